"""Letters of single strokes, which every machine can draw and no file needs a font for."""

from __future__ import annotations

import itertools
import unicodedata

from .pieces import Line
from .walk import Walk

#: Cells of a letter, and from one to the next: letters are drawn on a grid of 4 by 6.
_HEIGHT, _ADVANCE = 6.0, 5.6
#: Each stroke of a letter is a row of points "xy" on the grid.
_LETTERS = {
    "A": "00 26 40;12 32", "B": "00 06 36 45 44 33 03;33 42 41 30 00", "C": "45 36 16 05 01 10 30 41",
    "D": "00 06 26 44 42 20 00", "E": "46 06 00 40;03 33", "F": "46 06 00;03 33",
    "G": "45 36 16 05 01 10 30 41 43 23", "H": "00 06;40 46;03 43", "I": "16 36;26 20;10 30",
    "J": "46 41 30 10 01", "K": "00 06;46 03 40", "L": "06 00 40", "M": "00 06 23 46 40", "N": "00 06 40 46",
    "O": "10 01 05 16 36 45 41 30 10", "P": "00 06 36 45 44 33 03", "Q": "10 01 05 16 36 45 41 30 10;22 40",
    "R": "00 06 36 45 44 33 03;23 40", "S": "45 36 16 05 04 13 33 42 41 30 10 01", "T": "06 46;26 20",
    "U": "06 01 10 30 41 46", "V": "06 20 46", "W": "06 10 23 30 46", "X": "00 46;06 40", "Y": "06 23 46;23 20",
    "Z": "06 46 00 40", "0": "10 01 05 16 36 45 41 30 10", "1": "14 26 20;10 30", "2": "05 16 36 45 44 00 40",
    "3": "05 16 36 45 44 33 42 41 30 10 01;13 33", "4": "30 36 02 42", "5": "46 06 03 33 42 41 30 10 01",
    "6": "45 36 16 05 01 10 30 41 42 33 13 02", "7": "06 46 10",
    "8": "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33", "9": "01 10 30 41 45 36 16 05 04 13 33 44",
    "-": "13 33", "_": "00 40", ".": "10 20 21 11 10", ",": "21 10", ":": "21 22;24 25", "/": "00 46",
    "(": "36 24 22 30", ")": "16 24 22 10", "+": "03 43;21 25", "%": "06 16 15 05 06;46 00;31 41 40 30 31",
    "=": "02 42;04 44", "?": "05 16 36 45 44 23 22;21 20",
}  # fmt: skip


def lettering(text: str, at: complex, height: float) -> list[Walk]:
    """Text from a point on, mm: a walk for each stroke. Letters are capitals; unknown ones are question marks."""
    scale = height / _HEIGHT
    found = []
    for column, letter in enumerate(_plain(text)):
        origin = at + column * _ADVANCE * scale
        for stroke in _LETTERS.get(letter, "").split(";"):
            points = [origin + scale * complex(int(xy[0]), int(xy[1])) for xy in stroke.split()]
            if len(points) > 1:
                lines = tuple(Line(a, b) for a, b in itertools.pairwise(points))
                found.append(Walk(lines, points[0] == points[-1]))
    return found


def width_of(text: str, height: float) -> float:
    """How wide text is, mm."""
    count = len(_plain(text))
    return (count * _ADVANCE - (_ADVANCE - 4.0)) * height / _HEIGHT if count else 0.0


def _plain(text: str) -> str:
    """Capital letters without accents."""
    bare = unicodedata.normalize("NFKD", text.upper())
    bare = "".join(letter for letter in bare if not unicodedata.combining(letter))
    return "".join(letter if letter in _LETTERS or letter == " " else "?" for letter in bare)
