"""Takes a handle away."""

from typing import ClassVar

import bpy
from bpy.props import IntProperty

from .. import handle_making
from ..drawing_context import select_only
from .on_paper import OnPaper


class RemoveHandle(OnPaper, bpy.types.Operator):
    """Remove the handle, and its empty when nothing else needs it"""

    bl_idname = "curvefold.remove_handle"
    bl_label = "Remove Handle"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    index: IntProperty(
        name="Handle",
        description="Which handle; the active one when negative",
        default=-1,
        min=-1,
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        settings = paper.data.curvefold
        index = settings.chosen_handle if self.index < 0 else self.index
        if index >= len(settings.handles):
            return self.refuse("The paper has no such handle")
        active = context.view_layer.objects.active
        was_active = active == settings.handles[index].hook
        handle_making.remove_handle(paper, index)
        if was_active:
            # Whoever removes several in a row goes on with the paper.
            select_only(context, paper)
        handle_making.go_on(paper)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(RemoveHandle)


def unregister() -> None:
    bpy.utils.unregister_class(RemoveHandle)
