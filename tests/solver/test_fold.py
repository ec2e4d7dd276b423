"""A whole fold: the outcome is what the shape is, and progress is told."""

from __future__ import annotations

import sys
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from settling import settle

import solver
from benchmarks.corpus_drags import make_drag
from benchmarks.corpus_drawings import make_drawing
from solver.drive import MAX_MEAN_STRETCH

#: ``solver.fold`` is the function; its module has the same name.
fold_module = sys.modules["solver.fold"]


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


def test_progress_is_told_with_rising_iterations(drawings: ModuleType) -> None:
    seen: list[int] = []

    def progress(iterations: int, report: solver.SqpReport) -> None:
        seen.append(iterations)

    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=8, angle=30.0), progress)
    assert seen == sorted(set(seen))
    assert seen[-1] == result.iterations


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


def test_a_crease_on_neither_side_is_said_to_be_flat_or_to_change(drawings: ModuleType) -> None:
    m = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=8, angle=30.0)).measurement
    assert m.side_in_words(0) == "valley"
    alternating = np.where(np.arange(len(m.fold_sign)) % 2, 1, -1)
    assert replace(m, fold_sign=alternating).side_in_words(0) == "partly valley and partly mountain"
    assert replace(m, fold_angle=np.zeros_like(m.fold_angle)).side_in_words(0) == "flat"
    assert replace(m, fold_angle=np.full_like(m.fold_angle, np.nan)).side_in_words(0) == "flat"


@pytest.mark.parametrize(
    ("drawn", "words"),
    [
        ("VM", ""),  # as it folds
        ("UU", ""),
        ("VV", "not on the side that is drawn: crease 2 ("),
        ("UV", "not on the side that is drawn: crease 2 ("),
        ("MM", "not on the side that is drawn: crease 1 ("),
    ],
)
def test_the_summary_names_the_creases_that_are_not_on_the_side_that_is_drawn(
    drawings: ModuleType, drawn: str, words: str
) -> None:
    plain = drawings.two_arcs()
    creases = [replace(c, assignment=letter) for c, letter in zip(plain.creases, drawn, strict=True)]
    pattern = solver.CreasePattern(plain.boundary, plain.holes, creases)
    text = solver.fold(pattern, solver.FoldDescription(resolution=9, angle=40.0)).summary()
    assert "crease 1 valley, crease 2 mountain" in text
    if words:
        assert words in text
        assert "--assignments bind" in text
    else:
        assert "drawn" not in text


# --- another way ----------------------------------------------------------------------------------------


def test_folded_anew_a_paper_opens_along_its_creases_and_is_then_told_the_same(drawings: ModuleType) -> None:
    pattern = drawings.one_arc()
    net = solver.build_net(pattern, 10)
    model = solver.FoldModel(net)
    low = pattern.boundary[:2]
    model.set_handles([solver.Handle((x, y), (x * 0.9 + 0.05, y, 0.15)) for x, y in low.tolist()])
    settle(model)
    model.fold_anew()
    assert np.abs(model.positions[:, 2]).max() == 0
    medians, errors = [], []
    while model.status is solver.Status.RUNNING:
        report = model.advance(5)
        medians.append(float(np.nanmedian(solver.measure(net, model.positions).fold_angle)))
        errors.append(report.handle_error)
    opened = int(np.argmax(np.array(medians) > 0.9 * 60))
    assert medians[opened] > 0.9 * 60
    assert errors[opened] > 0.02
    assert errors[-1] < 0.1 * errors[opened]
    assert solver.measure(net, model.positions).folded.all()


def test_what_is_stuck_on_the_way_of_its_handles_gets_there_in_another(monkeypatch: pytest.MonkeyPatch) -> None:
    """Corpus seed 44: a star whose handles are moved within the plane of the sheet, at once."""
    drawing = make_drawing(44)
    drag = make_drag(44, drawing, solver.build_net(drawing.pattern, drawing.resolution))
    told = solver.FoldDescription(drawing.resolution, angle=None, handles=tuple(drag.handles(1.0)))
    result = solver.fold(drawing.pattern, told)
    assert result.status is solver.Outcome.FOLDED
    monkeypatch.setattr(fold_module, "_WORTH_ANOTHER_WAY", ())
    stuck = solver.fold(drawing.pattern, told)
    assert not stuck.status.ok
    assert stuck.iterations < result.iterations


def test_drawn_sides_start_the_fold_where_both_are_drawn(drawings: ModuleType) -> None:
    plain = drawings.two_arcs()
    for drawn in ("MV", "VM"):
        creases = [replace(c, assignment=letter) for c, letter in zip(plain.creases, drawn, strict=True)]
        pattern = solver.CreasePattern(plain.boundary, plain.holes, creases)
        m = solver.fold(pattern, solver.FoldDescription(resolution=9, angle=40.0)).measurement
        assert m.side(0) + m.side(1) == drawn


@pytest.mark.parametrize("too_far", [0.1, 0.5, 3.0])
def test_no_handle_stretches_the_paper(drawings: ModuleType, too_far: float) -> None:
    """Two corners pulled apart beyond the paper between them: it stays as long as it is, and folded."""
    pattern = drawings.one_arc()
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    length = float(np.hypot(*(high - low)))
    far = high + too_far * (high - low)
    handles = tuple(solver.Handle(tuple(at), (*to, 0.0)) for at, to in zip((low, high), (low, far), strict=True))
    result = solver.fold(pattern, solver.FoldDescription(12, angle=None, handles=handles))
    assert result.status is solver.Outcome.OUT_OF_REACH
    assert float(result.measurement.stretch.mean()) <= MAX_MEAN_STRETCH
    ends = [weights @ result.positions[vertices] for vertices, weights in map(result.net.locate, (low, high))]
    apart = float(np.linalg.norm(ends[0] - ends[1]))
    # Not slack either: as far apart as the paper lets them be, but for the few edges right at the handles.
    assert 0.97 * length < apart < length + 0.5 * result.net.frame.unit


def test_another_way_that_does_not_arrive_leaves_the_first_shape(
    drawings: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    pattern = drawings.one_arc()
    (x0, y0), (x1, y1) = pattern.boundary.min(axis=0).tolist(), pattern.boundary.max(axis=0).tolist()
    handles = (solver.Handle((x0, y0), (x0, y0, 0)), solver.Handle((x1, y1), (x1 + 0.5, y1 + 0.5, 0)))
    told = solver.FoldDescription(8, angle=None, handles=handles)
    first = solver.fold(pattern, told)
    assert first.status is solver.Outcome.OUT_OF_REACH
    monkeypatch.setattr(fold_module, "_too_far_apart", lambda handles, net: "")
    both = solver.fold(pattern, told)
    assert both.iterations > first.iterations
    assert np.array_equal(both.positions, first.positions)
