"""From a drawing back to the paper that follows it."""

from typing import ClassVar

import bpy

from .. import drawing_context, drawing_tool, live, shown_drawing
from .on_paper import OnPaper


class BackToPaper(OnPaper, bpy.types.Operator):
    """Select the paper that follows this drawing, leave Edit Mode, and hide the drawing"""

    bl_idname = "curvefold.back_to_paper"
    bl_label = "Back to the Paper"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    only_looks = True

    def meant(self, context: bpy.types.Context) -> bpy.types.Object | None:
        return drawing_context.meant_paper(context)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if drawing_context.meant_paper(context) is None:
            cls.poll_message_set("Select a sheet or a crease that a paper follows")
            return False
        return True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if not paper.visible_get():
            return self.refuse(f"{paper.name} is hidden: show it to go on with it")
        drawing_tool.leave_edit_mode(context)
        drawing_context.select_only(context, paper)
        sheet = live.sheet_here(paper.data.curvefold)
        if sheet is not None:
            shown_drawing.show(sheet, False)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(BackToPaper)


def unregister() -> None:
    bpy.utils.unregister_class(BackToPaper)
