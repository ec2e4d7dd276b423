"""Elimination order of the vertices: nested dissection by straight cuts through the plane.

The net is a grid drawn in the plane, so that good separators are straight lines, which need no search in
the graph. The stencil of bending and of the DOG conditions is a diamond (all vertices at most two grid
steps away), through which diagonal cuts are thinner than axis cuts. Coordinates serve as their ranks only:
a grid line is one integer however the lines are spaced. Patches lie over each other in the plane, so one
cut goes through all of them. Where no straight cut is thin, breadth-first levels of the graph are cut
instead, so that any graph is ordered, well or not.
Source: George, "Nested dissection of a regular finite element mesh", SIAM J. Numer. Anal. 10 (1973).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components, dijkstra

from ...arrays import BoolArray, FloatArray, IntArray

# Largest piece that is not cut further; the best of 16..40 vertices on grids of 500 to 10,000 vertices.
LEAF_VERTICES = 28
# Plane coordinates closer than this fraction of the drawing's extent lie on one grid line.
SAME_LINE = 1e-9
# A vertex with more neighbours than max(60, 4 sqrt(V)) is eliminated last: every cut would contain it.
DENSE_DEGREE = 60
DENSE_DEGREE_FACTOR = 4.0
# A separator above this multiple of sqrt(piece) is compared with one from breadth-first levels. A stitched
# grid of two layers with the diamond stencil has 2.8.
THICK_SEPARATOR = 4.0
# Weights of the cost estimate: the two pieces' fronts with borders of their own, and what lies inside them.
# Chosen, like the two after them, for the fewest operations on square grids of 500 to 10,000 vertices.
BORDER_WEIGHT = 1.0
INTERIOR_WEIGHT = 24.0
# A cut whose left share of the vertices is farther than this from one half counts as much dearer.
UNBALANCED_SHARE = 0.15
UNBALANCED_PENALTY = 100.0


@dataclass(frozen=True)
class Graph:
    """Symmetric vertex graph in compressed rows, every vertex its own neighbour (no row is empty)."""

    starts: IntArray  # (V+1,)
    neighbours: IntArray  # (E,)

    @property
    def size(self) -> int:
        return len(self.starts) - 1

    def subgraph(self, vertices: IntArray, scratch: IntArray) -> tuple[Graph, Border]:
        """The graph of ``vertices`` alone, renumbered, and what it touches outside.

        ``scratch`` is (V,) of -1 and is left so.
        """
        lengths = self.starts[vertices + 1] - self.starts[vertices]
        ends = np.cumsum(lengths)
        shift = np.repeat(self.starts[vertices] - (ends - lengths), lengths)
        neighbours = self.neighbours[shift + np.arange(len(shift))]
        scratch[vertices] = np.arange(len(vertices))
        local = scratch[neighbours]
        scratch[vertices] = -1
        inside = local >= 0
        starts = np.concatenate([[0], np.cumsum(inside)[ends - 1]])
        touched, owner = neighbours[~inside], np.repeat(np.arange(len(vertices)), lengths)[~inside]
        order = np.argsort(touched, kind="stable")
        firsts = np.flatnonzero(np.diff(touched[order], prepend=-1))
        return Graph(starts.astype(np.int64), local[inside]), Border(firsts, owner[order])


@dataclass(frozen=True)
class Border:
    """Vertices outside of a piece that it is coupled to; they are eliminated later."""

    starts: IntArray  # (B,) where each one's neighbours begin
    neighbours: IntArray  # local vertices of the piece

    def least(self, key: IntArray) -> IntArray:
        """(B,) smallest ``key`` among each one's neighbours."""
        return np.minimum.reduceat(key[self.neighbours], self.starts) if len(self.starts) else self.starts

    def largest(self, key: IntArray) -> IntArray:
        """(B,) largest ``key`` among each one's neighbours."""
        return np.maximum.reduceat(key[self.neighbours], self.starts) if len(self.starts) else self.starts


