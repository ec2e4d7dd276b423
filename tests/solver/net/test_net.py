"""Facts that hold for every net: it is the sheet, once, without cracks, cut where the creases cut it."""

from __future__ import annotations

from collections import Counter
from types import ModuleType

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import solver
from solver.net.grid import MIN_GAP
from solver.pattern.arrangement import SNAP_TOLERANCE

AWKWARD = (
    "one arc",
    "crossing",
    "loop",
    "cusp",
    "hairpin across a crease",
    "closed circle",
    "free end",
    "tee",
    "star of three",
    "star of four",
    "star of five",
    "star of six",
    "star of seven",
    "star of eight",
    "duplicate",
    "near duplicate",
    "sliver",
    "sticking out",
    "hole",
    "ring",
    "inflection",
    "lens",
)
RESOLUTIONS = (8, 13, 20)


def sheet_of(pattern: solver.CreasePattern) -> shapely.Polygon:
    return shapely.Polygon(pattern.boundary, pattern.holes)


def shown_polygons(net: solver.PiecewiseDog) -> list[shapely.Polygon]:
    return [shapely.Polygon(net.render_map.uv[face]) for face in net.render_map.faces()]


def check_net(pattern: solver.CreasePattern, net: solver.PiecewiseDog) -> None:
    """All the invariants at once; lengths relative to the sheet's size."""
    sheet = sheet_of(pattern)
    size = float(np.ptp(pattern.boundary, axis=0).max())
    cell = net.frame.unit

    # Arrays fit together.
    assert net.rest.shape == (len(net.vertex_patch), 2)
    assert set(net.vertex_patch) == set(range(len(net.patch_polygons)))
    assert (net.vertex_patch[net.quads] == net.quad_patch[:, None]).all()
    assert net.rest == pytest.approx(net.frame.to_drawing(net.flat), abs=1e-9 * size)
    assert net.edge_length.mean() == pytest.approx(1.0, rel=1e-9)
    lengths = np.hypot(*(net.flat[net.edges[:, 1]] - net.flat[net.edges[:, 0]]).T)
    assert net.edge_length == pytest.approx(lengths, rel=1e-12)
    corners = net.flat[net.quads]
    assert (corners[:, 1, 0] > corners[:, 0, 0]).all()
    assert (corners[:, 3, 1] > corners[:, 0, 1]).all()

    # The shown surface reproduces the flat sheet, and its weights only mix.
    shown = net.render_map
    flat = shown.apply(np.column_stack([net.rest, np.zeros(len(net.rest))]))
    assert np.abs(flat[:, :2] - shown.uv).max() < 1e-8 * cell
    assert not flat[:, 2].any()
    assert np.asarray(shown.weights.sum(axis=1)).ravel() == pytest.approx(1.0, abs=1e-12)
    assert np.abs(shown.weights.data).max() < 2.0

    # It covers the sheet exactly once.
    polygons = shown_polygons(net)
    assert all(polygon.is_valid for polygon in polygons)
    area = sum(polygon.area for polygon in polygons)
    # A curved border is shown by chords that leave it by at most 1/500 cell.
    slack = 2e-3 * cell * sheet.length if len(pattern.boundary) > 8 else 1e-7 * size**2
    assert area == pytest.approx(sheet.area, abs=slack)
    assert shapely.union_all(polygons).area == pytest.approx(area, abs=1e-7 * size**2)
    assert all(shapely.LinearRing(polygon.exterior).is_ccw for polygon in polygons)

    # Patches are the pieces of the sheet.
    assert sum(p.area for p in net.patch_polygons) == pytest.approx(sheet.area, abs=1e-7 * size**2)
    for polygon in net.patch_polygons:
        assert polygon.geom_type == "Polygon"
        assert polygon.within(sheet.buffer(1e-6 * size))
    by_patch = np.bincount(shown.face_patch, [p.area for p in polygons], len(net.patch_polygons))
    for patch, polygon in enumerate(net.patch_polygons):
        assert by_patch[patch] == pytest.approx(polygon.area, abs=2e-3 * cell * polygon.length)

    # No cracks: an edge has two faces, or one and lies on the rim.
    uses: Counter[tuple[int, int]] = Counter()
    faces_of: dict[tuple[int, int], list[int]] = {}
    for f, face in enumerate(shown.faces()):
        assert len(set(face.tolist())) == len(face) >= 3
        for a, b in zip(face.tolist(), np.roll(face, -1).tolist(), strict=True):
            edge = (min(a, b), max(a, b))
            uses[edge] += 1
            faces_of.setdefault(edge, []).append(f)
    assert set(uses.values()) <= {1, 2}
    rim = sheet.boundary
    once = [edge for edge, count in uses.items() if count == 1]
    middles = shapely.points([shown.uv[list(edge)].mean(axis=0) for edge in once])
    assert shapely.distance(middles, rim).max() < 3e-3 * cell
    assert sum(np.hypot(*np.subtract(*shown.uv[list(edge)])) for edge in once) == pytest.approx(
        rim.length, rel=1e-3
    )

    # Crease edges are edges of the mesh, lie on the drawn curve, and part two patches or end inside one.
    assert len(shown.crease_edges) == len(shown.crease_edge_crease) == len(shown.crease_edge_chain)
    assert (len(shown.crease_edges) > 0) == (len(net.chain_crease) > 0)
    curves = [
        shapely.LineString(np.vstack([c.points, c.points[:1]]) if c.closed else c.points) for c in pattern.creases
    ]
    for (a, b), crease in zip(shown.crease_edges.tolist(), shown.crease_edge_crease.tolist(), strict=True):
        edge = (min(a, b), max(a, b))
        assert uses[edge] == 2
        off = curves[crease].distance(shapely.Point(shown.uv[[a, b]].mean(axis=0)))
        assert off < 0.02 * cell + SNAP_TOLERANCE * size
    parted = {edge for edge, two in faces_of.items()
              if len(two) == 2 and shown.face_patch[two[0]] != shown.face_patch[two[1]]}  # fmt: skip
    crease_edges = {(min(a, b), max(a, b)) for a, b in shown.crease_edges.tolist()}
    assert parted <= crease_edges


