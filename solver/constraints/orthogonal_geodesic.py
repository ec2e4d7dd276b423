"""The DOG angles: all angles around a vertex are equal (Rabinovich et al. 2018a; method, section 2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray


def _row(e1: FloatArray, e2: FloatArray, e3: FloatArray) -> FloatArray:
    """(e1·e2)|e3| - (e2·e3)|e1|: the angles on both sides of e2 are equal. e (3,n), result (n,)."""
    n1, n3 = np.sqrt((e1 * e1).sum(0)), np.sqrt((e3 * e3).sum(0))
    return np.asarray((e1 * e2).sum(0) * n3 - (e2 * e3).sum(0) * n1)


def _row_gradient(
    e1: FloatArray, e2: FloatArray, e3: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The row (n,) and its derivatives (3,n) by e1, e2, e3."""
    n1, n3 = np.sqrt((e1 * e1).sum(0)), np.sqrt((e3 * e3).sum(0))
    d12, d23 = (e1 * e2).sum(0), (e2 * e3).sum(0)
    g1 = e2 * n3 - e1 * (d23 / n1)
    g2 = e1 * n3 - e3 * n1
    g3 = e3 * (d12 / n3) - e2 * n1
    return d12 * n3 - d23 * n1, g1, g2, g3


@dataclass(frozen=True, eq=False)
class StarAngles:
    """The angles at every inner vertex, stencil (n,5): centre, +x, +y, -x, -y. Exact: weight is unused.

    Three of the four rows say all; four keep the penalty the same under quarter turns and mirrors of the grid.
    """

    stencil: IntArray
    name: str = "star angles"

    @property
    def weight(self) -> FloatArray:
        return np.ones(len(self.stencil))

    def residual(self, x: FloatArray) -> FloatArray:
        e = x[:, 1:] - x[:, :1]
        return np.stack([_row(e[:, k], e[:, (k + 1) % 4], e[:, (k + 2) % 4]) for k in range(4)])

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        e = x[:, 1:] - x[:, :1]
        residual = np.empty((4, x.shape[2]))
        jacobian = np.zeros((4, 3, 5, x.shape[2]))
        for k in range(4):
            a, b, c = k, (k + 1) % 4, (k + 2) % 4
            residual[k], g1, g2, g3 = _row_gradient(e[:, a], e[:, b], e[:, c])
            jacobian[k, :, 1 + a], jacobian[k, :, 1 + b], jacobian[k, :, 1 + c] = g1, g2, g3
            jacobian[k, :, 0] = -(g1 + g2 + g3)
        return residual, jacobian


@dataclass(frozen=True, eq=False)
class LinkAngles:
    """One row where two quads meet at a border vertex. stencil (n,4): centre and three neighbours in turn."""

    stencil: IntArray
    name: str = "border angles"

    @property
    def weight(self) -> FloatArray:
        return np.ones(len(self.stencil))

    def residual(self, x: FloatArray) -> FloatArray:
        e = x[:, 1:] - x[:, :1]
        return _row(e[:, 0], e[:, 1], e[:, 2])[None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        e = x[:, 1:] - x[:, :1]
        value, g1, g2, g3 = _row_gradient(e[:, 0], e[:, 1], e[:, 2])
        jacobian = np.stack([-(g1 + g2 + g3), g1, g2, g3], axis=1)
        return value[None], jacobian[None]
