"""The corpus: forty fixed seeds fold, what is random is reproducible, and what is called feasible is so."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import solver
from benchmarks.corpus_drags import make_drag, protocol_drag
from benchmarks.corpus_drawings import FAMILIES, make_drawing
from benchmarks.corpus_run import FLAT_AGAIN, Job, do

ROOT = Path(__file__).resolve().parents[2]
#: Two or three small nets of every family, and every kind of drag.
SEEDS = (
    1, 2, 16, 24, 32, 35, 58, 61, 62, 70, 71, 72, 73, 81, 82, 83, 85, 93, 99, 108,
    120, 130, 131, 132, 146, 154, 156, 161, 162, 169, 182, 191, 195, 196, 201, 203, 206, 211, 212, 213,
)  # fmt: skip


@pytest.mark.parametrize("seed", SEEDS)
def test_seed_does_what_it_should(seed: int) -> None:
    run = do(Job(seed))
    assert run.ok, f"{run.family}, {run.drag}: {run.status}, {run.sentence}"
    assert run.status in {"folded", "out of reach"}


def test_the_seeds_cover_every_family_and_drag() -> None:
    drawings = [make_drawing(seed) for seed in SEEDS]
    assert {drawing.family for drawing in drawings} == set(FAMILIES)
    assert len(SEEDS) == 40


@pytest.mark.parametrize("family", range(len(FAMILIES)))
def test_drawings_of_every_family_make_a_net_and_are_the_same_each_time(family: int) -> None:
    for seed in (family, family + 5 * len(FAMILIES)):
        one, two = make_drawing(seed), make_drawing(seed)
        assert np.array_equal(one.pattern.boundary, two.pattern.boundary)
        assert 1 <= len(one.pattern.creases) <= 30
        net = solver.build_net(one.pattern, one.resolution)
        assert len(net.crease_points.position) > 0


def test_drawings_come_in_all_sizes_places_and_shapes() -> None:
    drawings = [make_drawing(seed) for seed in range(150)]
    sizes = [np.ptp(d.pattern.boundary, axis=0).max() for d in drawings]
    assert min(sizes) < 1e-4
    assert max(sizes) > 100
    heights = [d.box.height for d in drawings]
    assert min(heights) < 0.1
    assert max(heights) == pytest.approx(1.0)
    assert any(d.pattern.holes for d in drawings)
    assert any(np.abs(d.pattern.boundary).min() > 20 * np.ptp(d.pattern.boundary, axis=0).max() for d in drawings)
    assert max(len(d.pattern.creases) for d in drawings) >= 20


def test_two_handles_are_feasible_when_nearer_and_not_when_too_far() -> None:
    seen = set()
    for seed in (108, 182, 201, 211, 212):
        drawing = make_drawing(seed)
        drag = make_drag(seed, drawing, solver.build_net(drawing.pattern, drawing.resolution))
        flat = np.linalg.norm(drag.at[0] - drag.at[1])
        asked = np.linalg.norm(drag.targets[0] - drag.targets[1])
        if not drag.feasible:
            assert asked > 1.1 * flat
        elif len(drag.at) == 2:
            assert asked < flat * (1 + 1e-9)
        seen.add((drag.kind, drag.feasible, drag.back))
    assert seen >= {("far", False, False), ("back", True, True), ("lift", True, False)}


def test_a_drag_there_and_back_is_folded_there_and_flat_in_the_end() -> None:
    run = do(Job(61))
    assert run.drag.startswith("back")
    assert run.feasible
    assert run.ok
    assert run.reached
    assert run.status == "folded"
    assert run.folded == 1.0
    assert run.fold_angle[1] > 1.0
    assert run.off_flat is not None
    assert run.off_flat < FLAT_AGAIN


def test_the_protocol_moves_the_two_lower_corners() -> None:
    pattern = solver.CreasePattern(
        [(0, 0), (4, 0), (4, 3), (0, 3)], creases=[solver.Crease([(0, 1), (2, 1.5), (4, 1)])]
    )
    drag = protocol_drag(pattern)
    assert drag.at.tolist() == [[0, 0], [4, 0]]
    assert drag.targets == pytest.approx(np.array([(0.5, 0.375, 1.0), (3.5, 0.375, 1.0)]))


def test_the_command_prints_a_table_and_writes_every_run(tmp_path: Path) -> None:
    drawings = tmp_path / "drawings"
    drawings.mkdir()
    (drawings / "one.svg").write_bytes((ROOT / "sample_patterns" / "strip.svg").read_bytes())
    (drawings / "none.svg").write_text("no drawing", encoding="utf-8")
    out = tmp_path / "runs.json"
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.corpus", "--drawings", str(drawings), "--json", str(out)],
        cwd=ROOT, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 1
    assert "1 refused" in done.stdout
    runs = {run["family"]: run for run in json.loads(out.read_text(encoding="utf-8"))["runs"]}
    assert runs["none"]["status"] == "refused"
    strip = runs["one"]
    assert strip["status"] == "folded"
    assert strip["iterations"] == 24 * 5
    wanted = {"seed", "family", "feasible", "status", "reached", "folded", "fold_angle", "stretch_mean",
              "stretch_max", "dog_angle", "handle_error", "iterations", "seconds"}  # fmt: skip
    assert set(strip) >= wanted
    assert strip["fold_angle"] == sorted(strip["fold_angle"])
