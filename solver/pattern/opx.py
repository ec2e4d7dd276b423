"""OPX files (ORIPA) -> lines with a meaning.

They are XML that tells a Java program which objects to make. Here it is data: only the numbers of lines are looked
at, wherever they stand, and nothing is made or called.
"""

from __future__ import annotations

import math

from ..errors import PatternError, ReadError
from .drawing_format import DrawingFormat
from .read_options import ReadOptions
from .safe_xml import parse_xml
from .sheets import MAX_STROKES
from .stroke import Lines
from .typed_lines import TypedLine, lines_of_typed

_ROOT = "java"
#: How the class of a line is called, in whatever package.
_LINE_CLASS = "OriLineProxy"
#: Numbers of a line. One that is 0 is not written.
_NUMBERS = ("type", "x0", "y0", "x1", "y1")
#: Elements around a number.
_VALUES = frozenset({"int", "double", "float", "long", "short", "byte"})
#: Elements of a file: a line has two, and two more for each of its numbers.
_MAX_ELEMENTS = 15 * MAX_STROKES
#: Characters of one number.
_MAX_NUMBER = 400


def _lines(data: bytes | str, options: ReadOptions) -> Lines:
    found = _Found()
    parse_xml(data, found, _MAX_ELEMENTS)
    if found.root != _ROOT:
        raise ReadError(f"this is XML but not OPX: its root element is <{found.root}>")
    return lines_of_typed(found.lines, options, ())


class _Found:
    """The lines that are in a file. Raises PatternError where one has a number that is none."""

    def __init__(self) -> None:
        self.root = ""
        self.lines: list[TypedLine] = []
        self._depth = 0
        self._line: dict[str, float] | None = None
        self._line_depth = 0
        self._property = ""
        self._text: list[str] | None = None

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth == 1:
            self.root = name
        if name == "object" and attributes.get("class", "").endswith(_LINE_CLASS):
            self._line, self._line_depth = dict.fromkeys(_NUMBERS, 0.0), self._depth
        elif name == "void":
            self._property = attributes.get("property", "")
        elif name in _VALUES and self._line is not None and self._property in _NUMBERS:
            self._text = []

    def end(self, name: str) -> None:
        if name in _VALUES and self._text is not None and self._line is not None:
            self._line[self._property] = self._number("".join(self._text))
            self._text = None
        elif self._line is not None and self._depth == self._line_depth:
            kind, x0, y0, x1, y1 = self._line.values()
            self.lines.append(TypedLine(int(kind), x0, y0, x1, y1, len(self.lines) + 1))
            self._line = None
        self._depth -= 1

    def characters(self, text: str) -> None:
        if self._text is not None:
            self._text.append(text)

    def _number(self, text: str) -> float:
        try:
            value = float(text) if len(text) <= _MAX_NUMBER else math.nan
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise PatternError(
                f"its {self._property} is {text.strip()[:40]!r} and no number",
                element=f"line {len(self.lines) + 1}",
            )
        return value


OPX = DrawingFormat("OPX", (".opx",), _lines)
read_opx = OPX.read
