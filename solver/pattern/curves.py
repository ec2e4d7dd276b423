"""Sampling of crease curves: as fine as the grid needs, smooth where the drawing is smooth."""

from __future__ import annotations

import itertools

import numpy as np
from scipy.interpolate import CubicSpline

from ..arrays import FloatArray
from ..errors import PatternError
from .crease_pattern import Crease

#: Turns above this are corners of the drawing, smaller ones are samples of a smooth curve.
CORNER = np.radians(30.0)
#: Points of one sampled crease at most: a thousand sheets long at a usual resolution. What lies off the sheet is
#: sampled as finely as what lies on it.
_MOST_POINTS = 400_000
#: Turns of a zigzag are more than this, radians: smaller ones are rounding.
_TURN = np.radians(1.0)
#: A polyline is a zigzag when this part of its turns is to the other side than the one before.
_ZIGZAG = 0.5
#: A segment this many times longer than the median is a straight part between curved ones.
_STRAIGHT_RATIO = 3.0


def sample_crease(crease: Crease, spacing: float) -> FloatArray:
    """Points (P,2) along a crease at most about ``spacing`` apart where it is curved; drawing units.

    Control points are used where the drawing has them; otherwise coarse samples of a smooth curve are
    joined by a cubic spline. Corners (turns above 30°) stay. A closed crease repeats its first point.
    Raises PatternError when the crease is so long that this would be too many.
    """
    given = crease.points if crease.beziers is None else crease.beziers.reshape(-1, 2)
    cells = float(np.hypot(*np.diff(given, axis=0).T).sum()) / spacing
    if not cells <= _MOST_POINTS:
        raise PatternError(
            "it reaches too far beyond the sheet to be sampled; cut it at the border",
            element=crease.name or "crease",
        )
    if crease.beziers is not None and len(crease.beziers):
        points = _sample_beziers(crease.beziers, spacing)
        if crease.closed and not np.array_equal(points[0], points[-1]):
            points = np.vstack([points, points[:1]])
        return drop_repeats(points)
    points = np.vstack([crease.points, crease.points[:1]]) if crease.closed else crease.points
    points = drop_repeats(points)
    if len(points) < 3:
        return points
    return _densify(points, crease.closed, spacing)


def drop_repeats(points: FloatArray) -> FloatArray:
    """The polyline without consecutive equal points."""
    keep = np.ones(len(points), dtype=bool)
    keep[1:] = np.any(points[1:] != points[:-1], axis=1)
    return points[keep]


def turns(points: FloatArray) -> FloatArray:
    """Turning angle (P-2,) at the inner points of a polyline, radians, unsigned."""
    steps = np.diff(points, axis=0)
    cross = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    return np.abs(np.arctan2(cross, np.sum(steps[:-1] * steps[1:], axis=1)))


def _sample_beziers(beziers: FloatArray, spacing: float) -> FloatArray:
    pieces = []
    for control in beziers:
        chord = control[3] - control[0]
        size = float(np.abs(np.diff(control, axis=0)).sum())
        # Distance of the inner control points from the chord: nothing there means a straight segment. A segment
        # that ends where it starts has no chord, and is a loop.
        offset = np.abs(
            chord[0] * (control[1:3, 1] - control[0, 1]) - chord[1] * (control[1:3, 0] - control[0, 0])
        ).max()
        straight = chord.any() and offset <= 1e-12 * size * max(float(np.hypot(*chord)), 1e-300)
        length = float(np.hypot(*np.diff(control, axis=0).T).sum())
        count = 1 if straight else max(4, int(np.ceil(length / spacing)))
        t = np.linspace(0.0, 1.0, count + 1)[:, None]
        s = 1.0 - t
        pieces.append(
            s**3 * control[0] + 3 * s * s * t * control[1] + 3 * s * t * t * control[2] + t**3 * control[3]
        )
    return np.vstack(pieces)


def _densify(points: FloatArray, closed: bool, spacing: float) -> FloatArray:
    lengths = np.hypot(*np.diff(points, axis=0).T)
    corner = np.zeros(len(points), dtype=bool)
    corner[1:-1] = turns(points) > CORNER
    smooth_ring = False
    if closed:
        around = np.vstack([points[-2], points[0], points[1]])
        smooth_ring = bool(turns(around)[0] <= CORNER)
    straight = lengths > _STRAIGHT_RATIO * np.median(lengths)
    if closed and smooth_ring and not corner.any() and not straight.any() and len(points) > 4:
        return _spline(points, spacing, periodic=True)
    cuts = {0, len(points) - 1, *np.flatnonzero(corner).tolist()}
    for k in np.flatnonzero(straight):
        cuts.update((int(k), int(k) + 1))
    marks = sorted(cuts)
    runs = [points[a : b + 1] for a, b in itertools.pairwise(marks)]
    dense = [run if len(run) < 5 else _spline(run, spacing, periodic=False) for run in runs]
    return drop_repeats(np.vstack(dense))


def is_zigzag(points: FloatArray) -> bool:
    """Whether a polyline turns left and right in turn, which no samples of a smooth curve do."""
    steps = np.diff(points, axis=0)
    cross = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    sides = np.sign(cross[turns(points) > _TURN])
    return len(sides) > 2 and bool((sides[1:] != sides[:-1]).sum() > _ZIGZAG * (len(sides) - 1))


def _spline(points: FloatArray, spacing: float, periodic: bool) -> FloatArray:
    steps = np.hypot(*np.diff(points, axis=0).T)
    if steps.max() <= spacing or turns(points).max() < 1e-7 or is_zigzag(points):
        return points
    along = np.concatenate([[0.0], np.cumsum(steps)])
    curve = CubicSpline(along, points, bc_type="periodic" if periodic else "not-a-knot")
    parts = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) / spacing))), endpoint=False)
        for a, b in itertools.pairwise(along)
    ]
    result = curve(np.concatenate([*parts, along[-1:]]))
    result[0], result[-1] = points[0], points[-1]
    return np.asarray(result)
