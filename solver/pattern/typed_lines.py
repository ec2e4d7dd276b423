"""Straight lines with a type, as programs for origami keep them -> lines with a meaning."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from ..errors import PatternError
from .drawn_lines import DrawnLine, lines_of_drawn, size_of, too_many
from .read_options import ReadOptions
from .segments import MAX_COORDINATE, Subpath, line
from .sheets import MAX_STROKES
from .sizes import NO_SIZE, unit_of_small
from .stroke import Decision, Lines, Role

#: What the types of lines mean. ORIPA writes auxiliary lines as 0, the others as 4.
_ROLES = {0: Role.FACET, 1: Role.BORDER, 2: Role.MOUNTAIN, 3: Role.VALLEY, 4: Role.FACET}
_WHY = "line type"


@dataclass(frozen=True)
class TypedLine:
    """One line of a file. y points down, as on the screens of these programs; number: its place in the file."""

    kind: int
    x0: float
    y0: float
    x1: float
    y1: float
    number: int


def lines_of_typed(typed: Iterable[TypedLine], options: ReadOptions, notes: tuple[str, ...]) -> Lines:
    """The lines, y up. Raises PatternError: none, too many, no size."""
    drawn: list[DrawnLine] = []
    strange: Counter[int] = Counter()
    beyond = 0
    for one in typed:
        if not all(-MAX_COORDINATE < value < MAX_COORDINATE for value in (one.x0, one.y0, one.x1, one.y1)):
            beyond += 1
            continue
        if one.kind not in _ROLES:
            strange[one.kind] += 1
        subpath = Subpath((line((one.x0, 0.0 - one.y0), (one.x1, 0.0 - one.y1)),), False)
        decision = Decision(_ROLES.get(one.kind, Role.CREASE), _WHY, f"of type {one.kind}")
        drawn.append(DrawnLine(subpath, decision, f"line {one.number}"))
        if len(drawn) > MAX_STROKES:
            raise too_many(notes)
    if beyond:
        notes = (
            *notes,
            f"{_count(beyond)} left out: coordinates that are not finite, or too large to be a drawing",
        )
    for kind, count in strange.most_common(5):
        notes = (*notes, f"{_count(count)} of type {kind}, which has no meaning")
    if not drawn:
        raise PatternError("the drawing has no line", notes=notes)
    unit_mm, said = unit_of_small(size_of(drawn, notes)) if options.unit is None else (None, ())
    if options.unit is None and unit_mm is None:
        said = (NO_SIZE,)
    return lines_of_drawn(drawn, unit_mm, (*notes, *said))


def _count(lines: int) -> str:
    return "1 line" if lines == 1 else f"{lines:,} lines"
