"""From a drawing to a paper that folds: the active sheet becomes a mesh in the same place."""

from typing import ClassVar

import bpy
from bpy.props import FloatProperty

from ... import solver
from .. import drawing_tool, handle_making, later_work, live, paper_material
from ..bridge import drawing, linked, papers, state
from ..bridge.nets import choose
from ..bridge.session import flat_session
from ..drawing_context import NO_SHEET, active_sheet, select_only
from ..resolution_property import resolution_property


class MakePaper(bpy.types.Operator):
    """Make a paper of the active drawing, ready to be folded; the drawing stays and can be edited"""

    bl_idname = "curvefold.make_paper"
    bl_label = "Make Paper"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    resolution: resolution_property(soft_max=80)
    fold: FloatProperty(
        name="Fold",
        description="How far all creases are folded, each on the side it chooses",
        subtype="PERCENTAGE",
        default=0.0,
        min=0.0,
        max=100.0,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if active_sheet(context) is None:
            cls.poll_message_set(NO_SHEET)
            return False
        return True

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        sheet = active_sheet(context)
        drawing_tool.leave_edit_mode(context)
        try:
            chosen = choose(state.source_of(drawing.read_drawing(sheet), self.resolution))
            made = flat_session(chosen.source)
            paper = papers.new_paper("Paper", linked.new_home(), paper_material.paper_material())
            paper.matrix_world = sheet.matrix_world
            settings = paper.data.curvefold
            settings.sheet = sheet
            settings.resolution = self.resolution
            settings.fold = self.fold
            settings.is_paper = True
            live.adopt(paper, made)
            select_only(context, paper)
            handle_making.go_on(paper)
        except solver.CurvefoldError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        for note in (*chosen.notes, *made.net.notes):
            self.report({"INFO"}, note)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(MakePaper)


def unregister() -> None:
    bpy.utils.unregister_class(MakePaper)
