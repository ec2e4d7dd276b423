"""Whether a drawing is seen in the viewport: its sheet and its creases, in the view layer that is worked in.

A drawing that is hidden stays in the file, is folded as it is, and is what Blender's own Hide makes of it.
"""

import bpy

from .bridge import drawing_objects


def is_shown(sheet: bpy.types.Object) -> bool:
    """Whether any part of a drawing is not hidden."""
    return any(not part.hide_get() for part in _parts(sheet))


def show(sheet: bpy.types.Object, shown: bool) -> None:
    """Shows a drawing or hides it; what is being edited stays."""
    for part in _parts(sheet):
        if part.mode == "OBJECT":
            part.hide_set(not shown)


def _parts(sheet: bpy.types.Object) -> list[bpy.types.Object]:
    """The sheet and its creases, as far as they are in the view layer."""
    present = set(bpy.context.view_layer.objects)
    return [part for part in (sheet, *drawing_objects.creases_of(sheet)) if part in present]
