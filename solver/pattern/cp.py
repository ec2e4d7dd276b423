"""CP files (ORIPA, Oriedita, Orihime and others) -> lines with a meaning.

Each line of text is a line of the drawing: type x1 y1 x2 y2. The sheet is usually a square of 400 about the origin.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from ..errors import ReadError
from .drawing_format import DrawingFormat
from .read_options import ReadOptions
from .stroke import Lines
from .text import decode_plain
from .typed_lines import TypedLine, lines_of_typed

#: What a line of text is split at, and how comments begin.
_SEPARATOR = re.compile(r"[\s,;]+")
_COMMENTS = ("#", "//", "%")
#: Characters of a line of text that are looked at.
_MAX_LINE = 1_000
#: Numbers of one line: its type and its two ends.
_NUMBERS = 5


def _lines(data: bytes | str, options: ReadOptions) -> Lines:
    text = decode_plain(data)
    if not text.strip():
        raise ReadError("the file is empty")
    wrong: list[int] = []
    typed = list(_typed(text, wrong))
    if wrong and len(wrong) >= len(typed):
        raise ReadError(f"this is no CP file: line {wrong[0]} of its text is not a type and four numbers")
    notes: tuple[str, ...] = ()
    if wrong:
        count = "1 line" if len(wrong) == 1 else f"{len(wrong):,} lines"
        notes = (f"{count} of the text left out, the first in line {wrong[0]}: not a type and four numbers",)
    return lines_of_typed(typed, options, notes)


def _typed(text: str, wrong: list[int]) -> Iterator[TypedLine]:
    """The lines, and in ``wrong`` the numbers of those that are none."""
    for number, line in enumerate(text.splitlines(), 1):
        words = _SEPARATOR.split(line[:_MAX_LINE].strip(" \t,;"))
        if words == [""] or words[0].startswith(_COMMENTS):
            continue
        try:
            kind, x0, y0, x1, y1 = map(float, words[:_NUMBERS])
        except ValueError:
            kind = math.nan
        if kind.is_integer():
            yield TypedLine(int(kind), x0, y0, x1, y1, number)
        else:
            wrong.append(number)


CP = DrawingFormat("CP", (".cp",), _lines)
read_cp = CP.read
