"""The resolution that follows the drawing: fine where it is fine, and never over the vertices that may be used."""

from __future__ import annotations

import cProfile
import io
import json
import pstats
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import solver
from benchmarks.corpus_drawings import make_drawing
from solver.command_line import main
from solver.net.layout import draw, lay_out
from solver.net.resolution import LEAST_QUADS, estimated_vertices

SAMPLES = Path(__file__).resolve().parents[3] / "sample_patterns"
#: Corpus drawings of all families, and some that need more than a small budget.
SEEDS = (1, 2, 6, 9, 42, 96, 114, 168, 339, 575)


def stripes(count: int, low: float = 0.0, high: float = 1.0) -> solver.CreasePattern:
    """A unit square with creases across it, evenly spaced between two heights."""
    heights = np.linspace(low, high, count + 2)[1:-1]
    box = [(0, 0), (1, 0), (1, 1), (0, 1)]
    return solver.CreasePattern(box, creases=[solver.Crease([(0, y), (0.5, y), (1, y)]) for y in heights])


def long_strip() -> solver.CreasePattern:
    """Twenty times as long as wide, with an arc at every width."""
    t = np.linspace(0, 1, 25)
    arcs = [np.column_stack([10 * k + 8 * t * (1 - t), 10 * t]) for k in range(1, 20)]
    return solver.CreasePattern([(0, 0), (200, 0), (200, 10), (0, 10)], creases=[solver.Crease(a) for a in arcs])


def tessellation(n: int = 22) -> solver.CreasePattern:
    """About 2 n² short creases that meet at zigzag vertices."""
    places = {
        (i, j): (i / n, (j + 0.3 * (i % 2) if 0 < j < n else j) / n) for i in range(n + 1) for j in range(n + 1)
    }
    across = [((i, j), (i + 1, j)) for i in range(n) for j in range(1, n)]
    upwards = [((i, j), (i, j + 1)) for i in range(1, n) for j in range(n)]
    creases = [solver.Crease([places[a], places[b]]) for a, b in across + upwards]
    return solver.CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], creases=creases)


def test_a_plain_drawing_gets_the_least_that_looks_smooth(drawings: ModuleType) -> None:
    assert solver.choose_resolution(drawings.one_arc()).quads == LEAST_QUADS
    net = solver.build_net(drawings.one_arc())
    assert net.resolution == LEAST_QUADS
    assert np.array_equal(net.rest, solver.build_net(drawings.one_arc(), LEAST_QUADS).rest)
    assert net.notes == (solver.choose_resolution(drawings.one_arc()).sentence,)
    assert solver.build_net(drawings.one_arc(), LEAST_QUADS).notes == ()


def test_four_cells_fit_across_a_typical_piece() -> None:
    chosen = solver.choose_resolution(stripes(9))
    assert chosen.quads == pytest.approx(40, abs=1)
    assert "4 cells" in chosen.sentence
    assert "0.1 wide" in chosen.sentence


def test_two_cells_fit_between_creases_that_run_side_by_side() -> None:
    pair = stripes(2, 0.47, 0.53)  # a piece 0.02 wide between two of 0.49
    chosen = solver.choose_resolution(pair, 100_000)
    assert chosen.quads == pytest.approx(100, abs=2)
    assert "2 cells" in chosen.sentence
    assert "0.02 wide" in chosen.sentence


def test_a_few_slivers_and_small_triangles_ask_for_nothing() -> None:
    """Three creases that nearly meet in a point, and a piece that tapers to one."""
    box = [(0, 0), (1, 0), (1, 1), (0, 1)]
    star = [[(0, 0.5), (1, 0.5)], [(0.1, 0), (0.91, 1)], [(0.9, 0), (0.1, 1)]]
    assert (
        solver.choose_resolution(solver.CreasePattern(box, creases=[*map(solver.Crease, star)])).quads
        == LEAST_QUADS
    )
    fan = [[(0, 0), (1, y)] for y in (0.3, 0.6, 1.0)]
    chosen = solver.choose_resolution(solver.CreasePattern(box, creases=[*map(solver.Crease, fan)]))
    assert chosen.quads <= 1.5 * LEAST_QUADS


def test_paper_beside_creases_that_end_in_it_counts() -> None:
    """One long spiral leaves one piece of paper, which is narrow all the same."""
    t = np.linspace(0, 1, 400)
    spiral = 0.5 + (0.02 + 0.45 * t)[:, None] * np.column_stack([np.cos(80 * t), np.sin(80 * t)])
    box = [(0, 0), (1, 0), (1, 1), (0, 1)]
    assert solver.choose_resolution(solver.CreasePattern(box, creases=[solver.Crease(spiral)])).quads > 40


