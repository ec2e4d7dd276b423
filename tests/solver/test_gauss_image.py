"""Gauss images of exact states: points, arcs of great and small circles, areas only where paper is stretched."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import solver
from solver import gauss_image
from solver.gauss_image import ARM
from solver.net.paper_share import paper_areas, paper_shares


def flat_sheet(net: solver.PiecewiseDog) -> np.ndarray:
    return np.column_stack([net.rest, np.zeros(len(net.rest))])


def cone(exact: ModuleType) -> object:
    return exact.Pleats(np.radians(60), (1.0, 1.5), 0.5, 2.0, 0.9)


def curvature(net: solver.PiecewiseDog, positions: np.ndarray) -> tuple[float, float]:
    """Area of the image over the quads round each inner vertex: summed with its sign, and without."""
    image = gauss_image(net, positions)
    centres = net.rest[net.quads].mean(axis=1)
    around: list[list[int]] = [[] for _ in net.rest]
    for q, corners in enumerate(net.quads):
        for vertex in corners:
            around[vertex].append(q)
    signed = []
    for vertex, quads in enumerate(around):
        if len(quads) != 4 or not image.shown[quads].all():
            continue
        turn = centres[quads] - net.rest[vertex]
        a, b, c, d = image.normals[np.array(quads)[np.argsort(np.arctan2(turn[:, 1], turn[:, 0]))]]
        # Half the cross product of the diagonals; on a small piece of the ball that is its area.
        signed.append(0.5 * np.cross(c - a, d - b) @ (a + b + c + d) / 4)
    return float(np.sum(signed)), float(np.abs(signed).sum())


def test_of_a_cylinder_it_is_an_arc_of_a_great_circle(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 16)
    image = gauss_image(net, state.positions(net))
    assert np.linalg.norm(image.normals, axis=1) == pytest.approx(1.0)
    for patch in (0, 1):
        # A great circle lies in a plane through the centre.
        sizes = np.linalg.svd(image.normals[image.patch == patch], compute_uv=False)
        assert sizes[2] < 1e-12 * sizes[0]
        assert sizes[1] > 0.05 * sizes[0]


def test_of_a_cone_it_is_an_arc_of_a_circle_about_its_axis(exact: ModuleType) -> None:
    state = cone(exact)
    errors = []
    for resolution in (16, 32, 64):
        net = solver.build_net(state.pattern(), resolution)
        image = gauss_image(net, state.positions(net))
        off = np.abs(image.normals[:, 2] - np.sin(state.half_angle))
        errors.append(off[image.shown].max())
        around = np.arctan2(image.normals[:, 1], image.normals[:, 0])
        for patch in np.unique(image.patch):
            assert np.ptp(np.unwrap(np.sort(around[image.shown & (image.patch == patch)]))) > 0.8
    assert errors[1] < 0.4 * errors[0]
    assert errors[2] < 0.4 * errors[1]
    assert errors[2] < 1e-3


def test_of_a_plane_it_is_a_point_that_is_drawn_as_a_star(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 16)
    image = gauss_image(net, flat_sheet(net))
    assert image.normals == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(net.quads), 1)))
    strokes, patch = image.strokes()
    step = strokes[:, 1] - strokes[:, 0]
    assert sorted(patch) == [0, 0, 0, 1, 1, 1]
    assert strokes.mean(axis=1) == pytest.approx(np.tile([0.0, 0.0, 1.0], (6, 1)))
    for one in (0, 1):
        star = step[patch == one]
        assert star @ star.T == pytest.approx((2 * ARM) ** 2 * np.eye(3))


def test_bent_paper_has_no_stars(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 16)
    image = gauss_image(net, state.positions(net))
    strokes, patch = image.strokes()
    assert np.array_equal(strokes, image.normals[image.lines])
    assert np.array_equal(patch, image.patch[image.lines[:, 1]])


def test_the_area_of_bent_paper_vanishes_and_that_of_a_ball_does_not(exact: ModuleType) -> None:
    state = cone(exact)
    areas, balls = [], []
    for resolution in (16, 32, 64):
        net = solver.build_net(state.pattern(), resolution)
        signed, unsigned = curvature(net, state.positions(net))
        areas.append(unsigned)
        assert abs(signed) <= unsigned
        x, y = 0.2 * net.rest.T
        signed, unsigned = curvature(net, np.column_stack([x, y, np.sqrt(1 - x**2 - y**2)]))
        assert signed == pytest.approx(unsigned)
        balls.append(signed)
    assert areas[1] < 0.5 * areas[0]
    assert areas[2] < 0.5 * areas[1]
    assert areas[2] < 0.02 * balls[2]
    assert min(balls) > 0.05


def test_it_joins_quads_over_the_edges_of_one_patch(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 16)
    image = gauss_image(net, flat_sheet(net))
    shared = [len(set(net.quads[a]) & set(net.quads[b])) for a, b in image.pairs]
    assert set(shared) == {2}
    assert (image.patch[image.pairs[:, 0]] == image.patch[image.pairs[:, 1]]).all()
    edges = np.sort(net.quads[:, [[0, 1], [1, 2], [2, 3], [3, 0]]].reshape(-1, 2), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    assert len(image.pairs) == (uses == 2).sum()
    assert set(map(tuple, image.lines)) < set(map(tuple, image.pairs))


def test_quads_that_are_mostly_no_paper_are_not_shown(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 16)
    shown, share = gauss_image(net, flat_sheet(net)).shown, paper_shares(net)
    assert shown[share >= 0.5].all()
    assert not shown[share < 0.4].any()
    assert 0 < (~shown).sum() < 0.2 * len(shown)


def test_a_patch_narrower_than_a_cell_is_shown_too(drawings: ModuleType) -> None:
    creases = [drawings.curve([(0, y), (1, y)], 0.1) for y in (0.4, 0.41)]
    net = solver.build_net(drawings.square_with(*creases), 8)
    image = gauss_image(net, flat_sheet(net))
    narrow = int(np.argmin([polygon.area for polygon in net.patch_polygons]))
    assert paper_shares(net)[net.quad_patch == narrow].max() < 0.4
    assert (image.patch[image.lines[:, 0]] == narrow).sum() > 3


def test_areas_of_paper_are_those_of_the_patches(exact: ModuleType) -> None:
    net = solver.build_net(cone(exact).pattern(), 20)
    area = np.bincount(net.quad_patch, weights=paper_areas(net)) * net.frame.unit**2
    assert area == pytest.approx([polygon.area for polygon in net.patch_polygons], rel=1e-6)


def test_what_is_no_shape_is_refused(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 8)
    with pytest.raises(ValueError, match="positions"):
        gauss_image(net, np.zeros((3, 3)))


def test_the_area_of_the_image_tells_ripples_from_bent_paper(exact: ModuleType, drawings: ModuleType) -> None:
    """Bent paper covers none, up to the grid's error; the cap of a ball covers what the cap does."""
    state = cone(exact)
    areas = []
    for resolution in (16, 32):
        net = solver.build_net(state.pattern(), resolution)  # type: ignore[attr-defined]
        areas.append(solver.gauss_area(net, state.positions(net)))  # type: ignore[attr-defined]
    assert areas[1] < 0.6 * areas[0] < 0.1
    net = solver.build_net(drawings.square_with(), 32)
    assert solver.gauss_area(net, flat_sheet(net)) == 0.0
    x, y = (net.rest - 0.5).T
    ball = np.column_stack([x, y, np.sqrt(1.0 - x**2 - y**2)])
    inner = 31.0 / 32.0  # the cells around vertices that have four quads
    sides = np.linspace(-inner / 2, inner / 2, 200)
    u, v = np.meshgrid(sides, sides)
    cap = np.mean((1.0 - u**2 - v**2) ** -0.5) * inner**2
    assert solver.gauss_area(net, ball) == pytest.approx(cap, rel=0.02)
    rippled = np.column_stack([x, y, 0.01 * np.sin(40 * x) * np.sin(40 * y)])
    assert solver.gauss_area(net, rippled) > 1.0
