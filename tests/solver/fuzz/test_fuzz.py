"""Hostile input by every door: what is refused is refused by the project's own errors, quickly, in one line."""

from __future__ import annotations

import contextlib
import io
import json
import time
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import solver
from benchmarks.fuzz_inputs import DOORS, RESOLUTION, TRIED_ON, made_fold, made_svg, not_sides, true_fold
from benchmarks.fuzz_run import attempt, scratch
from solver.description import parse_handles
from solver.pattern.fold_file import read_fold

FOLD_KEYS = (
    "vertices_coords", "edges_vertices", "edges_assignment", "edges_foldAngle", "edges_curvefold:crease",
    "faces_vertices", "file_frames", "frame_classes", "frame_inherit", "frame_parent", "frame_unit", "frame_title",
)  # fmt: skip
#: Inputs for each door; ``python -m benchmarks.fuzz`` makes as many as one likes.
FEW = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
ANY_JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=12,
)


@pytest.mark.parametrize("door", DOORS)
@FEW
@given(rng=st.randoms(use_true_random=False))
def test_spoilt_files_are_refused_or_read(door: str, rng: Random) -> None:
    with scratch() as folder:
        attempt(DOORS[door], DOORS[door].make(rng), Path(folder))


@pytest.mark.parametrize("door", DOORS)
@FEW
@given(data=st.binary(max_size=300))
def test_any_bytes_are_refused(door: str, data: bytes) -> None:
    with scratch() as folder:
        attempt(DOORS[door], data, Path(folder))


@FEW
@given(data=ANY_JSON)
def test_any_json_is_a_description_or_handles_or_refused(data: Any) -> None:
    for read in (solver.FoldDescription.from_json, parse_handles):
        with contextlib.suppress(solver.CurvefoldError):
            read(data)


@FEW
@given(data=ANY_JSON, key=st.sampled_from(FOLD_KEYS), kind=st.randoms(use_true_random=False))
def test_any_json_in_a_fold_file_is_refused_or_read(data: Any, key: str, kind: Random) -> None:
    content = {**true_fold(kind), key: data}
    with contextlib.suppress(solver.CurvefoldError):
        read_fold(io.StringIO(json.dumps(content)))


HUGE = 10**400
SIDE = {"kind": "side", "crease": 1, "side": ["M"]}


@pytest.mark.parametrize(
    "data",
    [
        {"handles": [{"at": [HUGE, 0], "target": [0, 0, 0]}]},
        {"handles": [{"at": [0, 0], "target": [0, 0, 0], "strength": HUGE}]},
        {"angle": HUGE},
        {"weights": {"bending": HUGE}},
        {"controls": [{"kind": "amount", "crease": 1, "part": HUGE}]},
        {"controls": [SIDE]},
        {"two\r\nlines": 1},
    ],
)
def test_what_breeding_has_found_is_refused(data: Any) -> None:
    """Whole numbers that no float holds, a list for a word, a name of two lines."""
    with pytest.raises(solver.CurvefoldError) as refused:
        solver.FoldDescription.from_json(data)
    assert len(str(refused.value).splitlines()) == 1


@pytest.mark.parametrize(("strength", "weight"), [(10**40, 10**10), (1, 1)])
def test_weights_and_strengths_are_floats(strength: int, weight: int) -> None:
    """Whole numbers beyond 64 bits make arrays of objects."""
    handle = solver.Handle((0, 0), (0, 0, 0), strength=strength)
    assert type(handle.strength) is type(solver.Weights(bending=weight).bending) is float


def test_a_curve_beyond_all_bounds_is_refused() -> None:
    model = solver.FoldModel(solver.build_net(solver.read_pattern(TRIED_ON), RESOLUTION))
    with pytest.raises(solver.DescriptionError, match="beyond all bounds"):
        model.set_controls([solver.Curve(crease=1, curvature_times=1.5, torsion_plus=1e308)])


