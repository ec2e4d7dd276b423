"""Four vertices in a plane, or as far from one as they are: what keeps a patch flat, or rigid in its shape.

The signed volumes of all neighbouring fours tell the second fundamental form of a net, and isometry the first:
together they leave only rigid motions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..net.piecewise_dog import PiecewiseDog


@dataclass(frozen=True, eq=False)
class Volume:
    """stencil (n,4); target (n,) six times the volume, net units³; weight (n,)"""

    stencil: IntArray
    target: FloatArray
    weight: FloatArray
    name: str = "patch shapes"

    def residual(self, x: FloatArray) -> FloatArray:
        a, b, c = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0], x[:, 3] - x[:, 0]
        return ((a * _cross(b, c)).sum(0) - self.target)[None]

    def linearize(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        a, b, c = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0], x[:, 3] - x[:, 0]
        ga, gb, gc = _cross(b, c), _cross(c, a), _cross(a, b)
        residual = ((a * ga).sum(0) - self.target)[None]
        return residual, np.stack([-(ga + gb + gc), ga, gb, gc], axis=1)[None]


def _cross(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])


def patch_fours(net: PiecewiseDog, patch: int) -> IntArray:
    """(n,4) all quads of a patch, and each vertex with its two neighbours on a grid line and one beside it."""
    mine = np.flatnonzero(net.vertex_patch == patch)
    around = net.neighbours[mine]
    fours = [net.quads[net.quad_patch == patch]]
    for axis in (0, 1):
        beside = np.where(around[:, 1 - axis] >= 0, around[:, 1 - axis], around[:, 3 - axis])
        row = np.column_stack([mine, around[:, axis], around[:, axis + 2], beside])
        fours.append(row[(row >= 0).all(axis=1)])
    return np.vstack(fours)
