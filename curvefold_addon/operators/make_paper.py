"""From drawings to papers that fold: each of the sheets that are meant becomes a mesh in the same place."""

from typing import ClassVar

import bpy
from bpy.props import FloatProperty

from ... import solver
from .. import drawing_tool, handle_making, later_work, live, paper_material, shown_drawing
from ..bridge import drawing, linked, papers, state
from ..bridge.nets import choose
from ..bridge.session import flat_session
from ..drawing_context import NO_SHEET, meant_sheets, select_only
from ..resolution_property import resolution_property
from ..waiting import busy


class MakePaper(bpy.types.Operator):
    """Make a paper of each selected sheet, ready to be folded; the drawing is hidden and can still be edited"""

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
        if not meant_sheets(context):
            cls.poll_message_set(NO_SHEET)
            return False
        return True

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        sheets = meant_sheets(context)
        drawing_tool.leave_edit_mode(context)
        made, faults = [], []
        for sheet in sheets:
            try:
                with busy(context):
                    made.append(self._make(sheet))
            except solver.CurvefoldError as error:
                faults.append(str(error))
        for fault in faults:
            # Where there are some papers, it has not failed.
            self.report({"WARNING"} if made else {"ERROR"}, fault)
        if not made:
            return {"CANCELLED"}
        select_only(context, *made)
        for paper in made:
            shown_drawing.show(paper.data.curvefold.sheet, False)
            try:
                handle_making.go_on(paper)
            except solver.CurvefoldError as error:
                self.report({"ERROR"}, str(error))
        return {"FINISHED"}

    def _make(self, sheet: bpy.types.Object) -> bpy.types.Object:
        """A flat paper of a sheet. Raises CurvefoldError."""
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
        for note in (*chosen.notes, *made.net.notes):
            self.report({"INFO"}, note)
        return paper


def register() -> None:
    bpy.utils.register_class(MakePaper)


def unregister() -> None:
    bpy.utils.unregister_class(MakePaper)
