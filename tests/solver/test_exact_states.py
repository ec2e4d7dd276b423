"""Folded states in closed form: what is measured on them, what moves them, how they are found again."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
import shapely
from settling import settle

import solver

#: Degrees of state A, g = 0.3 sin pi x, at x = 0, 0.25, 0.5, by the parameter b.
SINE_ANGLES = {
    3.0: (51.512263, 44.669520, 36.869898),
    1.5: (99.323517, 83.609552, 67.380135),
    1.0: (152.655955, 116.367830, 90.0),
}
#: Mean and largest stretch of state A, b = 1.5, on N x N vertices.
STRETCH = {11: (1.8e-3, 6.4e-3), 21: (4.6e-4, 1.6e-3), 41: (1.2e-4, 4.0e-4)}


def angle_errors(net: solver.PiecewiseDog, m: solver.Measurement, state: object) -> np.ndarray:
    known = np.isfinite(m.fold_angle)
    return np.abs(m.fold_angle - state.fold_angle(m.crease_position[:, 0]))[known]  # type: ignore[attr-defined]


# --- the closed forms themselves: what the tests rest on ------------------------------------------------


@pytest.mark.parametrize(("b", "angles"), SINE_ANGLES.items())
def test_the_closed_form_of_a_gives_its_published_angles(
    exact: ModuleType, b: float, angles: tuple[float, ...]
) -> None:
    assert exact.sine(b).fold_angle(np.array([0, 0.25, 0.5])) == pytest.approx(angles, abs=2e-6)


def test_the_closed_form_of_a_gives_its_published_points_and_distances(exact: ModuleType) -> None:
    point = exact.arc(1.5).fold(np.array([[1.0, 1.0]]), 1)[0]
    assert point == pytest.approx((0.9917818442, 0.9775975689, 0.2197235739), abs=1e-9)
    for b, long, short in (
        (3.0, 2.7205378863, 1.9496990513),
        (1.5, 2.4403038681, 1.7848955711),
        (1.0, 2.0031689236, 1.4186915579),
    ):
        state = exact.sine(b)
        low_left, top_left, top_right = (state.at(p) for p in ((-1, -1), (-1, 1), (1, 1)))
        assert np.linalg.norm(low_left - top_right) == pytest.approx(long, abs=1e-9)
        assert np.linalg.norm(top_left - top_right) == pytest.approx(short, abs=1e-9)


def test_the_closed_form_of_b_gives_its_published_point(exact: ModuleType) -> None:
    cone = exact.Pleats(np.radians(60), (1, 1.25, 1.5, 1.75), 0.75, 2.0, 0.5)
    point = cone.fold(np.array([[2 * np.cos(1), 2 * np.sin(1)]]), 4)[0]
    assert point == pytest.approx((0.7000818802, 1.5842617716, 0.5), abs=1e-9)


# --- A: graphs ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("vertices", STRETCH)
def test_a_is_as_isometric_as_its_grid_allows(exact: ModuleType, vertices: int) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), vertices - 1)
    m = solver.measure(net, state.positions(net))
    mean, largest = STRETCH[vertices]
    assert m.stretch.mean() == pytest.approx(mean, rel=0.06)
    assert m.stretch.max() == pytest.approx(largest, rel=0.06)


@pytest.mark.parametrize("b", SINE_ANGLES)
def test_stretch_of_a_falls_with_the_square_of_the_grid(exact: ModuleType, b: float) -> None:
    state = exact.sine(b)
    means = []
    for resolution in (10, 20, 40):
        net = solver.build_net(state.pattern(), resolution)
        means.append(solver.measure(net, state.positions(net)).stretch.mean())
    orders = np.log2(np.array(means[:-1]) / means[1:])
    assert orders == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("b", SINE_ANGLES)
def test_measured_angles_of_a_converge_with_the_square_of_the_grid(exact: ModuleType, b: float) -> None:
    state = exact.sine(b)
    errors = []
    for resolution in (12, 24, 48):
        net = solver.build_net(state.pattern(), resolution)
        errors.append(angle_errors(net, solver.measure(net, state.positions(net)), state).mean())
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(2.0, abs=0.35)
    assert errors[2] < 0.2


@pytest.mark.parametrize(("b", "angles"), SINE_ANGLES.items())
def test_measured_angles_of_a_are_those_of_the_table(
    exact: ModuleType, b: float, angles: tuple[float, ...]
) -> None:
    state = exact.sine(b)
    net = solver.build_net(state.pattern(), 40)
    m = solver.measure(net, state.positions(net))
    for place, angle in zip((0.0, 0.25, 0.5), angles, strict=True):
        for x in (place, -place):
            # The two nearest crease points, straight between them.
            nearest = np.argsort(np.abs(m.crease_position[:, 0] - x))[:2]
            assert m.fold_angle[nearest].mean() == pytest.approx(angle, rel=0.02)


def test_measured_angles_of_an_arc_are_those_of_the_table(exact: ModuleType) -> None:
    state = exact.arc(1.5)
    net = solver.build_net(state.pattern(low=-1.3, high=0.7), 40)
    m = solver.measure(net, state.positions(net))
    middle = np.argmin(np.abs(m.crease_position[:, 0]))
    assert m.fold_angle[middle] == pytest.approx(67.380135, abs=0.3)
    assert angle_errors(net, m, state).max() < 0.6


@pytest.mark.parametrize("b", SINE_ANGLES)
@pytest.mark.parametrize("resolution", [10, 17, 24])
def test_a_holds_its_dog_angles_and_is_folded_everywhere(exact: ModuleType, b: float, resolution: int) -> None:
    state = exact.sine(b)
    net = solver.build_net(state.pattern(), resolution)
    m = solver.measure(net, state.positions(net))
    assert m.dog_angle.max() < 1e-10
    assert m.asked.sum() >= resolution
    assert m.folded.all()
    assert m.folded_part == 1.0
    assert m.not_folded == ()


def test_gaps_of_a_vanish_with_the_grid(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    gaps = []
    for resolution in (10, 20, 40):
        net = solver.build_net(state.pattern(), resolution)
        # In units of the sheet: the sag of a chord is of second order.
        gaps.append(solver.measure(net, state.positions(net)).continuity.max() * net.frame.unit)
    assert gaps[0] > 1.5 * gaps[1]
    assert gaps[0] > 6 * gaps[2]


@pytest.mark.parametrize(
    ("creases", "sides"),
    [
        (((1, -0.5), (1, 0.0), (1, 0.5)), (1, -1, 1)),
        (((1, -0.65), (-1, 0.0), (1, 0.65)), (1, 1, 1)),
    ],
    ids=["parallel creases fold alternately", "mirrored creases fold to one side"],
)
def test_several_creases_of_a_fold_to_the_sides_that_the_closed_form_says(
    exact: ModuleType, creases: tuple[tuple[int, float], ...], sides: tuple[int, ...]
) -> None:
    state = exact.sine(1.5, creases, height=0.15)
    net = solver.build_net(state.pattern(), 24)
    m = solver.measure(net, state.positions(net))
    assert m.folded.all()
    assert m.dog_angle.max() < 1e-10
    assert m.stretch.mean() < 1e-4
    assert angle_errors(net, m, state).mean() < 0.2
    known = np.isfinite(m.fold_angle)
    for crease, side in enumerate(sides):
        assert set(m.fold_sign[known & (m.crease == crease)]) == {side}


@pytest.mark.parametrize("b", SINE_ANGLES)
def test_a_smooth_bent_sheet_is_not_folded(exact: ModuleType, b: float) -> None:
    state = exact.sine(b)
    net = solver.build_net(state.pattern(), 20)
    m = solver.measure(net, state.bent(net))
    assert np.ptp(state.bent(net)[:, 2]) > 0.1
    assert m.dog_angle.max() < 1e-10
    assert m.continuity.max() < 1e-7
    assert m.asked.sum() >= 20
    assert not m.folded[m.asked].any()
    assert m.not_folded == (0,)
    assert np.nanmax(m.fold_angle) < 1e-6


def test_a_flat_sheet_has_no_angle_and_is_not_folded(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 12)
    m = solver.measure(net, np.column_stack([net.rest, np.zeros(len(net.rest))]))
    assert m.stretch.max() < 1e-12
    assert m.continuity.max() < 1e-7
    assert np.nanmax(m.fold_angle) < 1e-6
    assert not m.folded[m.asked].any()


@pytest.mark.parametrize("turn", [0.0, 90.0, 33.0], ids=lambda turn: f"turned by {turn:g} degrees")
@pytest.mark.parametrize("degrees", [0.05, 10.0, 90.0, 170.0])
def test_a_straight_fold_is_measured_exactly_and_a_valley_is_positive(degrees: float, turn: float) -> None:
    half = np.radians(degrees / 2)
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    spin = np.array([[c, -s], [s, c]])
    pattern = solver.CreasePattern(
        boundary=np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)]) @ spin.T,
        creases=[solver.Crease(points=np.array([(-0.21, -1.0), (0.37, 1.0)]) @ spin.T)],
    )
    net = solver.build_net(pattern, 9)
    start, end = pattern.creases[0].points
    along = (end - start) / np.hypot(*(end - start))
    across = np.array([-along[1], along[0]])
    for sign, side in ((1, "valley"), (-1, "mountain")):
        plane = net.rest - start
        # Both halves rise above the table: seen from the front, the crease is a valley.
        left = np.array([across @ (np.array(p.representative_point().coords[0]) - start) > 0
                         for p in net.patch_polygons])[net.vertex_patch]  # fmt: skip
        u, v = plane @ along, plane @ across
        out = np.where(left, v, -v)
        flat = start + u[:, None] * along + (np.cos(half) * v)[:, None] * across
        positions = np.column_stack([flat, sign * np.sin(half) * out])
        m = solver.measure(net, positions)
        known = np.isfinite(m.fold_angle)
        assert known.sum() >= 7
        assert m.fold_angle[known] == pytest.approx(degrees, abs=1e-5)
        assert set(m.fold_sign[known]) == {sign}, side
        assert m.side(0) == (side[0].upper() if degrees > 1 else "U"), "too flat to have a side"
        assert m.stretch.max() < 1e-12


# --- B: pleated cone ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def cone(exact: ModuleType) -> object:
    return exact.Pleats(np.radians(60), (1.0, 1.25, 1.5, 1.75), 0.75, 2.0, 0.5)


@pytest.mark.parametrize("resolution", [10, 20, 32])
def test_b_is_folded_by_its_constant_angle_with_alternating_sides(cone: object, resolution: int) -> None:
    net = solver.build_net(cone.pattern(), resolution)  # type: ignore[attr-defined]
    m = solver.measure(net, cone.positions(net))  # type: ignore[attr-defined]
    known = np.isfinite(m.fold_angle)
    assert np.abs(m.fold_angle[known] - 60.0).max() < 0.3
    assert m.asked.sum() >= 20
    assert m.folded.all()
    for crease in range(4):
        sides = set(m.fold_sign[known & (m.crease == crease)])
        assert len(sides) == 1
        assert sides == ({-1} if crease % 2 == 0 else {1})


@pytest.mark.parametrize("resolution", [10, 20, 40, 60])
def test_b_has_one_patch_between_neighbouring_circles(cone: object, resolution: int) -> None:
    net = solver.build_net(cone.pattern(), resolution)  # type: ignore[attr-defined]
    assert len(net.patch_polygons) == 5
    assert min(polygon.area for polygon in net.patch_polygons) > 0.1


def test_stretch_and_angles_of_b_converge(cone: object) -> None:
    stretch, dog = [], []
    for resolution in (12, 24, 48):
        net = solver.build_net(cone.pattern(), resolution)  # type: ignore[attr-defined]
        m = solver.measure(net, cone.positions(net))  # type: ignore[attr-defined]
        stretch.append(m.stretch.mean())
        dog.append(m.dog_angle.mean())
    assert np.log2(stretch[0] / stretch[2]) / 2 == pytest.approx(2.0, abs=0.4)
    assert np.log2(dog[0] / dog[2]) / 2 == pytest.approx(2.0, abs=0.4)


# --- H: prisms ------------------------------------------------------------------------------------------

RISES = {
    "dyadic heights": (0.5, 0.5, 0.25, 0.125, -0.25, -0.125, -0.5, -0.25, 0.5, 0.25),
    "any heights": (0.5, 0.43, 0.21, 0.13, -0.21, -0.17, -0.41, -0.23, 0.34, 0.41),
}


@pytest.mark.parametrize("rises", RISES.values(), ids=RISES)
def test_h_is_exact_in_the_discrete_model(exact: ModuleType, rises: tuple[float, ...]) -> None:
    state = exact.Prism(1.25, rises, start=4, height=10)
    net = state.net()
    assert np.ptp(np.diff(net.grid.xs)) < 1e-9
    assert np.ptp(np.diff(net.grid.ys)) < 1e-7
    m = solver.measure(net, state.positions(net))
    assert m.stretch.max() < 1e-12
    assert m.dog_angle.max() < 1e-10
    assert m.continuity.max() < 1e-9
    assert m.asked.sum() >= 5
    assert m.folded.all()


@pytest.mark.parametrize("rises", RISES.values(), ids=RISES)
def test_h_does_not_move(exact: ModuleType, on_the_sheet: ModuleType, rises: tuple[float, ...]) -> None:
    state = exact.Prism(1.25, rises, start=4, height=10)
    net = state.net()
    start = state.positions(net)
    places = np.array([(0, 0), (10, 0), (10, 10), (0, 10), (5, 1), (6.3, 8.2), (3.5, 2)], dtype=float)
    model = solver.FoldModel(net, positions=start, weights=solver.Weights(bending=0))
    model.set_handles(
        [
            solver.Handle(at=tuple(place), target=tuple(target))
            for place, target in zip(places, on_the_sheet.in_space(net, start, places), strict=True)
        ]
    )
    for _ in range(6):
        report = model.advance(10)
        assert np.abs(model.positions - start).max() < 1e-9
    assert report.constraint < 1e-9


def test_the_shown_crease_of_h_lies_in_its_mirror_plane(exact: ModuleType) -> None:
    state = exact.Prism(1.25, RISES["dyadic heights"], start=4, height=10)
    net = state.net()
    shown = net.render_map.apply(state.positions(net))
    on_crease = np.unique(net.render_map.crease_edges)
    # The upright state has X in z and the rulings along y: the plane is y = b z + start.
    gap = shown[on_crease, 1] - 1.25 * shown[on_crease, 2] - 4.0
    assert np.abs(gap).max() < 1e-9


# --- A is found again -----------------------------------------------------------------------------------


def found_again(
    exact: ModuleType, state: object, resolution: int, spacing: int
) -> tuple[solver.PiecewiseDog, np.ndarray, np.ndarray]:
    """A flat sheet drawn by handles every ``spacing`` cells: the net, where it came, where it should."""
    net = solver.build_net(state.pattern(), resolution)  # type: ignore[attr-defined]
    steps = np.linspace(-1, 1, resolution // spacing + 1)
    model = solver.FoldModel(net)
    model.set_handles(
        [solver.Handle(at=(x, y), target=tuple(state.at((x, y)))) for x in steps for y in steps]  # type: ignore[attr-defined]
    )
    settle(model)
    assert model.status is solver.Status.SETTLED
    return net, model.positions, state.positions(net)  # type: ignore[attr-defined]


@pytest.mark.parametrize("b", SINE_ANGLES)
def test_a_is_found_again_from_handles_on_it(exact: ModuleType, on_the_sheet: ModuleType, b: float) -> None:
    state = exact.sine(b)
    gaps = []
    for resolution in (10, 20):
        net, found, true = found_again(exact, state, resolution, 2)
        m = solver.measure(net, found)
        assert m.folded.all()
        known = np.isfinite(m.fold_angle)
        assert set(m.fold_sign[known]) == {1}
        places = on_the_sheet.some_places(net, 150)
        gap = on_the_sheet.in_space(net, found, places) - on_the_sheet.in_space(net, true, places)
        gaps.append(np.linalg.norm(gap, axis=1))
    # No more stretch than a few times what sampling the exact state costs on this grid.
    assert m.stretch.mean() < 4 * solver.measure(net, true).stretch.mean()
    cell = 0.1
    assert gaps[1].max() < 1.5 * cell**2 * (3 / b)
    assert np.log2(gaps[0].mean() / gaps[1].mean()) > 1.5


def test_several_creases_of_a_are_found_again(exact: ModuleType) -> None:
    state = exact.sine(1.5, ((1, -0.5), (1, 0.0), (1, 0.5)), height=0.15)
    net, found, _ = found_again(exact, state, 16, 2)
    m = solver.measure(net, found)
    assert m.folded.all()
    known = np.isfinite(m.fold_angle)
    for crease, side in enumerate((1, -1, 1)):
        assert set(m.fold_sign[known & (m.crease == crease)]) == {side}


def test_the_sheet_of_a_is_covered_by_its_two_patches(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 12)
    low, high = sorted(net.patch_polygons, key=lambda p: p.centroid.y)
    assert low.area == pytest.approx(2.0, abs=1e-4)
    assert high.area == pytest.approx(2.0, abs=1e-4)
    assert shapely.intersection(low, high).area < 1e-9
