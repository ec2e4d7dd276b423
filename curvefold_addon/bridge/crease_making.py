"""Curves and strokes laid onto a sheet: what becomes a crease lies in the sheet's plane and coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from mathutils import Matrix  # type: ignore[import-not-found]
from numpy.typing import NDArray

from ...solver.pattern.arrangement import SNAP_TOLERANCE
from . import drawing_objects, strokes
from .drawing import sheet_size
from .placing import matrix_on
from .splines import add_bezier_spline

Array = NDArray[np.float64]


def lay_curve(item: Any, sheet: Any) -> None:
    """Makes a Curve object a crease of a sheet: it keeps its shape in the world, but for its height above the
    sheet's plane. A curve that is moved by constraints, animation, modifiers or shape keys keeps those."""
    matrix = matrix_on(sheet, item)
    if item.constraints or item.modifiers or item.animation_data or item.data.shape_keys:
        item.parent, item.parent_type = sheet, "OBJECT"
        item.matrix_parent_inverse = Matrix(matrix.tolist()) @ item.matrix_basis.inverted_safe()
    else:
        if item.data.users > 1:
            item.data = item.data.copy()
        _flatten(item.data, matrix)
        item.parent, item.parent_type = sheet, "OBJECT"
        item.matrix_parent_inverse = Matrix()
        item.matrix_basis = Matrix()
    drawing_objects.mark_crease(item, item.curvefold.assignment)


def lay_strokes(pencil: Any, sheet: Any) -> Any | None:
    """A new crease of a sheet with a spline for each stroke, None when there are only dots."""
    size = sheet_size(sheet)
    matrix = matrix_on(sheet, pencil)
    curve = drawing_objects.new_curve(pencil.name)
    for points, closed in strokes.read_strokes(pencil):
        flat = (points @ matrix[:3, :3].T + matrix[:3, 3])[:, :2]
        cubics = strokes.smooth_cubics(flat, closed, SNAP_TOLERANCE * size)
        if cubics is not None:
            add_bezier_spline(curve, np.concatenate([cubics, np.zeros((len(cubics), 4, 1))], axis=2), closed)
    if not curve.splines:
        drawing_objects.remove_curve(curve)
        return None
    return drawing_objects.new_crease(curve, sheet, "U")


def _flatten(curve: Any, matrix: Array) -> None:
    """Moves all points by ``matrix`` (4,4), then onto z = 0."""
    rows = matrix[:3]
    for spline in curve.splines:
        if spline.type == "BEZIER":
            for point in spline.bezier_points:
                # Automatic handles would not stay where the projection puts them.
                for side in ("handle_left_type", "handle_right_type"):
                    if getattr(point, side) == "AUTO":
                        setattr(point, side, "ALIGNED")
            for name in ("co", "handle_left", "handle_right"):
                _map(spline.bezier_points, name, 3, rows)
        else:
            _map(spline.points, "co", 4, rows)
    # Which takes the height from all points.
    curve.dimensions = "2D"
    curve.fill_mode = "NONE"


def _map(points: Any, name: str, width: int, rows: Array) -> None:
    values = np.empty(width * len(points), dtype=np.float32)
    points.foreach_get(name, values)
    table = values.reshape(-1, width)
    table[:, :3] = table[:, :3] @ rows[:, :3].T + rows[:, 3]
    points.foreach_set(name, values)
