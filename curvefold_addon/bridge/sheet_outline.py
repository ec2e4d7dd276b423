"""Sheets from what a scene already has: closed curves, and flat meshes with their holes."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils import Matrix  # type: ignore[import-not-found]
from numpy.typing import NDArray

from ... import solver
from . import drawing_objects
from .drawing import EVEN, FLAT, length_text, read_drawing, shown_strands
from .mesh import edge_ends, edge_uses
from .placing import world_matrix
from .splines import Strand, add_bezier_spline, add_poly_spline, polyline

Array = NDArray[np.float64]


def make_sheet(item: Any, collection: Any) -> Any:
    """The sheet that a Curve or Mesh object outlines.

    A curve in its own XY plane, not scaled unevenly, becomes the sheet itself: its border stays the curve that
    the user drew. Of anything else a new sheet is made in the same place, in true scale, and the object stays
    as it is. Raises PatternError, and then nothing has changed.
    """
    if item.type == "CURVE" and _lies_in_its_plane(item):
        item.curvefold.role = drawing_objects.SHEET
        try:
            read_drawing(item)
        except solver.PatternError:
            item.curvefold.role = "NONE"
            raise
        drawing_objects.mark_sheet(item)
        item.data.fill_mode = "NONE" if item.data.dimensions == "2D" else item.data.fill_mode
        return item
    matrix = world_matrix(item)
    strands = shown_strands(item) if item.type == "CURVE" else _mesh_outlines(item)
    strands = [strand.transformed(matrix) for strand in strands if len(strand.cubics)]
    if not strands:
        raise solver.PatternError("it has no outline", element=item.name)
    if not all(np.isfinite(strand.cubics).all() for strand in strands):
        raise solver.PatternError("a point of it is not finite", element=item.name)
    frame = _frame(strands, matrix, item.name)
    curve = drawing_objects.new_curve(f"{item.name} Sheet")
    for strand in strands:
        _add_flat(curve, strand.transformed(np.linalg.inv(frame)))
    sheet = drawing_objects.new_sheet(curve, collection)
    sheet.matrix_world = Matrix(frame.tolist())
    try:
        read_drawing(sheet)
    except solver.PatternError as error:
        bpy.data.objects.remove(sheet)
        bpy.data.curves.remove(curve)
        raise solver.PatternError(error.message, element=item.name) from error
    return sheet


def _lies_in_its_plane(item: Any) -> bool:
    strands = [strand for strand in shown_strands(item) if len(strand.cubics)]
    if not strands:
        return True  # and reading it says what is missing
    points = np.vstack([strand.cubics.reshape(-1, 3) for strand in strands])
    scale = np.linalg.norm(world_matrix(item)[:3, :2], axis=0)
    flat = np.abs(points[:, 2]).max() <= FLAT * np.ptp(points, axis=0).max()
    return bool(flat and np.ptp(scale) <= EVEN * scale.max())


def _add_flat(curve: Any, strand: Strand) -> None:
    cubics = strand.cubics * [1.0, 1.0, 0.0]
    if not strand.polyline:
        add_bezier_spline(curve, cubics, strand.closed)
    elif strand.closed:
        add_poly_spline(curve, cubics[:, 0], True)
    else:
        add_poly_spline(curve, np.vstack([cubics[:, 0], cubics[-1:, 3]]), False)


def _frame(strands: list[Strand], matrix: Array, name: str) -> Array:
    """(4,4), without scale: the outlines' plane is its XY plane. ``matrix`` says where the object's axes are."""
    points = np.vstack([strand.cubics.reshape(-1, 3) for strand in strands])
    middle = points.mean(axis=0)
    _, extents, axes = np.linalg.svd(points - middle, full_matrices=False)
    if not extents[1] > FLAT * extents[0]:
        raise solver.PatternError("its outline encloses no area", element=name)
    normal = axes[2]
    distance = float(np.abs((points - middle) @ normal).max())
    if distance > FLAT * float(np.ptp(points, axis=0).max()):
        raise solver.PatternError(f"it is not flat: it leaves its plane by {length_text(distance)}", element=name)
    up = matrix[:3, 2] @ normal
    # Standing upright on the object's own plane, either side is as good: the same one for all.
    upright = abs(up) <= 1e-6 * np.linalg.norm(matrix[:3, 2])
    if (normal[int(np.argmax(np.abs(normal)))] if upright else up) < 0:
        normal = -normal
    along = [axis - (axis @ normal) * normal for axis in (matrix[:3, 0], matrix[:3, 1])]
    x = along[0] if np.linalg.norm(along[0]) >= 1e-3 * np.linalg.norm(matrix[:3, 0]) else along[1]
    x = x / np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([x, np.cross(normal, x), normal])
    origin = matrix[:3, 3]
    frame[:3, 3] = origin + ((middle - origin) @ normal) * normal
    return frame


def _mesh_outlines(item: Any) -> list[Strand]:
    """The loops of edges with one face or none, as modifiers leave the mesh. Raises PatternError."""
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    rim = edge_ends(mesh)[edge_uses(mesh) <= 1]
    evaluated.to_mesh_clear()
    if len(rim) == 0:
        raise solver.PatternError("its faces have no outer edge", element=item.name)
    return [polyline(points.reshape(-1, 3)[loop], closed=True) for loop in _loops(rim, item.name)]


def _loops(edges: NDArray[np.int32], name: str) -> list[list[int]]:
    """Vertex loops of (E,2) edges. Raises PatternError when they do not close or touch each other."""
    around: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        around.setdefault(a, []).append(b)
        around.setdefault(b, []).append(a)
    counts = {len(others) for others in around.values()}
    if counts != {2}:
        what = "is not closed" if 1 in counts else "touches itself"
        raise solver.PatternError(f"its outline {what}", element=name)
    loops = []
    while around:
        start = next(iter(around))
        loop, node = [], start
        while node in around:
            loop.append(node)
            onward = [other for other in around.pop(node) if other in around]
            node = onward[0] if onward else start
        loops.append(loop)
    return loops
