"""Curve objects as Blender shows them: with hooks, shape keys and modifiers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .splines import Strand, polyline, read_strands

#: Modifiers that Blender always applies to control points; others only when they are told to.
_ON_CONTROL_POINTS = {"HOOK", "SOFT_BODY", "MESH_DEFORM"}


class NoLineError(ValueError):
    """What is shown of a curve object is no line, since it has thickness: modifier, the one that is to blame."""

    def __init__(self, modifier: str) -> None:
        super().__init__(modifier)
        self.modifier = modifier


def control_strands(item: Any, depsgraph: Any) -> list[Strand]:
    """The splines of a Curve object as hooks, shape keys and modifiers on control points leave them."""
    data = item.data
    if not data.shape_keys and not any(_shown_modifiers(item, depsgraph)):
        return read_strands(data)
    evaluated = item.evaluated_get(depsgraph)
    try:
        strands = read_strands(evaluated.to_curve(depsgraph, apply_modifiers=True))
    except RuntimeError:  # hidden from the view layer, so Blender does not evaluate it
        return read_strands(data)
    evaluated.to_curve_clear()
    return strands


def line_strands(item: Any, depsgraph: Any) -> list[Strand]:
    """The splines of a Curve object as all its modifiers leave them. Raises NoLineError."""
    after = next(others_than_on_points(_shown_modifiers(item, depsgraph)), None)
    if after is None:
        return control_strands(item, depsgraph)
    evaluated = item.evaluated_get(depsgraph)
    if not evaluated.is_evaluated:
        return control_strands(item, depsgraph)
    mesh = evaluated.to_mesh()
    try:
        if len(mesh.polygons):
            raise NoLineError(after.name)
        return _strands_of(mesh)
    finally:
        evaluated.to_mesh_clear()


def others_than_on_points(modifiers: Iterable[Any]) -> Iterator[Any]:
    """Those of a curve's modifiers that do not act on its control points."""
    for modifier in modifiers:
        if modifier.type not in _ON_CONTROL_POINTS and not getattr(modifier, "use_apply_on_spline", False):
            yield modifier


def _shown_modifiers(item: Any, depsgraph: Any) -> Iterator[Any]:
    shown = "show_render" if depsgraph.mode == "RENDER" else "show_viewport"
    return (modifier for modifier in item.modifiers if getattr(modifier, shown))


def _strands_of(mesh: Any) -> list[Strand]:
    """Lines along the edges of a mesh that Blender has made of a curve: its vertices are in their order."""
    places = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", places)
    ends: NDArray[np.int32] = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends)
    joined = {(int(low), int(high)) for low, high in np.sort(ends.reshape(-1, 2), axis=1)}
    points, strands, begin = places.reshape(-1, 3), [], 0
    for k in range(len(points)):
        if (k, k + 1) not in joined:
            strands.append(polyline(points[begin : k + 1], (begin, k) in joined and k > begin + 1))
            begin = k + 1
    return strands
