"""Handles: points of the sheet drawn to targets in space (paper, section 6.2, positional constraints)."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray, IntArray
from ..optimize.term import LinearTerm


def handles(vertices: IntArray, weights: FloatArray, targets: FloatArray, weight: float) -> LinearTerm:
    """vertices, weights (H,4) of the points; targets (H,3) net units."""
    return LinearTerm("handles", vertices, weights, targets, np.full(len(vertices), weight))
