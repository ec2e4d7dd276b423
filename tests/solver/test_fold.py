"""A whole fold: the outcome is what the shape is, and progress is told."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import solver


def test_a_fold_is_a_function_of_its_drawing_and_description(drawings: ModuleType) -> None:
    told = solver.FoldDescription(resolution=9, angle=35.0)
    first, second = (solver.fold(drawings.one_arc(), told) for _ in range(2))
    assert np.array_equal(first.positions, second.positions)
    assert first.iterations == second.iterations
    assert first.status is solver.Outcome.FOLDED
    assert first.status.ok
    m = solver.measure(first.net, first.positions)
    assert m.folded.all()
    assert np.nanmedian(m.fold_angle) > 0.85 * 35


def test_progress_is_told_with_rising_iterations_and_a_rising_angle(drawings: ModuleType) -> None:
    seen: list[tuple[int, float]] = []

    def progress(iterations: int, report: solver.SqpReport) -> None:
        assert report.asked_angle is not None
        seen.append((iterations, report.asked_angle))

    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=8, angle=30.0), progress)
    counts, asked = zip(*seen, strict=True)
    assert list(counts) == sorted(set(counts))
    assert list(asked) == sorted(asked)
    assert counts[-1] == result.iterations
    assert asked[-1] == 30.0


def test_max_iterations_ends_a_fold_with_its_own_outcome(drawings: ModuleType) -> None:
    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=8, angle=80.0, max_iterations=20))
    assert result.iterations == 20
    assert result.status is solver.Outcome.UNSETTLED
    assert "20" in result.detail


def test_nothing_asked_is_no_success(drawings: ModuleType) -> None:
    """Neither handle nor angle: the sheet stays flat, and flat is not folded."""
    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=8, angle=None))
    assert not result.status.ok
    assert np.abs(result.positions[:, 2]).max() < 1e-9


def test_a_crease_that_is_not_folded_is_named_with_its_place(drawings: ModuleType) -> None:
    told = solver.FoldDescription(
        resolution=10,
        angle=None,
        handles=tuple(
            solver.Handle(at=(x, y), target=(x + (0.1 if x == 0 else -0.1), y, 0.2)) for x, y in
            drawings.one_arc().boundary.tolist()
        ),
        weights=solver.Weights(fold_condition=0),
    )  # fmt: skip
    result = solver.fold(drawings.one_arc(), told)
    assert result.status is solver.Outcome.NOT_FOLDED
    assert "crease 1" in result.detail
    assert "(" in result.detail


@pytest.mark.parametrize("letters", ["VM", "MV", "VV", "MM"])
def test_bound_assignments_hold_or_the_fold_says_which_does_not(drawings: ModuleType, letters: str) -> None:
    plain = drawings.two_arcs()
    pattern = solver.CreasePattern(
        boundary=plain.boundary,
        creases=[
            solver.Crease(points=c.points, assignment=letter)
            for c, letter in zip(plain.creases, letters, strict=True)
        ],
    )
    result = solver.fold(pattern, solver.FoldDescription(resolution=9, angle=40.0, assignments="bind"))
    found = "".join(c["found"] for c in result.report()["creases"])
    assert (found == letters) == (result.status is not solver.Outcome.AGAINST_ASSIGNMENT) or not result.status.ok
    assert found == letters


def test_the_summary_says_how_it_went(drawings: ModuleType) -> None:
    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=8, angle=30.0))
    text = result.summary()
    for words in ("vertices", "iterations", "fold angle", "stretch", "100.0%"):
        assert words in text