def check_stitches(net: solver.PiecewiseDog) -> None:
    """Copies of a point are the same point of the flat sheet, and nothing else is stitched."""
    gaps = np.einsum("ck,ckd->cd", net.stitches.weights, net.flat[net.stitches.vertices])
    assert np.abs(gaps).max(initial=0.0) < 1e-7
    assert np.abs(net.stitches.weights.sum(axis=1)).max(initial=0.0) < 1e-12


@pytest.mark.parametrize("resolution", RESOLUTIONS)
@pytest.mark.parametrize("name", AWKWARD)
def test_every_drawing_becomes_a_sound_net_with_its_number_of_patches(
    drawings: ModuleType, name: str, resolution: int
) -> None:
    make, patches = drawings.AWKWARD[name]
    pattern = make()
    net = solver.build_net(pattern, resolution)
    check_net(pattern, net)
    check_stitches(net)
    assert len(net.patch_polygons) == patches


def test_every_awkward_drawing_is_tested(drawings: ModuleType) -> None:
    assert set(AWKWARD) == set(drawings.AWKWARD)


@pytest.mark.parametrize("name", AWKWARD)
def test_crease_points_lie_on_their_crease_and_grid(drawings: ModuleType, name: str) -> None:
    pattern = drawings.AWKWARD[name][0]()
    net = solver.build_net(pattern, 13)
    points = net.crease_points
    assert np.isfinite(points.position).all()
    place = net.frame.to_drawing(points.position)
    size = float(np.ptp(pattern.boundary, axis=0).max())
    for k, crease in enumerate(points.crease):
        c = pattern.creases[crease]
        curve = shapely.LineString(np.vstack([c.points, c.points[:1]]) if c.closed else c.points)
        assert curve.distance(shapely.Point(place[k])) < 0.02 * net.frame.unit + SNAP_TOLERANCE * size
    inner = ~points.end
    off_x = np.abs(points.position[inner, :1] - net.grid.xs).min(axis=1)
    off_y = np.abs(points.position[inner, 1:] - net.grid.ys).min(axis=1)
    assert np.minimum(off_x, off_y).max() < 1e-6
    for vertices, weights in (
        (points.left_vertices, points.left_weights),
        (points.right_vertices, points.right_weights),
    ):
        here = vertices[:, 0] >= 0
        found = np.einsum("kw,kwc->kc", weights[here], net.flat[vertices[here]])
        assert np.abs(found - points.position[here]).max() < 1e-6
    # Left and right are meant as seen along the crease.
    step = 0.05 * net.frame.unit
    for k in np.flatnonzero(inner)[::3]:
        normal = np.array([-points.tangent[k, 1], points.tangent[k, 0]])
        for side, vertices in ((1, points.left_vertices[k]), (-1, points.right_vertices[k])):
            if vertices[0] < 0:
                continue
            patch = net.patch_polygons[net.vertex_patch[vertices[0]]]
            assert patch.distance(shapely.Point(place[k] + side * step * normal)) < 1e-3 * net.frame.unit


