"""The compiled kernel: when it is used and when not, and that no broken plan gets as far as a pointer.

What it computes is tested with the direct solver, in test_linear_system.
"""

from __future__ import annotations

import ctypes
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.linear_system import diamond_pattern, dominant_values
from solver.errors import NotPositiveDefiniteError
from solver.optimize import kernel
from solver.optimize.kernel import linear_algebra
from solver.optimize.linear_system import LinearSystem
from solver.optimize.multifrontal import compiled, library
from solver.optimize.multifrontal.compiled import CompiledFactorization
from solver.optimize.multifrontal.library import KernelUnavailableError, Library
from solver.optimize.multifrontal.ordering import dissect, vertex_graph
from solver.optimize.multifrontal.plan import BrokenPlanError, KernelPlan, check, lay_out
from solver.optimize.multifrontal.symbolic import Symbolic, analyse

#: Vertices along a side of the grid that plans are made for: large enough for two lanes and a top.
SIDE = 16


def symbolic_of(rows: np.ndarray, cols: np.ndarray, plane: np.ndarray) -> Symbolic:
    graph = vertex_graph(rows // 3, cols // 3, len(plane))
    return analyse(graph, dissect(graph, plane))


@pytest.fixture
def plan() -> KernelPlan:
    rows, cols, plane = diamond_pattern(SIDE)
    return lay_out(symbolic_of(rows, cols, plane), rows, cols)


@pytest.fixture
def fresh(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """What was found out about the kernel in this process is forgotten, now and after the test."""
    monkeypatch.setattr(kernel, "linear_algebra", kernel.linear_algebra.__wrapped__)
    return monkeypatch


# --- whether it is used -----------------------------------------------------------------------------------


def test_the_switch_in_the_environment_leaves_numpy_and_says_so(fresh: pytest.MonkeyPatch) -> None:
    fresh.setenv(kernel.SWITCH, "0")
    found = kernel.linear_algebra()
    assert found.library is None
    assert found.phrase == "numpy and scipy; the compiled kernel is switched off by CURVEFOLD_KERNEL=0"


def test_a_missing_kernel_leaves_numpy_and_says_so(fresh: pytest.MonkeyPatch) -> None:
    fresh.setattr(kernel, "PACKAGE", "curvefold_kernel_that_nobody_installs")
    fresh.delenv(kernel.SWITCH, raising=False)
    assert kernel.linear_algebra().phrase == "numpy and scipy; the compiled kernel is not installed"


def test_a_file_that_is_no_library_leaves_numpy_and_says_so(fresh: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fresh.delenv(kernel.SWITCH, raising=False)
    fresh.setattr(kernel, "_library_file", lambda: tmp_path / "kernel.so")
    (tmp_path / "kernel.so").write_bytes(b"no library")
    found = kernel.linear_algebra()
    assert found.library is None
    assert found.phrase.startswith("numpy and scipy; the compiled kernel cannot be loaded")


def test_a_kernel_that_works_is_named_with_its_instructions(kernel_library: Library) -> None:
    assert kernel_library.instructions in ("AVX2", "AVX-512", "NEON")
    assert linear_algebra().phrase == f"compiled kernel, {kernel_library.instructions}"
    rows, cols, plane = diamond_pattern(3)
    assert LinearSystem(rows, cols, plane).backend == "kernel"


def _stand_in(layout: list[int], level: int) -> SimpleNamespace:
    """A library that says this of itself, and must not be asked for more."""

    def say_layout(said: ctypes.Array[ctypes.c_int64]) -> None:
        said[:] = layout

    def refuse(*_: object) -> None:
        raise AssertionError("a kernel that cannot be used was called")

    return SimpleNamespace(
        curvefold_layout=say_layout,
        curvefold_level=lambda: level,
        curvefold_factor=lambda *a: refuse(*a),
        curvefold_forward=lambda *a: refuse(*a),
        curvefold_backward=lambda *a: refuse(*a),
    )


_RIGHT = [library.ABI, 16 * 8, 3 * 4, 11 * 8]


@pytest.mark.parametrize(
    ("layout", "level", "why"),
    [
        ([library.ABI + 1, *_RIGHT[1:]], 1, "another version"),
        ([library.ABI, 15 * 8, *_RIGHT[2:]], 1, "another version"),
        ([*_RIGHT[:3], 12 * 8], 1, "another version"),
        (_RIGHT, 0, "lacks AVX2"),
    ],
)
def test_a_kernel_of_other_structs_or_for_newer_processors_is_refused(
    layout: list[int], level: int, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(library.ctypes, "CDLL", lambda path: _stand_in(layout, level))
    with pytest.raises(KernelUnavailableError, match=why):
        Library(Path("kernel.so"))


def test_a_kernel_without_a_function_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in = _stand_in(_RIGHT, 1)
    del stand_in.curvefold_backward
    monkeypatch.setattr(library.ctypes, "CDLL", lambda path: stand_in)
    with pytest.raises(KernelUnavailableError, match="lacks a function"):
        Library(Path("kernel.so"))


def _spoilt(good: Library, **functions: object) -> Library:
    """The same library with other functions."""
    bad = object.__new__(Library)
    bad.__dict__.update(good.__dict__ | functions)
    return bad


def test_the_self_test_finds_each_function_that_does_nothing_or_too_little(
    kernel_library: Library, fresh: pytest.MonkeyPatch
) -> None:
    assert kernel.passes_self_test(kernel_library)
    for name in ("factor", "forward", "backward"):
        spoilt = _spoilt(kernel_library, **{name: lambda *a: 0})
        assert not kernel.passes_self_test(spoilt), name
    # Factors all but the last front of each list; takes an indefinite matrix for a good one.
    last_missing = _spoilt(
        kernel_library, factor=lambda *a: kernel_library.factor(*a[:4], max(a[4] - 1, 0), *a[5:])
    )
    blind = _spoilt(kernel_library, factor=lambda *a: 0 * kernel_library.factor(*a))
    assert not kernel.passes_self_test(last_missing)
    assert not kernel.passes_self_test(blind)
    fresh.delenv(kernel.SWITCH, raising=False)
    fresh.setattr(kernel, "Library", lambda path: blind)
    assert kernel.linear_algebra().phrase == "numpy and scipy; the compiled kernel failed its self-test"


# --- what it computes, on every instruction set ----------------------------------------------------------


def test_every_instruction_set_gives_the_same_bits(kernel_library: Library) -> None:
    rows, cols, plane = diamond_pattern(SIDE)
    values, rhs = dominant_values(rows, cols, 3 * len(plane)), np.cos(np.arange(3 * len(plane)))
    solutions = set()
    for level in range(1, kernel_library.level + 1):
        system = CompiledFactorization(
            kernel_library, symbolic_of(rows, cols, plane), rows, cols, threads=1, level=level
        )
        system.factorize(values, rhs)
        solutions.add(system.solution().tobytes())
    assert len(solutions) == 1


def test_each_thread_has_a_scratch_of_its_own(kernel_library: Library) -> None:
    rows, cols, plane = diamond_pattern(SIDE)
    values, size = dominant_values(rows, cols, 3 * len(plane)), 3 * len(plane)
    system = CompiledFactorization(kernel_library, symbolic_of(rows, cols, plane), rows, cols, threads=1)
    halves = np.split(system._scratch, 2)
    x = np.ones(size)
    for thread in (0, 1):
        for half in halves:
            half.fill(np.nan)
        for front_list in system._lists():
            call = system._call(thread, front_list)
            assert system._library.factor(*call, values.ctypes.data, x.ctypes.data) == 0
        for front_list in reversed(list(system._lists())):
            system._library.backward(*system._call(thread, front_list), x.ctypes.data)
        assert np.isfinite(halves[thread]).all()
        assert np.isnan(halves[1 - thread]).all()


def test_an_instruction_set_that_the_machine_lacks_is_refused(kernel_library: Library) -> None:
    rows, cols, plane = diamond_pattern(3)
    for level in (0, kernel_library.level + 1):
        with pytest.raises(ValueError, match="instruction set"):
            CompiledFactorization(
                kernel_library, symbolic_of(rows, cols, plane), rows, cols, threads=1, level=level
            )


# --- broken plans ----------------------------------------------------------------------------------------

_ARRAYS = ("fronts", "source", "target", "children", "runs", "indices", "stages")
_SIZES = ("unknowns", "panels_size", "updates_size", "carried_size", "scratch_size")


def _one_number_changed(plan: KernelPlan, rng: np.random.Generator) -> KernelPlan:
    """The plan with one number anywhere in it made a little or much too large or too small."""
    name = str(rng.choice(_ARRAYS))
    side = int(rng.integers(len(plan.stages[0])))
    whole = plan.stages[0][side] if name == "stages" else getattr(plan, name)
    changed = whole.copy()
    flat = changed.view(changed.dtype[0] if changed.dtype.names else changed.dtype)
    at = int(rng.integers(len(flat)))
    limits = np.iinfo(flat.dtype)
    choices = [-1, 0, int(flat[at]) - 8, int(flat[at]) - 1, int(flat[at]) + 1, int(flat[at]) + 8]
    choices += [int(flat[at]) + 4096, limits.max, limits.min, limits.max // 8]
    flat[at] = min(max(choices[int(rng.integers(len(choices)))], limits.min), limits.max)
    if name == "stages":
        sides = list(plan.stages[0])
        sides[side] = changed
        return replace(plan, stages=(tuple(sides), *plan.stages[1:]))
    return replace(plan, **{name: changed})


class _Fenced:
    """numpy, but what it makes of zeros lies between two fences."""

    WIDTH, FENCE = 4096, 7.25e77

    def __init__(self) -> None:
        self.fences: list[np.ndarray] = []

    def __getattr__(self, name: str) -> object:
        return getattr(np, name)

    def zeros(self, size: int) -> np.ndarray:
        whole = np.full(size + 2 * self.WIDTH, self.FENCE)
        self.fences += [whole[: self.WIDTH], whole[self.WIDTH + size :]]
        whole[self.WIDTH : self.WIDTH + size] = 0.0
        return whole[self.WIDTH : self.WIDTH + size]


def test_a_plan_as_it_is_laid_out_is_accepted(plan: KernelPlan) -> None:
    assert len(plan.fronts) > 4
    assert len(plan.stages) > 1
    check(plan)


def test_a_plan_with_one_wrong_number_is_refused_or_harmless(
    kernel_library: Library, plan: KernelPlan, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, cols, plane = diamond_pattern(SIDE)
    symbolic, values = symbolic_of(rows, cols, plane), dominant_values(rows, cols, 3 * len(plane))
    rng = np.random.default_rng(11)
    refused = 0
    for _ in range(600):
        broken = _one_number_changed(plan, rng)
        fenced = _Fenced()
        monkeypatch.setattr(compiled, "lay_out", lambda *a, broken=broken: broken)
        monkeypatch.setattr(compiled, "np", fenced)
        try:
            system = CompiledFactorization(kernel_library, symbolic, rows, cols, threads=1)
        except BrokenPlanError:
            refused += 1
            continue
        try:
            system.factorize(values, np.ones(plan.unknowns))
            system.solution()
            system.solve(np.ones(plan.unknowns))
        except NotPositiveDefiniteError:
            pass
        assert all((fence == _Fenced.FENCE).all() for fence in fenced.fences)
    assert 200 < refused < 600


def test_a_broken_plan_is_refused_before_the_library_is_called(
    plan: KernelPlan, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, cols, plane = diamond_pattern(SIDE)
    broken = replace(plan, panels_size=plan.panels_size - 1)
    monkeypatch.setattr(compiled, "lay_out", lambda *a: broken)
    monkeypatch.setattr(library.ctypes, "CDLL", lambda path: _stand_in(_RIGHT, 1))
    with pytest.raises(BrokenPlanError, match="the place of a panel"):
        CompiledFactorization(Library(Path("kernel.so")), symbolic_of(rows, cols, plane), rows, cols, threads=1)


@pytest.mark.parametrize("name", _SIZES)
def test_a_storage_that_is_too_small_by_one_is_refused(name: str, plan: KernelPlan) -> None:
    with pytest.raises(BrokenPlanError):
        check(replace(plan, **{name: getattr(plan, name) - 1}))


@pytest.mark.parametrize("name", _ARRAYS[:-1])
def test_an_array_of_another_type_or_cut_short_is_refused(name: str, plan: KernelPlan) -> None:
    array = getattr(plan, name)
    wider = np.zeros(len(array), np.float32 if array.dtype.names is None else "i8,i8")
    with pytest.raises(BrokenPlanError, match="the type of an array"):
        check(replace(plan, **{name: wider}))
    with pytest.raises(BrokenPlanError, match="the type of an array"):
        check(replace(plan, **{name: np.repeat(array, 2)[::2]}))
    with pytest.raises(BrokenPlanError):
        check(replace(plan, **{name: array[:-1]}))


def test_runs_out_of_order_are_refused(plan: KernelPlan) -> None:
    """Where columns of an update come first, rows of a panel would lie before it."""
    f = plan.fronts
    front = int(np.flatnonzero(f["runs_end"] - f["runs"] > 1)[0])
    runs = plan.runs.copy()
    first = int(f["runs"][front])
    runs[[first, first + 1]] = runs[[first + 1, first]]
    with pytest.raises(BrokenPlanError, match="the order of runs"):
        check(replace(plan, runs=runs))


def test_values_of_another_kind_never_reach_the_library(kernel_library: Library) -> None:
    rows, cols, plane = diamond_pattern(3)
    system = CompiledFactorization(kernel_library, symbolic_of(rows, cols, plane), rows, cols, threads=1)
    values = dominant_values(rows, cols, 3 * len(plane))
    for wrong in (values[:-1], values.astype(np.float32), np.repeat(values, 2)[::2]):
        with pytest.raises(ValueError, match="contiguous doubles"):
            system.factorize(wrong)
