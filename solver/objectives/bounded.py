"""A residual whose energy grows like r² when it is small and like |r| when it is large: a bounded force."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

#: Residual from which on the force no longer grows: half a chord, about half a fold angle in radians.
BOUND = 0.05


def bounded(r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """s(r) with s² = 2 b² (sqrt(1 + r²/b²) - 1), b = BOUND, and ds/dr."""
    root = np.sqrt(1 + (r / BOUND) ** 2)
    factor = np.sqrt(2 / (1 + root))
    return r * factor, 1 / (root * factor)
