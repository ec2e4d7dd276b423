"""Creases in parts: cut where they meet each other, turn a corner, or leave the paper."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from ..arrays import FloatArray, IntArray
from ..pattern.arrangement import snap_tolerance
from ..pattern.curves import CORNER
from ..pattern.places import line_strings
from .walk import NOTHING, Walk

#: Chords that stand for curves where lengths are looked for lie this near, mm.
CHORD = 2e-3
#: Meeting places along a crease that are nearer than this are one, mm.
_SAME = 0.02
#: A part whose middle is this near the sheet's edge runs along it, and is no crease; parts of the longer side.
_ALONG_EDGE = 1e-4
#: Lines whose directions have a smaller cross product do not cross.
_PARALLEL = 1e-9


@dataclass(frozen=True)
class Part:
    """Of which crease, from which length to which; of a closed crease ``end`` may lie beyond its length."""

    crease: int
    start: float
    end: float


def crease_parts(walks: Sequence[Walk], paper: shapely.Polygon) -> list[Part]:
    """The parts of creases that lie on the paper, along each crease in order. paper: the sheet without holes."""
    if not walks:
        return []
    lines = [walk.samples(CHORD) for walk in walks]
    reach = snap_tolerance(paper)
    meeting = _meetings(walks, lines, paper, reach)
    inside = paper.buffer(-_ALONG_EDGE * _longer_side(paper))
    shapely.prepare(inside)
    parts = []
    for k, walk in enumerate(walks):
        cuts = _spread([*meeting[k], *_corners(walk)], walk)
        if walk.closed and not cuts:
            spans = [(0.0, walk.length)]
        elif walk.closed:
            spans = list(zip(cuts, [*cuts[1:], cuts[0] + walk.length], strict=True))
        else:
            bounds = [0.0, *cuts, walk.length]
            # What passes a meeting place by less than ends are snapped by ends there.
            if len(bounds) > 2 and bounds[1] < reach:
                bounds = bounds[1:]
            if len(bounds) > 2 and bounds[-1] - bounds[-2] < reach:
                bounds = bounds[:-1]
            spans = list(itertools.pairwise(bounds))
        for a, b in spans:
            middle = walk.at(0.5 * (a + b))
            if b - a > NOTHING and inside.contains(shapely.Point(middle.real, middle.imag)):
                parts.append(Part(k, a, b))
    return parts


def _longer_side(paper: shapely.Polygon) -> float:
    low_x, low_y, high_x, high_y = paper.bounds
    return float(max(high_x - low_x, high_y - low_y))


def _corners(walk: Walk) -> list[float]:
    """Lengths at which a walk turns sharply."""
    found = []
    pieces = walk.pieces
    for k in range(0 if walk.closed else 1, len(pieces)):
        before, after = pieces[k - 1].way(1.0), pieces[k].way(0.0)
        if before and after and abs(np.angle(after / before)) > CORNER:
            found.append(float(walk.starts[k]))
    return found


def _spread(lengths: list[float], walk: Walk) -> list[float]:
    """Lengths in order, those in one place once, without the ends of an open walk."""
    kept: list[float] = []
    for length in sorted(length % walk.length if walk.closed else length for length in lengths):
        if kept and length - kept[-1] < _SAME:
            continue
        if walk.closed or _SAME <= length <= walk.length - _SAME:
            kept.append(length)
    if walk.closed and len(kept) > 1 and kept[0] + walk.length - kept[-1] < _SAME:
        kept.pop()
    return kept


def _meetings(
    walks: Sequence[Walk],
    lines: Sequence[tuple[FloatArray, FloatArray]],
    paper: shapely.Polygon,
    reach: float,
) -> list[list[float]]:
    """Lengths along each walk at which another one, itself, or the paper's edge crosses or meets it."""
    edges = [shapely.get_coordinates(ring) for ring in (paper.exterior, *paper.interiors)]
    rows = [points for points, _ in lines] + edges
    start = np.concatenate([row[:-1] for row in rows])
    step = np.concatenate([np.diff(row, axis=0) for row in rows])
    owner = np.repeat(np.arange(len(rows)), [len(row) - 1 for row in rows])
    number = np.concatenate([np.arange(len(row) - 1) for row in rows])
    segments = shapely.linestrings(np.stack([start, start + step], axis=1))
    creases = np.flatnonzero(owner < len(walks))
    tree = shapely.STRtree(segments)
    one, other = tree.query(segments[creases], predicate="intersects")
    one = creases[one]
    # Neighbours on a walk always meet; those of a closed one also where it closes.
    last = np.array([len(row) - 2 if k < len(walks) and walks[k].closed else -1 for k, row in enumerate(rows)])
    between = np.abs(number[one] - number[other])
    apart = (owner[one] != owner[other]) | ((between > 1) & (between != last[owner[one]]))
    one, other = one[apart], other[apart]
    here = _crossing(start, step, one, other)
    known = np.isfinite(here)
    found: list[list[float]] = [[] for _ in walks]
    for segment, t in zip(one[known].tolist(), here[known].tolist(), strict=True):
        walk = int(owner[segment])
        lengths, k = lines[walk][1], int(number[segment])
        found[walk].append(float(lengths[k] + t * (lengths[k + 1] - lengths[k])))
    _add_ends(walks, lines, found, reach)
    return found


def _crossing(start: FloatArray, step: FloatArray, one: IntArray, other: IntArray) -> FloatArray:
    """Where on each first segment the second one crosses it, 0 to 1; NaN for those side by side."""
    p, q = step[one], step[other]
    gap = start[other] - start[one]
    cross = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    size = np.hypot(*p.T) * np.hypot(*q.T)
    beside = np.abs(cross) <= _PARALLEL * size
    t = (gap[:, 0] * q[:, 1] - gap[:, 1] * q[:, 0]) / np.where(beside, 1.0, cross)
    return np.asarray(np.where(beside, np.nan, np.clip(t, 0.0, 1.0)))


def _add_ends(
    walks: Sequence[Walk],
    lines: Sequence[tuple[FloatArray, FloatArray]],
    found: list[list[float]],
    reach: float,
) -> None:
    """Where the end of a crease comes as near to another one as ends are joined."""
    open_ = [k for k, walk in enumerate(walks) if not walk.closed]
    ends = np.array([lines[k][0][[0, -1]] for k in open_]).reshape(-1, 2)
    whole = line_strings([points for points, _ in lines])
    tree = shapely.STRtree(whole)
    if not len(ends):
        return
    points = shapely.points(ends)
    which, near = tree.query(points, predicate="dwithin", distance=reach)
    for end, walk in zip(which.tolist(), near.tolist(), strict=True):
        if open_[end // 2] == walk:
            continue
        along = float(shapely.line_locate_point(whole[walk], points[end]))
        length = length_on(lines[walk], along)
        if not any(abs(length - known) < reach for known in found[walk]):
            found[walk].append(length)


def length_on(line: tuple[FloatArray, FloatArray], along: float) -> float:
    """A length along the chords of a walk's samples as one along the walk."""
    points, lengths = line
    chords = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    return float(np.interp(along, chords, lengths))
