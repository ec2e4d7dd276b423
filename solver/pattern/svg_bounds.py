"""The box of outlines, exact for curves: what CSS calls the fill box."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..arrays import FloatArray
from .segments import Segment, Subpath


def exact_box(subpaths: Iterable[Subpath]) -> tuple[float, float, float, float]:
    """(x0, y0, x1, y1) of at least one outline."""
    points = np.vstack([_extremes(segment) for subpath in subpaths for segment in subpath.segments])
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    return float(x0), float(y0), float(x1), float(y1)


def _extremes(segment: Segment) -> FloatArray:
    """(n,2) points of a segment: its ends, and where it turns back in x or in y."""
    if segment.kind == "line":
        return segment.points
    if segment.kind == "arc":
        _, _, _, u, v = segment.points
        begin, sweep = segment.angles
        turns = np.array([math.atan2(v[axis], u[axis]) + k * math.pi for axis in (0, 1) for k in (0, 1)])
        along = np.mod((turns - begin) * math.copysign(1.0, sweep), math.tau)
        inside = turns[along < abs(sweep)]
        return np.vstack([segment.points[:2], segment.at_angles(inside)])
    a, b, c, d = segment.points
    # The derivative, over 3: p t^2 + q t + r.
    p, q, r = d - a + 3 * (b - c), 2 * (a - 2 * b + c), b - a
    t = np.concatenate([np.roots([p[axis], q[axis], r[axis]]) for axis in (0, 1)])
    t = np.real(t[np.isreal(t)])
    t = np.concatenate([t[(t > 0.0) & (t < 1.0)], [0.0, 1.0]])[:, None]
    return np.asarray((1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d)
