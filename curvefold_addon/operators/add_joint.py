"""Joints: two points, two borders, or a patch, chosen in Edit Mode; and their removal."""

from math import dist
from typing import ClassVar

import bpy
from bpy.props import EnumProperty, IntProperty

from .. import handle_making, live
from ..bridge import surface_points
from ..control_properties import RELATIONS, SHAPES
from .add_handles import leave_edit_mode, selected_points
from .on_paper import OnPaper, remove_entry

_TWO_POINTS = "Select two vertices of the paper in Edit Mode, or two of its handles"
_NAMES = {"POINTS": "Points", "BORDERS": "Seam", "PATCH": "Patch"}


class JoinPoints(OnPaper, bpy.types.Operator):
    """Draw two points of the paper together: two vertices selected in Edit Mode, or two selected handles"""

    bl_idname = "curvefold.join_points"
    bl_label = "Join Two Points"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    relation: EnumProperty(name="They", items=RELATIONS, default="MEET")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        paper = live.active_paper(context)
        if paper.mode != "EDIT" and len(_points_of_hooks(context, paper)) != 2:
            cls.poll_message_set(_TWO_POINTS)
            return False
        return True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        points = [point.at for point in selected_points(paper)] or _points_of_hooks(context, paper)
        if len(points) != 2:
            return self.refuse(_TWO_POINTS)
        _leave_edit_mode(paper)
        found = live.make_session(paper)
        places = [found.place_of(point) for point in points]
        joint = _add(paper, "POINTS")
        joint.first, joint.second = points
        joint.relation = self.relation
        joint.distance = dist(*places)
        handle_making.go_on(paper)
        return {"FINISHED"}


class GlueBorders(OnPaper, bpy.types.Operator):
    """Glue two stretches of the border, whose vertices are selected in Edit Mode, to each other"""

    bl_idname = "curvefold.glue_borders"
    bl_label = "Glue Borders"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    selects = "Select the vertices of two stretches of the border in Edit Mode"

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        borders = surface_points.selected_borders(paper.data)
        if len(borders) != 2:
            return self.refuse(self.selects)
        leave_edit_mode(paper)
        live.make_session(paper)
        joint = _add(paper, "BORDERS")
        (a, b), (c, d) = borders
        joint.first, joint.second = a, b
        # The ends that are nearer to each other meet: an untwisted band.
        joint.third, joint.fourth = (c, d) if dist(a, c) + dist(b, d) <= dist(a, d) + dist(b, c) else (d, c)
        handle_making.go_on(paper)
        return {"FINISHED"}


class KeepPatch(OnPaper, bpy.types.Operator):
    """Keep patches, of which faces are selected in Edit Mode, flat or as they are"""

    bl_idname = "curvefold.keep_patch"
    bl_label = "Keep Patch"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    selects = "Select a face of the patch in Edit Mode"

    shape: EnumProperty(name="Keep", items=SHAPES, default="FLAT")

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        points = surface_points.selected_patches(paper.data)
        if not points:
            return self.refuse(self.selects)
        leave_edit_mode(paper)
        live.make_session(paper)
        for point in points:
            joint = _add(paper, "PATCH")
            joint.first = point
            joint.shape = self.shape
        handle_making.go_on(paper)
        return {"FINISHED"}


class RemoveJoint(OnPaper, bpy.types.Operator):
    """Remove the active joint"""

    bl_idname = "curvefold.remove_joint"
    bl_label = "Remove Joint"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    index: IntProperty(
        name="Joint", description="Number from 0; -1 for the active one", default=-1, min=-1, options={"SKIP_SAVE"}
    )

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if not remove_entry(paper, "joints", "active_joint", self.index):
            return self.refuse("The paper has no such joint")
        handle_making.go_on(paper)
        return {"FINISHED"}


def _points_of_hooks(context: bpy.types.Context, paper: bpy.types.Object) -> list[tuple[float, ...]]:
    """Points of the handles whose hooks are selected."""
    chosen = set(context.selected_objects)
    return [tuple(handle.at) for handle in paper.data.curvefold.handles if handle.hook in chosen]


def _leave_edit_mode(paper: bpy.types.Object) -> None:
    if paper.mode == "EDIT":
        leave_edit_mode(paper)


def _add(paper: bpy.types.Object, family: str) -> bpy.types.PropertyGroup:
    """A new joint, which becomes the active one."""
    settings = paper.data.curvefold
    taken = {joint.name for joint in settings.joints}
    word = _NAMES[family]
    number = next(n for n in range(1, len(taken) + 2) if f"{word} {n}" not in taken)
    joint = settings.joints.add()
    joint.name, joint.family = f"{word} {number}", family
    settings.active_joint = len(settings.joints) - 1
    return joint


_CLASSES = (JoinPoints, GlueBorders, KeepPatch, RemoveJoint)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
