"""A closed curve or a flat mesh becomes a sheet."""

from typing import ClassVar

import bpy

from ... import solver
from .. import later_work
from ..bridge import linked, sheet_outline
from ..bridge.papers import is_paper
from ..drawing_context import in_object_mode, may_change, select_only


class SheetFromObject(bpy.types.Operator):
    """Use the active closed curve as a sheet's border, or make a sheet from a flat mesh"""

    bl_idname = "curvefold.sheet_from_object"
    bl_label = "Sheet from Object"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        active = context.active_object
        if active is None or active.type not in {"CURVE", "MESH"}:
            cls.poll_message_set("Select a closed curve or a flat mesh")
            return False
        if active.curvefold.role != "NONE" or is_paper(active):
            cls.poll_message_set("This object is a part of a drawing already")
            return False
        # The curve itself becomes the sheet; of a mesh a new one is made.
        if active.type == "CURVE" and not may_change(cls, active):
            return False
        return in_object_mode(cls, context)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        active = context.active_object
        try:
            sheet = sheet_outline.make_sheet(active, linked.new_home())
        except solver.PatternError as error:
            self.report({"ERROR"}, f"{active.name}: {error.message}")
            return {"CANCELLED"}
        select_only(context, sheet)
        if sheet != active:
            self.report({"INFO"}, f"{sheet.name} was made from {active.name}, which stays as it is")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(SheetFromObject)


def unregister() -> None:
    bpy.utils.unregister_class(SheetFromObject)