# --- vertices and grid lines ----------------------------------------------------------------------------


def lines_through(net: solver.PiecewiseDog, place: tuple[float, float]) -> tuple[float, float]:
    """Distances (cells) of a place from the nearest grid line in x and in y."""
    x, y = net.frame.to_net(np.array([place]))[0]
    return float(np.abs(net.grid.xs - x).min()), float(np.abs(net.grid.ys - y).min())


@pytest.mark.parametrize("arms", range(3, 9))
@pytest.mark.parametrize("resolution", [7, 16])
def test_grid_lines_pass_through_a_crease_vertex(drawings: ModuleType, arms: int, resolution: int) -> None:
    net = solver.build_net(drawings.star(arms), resolution)
    assert max(lines_through(net, (0.503, 0.497))) < 1e-6


cell_place = st.floats(0.15, 0.85)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.tuples(cell_place, cell_place), st.tuples(cell_place, cell_place), st.integers(6, 20))
def test_grid_lines_pass_through_all_vertices_that_leave_room(
    first: tuple[float, float], second: tuple[float, float], resolution: int
) -> None:
    """Two crosses of straight creases anywhere: a line through each vertex, or another one close by."""
    creases = []
    for x, y in (first, second):
        creases.append(solver.Crease(points=[(x, 0), (x, 1)]))
        creases.append(solver.Crease(points=[(0, y), (1, y)]))
    pattern = solver.CreasePattern(boundary=[(0, 0), (1, 0), (1, 1), (0, 1)], creases=creases)
    net = solver.build_net(pattern, resolution)
    check_net(pattern, net)
    far = resolution * min(abs(first[0] - second[0]), abs(first[1] - second[1])) > 2 * MIN_GAP
    for place in (first, second):
        nearest = max(lines_through(net, place))
        assert nearest < (1e-5 if far else 2 * MIN_GAP)


@pytest.mark.parametrize("aspect", [1, 2, 3.3, 7, 20])
@pytest.mark.parametrize("tall", [False, True], ids=["wide", "tall"])
def test_cells_are_nearly_square_whatever_the_sheet(drawings: ModuleType, aspect: float, tall: bool) -> None:
    points = drawings.curve([(0, 0.45), (aspect, 0.55)], 0.2).points
    boundary = drawings.rectangle(aspect, 1.0)
    if tall:
        points, boundary = points[:, ::-1], boundary[:, ::-1]
    pattern = solver.CreasePattern(boundary=boundary, creases=[solver.Crease(points=points)])
    net = solver.build_net(pattern, max(12, int(4 * aspect)))
    steps = np.concatenate([np.diff(net.grid.xs), np.diff(net.grid.ys)])
    # Lines through the crease's ends may bend the spacing, but never to slivers.
    assert steps.max() < 1.6
    assert steps.min() > 0.35 / 1.6
    x, y = np.diff(net.grid.xs), np.diff(net.grid.ys)
    assert 2 / 3 < np.median(x) / np.median(y) < 3 / 2


def test_the_resolution_counts_quads_along_the_longer_side(drawings: ModuleType) -> None:
    for resolution in (5, 16, 31):
        net = solver.build_net(
            solver.CreasePattern(
                boundary=drawings.rectangle(3.0, 1.0), creases=[drawings.curve([(0, 0), (3, 0.0)], 0.6)]
            ),
            resolution,
        )
        assert len(net.grid.xs) - 1 == resolution


# --- near misses ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("gap", "joined"), [(0.0, True), (0.5 * SNAP_TOLERANCE, True), (0.015, True), (0.02, True), (0.022, False)]
)
def test_an_end_joins_the_border_within_a_quarter_of_a_cell_only(
    drawings: ModuleType, gap: float, joined: bool
) -> None:
    net = solver.build_net(drawings.square_with(drawings.curve([(gap, 0.4), (1, 0.5)], 0.1)), 12)
    assert len(net.patch_polygons) == (2 if joined else 1)
    assert any("crease 1" in note for note in net.notes) == (joined and gap > 0)


