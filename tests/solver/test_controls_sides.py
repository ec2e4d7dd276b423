"""Mountains and valleys: held, flipped, locked, and contradictory ones told in words."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType

import numpy as np
import pytest
from settling import settled

import solver
from solver.controls.side import Side


def lifted(pattern: solver.CreasePattern) -> list[solver.Handle]:
    """The corners moved inwards and up: this makes a mountain of a lone arc."""
    return [
        solver.Handle(at=(x, y), target=(x + (0.1 if x < 0.5 else -0.1), y, 0.2))
        for x, y in pattern.boundary.tolist()
    ]


def assigned(pattern: solver.CreasePattern, letters: Sequence[str]) -> solver.CreasePattern:
    return solver.CreasePattern(
        boundary=pattern.boundary,
        creases=[
            solver.Crease(points=c.points, assignment=letter)
            for c, letter in zip(pattern.creases, letters, strict=True)
        ],
    )


@pytest.mark.parametrize("name", ["two_arcs", "off_centre"])
@pytest.mark.parametrize("letters", ["VV", "VM", "MV", "MM"])
def test_any_two_sides_hold_while_handles_pull_one_way(drawings: ModuleType, name: str, letters: str) -> None:
    pattern = getattr(drawings, name)()
    model = solver.FoldModel(solver.build_net(pattern, 12))
    model.set_handles(lifted(pattern))
    model.set_assignments(letters)
    m = settled(model)
    assert "".join(model.found_assignments) == letters
    assert m.folded.all()
    assert not model.findings


def test_a_side_holds_where_a_start_would_not(drawings: ModuleType) -> None:
    """The handles alone make a mountain of the arc."""
    pattern = drawings.one_arc()
    free, bound = (solver.FoldModel(solver.build_net(pattern, 12)) for _ in range(2))
    for model in (free, bound):
        model.set_handles(lifted(pattern))
    bound.set_assignments(["V"])
    settled(free)
    settled(bound)
    assert free.found_assignments == ("M",)
    assert bound.found_assignments == ("V",)


@pytest.mark.parametrize("degrees", [40.0, 100.0])
def test_a_folded_crease_flips_and_folds_as_deep_on_the_other_side(drawings: ModuleType, degrees: float) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 12))
    model.set_fold_angle(degrees)
    before = settled(model)
    (letter,) = model.found_assignments
    model.set_assignments(["M" if letter == "V" else "V"])
    # On its way nothing holds it where it was.
    assert model.advance(5).objective["fold angle"] == 0.0
    after = settled(model)
    assert model.advance(0).objective["fold angle"] > 0.0
    assert model.found_assignments != (letter,)
    assert np.nanmedian(after.fold_angle) == pytest.approx(np.nanmedian(before.fold_angle), rel=0.03)
    assert after.folded.all()
    assert after.stretch.mean() < 0.002


def test_what_was_found_can_be_locked(drawings: ModuleType) -> None:
    pattern = drawings.two_arcs()
    model = solver.FoldModel(solver.build_net(pattern, 12))
    model.set_fold_angle(40)
    settled(model)
    found = model.found_assignments
    assert set(found) <= {"M", "V"}
    model.set_assignments(found)
    model.set_fold_angle(None)
    model.set_handles(lifted(pattern))
    settled(model)
    assert model.found_assignments == found


def test_sides_that_handles_contradict_are_named_and_nothing_jams(exact: ModuleType) -> None:
    """Handles on an exact state of a valley and a mountain, asked for two valleys."""
    state = exact.sine(1.5, ((1, -0.4), (1, 0.4)))
    net = solver.build_net(state.pattern(), 10)
    model = solver.FoldModel(net)
    places = [(x, y) for x in np.linspace(-1, 1, 21) for y in np.linspace(-1, 1, 21)]
    model.set_handles([solver.Handle(at=p, target=tuple(state.at(p)), strength=20.0) for p in places])
    settled(model)
    first, second = model.found_assignments
    assert first != second
    model.set_assignments([first, first])
    m = settled(model)
    assert model.found_assignments == (first, second)
    (finding,) = model.findings
    assert finding.sentence.startswith("crease 2 was to be a")
    assert "crease 1 around the same patch held" in finding.sentence
    # Given up, it does no harm: the paper is what the handles make of it.
    assert m.stretch.mean() < 0.006


def test_bound_assignments_that_fail_are_the_outcome_of_a_fold(exact: ModuleType) -> None:
    state = exact.sine(1.5, ((1, -0.4), (1, 0.4)))
    pattern = assigned(state.pattern(), "VV")
    places = [(x, y) for x in np.linspace(-1, 1, 21) for y in np.linspace(-1, 1, 21)]
    told = solver.FoldDescription(
        resolution=10,
        angle=None,
        handles=tuple(solver.Handle(at=p, target=tuple(state.at(p)), strength=20.0) for p in places),
        assignments="bind",
    )
    result = solver.fold(pattern, told)
    assert result.status is solver.Outcome.AGAINST_ASSIGNMENT
    assert "crease 2 was to be a valley but is a mountain" in result.detail


def test_a_side_of_its_own_goes_before_the_drawing(drawings: ModuleType) -> None:
    pattern = assigned(drawings.two_arcs(), "VM")
    told = solver.FoldDescription(resolution=9, angle=40.0, assignments="bind", controls=(Side(2, "V"),))
    result = solver.fold(pattern, told)
    assert [crease["found"] for crease in result.report()["creases"]] == ["V", "V"]
    assert result.status.ok
