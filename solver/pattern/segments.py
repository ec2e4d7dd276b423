"""Segments of drawn outlines: lines, cubics and elliptic arcs, transformed exactly and sampled finely."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import BoolArray, FloatArray, IntArray
from ..errors import PatternError

#: Largest distance between a curve and its samples, relative to the drawing's longer side. Half of the
#: promised 1e-5, because the side is measured on control points, which may lie outside the curve.
SAGITTA = 0.5e-5
#: Drawings of thousands of curves have short ones: a cubic shorter than this part of the drawing's longer side may
#: be missed by this part of its own length.
_SHORT = 1e-2
_SAGITTA_OF_SHORT = 4e-3
#: Samples of a curved segment at least, however flat it is; of one that is short beside the drawing fewer, in
#: proportion: this many on a segment as long as the drawing, and never fewer than the third number.
MIN_SAMPLES = 16
_SAMPLES_OF_SIZE = 320
LEAST_SAMPLES = 5
#: Samples of a straight one: its ends.
_STRAIGHT_SAMPLES = 2
#: Larger numbers cannot be squared and subtracted without losing the drawing.
MAX_COORDINATE = 1e12
#: Points of a whole drawing. A drawing that needs more is not a crease pattern a net could carry.
MAX_POINTS = 200_000
#: Samples of a segment that needs more than a whole drawing may have, without the one that it shares.
_TOO_MANY = MAX_POINTS + 2
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
    return sample_all([subpath], [None], size, budget)[0]


def sample_all(
    subpaths: Sequence[Subpath], elements: Sequence[str | None], size: float, budget: int
) -> list[Curve | None]:
    """Each of ``subpaths`` as points, None for one without length.

    elements  whose subpath each is, for the error
    size      the drawing's longer side in the same units
    budget    points of all together at most. Raises PatternError when they need more.
    """
    segments = [segment for subpath in subpaths for segment in subpath.segments]
    counts = _sample_counts(segments, size)
    starts = np.concatenate([[0], np.cumsum([len(subpath.segments) for subpath in subpaths])]).astype(np.int64)
    needed = np.concatenate([[0], np.cumsum(np.maximum(counts - 1, 0))])[starts[1:]]
    if len(needed) and needed[-1] > budget:
        raise PatternError(
            f"the drawing needs more than {MAX_POINTS:,} points",
            element=elements[int(np.searchsorted(needed, budget, side="right"))],
        )
    kept = np.flatnonzero(counts)
    rows = dict(zip(kept.tolist(), _sampled([segments[k] for k in kept], counts[kept]), strict=True))
    which = counts.tolist()
    return [
        _assembled([(segments[k], which[k], rows[k]) for k in range(first, last) if which[k]], subpath.closed, size)
        for subpath, first, last in zip(subpaths, starts[:-1].tolist(), starts[1:].tolist(), strict=True)
    ]


def _assembled(parts: Sequence[tuple[Segment, int, FloatArray]], closed: bool, size: float) -> Curve | None:
    """A curve of sampled segments, each with how many samples it has."""
    if not parts:
        return None
    beziers: list[FloatArray] = []
    exact = True
    for segment, count, _ in parts:
        cubics = _as_cubics(segment, count == _STRAIGHT_SAMPLES, ARC_AS_CUBICS * size)
        exact &= cubics is not None
        beziers.extend(cubics or ())
    if len(parts) == 1 and parts[0][1] == _STRAIGHT_SAMPLES:
        return Curve(parts[0][2], False, np.array(beziers))
    points = np.vstack([parts[0][2], *(row[1:] for _, _, row in parts[1:])])
    points = points[np.concatenate([[True], (np.diff(points, axis=0) != 0.0).any(axis=1)])]
    joined = bool(np.hypot(*(points[0] - points[-1])) <= STRAIGHT * size)
    closed = (closed or joined) and len(points) >= 4
    if closed and joined:
        points = points[:-1]
    if len(points) < 2:
        return None
    return Curve(points, closed, np.array(beziers) if exact else None)


def _sample_counts(segments: Sequence[Segment], size: float) -> IntArray:
    """Points (S,) of each segment, ends included, so that no chord is further than ``SAGITTA`` from it.

    Two where it is straight, none where it has no length. ``size`` is the drawing's longer side.
    """
    straight = np.array([segment.kind == "line" for segment in segments], dtype=bool)
    counts = np.full(len(segments), _STRAIGHT_SAMPLES, dtype=np.int64)
    where, controls = _cubics_of(segments)
    straight[where] = _cover_their_chords(controls, STRAIGHT * size)
    with np.errstate(divide="ignore", invalid="ignore"):
        # |B''| <= 6 max |second difference|, and a chord's sagitta is at most |B''| h^2 / 8.
        bend = controls[:, :-2] - 2 * controls[:, 1:-1] + controls[:, 2:]
        length = np.hypot(*np.moveaxis(np.diff(controls, axis=1), 2, 0)).sum(axis=1)
        sagitta = np.where(
            length < _SHORT * size, np.maximum(SAGITTA * size, _SAGITTA_OF_SHORT * length), SAGITTA * size
        )
        pieces = np.sqrt(6.0 * np.hypot(bend[..., 0], bend[..., 1]).max(axis=1) / (8.0 * sagitta))
        usual = pieces < MAX_POINTS
        least = np.clip(np.ceil(_SAMPLES_OF_SIZE * length / size), LEAST_SAMPLES, MIN_SAMPLES)
        counts[where] = np.where(usual, np.maximum(np.ceil(np.where(usual, pieces, 0.0)) + 1, least), _TOO_MANY)
    for k in np.flatnonzero(~straight):
        if segments[k].kind == "arc":
            counts[k] = _arc_sample_count(segments[k], SAGITTA * size)
    which = np.flatnonzero(straight)
    if len(which):
        begin = np.array([segments[k].start for k in which])
        end = np.array([segments[k].end for k in which])
        counts[which] = _STRAIGHT_SAMPLES * (begin != end).any(axis=1)
    return counts


def _cubics_of(segments: Sequence[Segment]) -> tuple[IntArray, FloatArray]:
    """Which segments are cubics, and their control points (C,4,2)."""
    where = np.array([k for k, segment in enumerate(segments) if segment.kind == "cubic"], dtype=np.int64)
    return where, np.array([segments[k].points for k in where]).reshape(-1, 4, 2)


def _cover_their_chords(controls: FloatArray, tolerance: float) -> BoolArray:
    """Which cubics (C,4,2) cover their chords and nothing else."""
    chord = controls[:, 3] - controls[:, 0]
    length = np.hypot(chord[:, 0], chord[:, 1])
    offsets = controls[:, 1:3] - controls[:, :1]
    # Of a cubic without a chord, nothing may be further than the tolerance from its point.
    point = length <= tolerance
    direction = chord / np.where(point, 1.0, length)[:, None]
    along = np.einsum("chd,cd->ch", offsets, direction)
    across = np.abs(offsets[..., 1] * direction[:, None, 0] - offsets[..., 0] * direction[:, None, 1])
    on_chord = (across <= tolerance) & (along >= -tolerance) & (along <= length[:, None] + tolerance)
    at_point = np.hypot(offsets[..., 0], offsets[..., 1]) <= tolerance
    return np.asarray(np.where(point[:, None], at_point, on_chord).all(axis=1))


def _arc_sample_count(segment: Segment, tolerance: float) -> int:
    radius = float(np.linalg.norm(segment.points[3:], 2))
    ratio = tolerance / radius if radius > 0 else 1.0
    # Sagitta of a circle: r (1 - cos(step / 2)); written with arcsin, which keeps its digits.
    step = 4.0 * math.asin(math.sqrt(min(ratio, 1.0) / 2.0))
    pieces = abs(segment.angles[1]) / step if step > 0 else math.inf
    return max(math.ceil(pieces) + 1, MIN_SAMPLES) if pieces < MAX_POINTS else _TOO_MANY


def _sampled(segments: Sequence[Segment], counts: IntArray) -> list[FloatArray]:
    """As many points (n,2) of each segment."""
    result = [
        segment.at_angles(segment.angles[0] + segment.angles[1] * np.linspace(0.0, 1.0, count))
        if segment.kind == "arc"
        else segment.points[[0, -1]]
        for segment, count in zip(segments, counts, strict=True)
    ]
    where, controls = _cubics_of(segments)
    for count in np.unique(counts[where]):
        if count == _STRAIGHT_SAMPLES:
            continue
        mine = np.flatnonzero(counts[where] == count)
        for k, points in zip(
            where[mine], evaluate_cubics(controls[mine], np.linspace(0.0, 1.0, count)), strict=True
        ):
            result[k] = points
    for segment, points in zip(segments, result, strict=True):
        # The drawn ends exactly, so that neighbours share them.
        points[0], points[-1] = segment.start, segment.end
    return result


def evaluate_cubics(controls: FloatArray, t: FloatArray) -> FloatArray:
    """(C,n,2) points of cubic Beziers with (C,4,2) control points."""
    s = 1.0 - t
    weights = np.stack([s**3, 3 * s**2 * t, 3 * s * t**2, t**3], axis=1)
    return np.asarray(weights @ controls, dtype=np.float64)


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
