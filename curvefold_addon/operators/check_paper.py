"""Is this paper? The certificate, for papers and for any other mesh."""

from typing import ClassVar

import bpy

from ... import solver
from .. import later_work, live
from ..bridge import mesh_check
from ..bridge.state import StateError, is_stored
from ..drawing_context import in_object_mode
from ..waiting import busy


class CheckPaper(bpy.types.Operator):
    """Check whether the mesh could be made of its flat sheet, its UV map, without stretching or tearing it"""

    bl_idname = "curvefold.check_paper"
    bl_label = "Check Paper"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if _meant(context) is None:
            cls.poll_message_set("Select a paper, or another mesh with a UV map that is its flat sheet")
            return False
        return in_object_mode(cls, context)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        item = _meant(context)
        try:
            with busy(context):
                found = mesh_check.check(item, context.evaluated_depsgraph_get(), _session(item))
        except mesh_check.CheckError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        sentence = found.sentence
        if found.vertex is not None and item.data.is_editable:
            mesh_check.select_vertex(item.data, found.vertex)
            sentence += "; Edit Mode shows where"
        self.report({"INFO"} if found.ok else {"WARNING"}, sentence)
        return {"FINISHED"}


def _meant(context: bpy.types.Context) -> bpy.types.Object | None:
    """The active mesh, or the paper that the active object pulls."""
    active = context.active_object
    return active if active is not None and active.type == "MESH" else live.active_paper(context)


def _session(item: bpy.types.Object) -> live.Session | None:
    """That of a paper; None for another mesh, and for a paper whose net cannot be made any more."""
    if not (item.data.curvefold.is_paper and is_stored(item.data)):
        return None
    try:
        return live.make_session(item)
    except (solver.CurvefoldError, StateError):
        return None


def _menu_entry(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.separator()
    menu.layout.operator(CheckPaper.bl_idname, icon="VIEWZOOM")


def register() -> None:
    bpy.utils.register_class(CheckPaper)
    bpy.types.VIEW3D_MT_object.append(_menu_entry)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(_menu_entry)
    bpy.utils.unregister_class(CheckPaper)
