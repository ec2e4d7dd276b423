"""What a press of the mouse does with the toolbar's tool for handles."""

from typing import ClassVar

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from ... import solver
from .. import live
from ..bridge.papers import is_paper
from ..bridge.snapping import POINT_REACH
from ..bridge.state import StateError
from ..drawing_context import select_only
from ..mouse_ray import MouseRay, point_on, ray_of, view_under
from .place_handle import BESIDE, place_along


class TakeHandle(bpy.types.Operator):
    """Take the handle under the mouse, or place one on the paper there"""

    bl_idname = "curvefold.take_handle"
    bl_label = "Take or Place Handle"
    # A new handle is the work of an operator with an undo step of its own.
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        ray = ray_of(context, event)
        if ray is None:
            return {"PASS_THROUGH"}
        hook = _hook_near(context, event)
        # Passed on, so that a drag of the mouse drags what was taken.
        if hook is not None:
            select_only(context, hook)
            return {"FINISHED", "PASS_THROUGH"}
        try:
            paper = _paper_under(context, ray)
            if paper is None:
                self.report({"INFO"}, BESIDE)
                return {"CANCELLED"}
            place_along(context, paper, ray)
        except (solver.CurvefoldError, StateError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED", "PASS_THROUGH"}


def _papers(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The papers that are seen, the one that is meant first."""
    meant = live.active_paper(context)
    seen = [item for item in context.visible_objects if is_paper(item) and item != meant]
    return seen if meant is None or not meant.visible_get() else [meant, *seen]


def _paper_under(context: bpy.types.Context, ray: MouseRay) -> bpy.types.Object | None:
    return next((paper for paper in _papers(context) if point_on(paper, ray) is not None), None)


def _hook_near(context: bpy.types.Context, event: bpy.types.Event) -> bpy.types.Object | None:
    """What pulls a handle and is nearest to the mouse, when that is near."""
    region, view = view_under(context, event)
    mouse = Vector((event.mouse_x - region.x, event.mouse_y - region.y))
    best, best_gap = None, POINT_REACH * context.preferences.system.ui_scale
    for paper in _papers(context):
        for handle in paper.data.curvefold.handles:
            hook = handle.hook
            if hook is None or not hook.visible_get():
                continue
            place = location_3d_to_region_2d(region, view, hook.matrix_world.translation)
            if place is not None and (place - mouse).length <= best_gap:
                best, best_gap = hook, (place - mouse).length
    return best


def register() -> None:
    bpy.utils.register_class(TakeHandle)


def unregister() -> None:
    bpy.utils.unregister_class(TakeHandle)
