"""Handles by clicking on the paper."""

from typing import ClassVar

import bpy
from bpy_extras import view3d_utils

from ... import solver
from .. import drawing_tool, live
from ..bridge import surface_points
from ..bridge.state import StateError
from .on_paper import OnPaper

HELP = "Click on the paper to place a handle, then drag it with G   |   Enter, Esc or right click: done"


class PlaceHandle(OnPaper, bpy.types.Operator):
    """Click on the paper to place handles; each gets an empty to drag it by"""

    bl_idname = "curvefold.place_handle"
    bl_label = "Place Handles"
    # Every click calls an operator with an undo step of its own, and that is the one that can be adjusted.
    bl_options: ClassVar[set[str]] = {"REGISTER"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, "Handles are placed in a 3D view")
            return {"CANCELLED"}
        drawing_tool.leave_edit_mode(context)
        paper = live.active_paper(context)
        try:
            live.check_follows(paper.data)
        except StateError as error:
            return self.refuse(str(error))
        self._paper = paper.name
        context.window.cursor_modal_set("CROSSHAIR")
        context.workspace.status_text_set(HELP)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.refuse("Handles are placed with the mouse; use Add Handles in Edit Mode instead")

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        paper = context.scene.objects.get(self._paper)
        done = event.type in {"ESC", "RIGHTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS"
        if done or paper is None:
            self.cancel(context)
            return {"FINISHED"}
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            region, view = view_under(context, event)
            if region is not None:
                mouse = (event.mouse_x - region.x, event.mouse_y - region.y)
                return self._click(context, paper, region, view, mouse)
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)

    def _click(
        self,
        context: bpy.types.Context,
        paper: bpy.types.Object,
        region: bpy.types.Region,
        view: bpy.types.RegionView3D,
        mouse: tuple[int, int],
    ) -> set[str]:
        origin = view3d_utils.region_2d_to_origin_3d(region, view, mouse)
        direction = view3d_utils.region_2d_to_vector_3d(region, view, mouse)
        try:
            if place_along(context, paper, origin, direction) is None:
                self.report({"INFO"}, "There is no paper under the mouse")
        except (solver.CurvefoldError, StateError) as error:
            self.report({"ERROR"}, str(error))
        return {"RUNNING_MODAL"}


def place_along(context: bpy.types.Context, paper: bpy.types.Object, origin, direction) -> bpy.types.Object | None:
    """A handle where a ray of the world first meets the paper, and its empty; None when it misses.

    Raises CurvefoldError, StateError.
    """
    live.check_follows(paper.data)
    to_local = paper.matrix_world.inverted_safe()
    point = surface_points.under_ray(paper.data, to_local @ origin, to_local.to_3x3() @ direction)
    if point is None:
        return None
    live.make_session(paper).place_of(point.at)  # what is wrong with the paper or the point is said here
    bpy.ops.curvefold.add_handle("EXEC_DEFAULT", True, paper=paper.name, at=point.at)
    return context.view_layer.objects.active


def view_under(
    context: bpy.types.Context, event: bpy.types.Event
) -> tuple[bpy.types.Region | None, bpy.types.RegionView3D | None]:
    """The 3D view in which the mouse is, without its toolbars and menus."""
    for area in context.window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        inside = [region for region in area.regions if _holds(region, event)]
        if any(region.type != "WINDOW" for region in inside):
            return None, None
        for region in inside:
            return region, region.data
    return None, None


def _holds(region: bpy.types.Region, event: bpy.types.Event) -> bool:
    return (
        region.x <= event.mouse_x < region.x + region.width and region.y <= event.mouse_y < region.y + region.height
    )


def register() -> None:
    bpy.utils.register_class(PlaceHandle)


def unregister() -> None:
    bpy.utils.unregister_class(PlaceHandle)
