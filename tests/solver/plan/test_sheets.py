"""What of a drawing, and of its fold, becomes which line of the plan."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import solver
from solver.errors import PatternError, ReadError
from solver.plan.data import CREASES, Kind, Plan
from solver.plan.pieces import Arc
from solver.plan.sheet import make_plan
from solver.plan.source import FoldAngles, PlanSource, of_pattern, read_plan_source

SQUARE = [(0, 0), (100, 0), (100, 100), (0, 100)]


def flat(pattern: solver.CreasePattern, *angles: tuple[float, float, float]) -> Plan:
    """angles: x, y, degrees."""
    rows = np.array(angles, dtype=float).reshape(-1, 3)
    return make_plan(PlanSource(pattern, FoldAngles(rows[:, :2], rows[:, 2])))


def creases(plan: Plan) -> list[tuple[str, str, float]]:
    return [(stroke.kind.value, stroke.name, round(stroke.walk.length, 3)) for stroke in plan.having(*CREASES)]


def square(*lines: solver.Crease, unit_mm: float | None = 1.0) -> solver.CreasePattern:
    return solver.CreasePattern(SQUARE, (), lines, "square", unit_mm)


def test_a_drawing_alone_says_which_sides_are_drawn() -> None:
    pattern = square(
        solver.Crease([(0, 20), (100, 20)], assignment="M"),
        solver.Crease([(0, 50), (100, 50)], assignment="V"),
        solver.Crease([(0, 80), (100, 80)], assignment="U"),
    )
    plan = make_plan(of_pattern(pattern))
    assert [kind for kind, _, _ in creases(plan)] == ["mountain", "valley", "flat"]
    assert not plan.folded
    (border,) = plan.having(Kind.BORDER)
    assert border.walk.closed
    assert border.walk.length == 400.0


def test_lengths_are_millimetres() -> None:
    plan = make_plan(of_pattern(square(solver.Crease([(0, 50), (100, 50)]), unit_mm=25.4)))
    assert (plan.width, plan.height) == pytest.approx((2540.0, 2540.0))
    assert creases(plan) == [("flat", "crease 1", 2540.0)]
    unknown = make_plan(of_pattern(square(unit_mm=None)))
    assert unknown.width == 100.0
    assert "the drawing gives no unit, so that one is taken for 1 mm" in unknown.notes


def test_creases_end_at_the_paper() -> None:
    hole = [(40, 40), (60, 40), (60, 60), (40, 60)]
    pattern = solver.CreasePattern(SQUARE, [hole], [solver.Crease([(-30, 50), (130, 50)])], "holed", 1.0)
    assert creases(make_plan(of_pattern(pattern))) == [("flat", "crease 1", 40.0)] * 2


def test_a_crease_along_the_border_is_none() -> None:
    assert creases(make_plan(of_pattern(square(solver.Crease([(0, 0), (100, 0)]))))) == []


def test_a_fold_says_which_side_each_part_folds_to() -> None:
    pattern = square(
        solver.Crease([(0, 50), (100, 50)], assignment="M"), solver.Crease([(30, 0), (30, 100)], assignment="M")
    )
    plan = flat(pattern, (15, 50, 60), (65, 50, 55), (30, 25, 40), (30, 75, -40))
    assert creases(plan) == [
        ("valley", "crease 1", 100.0),
        ("valley", "crease 2", 50.0),
        ("mountain", "crease 2", 50.0),
    ]
    assert plan.folded
    whole = plan.having(*CREASES)[0]
    assert whole.vertices == pytest.approx((30.0,))
    assert whole.angles == ((pytest.approx(15.0), 60.0), (pytest.approx(65.0), 55.0))


def test_what_hardly_folds_is_flat_and_what_is_not_known_is_as_beside_it_or_as_drawn() -> None:
    pattern = square(
        solver.Crease([(0, 50), (100, 50)], assignment="M"),
        solver.Crease([(30, 0), (30, 100)], assignment="V"),
        solver.Crease([(70, 0), (70, 100)], assignment="M"),
    )
    plan = flat(pattern, (15, 50, 0.01), (50, 50, 0.02), (85, 50, 0.01), (30, 25, -50))
    assert creases(plan) == [
        ("flat", "crease 1", 100.0),
        ("mountain", "crease 2", 100.0),
        ("mountain", "crease 3", 100.0),
    ]


def test_a_loop_is_cut_where_it_crosses_itself() -> None:
    (crease,) = make_plan(read_plan_source("sample_patterns/loop.svg")).having(*CREASES)
    assert len(crease.vertices) == 2
    first, second = (crease.walk.at(length) for length in crease.vertices)
    assert first == pytest.approx(second, abs=1e-2)


def test_a_hairpin_meets_the_crease_across_it_twice() -> None:
    pin, across = make_plan(read_plan_source("sample_patterns/hairpin.svg")).having(*CREASES)
    assert len(pin.vertices) == len(across.vertices) == 2
    for stroke, other in ((pin, across), (across, pin)):
        places = [stroke.walk.at(length) for length in stroke.vertices]
        others = [other.walk.at(length) for length in other.vertices]
        assert all(min(abs(place - there) for there in others) < 1e-2 for place in places)


def test_a_crease_that_ends_on_another_makes_a_vertex_of_it() -> None:
    pattern = square(solver.Crease([(0, 50), (100, 50)]), solver.Crease([(40, 50.1), (40, 100)]))
    first, second = make_plan(of_pattern(pattern)).having(*CREASES)
    assert first.vertices == pytest.approx((40.0,))
    assert second.vertices == ()


def test_a_closed_crease_that_others_cross_has_a_vertex_at_each_place() -> None:
    t = np.linspace(0.0, 2 * math.pi, 240)[:-1]
    ring = solver.Crease(np.column_stack([50 + 30 * np.cos(t), 50 + 30 * np.sin(t)]), True)
    pattern = square(ring, solver.Crease([(0, 50), (100, 50)]))
    plan = flat(pattern, (50, 80, 50), (50, 20, -50), (50, 50, 20), (10, 50, 20), (90, 50, 20))
    assert [(kind, name) for kind, name, _ in creases(plan)] == [
        ("valley", "crease 1"),
        ("mountain", "crease 1"),
        ("valley", "crease 2"),
    ]
    halves = plan.having(*CREASES)[:2]
    assert [stroke.walk.length for stroke in halves] == pytest.approx([30 * math.pi] * 2, rel=1e-4)
    same = flat(pattern, (50, 80, 50), (50, 20, 50), (50, 50, 20), (10, 50, 20), (90, 50, 20))
    whole = same.having(*CREASES)[0]
    assert whole.walk.closed
    assert len(whole.vertices) == 2
    assert isinstance(whole.walk.pieces[0], Arc)


def test_sheets_that_cannot_be_made_are_refused() -> None:
    with pytest.raises(PatternError, match="too small to be made"):
        make_plan(of_pattern(square(unit_mm=1e-6)))
    bow = solver.CreasePattern([(0, 0), (100, 100), (100, 0), (0, 50)], (), (), "bow", 1.0)
    with pytest.raises(PatternError, match="cross each other"):
        make_plan(of_pattern(bow))


@pytest.fixture(scope="module")
def folded(tmp_path_factory: pytest.TempPathFactory) -> tuple[solver.FoldResult, Path]:
    """Two arcs with a handle and joined points, folded coarsely, and the folder of its results."""
    pattern = solver.read_pattern("sample_patterns/lens.svg")
    description = solver.FoldDescription(
        resolution=12, angle=50.0, controls=(solver.Pair((0.0, 0.0), (210.0, 0.0), distance=200.0),)
    )
    result = solver.fold(pattern, description)
    folder = tmp_path_factory.mktemp("folded")
    solver.write_results(result, folder, with_rulings=True)
    return result, folder


def test_a_folded_file_and_its_folder_are_the_plan_of_the_fold(folded: tuple[solver.FoldResult, Path]) -> None:
    result, folder = folded
    wanted = make_plan(solver.plan_source(result, with_rulings=True))
    file, whole = (make_plan(read_plan_source(path)) for path in (folder / "folded.fold", folder))
    for found in (file, whole):
        assert found.folded
        assert [kind for kind, _, _ in creases(found)] == ["valley", "valley"]
        # Curves again from the edges of a mesh: arcs of the drawing's radius.
        for crease in found.having(*CREASES):
            (piece,) = crease.walk.pieces
            assert isinstance(piece, Arc)
            assert piece.radius == pytest.approx(190.0, abs=0.05)
    assert whole.name == "lens"
    assert len(whole.having(Kind.MARK)) == len(wanted.having(Kind.MARK)) == 2
    rulings = [plan.having(Kind.RULING) for plan in (whole, wanted)]
    assert len(rulings[0]) == len(rulings[1]) > 10
    middles = [np.array([one.walk.at(0.5 * one.walk.length) for one in some]) for some in rulings]
    assert np.abs(middles[0][:, None] - middles[1][None, :]).min(axis=1).max() < 1e-3
    assert not file.having(Kind.MARK, Kind.RULING)


def test_a_folder_without_results_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"has no folded\.fold"):
        read_plan_source(tmp_path)
    (tmp_path / "folded.fold").write_text("{}")
    with pytest.raises(ReadError, match=r"has no report\.json"):
        read_plan_source(tmp_path)


def test_a_report_that_is_none_is_refused(folded: tuple[solver.FoldResult, Path], tmp_path: Path) -> None:
    for name in ("folded.fold", "report.json"):
        (tmp_path / name).write_bytes((folded[1] / name).read_bytes())
    for text in ("", "[]", '{"drawing": "x"}', '{"drawing": "x", "description": 3}'):
        (tmp_path / "report.json").write_text(text)
        with pytest.raises(solver.CurvefoldError, match=r"report\.json"):
            read_plan_source(tmp_path)


def test_a_sheet_that_lies_flat_is_as_it_is_drawn() -> None:
    plan = flat(square(solver.Crease([(0, 50), (100, 50)], assignment="M")), (20, 50, 0.01), (60, 50, -0.02))
    assert creases(plan) == [("mountain", "crease 1", 100.0)]
    assert not plan.folded
    assert "the sheet lies flat" in plan.notes[-1]