@pytest.mark.parametrize(("gap", "joined"), [(0.5 * SNAP_TOLERANCE, True), (0.02, True), (0.025, False)])
def test_an_end_joins_another_crease_within_a_quarter_of_a_cell_only(
    drawings: ModuleType, gap: float, joined: bool
) -> None:
    net = solver.build_net(
        drawings.square_with(
            drawings.line((0, 0.4), (1, 0.4)), drawings.curve([(0.45, 0.4 + gap), (0.6, 1)], 0.05)
        ),
        12,
    )
    assert len(net.patch_polygons) == (3 if joined else 2)


@pytest.mark.parametrize(("gap", "joined"), [(0.6 * SNAP_TOLERANCE, True), (0.02, True), (0.022, False)])
def test_ends_that_face_each_other_join_within_a_quarter_of_a_cell_only(
    drawings: ModuleType, gap: float, joined: bool
) -> None:
    net = solver.build_net(
        drawings.square_with(
            drawings.curve([(0, 0.4), (0.5 - gap / 2, 0.5)], 0.1),
            drawings.curve([(0.5 + gap / 2, 0.5), (1, 0.4)], -0.1),
        ),
        12,
    )
    assert len(net.patch_polygons) == (2 if joined else 1)


def test_an_overshoot_within_the_tolerance_leaves_no_whisker(drawings: ModuleType) -> None:
    net = solver.build_net(
        drawings.square_with(
            drawings.line((0, 0.4), (1, 0.4)),
            drawings.curve([(0.45, 0.4 - 0.5 * SNAP_TOLERANCE), (0.6, 1)], 0.05),
        ),
        12,
    )
    assert len(net.patch_polygons) == 3
    assert len(net.chain_crease) == 3


def test_three_creases_that_almost_meet_in_a_point_meet_in_a_point(drawings: ModuleType) -> None:
    d = 0.3 * SNAP_TOLERANCE
    net = solver.build_net(
        drawings.square_with(
            drawings.line((0.0, 0.5 + d), (1.0, 0.5 + d)),
            drawings.line((0.5, 0.0), (0.5 + d, 1.0)),
            drawings.line((0.0, 0.0), (1.0, 1.0)),
        ),
        12,
    )
    assert len(net.patch_polygons) == 6
    assert len(net.chain_crease) == 6
    ends = net.crease_points.position[net.crease_points.end]
    inner = ends[[net.sheet.exterior.distance(shapely.Point(p)) > 0.1 for p in ends]]
    assert len(inner) == 6
    assert np.ptp(inner, axis=0).max() < 1e-6


def test_what_was_mended_is_said(drawings: ModuleType) -> None:
    for name, word in (
        ("near duplicate", "crease 2"),
        ("sliver", "crease 2"),
        ("sticking out", "trimmed"),
    ):
        net = solver.build_net(drawings.AWKWARD[name][0](), 12)
        assert any(word in note for note in net.notes), name
    assert solver.build_net(drawings.one_arc(), 12).notes == ()


def test_creases_that_stick_out_are_one_note() -> None:
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    creases = [solver.Crease([(-0.1, y), (1.1, y)]) for y in (0.2, 0.4, 0.6, 0.7, 0.8, 0.9)]
    listed = "crease 1, crease 2, crease 3, crease 4 and 2 more"
    (note,) = solver.build_net(solver.CreasePattern(square, creases=creases), 12).notes
    assert note == f"creases stick out of the sheet and were trimmed at the border: {listed}"
    (note,) = solver.build_net(solver.CreasePattern(square, creases=creases[:1]), 12).notes
    assert note == "crease 1 sticks out of the sheet and was trimmed at the border"


# --- any crease at all ----------------------------------------------------------------------------------

