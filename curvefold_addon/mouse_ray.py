"""Where the mouse points: which 3D view it is in, and what it means on a paper there."""

from dataclasses import dataclass

import bpy
from bpy_extras import view3d_utils
from mathutils import Vector

from .bridge import snapping, surface_points


@dataclass(frozen=True)
class MouseRay:
    """Where the mouse looks along, in the world; view: from where, None when nothing is to be near the mouse."""

    origin: Vector
    direction: Vector
    view: snapping.View | None = None


def ray_of(context: bpy.types.Context, event: bpy.types.Event) -> MouseRay | None:
    """That of an event; None when the mouse is in no 3D view."""
    region, view = view_under(context, event)
    if region is None:
        return None
    mouse = (event.mouse_x - region.x, event.mouse_y - region.y)
    return MouseRay(
        view3d_utils.region_2d_to_origin_3d(region, view, mouse),
        view3d_utils.region_2d_to_vector_3d(region, view, mouse),
        snapping.View(
            view.perspective_matrix, (region.width, region.height), mouse, context.preferences.system.ui_scale
        ),
    )


def point_on(paper: bpy.types.Object, ray: MouseRay) -> surface_points.SurfacePoint | None:
    """The point of a paper that is meant: the corner, crease or border near the mouse, else what is under it.

    None beside the paper. Raises StateError.
    """
    to_local = paper.matrix_world.inverted_safe()
    origin, direction = to_local @ ray.origin, to_local.to_3x3() @ ray.direction
    if ray.view is not None:
        view = snapping.View(ray.view.matrix @ paper.matrix_world, ray.view.size, ray.view.mouse, ray.view.scale)
        near = snapping.near_mouse(paper.data, view, origin, direction)
        if near is not None:
            return near
    return surface_points.under_ray(paper.data, origin, direction)


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
