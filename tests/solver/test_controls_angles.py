"""Fold angles: asked at points, along creases, signed, in parts of the drive, and more than any sheet gives."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from settling import settled

import solver
from solver.controls.amount import Amount
from solver.controls.angle import Angle


def medians(m: solver.Measurement) -> list[float]:
    return [float(np.nanmedian(m.fold_angle[m.crease == k])) for k in range(int(m.crease.max()) + 1)]


def distances(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[:, None] - points[None], axis=2)


def test_b_is_reached_from_flat_by_its_angles_alone(exact: ModuleType, on_the_sheet: ModuleType) -> None:
    cone = exact.Pleats(np.radians(60), (1.0, 1.25, 1.5, 1.75), 0.75, 2.0, 0.5)
    gaps = []
    for resolution in (12, 24):
        net = solver.build_net(cone.pattern(), resolution)
        model = solver.FoldModel(net)
        model.set_controls([Angle(60.0, crease=k) for k in (1, 2, 3, 4)])
        m = settled(model)
        assert medians(m) == pytest.approx([60.0] * 4, abs=0.5)
        assert m.folded.all()
        places = on_the_sheet.some_places(net, 60)
        found, true = (on_the_sheet.in_space(net, x, places) for x in (model.positions, cone.positions(net)))
        gaps.append(np.abs(distances(found) - distances(true)).max())
    # The sheet is about two units wide.
    assert gaps[0] < 0.008
    assert gaps[1] < 0.003


@pytest.mark.parametrize(("curve", "b", "low"), [("sine", 3.0, -1.0), ("arc", 1.5, -1.3)])
def test_a_is_folded_as_deep_as_it_is_at_the_points_that_were_asked(
    exact: ModuleType, curve: str, b: float, low: float
) -> None:
    """Measured angles, not those of the term's own chords, which differ by up to nine degrees here."""
    state = getattr(exact, curve)(b)
    net = solver.build_net(state.pattern(low=low, high=low + 2), 12)
    model = solver.FoldModel(net)
    inner = np.flatnonzero(~net.crease_points.end & np.isfinite(net.crease_points.cos2))
    places = net.frame.to_drawing(net.crease_points.position[inner])[1:-1:2]
    asked = state.fold_angle(places[:, 0])
    model.set_controls([Angle(float(a), at=tuple(p)) for a, p in zip(asked, places.tolist(), strict=True)])
    m = settled(model)
    assert not model.findings
    nearest = [int(np.argmin(np.hypot(*(m.crease_position - p).T))) for p in places]
    assert m.fold_angle[nearest] == pytest.approx(asked, abs=1.5)
    assert m.folded.all()
    assert m.stretch.mean() < 0.002


@pytest.mark.parametrize("degrees", [-50.0, 50.0])
def test_a_signed_angle_chooses_the_side_and_takes_a_folded_crease_through_flat(
    drawings: ModuleType, degrees: float
) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 12))
    side = "V" if degrees > 0 else "M"
    model.set_controls([Angle(degrees, crease=1, signed=True)])
    m = settled(model)
    assert model.found_assignments == (side,)
    assert medians(m) == pytest.approx([50.0], abs=0.5)
    model.set_controls([Angle(-degrees, crease=1, signed=True)])
    m = settled(model)
    assert model.found_assignments == ("M" if side == "V" else "V",)
    assert medians(m) == pytest.approx([50.0], abs=0.5)
    assert m.folded.all()


def test_an_angle_ramps_from_the_present_one(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 10))
    model.set_controls([Angle(50.0, crease=1)])
    settled(model)
    model.set_controls([Angle(30.0, crease=1)])
    seen = []
    while model.status is solver.Status.RUNNING:
        model.advance(5)
        seen.append(medians(solver.measure(model.net, model.positions))[0])
    # No jump to flat and back: it comes down and stays.
    assert min(seen) > 28
    assert seen[0] > 44
    assert seen[-1] == pytest.approx(30.0, abs=0.5)


def test_one_point_is_folded_and_the_rest_of_the_crease_follows(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
    model.set_controls([Angle(70.0, at=(0.5, 0.35))])
    m = settled(model)
    here = int(np.argmin(np.hypot(*(m.crease_position - (0.5, 0.35)).T)))
    assert m.fold_angle[here] == pytest.approx(70.0, abs=1.5)
    assert m.folded.all()
    assert not model.findings


@pytest.mark.parametrize("part", [0.5, 1.5])
def test_an_amount_takes_one_crease_another_part_of_the_way(drawings: ModuleType, part: float) -> None:
    model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
    model.set_controls([Amount(1, part)])
    model.set_fold_angle(50)
    one, other = medians(settled(model))
    assert one / other == pytest.approx(part, rel=0.05)
    assert 0.5 * (one / part + other) == pytest.approx(50.0, rel=0.03)
    model.set_controls([])
    assert medians(settled(model)) == pytest.approx([50.0, 50.0], rel=0.03)


def test_an_angle_of_its_own_goes_before_the_drive(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
    model.set_controls([Angle(20.0, crease=1), Angle(20.0, crease=2)])
    model.set_fold_angle(60)
    assert medians(settled(model)) == pytest.approx([20.0, 20.0], rel=0.04)
    # The drive does not even pull.
    assert model.advance(0).objective["fold angle"] == 0.0
    model.set_controls([Angle(20.0, crease=2)])
    assert medians(settled(model)) == pytest.approx([60.0, 20.0], rel=0.04)


def test_angles_that_no_sheet_has_are_said_with_their_place_and_tear_nothing(drawings: ModuleType) -> None:
    """Opposite ends of one closed crease cannot be shut and flat."""
    told = solver.FoldDescription(resolution=10, angle=None, controls=(Angle(150.0, crease=1),))
    result = solver.fold(drawings.closed_circle(), told)
    assert result.status is solver.Outcome.SHALLOW
    assert "crease 1 came to" in result.detail
    assert "150° were asked" in result.detail
    assert "(" in result.detail
    assert solver.measure(result.net, result.positions).stretch.mean() < 0.005
