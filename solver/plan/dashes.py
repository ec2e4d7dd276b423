"""Dashes and perforations as real segments, the same from both ends of every part of a crease."""

from __future__ import annotations

from collections.abc import Sequence

from .data import PlanStroke
from .walk import NOTHING, Walk


def segments(stroke: PlanStroke, lengths: Sequence[float], margin: float) -> list[Walk]:
    """What is drawn of a line.

    lengths  of a dash and a gap, or of a dash, a gap, a dot and a gap, mm; none for a whole line
    margin   what stays free at the ends of the line and on both sides of its vertices, mm

    Dashes are as long as told; gaps are as long as told or a little longer, so that both ends have the same dash.
    """
    walk = stroke.walk
    if not lengths and margin <= 0.0:
        return [walk]
    if walk.closed and not stroke.vertices:
        return _around(walk, lengths) if lengths else [walk]
    found = []
    for start, end in stroke.parts:
        room = end - start - 2.0 * margin
        if room <= NOTHING:
            continue
        marks = _symmetric(room, lengths) if lengths else [(0.0, room)]
        found += [Walk(walk.part(start + margin + a, start + margin + b)) for a, b in marks]
    return found


def _symmetric(room: float, lengths: Sequence[float]) -> list[tuple[float, float]]:
    """Dashes on a straight way of a length: a dash at either end, the rest spread evenly between them."""
    dash, gaps = lengths[0], sum(lengths[1::2])
    dots = lengths[2::2]
    period = sum(lengths)
    if room <= dash:
        return [(0.0, room)]
    count = int((room - dash + NOTHING) / period)
    if count == 0:
        middle = 0.5 * room
        return [(middle - 0.5 * dash, middle + 0.5 * dash)]
    spare = (room - dash - count * period) / count
    rows = _rows(0.0, [dash, *dots], [gap * (1.0 + spare / gaps) for gap in lengths[1::2]], count)
    return [*rows, (room - dash, room)]


def _around(walk: Walk, lengths: Sequence[float]) -> list[Walk]:
    """Dashes on a closed line that nothing meets: evenly all around."""
    count = int((walk.length + NOTHING) / sum(lengths))
    if count == 0:
        return [walk]
    gaps = sum(lengths[1::2])
    spare = walk.length / count - sum(lengths)
    rows = _rows(0.0, list(lengths[::2]), [gap * (1.0 + spare / gaps) for gap in lengths[1::2]], count)
    return [Walk(walk.part(a, b)) for a, b in rows]


def _rows(start: float, dashes: list[float], gaps: list[float], count: int) -> list[tuple[float, float]]:
    found, at = [], start
    for _ in range(count):
        for dash, gap in zip(dashes, gaps, strict=True):
            found.append((at, at + dash))
            at += dash + gap
    return found