@dataclass(frozen=True)
class EliminationNode:
    """Vertices eliminated together, after those of all ``children`` (indices of earlier nodes)."""

    vertices: IntArray
    children: tuple[int, ...]


@dataclass(frozen=True)
class _Cut:
    cost: float
    separator: BoolArray
    left: BoolArray
    right: BoolArray


def vertex_graph(rows: IntArray, cols: IntArray, size: int) -> Graph:
    """The graph of ``size`` vertices from vertex pairs (either triangle, repeats allowed)."""
    own = np.arange(size)
    keys = np.unique(np.concatenate([rows * size + cols, cols * size + rows, own * size + own]))
    starts = np.searchsorted(keys, np.arange(size + 1) * size)
    return Graph(starts.astype(np.int64), keys % size)


def grid_ranks(plane: FloatArray) -> IntArray:
    """(V,2) integer grid lines of plane points: equal coordinates give equal ranks, order is kept."""
    ranks = np.zeros(plane.shape, np.int64)
    for axis in range(2):
        values = plane[:, axis]
        order = np.argsort(values, kind="stable")
        tolerance = SAME_LINE * max(float(np.ptp(values)), 1e-300)
        ranks[order[1:], axis] = np.cumsum(np.diff(values[order]) > tolerance)
    return ranks


def dissect(graph: Graph, plane: FloatArray, *, leaf: int = LEAF_VERTICES) -> list[EliminationNode]:
    """Elimination nodes in postorder, every vertex in exactly one; the last node may be one of many roots.

    ``plane`` is (V,2) in any unit. Any graph and any finite coordinates are accepted.
    """
    return _Dissection(graph, grid_ranks(plane), leaf).run()


class _Dissection:
    def __init__(self, graph: Graph, ranks: IntArray, leaf: int) -> None:
        self.graph = graph
        a, b = ranks[:, 0], ranks[:, 1]
        self.lines = np.stack([a, b, a + b, a - b])  # (4,V) coordinate across the four families of cuts
        self.leaf = leaf
        self.nodes: list[EliminationNode] = []
        self.scratch = np.full(graph.size, -1, np.int64)

    def run(self) -> list[EliminationNode]:
        degrees = np.diff(self.graph.starts)
        dense = degrees > max(DENSE_DEGREE, DENSE_DEGREE_FACTOR * self.graph.size**0.5)
        sparse = np.flatnonzero(~dense)
        roots = [self._piece(piece) for piece in self._components(sparse)]
        if dense.any():
            self._add(np.flatnonzero(dense), tuple(roots))
        return self.nodes

    def _components(self, vertices: IntArray) -> list[IntArray]:
        """Connected pieces; small ones are put together until they fill a leaf."""
        if len(vertices) == 0:
            return []
        graph, _ = self.graph.subgraph(vertices, self.scratch)
        count, labels = connected_components(_matrix(graph), directed=False)
        if count == 1:
            return [vertices]
        sizes = np.bincount(labels, minlength=count)
        small = sizes <= self.leaf // 2
        filled = np.cumsum(np.where(small, sizes, 0)) // self.leaf
        group = np.where(small, filled, np.arange(count) + count + len(vertices))
        groups = group[labels]
        order = np.argsort(groups, kind="stable")
        cuts = np.flatnonzero(np.diff(groups[order])) + 1
        return list(np.split(vertices[order], cuts))

    def _add(self, vertices: IntArray, children: tuple[int, ...]) -> int:
        self.nodes.append(EliminationNode(self._along(vertices), children))
        return len(self.nodes) - 1

    def _along(self, vertices: IntArray) -> IntArray:
        """Vertices sorted along their longest extent, so that neighbours' borders are few runs of rows."""
        if len(vertices) == 0:
            return vertices
        lines = self.lines[:, vertices]
        spread = np.ptp(lines, axis=1) / np.array([1.0, 1.0, 2.0, 2.0])
        across = (1, 0, 3, 2)
        main = int(np.argmax(spread))
        order: IntArray = np.lexsort((lines[across[main]], lines[main]))
        return vertices[order]

    def _piece(self, vertices: IntArray) -> int:
        """Dissects one piece. The stack is explicit, since cuts may go deeper than recursion does."""
        done: list[int] = []
        stack: list[tuple[IntArray, bool]] = [(vertices, False)]
        while stack:
            piece, is_separator = stack.pop()
            if is_separator:
                right, left = done.pop(), done.pop()
                done.append(self._add(piece, (left, right)))
                continue
            cut = self._best_cut(piece) if len(piece) > self.leaf else None
            if cut is None:
                done.append(self._add(piece, ()))
                continue
            stack.append((piece[cut.separator], True))
            stack.append((piece[cut.right], False))
            stack.append((piece[cut.left], False))
        return done.pop()

    def _best_cut(self, vertices: IntArray) -> _Cut | None:
        graph, border = self.graph.subgraph(vertices, self.scratch)
        best: _Cut | None = None
        for line in self.lines[:, vertices]:
            cut = _cut_across(graph, line, border)
            if cut is not None and (best is None or cut.cost < best.cost):
                best = cut
        if best is None or best.separator.sum() > THICK_SEPARATOR * len(vertices) ** 0.5:
            cut = _cut_across(graph, _levels(graph), border)
            if cut is not None and (best is None or cut.cost < best.cost):
                best = cut
        return best


