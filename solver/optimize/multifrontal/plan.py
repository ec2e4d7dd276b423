"""The fronts laid out for the compiled kernel: the arrays of ``kernel/plan.h``, and a check of every number.

C is told bare addresses and trusts them. So whatever it will read or write is checked here against the sizes of the
arrays, once a pattern, and a plan that does not fit is refused in words.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import BoolArray, IntArray
from .symbolic import Symbolic, border_runs, entry_addresses, update_places

#: Sizes and places in a front's storage are multiples of so many numbers (UNIT in plan.h).
UNIT = 8
#: Unknowns of the largest system; products of sizes then fit into 64 bits.
MOST_UNKNOWNS = 1 << 30

_FIELDS = (
    *("pivots", "wide", "border", "tall", "height", "panel", "update", "carried", "first"),
    *("entries", "entries_end", "children", "children_end", "runs", "runs_end", "indices"),
)
Int32Array = NDArray[np.int32]
#: Of FRONT or RUN.
StructArray = NDArray[np.void]

#: ``Front`` of plan.h.
FRONT = np.dtype([(name, np.int64) for name in _FIELDS])
#: ``Run`` of plan.h.
RUN = np.dtype([(name, np.int32) for name in ("from", "to", "count")])


class BrokenPlanError(Exception):
    """A plan that would have the kernel read or write where it must not; the text says which part of it."""


@dataclass(frozen=True, eq=False)
class KernelPlan:
    """Arrays as plan.h describes them, and the sizes of the storage that they speak of."""

    fronts: StructArray  # (F,) FRONT
    source: Int32Array  # (nnz,)
    target: Int32Array  # (nnz,)
    children: Int32Array
    runs: StructArray  # RUN
    indices: Int32Array
    stages: tuple[tuple[Int32Array, Int32Array], ...]  # lists of fronts to work on side by side, in turn
    unknowns: int
    panels_size: int
    updates_size: int
    carried_size: int
    scratch_size: int  # for one thread


def lay_out(symbolic: Symbolic, rows: IntArray, cols: IntArray) -> KernelPlan:
    """The plan for matrices with the entries (rows, cols), either triangle."""
    fronts = symbolic.fronts
    f = np.zeros(len(fronts), FRONT)
    f["pivots"], f["border"] = [front.pivot_size for front in fronts], [front.border_size for front in fronts]
    f["wide"], f["tall"] = _rounded_up(f["pivots"]), _rounded_up(f["border"])
    f["height"] = f["wide"] + f["tall"]
    f["first"] = [3 * front.start for front in fronts]
    panels_size = _follow_each_other(f["panel"], f["height"] * f["wide"])
    carried_size = _follow_each_other(f["carried"], f["border"])
    f["indices"] = f["carried"]
    f["update"], updates_size = update_places(symbolic, f["tall"] ** 2)
    _follow_each_other(f["children"], np.array([len(front.children) for front in fronts]))
    f["children_end"] = f["children"] + [len(front.children) for front in fronts]
    runs = _runs(symbolic, f)
    source, target = _entries(symbolic, f, rows, cols)
    first, second = symbolic.lane_ends
    stages = [(range(first), range(first, second)), *symbolic.top_stages]
    return KernelPlan(
        f,
        source,
        target,
        _int32([child for front in fronts for child in front.children]),
        runs,
        _int32(3 * np.concatenate([front.border for front in fronts])[:, None] + np.arange(3)).ravel(),
        tuple((_int32(list(left)), _int32(list(right))) for left, right in stages),
        3 * len(symbolic.position),
        panels_size,
        updates_size,
        carried_size,
        int(f["height"].max()),
    )


def check(plan: KernelPlan) -> None:
    """Raises BrokenPlanError where the kernel would leave the arrays that it is given."""
    _check_types(plan)
    f, unknowns = plan.fronts, plan.unknowns
    _demand(0 < unknowns <= MOST_UNKNOWNS, "the number of unknowns")
    # Sizes first: all that follows multiplies them.
    _demand(_within(f["pivots"], 0, unknowns) & _within(f["border"], 0, unknowns), "the size of a front")
    rounded = (f["wide"] == _rounded_up(f["pivots"])) & (f["tall"] == _rounded_up(f["border"]))
    _demand(rounded & (f["height"] == f["wide"] + f["tall"]), "the size of a panel")
    _demand(f["height"] <= plan.scratch_size, "the size of the scratch")
    _demand(_fits(f["panel"], f["height"] * f["wide"], plan.panels_size), "the place of a panel")
    _demand(_fits(f["update"], f["tall"] ** 2, plan.updates_size), "the place of an update")
    _demand(_fits(f["carried"], f["border"], plan.carried_size), "the place of a carried right-hand side")
    _demand(_fits(f["first"], f["pivots"], unknowns), "the place of pivots")
    _demand(_fits(f["indices"], f["border"], len(plan.indices)), "the place of a border's unknowns")
    _demand(_within(plan.indices, 0, unknowns - 1), "an unknown of a border")
    for name, array in (("entries", plan.source), ("children", plan.children), ("runs", plan.runs)):
        start, end = f[name], f[f"{name}_end"]
        _demand(_within(start, 0, len(array)) & (start <= end) & (end <= len(array)), f"the range of {name}")
    _check_entries(plan)
    parent = _parents(plan)
    _check_runs(plan, parent)
    listed = np.concatenate([side for stage in plan.stages for side in stage])
    _demand(np.array_equal(np.sort(listed), np.arange(len(f))), "the order of the fronts")


def _check_types(plan: KernelPlan) -> None:
    lists = [side for stage in plan.stages for side in stage]
    integers = [plan.source, plan.target, plan.children, plan.indices, *lists]
    wanted: list[tuple[NDArray[Any], np.dtype[Any]]] = [(array, np.dtype(np.int32)) for array in integers]
    for array, dtype in [*wanted, (plan.fronts, FRONT), (plan.runs, RUN)]:
        _demand(array.dtype == dtype and array.ndim == 1 and array.flags.c_contiguous, "the type of an array")
    _demand(len(plan.source) == len(plan.target), "the number of entries")
    _demand(len(plan.fronts) > 0 and len(plan.stages) > 0, "the number of fronts")


def _check_entries(plan: KernelPlan) -> None:
    f = plan.fronts
    _demand(_within(plan.source, 0, len(plan.source) - 1), "the source of an entry")
    counts = f["entries_end"] - f["entries"]
    _demand(np.array_equal(f["entries"], np.cumsum(counts) - counts), "the range of entries")
    _demand(counts.sum() == len(plan.target), "the number of entries")
    room = np.repeat(f["height"] * f["wide"], counts)
    _demand(_within(plan.target, 0, room - 1), "the target of an entry")


def _parents(plan: KernelPlan) -> IntArray:
    """(F,) the front that takes each front's update, -1 for none."""
    f = plan.fronts
    counts = f["children_end"] - f["children"]
    _demand(np.array_equal(f["children"], np.cumsum(counts) - counts), "the range of children")
    _demand(counts.sum() == len(plan.children), "the number of children")
    owner = np.repeat(np.arange(len(f)), counts)
    _demand(_within(plan.children, 0, owner - 1), "a child")
    _demand(len(np.unique(plan.children)) == len(plan.children), "a child of two fronts")
    parent = np.full(len(f), -1)
    parent[plan.children] = owner
    return parent


