"""An animation as shape keys, so that a render farm needs no solver; and back."""

from typing import ClassVar

import bpy

from .. import live
from ..bridge import baking, by_hand
from ..waiting import Waiting
from .on_paper import OnPaper


class Bake(OnPaper, bpy.types.Operator):
    """Keep the paper's shape at every frame of the scene as shape keys; then no solver is needed to play it"""

    bl_idname = "curvefold.bake"
    bl_label = "Bake to Shape Keys"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        scene, mesh = context.scene, paper.data
        if paper.mode != "OBJECT":
            return self.refuse("Leave Edit Mode before baking")
        if baking.is_baked(mesh):
            return self.refuse("The paper is baked already; free its bake first")
        if mesh.shape_keys is not None:
            return self.refuse("The paper has shape keys of its own; remove them first")
        if not mesh.curvefold.live:
            return self.refuse("The paper is not live, so there is nothing to bake")
        live.check_writable(mesh)
        live.make_session(paper)  # before anything is changed: a paper that cannot be read stays as it is
        present = scene.frame_current
        shapes = []
        frames = range(scene.frame_start, scene.frame_end + 1)
        with Waiting(context) as waiting:
            for done, frame in enumerate(frames):
                waiting.of_all(done, len(frames))
                # Every frame in its turn: the shape depends on the way.
                scene.frame_set(frame)
                shapes.append(baking.shown_positions(mesh))
        mesh.curvefold.live = False
        baking.store_keys(paper, shapes, scene.frame_start)
        scene.frame_set(present)
        return {"FINISHED"}


class FreeBake(OnPaper, bpy.types.Operator):
    """Remove the baked shape keys; the paper follows its handles again"""

    bl_idname = "curvefold.free_bake"
    bl_label = "Free Bake"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def check(self, paper: bpy.types.Object) -> None:
        """What was done to the mesh by hand does not keep its shape keys."""

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        mesh = paper.data
        if not baking.is_baked(mesh):
            return self.refuse("The paper is not baked")
        changed = by_hand.is_changed(mesh)
        baking.remove_keys(paper)
        if changed:
            self.report({"WARNING"}, live.BY_HAND)
        else:
            live.show_again(paper)
        mesh.curvefold.live = True
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(Bake)
    bpy.utils.register_class(FreeBake)


def unregister() -> None:
    bpy.utils.unregister_class(FreeBake)
    bpy.utils.unregister_class(Bake)
