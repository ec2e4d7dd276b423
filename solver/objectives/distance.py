"""The distance between two points of the paper (paper, section 6.2: positional constraints on pairs)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray

#: Rounds the kink of the distance at zero, net units.
_TOUCHING = 1e-3


@dataclass(frozen=True, eq=False)
class Distance:
    """stencil, coefficients (n,k): their sum of products is the difference of two points; length (n,) net units;
    weight (n,)
    """

    stencil: IntArray
    coefficients: FloatArray
    length: FloatArray
    weight: FloatArray
    name: str = "distances"

    def residual(self, x: FloatArray) -> FloatArray:
        return (self._gap(x)[1] - self.length)[None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        gap, size = self._gap(x)
        return (size - self.length)[None], np.einsum("cn,nk->ckn", gap / size, self.coefficients)[None]

    def _gap(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        gap = np.einsum("ckn,nk->cn", x, self.coefficients)
        return gap, np.sqrt((gap * gap).sum(0) + _TOUCHING**2)
