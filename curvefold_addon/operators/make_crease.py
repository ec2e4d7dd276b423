"""Curves and grease pencil strokes become creases."""

from typing import ClassVar

import bpy

from ... import solver
from .. import later_work
from ..bridge import crease_making, drawing_objects, strokes
from ..drawing_context import (
    NO_SHEET,
    active_sheet,
    changeable,
    drawing_changed,
    in_object_mode,
    may_change,
    may_change_some,
    select_only,
)


class MakeCrease(bpy.types.Operator):
    """Lay the selected curves and grease pencil strokes onto the sheet as creases"""

    bl_idname = "curvefold.make_crease"
    bl_label = "Make Crease"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        sheet = active_sheet(context)
        if sheet is None:
            cls.poll_message_set(NO_SHEET)
            return False
        if not _candidates(context):
            cls.poll_message_set("Select curves or grease pencil strokes as well as the sheet")
            return False
        curves = [item for item in _candidates(context) if item.type == "CURVE"]
        # Strokes are only read.
        if len(curves) == len(_candidates(context)) and not may_change_some(cls, curves):
            return False
        return may_change(cls, sheet) and in_object_mode(cls, context)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        sheet = active_sheet(context)
        made = []
        curves = [item for item in _candidates(context) if item.type == "CURVE"]
        drawn = [item for item in _candidates(context) if item.type != "CURVE"]
        for item in [*changeable(self, curves), *drawn]:
            try:
                if item.type == "CURVE":
                    crease_making.lay_curve(item, sheet)
                    made.append(item)
                    continue
                crease = crease_making.lay_strokes(item, sheet)
            except solver.CurvefoldError as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
            if crease is None:
                self.report({"WARNING"}, f"{item.name}: it has no stroke in this frame, so no crease was made")
            else:
                made.append(crease)
        if not made:
            return {"CANCELLED"}
        select_only(context, made[0])
        for crease in made:
            crease.select_set(True)
        for problem in drawing_changed(sheet):
            self.report({"WARNING"}, problem)
        return {"FINISHED"}


def _candidates(context: bpy.types.Context) -> list[bpy.types.Object]:
    """What is selected and could be a crease but is none of this sheet's yet."""
    sheet = active_sheet(context)
    return [
        item
        for item in context.selected_objects
        if item.type in {"CURVE", *strokes.TYPES}
        and not drawing_objects.is_sheet(item)
        and not (drawing_objects.is_crease(item) and drawing_objects.sheet_of(item) == sheet)
    ]


def register() -> None:
    bpy.utils.register_class(MakeCrease)


def unregister() -> None:
    bpy.utils.unregister_class(MakeCrease)
