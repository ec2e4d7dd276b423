"""Tabs along borders that are glued, with the number of the joint on the tab and where it is glued to."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from ..errors import PatternError
from .crease_parts import CHORD, length_on
from .data import Kind, Plan, PlanStroke
from .lettering import lettering, width_of
from .marks import Placed
from .pieces import Line, Motion, Piece
from .source import Joint
from .walk import Walk

#: The sides of a tab lean inward by this part of its width, and by this part of its length at most.
_LEAN, _MOST_LEAN = 0.5, 0.3
#: Tabs on curved borders are teeth of about this length, mm, so that they can be folded.
_TOOTH = 12.0
#: Numbers are so high, mm, and at most this part of a tab's width.
_HEIGHT, _PART = 2.5, 0.5
#: Tabs may lie on the sheet, or on each other, by this part of their area: rounding.
_ROUNDING = 1e-3


@dataclass(frozen=True)
class _Stretch:
    """A part of a ring of the plan, from a length to a length."""

    ring: int
    start: float
    end: float


def with_tabs(plan: Plan, joints: Sequence[Joint], placed: Placed, width: float) -> Plan:
    """The plan with a tab along the first border of each glued pair: the outline goes round it, and its foot is
    scored.

    placed: from the drawing's places to the plan's; width: of tabs, mm. Raises PatternError where there is no room.
    """
    rings = [k for k, stroke in enumerate(plan.strokes) if stroke.kind in (Kind.BORDER, Kind.HOLE)]
    walks = {k: plan.strokes[k].walk for k in rings}
    glued = [(number, joint) for number, joint in enumerate(joints, 1) if len(joint.first) == 2]
    if not glued:
        raise PatternError("no glued borders are known of it, so there is no place for tabs")
    tabs = [(number, _stretch(walks, joint.first, placed), joint) for number, joint in glued]
    strokes = list(plan.strokes)
    for k in rings:
        mine = sorted(((number, part) for number, part, _ in tabs if part.ring == k), key=lambda tab: tab[1].start)
        if mine:
            strokes[k] = replace(strokes[k], walk=_outline(walks[k], mine, width), vertices=())
    _check_room(plan, walks, tabs, width)
    for number, part, joint in tabs:
        walk = walks[part.ring]
        name = f"tab {number}"
        strokes.append(PlanStroke(Walk(walk.part(part.start, part.end)), Kind.FLAT, name))
        # The number stands in the middle tooth, and beside the middle of the other border.
        start, end = _middle_tooth(walk, part)
        strokes += _number(walk, 0.5 * (start + end), 0.5 * width, number, min(_HEIGHT, _PART * width), name)
        other = _stretch(walks, joint.second, placed)
        middle = 0.5 * (other.start + other.end)
        strokes += _number(walks[other.ring], middle, -_HEIGHT, number, _HEIGHT, name)
    return _in_corner(replace(plan, strokes=tuple(strokes)))


def _stretch(walks: dict[int, Walk], ends: Sequence[tuple[float, float]], placed: Placed) -> _Stretch:
    """The shorter way between two points along the ring that both lie on."""
    points = [shapely.Point(*row) for row in placed(np.array(ends, dtype=float)).tolist()]
    lines = {k: walk.samples(CHORD) for k, walk in walks.items()}
    ring = min(lines, key=lambda k: sum(shapely.LineString(lines[k][0]).distance(point) for point in points))
    line, walk = shapely.LineString(lines[ring][0]), walks[ring]
    a, b = (length_on(lines[ring], line.project(point)) for point in points)
    forward, backward = (b - a) % walk.length, (a - b) % walk.length
    start, length = (a, forward) if forward <= backward else (b, backward)
    return _Stretch(ring, start % walk.length, start % walk.length + length)


def _teeth(walk: Walk, part: _Stretch) -> list[tuple[float, float]]:
    """One tab along each straight piece of a border, teeth along a curved one."""
    found, at = [], part.start
    for piece in walk.part(part.start, part.end):
        count = 1 if isinstance(piece, Line) else max(math.ceil(piece.length / _TOOTH), 1)
        bounds = np.linspace(at, at + piece.length, count + 1).tolist()
        found += list(itertools.pairwise(bounds))
        at += piece.length
    return found


def _middle_tooth(walk: Walk, part: _Stretch) -> tuple[float, float]:
    teeth = _teeth(walk, part)
    return teeth[len(teeth) // 2]


def _tooth(walk: Walk, start: float, end: float, width: float) -> list[complex]:
    """The corners of a tab from its foot's start round to its foot's end. The sheet lies left of its rings."""
    lean = min(_LEAN * width, _MOST_LEAN * (end - start))
    first, last = walk.at(start), walk.at(end - 1e-9)
    corners = [walk.at(length) - 1j * walk.way(length) * width for length in (start + lean, end - lean)]
    return [first, *corners, last]


def _outline(walk: Walk, tabs: Sequence[tuple[int, _Stretch]], width: float) -> Walk:
    """A ring that goes round its tabs."""
    pieces: list[Piece] = []
    parts = [part for _, part in tabs]
    for part, following in zip(parts, [*parts[1:], None], strict=True):
        for start, end in _teeth(walk, part):
            corners = _tooth(walk, start, end, width)
            pieces += [Line(a, b) for a, b in itertools.pairwise(corners)]
        until = parts[0].start + walk.length if following is None else following.start
        if until < part.end - CHORD:
            raise PatternError("its glued borders overlap, so that two tabs would be in one place", element="joint")
        pieces += walk.part(part.end, until)
    return Walk(tuple(pieces), True)


def _check_room(
    plan: Plan, walks: dict[int, Walk], tabs: Sequence[tuple[int, _Stretch, Joint]], width: float
) -> None:
    """Raises PatternError where a tab would lie on the sheet, or on another tab."""
    outside, *holes = (walk.samples(CHORD)[0] for walk in walks.values())
    taken = shapely.Polygon(outside, holes)
    for number, part, _ in tabs:
        walk = walks[part.ring]
        for start, end in _teeth(walk, part):
            foot = Walk(walk.part(start, end)).reversed().samples(CHORD)[0].tolist()
            corners = [(z.real, z.imag) for z in _tooth(walk, start, end, width)[1:-1]]
            tooth = shapely.Polygon([*corners, *foot])
            if not tooth.is_valid or tooth.intersection(taken).area > _ROUNDING * width * width:
                at = walk.at(0.5 * (start + end))
                raise PatternError(
                    f"a tab of {width:g} mm has no room there; take narrower tabs",
                    element=f"joint {number}",
                    place=(at.real, at.imag),
                )
            taken = shapely.union(taken, tooth)


def _number(walk: Walk, length: float, out: float, number: int, height: float, name: str) -> list[PlanStroke]:
    """A number beside a ring; out: how far outside the middle of its letters is."""
    middle = walk.at(length) - 1j * walk.way(length) * out
    corner = middle - complex(width_of(str(number), height), height) / 2
    return [PlanStroke(one, Kind.NAME, name) for one in lettering(str(number), corner, height)]


def _in_corner(plan: Plan) -> Plan:
    """The plan with its lowest left corner at the origin again."""
    points = np.concatenate([stroke.walk.samples(CHORD)[0] for stroke in plan.having(Kind.BORDER)])
    low, high = points.min(axis=0), points.max(axis=0)
    motion = Motion(shift=-complex(*low.tolist()))
    width, height = (high - low).tolist()
    strokes = tuple(replace(stroke, walk=stroke.walk.moved(motion)) for stroke in plan.strokes)
    return replace(plan, strokes=strokes, width=width, height=height)
