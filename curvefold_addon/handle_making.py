"""Handles as the operators make and remove them."""

from collections.abc import Sequence

import bpy
from mathutils import Vector

from . import live, looking
from .bridge import hooks, linked
from .bridge.mesh import longer_side
from .bridge.surface_points import SurfacePoint

#: Size of a handle's empty, relative to the longer side of the paper.
EMPTY_SIZE = 0.025
EMPTY_COLOR = (1.0, 0.55, 0.1, 1.0)
#: Marks empties that were made for a handle and go with it.
OURS = "curvefold_handle"


def add_handle(paper: bpy.types.Object, point: SurfacePoint) -> bpy.types.PropertyGroup:
    """A new handle, which becomes the active one; it is a pin until it gets a hook.

    It holds the point exactly where the net has it, so that holding it moves nothing. Raises HandleError off the
    sheet.
    """
    place = live.make_session(paper).place_of(point.at)
    settings = paper.data.curvefold
    taken = {handle.name for handle in settings.handles}
    number = next(n for n in range(1, len(taken) + 2) if f"Handle {n}" not in taken)
    handle = settings.handles.add()
    settings.active_handle = len(settings.handles) - 1
    handle.name = f"Handle {number}"
    handle.at = point.at
    handle.offset = place
    handle.pinned = True
    return handle


def hook_to(handle: bpy.types.PropertyGroup, paper: bpy.types.Object, hook: bpy.types.Object) -> None:
    """Hangs a handle on an object; its target stays where it is."""
    target = handle.offset.copy()
    handle.hook = hook
    handle.pinned = False
    handle.offset = hooks.offset_in(hook, paper, bpy.context.evaluated_depsgraph_get(), target)


def new_empty(paper: bpy.types.Object, place: Sequence[float], name: str) -> bpy.types.Object:
    """An empty at a place of the paper's local coordinates, which moves with the paper.

    With the first one, lines from children to parents are switched off; who switches them on again, keeps them.
    """
    if not any(child.get(OURS) for child in paper.children):
        looking.hide_relations()
    empty = bpy.data.objects.new(name, None)
    empty[OURS] = True
    empty.empty_display_type = "SPHERE"
    empty.empty_display_size = EMPTY_SIZE * longer_side(paper.data)
    empty.show_in_front = True
    empty.color = EMPTY_COLOR
    for collection in linked.homes_beside(paper):
        collection.objects.link(empty)
    empty.parent = paper
    empty.location = place
    # Until now Blender does not know where it is.
    bpy.context.view_layer.update()
    return empty


def remove_handle(paper: bpy.types.Object, index: int) -> None:
    """Removes a handle, and its empty when that was made for it and nothing else needs it."""
    settings = paper.data.curvefold
    hook = settings.handles[index].hook
    settings.handles.remove(index)
    settings.active_handle = max(0, min(settings.active_handle, len(settings.handles) - 1))
    drop_empty(hook)


def drop_empty(hook: bpy.types.Object | None) -> None:
    """Removes what pulls no handle any more, when it was made for one and nothing else needs it."""
    if hook is not None and _is_ours(hook) and not hook.children and _is_unused(hook):
        bpy.data.objects.remove(hook)


def _is_ours(hook: bpy.types.Object) -> bool:
    """Whether an empty was made for a handle, and in this file."""
    return bool(hook.get(OURS)) and linked.is_local(hook)


def _is_unused(hook: bpy.types.Object) -> bool:
    return hook.users <= len(hook.users_collection)


def go_on(paper: bpy.types.Object) -> None:
    """The paper follows what was changed: at once without a window, soon with one or after Edit Mode.

    Raises CurvefoldError, StateError.
    """
    if bpy.app.background and not paper.data.is_editmode and paper.data.shape_keys is None:
        live.settle(paper.data)
    else:
        live.wake(paper.data)


def lay_flat(paper: bpy.types.Object) -> None:
    """Asks every handle to hold its point of the flat sheet; empties made for one handle move there."""
    settings = paper.data.curvefold
    settings.fold = 0.0
    depsgraph = bpy.context.evaluated_depsgraph_get()
    hung = [handle.hook for handle in settings.handles]
    for handle in settings.handles:
        place = Vector((*handle.at, 0.0))
        hook = handle.hook
        if hook is None:
            if handle.pinned:
                handle.offset = place
        elif _is_ours(hook) and hung.count(hook) == 1 and hook.parent == paper and not hook.animation_data:
            hook.matrix_basis.identity()
            hook.matrix_parent_inverse.identity()
            hook.location = place
            handle.offset = (0.0, 0.0, 0.0)
        else:
            handle.offset = hooks.offset_in(hook, paper, depsgraph, place)
