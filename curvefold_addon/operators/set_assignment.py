"""Mountain, valley, free or flat: for the selected creases."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty

from .. import later_work
from ..bridge import drawing_objects
from ..drawing_context import changeable, drawing_changed, may_change_some
from ..properties import ASSIGNMENTS


class SetAssignment(bpy.types.Operator):
    """Say to which side the selected creases fold"""

    bl_idname = "curvefold.set_assignment"
    bl_label = "Set Assignment"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    assignment: EnumProperty(name="Assignment", items=ASSIGNMENTS, default="U")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        creases = _creases(context)
        if not creases:
            cls.poll_message_set("Select creases")
            return False
        return may_change_some(cls, creases)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        sheets = []
        for crease in changeable(self, _creases(context)):
            crease.curvefold.assignment = self.assignment
            drawing_objects.show_assignment(crease)
            sheet = drawing_objects.sheet_of(crease)
            if sheet is not None and sheet not in sheets:
                sheets.append(sheet)
        for sheet in sheets:
            for problem in drawing_changed(sheet):
                self.report({"WARNING"}, problem)
        return {"FINISHED"}


def _creases(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [item for item in context.selected_objects if drawing_objects.is_crease(item)]


def register() -> None:
    bpy.utils.register_class(SetAssignment)


def unregister() -> None:
    bpy.utils.unregister_class(SetAssignment)
