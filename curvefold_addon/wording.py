"""What the panels say, as text: facts in, plain sentences out."""

import re
import textwrap
import unicodedata

from ..solver.measurement import FLAT_ANGLE
from .bridge.report import CreaseReport, Report, stretch_words

#: The solver numbers creases; in Blender they have names of their own.
_NUMBERED = re.compile(r"crease \d+ \((.+)\)")
#: Width of a letter and of an icon with its margins in the interface, pixels at a resolution scale of 1.
_LETTER, _MARGIN = 6.6, 46.0

SIDES = {"V": "Valley", "M": "Mountain", "U": "Not folded"}
SIDE_ICONS = {"V": "COLORSET_04_VEC", "M": "COLORSET_01_VEC", "U": "REMOVE"}
JOINT_ICONS = {"POINTS": "LINKED", "BORDERS": "MESH_CYLINDER", "PATCH": "FACESEL"}
STATE_ICONS = {"settled": "CHECKMARK", "folding": "SORTTIME", "trouble": "ERROR"}

#: Where words are looked up that mean something else elsewhere in Blender.
CONTEXT = "Curvefold"

NO_SHEET = "Start with a sheet of paper, a sample, or a drawing"
NO_CREASE = "Draw creases on it: curves along which the paper folds"
READY = "Make Paper makes a sheet of it that folds"
SEVERAL = "Make Paper makes a paper of each of them"
DRAWING = "Draw from border to border, or edit the points; Tab ends it"
NEXT = "Slide Fold, or place handles and drag them"
NEXT_BLANK = "Place handles and drag them"
ASLEEP = "Asleep: it wakes when something moves"
NOT_LIVE = "Not live: it stays as it is"
KEYED = "Its shape keys hide how it folds: remove them"
EDITED = "In Edit Mode: choose points for handles and joints; it folds again after Tab"
BAKED = "Baked: it plays its shape keys"
SHEET_DELETED = (
    "Its sheet was deleted: the paper keeps its shape and its creases; choose another sheet under Drawing, or none"
)
SHEET_ELSEWHERE = "Its sheet is not in this scene: the paper keeps its shape and its creases"
LOST_CREASE = "lies on no sheet any more: select it and a sheet, and Make Crease lays it there"
NO_RULINGS_BAKED = "A baked paper shows no rulings and no Gauss image: free the bake"
NO_RULINGS_ASLEEP = "Asleep: rulings and Gauss image come when it wakes"


def stretch(report: Report) -> str:
    """How much the paper is stretched; paper itself allows about half a percent."""
    words = stretch_words(report.stretch_mean, report.stretch_max)
    return words[:1].upper() + words[1:]


def crease_name(report: CreaseReport) -> str:
    """What the user calls a crease."""
    numbered = _NUMBERED.fullmatch(report.label)
    return report.label if numbered is None else numbered[1]


def angle(report: CreaseReport) -> str:
    """How far a crease is folded, in short."""
    return "" if report.fold_angle is None else f"{report.fold_angle:.0f}°"


def crease(report: CreaseReport) -> str:
    """What became of a crease."""
    degrees = "" if report.fold_angle is None else f" {angle(report)}"
    if report.found not in ("M", "V"):
        changes = report.folded and report.fold_angle is not None and report.fold_angle >= FLAT_ANGLE
        return f"Changes sides{degrees}" if changes else SIDES["U"]
    gaps = "" if report.folded else ", with gaps"
    return f"{SIDES[report.found]}{degrees}{gaps}"


def progress(report: CreaseReport) -> str:
    """How far a crease is on its way to the curve it is given."""
    return f"{report.progress:.0%} of the way"


def effort(report: Report) -> str:
    """What the solver has to do."""
    return f"{report.vertices} vertices, {report.milliseconds:.0f} ms an iteration"


def count(number: int, thing: str, things: str = "") -> str:
    """``3 creases``. things: more than one, where that is not the one with an s."""
    return f"{number or 'No'} {thing if number == 1 else things or thing + 's'}"


def readable(text: str) -> str:
    """Text with names of files, which need not be text themselves."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def lines(sentence: str, width: float) -> list[str]:
    """A sentence in lines that fit into so many pixels (at a resolution scale of 1)."""
    # Letters of Chinese and Japanese are twice as wide.
    wide = sum(unicodedata.east_asian_width(letter) in "WF" for letter in sentence)
    letter_width = _LETTER * (1.0 + wide / max(1, len(sentence)))
    return textwrap.wrap(sentence, max(8 if wide else 16, int((width - _MARGIN) / letter_width)))
