"""Existing objects become hooks of the paper's nearest points."""

from typing import ClassVar

import bpy

from .. import handle_making, live
from ..bridge import surface_points
from .on_paper import OnPaper


class HookObject(OnPaper, bpy.types.Operator):
    """Let the selected objects pull the points of the active paper that are nearest to them"""

    bl_idname = "curvefold.hook_object"
    bl_label = "Hook Selected Objects"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        active = context.active_object
        if live.active_paper(context) != active or not _others(context):
            cls.poll_message_set("Select empties or other objects, and the paper last")
            return False
        return True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        taken = {handle.hook for handle in paper.data.curvefold.handles}
        free = [thing for thing in _others(context) if thing not in taken]
        if not free:
            return self.refuse("The selected objects are hooks of this paper already")
        to_local = paper.matrix_world.inverted_safe()
        for thing in free:
            point = surface_points.nearest(paper.data, to_local @ thing.matrix_world.translation)
            handle_making.hook_to(handle_making.add_handle(paper, point), paper, thing)
        handle_making.go_on(paper)
        return {"FINISHED"}


def _others(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [thing for thing in context.selected_objects if thing != context.active_object]


def register() -> None:
    bpy.utils.register_class(HookObject)


def unregister() -> None:
    bpy.utils.unregister_class(HookObject)
