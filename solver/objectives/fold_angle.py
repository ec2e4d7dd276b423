"""Fold angle: <t1, t2> = cos² alpha + sin² alpha cos theta (paper, Lemma 5.1, Eq. 5 and 12), bounded pull.

Only the unsigned angle enters, so one is asked for without choosing mountain or valley. Three changes to the
paper's term, each measured (docs/method.md):
- the tangents are edges divided by their present lengths: divided by rest lengths, <t1, t2> falls to first
  order when the edges shrink but only to second order when a flat crease folds, and the drive would squeeze
  the paper;
- Lemma 5.1 is taken in its half-angle form, |t1 - t2| / 2 = sin alpha sin(theta/2): the same condition, but
  nearly linear in the angle, so that a nearly flat point is pulled about as hard as any other;
- the energy grows like r² for small residuals and like |r| for large ones: a point that cannot reach its
  angle pulls with a bounded force and leaves the paper whole.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..net.piecewise_dog import PiecewiseDog
from .bounded import bounded

#: Chord below which a crease counts as flat: rounds the kink of |t1 - t2| at zero.
FLAT_CHORD = 0.02


@dataclass(frozen=True, eq=False)
class FoldAngle:
    """stencil (n,4): a grid edge in the left patch, the same in the right one.

    cos2 (n,) squared cosine of the flat angle between edge and crease; cosine (n,) of the asked fold angle;
    weight (n,)
    """

    stencil: IntArray
    cos2: FloatArray
    cosine: FloatArray
    weight: FloatArray
    name: str = "fold angle"

    def residual(self, x: FloatArray) -> FloatArray:
        tangents, _ = _tangents(x)
        _, size = _chord(tangents)
        return bounded(0.5 * size - self._asked())[0][None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        (t1, t2), (l1, l2) = _tangents(x)
        chord, size = _chord((t1, t2))
        residual, slope = bounded(0.5 * size - self._asked())
        pull = 0.5 * slope * chord / size
        g1 = (pull - (pull * t1).sum(0) * t1) / l1
        g2 = ((pull * t2).sum(0) * t2 - pull) / l2
        return residual[None], np.stack([-g1, g1, -g2, g2], axis=1)[None]

    def _asked(self) -> FloatArray:
        """sin alpha sin(theta/2), rounded like the chord so that a flat crease satisfies an angle of zero."""
        chord2 = 2 * (1 - self.cos2) * (1 - self.cosine)
        return np.asarray(0.5 * np.sqrt(chord2 + FLAT_CHORD**2))


def _tangents(x: FloatArray) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
    e1, e2 = x[:, 1] - x[:, 0], x[:, 3] - x[:, 2]
    l1, l2 = np.sqrt((e1 * e1).sum(0)), np.sqrt((e2 * e2).sum(0))
    return (e1 / l1, e2 / l2), (l1, l2)


def _chord(tangents: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """t1 - t2 (3,n) and its rounded length (n,)."""
    chord = tangents[0] - tangents[1]
    return chord, np.sqrt((chord * chord).sum(0) + FLAT_CHORD**2)


def driven_points(net: PiecewiseDog) -> IntArray:
    """Crease points (n,) whose fold angle can be asked for: an edge on each side, not along the crease."""
    points = net.crease_points
    return np.flatnonzero(np.isfinite(points.cos2) & (points.left_edge[:, 0] >= 0))


def fold_angle(net: PiecewiseDog, degrees: FloatArray, weight: FloatArray | float) -> FoldAngle:
    """degrees (n,): the asked angle at each of ``driven_points(net)``; weight: one, or one each (n,)."""
    return fold_angle_at(net, np.arange(len(driven_points(net))), degrees, weight)


def fold_angle_at(net: PiecewiseDog, rows: IntArray, degrees: FloatArray, weight: FloatArray | float) -> FoldAngle:
    """The same at some of the driven points: rows (n,) indices into ``driven_points(net)``."""
    points, chosen = net.crease_points, driven_points(net)[rows]
    stencil = np.hstack([points.left_edge[chosen], points.right_edge[chosen]])
    return FoldAngle(stencil, points.cos2[chosen], np.cos(np.radians(degrees)), np.full(len(chosen), weight))
