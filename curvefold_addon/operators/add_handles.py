"""Handles at the selected vertices of a paper."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty
from mathutils import Vector

from .. import handle_making
from ..bridge import surface_points
from ..drawing_context import select_only
from .on_paper import OnPaper


class AddHandles(OnPaper, bpy.types.Operator):
    """Add handles at the selected vertices of the paper, and an empty to drag them"""

    bl_idname = "curvefold.add_handles"
    bl_label = "Add Handles"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    selects = "Select vertices of the paper in Edit Mode first"

    together: BoolProperty(
        name="Together",
        description="One empty moves, turns and scales all points; otherwise each gets its own",
        default=True,
    )

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        points = selected_points(paper)
        if not points:
            return self.refuse(self.selects)
        leave_edit_mode(paper)
        empty = None
        for point in points:
            handle = handle_making.add_handle(paper, point)
            if empty is None or not self.together:
                spot = _middle(points) if self.together else handle.offset.copy()
                empty = handle_making.new_empty(paper, spot, handle.name)
            handle_making.hook_to(handle, paper, empty)
        select_only(context, empty)
        handle_making.go_on(paper)
        return {"FINISHED"}


def selected_points(paper: bpy.types.Object) -> list[surface_points.SurfacePoint]:
    """The vertices that are selected in Edit Mode, none in others."""
    return surface_points.selected(paper.data) if paper.mode == "EDIT" else []


def leave_edit_mode(paper: bpy.types.Object) -> None:
    bpy.ops.object.mode_set(mode="OBJECT")


def _middle(points: list[surface_points.SurfacePoint]) -> Vector:
    return sum((Vector(point.place) for point in points), Vector()) / len(points)


def register() -> None:
    bpy.utils.register_class(AddHandles)


def unregister() -> None:
    bpy.utils.unregister_class(AddHandles)
