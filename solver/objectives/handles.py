"""Handles: points of the sheet drawn to targets in space (paper, section 6.2, positional constraints)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..optimize.term import LinearTerm


def handles(vertices: IntArray, weights: FloatArray, targets: FloatArray, stiffness: FloatArray) -> LinearTerm:
    """vertices, weights (H,4) of the points; targets (H,3) net units; stiffness (H,)."""
    return LinearTerm("handles", vertices, weights, targets, stiffness)


@dataclass(frozen=True, eq=False)
class AxisHandles:
    """Handles that pull along some axes only, which need not be the net's own.

    stencil, coefficients (H,4); target (H,3) net units; axes (3,H,3): direction of each axis, zero where the
    handle is free; weight (H,)
    """

    stencil: IntArray
    coefficients: FloatArray
    target: FloatArray
    axes: FloatArray
    weight: FloatArray
    name: str = "handles on axes"

    def residual(self, x: FloatArray) -> FloatArray:
        gap = np.einsum("ckn,nk->nc", x, self.coefficients) - self.target
        return np.einsum("anc,nc->an", self.axes, gap)

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self.residual(x), np.einsum("anc,nk->ackn", self.axes, self.coefficients)
