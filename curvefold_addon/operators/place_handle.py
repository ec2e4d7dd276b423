"""Handles by clicking on the paper."""

from typing import ClassVar

import bpy

from ... import solver
from .. import live
from ..bridge.state import StateError
from ..mouse_ray import MouseRay, point_on, ray_of
from .on_paper import AwaitsClicks

BESIDE = "There is no paper under the mouse"


class PlaceHandle(AwaitsClicks, bpy.types.Operator):
    """Click on the paper to place handles; each gets an empty to drag it by"""

    bl_idname = "curvefold.place_handle"
    bl_label = "Place Handles"
    # Every click calls an operator with an undo step of its own, and that is the one that can be adjusted.
    bl_options: ClassVar[set[str]] = {"REGISTER"}

    what = "Handles"
    cursor = "CROSSHAIR"
    help = "Click on the paper to place a handle, then drag it with G   |   Enter, Esc or right click: done"
    without_mouse = "Handles are placed with the mouse; use Add Handles in Edit Mode instead"

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        paper = self.waiting_paper(context)
        done = event.type in {"ESC", "RIGHTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS"
        if done or paper is None:
            self.cancel(context)
            return {"FINISHED"}
        ray = ray_of(context, event) if event.type == "LEFTMOUSE" and event.value == "PRESS" else None
        if ray is None:
            return {"PASS_THROUGH"}
        try:
            if place_along(context, paper, ray) is None:
                self.report({"INFO"}, BESIDE)
        except (solver.CurvefoldError, StateError) as error:
            self.report({"ERROR"}, str(error))
        return {"RUNNING_MODAL"}


def place_along(context: bpy.types.Context, paper: bpy.types.Object, ray: MouseRay) -> bpy.types.Object | None:
    """A handle where the mouse points on a paper, and its empty; None beside it.

    Raises CurvefoldError, StateError.
    """
    live.check_follows(paper.data)
    point = point_on(paper, ray)
    if point is None:
        return None
    live.make_session(paper).place_of(point.at)  # what is wrong with the paper or the point is said here
    bpy.ops.curvefold.add_handle("EXEC_DEFAULT", True, paper=paper.name, at=point.at)
    return context.view_layer.objects.active


def register() -> None:
    bpy.utils.register_class(PlaceHandle)


def unregister() -> None:
    bpy.utils.unregister_class(PlaceHandle)
