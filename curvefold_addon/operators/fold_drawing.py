"""File > Import > Crease Pattern: read a drawing, fold it, add the paper. Blocking, so also headless."""

from math import degrees, pi, radians
from typing import ClassVar

import bpy
from bpy.props import FloatProperty, IntProperty, StringProperty

from ... import solver
from .. import paper_material
from ..bridge import mesh, papers
from ..drawing_context import select_only


class FoldDrawing(bpy.types.Operator):
    """Fold the crease pattern in an SVG or FOLD file and add the paper"""

    bl_idname = "curvefold.fold_drawing"
    bl_label = "Fold Drawing"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE"})
    filter_glob: StringProperty(default="*.svg;*.svgz;*.fold", options={"HIDDEN"})
    resolution: IntProperty(
        name="Resolution",
        description="Quads along the longer side of the sheet",
        default=32,
        min=4,
        soft_max=100,
    )
    angle: FloatProperty(
        name="Fold Angle",
        description="How far every crease is folded, on whichever side it chooses; flat is zero",
        subtype="ANGLE",
        default=radians(60.0),
        min=0.0,
        max=pi,
    )

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
            description = solver.FoldDescription(resolution=self.resolution, angle=degrees(self.angle))
            result = solver.fold(pattern, description)
        except solver.CurvefoldError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        paper = mesh.add_paper(result, context.collection, paper_material.paper_material())
        papers.keep(paper, result)
        select_only(context, paper)
        self.report({"INFO"} if result.status.ok else {"WARNING"}, result.status.sentence)
        return {"FINISHED"}


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(FoldDrawing.bl_idname, text="Crease Pattern, folded (.svg, .fold)")


def register() -> None:
    bpy.utils.register_class(FoldDrawing)
    bpy.types.TOPBAR_MT_file_import.append(_menu_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu_entry)
    bpy.utils.unregister_class(FoldDrawing)
