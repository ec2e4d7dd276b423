"""Median fold angles of the creases of a net."""

from __future__ import annotations

import numpy as np

from solver.arrays import FloatArray
from solver.measurement import measure
from solver.net.piecewise_dog import PiecewiseDog


def crease_medians(net: PiecewiseDog, x: FloatArray) -> FloatArray:
    """(creases,) median unsigned fold angle at x (V,3), net units; degrees, 0 where no point has one."""
    m = measure(net, net.frame.to_drawing(x))
    known = np.isfinite(m.fold_angle)
    return np.array(
        [np.median(m.fold_angle[known & (m.crease == k)]) if (known & (m.crease == k)).any() else 0.0
         for k in range(len(net.crease_labels))]
    )  # fmt: skip
