"""A line of a drawing, whatever its format: its curve, and what it is thought to mean."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ..arrays import FloatArray
from .segments import Curve


class Role(Enum):
    """What a stroke is. The value is how notes call it."""

    MOUNTAIN = "mountain crease"
    VALLEY = "valley crease"
    CREASE = "unassigned crease"
    BORDER = "border"
    HOLE = "hole"
    CUT = "cut"
    FACET = "facet line, left out"
    ASIDE = "line that is no part of the sheet, left out"  # dimensions, text, glue, bleed, guides; by its name
    DARK = "border, hole or unassigned crease"  # black and nothing else to go by
    PALE = "auxiliary line"  # grey and nothing else to go by


#: Roles that are creases whatever else is in the drawing.
CREASE_ROLES = frozenset({Role.MOUNTAIN, Role.VALLEY, Role.CREASE})
#: Roles that are edges of the paper whatever else is in the drawing.
EDGE_ROLES = frozenset({Role.BORDER, Role.HOLE, Role.CUT})


@dataclass(frozen=True)
class Decision:
    """The role of one stroke and the evidence.

    why     "hue", "dash pattern", "class", "group or layer name", ...
    detail  what the stroke looks like and is called, for notes: "of colour #ff0000 named 'cut'"
    word    what a line that is no part of the sheet is: "dimension line"
    """

    role: Role
    why: str
    detail: str
    word: str = ""


@dataclass(frozen=True, eq=False)
class Stroke:
    """One line with what is thought of it.

    count     how many strokes of the file it is made of, where they continue each other
    conflict  that it is drawn as a mountain and as a valley, in words; else empty
    fate      what became of it, for the notes
    """

    curve: Curve
    decision: Decision
    name: str
    opacity: float = 1.0
    count: int = 1
    conflict: str = ""
    fate: str = ""


@dataclass(frozen=True, eq=False)
class Lines:
    """All that a reader finds in a file. Drawing units, y up.

    strokes  in the file's order
    filled   of each shape that is filled and not stroked, its closed outlines (P,2)
    page     x and y minimum, x and y maximum of the page, None when the file has none
    unit_mm  millimetres in one unit, None when the file does not say
    notes    what was decided on the way
    conflicts  creases that the file gives as a mountain and as a valley, one sentence each
    """

    strokes: tuple[Stroke, ...]
    filled: tuple[tuple[FloatArray, ...], ...]
    page: tuple[float, float, float, float] | None
    unit_mm: float | None
    notes: tuple[str, ...]
    conflicts: tuple[str, ...] = ()
