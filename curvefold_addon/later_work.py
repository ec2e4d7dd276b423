"""Adjust Last Operation, which must not take back what was done after that operation.

Blender adjusts an operator by going back to the undo step before it and running it again: whatever was done since
is gone, and Redo does not bring it back. Blender offers that only for the operator that was called last, and not
once a field of a panel was edited; but what a script does, or an operator that is not listed, goes unnoticed.
So an operator that changes drawings or papers compares what it left with what was there when it is adjusted.
"""

import functools
from array import array
from collections.abc import Callable, Iterator

import bpy

from .bridge.papers import is_paper

Execute = Callable[[bpy.types.Operator, bpy.types.Context], set[str]]

CHANGED = "This cannot be adjusted any more: what was done since would be lost"

#: What was there when Blender began to adjust an operator; None when it does not.
_before: str | None = None


def kept(execute: Execute) -> Execute:
    """An operator's ``execute`` that refuses to be adjusted where that would take back later work."""

    @functools.wraps(execute)
    def keeping(self: bpy.types.Operator, context: bpy.types.Context) -> set[str]:
        global _before
        before, _before = _before, None
        left = getattr(self, "left", None)
        if self.options.is_repeat and None not in (before, left) and before != left:
            self.report({"WARNING"}, CHANGED)
            # Blender itself goes one step forward again, once this has returned.
            bpy.app.timers.register(come_forward, first_interval=0.0)
            return {"CANCELLED"}
        result = execute(self, context)
        if "FINISHED" in result:
            # Blender keeps the operator for as long as it can be adjusted.
            self.left = fingerprint(context.scene)
        return result

    return keeping


def undo_begins(*_: object) -> None:
    """Looks at what is there, in case an operator is being adjusted; Undo itself empties Blender's list of them."""
    global _before
    _before = fingerprint(bpy.context.scene) if _last_is_ours() else None


def come_forward() -> None:
    """Redoes all that can be redone: it was there before an operator refused to be adjusted."""
    manager = bpy.context.window_manager
    if not len(manager.windows):
        return
    with bpy.context.temp_override(window=manager.windows[0]):
        while bpy.ops.ed.redo.poll() and bpy.ops.ed.redo() == {"FINISHED"}:
            pass


def fingerprint(scene: bpy.types.Scene) -> str:
    """The objects of a scene with their places, its drawings, and what its papers are told; not how they bend."""
    return repr(list(_facts(scene)))


def _last_is_ours() -> bool:
    listed = (op for op in reversed(bpy.context.window_manager.operators) if op.bl_options >= {"REGISTER", "UNDO"})
    last = next(listed, None)
    return last is not None and last.bl_idname.startswith("CURVEFOLD_OT_")


def _facts(scene: bpy.types.Scene) -> Iterator[object]:
    for thing in scene.objects:
        yield thing.name, [tuple(row) for row in thing.matrix_basis]
        if thing.curvefold.role != "NONE":
            yield _told(thing.curvefold), thing.parent and thing.parent.name
            if thing.type == "CURVE":
                yield [_points(spline) for spline in thing.data.splines]
        if is_paper(thing):
            yield thing.data.name, _told(thing.data.curvefold)


def _points(spline: bpy.types.Spline) -> tuple[bool, int]:
    """Whether a spline is closed, and its points in short."""
    bezier = spline.type == "BEZIER"
    points = spline.bezier_points if bezier else spline.points
    places = []
    for name in ("co", "handle_left", "handle_right") if bezier else ("co",):
        numbers = array("f", bytes(4 * (3 if bezier else 4) * len(points)))
        points.foreach_get(name, numbers)
        places.append(numbers.tobytes())
    return spline.use_cyclic_u, hash(tuple(places))


def _told(group: bpy.types.PropertyGroup) -> list[object]:
    """The values of a group of properties and of the groups in it."""
    values: list[object] = []
    for kind in group.bl_rna.properties:
        if kind.identifier == "rna_type" or kind.is_skip_save:
            continue
        value = getattr(group, kind.identifier)
        if kind.type == "COLLECTION":
            values.append([_told(entry) for entry in value])
        elif isinstance(value, bpy.types.PropertyGroup):
            values.append(_told(value))
        elif kind.type == "POINTER":
            values.append(value and value.name)
        else:
            values.append(tuple(value) if getattr(kind, "is_array", False) else value)
    return values
