"""File > Import > Crease Pattern: drawings as curves, to be edited and folded."""

from collections.abc import Sequence
from typing import ClassVar

import bpy

from ... import solver
from .. import later_work, looking
from ..bridge import drawing, linked
from ..drawing_context import in_object_mode, select_only
from .drawing_files import FORMATS, SUFFIXES, DrawingFiles


class ImportDrawing(DrawingFiles, bpy.types.Operator):
    """Adds the crease patterns in drawings as sheets with creases."""

    bl_idname = "curvefold.import_drawing"
    bl_label = "Import Crease Pattern"
    bl_description = f"Add the crease patterns in {FORMATS} files as sheets with creases"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return in_object_mode(cls, context)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        files = self.read_files()
        if not files:
            return {"CANCELLED"}
        add_at_cursor(context, files)
        return {"FINISHED"}


def add_at_cursor(context: bpy.types.Context, files: Sequence[Sequence[solver.CreasePattern]]) -> None:
    """Sheets with the patterns' creases, all selected: those of a file as they lie in it, the files in a row."""
    sheets = drawing.add_drawings(files, linked.new_home(), context.scene.cursor.location)
    select_only(context, *sheets)
    looking.show(context, *sheets)


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(ImportDrawing.bl_idname, text=f"Crease Pattern ({SUFFIXES})")


def register() -> None:
    bpy.utils.register_class(ImportDrawing)
    bpy.types.TOPBAR_MT_file_import.append(_menu_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu_entry)
    bpy.utils.unregister_class(ImportDrawing)
