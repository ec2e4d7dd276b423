"""From papers to meshes that the extension leaves alone."""

from collections.abc import Iterable
from typing import ClassVar

import bpy

from .. import later_work, live, wording
from ..bridge import baking, linked, state
from ..bridge.papers import is_paper
from ..drawing_context import in_object_mode


class MakeOrdinaryMesh(bpy.types.Operator):
    """Let the selected papers be meshes like any other, in the shape that they have; they fold no more"""

    bl_idname = "curvefold.make_ordinary_mesh"
    bl_label = "Make Ordinary Mesh"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        chosen = _papers(context)
        if not chosen:
            cls.poll_message_set("Select papers")
            return False
        reason = _why_none(chosen)
        if reason:
            cls.poll_message_set(reason)
            return False
        return in_object_mode(cls, context)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        chosen = _papers(context)
        made = []
        for paper in chosen:
            reason = linked.why_not_changeable(paper.name, paper.data)
            if reason:
                self.report({"WARNING"}, reason)
            else:
                made.append(paper)
        for mesh in {paper.data.session_uid: paper.data for paper in made}.values():
            _make_ordinary(mesh, [paper for paper in made if paper.data == mesh])
        self.report({"INFO"}, f"Made {wording.count(len(made), 'ordinary mesh', 'ordinary meshes')}")
        return {"FINISHED"}


def _papers(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected papers; where none is selected, the one that is meant."""
    chosen = [item for item in context.selected_objects if is_paper(item)]
    meant = None if chosen else live.active_paper(context)
    return chosen if meant is None else [meant]


def _why_none(papers: Iterable[bpy.types.Object]) -> str:
    """Why no paper can become an ordinary mesh; empty when one can."""
    reasons = [linked.why_not_changeable(paper.name, paper.data) for paper in papers]
    return "" if "" in reasons else reasons[0]


def _make_ordinary(mesh: bpy.types.Mesh, chosen: list[bpy.types.Object]) -> None:
    """The mesh of the chosen objects; others that show it keep the paper."""
    if any(item.data == mesh and item not in chosen for item in bpy.data.objects):
        mesh = mesh.copy()
        for item in chosen:
            item.data = mesh
    live.drop(mesh)
    mesh.property_unset("curvefold")
    state.clear(mesh)
    baking.leave_keys(mesh)


def _menu_entry(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    if any(is_paper(item) for item in context.selected_objects):
        menu.layout.separator()
        menu.layout.operator(MakeOrdinaryMesh.bl_idname, icon="OUTLINER_OB_MESH")


def register() -> None:
    bpy.utils.register_class(MakeOrdinaryMesh)
    bpy.types.VIEW3D_MT_object_convert.append(_menu_entry)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object_convert.remove(_menu_entry)
    bpy.utils.unregister_class(MakeOrdinaryMesh)
