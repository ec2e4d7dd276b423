"""Tangent planes at crease points, second order in the grid: for measuring only, no term uses them.

The directions along and across the grid edge at a crease point are linear in the net's vertices. They give the
surface normal of either patch and the crease's tangent, and so the signed fold angle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from ..arrays import FloatArray, IntArray
from .piecewise_dog import PiecewiseDog


@dataclass(frozen=True, eq=False)
class CreaseFrames:
    """Per crease point with a tangent plane on both sides: sparse rows for ∂x and ∂y in each patch.

    points (n,) indices into the crease points; left_x, left_y, right_x, right_y (n,V)
    """

    points: IntArray
    left_x: csr_matrix
    left_y: csr_matrix
    right_x: csr_matrix
    right_y: csr_matrix
    tangent: FloatArray

    def angles(self, positions: FloatArray) -> FloatArray:
        """Signed fold angles (n,) in degrees, valley positive seen from the sheet's front (+z when flat)."""
        lx, ly = self.left_x @ positions, self.left_y @ positions
        rx, ry = self.right_x @ positions, self.right_y @ positions
        left, right = np.cross(lx, ly), np.cross(rx, ry)
        t = self.tangent
        tangent = t[:, :1] * (lx + rx) + t[:, 1:] * (ly + ry)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        # Turn of the normal about the crease: from right to left is a valley (both sides rise).
        sine = np.einsum("nc,nc->n", np.cross(right, left), tangent)
        # The normals are nearly perpendicular to the tangent; their part along it is error, not angle.
        left = left - np.einsum("nc,nc->n", left, tangent)[:, None] * tangent
        right = right - np.einsum("nc,nc->n", right, tangent)[:, None] * tangent
        cosine = np.einsum("nc,nc->n", left, right)
        return np.asarray(np.degrees(np.arctan2(sine, cosine)))


def crease_frames(net: PiecewiseDog) -> CreaseFrames:
    """Derivative rows at every inner crease point that lies on a grid line."""
    points = net.crease_points
    chosen, rows = [], []
    for k in range(len(points.position)):
        if points.end[k]:
            continue
        sides = [
            _derivatives(net, vertices, weights)
            for vertices, weights in (
                (points.left_vertices[k], points.left_weights[k]),
                (points.right_vertices[k], points.right_weights[k]),
            )
        ]
        if any(side is None for side in sides):
            continue
        if np.array_equal(points.left_vertices[k], points.right_vertices[k]):
            continue
        chosen.append(k)
        rows.append([row for side in sides if side is not None for row in side])
    index = np.array(chosen, dtype=np.int64)
    lx, ly, rx, ry = (_matrix([row[m] for row in rows], len(net.flat)) for m in range(4))
    return CreaseFrames(index, lx, ly, rx, ry, points.tangent[index])


_Row = dict[int, float]


def _matrix(rows: list[_Row], count: int) -> csr_matrix:
    lengths = [len(row) for row in rows]
    columns = [c for row in rows for c in row]
    values = [v for row in rows for v in row.values()]
    start = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
    return csr_matrix((np.array(values), np.array(columns, dtype=np.int64), start), shape=(len(rows), count))


def _derivatives(net: PiecewiseDog, vertices: IntArray, weights: FloatArray) -> tuple[_Row, _Row] | None:
    counting = int(np.count_nonzero(weights))
    if vertices[0] < 0 or counting not in (1, 2):
        return None
    a = int(vertices[0])
    if counting == 1:
        both = [_across(net, a, axis) for axis in (0, 1)]
        return None if both[0] is None or both[1] is None else (both[0], both[1])
    b, t = int(vertices[1]), float(weights[1])
    axis = int(abs(net.flat[b, 1] - net.flat[a, 1]) > abs(net.flat[b, 0] - net.flat[a, 0]))
    if net.flat[b, axis] < net.flat[a, axis]:
        a, b, t = b, a, 1.0 - t
    along = _along(net, a, b, t, axis)
    near, far = _across(net, a, 1 - axis), _across(net, b, 1 - axis)
    if near is None or far is None:
        return None
    across: _Row = {}
    for row, share in ((near, 1 - t), (far, t)):
        for v, c in row.items():
            across[v] = across.get(v, 0.0) + share * c
    return (along, across) if axis == 0 else (across, along)


def _along(net: PiecewiseDog, a: int, b: int, t: float, axis: int) -> _Row:
    """Derivative at a + t (b - a) of the parabola through a, b and the next vertex of the patch on its own side.

    The mean of two parabolas where neither end tells more than the other, so that no direction is preferred.
    """
    u = net.flat[:, axis]
    at = float(u[a] + t * (u[b] - u[a]))
    before, after = int(net.neighbours[a, axis + 2]), int(net.neighbours[b, axis])
    # The vertex on the patch's own side has a whole neighbourhood; the other one is an extension.
    first = before >= 0 and (after < 0 or _inner(net, a) or not _inner(net, b))
    second = after >= 0 and (before < 0 or _inner(net, b) or not _inner(net, a))
    thirds = [third for third, good in ((before, first), (after, second)) if good]
    if not thirds:
        length = float(u[b] - u[a])
        return {a: -1 / length, b: 1 / length}
    row: _Row = {}
    for third in thirds:
        for v, c in _parabola([a, b, third], [float(u[v]) for v in (a, b, third)], at).items():
            row[v] = row.get(v, 0.0) + c / len(thirds)
    return row


def _inner(net: PiecewiseDog, v: int) -> bool:
    return bool((net.neighbours[v] >= 0).all())


def _parabola(vertices: list[int], u: list[float], at: float) -> _Row:
    """Weights of the derivative at ``at`` of the parabola through three points (Lagrange)."""
    row = {}
    for k in range(3):
        p, q = u[(k + 1) % 3], u[(k + 2) % 3]
        row[vertices[k]] = (2 * at - p - q) / ((u[k] - p) * (u[k] - q))
    return row


def _across(net: PiecewiseDog, v: int, axis: int) -> _Row | None:
    """Derivative at a vertex: central where both neighbours exist, the best one-sided formula elsewhere."""
    u = net.flat[:, axis]
    low, high = int(net.neighbours[v, axis + 2]), int(net.neighbours[v, axis])
    if low >= 0 and high >= 0:
        return _parabola([low, v, high], [float(u[w]) for w in (low, v, high)], float(u[v]))
    only, direction = (high, axis) if high >= 0 else (low, axis + 2)
    if only < 0:
        return None
    beyond = int(net.neighbours[only, direction])
    if beyond >= 0:
        return _parabola([v, only, beyond], [float(u[w]) for w in (v, only, beyond)], float(u[v]))
    step = float(u[only] - u[v])
    return {v: -1 / step, only: 1 / step}
