"""Handles that hold where they are."""

from typing import ClassVar

import bpy

from .. import handle_making, live
from ..drawing_context import select_only
from .add_handles import leave_edit_mode, selected_points
from .on_paper import OnPaper


class Pin(OnPaper, bpy.types.Operator):
    """Hold the selected vertices where they are; in Object Mode, the active handle"""

    bl_idname = "curvefold.pin"
    bl_label = "Pin"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        settings = paper.data.curvefold
        points = selected_points(paper)
        if points:
            leave_edit_mode(paper)
            for point in points:
                handle_making.add_handle(paper, point)
        elif paper.mode == "EDIT":
            return self.refuse("Select vertices of the paper first")
        elif settings.chosen_handle < len(settings.handles):
            handle = settings.handles[settings.chosen_handle]
            place = live.make_session(paper).place_of(tuple(handle.at))
            hook, handle.hook = handle.hook, None
            handle.pinned = True
            handle.offset = place
            if hook is not None and hook == context.view_layer.objects.active:
                select_only(context, paper)
            handle_making.drop_empty(hook)
        else:
            return self.refuse("Select vertices of the paper in Edit Mode first")
        handle_making.go_on(paper)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(Pin)


def unregister() -> None:
    bpy.utils.unregister_class(Pin)