spot = st.tuples(st.floats(-0.2, 1.2), st.floats(-0.2, 1.2))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(spot, spot, st.floats(-0.3, 0.3)), min_size=1, max_size=4),
    st.integers(5, 14),
)
def test_any_heap_of_arcs_becomes_a_sound_net_or_says_why_not(
    arcs: list[tuple[tuple[float, float], tuple[float, float], float]], resolution: int
) -> None:
    t = np.linspace(0, 1, 25)[:, None]
    creases = []
    for start, end, sag in arcs:
        a, b = np.array(start), np.array(end)
        if np.hypot(*(b - a)) < 1e-3:
            continue
        left = np.array([a[1] - b[1], b[0] - a[0]])
        creases.append(solver.Crease(points=(1 - t) * a + t * b + 4 * sag * t * (1 - t) * left))
    pattern = solver.CreasePattern(boundary=[(0, 0), (1, 0), (1, 1), (0, 1)], creases=creases)
    try:
        net = solver.build_net(pattern, resolution)
    except (solver.PatternError, solver.NetError):
        return
    check_net(pattern, net)
    check_stitches(net)
    m = solver.measure(net, np.column_stack([net.rest, np.zeros(len(net.rest))]))
    assert m.stretch.max() < 1e-9
    assert m.continuity.max(initial=0.0) < 1e-7


# --- handles --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["one arc", "crossing", "star of five", "hole", "free end", "lens", "ring"])
def test_a_point_of_the_sheet_is_found_wherever_it_lies(drawings: ModuleType, name: str) -> None:
    pattern = drawings.AWKWARD[name][0]()
    net = solver.build_net(pattern, 11)
    sheet = sheet_of(pattern)
    rng = np.random.default_rng(8)
    low_x, low_y, high_x, high_y = sheet.bounds
    random = rng.uniform((low_x, low_y), (high_x, high_y), (60, 2))
    places = [
        *random[shapely.contains_xy(sheet, random)],
        *pattern.boundary,
        *(0.5 * (pattern.boundary + np.roll(pattern.boundary, 1, axis=0))),
        *net.frame.to_drawing(net.crease_points.position),
        *[point for hole in pattern.holes for point in hole],
        *net.rest[:: max(1, len(net.rest) // 20)],
    ]
    for place in places:
        if not sheet.buffer(1e-9).contains(shapely.Point(place)):
            continue
        vertices, weights = net.locate((float(place[0]), float(place[1])))
        assert weights.sum() == pytest.approx(1.0)
        assert weights.min() > -1e-6
        assert weights @ net.rest[vertices] == pytest.approx(place, abs=1e-6)
        assert len(set(net.vertex_patch[vertices])) == 1
        patch = net.patch_polygons[net.vertex_patch[vertices[0]]]
        assert patch.distance(shapely.Point(place)) < 1e-5


@pytest.mark.parametrize("place", [(-0.2, 0.5), (1.3, 1.3), (0.5, 0.5), (0.45, 0.55), (7e9, 0), (np.nan, 0.5)])
def test_a_point_off_the_sheet_or_in_a_hole_is_refused(drawings: ModuleType, place: tuple[float, float]) -> None:
    net = solver.build_net(drawings.holed(), 11)
    with pytest.raises(solver.HandleError) as caught:
        net.locate(place)
    assert len(str(caught.value).splitlines()) == 1


def test_a_point_beside_a_crease_belongs_to_its_own_side(drawings: ModuleType) -> None:
    pattern = drawings.one_arc()
    net = solver.build_net(pattern, 9)
    for x in (0.13, 0.5, 0.77):
        height = np.interp(x, *pattern.creases[0].points.T)
        for side in (-1, 1):
            vertices, _ = net.locate((x, height + side * 0.004))
            patch = net.patch_polygons[net.vertex_patch[vertices[0]]]
            assert (patch.centroid.y > height) == (side > 0)


def test_a_flat_crease_is_no_cut_and_keeps_its_number() -> None:
    square = [(0, 0), (10, 0), (10, 10), (0, 10)]
    flat, valley = (solver.Crease([(x, 0), (x + 0.3, 5), (x, 10)], assignment=a) for x, a in ((3, "F"), (7, "V")))
    both = solver.build_net(solver.CreasePattern(square, creases=[flat, valley]), 8)
    alone = solver.build_net(solver.CreasePattern(square, creases=[valley]), 8)
    assert np.array_equal(both.rest, alone.rest)
    assert set(both.crease_points.crease) == {1}
    assert len(both.crease_labels) == 2
    assert any("crease 1" in note for note in both.notes)
    blank = solver.build_net(solver.CreasePattern(square, creases=[flat]), 8)
    assert len(blank.patch_polygons) == 1
    assert [note.split(":")[0] for note in blank.notes] == [
        "marked flat (F) and not folded", "no crease is left to fold"
    ]  # fmt: skip
