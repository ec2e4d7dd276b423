"""File > Import > Crease Pattern, folded: read drawings, fold them, add the papers. Blocking, so also headless."""

from math import degrees, pi, radians
from typing import ClassVar

import bpy
from bpy.props import FloatProperty

from ... import solver
from .. import later_work, paper_material, wording
from ..bridge import drawing, linked, mesh, papers
from ..drawing_context import select_only
from ..resolution_property import resolution_property, told
from ..waiting import Waiting
from .drawing_files import FORMATS, READING, SUFFIXES, DrawingFiles


class FoldDrawing(DrawingFiles, bpy.types.Operator):
    """Folds the crease patterns in drawings and adds the papers."""

    bl_idname = "curvefold.fold_drawing"
    bl_label = "Fold Drawing"
    bl_description = f"Fold the crease patterns in {FORMATS} files and add the papers"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    choices: ClassVar[tuple[str, ...]] = (*READING, "angle", "resolution")

    resolution: resolution_property(soft_max=100)
    angle: FloatProperty(
        name="Fold Angle",
        description="How far every crease is folded, on whichever side it chooses; flat is zero",
        subtype="ANGLE",
        default=radians(60.0),
        min=0.0,
        max=pi,
    )

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        files = self.read_files()
        added = []
        for patterns, (x, y) in zip(files, drawing.row(files), strict=True):
            for pattern in patterns:
                paper = self._fold(context, pattern, sum(map(len, files)) > 1)
                if paper is not None:
                    paper.location = (x, y, 0.0)
                    added.append(paper)
        if not added:
            return {"CANCELLED"}
        select_only(context, *added)
        return {"FINISHED"}

    def _fold(
        self, context: bpy.types.Context, pattern: solver.CreasePattern, one_of_many: bool
    ) -> bpy.types.Object | None:
        """A paper where the file has it; None when it cannot be folded. The user is told how it went."""
        beginning = f"{pattern.name}: " if one_of_many else ""
        try:
            description = solver.FoldDescription(resolution=told(self.resolution), angle=degrees(self.angle))
            with Waiting(context) as waiting:
                result = solver.fold(pattern, description, waiting.iterations)
        except solver.CurvefoldError as error:
            self.refuse(error if error.where.file else error.in_file(pattern.name), beginning)
            return None
        paper = mesh.add_paper(result, linked.new_home(), paper_material.paper_material())
        papers.keep(paper, result)
        self.tell(result.net.notes, beginning)
        kind = "INFO" if result.status.ok else "WARNING"
        self.report({kind}, wording.readable(beginning + result.status.sentence))
        return paper


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(FoldDrawing.bl_idname, text=f"Crease Pattern, folded ({SUFFIXES})")


def register() -> None:
    bpy.utils.register_class(FoldDrawing)
    bpy.types.TOPBAR_MT_file_import.append(_menu_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu_entry)
    bpy.utils.unregister_class(FoldDrawing)
