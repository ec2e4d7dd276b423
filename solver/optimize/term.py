"""What a term is. The assembler knows indices, a term knows only the vertices of one stencil.

Arrays run stencil-last (structure of arrays), which is what makes numpy fast here:
x (3, k, n): coordinate, place in the stencil, stencil.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from ..arrays import FloatArray, IntArray


class ResidualTerm(Protocol):
    """Sum over n stencils of weight · |residual|²; its Hessian is the Gauss-Newton one, 2 weight JᵀJ."""

    @property
    def name(self) -> str: ...

    @property
    def stencil(self) -> IntArray:
        """(n,k) vertices."""

    @property
    def weight(self) -> FloatArray:
        """(n,)"""

    def residual(self, x: FloatArray) -> FloatArray:
        """(r,n) of x (3,k,n)."""

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residual (r,n) and Jacobian (r,3,k,n)."""


@runtime_checkable
class EdgeTerm(ResidualTerm, Protocol):
    """A term of edges (k = 2) with more than the Gauss-Newton Hessian: edge_stiffness · |difference|²/2."""

    def edge_stiffness(self, residual: FloatArray) -> FloatArray:
        """(n,), not negative, of a residual (1,n)."""


@dataclass(frozen=True, eq=False)
class LinearTerm:
    """Sum over rows of weight · |Σ coefficient · vertex - target|²: the same row for x, y and z.

    stencil, coefficients (n,k); target (n,3); weight (n,). A coefficient of zero marks an unused place.
    """

    name: str
    stencil: IntArray
    coefficients: FloatArray
    target: FloatArray
    weight: FloatArray

    def residual(self, x: FloatArray) -> FloatArray:
        """(3,n) of x (3,k,n)."""
        return np.asarray(np.einsum("ckn,nk->cn", x, self.coefficients) - self.target.T)

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residual (3,n) and constant Jacobian (3,3,k,n)."""
        jacobian = np.eye(3)[:, :, None, None] * self.coefficients.T[None, None]
        return self.residual(x), jacobian


def gather(x: FloatArray, stencil: IntArray) -> FloatArray:
    """(3,k,n) from x (3,V) and a stencil (n,k)."""
    return np.asarray(x[:, stencil.T])
