"""Signed fold angle: mountain or valley, and how far (paper, Lemma 5.1 with Eq. 7 to 9), bounded pull.

With t1, t2 the directions of the two copies of a grid edge at flat angle alpha to the crease, tau along the
crease and b the direction of tau x (t1 + t2), Lemma 5.1 reads <t1 - t2, b> / 2 = sin alpha sin(theta/2) with
the sign of theta: positive for a valley. Eq. 7 asks only for the sign of <t1, tau x t2>, which is sin theta:
beyond 90 degrees its slope leads away from flat, whereas the half angle leads through flat to the other side
from any angle. The crease's direction enters through b alone, which every vector of the osculating plane
gives: a secant will do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..net.piecewise_dog import PiecewiseDog
from .bounded import bounded
from .fold_angle import driven_points

#: Part of its flat length below which tau x (t1 + t2) is rounded: at a fold that is nearly shut.
_SHUT = 0.02
#: Least flat length of tau x (t1 + t2), net units²: a point without neighbours along its crease has no tau at all.
_NO_DIRECTION = 1e-3
#: Points nearer than this along a crease give no direction, net units.
_APART = 0.2


@dataclass(frozen=True, eq=False)
class SignedFold:
    """stencil (n,8): a grid edge in the left and in the right patch, then two vertices each of the points before
    and after on the crease.

    places (2,n): where those two points lie between their vertices; sine (n,) of alpha; flat (n,) length of
    tau x (t1 + t2) on the flat sheet; half (n,) sine of half the asked signed angle
    side (n,): 0 asks for just that angle, +1 for at least, -1 for at most that much; weight (n,)
    """

    stencil: IntArray
    places: FloatArray
    sine: FloatArray
    flat: FloatArray
    half: FloatArray
    side: IntArray
    weight: FloatArray
    name: str = "signed angle"

    def half_angles(self, x: FloatArray) -> FloatArray:
        """(n,) sines of half the signed fold angles."""
        _, _, _, d, _, b = self._frame(x)
        return 0.5 * (d * b).sum(0) / self.sine

    def residual(self, x: FloatArray) -> FloatArray:
        return bounded(self._lack(self.half_angles(x))[0])[0][None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        (t1, t2), (l1, l2), tau, d, size, b = self._frame(x)
        lack, active = self._lack(0.5 * (d * b).sum(0) / self.sine)
        residual, slope = bounded(lack)
        pull = 0.5 * slope * active
        p = d - (d * b).sum(0) * b
        along_s = _cross(p, tau) / size
        g1, g2 = pull * (b + along_s), pull * (along_s - b)
        g1 = (g1 - (g1 * t1).sum(0) * t1) / l1
        g2 = (g2 - (g2 * t2).sum(0) * t2) / l2
        g_tau = pull * _cross(t1 + t2, p) / size
        before, after = self.places
        jacobian = np.stack(
            [-g1, g1, -g2, g2, (before - 1) * g_tau, -before * g_tau, (1 - after) * g_tau, after * g_tau], axis=1
        )
        return residual[None], jacobian[None]

    def _lack(self, half: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Half-chord beyond or short of what is asked (n,), and 1 where it counts."""
        lack = (half - self.half) * self.sine
        active = np.where(self.side == 0, True, lack * self.side < 0).astype(np.float64)
        return lack * active, active

    def _frame(self, x: FloatArray) -> tuple[
        tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray], FloatArray, FloatArray, FloatArray, FloatArray
    ]:  # fmt: skip
        e1, e2 = x[:, 1] - x[:, 0], x[:, 3] - x[:, 2]
        l1, l2 = np.sqrt((e1 * e1).sum(0)), np.sqrt((e2 * e2).sum(0))
        t1, t2 = e1 / l1, e2 / l2
        before, after = self.places
        tau = (1 - after) * x[:, 6] + after * x[:, 7] - (1 - before) * x[:, 4] - before * x[:, 5]
        normal = _cross(tau, t1 + t2)
        size = np.sqrt((normal * normal).sum(0) + (_SHUT * self.flat) ** 2)
        return (t1, t2), (l1, l2), tau, t1 - t2, size, normal / size


def _cross(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])


def signed_fold(
    net: PiecewiseDog,
    points: IntArray,
    degrees: FloatArray,
    side: IntArray | int,
    weight: FloatArray | float,
    name: str,
) -> SignedFold:
    """points (n,): indices of crease points, all of ``signed_points(net)``; degrees, side, weight: one each."""
    crease = net.crease_points
    place = {int(k): n for n, k in enumerate(signed_points(net))}
    rows = np.array([place[int(k)] for k in points], dtype=np.int64)
    neighbours, places = _secants(net)
    stencil = np.hstack([crease.left_edge[points], crease.right_edge[points], neighbours[rows]])
    flat = net.flat[stencil]
    step = flat[:, 1] - flat[:, 0]
    along = places[rows]
    tau = (
        (1 - along[:, 1:]) * flat[:, 6] + along[:, 1:] * flat[:, 7]
        - (1 - along[:, :1]) * flat[:, 4] - along[:, :1] * flat[:, 5]
    )  # fmt: skip
    twist = np.abs(tau[:, 0] * step[:, 1] - tau[:, 1] * step[:, 0]) / np.hypot(*step.T)
    n = len(points)
    return SignedFold(
        stencil, np.ascontiguousarray(along.T), np.sqrt(1 - crease.cos2[points]),
        np.maximum(2 * twist, _NO_DIRECTION),
        np.sin(np.radians(degrees) / 2), np.broadcast_to(np.asarray(side, dtype=np.int64), n).copy(),
        np.broadcast_to(np.asarray(weight, dtype=np.float64), n).copy(), name,
    )  # fmt: skip


def signed_points(net: PiecewiseDog) -> IntArray:
    """Crease points (n,) whose signed fold angle can be asked for: all driven ones."""
    return driven_points(net)


def _secants(net: PiecewiseDog) -> tuple[IntArray, FloatArray]:
    """For each of ``signed_points``: two vertices of the left patch each for the points before and after (n,4),
    and where the points lie between them (n,2). A point without a neighbour on a grid edge stands in for it.
    """
    crease = net.crease_points
    vertices, places = [], []
    for k in signed_points(net).tolist():
        row: list[int] = []
        along: list[float] = []
        for step in (-1, 1):
            m = _onward(net, k, step)
            a, b, t = _pair(crease.left_vertices[m], crease.left_weights[m])
            row += [a, b]
            along.append(t)
        vertices.append(row)
        places.append(along)
    return np.array(vertices, dtype=np.int64).reshape(-1, 4), np.array(places).reshape(-1, 2)


def _onward(net: PiecewiseDog, k: int, step: int) -> int:
    """The next crease point of the same chain that a grid edge of the same patch carries, or k itself."""
    crease = net.crease_points
    patch = net.vertex_patch[crease.left_vertices[k, 0]]
    for m in (k + step, k + 2 * step):
        if not 0 <= m < len(crease.chain) or crease.chain[m] != crease.chain[k]:
            break
        counting = np.count_nonzero(crease.left_weights[m])
        same = crease.left_vertices[m, 0] >= 0 and net.vertex_patch[crease.left_vertices[m, 0]] == patch
        if counting in (1, 2) and same and abs(crease.along[m] - crease.along[k]) > _APART:
            return m
    return k


def _pair(vertices: IntArray, weights: FloatArray) -> tuple[int, int, float]:
    """The grid edge that carries a copy, counting vertices first, and the copy's place on it."""
    return int(vertices[0]), int(vertices[1]), float(weights[1]) if np.count_nonzero(weights) == 2 else 0.0
