"""A new crease, drawn by hand on the sheet."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty

from .. import drawing_tool, later_work, shown_drawing
from ..bridge import drawing_objects
from ..drawing_context import NO_SHEET, active_sheet, may_change, select_only
from ..properties import ASSIGNMENTS


class DrawCrease(bpy.types.Operator):
    """Draw a new crease on the sheet; leave Edit Mode when it is done"""

    bl_idname = "curvefold.draw_crease"
    bl_label = "Draw Crease"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    assignment: EnumProperty(name="Assignment", items=ASSIGNMENTS, default="U")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode not in {"OBJECT", "EDIT_CURVE"}:
            cls.poll_message_set("Works in Object Mode, or while a curve is edited")
            return False
        sheet = active_sheet(context)
        if sheet is None:
            cls.poll_message_set(NO_SHEET)
            return False
        return may_change(cls, sheet)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        sheet = active_sheet(context)
        drawing_tool.leave_edit_mode(context)
        shown_drawing.show(sheet, True)
        # Drawing on a planar curve stays in its plane, from wherever it is seen; and its plane is the sheet's.
        curve = drawing_objects.new_curve("Crease")
        crease = drawing_objects.new_crease(curve, sheet, self.assignment)
        if not crease.visible_get():
            bpy.data.objects.remove(crease)
            drawing_objects.remove_curve(curve)
            self.report({"ERROR"}, f"{sheet.name} is hidden: show it to draw on it")
            return {"CANCELLED"}
        select_only(context, crease)
        if not bpy.app.background:
            drawing_tool.begin(context, crease)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(DrawCrease)


def unregister() -> None:
    bpy.utils.unregister_class(DrawCrease)
