"""Segments of drawn outlines: lines, cubics and elliptic arcs, transformed exactly and sampled finely."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from ..errors import PatternError

#: Largest distance between a curve and its samples, relative to the drawing's longer side. Half of the
#: promised 1e-5, because the side is measured on control points, which may lie outside the curve.
SAGITTA = 0.5e-5
#: Samples of a curved segment at least, however flat it is.
MIN_SAMPLES = 16
#: Points of a whole drawing. A drawing that needs more is not a crease pattern a net could carry.
MAX_POINTS = 200_000
#: A cubic this close to its chord (relative to the drawing) is a straight line drawn as a curve.
STRAIGHT = 1e-9
#: Allowed error of the cubics that stand for an arc, relative to the drawing's longer side.
ARC_AS_CUBICS = 1e-6
#: Cubics in one arc; needed only by arcs much larger than the drawing.
MAX_ARC_CUBICS = 64


@dataclass(frozen=True, eq=False)
class Segment:
    """One piece of an outline.

    kind    line: points (2,2) are its ends; cubic: (4,2) its control points;
            arc: (5,2) start, end, centre, and the two conjugate radius *vectors* u, v
    angles  of an arc: start t and signed sweep of centre + cos(t) u + sin(t) v, radians
    """

    kind: Literal["line", "cubic", "arc"]
    points: FloatArray
    angles: tuple[float, float] = (0.0, 0.0)

    @property
    def start(self) -> FloatArray:
        return np.asarray(self.points[0])

    @property
    def end(self) -> FloatArray:
        return np.asarray(self.points[1] if self.kind == "arc" else self.points[-1])

    def transformed(self, matrix: FloatArray) -> Segment:
        """Under an affine (3,3) ``matrix``: exact for every kind, also for arcs that are sheared."""
        points = self.points @ matrix[:2, :2].T
        if self.kind == "arc":
            points[:3] += matrix[:2, 2]
        else:
            points += matrix[:2, 2]
        return Segment(self.kind, points, self.angles)

    def at_angles(self, t: FloatArray) -> FloatArray:
        """(n,2) points of an arc."""
        _, _, centre, u, v = self.points
        return np.asarray(centre + np.cos(t)[:, None] * u + np.sin(t)[:, None] * v)

    def hull(self) -> FloatArray:
        """(n,2) points whose box holds the segment."""
        if self.kind != "arc":
            return self.points
        t0, sweep = self.angles
        return np.vstack([self.points[:2], self.at_angles(np.linspace(t0, t0 + sweep, 17))])


def line(start: ArrayLike, end: ArrayLike) -> Segment:
    return Segment("line", np.array([start, end], dtype=np.float64))


def cubic(points: ArrayLike) -> Segment:
    return Segment("cubic", np.array(points, dtype=np.float64))


def quadratic(start: complex, control: complex, end: complex) -> Segment:
    """A quadratic Bezier, elevated: the same curve as a cubic."""
    first, second = start + (control - start) * (2 / 3), end + (control - end) * (2 / 3)
    return cubic([(p.real, p.imag) for p in (start, first, second, end)])


def arc(
    start: ArrayLike, end: ArrayLike, centre: ArrayLike, u: ArrayLike, v: ArrayLike, t0: float, sweep: float
) -> Segment:
    return Segment("arc", np.array([start, end, centre, u, v], dtype=np.float64), (t0, sweep))


@dataclass(frozen=True, eq=False)
class Subpath:
    """Joined segments; ``closed`` when the drawing closes them (with Z, or by being a closed shape)."""

    segments: tuple[Segment, ...]
    closed: bool

    def transformed(self, matrix: FloatArray) -> Subpath:
        return Subpath(tuple(segment.transformed(matrix) for segment in self.segments), self.closed)

    def hull(self) -> FloatArray:
        return np.vstack([segment.hull() for segment in self.segments])


@dataclass(frozen=True, eq=False)
class Curve:
    """A sampled subpath: points (P,2), a closed one without repeating its first; beziers (S,4,2) or None."""

    points: FloatArray
    closed: bool
    beziers: FloatArray | None


def sample(subpath: Subpath, size: float, budget: int) -> Curve | None:
    """``subpath`` as points, None when it has no length.

    ``size`` is the drawing's longer side in the same units; at most ``budget`` points. Raises PatternError.
    """
    pieces: list[FloatArray] = []
    beziers: list[FloatArray] | None = []
    left = budget
    for segment in subpath.segments:
        straight = segment.kind == "line" or _is_straight(segment, STRAIGHT * size)
        if straight and np.array_equal(segment.start, segment.end):
            continue
        if straight:
            points = np.array([segment.start, segment.end])
        else:
            count = _sample_count(segment, SAGITTA * size)
            if count > left:
                raise PatternError(f"the drawing needs more than {MAX_POINTS:,} points")
            points = _sampled(segment, count)
        left -= len(points) - 1
        if left < 0:
            raise PatternError(f"the drawing needs more than {MAX_POINTS:,} points")
        pieces.append(points if not pieces else points[1:])
        if beziers is not None:
            cubics = _as_cubics(segment, straight, ARC_AS_CUBICS * size)
            if cubics is None:
                beziers = None
            else:
                beziers.extend(cubics)
    if not pieces:
        return None
    points = np.vstack(pieces)
    points = points[np.concatenate([[True], (np.diff(points, axis=0) != 0.0).any(axis=1)])]
    joined = bool(np.hypot(*(points[0] - points[-1])) <= STRAIGHT * size)
    closed = (subpath.closed or joined) and len(points) >= 4
    if closed and joined:
        points = points[:-1]
    if len(points) < 2:
        return None
    return Curve(points, closed, np.array(beziers) if beziers else None)


def _is_straight(segment: Segment, tolerance: float) -> bool:
    """Whether a cubic covers its chord and nothing else."""
    if segment.kind != "cubic":
        return False
    chord = segment.end - segment.start
    length = float(np.hypot(*chord))
    offsets = segment.points[1:3] - segment.start
    if length <= tolerance:
        return bool(np.hypot(*offsets.T).max() <= tolerance)
    along = offsets @ chord / length
    across = offsets @ np.array([-chord[1], chord[0]]) / length
    return bool(
        np.abs(across).max() <= tolerance and along.min() >= -tolerance and along.max() <= length + tolerance
    )


def _sample_count(segment: Segment, tolerance: float) -> int:
    """Points, ends included, so that no chord is further than ``tolerance`` from the curve."""
    if segment.kind == "cubic":
        p = segment.points
        # |B''| <= 6 max |second difference|, and a chord's sagitta is at most |B''| h^2 / 8.
        bend = 6.0 * float(np.hypot(*(p[:-2] - 2 * p[1:-1] + p[2:]).T).max())
        pieces = math.sqrt(bend / (8.0 * tolerance)) if tolerance > 0 else math.inf
    else:
        radius = float(np.linalg.norm(segment.points[3:], 2))
        ratio = tolerance / radius if radius > 0 else 1.0
        # Sagitta of a circle: r (1 - cos(step / 2)); written with arcsin, which keeps its digits.
        step = 4.0 * math.asin(math.sqrt(min(ratio, 1.0) / 2.0))
        pieces = abs(segment.angles[1]) / step if step > 0 else math.inf
    if not pieces < MAX_POINTS:
        return MAX_POINTS + 1
    return max(math.ceil(pieces) + 1, MIN_SAMPLES)


def _sampled(segment: Segment, count: int) -> FloatArray:
    t = np.linspace(0.0, 1.0, count)
    if segment.kind == "arc":
        points = segment.at_angles(segment.angles[0] + segment.angles[1] * t)
    else:
        points = evaluate_cubic(segment.points, t)
    # The drawn ends exactly, so that neighbours share them.
    points[0], points[-1] = segment.start, segment.end
    return points


def evaluate_cubic(control: FloatArray, t: FloatArray) -> FloatArray:
    """(n,2) points of a cubic Bezier with (4,2) control points."""
    s = 1.0 - t
    weights = np.stack([s**3, 3 * s**2 * t, 3 * s * t**2, t**3], axis=1)
    return np.asarray(weights @ control, dtype=np.float64)


def _as_cubics(segment: Segment, straight: bool, tolerance: float) -> list[FloatArray] | None:
    if straight:
        start, end = segment.start, segment.end
        return [np.array([start, start + (end - start) / 3, end - (end - start) / 3, end])]
    if segment.kind == "cubic":
        return [segment.points]
    radius = float(np.linalg.norm(segment.points[3:], 2))
    t0, sweep = segment.angles
    count = max(math.ceil(abs(sweep) / (math.pi / 2)), 1)
    while _arc_error(abs(sweep) / count) * radius > tolerance:
        count += 1
        if count > MAX_ARC_CUBICS:
            return None
    angles = t0 + sweep * np.linspace(0.0, 1.0, count + 1)
    points = segment.at_angles(angles)
    points[0], points[-1] = segment.start, segment.end
    _, _, _, u, v = segment.points
    handle = 4.0 / 3.0 * math.tan(sweep / count / 4.0)
    tangents = handle * (-np.sin(angles)[:, None] * u + np.cos(angles)[:, None] * v)
    return [
        np.array([points[k], points[k] + tangents[k], points[k + 1] - tangents[k + 1], points[k + 1]])
        for k in range(count)
    ]


def _arc_error(angle: float) -> float:
    """Upper bound of the radial error of the usual cubic for an arc of a unit circle (Goldapp 1991)."""
    return 4.0 / 27.0 * math.sin(angle / 4.0) ** 6 / math.cos(angle / 4.0) ** 2


def bounds(subpaths: Sequence[Subpath]) -> tuple[float, float, float, float]:
    """x minimum, y minimum, x maximum, y maximum of all subpaths."""
    points = np.vstack([subpath.hull() for subpath in subpaths])
    low, high = points.min(axis=0), points.max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
