"""The plan: the flat sheet as lines that say what is to be done along them. Millimetres, y up, the sheet's lowest
left corner at the origin.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from enum import Enum

from .walk import Walk


class Kind(Enum):
    """What a line of a plan is. The value is its name in profiles."""

    BORDER = "border"
    HOLE = "hole"
    MOUNTAIN = "mountain"
    VALLEY = "valley"
    FLAT = "flat"  # a crease that folds to neither side, or of which nobody knows to which
    RULING = "ruling"
    MARK = "mark"  # where handles and joints are
    NAME = "name"  # the numbers of creases and joints
    GROOVE = "groove"  # edges of V-grooves, on the face that the fold closes
    REGISTRATION = "registration"  # what aligns two faces, or two pages
    FRAME = "frame"  # what is written around the sheet on printed pages


#: Creases, of which no two kinds lie in one place.
CREASES = (Kind.MOUNTAIN, Kind.VALLEY, Kind.FLAT)


@dataclass(frozen=True)
class PlanStroke:
    """One line.

    name      of the crease, for people
    vertices  lengths along it where creases meet it or it has a corner, in order; its ends are not among them
    angles    (length, fold angle in degrees, unsigned) in order, where the fold is known
    back      whether it belongs to the sheet's back
    """

    walk: Walk
    kind: Kind
    name: str = ""
    vertices: tuple[float, ...] = ()
    angles: tuple[tuple[float, float], ...] = ()
    back: bool = False

    @property
    def parts(self) -> list[tuple[float, float]]:
        """From which length to which it goes between its vertices; of a closed line the last may pass its start."""
        if not self.walk.closed:
            return list(itertools.pairwise([0.0, *self.vertices, self.walk.length]))
        if not self.vertices:
            return [(0.0, self.walk.length)]
        return list(itertools.pairwise([*self.vertices, self.vertices[0] + self.walk.length]))


@dataclass(frozen=True)
class Plan:
    """All lines of one sheet.

    width, height  of the sheet, mm
    folded         whether mountains and valleys are as folded, else as drawn
    notes          what was decided, a sentence each
    """

    strokes: tuple[PlanStroke, ...]
    width: float
    height: float
    name: str
    folded: bool
    notes: tuple[str, ...] = ()

    def having(self, *kinds: Kind) -> list[PlanStroke]:
        return [stroke for stroke in self.strokes if stroke.kind in kinds]
