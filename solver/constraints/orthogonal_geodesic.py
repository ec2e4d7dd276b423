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
        _, n, d = self._turn(x)
        return np.asarray(d * _ahead(n, 2) - _ahead(d, 1) * n)

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        # Row k is _row of the edges k, k + 1, k + 2; all four at once, edges along the second axis.
        e, n, d = self._turn(x)
        n2, d1 = _ahead(n, 2), _ahead(d, 1)
        e1, e2 = np.roll(e, -1, axis=1), np.roll(e, -2, axis=1)
        g1 = e1 * n2 - e * (d1 / n)
        g2 = e * n2 - e2 * n
        g3 = e2 * (d / n2) - e1 * n
        jacobian = np.zeros((4, 3, 5, x.shape[2]))
        for k in range(4):
            jacobian[k, :, 1 + k] = g1[:, k]
            jacobian[k, :, 1 + (k + 1) % 4] = g2[:, k]
            jacobian[k, :, 1 + (k + 2) % 4] = g3[:, k]
        jacobian[:, :, 0] = -(g1 + g2 + g3).transpose(1, 0, 2)
        return d * n2 - d1 * n, jacobian

    def _turn(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Edges (3,4,n), their lengths (4,n), and the dot products (4,n) of each with the next."""
        e = x[:, 1:] - x[:, :1]
        return e, np.sqrt((e * e).sum(0)), (e * np.roll(e, -1, axis=1)).sum(0)


def _ahead(values: FloatArray, steps: int) -> FloatArray:
    """The values (4,n) of the edges so many steps on."""
    return np.roll(values, -steps, axis=0)


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
