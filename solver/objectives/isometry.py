"""Isometry: (|e|² - l²)² over all net edges, copies included (paper, Eq. 13)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..net.piecewise_dog import PiecewiseDog


@dataclass(frozen=True, eq=False)
class Isometry:
    """stencil (n,2) edges; rest_squared (n,) net units²; weight (n,)."""

    stencil: IntArray
    rest_squared: FloatArray
    weight: FloatArray
    name: str = "isometry"

    def residual(self, x: FloatArray) -> FloatArray:
        e = x[:, 1] - x[:, 0]
        return ((e * e).sum(0) - self.rest_squared)[None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        e = x[:, 1] - x[:, 0]
        residual = ((e * e).sum(0) - self.rest_squared)[None]
        return residual, np.stack([-2 * e, 2 * e], axis=1)[None]

    def edge_stiffness(self, residual: FloatArray) -> FloatArray:
        """4 w r of stretched edges: a pulled string resists sideways, and without it steps overshoot sideways."""
        return 4 * self.weight * np.maximum(residual[0], 0.0)


def isometry(net: PiecewiseDog, weight: float) -> Isometry:
    """``weight`` is divided by the number of edges, as in the paper (section 6.2)."""
    count = len(net.edges)
    return Isometry(net.edges, net.edge_length**2, np.full(count, weight / count))
