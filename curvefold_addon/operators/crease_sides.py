"""The sides of creases: held to what was found, turned over, and let go."""

from typing import ClassVar

import bpy
from bpy.props import IntProperty

from .. import handle_making, live
from .on_paper import OnPaper

_OTHER = {"V": "M", "M": "V"}


class FlipCrease(OnPaper, bpy.types.Operator):
    """Turn the active crease over to its other side, and hold it there"""

    bl_idname = "curvefold.flip_crease"
    bl_label = "Flip Crease"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    index: IntProperty(
        name="Crease", description="Number from 0; -1 for the active one", default=-1, min=-1, options={"SKIP_SAVE"}
    )

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        settings = paper.data.curvefold
        found = live.make_session(paper).found_sides()
        index = settings.active_crease if self.index < 0 else self.index
        if index >= len(settings.creases):
            return self.refuse("The paper has no such crease")
        crease = settings.creases[index]
        side = _OTHER.get(crease.side) or _OTHER.get(found[index])
        if crease.use_angle and crease.signed:
            # It has its side in its sign.
            crease.angle = -crease.angle
            crease.side = _OTHER.get(crease.side, "U")
        elif side is None:
            return self.refuse(f"{crease.name} is on no side yet; fold the paper first")
        else:
            crease.side = side
        handle_making.go_on(paper)
        return {"FINISHED"}


class LockSides(OnPaper, bpy.types.Operator):
    """Hold every crease to the side that it is folded to now"""

    bl_idname = "curvefold.lock_sides"
    bl_label = "Lock Sides"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        creases = paper.data.curvefold.creases
        found = live.make_session(paper).found_sides()
        if not any(letter in _OTHER for letter in found):
            return self.refuse("No crease is folded yet")
        free = []
        for crease, letter in zip(creases, found, strict=True):
            if letter in _OTHER:
                crease.side = letter
            elif crease.side not in _OTHER:
                free.append(crease.name)
        if free:
            more = f" and {len(free) - 1} more" if len(free) > 1 else ""
            self.report({"INFO"}, f"{free[0]}{more} stays free: it is flat or changes sides along its length")
        handle_making.go_on(paper)
        return {"FINISHED"}


class FreeSides(OnPaper, bpy.types.Operator):
    """Hold no crease to a side, whatever the drawing says; each stays where it is until something moves it"""

    bl_idname = "curvefold.free_sides"
    bl_label = "Free Sides"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        live.make_session(paper)
        settings = paper.data.curvefold
        settings.use_assignments = False
        for crease in settings.creases:
            crease.side = "U"
        handle_making.go_on(paper)
        return {"FINISHED"}


_CLASSES = (FlipCrease, LockSides, FreeSides)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
