"""From a paper to its drawing, to change it."""

from typing import ClassVar

import bpy

from .. import drawing_context, drawing_tool, later_work, shown_drawing
from ..bridge import drawing_objects


class EditDrawing(bpy.types.Operator):
    """Show the drawing that is folded, and edit the points of its border and creases"""

    bl_idname = "curvefold.edit_drawing"
    bl_label = "Edit Drawing"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        sheet = drawing_context.active_sheet(context)
        if sheet is None:
            cls.poll_message_set(drawing_context.NO_SHEET)
            return False
        return drawing_context.may_change(cls, sheet)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        sheet = drawing_context.active_sheet(context)
        drawing_tool.leave_edit_mode(context)
        shown_drawing.show(sheet, True)
        parts = [sheet, *drawing_objects.creases_of(sheet)]
        seen = [part for part in drawing_context.changeable(self, parts) if part.visible_get()]
        if not seen:
            self.report({"ERROR"}, f"{sheet.name} is hidden with its collection: show that to edit it")
            return {"CANCELLED"}
        drawing_context.select_only(context, *seen)
        bpy.ops.object.mode_set(mode="EDIT")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(EditDrawing)


def unregister() -> None:
    bpy.utils.unregister_class(EditDrawing)
