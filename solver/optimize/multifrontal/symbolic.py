"""Symbolic factorisation: fronts with their borders, joined where that saves time, dealt out to two lanes.

A *front* is the dense block in which some vertices (its pivots) are eliminated together; its *border* are
the later vertices that they are coupled to by then. Everything here depends on the pattern only and is
done once.
Source: Duff and Reid, "The multifrontal solution of indefinite sparse symmetric linear equations", ACM
Trans. Math. Softw. 9 (1983); Liu, "The multifrontal method for sparse matrix solution", SIAM Rev. 34 (1992).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray, IntArray
from .ordering import EliminationNode, Graph

# Time model of one front on one core, from timing OpenBLAS on blocks of 30..300 rows: microseconds a
# floating-point operation in the pivot block, the panel, and the border, a moved entry, and a front.
PIVOT_COST = 1 / 7e3
PANEL_COST = 1 / 28e3
BORDER_COST = 1 / 36e3
ENTRY_COST = 1e-3
FRONT_COST = 25.0
# Most fronts that may be left for the end, when both lanes are done.
MAX_TOP_FRONTS = 4
# Microseconds to hand work to the second thread and to wait for it.
HANDOVER_COST = 100.0


@dataclass(frozen=True)
class Front:
    """One dense block. Vertices are elimination positions 0..V-1; scalar sizes are three times as many."""

    start: int  # its pivots are the positions start..stop-1
    stop: int
    border: IntArray  # sorted positions >= stop
    children: tuple[int, ...]  # earlier fronts whose updates are added to this one

    @property
    def rows(self) -> IntArray:
        """Sorted positions of all its rows, pivots first."""
        return np.concatenate([np.arange(self.start, self.stop), self.border])

    @property
    def pivot_size(self) -> int:
        return 3 * (self.stop - self.start)

    @property
    def border_size(self) -> int:
        return 3 * len(self.border)


@dataclass(frozen=True)
class Symbolic:
    """The fronts in the order of their elimination: lane 0, then lane 1, then those that need both."""

    fronts: tuple[Front, ...]
    lane_ends: tuple[int, int]  # fronts [0, e0) are lane 0, [e0, e1) lane 1, [e1, ...) the top
    top_stages: tuple[tuple[list[int], list[int]], ...]  # the top's fronts by stages, two lists side by side
    position: IntArray  # (V,) elimination position of every vertex
    panel_starts: IntArray  # (F+1,) where each front's panel begins in the factor's storage

    @property
    def flops(self) -> float:
        """Multiplications and additions of one factorisation."""
        return float(sum(front_flops(f.pivot_size, f.border_size) for f in self.fronts))


def front_flops(pivots: int, border: int) -> float:
    """Operations of a dense partial Cholesky factorisation: p^3/3 + p^2 b + p b^2."""
    return pivots**3 / 3 + float(pivots) ** 2 * border + float(border) ** 2 * pivots


def front_time(pivots: int, border: int) -> float:
    """Estimated microseconds for one front, scalar sizes."""
    work = PIVOT_COST * pivots**3 + PANEL_COST * pivots**2 * border + BORDER_COST * pivots * border**2
    return FRONT_COST + work + ENTRY_COST * (border**2 + (pivots + border) * pivots)


@dataclass
class _Draft:
    """A front while fronts are still being joined; vertices by their first elimination positions."""

    pivots: IntArray
    border: IntArray
    children: list[int]

    @property
    def time(self) -> float:
        return front_time(3 * len(self.pivots), 3 * len(self.border))


def analyse(graph: Graph, nodes: list[EliminationNode]) -> Symbolic:
    """Fronts, lanes and storage for eliminating ``nodes`` (from ``ordering.dissect``) in ``graph``."""
    order = np.concatenate([node.vertices for node in nodes])
    drafts = _drafts(graph, nodes, order)
    roots = _join(drafts)
    lanes, top = _deal(drafts, roots)
    sequence = [*lanes[0], *lanes[1], *top]
    renumbered = np.concatenate([drafts[i].pivots for i in sequence])
    moved = np.empty_like(renumbered)
    moved[renumbered] = np.arange(len(renumbered))
    index = {draft: front for front, draft in enumerate(sequence)}
    fronts = []
    start = 0
    for i in sequence:
        draft = drafts[i]
        stop = start + len(draft.pivots)
        children = tuple(sorted(index[c] for c in draft.children))
        fronts.append(Front(start, stop, np.sort(moved[draft.border]), children))
        start = stop
    position = np.empty(graph.size, np.int64)
    position[order[renumbered]] = np.arange(graph.size)
    panels = [f.pivot_size * (f.pivot_size + f.border_size) for f in fronts]
    panel_starts = np.concatenate([[0], np.cumsum(panels)]).astype(np.int64)
    ends = len(lanes[0]), len(lanes[0]) + len(lanes[1])
    stages = tuple(
        ([index[i] for i in first], [index[i] for i in second]) for first, second in _stages(drafts, top)
    )
    return Symbolic(tuple(fronts), ends, stages, position, panel_starts)


def entry_addresses(symbolic: Symbolic, rows: IntArray, cols: IntArray) -> IntArray:
    """Where each scalar entry of the matrix lies in the factor's storage; either triangle is given.

    A front's panel is column-major with (pivots + border) rows and pivots columns.
    """
    size = len(symbolic.position)
    row_vertex, col_vertex = symbolic.position[rows // 3], symbolic.position[cols // 3]
    row, col = 3 * row_vertex + rows % 3, 3 * col_vertex + cols % 3
    swapped = row < col
    row, col = np.where(swapped, col, row), np.where(swapped, row, col)
    row_vertex, col_vertex = row // 3, col // 3
    starts = np.array([f.start for f in symbolic.fronts])
    front = np.searchsorted(starts, col_vertex, side="right") - 1
    keys = np.concatenate([i * size + f.rows for i, f in enumerate(symbolic.fronts)])
    first_key = np.searchsorted(keys, np.arange(len(starts)) * size)
    wanted = front * size + row_vertex
    found = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    if not np.array_equal(keys[found], wanted):
        raise ValueError("the entries do not belong to the analysed pattern")
    heights = np.array([f.pivot_size + f.border_size for f in symbolic.fronts])
    local_row = 3 * (found - first_key[front]) + row % 3
    local_col = col - 3 * starts[front]
    addresses: IntArray = symbolic.panel_starts[front] + local_col * heights[front] + local_row
    return addresses


def _drafts(graph: Graph, nodes: list[EliminationNode], order: IntArray) -> list[_Draft]:
    position = np.empty(graph.size, np.int64)
    position[order] = np.arange(graph.size)
    lengths = np.diff(graph.starts)[order]
    sources = np.repeat(graph.starts[order] - (np.cumsum(lengths) - lengths), lengths)
    neighbours = position[graph.neighbours[sources + np.arange(len(sources))]]
    ends = np.concatenate([[0], np.cumsum(lengths)])
    drafts: list[_Draft] = []
    start = 0
    for node in nodes:
        stop = start + len(node.vertices)
        inherited = [drafts[c].border for c in node.children]
        reached = np.concatenate([neighbours[ends[start] : ends[stop]], *inherited])
        border = np.unique(reached[reached >= stop])
        drafts.append(_Draft(np.arange(start, stop), border, list(node.children)))
        start = stop
    return drafts


def _join(drafts: list[_Draft]) -> list[int]:
    """Joins a front into its parent wherever the time model gains; returns the roots that are left."""
    parents = np.full(len(drafts), -1)
    for i, draft in enumerate(drafts):
        kept: list[int] = []
        for child in draft.children:
            joined_size = 3 * (len(drafts[child].pivots) + len(draft.pivots))
            joined = front_time(joined_size, 3 * len(draft.border))
            if len(draft.pivots) == 0 or joined < draft.time + drafts[child].time:
                draft.pivots = np.concatenate([drafts[child].pivots, draft.pivots])
                kept.extend(drafts[child].children)
                parents[child] = -2
            else:
                kept.append(child)
        draft.children = kept
        parents[kept] = i
    return [i for i in range(len(drafts)) if parents[i] == -1]


def _deal(drafts: list[_Draft], roots: list[int]) -> tuple[tuple[list[int], list[int]], list[int]]:
    """Two lists of fronts to run side by side, and the ones left for the end, each in postorder."""
    total = np.array([draft.time for draft in drafts])
    for i, draft in enumerate(drafts):  # children come first
        total[i] += sum(total[c] for c in draft.children)
    tasks, top = sorted(roots, key=lambda i: -total[i]), list[int]()
    best: tuple[float, tuple[list[int], list[int]], list[int]] | None = None
    while True:
        lanes = _halves(tasks, total)
        longer, shorter = (float(sum(total[i] for i in lane)) for lane in lanes)
        length = max(longer, shorter) + _stages_time(drafts, sorted(top))
        if best is None or length < best[0]:
            best = length, lanes, list(top)
        if len(top) >= MAX_TOP_FRONTS or not tasks or not drafts[tasks[0]].children:
            break
        top.append(tasks[0])
        tasks = sorted([*tasks[1:], *drafts[tasks[0]].children], key=lambda i: -total[i])
    _, lanes, top = best
    first, second = ([i for root in sorted(lane) for i in _postorder(drafts, root)] for lane in lanes)
    return (first, second), sorted(top)


def _stages(drafts: list[_Draft], top: list[int]) -> list[tuple[list[int], list[int]]]:
    """Fronts of the top (in postorder) by how many generations of the top lie below them."""
    stage: dict[int, int] = {}
    for i in top:
        stage[i] = 1 + max((stage[c] for c in drafts[i].children if c in stage), default=-1)
    time = np.array([draft.time for draft in drafts])
    by_stage = [[i for i in top if stage[i] == k] for k in range(max(stage.values(), default=-1) + 1)]
    return [_halves(sorted(fronts, key=lambda i: -time[i]), time) for fronts in by_stage]


def _stages_time(drafts: list[_Draft], top: list[int]) -> float:
    time = 0.0
    for stage in _stages(drafts, top):
        time += max(sum(drafts[i].time for i in side) for side in stage)
        time += HANDOVER_COST if all(stage) else 0.0
    return time


def _halves(tasks: list[int], time: FloatArray) -> tuple[list[int], list[int]]:
    """Longest task first, each to the lane that is free earlier."""
    lanes: tuple[list[int], list[int]] = ([], [])
    loads = [0.0, 0.0]
    for task in tasks:
        lane = int(loads[1] < loads[0])
        lanes[lane].append(task)
        loads[lane] += float(time[task])
    return lanes


def _postorder(drafts: list[_Draft], root: int) -> list[int]:
    found, stack = [], [root]
    while stack:
        i = stack.pop()
        found.append(i)
        stack.extend(drafts[i].children)
    return found[::-1]


def border_runs(child: Front, parent: Front) -> list[tuple[int, int, int]]:
    """Where a child's border lies in its parent: (parent's row, place in the border, how many), in vertices.

    Rows that follow each other make one run; none goes on from the parent's pivots into its border.
    """
    rows = np.searchsorted(parent.rows, child.border)
    pivots = parent.stop - parent.start
    breaks = np.flatnonzero((np.diff(rows) != 1) | (rows[1:] == pivots)) + 1
    return [(int(run[0]), int(at), len(run)) for run, at in zip(np.split(rows, breaks), [0, *breaks], strict=True)]


def update_places(symbolic: Symbolic, sizes: IntArray) -> tuple[IntArray, int]:
    """Where each front's update of ``sizes`` (F,) numbers begins in one array, and the size of that.

    An update lives from its front to its parent's, in postorder: two stacks a lane, for even and odd depth,
    so that a front's update is never written over those of its children. The top's few fronts, which may be
    worked on at once, each have a place of their own.
    """
    fronts = symbolic.fronts
    depth = np.zeros(len(fronts), np.int64)
    for i in range(len(fronts) - 1, -1, -1):
        for child in fronts[i].children:
            depth[child] = depth[i] + 1
    first, second = symbolic.lane_ends
    tops: dict[tuple[int, int], int] = {}
    ends: dict[tuple[int, int], int] = {}
    place: list[tuple[tuple[int, int], int]] = []
    for i, front in enumerate(fronts):
        lane = int(i >= first) + int(i >= second)
        key = lane, int(depth[i] & 1)
        start = tops.get(key, 0)
        place.append((key, start))
        tops[key] = start + int(sizes[i])
        ends[key] = max(ends.get(key, 0), tops[key])
        released = [place[c] for c in front.children if place[c][0][0] == lane != 2]
        if released:
            tops[released[0][0]] = min(offset for _, offset in released)
    bases: dict[tuple[int, int], int] = {}
    total = 0
    for key, size in ends.items():
        bases[key] = total
        total += size
    return np.array([bases[key] + offset for key, offset in place], np.int64), total
