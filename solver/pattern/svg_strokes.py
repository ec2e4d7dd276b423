"""The shapes that an SVG file draws -> lines with a meaning."""

from __future__ import annotations

from collections.abc import Iterator

from ..errors import PatternError
from .joining import join_strokes
from .meaning import classify
from .segments import MAX_POINTS, Curve, bounds, sample
from .sheets import MAX_STROKES
from .stroke import Lines, Stroke
from .svg_walk import Drawing, Drawn

#: Characters of a shape's id that names repeat.
_NAME_LENGTH = 80


def lines_of(drawing: Drawing) -> Lines:
    """The strokes of a drawing, sampled and classified. Raises PatternError: nothing stroked, too many points."""
    stroked = [shape for shape in drawing.shapes if shape.stroke is not None]
    if not stroked:
        raise PatternError("the drawing has no line: nothing in it is stroked", notes=drawing.notes)
    x0, y0, x1, y1 = bounds([subpath for shape in stroked for subpath in shape.subpaths])
    size = max(x1 - x0, y1 - y0)
    if not size > 0.0:
        raise PatternError("the drawing has no size: all its lines are one point", notes=drawing.notes)
    strokes: list[Stroke] = []
    budget = MAX_POINTS
    for shape in stroked:
        decision = classify(shape)
        identity = shape.identity[:_NAME_LENGTH]
        for curve, part in _curves(shape, size, budget):
            budget -= len(curve.points)
            name = f"{identity} part {part}" if identity and part else identity
            if len(strokes) == MAX_STROKES:
                raise PatternError(f"the drawing has more than {MAX_STROKES:,} strokes", notes=drawing.notes)
            strokes.append(Stroke(curve, decision, name, shape.opacity))
    filled = [
        curve.points
        for shape in drawing.shapes
        if shape.stroke is None and shape.filled
        for curve, _ in _curves(shape, size, MAX_POINTS)
        if curve.closed
    ]
    joined, notes = join_strokes(strokes, size)
    return Lines(tuple(joined), tuple(filled), drawing.page, drawing.unit_mm, (*notes, *drawing.notes))


def _curves(shape: Drawn, size: float, budget: int) -> Iterator[tuple[Curve, int]]:
    """The sampled subpaths of a shape that have a length, and the number of each where there are several."""
    several = len(shape.subpaths) > 1
    for part, subpath in enumerate(shape.subpaths, start=1):
        try:
            curve = sample(subpath, size, budget)
        except PatternError as error:
            raise PatternError(error.message, element=shape.element) from error
        if curve is not None:
            budget -= len(curve.points)
            yield curve, part if several else 0
