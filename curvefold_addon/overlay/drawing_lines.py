"""Which lines of the drawings a viewport shows."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ..bridge import drawing_lines as arrays
from ..bridge import drawing_objects
from ..bridge.drawn import Color, Outline
from .drawing_watch import Kept

_lines = Kept(lambda part: arrays.lines_of(part))


@dataclass(frozen=True)
class PartLines:
    """A part of a drawing, its lines in its own coordinates, and their colour now."""

    part: bpy.types.Object
    lines: Outline
    color: Color


def is_kept(uid: int) -> bool:
    """Whether the lines of the object with this ``session_uid`` are kept."""
    return uid in _lines.found


def shown(context: bpy.types.Context) -> Iterator[PartLines]:
    """The lines of sheets and creases that are seen in the context's viewport, and are not being edited."""
    theme = context.preferences.themes[0].view_3d
    for part in context.view_layer.objects:
        if not drawing_objects.is_part(part) or part.mode == "EDIT":
            continue
        lines = _lines.of(part) if part.visible_in_viewport_get(context.space_data) else None
        if lines is None:
            continue
        color = arrays.color_of(part)
        if part.select_get():
            chosen = theme.object_active if part == context.view_layer.objects.active else theme.object_selected
            color = (*chosen, 1.0)
        yield PartLines(part, lines, color)
