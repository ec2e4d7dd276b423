"""Drawings dropped into a 3D viewport."""

import bpy

from .. import solver
from .operators.import_drawing import ImportDrawing


class CURVEFOLD_FH_drawing(bpy.types.FileHandler):  # noqa: N801  (Blender wants the name like this)
    """Adds dropped drawings as sheets with creases."""

    bl_idname = "CURVEFOLD_FH_drawing"
    bl_label = "Crease Pattern"
    bl_import_operator = ImportDrawing.bl_idname
    bl_file_extensions = ";".join(solver.DRAWING_SUFFIXES)

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        return context.area is not None and context.area.type == "VIEW_3D"


def register() -> None:
    bpy.utils.register_class(CURVEFOLD_FH_drawing)


def unregister() -> None:
    bpy.utils.unregister_class(CURVEFOLD_FH_drawing)
