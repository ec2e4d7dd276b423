"""Choosing a crease by clicking on it."""

from typing import ClassVar

import bpy
from bpy_extras import view3d_utils

from ... import solver
from .. import live
from ..bridge import surface_points
from ..bridge.state import StateError
from .on_paper import OnPaper
from .place_handle import view_under

HELP = "Click on a crease of the paper   |   Esc or right click: leave it"


class PickCrease(OnPaper, bpy.types.Operator):
    """Click on a crease of the paper to make it the active one"""

    bl_idname = "curvefold.pick_crease"
    bl_label = "Pick Crease"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            return self.refuse("Creases are picked in a 3D view")
        self._paper = live.active_paper(context).name
        context.window.cursor_modal_set("EYEDROPPER")
        context.workspace.status_text_set(HELP)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.refuse("Creases are picked with the mouse; choose one in the list instead")

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        paper = context.scene.objects.get(self._paper)
        if paper is None or (event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"):
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            region, view = view_under(context, event)
            if region is not None:
                mouse = (event.mouse_x - region.x, event.mouse_y - region.y)
                origin = view3d_utils.region_2d_to_origin_3d(region, view, mouse)
                direction = view3d_utils.region_2d_to_vector_3d(region, view, mouse)
                try:
                    found = pick_along(paper, origin, direction)
                except (solver.CurvefoldError, StateError) as error:
                    self.cancel(context)
                    return self.refuse(str(error))
                if not found:
                    self.report({"INFO"}, "There is no paper under the mouse")
                    return {"RUNNING_MODAL"}
                self.cancel(context)
                for area in context.window.screen.areas:
                    area.tag_redraw()
                return {"FINISHED"}
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)


def pick_along(paper: bpy.types.Object, origin, direction) -> bool:
    """Makes the crease active that is nearest to where a ray of the world meets the paper; whether it meets it."""
    to_local = paper.matrix_world.inverted_safe()
    crease = surface_points.crease_under_ray(paper.data, to_local @ origin, to_local.to_3x3() @ direction)
    if crease is None:
        return False
    live.make_session(paper)
    paper.data.curvefold.active_crease = crease
    return True


def register() -> None:
    bpy.utils.register_class(PickCrease)


def unregister() -> None:
    bpy.utils.unregister_class(PickCrease)
