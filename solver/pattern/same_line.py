"""The same line drawn more than once: a copy too many, or two meanings for one crease."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely

from ..arrays import FloatArray, IntArray
from .near_lines import Geometries, lines_near
from .rings import MAX_NEAR, curve_lines, too_near
from .stroke import Decision, Role, Stroke

#: Lines of these roles may be the same crease.
_CREASES = (Role.MOUNTAIN, Role.VALLEY, Role.CREASE)
#: Contradictions that are told one by one.
_MOST_SAID = 20
#: Copies of one line lie this near to each other, in tolerances.
_NEAR = 2.0


def without_copies(strokes: Sequence[Stroke]) -> tuple[list[Stroke], list[str]]:
    """The strokes without those that are the very points of an earlier one of the same role, and a note."""
    seen: set[tuple[Role, bytes]] = set()
    kept = []
    for stroke in strokes:
        points = stroke.curve.points
        key = stroke.decision.role, min(points.tobytes(), points[::-1].tobytes())
        if key not in seen:
            kept.append(stroke)
        seen.add(key)
    return kept, _twice(len(strokes) - len(kept))


def settle_same_lines(strokes: Sequence[Stroke], tolerance: float) -> tuple[list[Stroke], list[str]]:
    """The strokes without creases that lie on earlier ones, and notes.

    A crease that is drawn as a mountain and as a valley has no side of its own, and says so.
    tolerance: how near two lines are the same, drawing units.
    """
    creases = [k for k, stroke in enumerate(strokes) if stroke.decision.role in _CREASES]
    copies = 0
    dropped: set[int] = set()
    changed: dict[int, Stroke] = {}
    conflicts: list[str] = []
    lines = curve_lines([strokes[k].curve for k in creases])
    for a, b in _alike(lines, *_passing_middles(lines, _NEAR * tolerance), tolerance):
        if a in dropped or b in dropped or not _same(lines[a], lines[b], tolerance):
            continue
        one, other = creases[b], creases[a]
        dropped.add(a)
        kept = changed.get(one, strokes[one])
        roles = {kept.decision.role, strokes[other].decision.role}
        if roles == {Role.MOUNTAIN, Role.VALLEY}:
            conflicts.append(_in_words(kept, strokes[other], lines[b]))
            decision = Decision(Role.CREASE, "drawn as a mountain and as a valley", kept.decision.detail)
            changed[one] = replace(kept, decision=decision, conflict=conflicts[-1])
        else:
            copies += 1
            if kept.decision.role is Role.CREASE and not kept.conflict:
                changed[one] = replace(kept, decision=strokes[other].decision)
    notes = [f"{conflict}; it is left unassigned" for conflict in conflicts[:_MOST_SAID]]
    if len(conflicts) > _MOST_SAID:
        notes.append(f"{len(conflicts) - _MOST_SAID:,} more lines are drawn as mountains and as valleys")
    notes += _twice(copies)
    out = {creases[a] for a in dropped}
    return [changed.get(k, stroke) for k, stroke in enumerate(strokes) if k not in out], notes


def _twice(copies: int) -> list[str]:
    if not copies:
        return []
    if copies == 1:
        return ["1 line was drawn twice and counts once"]
    return [f"{copies:,} lines were drawn twice and count once"]


def _passing_middles(lines: Geometries, distance: float) -> tuple[IntArray, IntArray]:
    """Index pairs of lines: one, and another that passes by its middle. Raises PatternError: too many."""
    middles = shapely.get_coordinates(shapely.line_interpolate_point(lines, 0.5, normalized=True))
    found: list[tuple[IntArray, IntArray]] = []
    count = 0
    for pairs in lines_near(lines, middles, distance):
        count += len(pairs[0])
        if count > MAX_NEAR:
            raise too_near()
        found.append(pairs)
    first = [np.zeros(0, dtype=np.int64), *(one for one, _ in found)]
    second = [np.zeros(0, dtype=np.int64), *(other for _, other in found)]
    return np.concatenate(first), np.concatenate(second)


def _alike(lines: Geometries, first: IntArray, second: IntArray, tolerance: float) -> Iterator[tuple[int, int]]:
    """The pairs that may be the same line, each once, the later line first: of a length, and ends on each other."""
    later = first > second
    a, b = first[later], second[later]
    lengths = shapely.length(lines)
    alike = np.abs(lengths[a] - lengths[b]) <= _most_longer(lengths[a], tolerance)
    for place in (0, -1):
        a, b = a[alike], b[alike]
        ends = shapely.get_point(lines, place)
        alike = shapely.dwithin(ends[a], lines[b], _NEAR * tolerance)
        alike &= shapely.dwithin(ends[b], lines[a], _NEAR * tolerance)
    return zip(a[alike].tolist(), b[alike].tolist(), strict=True)


def _most_longer(length: FloatArray, tolerance: float) -> FloatArray:
    """How much longer or shorter than a line of this length one is that may be the same."""
    return 4.0 * _NEAR * tolerance + 0.01 * length


def _same(one: shapely.LineString, other: shapely.LineString, tolerance: float) -> bool:
    """Whether two lines cover each other."""
    return bool(
        shapely.covers(one.buffer(_NEAR * tolerance), other)
        and shapely.covers(other.buffer(_NEAR * tolerance), one)
    )


def _in_words(one: Stroke, other: Stroke, line: shapely.LineString) -> str:
    x, y = shapely.get_coordinates(line.interpolate(0.5, normalized=True))[0]
    names = " and ".join(
        f"{stroke.name or f'a line {stroke.decision.detail}'} ({stroke.decision.role.value.split()[0]})"
        for stroke in (one, other)
    )
    return f"the same line near ({x:.4g}, {y:.4g}) is drawn as a mountain and as a valley, by {names}"
