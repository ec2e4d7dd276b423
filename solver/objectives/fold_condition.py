"""The fold condition: both patches lie on one side of the crease's osculating plane (paper, Eq. 3).

With T1, T2 the triple products <e, ef x eb> of the two copies of the grid edge, scaled to sines of tilts, the
residual is (T1 + T2) / sqrt((T1 - T2)² + delta²): zero at a fold, large for a point that bends without
folding, and never without a gradient that leads back (method, section 4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..net.piecewise_dog import PiecewiseDog

#: Tilt (sine) below which a point counts as flat (method, section 4).
DELTA = 0.02
#: The smallest rest value by which a triple product is divided: crease points on nearly straight parts.
_MIN_SCALE = 0.02


@dataclass(frozen=True, eq=False)
class FoldCondition:
    """stencil (n,12): a1, b1, a2, b2 (grid edge left and right), the point before (2 left, 2 right) and after.

    Crease points are means of their two copies, so that neither side counts for more.

    places (3,n): position of the crease point, the one before, and the one after along their pairs
    scale (n,): rest value |e||ef x eb|, net units³; weight (n,)
    """

    stencil: IntArray
    places: FloatArray
    scale: FloatArray
    weight: FloatArray
    name: str = "fold condition"

    def tilts(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """T1, T2 (n,) scaled: sines of the tilts of the two edges out of the osculating plane."""
        _, _, binormal = self._frame(x)
        first = ((x[:, 1] - x[:, 0]) * binormal).sum(0) / self.scale
        second = ((x[:, 3] - x[:, 2]) * binormal).sum(0) / self.scale
        return first, second

    def residual(self, x: FloatArray) -> FloatArray:
        a, b = self.tilts(x)
        return ((a + b) / np.sqrt((a - b) ** 2 + DELTA**2))[None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        back, front, binormal = self._frame(x)
        e1, e2 = x[:, 1] - x[:, 0], x[:, 3] - x[:, 2]
        a, b = (e1 * binormal).sum(0) / self.scale, (e2 * binormal).sum(0) / self.scale
        root = np.sqrt((a - b) ** 2 + DELTA**2)
        pull = (a + b) * (a - b) / root**3
        ra, rb = (1 / root - pull) / self.scale, (1 / root + pull) / self.scale
        w = ra * e1 + rb * e2
        g_front, g_back = _cross(back, w), _cross(w, front)
        g_here = -(g_front + g_back)
        t, tb, tf = 0.5 * self.places
        h = 0.5
        jacobian = np.stack(
            [
                (h - t) * g_here - ra * binormal,
                t * g_here + ra * binormal,
                (h - t) * g_here - rb * binormal,
                t * g_here + rb * binormal,
                *((h - tb) * g_back, tb * g_back) * 2,
                *((h - tf) * g_front, tf * g_front) * 2,
            ],
            axis=1,
        )
        return ((a + b) / root)[None], jacobian[None]

    def _frame(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        here, before, after = (
            0.5 * ((1 - t) * (x[:, k] + x[:, k + 2]) + t * (x[:, k + 1] + x[:, k + 3]))
            for k, t in zip((0, 4, 8), self.places, strict=True)
        )
        back, front = before - here, after - here
        return back, front, _cross(front, back)


def _cross(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])


def fold_condition(net: PiecewiseDog, weight: float) -> FoldCondition:
    """The condition at every crease point that carries one."""
    points = net.crease_points
    flat = net.flat[points.fold_vertices]
    here, before, after = (
        (1 - t)[:, None] * flat[:, k] + t[:, None] * flat[:, k + 1]
        for k, t in zip((0, 4, 8), points.fold_weights.T, strict=True)
    )
    back, front = before - here, after - here
    edge = np.hypot(*(flat[:, 1] - flat[:, 0]).T)
    area = np.abs(front[:, 0] * back[:, 1] - front[:, 1] * back[:, 0])
    return FoldCondition(
        points.fold_vertices,
        points.fold_weights.T.copy(),
        np.maximum(edge * area, _MIN_SCALE),
        np.full(len(edge), weight),
    )
