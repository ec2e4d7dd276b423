"""Films of a paper in one click: round it, and of its folding."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty

from .. import picture, scene
from ..bridge import baking, linked
from ..waiting import Waiting
from .on_paper import OnPaper
from .set_up_picture import papers_meant

KINDS = (
    ("TURNTABLE", "Turntable", "Camera and light of the picture go once round the paper"),
    ("FOLDING", "Folding", "The paper folds from flat to what its Fold slider shows, and stays there for a while"),
)
#: The folding has ended after this part of the film.
FOLDED_AFTER = 0.8
#: What a paper is folded to whose slider is at zero, per cent.
FULL = 100.0


class AnimatePicture(OnPaper, bpy.types.Operator):
    """Animate the paper's picture over the frames of the scene"""

    bl_idname = "curvefold.animate_picture"
    bl_label = "Animate Picture"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    only_looks = True

    kind: EnumProperty(name="Film", items=KINDS, default="TURNTABLE")

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        target = context.scene
        if target.frame_end <= target.frame_start:
            return self.refuse("The scene has one frame only; give it more")
        papers = papers_meant(context, paper)
        if self.kind == "FOLDING":
            why_not = _why_not_folding(paper)
            if why_not:
                return self.refuse(why_not)
            _fold(target, paper)
        elif scene.find_home(target) is None and bpy.ops.curvefold.set_up_picture() != {"FINISHED"}:
            return {"CANCELLED"}
        with Waiting(context) as waiting:
            if self.kind == "TURNTABLE":
                picture.turn_round(target, papers, waiting.of_all)
            else:
                picture.reframe(target, papers, waiting.of_all)
        return {"FINISHED"}


def _why_not_folding(paper: bpy.types.Object) -> str:
    mesh = paper.data
    reason = linked.why_not_changeable(paper.name, mesh)
    if reason:
        return reason
    if baking.is_baked(mesh) or not mesh.curvefold.live:
        return "The paper does not follow its slider: free its bake, or switch Live on"
    if not mesh.curvefold.creases:
        return "The paper has no creases that could fold"
    if mesh.animation_data is not None and any(
        curve.data_path == "curvefold.fold" for curve in baking.curves_of(mesh)
    ):
        return "Its Fold slider is animated already; clear those keyframes first"
    return ""


def _fold(target: bpy.types.Scene, paper: bpy.types.Object) -> None:
    mesh = paper.data
    fold = mesh.curvefold.fold or FULL
    folded = target.frame_start + max(1, round(FOLDED_AFTER * (target.frame_end - target.frame_start)))
    for frame, value in ((target.frame_start, 0.0), (folded, fold)):
        mesh.curvefold.fold = value
        mesh.keyframe_insert("curvefold.fold", frame=frame)
    target.frame_set(target.frame_current)


def register() -> None:
    bpy.utils.register_class(AnimatePicture)


def unregister() -> None:
    bpy.utils.unregister_class(AnimatePicture)
