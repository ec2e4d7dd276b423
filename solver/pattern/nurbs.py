"""Rational B-splines -> cubic Beziers: exact up to the third degree without weights, else within a tolerance."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.interpolate import BSpline

from ..arrays import FloatArray
from ..errors import PatternError
from .segments import Segment, cubic, evaluate_cubics

#: CAD programs draw up to this degree.
MAX_DEGREE = 25
#: Cubics for one span between two knots.
_MAX_PIECES = 256
#: Where a cubic is compared with its curve.
_PLACES = np.array([0.2, 0.5, 0.8])


def spline_segments(
    controls: FloatArray, weights: FloatArray, knots: FloatArray, degree: int, tolerance: float
) -> tuple[Segment, ...]:
    """The cubics along a spline: controls (N,2), weights (N,), knots (N + degree + 1,).

    tolerance: how far a cubic may be from the curve. Raises PatternError when these are no spline.
    """
    _check(controls, weights, knots, degree)
    homogeneous = np.column_stack([controls * weights[:, None], weights])
    # Beginning at its first knot, so that large parameters lose no digits.
    edges = np.unique(knots[degree : len(controls) + 1]) - knots[degree]
    if len(edges) < 2:
        raise PatternError("it is a spline without a length of its own")
    spline = BSpline(knots - knots[degree], homogeneous, degree)
    # The polynomial of each span is that of its beginning, also where the next one does not go on smoothly.
    powers = [spline(edges[:-1], nu=power) / math.factorial(power) for power in range(degree, -1, -1)]
    spans = zip(np.stack(powers, axis=1), np.diff(edges).tolist(), strict=True)
    return tuple(segment for polynomial, length in spans for segment in _span(polynomial, length, tolerance))


def _check(controls: FloatArray, weights: FloatArray, knots: FloatArray, degree: int) -> None:
    if not 1 <= degree <= MAX_DEGREE:
        raise PatternError(f"it is a spline of degree {degree}, and those from 1 to {MAX_DEGREE} are read")
    if len(controls) <= degree or len(knots) != len(controls) + degree + 1 or len(weights) != len(controls):
        raise PatternError("it is a spline whose numbers of points, knots and weights do not fit each other")
    if not all(np.isfinite(values).all() for values in (controls, weights, knots)):
        raise PatternError("it is a spline with numbers that are not finite")
    if (np.diff(knots) < 0).any() or not (weights > 0).all():
        raise PatternError("it is a spline whose knots go back or whose weights are not positive")


def _span(coefficients: FloatArray, length: float, tolerance: float) -> Iterator[Segment]:
    """Cubics for one span: coefficients (degree + 1, 3) of homogeneous polynomials, the highest power first."""
    count = 1
    while True:
        edges = np.linspace(0.0, length, count + 1)
        points, ways = _evaluated(coefficients, edges)
        third = (length / count) / 3.0
        controls = np.stack(
            [points[:-1], points[:-1] + third * ways[:-1], points[1:] - third * ways[1:], points[1:]], axis=1
        )
        exact = (edges[:-1, None] + _PLACES * (length / count)).ravel()
        misses = _evaluated(coefficients, exact)[0] - evaluate_cubics(controls, _PLACES).reshape(-1, 2)
        if np.hypot(*misses.T).max() <= tolerance or count >= _MAX_PIECES:
            return map(cubic, controls)
        count *= 2


def _evaluated(coefficients: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points (n,2) and derivatives (n,2)."""
    value = np.zeros((len(at), 3))
    slope = np.zeros((len(at), 3))
    for row in coefficients:
        slope = slope * at[:, None] + value
        value = value * at[:, None] + row
    points = value[:, :2] / value[:, 2:]
    return points, (slope[:, :2] - points * slope[:, 2:]) / value[:, 2:]
