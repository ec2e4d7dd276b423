"""Crease points: where a crease crosses a grid edge, with what the terms and the measures need of each."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import shapely
from numpy.typing import NDArray

from ..arrays import BoolArray, FloatArray, IntArray, frozen_array
from ..pattern.arrangement import Arrangement
from ..pattern.places import line_strings, places_along
from .grid import OrthogonalGrid
from .net_points import weights_at
from .overlay import Overlay
from .topology import Topology

#: Neighbours for tangent and osculating plane lie at least this far along the crease, cell lengths: nearer
#: ones measure the sag of the grid's chords instead of the crease.
NEIGHBOUR_SPACING = 0.5
#: At the last point before a crease's end a nearer neighbour will do, cell lengths.
NEIGHBOUR_SPACING_AT_END = 0.25
#: Crease points that carry no fold condition (paper, section 6.1, Fig. 12).
MIN_CURVATURE = 1e-5
MIN_EDGE_PART = 0.05
MIN_EDGE_ANGLE = np.radians(3.0)
#: The flat tangent is a central difference over this distance to each side, cell lengths.
_TANGENT_STEP = 0.1


@dataclass(frozen=True, eq=False)
class CreasePoints:
    """K crease points, chain by chain in the creases' direction.

    position (K,2) net units; chain, crease (K,); along (K,) distance from the chain's start; end (K,) at a
    crease vertex; tangent (K,2) flat unit tangent
    left_vertices, right_vertices (K,4), left_weights, right_weights (K,4): the point in the two patches
    left_edge, right_edge (K,2): directed grid edges, equal when flat, one on each side; -1 where none
    cos2 (K,) squared cosine of the flat angle between that edge and the tangent (alpha of Lemma 5.1)
    carrier (F,) points with a fold condition
    fold_vertices (F,12): a1, b1, a2, b2 (the grid edge in the left and right patch), the point before as two
    vertices of the left and two of the right patch, the point after likewise; fold_weights (F,3): places of the
    point, the one before and the one after along their pairs; fold_neighbours (F,2) these as crease points
    """

    position: FloatArray
    chain: IntArray
    crease: IntArray
    along: FloatArray
    end: BoolArray
    tangent: FloatArray
    left_vertices: IntArray
    left_weights: FloatArray
    right_vertices: IntArray
    right_weights: FloatArray
    left_edge: IntArray
    right_edge: IntArray
    cos2: FloatArray
    carrier: IntArray
    fold_vertices: IntArray
    fold_weights: FloatArray
    fold_neighbours: IntArray


#: A point in one patch: the vertices of a quad, counting ones first, and their weights; none without a quad.
_Copy = tuple[IntArray, FloatArray] | None

#: (a, b, t) of a point on a grid edge directed along +x or +y, or of a vertex and one of its neighbours.
_Pair = tuple[int, int, float] | None


@dataclass
class _Row:
    """One crease point while it is being gathered: as seen through the faces on its left and right."""

    node: int
    along: float
    end: bool
    faces: tuple[int, int]
    left: _Copy = None
    right: _Copy = None
    left_pair: _Pair = None
    right_pair: _Pair = None


def find_crease_points(
    arrangement: Arrangement, over: Overlay, topology: Topology, grid: OrthogonalGrid
) -> CreasePoints:
    """Walk every chain of the arrangement through the overlay. All in cell lengths."""
    chains = arrangement.chains
    lines = [chain.points for chain in chains]
    whole = line_strings(lines)
    lengths = shapely.length(whole)
    closed = np.array([chain.closed for chain in chains], dtype=bool)
    walks = _walks(over, lines, lengths, closed)
    rows = [row for _, walk in walks for row in walk]
    _see(over, topology, grid, rows)
    which = np.array([chain for chain, walk in walks for _ in walk], dtype=np.int64)
    tangents = _tangents(
        whole[which], lengths[which], closed[which], np.array([row.along for row in rows], dtype=float)
    )
    builder = _Builder(over, topology, grid)
    done = 0
    for chain, walk in walks:
        mine = tangents[done : done + len(walk)]
        builder.add_chain(chain, chains[chain].crease, chains[chain].closed, walk, mine, float(lengths[chain]))
        done += len(walk)
    return builder.finish()


def _walks(
    over: Overlay, lines: list[FloatArray], lengths: FloatArray, closed: BoolArray
) -> list[tuple[int, list[_Row]]]:
    """The points of every chain that has any, in its direction."""
    segment = np.flatnonzero(over.chain >= 0)
    segment = segment[np.argsort(over.chain[segment], kind="stable")]
    nodes = np.unique(np.column_stack([np.repeat(over.chain[segment], 2), over.segments[segment].ravel()]), axis=0)
    places = places_along(lines, nodes[:, 0], over.points[nodes[:, 1]])
    on_grid = ((over.line_x >= 0) | (over.line_y >= 0)).tolist()
    first = np.searchsorted(nodes[:, 0], np.arange(len(lines) + 1))
    start = np.searchsorted(over.chain[segment], np.arange(len(lines) + 1))
    walks = []
    for index in np.flatnonzero(np.diff(start)).tolist():
        some, mine = slice(*first[index : index + 2]), segment[start[index] : start[index + 1]]
        along = dict(zip(nodes[some, 1].tolist(), places[some].tolist(), strict=True))
        rows = _walk(over, mine, along, on_grid, float(lengths[index]), bool(closed[index]))
        if rows:
            walks.append((index, rows))
    return walks


def _walk(
    over: Overlay, mine: IntArray, along: dict[int, float], on_grid: list[bool], length: float, closed: bool
) -> list[_Row]:
    """The points of the chain that the segments ``mine`` belong to; along: where on it its nodes lie."""
    after: dict[int, tuple[int, int]] = {}
    before: dict[int, tuple[int, int]] = {}
    for (p, q), left, right in zip(over.segments[mine].tolist(), over.left[mine].tolist(),
                                   over.right[mine].tolist(), strict=True):  # fmt: skip
        forward = along[q] > along[p]
        if closed and abs(along[q] - along[p]) > 0.5 * length:
            forward = not forward
        if not forward:
            p, q, left, right = q, p, right, left
        after[p] = before[q] = (left, right)
    rows = []
    for node in sorted(along, key=lambda n: along[n]):
        sides = after.get(node) or before.get(node)
        end = not closed and (node not in after or node not in before)
        if sides is not None and (on_grid[node] or end):
            rows.append(_Row(node, along[node], end, sides))
    return rows


def _see(over: Overlay, topology: Topology, grid: OrthogonalGrid, rows: list[_Row]) -> None:
    """Gives all points their copies: the vertices of the face's quad, counting ones first, and their weights."""
    nodes = np.repeat(np.array([row.node for row in rows], dtype=np.int64), 2)
    faces = np.array([row.faces for row in rows], dtype=np.int64).reshape(-1)
    solid = np.flatnonzero((faces >= 0) & (topology.face_quad[faces] >= 0))
    nodes, faces = nodes[solid], faces[solid]
    weights = weights_at(over, grid, nodes, over.cell[faces])
    order = np.argsort(np.abs(weights) == 0, axis=1, kind="stable")
    vertices = np.take_along_axis(topology.quads[topology.face_quad[faces]], order, axis=1)
    weights = np.take_along_axis(weights, order, axis=1)
    for k, copy in zip(solid.tolist(), zip(vertices, weights, strict=True), strict=True):
        if k % 2 == 0:
            rows[k // 2].left = copy
        else:
            rows[k // 2].right = copy


class _Builder:
    """Collects crease points chain by chain into the arrays of CreasePoints."""

    def __init__(self, over: Overlay, topology: Topology, grid: OrthogonalGrid) -> None:
        self.over, self.topology = over, topology
        self.flat = np.column_stack([grid.xs[topology.vertex_grid[:, 0]], grid.ys[topology.vertex_grid[:, 1]]])
        self.rank = self.flat.sum(axis=1).tolist()
        self.rows: list[tuple[object, ...]] = []
        self.carrier: list[int] = []
        self.fold: list[tuple[list[int], list[float], list[int]]] = []

    def add_chain(
        self, chain: int, crease: int, closed: bool, rows: list[_Row], tangents: FloatArray, length: float
    ) -> None:
        base = len(self.rows)
        for row in rows:
            row.left_pair, row.right_pair = self._pair(row.left), self._pair(row.right)
        for row, tangent in zip(rows, tangents, strict=True):
            left_edge, right_edge, cos2 = self._edges(row, tangent)
            blank = (np.full(4, -1, dtype=np.int64), np.zeros(4))
            left, right = row.left or blank, row.right or blank
            self.rows.append((self.over.points[row.node], chain, crease, row.along, row.end, tangent,
                              *left, *right, left_edge, right_edge, cos2))  # fmt: skip
        for k in range(len(rows)):
            stencil = self._fold_stencil(rows, k, closed, length)
            if stencil is not None:
                vertices, weights, neighbours = stencil
                self.carrier.append(base + k)
                self.fold.append((vertices, weights, [base + m for m in neighbours]))

    def _pair(self, copy: _Copy) -> _Pair:
        if copy is None:
            return None
        vertices, weights = copy
        counting = int(np.count_nonzero(weights))
        if counting == 2:
            a, b, t = int(vertices[0]), int(vertices[1]), float(weights[1])
            if self.rank[b] < self.rank[a]:
                a, b, t = b, a, 1.0 - t
            return a, b, t
        if counting == 1:
            a = int(vertices[0])
            around = self.topology.neighbours[a]
            for direction in range(4):
                if around[direction] >= 0:
                    return a, int(around[direction]), 0.0
        return None

    def _edges(self, row: _Row, tangent: FloatArray) -> tuple[list[int], list[int], float]:
        none = ([-1, -1], [-1, -1], np.nan)
        if row.end or row.left is None or row.right is None:
            return none
        counting = int(np.count_nonzero(row.left[1]))
        if counting == 2:
            left, right = row.left_pair, row.right_pair
            assert left is not None
            if right is None or left[:2] == right[:2]:
                return none
            edges = [left[0], left[1]], [right[0], right[1]]
        elif counting == 1:
            # On a grid vertex: the most transverse grid direction, inward on each side.
            axis = int(abs(tangent[0]) > abs(tangent[1]))
            normal = np.array([-tangent[1], tangent[0]])  # to the left
            to_left = axis if normal[axis] > 0 else axis + 2
            a, b = int(row.left[0][0]), int(row.right[0][0])
            outer_left = int(self.topology.neighbours[a, to_left])
            outer_right = int(self.topology.neighbours[b, (to_left + 2) % 4])
            if a == b or outer_left < 0 or outer_right < 0:
                return none
            edges = [a, outer_left], [outer_right, b]
        else:
            return none
        step = self.flat[edges[0][1]] - self.flat[edges[0][0]]
        cosine = float(step @ tangent / np.hypot(*step))
        if abs(cosine) > np.cos(MIN_EDGE_ANGLE):
            return none
        return *edges, cosine * cosine

    def _fold_stencil(
        self, rows: list[_Row], k: int, closed: bool, length: float
    ) -> tuple[list[int], list[float], list[int]] | None:
        row = rows[k]
        left, right = row.left_pair, row.right_pair
        if row.end or left is None or right is None or left[:2] == right[:2]:
            return None
        if not MIN_EDGE_PART <= left[2] <= 1 - MIN_EDGE_PART:
            return None
        found = [self._neighbour(rows, k, step, closed, length) for step in (-1, 1)]
        if found[0] is None or found[1] is None:
            return None
        (m_before, before), (m_after, after) = found[0], found[1]
        here = self._place(left)
        back, front = self._place(before) - here, self._place(after) - here
        edge = self.flat[left[1]] - self.flat[left[0]]
        nb, nf, ne, nc = (float(np.hypot(*v)) for v in (back, front, edge, front - back))
        curvature = 2 * abs(front[0] * back[1] - front[1] * back[0]) / (nb * nf * nc)
        angle = min(_line_angle(edge / ne, back / nb), _line_angle(edge / ne, front / nf))
        if curvature < MIN_CURVATURE or angle < MIN_EDGE_ANGLE:
            return None
        neighbours = [row for m in (m_before, m_after) for row in self._both(rows[m])]
        vertices = [*left[:2], *right[:2], *neighbours]
        return vertices, [left[2], before[2], after[2]], [m_before, m_after]

    def _both(self, row: _Row) -> tuple[int, ...]:
        """The pairs of a point in the left and the right patch; a missing right one is replaced by the left."""
        left, right = row.left_pair, row.right_pair
        assert left is not None
        return (*left[:2], *(right or left)[:2])

    def _neighbour(
        self, rows: list[_Row], k: int, step: int, closed: bool, length: float
    ) -> tuple[int, tuple[int, int, float]] | None:
        fallback = None
        for n in range(1, len(rows)):
            m = k + step * n
            if closed:
                m %= len(rows)
            elif not 0 <= m < len(rows):
                break
            distance = abs(rows[m].along - rows[k].along)
            distance = min(distance, length - distance) if closed else distance
            pair = rows[m].left_pair
            if pair is None:
                continue
            if distance >= NEIGHBOUR_SPACING:
                return m, pair
            if distance >= NEIGHBOUR_SPACING_AT_END:
                fallback = (m, pair)
        return fallback

    def _place(self, pair: tuple[int, int, float]) -> FloatArray:
        a, b, t = pair
        return (1 - t) * self.flat[a] + t * self.flat[b]

    def finish(self) -> CreasePoints:
        columns = list(zip(*self.rows, strict=True)) if self.rows else [()] * 13
        shapes: list[tuple[type, tuple[int | None, ...]]] = [
            (float, (None, 2)), (int, (None,)), (int, (None,)), (float, (None,)), (bool, (None,)),
            (float, (None, 2)), (int, (None, 4)), (float, (None, 4)), (int, (None, 4)), (float, (None, 4)),
            (int, (None, 2)), (int, (None, 2)), (float, (None,)),
        ]  # fmt: skip
        arrays = [
            frozen_array(column, dtype, shape, "crease points")
            for column, (dtype, shape) in zip(columns, shapes, strict=True)
        ]
        names = [field.name for field in fields(CreasePoints)]
        arrays.append(frozen_array(self.carrier, int, (None,), "carrier"))
        arrays.append(frozen_array([v for v, _, _ in self.fold], int, (None, 12), "fold_vertices"))
        arrays.append(frozen_array([w for _, w, _ in self.fold], float, (None, 3), "fold_weights"))
        arrays.append(frozen_array([n for _, _, n in self.fold], int, (None, 2), "fold_neighbours"))
        return CreasePoints(**dict(zip(names, arrays, strict=True)))


def _line_angle(u: FloatArray, v: FloatArray) -> float:
    return float(np.arctan2(abs(u[0] * v[1] - u[1] * v[0]), abs(u @ v)))


def _tangents(lines: NDArray[np.object_], lengths: FloatArray, closed: BoolArray, along: FloatArray) -> FloatArray:
    """Unit tangents (N,2) of polylines (N,) at the places ``along`` (N,) on them."""
    step = np.minimum(_TANGENT_STEP, 0.05 * lengths)
    before, after = along - step, along + step
    places = [np.where(closed, at % lengths, np.clip(at, 0, lengths)) for at in (before, after)]
    ends = [shapely.get_coordinates(shapely.line_interpolate_point(lines, at)) for at in places]
    result = ends[1] - ends[0]
    return np.asarray(result / np.hypot(*result.T)[:, None])