def test_a_curve_with_a_point_given_twice_is_a_curve() -> None:
    net = solver.build_net(solver.read_pattern(TRIED_ON), RESOLUTION)
    once = [(0.0, 60.0, 0.0), (80.0, 90.0, 20.0), (160.0, 60.0, 0.0)]
    shapes = []
    for points in (once, [once[0], once[0], once[1], once[2], once[2]]):
        model = solver.FoldModel(net)
        model.set_controls([solver.Curve(crease=1, points=tuple(points))])
        model.advance(3)
        shapes.append(model.positions)
    assert np.array_equal(*shapes)


def test_a_crease_without_length_is_left_out() -> None:
    box = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    point = solver.Crease([(0.5, 0.5), (0.5, 0.5)])
    net = solver.build_net(solver.CreasePattern(box, creases=[point]), RESOLUTION)
    assert "crease 1 is shorter than the snap tolerance and was left out" in net.notes
    assert "no crease is left to fold: the sheet is blank paper and bends by handles" in net.notes


def test_creases_that_all_but_touch_mark_sides_of_faces_only() -> None:
    """Between them a face of the shown surface may vanish."""
    rng = np.random.default_rng(36)
    t = np.linspace(0, 6.2, int(rng.integers(20, 60)))[:, None]
    swing, harmonic = 0.3 * rng.normal(size=(2, 3)), np.arange(1, 4)

    def scribble(shift: float) -> solver.Crease:
        x = (swing[0] * np.sin(harmonic * t + shift)).sum(axis=1)
        y = (swing[1] * np.cos(harmonic * t + shift)).sum(axis=1)
        return solver.Crease(0.5 + np.column_stack([x, y]))

    box = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    gap = rng.choice([1e-3, 5e-3, 2e-2])
    net = solver.build_net(solver.CreasePattern(box, creases=[scribble(0.0), scribble(gap)]), RESOLUTION)
    assert len(net.render_map.crease_edges) > 50
    assert not_sides(net) == []


@pytest.mark.parametrize(("suffix", "make"), [(".svg", made_svg), (".fold", made_fold)])
def test_the_generators_reach_the_net(suffix: str, make: Callable[[Random], bytes]) -> None:
    """A fuzzer whose input is always refused at the first line tests nothing."""
    read, refused = 0, set()
    with scratch() as folder:
        for seed in range(60):
            path = Path(folder) / f"drawing{suffix}"
            path.write_bytes(make(Random(seed)))
            try:
                solver.read_pattern(path)
                read += 1
            except solver.CurvefoldError as error:
                refused.add(type(error))
    assert read >= 10
    assert refused >= {solver.ReadError, solver.PatternError}


def test_a_sheet_on_which_no_grid_line_crosses_another_is_refused() -> None:
    """All grid vertices lie off this zigzag, and were taken for it."""
    right = [(1.0, 0.067), (1.2, 1.179), (1.0, 2.012), (1.2, 3.122), (1.0, 4.161), (1.2, 5.141)]
    left = [(0.0, 0.104), (0.2, 1.015), (0.0, 2.127), (0.2, 3.108), (0.0, 4.187), (0.2, 5.129)]
    creases = [solver.Crease(ends) for ends in list(zip(left, right, strict=True))[1:-1]]
    with pytest.raises(solver.NetError, match="finer resolution"):
        solver.build_net(solver.CreasePattern([*right, *left[::-1]], creases=creases), 6)


BOMB = '<!DOCTYPE svg [<!ENTITY a "{}">{}]><svg xmlns="http://www.w3.org/2000/svg">&z;</svg>'


def test_entities_are_not_expanded(tmp_path: Path) -> None:
    levels = "".join(f'<!ENTITY {chr(98 + k)} "{(f"&{chr(97 + k)};") * 10}">' for k in range(25))
    path = tmp_path / "bomb.svg"
    path.write_text(BOMB.format("a" * 10, levels), encoding="utf-8")
    start = time.process_time()
    with pytest.raises(solver.ReadError, match="entity"):
        solver.read_pattern(path)
    assert time.process_time() - start < 60  # expanded it would never end