def _check_runs(plan: KernelPlan, parent: IntArray) -> None:
    """Every run lies in the child's border, and in the parent's pivots or border, after the run before it."""
    f = plan.fronts
    counts = f["runs_end"] - f["runs"]
    _demand(np.array_equal(f["runs"], np.cumsum(counts) - counts), "the range of runs")
    _demand(counts.sum() == len(plan.runs), "the number of runs")
    child = np.repeat(np.arange(len(f)), counts)
    _demand(parent[child] >= 0, "a run without a parent")
    start, to, count = (plan.runs[name].astype(np.int64) for name in ("from", "to", "count"))
    _demand((count > 0) & _fits(start, count, f["border"][child]), "a run's rows in its border")
    pivots, wide = f["pivots"][parent[child]], f["wide"][parent[child]]
    in_pivots = _fits(to, count, pivots)
    in_border = _fits(to - wide, count, f["border"][parent[child]])
    _demand(in_pivots | in_border, "a run's rows in its parent")
    follows = (start[1:] >= (start + count)[:-1]) & (to[1:] >= (to + count)[:-1])
    _demand(follows | (child[1:] != child[:-1]), "the order of runs")


def _demand(holds: bool | BoolArray, what: str) -> None:
    if not np.all(holds):
        raise BrokenPlanError(f"the kernel's plan is broken: {what} is wrong")


def _within(values: NDArray[Any], least: int, most: int | IntArray) -> BoolArray:
    inside: BoolArray = (values >= least) & (values <= most)
    return inside


def _fits(start: IntArray, size: IntArray, room: int | IntArray) -> BoolArray:
    inside: BoolArray = (start >= 0) & (start <= room - size)
    return inside


def _rounded_up(sizes: IntArray) -> IntArray:
    rounded: IntArray = -(-sizes // UNIT) * UNIT
    return rounded


def _follow_each_other(starts: IntArray, sizes: IntArray) -> int:
    """Fills ``starts`` so that one comes after the other; returns where the last one ends."""
    ends = np.cumsum(sizes)
    starts[:] = ends - sizes
    return int(ends[-1])


def _int32(values: IntArray | list[int]) -> Int32Array:
    return np.ascontiguousarray(values, np.int32)


def _runs(symbolic: Symbolic, f: StructArray) -> StructArray:
    """The runs of all fronts; fills their ranges in."""
    fronts = symbolic.fronts
    parent = {child: i for i, front in enumerate(fronts) for child in front.children}
    runs: list[tuple[int, int, int]] = []
    for i, front in enumerate(fronts):
        f["runs"][i] = len(runs)
        if front.border_size:
            pivots, wide = f["pivots"][parent[i]], f["wide"][parent[i]]
            for row, at, count in border_runs(front, fronts[parent[i]]):
                to = 3 * row if 3 * row < pivots else 3 * row - pivots + wide
                runs.append((3 * at, int(to), 3 * count))
        f["runs_end"][i] = len(runs)
    return np.array(runs, RUN)


def _entries(symbolic: Symbolic, f: StructArray, rows: IntArray, cols: IntArray) -> tuple[Int32Array, Int32Array]:
    """Source and target of all entries, front by front in the order of their storage; fills their ranges in."""
    addresses = entry_addresses(symbolic, rows, cols)
    source = np.argsort(addresses, kind="stable")  # long runs are in order already: four times as fast
    addresses = addresses[source]
    front = np.searchsorted(symbolic.panel_starts, addresses, side="right") - 1
    # In symbolic's panels nothing is rounded up.
    pivots, wide = f["pivots"][front], f["wide"][front]
    col, row = np.divmod(addresses - symbolic.panel_starts[front], pivots + f["border"][front])
    target = col * f["height"][front] + np.where(row < pivots, row, row - pivots + wide)
    f["entries_end"] = np.searchsorted(front, np.arange(len(f)), side="right")
    f["entries"][1:] = f["entries_end"][:-1]
    return _int32(source), _int32(target)
