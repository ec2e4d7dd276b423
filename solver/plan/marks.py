"""Marks for hands: where handles and joints are, and the numbers of creases."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..arrays import FloatArray
from .data import CREASES, Kind, PlanStroke
from .lettering import lettering, width_of
from .pieces import Arc, Line
from .source import PlanSource
from .walk import Walk

#: Half of a handle's cross, and the radius of a joint's ring, mm.
_CROSS, _RING = 2.0, 1.5
#: Height of numbers, and how far they stand from what they belong to, mm.
_HEIGHT, _BESIDE = 2.5, 1.5

Placed = Callable[[FloatArray], FloatArray]


def mark_strokes(source: PlanSource, placed: Placed, creases: Sequence[PlanStroke]) -> list[PlanStroke]:
    """placed: from the drawing's places (n,2) to the plan's."""
    strokes = []
    for number, place in enumerate(source.handles, 1):
        crossed = cross(_point(place, placed), _CROSS)
        strokes += [PlanStroke(walk, Kind.MARK, f"handle {number}") for walk in crossed]
    for number, joint in enumerate(source.joints, 1):
        for places in (joint.first, joint.second):
            # The first end of one side belongs to the first end of the other: letters say which is which.
            for place, letter in zip(places, "AB", strict=False):
                at = _point(place, placed)
                text = f"{number}{letter if len(places) > 1 else ''}"
                strokes.append(PlanStroke(Walk((circle(at, _RING),), True), Kind.MARK, f"joint {number}"))
                strokes += _text(text, at + _RING + _BESIDE, Kind.NAME, f"joint {number}")
    return strokes + _crease_numbers(creases)


def cross(at: complex, reach: float) -> list[Walk]:
    return [Walk((Line(at - reach, at + reach),)), Walk((Line(at - 1j * reach, at + 1j * reach),))]


def circle(at: complex, radius: float) -> Arc:
    return Arc(at + radius, at + radius, at, radius, 0.0, 2 * np.pi)


def _point(at: Sequence[float], placed: Placed) -> complex:
    x, y = placed(np.array([at], dtype=float))[0].tolist()
    return complex(x, y)


def _text(text: str, at: complex, kind: Kind, name: str) -> list[PlanStroke]:
    return [PlanStroke(walk, kind, name) for walk in lettering(text, at, _HEIGHT)]


def _crease_numbers(creases: Sequence[PlanStroke]) -> list[PlanStroke]:
    """The number of each crease beside the middle of its longest line."""
    longest: dict[str, PlanStroke] = {}
    for stroke in creases:
        if stroke.kind in CREASES:
            known = longest.get(stroke.name)
            if known is None or stroke.walk.length > known.walk.length:
                longest[stroke.name] = stroke
    strokes = []
    for name, stroke in longest.items():
        number = name.split()[1]
        # A little before the middle, where creases often cross.
        along = 0.45 * stroke.walk.length
        left = 1j * stroke.walk.way(along)
        half = complex(width_of(number, _HEIGHT), _HEIGHT) / 2
        away = _BESIDE + abs(left.real) * half.real + abs(left.imag) * half.imag
        strokes += _text(number, stroke.walk.at(along) + away * left - half, Kind.NAME, name)
    return strokes
