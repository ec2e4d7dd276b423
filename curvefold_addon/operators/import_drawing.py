"""File > Import > Crease Pattern: the drawing as curves, to be edited and folded."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ... import solver
from .. import looking
from ..bridge import drawing
from ..drawing_context import in_object_mode, select_only


class ImportDrawing(bpy.types.Operator):
    """Add the crease pattern in an SVG or FOLD file as a sheet with creases"""

    bl_idname = "curvefold.import_drawing"
    bl_label = "Import Crease Pattern"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE"})
    filter_glob: StringProperty(default="*.svg;*.svgz;*.fold", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return in_object_mode(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.filepath:
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self.filepath:
            self.report({"ERROR"}, "No drawing was chosen")
            return {"CANCELLED"}
        try:
            pattern = solver.read_pattern(bpy.path.abspath(self.filepath))
        except solver.CurvefoldError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        add_at_cursor(context, pattern)
        for note in pattern.notes:
            self.report({"INFO"}, note)
        return {"FINISHED"}


def add_at_cursor(context: bpy.types.Context, pattern: solver.CreasePattern) -> bpy.types.Object:
    """A sheet with the pattern's creases, selected."""
    sheet = drawing.add_drawing(pattern, context.collection)
    sheet.location = context.scene.cursor.location
    select_only(context, sheet)
    looking.show(context, sheet)
    return sheet


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(ImportDrawing.bl_idname, text="Crease Pattern (.svg, .fold)")


def register() -> None:
    bpy.utils.register_class(ImportDrawing)
    bpy.types.TOPBAR_MT_file_import.append(_menu_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu_entry)
    bpy.utils.unregister_class(ImportDrawing)
