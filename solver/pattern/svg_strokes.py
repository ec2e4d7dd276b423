"""The shapes that an SVG file draws -> lines with a meaning."""

from __future__ import annotations

import contextlib
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely

from ..arrays import FloatArray
from ..errors import PatternError
from .drawn_lines import joined_lines
from .meaning import Evidence, classify_all
from .segments import MAX_POINTS, Curve, bounds, sample_all
from .stroke import Decision, Lines, Role, Stroke
from .svg_walk import Drawing, Drawn
from .unstroked import why_no_line

#: Characters of a shape's id that names repeat.
_NAME_LENGTH = 80


def lines_of(drawing: Drawing) -> Lines:
    """The strokes of a drawing, sampled and classified. Raises PatternError: nothing stroked, too many points."""
    stroked = [shape for shape in drawing.shapes if shape.stroke is not None]
    if not stroked:
        raise PatternError(why_no_line(drawing.shapes), notes=drawing.notes)
    x0, y0, x1, y1 = bounds([subpath for shape in stroked for subpath in shape.subpaths])
    size = max(x1 - x0, y1 - y0)
    if not size > 0.0:
        raise PatternError("the drawing has no size: all its lines are one point", notes=drawing.notes)
    decisions = dict(zip(stroked, classify_all([_evidence(shape) for shape in stroked]), strict=True))
    curves = list(_curves(stroked, size))
    strokes = [Stroke(curve, decisions[shape], name, shape.opacity) for shape, curve, name in curves]
    for k in _inner(curves):
        if strokes[k].decision.role is Role.DARK:
            decision = Decision(Role.HOLE, "left out of a filled shape", strokes[k].decision.detail)
            strokes[k] = replace(strokes[k], decision=decision)
    lines = joined_lines(strokes, size, drawing.unit_mm, drawing.notes)
    return replace(lines, filled=_filled(drawing.shapes, size), page=drawing.page)


def _filled(shapes: Sequence[Drawn], size: float) -> tuple[tuple[FloatArray, ...], ...]:
    """Of each shape that is filled and not stroked, its outlines (P,2).

    They are only looked at where no stroke is a border, so that a drawing with too many of them has none.
    """
    outlines: dict[Drawn, list[FloatArray]] = defaultdict(list)
    with contextlib.suppress(PatternError):
        for shape, curve, _ in _curves([one for one in shapes if one.stroke is None and one.filled], size):
            if len(curve.points) > 2:
                outlines[shape].append(curve.points)
    return tuple(tuple(rings) for rings in outlines.values())


def _evidence(shape: Drawn) -> Evidence:
    return Evidence(shape.stroke, shape.dashes, shape.words)


def _inner(curves: Sequence[tuple[Drawn, Curve, str]]) -> Iterator[int]:
    """Which closed curves lie inside another one of the same filled shape, and so are not painted."""
    closed: dict[Drawn, list[int]] = defaultdict(list)
    for k, (shape, curve, _) in enumerate(curves):
        if shape.filled and curve.closed:
            closed[shape].append(k)
    for members in closed.values():
        rings = shapely.polygons([shapely.linearrings(curves[k][1].points) for k in members])
        inner, _ = shapely.STRtree(rings).query(rings, predicate="within")
        # Each is within itself.
        yield from (members[k] for k in np.flatnonzero(np.bincount(inner, minlength=len(members)) > 1))


def _curves(shapes: Sequence[Drawn], size: float) -> Iterator[tuple[Drawn, Curve, str]]:
    """The sampled subpaths of shapes that have a length, and the name of each. Raises PatternError."""
    subpaths = [subpath for shape in shapes for subpath in shape.subpaths]
    elements = [shape.element for shape in shapes for _ in shape.subpaths]
    curves = iter(sample_all(subpaths, elements, size, MAX_POINTS))
    for shape in shapes:
        identity = shape.identity[:_NAME_LENGTH]
        several = identity and len(shape.subpaths) > 1
        for part, _ in enumerate(shape.subpaths, start=1):
            curve = next(curves)
            if curve is not None:
                yield shape, curve, f"{identity} part {part}" if several else identity
