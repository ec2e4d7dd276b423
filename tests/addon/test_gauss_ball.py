"""The Gauss image over papers: on a ball that keeps clear of the paper, in the colours of its patches."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def arrays(extension):
    return extension("curvefold_addon.bridge.gauss_ball")


@pytest.fixture
def settings():
    settings = bpy.context.scene.curvefold
    settings.gauss_image = True
    return settings


@pytest.fixture
def ball(arrays, folded):
    """Of a folded paper."""
    return arrays.ball(folded.net, folded.positions, folded.net.render_map.apply(folded.positions))


def rolled(net):
    """The sheet round a cylinder that is thinner than the ball."""
    x, y = net.rest.T / 12.0
    return 12.0 * np.column_stack([np.sin(x), y, 1.0 - np.cos(x)])


@pytest.mark.parametrize("shape", ["flat", "folded", "rolled", "far away"])
def test_the_ball_keeps_clear_of_the_paper_from_wherever_it_is_looked_at(arrays, folded, shape):
    net = folded.net
    flat = np.column_stack([net.rest, np.zeros(len(net.rest))])
    positions = {
        "flat": flat,
        "folded": folded.positions,
        "rolled": rolled(net),
        "far away": folded.positions @ np.diag([-1.0, 1.0, -1.0]) + [400.0, -3.0, 50.0],
    }[shape]
    shown = net.render_map.apply(positions)
    ball = arrays.ball(net, positions, shown)
    middle = 0.5 * (shown.min(axis=0) + shown.max(axis=0))
    for right in np.random.default_rng(3).normal(size=(40, 3)):
        place = ball.beside(tuple(right))
        assert place.radius == pytest.approx(25.0, rel=1e-3)
        way = right / np.linalg.norm(right)
        away = np.array(place.centre) - middle
        assert away == pytest.approx((away @ way) * way, abs=1e-9)
        left_of_ball = np.array(place.centre) @ way - place.radius
        assert left_of_ball > (shown @ way).max() + 0.1 * 100.0
        # And not farther off than a box round the paper asks for.
        assert away @ way < 0.5 * np.linalg.norm(np.ptp(shown, axis=0)) + 0.41 * 100.0


def test_all_lies_on_the_unit_ball(ball):
    for lines in (ball.circles, ball.image):
        assert len(lines.points) == len(lines.colors) > 100
        assert np.linalg.norm(lines.points, axis=1) == pytest.approx(1.0, abs=1e-6)


def test_the_image_is_that_of_the_solver(extension, ball, folded):
    strokes, _ = extension("solver").gauss_image(folded.net, folded.positions).strokes()
    assert ball.image.points == pytest.approx(strokes.reshape(-1, 3), abs=1e-6)


def test_the_circles_are_closed_and_one_lies_across_each_axis(arrays):
    circles = arrays.great_circles()
    for axis, circle in enumerate(circles):
        assert circle[:, axis] == pytest.approx(0.0)
        steps = np.linalg.norm(np.roll(circle, -1, axis=0) - circle, axis=1)
        assert steps == pytest.approx(steps[0])


def test_a_mark_on_each_patch_has_the_colour_of_its_image(arrays, ball, folded):
    net = folded.net
    seen = {tuple(color) for color in ball.image.colors.tolist()}
    assert len(ball.marks) == len(seen) == 2
    for color, points in ball.marks:
        assert tuple(np.float32(color).tolist()) in seen
        (patch,) = [k for k, other in enumerate(arrays.PATCH_COLORS) if other == color]
        (point,) = points
        mine = folded.positions[net.vertex_patch == patch]
        assert np.linalg.norm(mine - point, axis=1).min() < 10.0
        assert np.linalg.norm(folded.positions[net.vertex_patch != patch] - point, axis=1).min() > 10.0


def test_it_is_made_once_for_a_shape_and_moves_with_the_fold(extension, content, paper, settings):
    live = extension("curvefold_addon.live")
    live.settle(paper.data)
    flat = content.of_paper(paper, settings).gauss_image
    assert content.of_paper(paper, settings).gauss_image is flat
    paper.data.curvefold.fold = 60.0
    live.settle(paper.data)
    folded = content.of_paper(paper, settings).gauss_image
    assert folded is not flat
    assert np.ptp(flat.image.points[:, 1]) < 0.2 * np.ptp(folded.image.points[:, 1])
    settings.gauss_image = False
    assert content.of_paper(paper, settings).gauss_image is None


def test_a_paper_without_a_session_has_none(extension, content, paper, settings):
    extension("curvefold_addon.live").forget()
    assert content.of_paper(paper, settings).gauss_image is None
