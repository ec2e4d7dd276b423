"""What the extension does to 3D views.

They turn to what was added where it would hardly be seen, a letter among things of metres; and they show no lines
between a paper and its handles.
"""

import bpy
from mathutils import Vector

#: A thing fills this much of the view's shorter side when it is turned to ...
FILLS = 0.64
#: ... and below this, or above the whole side, it is.
SMALL = 0.3
#: Width of the view's camera, mm, with the zoom that Blender gives it.
SENSOR = 72.0


def hide_relations() -> None:
    """Switches off, in the 3D views of the windows, the dashed lines from children to their parents."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.spaces.active.overlay.show_relationship_lines = False


def show(context: bpy.types.Context, *things: bpy.types.Object) -> None:
    """Moves the view from which a command was given, if there is one; never turns it."""
    space = context.space_data
    if bpy.app.background or space is None or space.type != "VIEW_3D" or space.region_3d is None:
        return
    view = space.region_3d
    if view.view_perspective == "CAMERA":
        return
    context.view_layer.update()
    corners = [thing.matrix_world @ Vector(corner) for thing in things for corner in thing.bound_box]
    low, high = (Vector(map(pick, zip(*corners, strict=True))) for pick in (min, max))
    middle = (low + high) / 2.0
    size = 2.0 * max((corner - middle).length for corner in corners)
    if size == 0.0:
        return
    area = context.area
    side = SENSOR / space.lens * min(area.width, area.height) / max(area.width, area.height)
    seen = size / (side * view.view_distance)
    away = (middle - view.view_location).length / (side * view.view_distance)
    if SMALL <= seen <= 1.0 and away <= 0.5:
        return
    view.view_location = middle
    view.view_distance = size / (side * FILLS)