@pytest.mark.parametrize("budget", [500, 2000])
@pytest.mark.parametrize("seed", SEEDS)
def test_no_more_vertices_are_used_than_may_be(seed: int, budget: int) -> None:
    pattern = make_drawing(seed).pattern
    net = solver.build_net(pattern, "auto", budget)
    assert len(net.rest) <= budget
    chosen = solver.choose_resolution(pattern, budget)
    assert net.resolution == chosen.quads
    if "allow" in chosen.sentence:
        assert "would be needed" in chosen.sentence


def test_what_the_budget_allows_is_used() -> None:
    chosen = solver.choose_resolution(tessellation(), 6000)
    count = len(solver.build_net(tessellation(), chosen.quads).rest)
    assert 0.8 * 6000 < count <= 6000
    assert "6,000 vertices" in chosen.sentence


def test_vertices_are_estimated_to_within_15_per_cent() -> None:
    patterns = [solver.read_pattern(path) for path in sorted(SAMPLES.glob("*.svg"))[::2]]
    for pattern in [*patterns, tessellation(8), long_strip(), stripes(9)]:
        arrangement = draw(pattern, 48, rough=True).arrangement
        count = len(lay_out(pattern, 60).topology.vertex_grid)
        assert estimated_vertices(arrangement, 60 / 48) == pytest.approx(count, rel=0.15), pattern.name


def test_a_drawing_that_no_budget_holds_gets_its_fewest_quads_and_is_told() -> None:
    net = solver.build_net(tessellation(), "auto", 300)
    assert len(net.rest) > 300
    with pytest.raises(solver.NetError):
        solver.build_net(tessellation(), net.resolution - 1)
    assert any(f"cannot have fewer quads, which need {len(net.rest):,} vertices" in note for note in net.notes)


def test_budgets_are_numbers_of_vertices() -> None:
    for bad in (99, 100_001, 500.0, "auto"):
        with pytest.raises(solver.NetError, match="from 100 to 100,000"):
            solver.choose_resolution(stripes(1), bad)  # type: ignore[arg-type]


@pytest.mark.parametrize("length", [5.0, 100.0, 900.0])
def test_a_narrow_sheet_gets_a_number_that_works(length: float) -> None:
    box = [(0, 0), (length, 0), (length, 1), (0, 1)]
    cut = solver.Crease([(0.4 * length, 0), (0.4 * length + 0.2, 0.5), (0.4 * length, 1)])
    assert solver.build_net(solver.CreasePattern(box)).resolution >= length
    net = solver.build_net(solver.CreasePattern(box, creases=[cut]))
    assert net.resolution >= length
    if length < 250:  # a longer one has fewer than four of the 1,000 quads across
        assert len(net.patch_polygons) == 2


def test_a_thin_ring_gets_cells_across(drawings: ModuleType) -> None:
    t = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    unit = np.column_stack([np.cos(t), np.sin(t)])
    assert solver.choose_resolution(solver.CreasePattern(unit, [0.9 * unit[::-1]])).quads >= 75


def test_a_drawing_of_a_thousand_creases_is_measured_in_steps_in_proportion() -> None:
    def calls(pattern: solver.CreasePattern) -> int:
        profile = cProfile.Profile()
        profile.runcall(solver.choose_resolution, pattern, 100_000)
        return int(pstats.Stats(profile).total_calls)

    few, many = tessellation(12), tessellation()
    assert len(many.creases) > 900
    assert calls(many) / calls(few) < 2.0 * len(many.creases) / len(few.creases)


def test_a_long_strip_with_twenty_arcs_folds_at_the_default(tmp_path: Path) -> None:
    result = solver.fold(long_strip())
    assert result.status is solver.Outcome.FOLDED
    assert np.nanmedian(result.measurement.fold_angle) == pytest.approx(60, abs=2)
    assert result.report()["resolution"] == result.net.resolution >= 80


def test_the_command_line_takes_numbers_auto_and_a_budget(tmp_path: Path) -> None:
    drawing = SAMPLES / "one_arc.svg"

    def used(*options: str) -> tuple[int, int]:
        out = tmp_path / "out"
        assert main(["fold", str(drawing), "--out", str(out), "--angle", "5", *options], io.StringIO()) == 0
        report = json.loads((out / "report.json").read_text(encoding="utf-8"))
        return report["resolution"], report["vertices"]

    assert used() == used("--resolution", "auto")
    assert used("--resolution", "9")[0] == 9
    quads, vertices = used("--vertices", "200")
    assert quads < LEAST_QUADS
    assert vertices <= 200
    with pytest.raises(SystemExit):
        used("--resolution", "many")
