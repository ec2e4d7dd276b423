"""Fold angles at single points of creases: clicked, or at vertices chosen in Edit Mode; and their removal."""

from collections.abc import Sequence
from math import radians
from typing import ClassVar

import bpy
from bpy.props import IntProperty

from .. import handle_making, live
from ..bridge import overlay, surface_points
from ..bridge.state import StateError
from .add_handles import leave_edit_mode
from .click_on_crease import ClickOnCrease
from .on_paper import OnPaper, remove_entry

_NO_ROOM = "The net is too coarse there to hold an angle; raise the paper's resolution"


class PlaceAngle(ClickOnCrease, bpy.types.Operator):
    """Click on a crease to give it a fold angle at that point"""

    bl_idname = "curvefold.place_angle"
    bl_label = "Place Angle"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    cursor = "CROSSHAIR"
    without_mouse = "Angles are placed with the mouse; use At Vertices in Edit Mode instead"

    def clicked(self, paper: bpy.types.Object, point: surface_points.CreasePoint) -> None:
        if not _ask(paper, [point.at]):
            raise StateError(_NO_ROOM)
        handle_making.go_on(paper)


class AddAngles(OnPaper, bpy.types.Operator):
    """Give creases a fold angle at each of their vertices that is selected in Edit Mode"""

    bl_idname = "curvefold.add_angles"
    bl_label = "Add Angles"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    selects = "Select vertices on creases of the paper in Edit Mode"

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        points = surface_points.selected_on_creases(paper.data)
        if not points:
            return self.refuse(self.selects)
        leave_edit_mode(paper)
        if not _ask(paper, points):
            return self.refuse(_NO_ROOM)
        handle_making.go_on(paper)
        return {"FINISHED"}


class RemoveAngle(OnPaper, bpy.types.Operator):
    """Remove the active angle"""

    bl_idname = "curvefold.remove_angle"
    bl_label = "Remove Angle"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    index: IntProperty(
        name="Angle", description="Number from 0; -1 for the active one", default=-1, min=-1, options={"SKIP_SAVE"}
    )

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if not remove_entry(paper, "angles", "active_angle", self.index):
            return self.refuse("The paper has no such angle")
        handle_making.go_on(paper)
        return {"FINISHED"}


def _ask(paper: bpy.types.Object, places: Sequence[surface_points.Point]) -> bool:
    """Angles at these places of the flat sheet, of which the last becomes active; whether there is room for any.

    They begin as they are, on an unfolded crease at the usual angle. What has one already keeps it.
    """
    found = live.make_session(paper)
    settings = paper.data.curvefold
    known = {overlay.nearest_angle(found.net, angle.at): k for k, angle in enumerate(settings.angles)}
    wanted = {point: at for at in places if (point := overlay.nearest_angle(found.net, at)) is not None}
    for point, at in wanted.items():
        if point not in known:
            known[point] = len(settings.angles)
            _add(settings.angles, at, overlay.angle_at(found.net, found.positions, at))
        settings.active_angle = known[point]
    return bool(wanted)


def _add(angles: bpy.types.bpy_prop_collection, at: surface_points.Point, degrees: float | None) -> None:
    taken = {angle.name for angle in angles}
    number = next(n for n in range(1, len(taken) + 2) if f"Angle {n}" not in taken)
    angle = angles.add()
    angle.name, angle.at = f"Angle {number}", at
    if degrees is not None and degrees >= overlay.FOLDED_FROM:
        angle.angle = radians(degrees)


_CLASSES = (PlaceAngle, AddAngles, RemoveAngle)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
