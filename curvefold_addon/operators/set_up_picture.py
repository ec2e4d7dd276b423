"""A picture of a paper in one click, and back."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from .. import later_work, picture, scene
from ..bridge.papers import is_paper
from ..waiting import Waiting
from .on_paper import OnPaper

ENGINES = (
    ("CYCLES", "Cycles", "Traces the light: soft shadows, light that shines through the paper"),
    ("EEVEE", "EEVEE", "Quick, with a graphics card"),
)


class SetUpPicture(OnPaper, bpy.types.Operator):
    """Light the selected papers, put a floor under them, and frame them with a camera in all frames of their film.
    What else is there is not rendered meanwhile, except what is selected; Remove Picture brings it back
    """

    bl_idname = "curvefold.set_up_picture"
    bl_label = "Set Up Picture"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    only_looks = True

    engine: EnumProperty(name="Engine", items=ENGINES, default="CYCLES")
    samples: IntProperty(
        name="Samples", description="Samples for each pixel; more take longer", default=32, min=1, max=4096
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Of the paper, in the scene's units; at zero it is a surface",
        subtype="DISTANCE",
        default=0.0,
        min=0.0,
        soft_max=0.01,
        precision=5,
    )

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if paper.mode != "OBJECT":
            return self.refuse("Leave Edit Mode before the picture is set up")
        papers = papers_meant(context, paper)
        for item in papers:
            picture.thicken(item, self.thickness)
        with Waiting(context) as waiting:
            picture.set_up(
                context.scene, papers, context.selected_objects, self.engine, self.samples, waiting.of_all
            )
        self.report({"INFO"}, "F12 renders the picture; Remove Picture gives the scene back")
        return {"FINISHED"}


class RemovePicture(bpy.types.Operator):
    """Remove the light, floor and camera of the picture, and give the scene back what it had before"""

    bl_idname = "curvefold.remove_picture"
    bl_label = "Remove Picture"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if scene.find_home(context.scene) is None:
            cls.poll_message_set("No picture is set up in this scene")
            return False
        return True

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        papers = [item for item in context.scene.objects if is_paper(item)]
        picture.remove(context.scene, papers)
        return {"FINISHED"}


def papers_meant(context: bpy.types.Context, paper: bpy.types.Object) -> list[bpy.types.Object]:
    """The paper that is meant, and other papers that are selected."""
    return [paper, *(item for item in context.selected_objects if is_paper(item) and item != paper)]


def register() -> None:
    bpy.utils.register_class(SetUpPicture)
    bpy.utils.register_class(RemovePicture)


def unregister() -> None:
    bpy.utils.unregister_class(RemovePicture)
    bpy.utils.unregister_class(SetUpPicture)
