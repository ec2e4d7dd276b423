"""What a reader finds drawn -> lines with a meaning: sampled, classified, joined where they continue each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..errors import PatternError
from .joining import join_strokes
from .meaning import Evidence, classify_all
from .same_line import without_copies
from .segments import MAX_POINTS, Subpath, bounds, sample_all
from .sheets import MAX_STROKES
from .stroke import Decision, Lines, Stroke


@dataclass(frozen=True, eq=False)
class DrawnLine:
    """One line as it is drawn.

    subpath  drawing units, y up
    meaning  what the file says about it, or what it is where the file says just that
    element  how errors call it
    """

    subpath: Subpath
    meaning: Evidence | Decision
    element: str


def lines_of_drawn(drawn: Sequence[DrawnLine], unit_mm: float | None, notes: tuple[str, ...]) -> Lines:
    """Raises PatternError: no line, no size, too many lines or points."""
    size = size_of(drawn, notes)
    curves = sample_all([line.subpath for line in drawn], [line.element for line in drawn], size, MAX_POINTS)
    evidence = [line.meaning for line in drawn if isinstance(line.meaning, Evidence)]
    read = iter(classify_all(evidence) if evidence else ())
    decisions = [next(read) if isinstance(line.meaning, Evidence) else line.meaning for line in drawn]
    strokes = [
        Stroke(curve, decision, "") for curve, decision in zip(curves, decisions, strict=True) if curve is not None
    ]
    return joined_lines(strokes, size, unit_mm, notes)


def size_of(drawn: Sequence[DrawnLine], notes: tuple[str, ...]) -> float:
    """The longer side of what is drawn. Raises PatternError: no line, no size, too many lines."""
    if not drawn:
        raise PatternError("the drawing has no line", notes=notes)
    if len(drawn) > MAX_STROKES:
        raise too_many(notes)
    x0, y0, x1, y1 = bounds([line.subpath for line in drawn])
    size = max(x1 - x0, y1 - y0)
    if not size > 0.0:
        raise PatternError("the drawing has no size: all its lines are one point", notes=notes)
    return size


def joined_lines(strokes: Sequence[Stroke], size: float, unit_mm: float | None, notes: tuple[str, ...]) -> Lines:
    """Strokes without copies, those that continue each other joined. size: longer side of the drawing.

    Raises PatternError when there are too many.
    """
    if len(strokes) > MAX_STROKES:
        raise too_many(notes)
    single, twice = without_copies(strokes)
    joined, said = join_strokes(single, size)
    return Lines(tuple(joined), (), None, unit_mm, (*twice, *said, *notes))


def too_many(notes: tuple[str, ...]) -> PatternError:
    return PatternError(f"the drawing has more than {MAX_STROKES:,} strokes", notes=notes)
