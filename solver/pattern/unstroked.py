"""Why a drawing in which nothing is stroked has no lines, as a sentence."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..arrays import FloatArray
from .segments import Segment
from .svg_walk import Drawn

#: A filled shape whose mean width is below this share of its length is a stroke that became its outline: a square
#: has 0.25, a circle 0.32, and a line of 1 mm on a sheet of 100 mm 0.01.
_THIN = 0.05


def why_no_line(shapes: Iterable[Drawn]) -> str:
    """The refusal of a drawing without strokes: whether it has filled shapes instead, and what to do then."""
    filled = [shape for shape in shapes if shape.filled]
    if not filled:
        return "the drawing has no line: nothing in it is stroked"
    thin = sum(_thinness(shape) < _THIN for shape in filled)
    count = "1 filled shape" if len(filled) == 1 else f"{len(filled)} filled shapes"
    if thin == 0:
        return f"the drawing has no line: it has only {count}; give the border and the creases a stroke"
    if len(filled) == 1:
        those = f"its {count}, as thin as a line, was a stroke"
    else:
        those = f"its {count}, {'all' if thin == len(filled) else thin} of them as thin as a line, were strokes"
    return (
        f"the drawing has no line: nothing in it is stroked, and {those} once; keep strokes as strokes"
        ' (undo "Stroke to Path", "Outline Stroke" or "Expand")'
    )


def _thinness(shape: Drawn) -> float:
    """Mean width over length of what is filled; holes count where they run the other way round."""
    area = length = 0.0
    for subpath in shape.subpaths:
        points = np.vstack([_polygon(segment) for segment in subpath.segments])
        after = np.roll(points, -1, axis=0)
        area += 0.5 * float((points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]).sum())
        length += 0.5 * float(np.hypot(*(after - points).T).sum())
    return abs(area) / length**2 if length > 0.0 else 0.0


def _polygon(segment: Segment) -> FloatArray:
    """(n,2) points in the segment's order, near enough to it to tell a strip from a disc."""
    if segment.kind != "arc":
        return segment.points
    begin, sweep = segment.angles
    return segment.at_angles(np.linspace(begin, begin + sweep, 9))