def _cut_across(graph: Graph, line: IntArray, border: Border) -> _Cut | None:
    """The cheapest cut ``line < c`` over all c, its separator taken from either side; None if there is none.

    All values of c are judged at once: with ``highest`` the largest line value of a vertex and its
    neighbours, the left side without its separator is ``highest < c``, and so on.
    """
    highest = np.maximum.reduceat(line[graph.neighbours], graph.starts[:-1])
    lowest = np.minimum.reduceat(line[graph.neighbours], graph.starts[:-1])
    values = np.unique(line)[1:]
    if len(values) == 0:
        return None
    n, total = len(line), float(len(border.starts))
    best: tuple[float, int, bool] | None = None
    for from_left in (True, False):
        left_key, right_key = (highest, line) if from_left else (line, lowest)
        left = np.searchsorted(np.sort(left_key), values)
        not_right = np.searchsorted(np.sort(right_key), values)
        right = n - not_right
        s = (not_right - left).astype(np.float64)
        left_border = s + np.searchsorted(np.sort(border.least(left_key)), values)
        right_border = s + total - np.searchsorted(np.sort(border.largest(right_key)), values)
        cost = s * (s * s / 3 + s * total + total**2)
        cost += BORDER_WEIGHT * (left_border**3 + right_border**3)
        cost += INTERIOR_WEIGHT * (left**1.5 + right**1.5)
        share = not_right if from_left else left
        cost[abs(share / n - 0.5) > UNBALANCED_SHARE] *= UNBALANCED_PENALTY
        cost[(left == 0) | (right == 0)] = np.inf
        k = int(np.argmin(cost))
        if np.isfinite(cost[k]) and (best is None or cost[k] < best[0]):
            best = float(cost[k]), k, from_left
    if best is None:
        return None
    cost_value, k, from_left = best
    c = values[k]
    left_side = (highest if from_left else line) < c
    right_side = (line if from_left else lowest) >= c
    return _Cut(cost_value, ~(left_side | right_side), left_side, right_side)


def _levels(graph: Graph) -> IntArray:
    """Breadth-first levels from a far end of the graph; unreached vertices one level after the next."""
    matrix = _matrix(graph)
    start = 0
    for _ in range(2):
        distance = dijkstra(matrix, indices=start, unweighted=True)
        reached = np.isfinite(distance)
        start = int(np.argmax(np.where(reached, distance, -1.0)))
    distance = dijkstra(matrix, indices=start, unweighted=True)
    reached = np.isfinite(distance)
    return np.where(reached, distance, distance[reached].max() + 2).astype(np.int64)


def _matrix(graph: Graph) -> sp.csr_matrix:
    ones = np.ones(len(graph.neighbours))
    return sp.csr_matrix((ones, graph.neighbours, graph.starts), shape=(graph.size, graph.size))
