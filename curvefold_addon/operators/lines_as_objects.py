"""Rulings and the Gauss image of a paper as it is now, as objects to keep; rulings on its faces."""

from typing import ClassVar

import bpy

from .. import kept_rulings, line_materials, live
from ..bridge import baking, line_objects
from ..waiting import busy
from .on_paper import OnPaper


class RulingsAsObject(OnPaper, bpy.types.Operator):
    """Keep the rulings of the paper as it is now: a curve object, a line a ruling, one material for each kind"""

    bl_idname = "curvefold.rulings_as_object"
    bl_label = "Rulings as Object"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    only_looks = True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if baking.is_baked(paper.data):
            return self.refuse("The paper is baked; free its bake to find its rulings")
        session = live.make_session(paper)
        with busy(context):
            made = line_objects.add_rulings(paper, session.net, session.positions, line_materials.of_rulings())
        if made is None:
            return self.refuse("The paper is plane, so it has no rulings")
        self.report({"INFO"}, f"Made {made.name}, which moves with the paper and does not bend with it")
        return {"FINISHED"}


class RulingsAsAttribute(OnPaper, bpy.types.Operator):
    """Give each face the direction of its ruling, for shaders and Geometry Nodes: the attribute "ruling", which is
    found again whenever the paper comes to rest, and at each frame of a film
    """

    bl_idname = "curvefold.rulings_as_attribute"
    bl_label = "Rulings as Attribute"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if baking.is_baked(paper.data):
            return self.refuse("The paper is baked; free its bake to find its rulings")
        if paper.mode != "OBJECT":
            return self.refuse("Leave Edit Mode before its rulings are written")
        with busy(context):
            has_some = kept_rulings.mark(paper.data, live.make_session(paper))
        plane = "" if has_some else "; it is 0 now, since the paper is plane"
        self.report({"INFO"}, f'{paper.name} has the attribute "ruling"{plane}')
        return {"FINISHED"}


class GaussImageAsObject(OnPaper, bpy.types.Operator):
    """Keep the Gauss image of the paper as it is now: a curve object beside it, one material for each patch"""

    bl_idname = "curvefold.gauss_image_as_object"
    bl_label = "Gauss Image as Object"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    only_looks = True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if baking.is_baked(paper.data):
            return self.refuse("The paper is baked; free its bake to find its Gauss image")
        session = live.make_session(paper)
        materials = line_materials.of_gauss_images()
        made = line_objects.add_gauss_image(paper, session.net, session.positions, materials)
        self.report({"INFO"}, f"Made {made.name}")
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(RulingsAsObject)
    bpy.utils.register_class(RulingsAsAttribute)
    bpy.utils.register_class(GaussImageAsObject)


def unregister() -> None:
    bpy.utils.unregister_class(GaussImageAsObject)
    bpy.utils.unregister_class(RulingsAsAttribute)
    bpy.utils.unregister_class(RulingsAsObject)
