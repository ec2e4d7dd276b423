"""Choosing a crease by clicking on it."""

from typing import ClassVar

import bpy

from .. import live
from ..bridge.surface_points import CreasePoint
from .click_on_crease import ClickOnCrease


class PickCrease(ClickOnCrease, bpy.types.Operator):
    """Click on a crease of the paper to make it the active one"""

    bl_idname = "curvefold.pick_crease"
    bl_label = "Pick Crease"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    cursor = "EYEDROPPER"
    without_mouse = "Creases are picked with the mouse; choose one in the list instead"

    def clicked(self, paper: bpy.types.Object, point: CreasePoint) -> None:
        live.make_session(paper)
        paper.data.curvefold.active_crease = point.crease


def register() -> None:
    bpy.utils.register_class(PickCrease)


def unregister() -> None:
    bpy.utils.unregister_class(PickCrease)
