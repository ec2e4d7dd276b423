"""Clicks near corners, creases and the border mean these."""

import bpy
import pytest
from mathutils import Matrix, Vector

#: Pixels of the region, and of a metre in it: 0.1 m of paper are 400 pixels.
SIZE = 800
METRE = 4000.0
#: Half of the paper's side, metres.
HALF = 0.05


@pytest.fixture
def rays(extension):
    return extension("curvefold_addon.mouse_ray")


@pytest.fixture
def click(extension, rays):
    """``click(paper, x, y)``: what a click means that is at a place of the paper's plane, seen from above."""
    snapping = extension("curvefold_addon.bridge.snapping")
    matrix = Matrix.Diagonal((2 * METRE / SIZE, 2 * METRE / SIZE, -0.1, 1.0))

    def clicked(paper, x, y, up=1.0):
        mouse = tuple(SIZE / 2 + METRE * c for c in (x, y))
        view = snapping.View(matrix, (SIZE, SIZE), mouse)
        return rays.point_on(paper, rays.MouseRay(Vector((x, y, 5.0 * up)), Vector((0, 0, -up)), view))

    return clicked


def pixels(count):
    return count / METRE


def test_a_click_near_a_corner_means_the_corner(paper, click):
    for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        for away in (-6, 6):
            found = click(paper, x * (HALF + pixels(away)), y * (HALF + pixels(away)))
            assert found.at == pytest.approx((x * HALF, y * HALF), abs=1e-7)


def test_a_click_a_few_pixels_outside_finds_the_border(paper, click):
    found = click(paper, 0.0137, HALF + pixels(5))
    assert found.at == pytest.approx((0.0137, HALF), abs=1e-6)
    assert found.place == pytest.approx((0.0137, HALF, 0.0), abs=1e-6)
    assert click(paper, 0.0137, HALF + pixels(20)) is None


def test_a_click_inside_the_border_means_the_border_only_when_it_is_near(paper, click):
    assert click(paper, 0.0137, HALF - pixels(5)).at == pytest.approx((0.0137, HALF), abs=1e-6)
    at = (0.0137, HALF - pixels(20))
    assert click(paper, *at).at == pytest.approx(at, abs=1e-6)


def ends_of_crease(paper):
    """Where the crease meets the border: the arc's ends, on the left and the right."""
    number = [item.value for item in paper.data.attributes["crease"].data]
    used = [v for edge, k in zip(paper.data.edges, number, strict=True) if k >= 0 for v in edge.vertices]
    return [paper.data.vertices[v].co for v in used if used.count(v) == 1], [
        paper.data.vertices[v].co for v in used if used.count(v) == 2
    ]


def test_a_click_near_the_end_of_a_crease_means_it_rather_than_the_border(paper, click):
    ends, _ = ends_of_crease(paper)
    assert len(ends) == 2
    for end in ends:
        found = click(paper, end.x * (1 + pixels(3) / HALF), end.y + pixels(6))
        assert found.place == pytest.approx(tuple(end), abs=1e-7)


def test_a_click_near_a_crease_point_means_it_and_near_a_crease_its_line(paper, click, live):
    _, inner = ends_of_crease(paper)
    point = min(inner, key=lambda co: abs(co.x))
    found = click(paper, point.x + pixels(3), point.y + pixels(5))
    assert found.place == pytest.approx(tuple(point), abs=1e-7)
    after = min((co for co in inner if co.x > point.x + pixels(20)), key=lambda co: co.x)
    middle = (after + point) / 2
    found = click(paper, middle.x, middle.y + pixels(4))
    assert found.place[1] == pytest.approx(middle.y, abs=pixels(1))
    live.make_session(paper).place_of(found.at)


def test_what_the_paper_hides_is_not_near(extension, click, paper):
    """Folded over, the border lies below the other half of the paper."""
    import numpy as np

    mesh = paper.data
    places = np.array([vertex.co for vertex in mesh.vertices])
    # The upper half laid over the lower one, a little above it; its border lands at y = -0.03.
    over = places[:, 1] > 0.01
    places[over, 1] = 0.02 - places[over, 1]
    places[over, 2] = 0.005
    mesh.vertices.foreach_set("co", places.astype(np.float32).ravel())
    mesh.update()
    x, y = 0.0137, 0.02 - HALF + pixels(5)
    assert click(paper, x, y).place == pytest.approx((x, 0.02 - HALF, 0.005), abs=1e-6)
    below = click(paper, x, y, up=-1.0)
    assert below.place == pytest.approx((x, y, 0.0), abs=1e-6), "from below the lower half hides it"


def test_a_handle_placed_beside_the_paper_holds_its_corner(extension, rays, paper):
    snapping = extension("curvefold_addon.bridge.snapping")
    placing = extension("curvefold_addon.operators.place_handle")
    scale = Matrix.Diagonal((2 * METRE / SIZE, 2 * METRE / SIZE, -0.1, 1.0))
    paper.location.x = 0.01
    bpy.context.view_layer.update()
    x, y = HALF + 0.01 + pixels(5), HALF + pixels(5)
    view = snapping.View(scale, (SIZE, SIZE), (SIZE / 2 + METRE * x, SIZE / 2 + METRE * y))
    ray = rays.MouseRay(Vector((x, y, 5.0)), Vector((0, 0, -1)), view)
    empty = placing.place_along(bpy.context, paper, ray)
    assert tuple(paper.data.curvefold.handles[0].at) == pytest.approx((HALF, HALF), abs=1e-6)
    assert tuple(empty.matrix_world.translation) == pytest.approx((HALF + 0.01, HALF, 0.0), abs=1e-6)


def test_what_is_behind_the_eye_is_not_near(extension, paper):
    snapping = extension("curvefold_addon.bridge.snapping")
    # A perspective view from below the paper that looks down, away from it.
    matrix = Matrix(((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, -1, 0), (0, 0, -1, -1.0)))
    view = snapping.View(matrix, (SIZE, SIZE), (SIZE / 2 - 400 * HALF, SIZE / 2 - 400 * HALF))
    assert snapping.near_mouse(paper.data, view, (0, 0, -1), (0, 0, -1)) is None
