"""Bending: integrated squared mean curvature, quadratic in the vertices (paper, Eq. 11; method, section 2)."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..net.piecewise_dog import PiecewiseDog
from ..optimize.term import LinearTerm


def bending(net: PiecewiseDog, weight: float) -> tuple[LinearTerm, LinearTerm]:
    """The inner vertices' Laplacian rows, and second differences along the border of every patch.

    Both are area · (second derivative)² with the vertex's share of the flat area, so the energy of a shape
    does not depend on the grid that samples it.
    """
    flat = net.flat

    def second_difference(centre: FloatArray, a: FloatArray, b: FloatArray) -> tuple[FloatArray, ...]:
        la, lb = np.hypot(*(a - centre).T), np.hypot(*(b - centre).T)
        ca, cb = 2 / (la * (la + lb)), 2 / (lb * (la + lb))
        return -(ca + cb), ca, cb, 0.5 * (la + lb)

    stars = net.stars
    c, e, n, w, s = (flat[stars[:, k]] for k in range(5))
    x0, xa, xb, width = second_difference(c, e, w)
    y0, ya, yb, height = second_difference(c, n, s)
    inner = LinearTerm(
        "bending",
        stars,
        np.column_stack([x0 + y0, xa, ya, xb, yb]),
        np.zeros((len(stars), 3)),
        0.5 * weight * width * height,
    )
    links = net.links
    centre, first, middle, last = (flat[links[:, k]] for k in range(4))
    b0, ba, bb, run = second_difference(centre, first, last)
    # Half of each of the two quads at the link lies on this vertex's side.
    area = 0.5 * run * np.hypot(*(middle - centre).T)
    border = LinearTerm(
        "border bending",
        links[:, [0, 1, 3]],
        np.column_stack([b0, ba, bb]),
        np.zeros((len(links), 3)),
        0.5 * weight * area,
    )
    return inner, border
