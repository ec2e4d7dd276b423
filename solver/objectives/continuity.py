"""Continuity: the copies of a crease point coincide (paper, section 6.2; method, section 2)."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..net.piecewise_dog import PiecewiseDog
from ..optimize.term import LinearTerm


def continuity(net: PiecewiseDog, weight: float) -> LinearTerm:
    """One row a pair of copies."""
    stitches = net.stitches
    count = len(stitches.vertices)
    return LinearTerm(
        "continuity", stitches.vertices, stitches.weights, np.zeros((count, 3)), np.full(count, weight)
    )


def gaps(net: PiecewiseDog, x: FloatArray) -> FloatArray:
    """(n,) distances of the two copies of each crease point, net units."""
    stitches = net.stitches
    between = np.einsum("nk,nkc->nc", stitches.weights, x[stitches.vertices])
    return np.asarray(np.linalg.norm(between, axis=1))


def mean_gap(net: PiecewiseDog, x: FloatArray) -> float:
    """Mean distance of two copies of a crease point, net units; 0 without creases."""
    return float(gaps(net, x).mean()) if len(net.stitches.vertices) else 0.0
