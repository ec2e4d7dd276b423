"""A handle at a point that is named, and its empty: what a click of Place Handles does."""

from typing import ClassVar

import bpy
from bpy.props import FloatVectorProperty, StringProperty

from .. import drawing_tool, handle_making, live
from ..bridge.papers import is_paper
from ..bridge.state import StateError
from ..bridge.surface_points import SurfacePoint
from ..drawing_context import select_only
from .on_paper import OnPaper


class AddHandle(OnPaper, bpy.types.Operator):
    """Add a handle at a point of the flat sheet, and an empty to drag it by"""

    bl_idname = "curvefold.add_handle"
    bl_label = "Add Handle"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    at: FloatVectorProperty(
        name="Point", description="On the flat sheet", size=2, subtype="XYZ", unit="LENGTH", options={"SKIP_SAVE"}
    )
    paper: StringProperty(
        name="Paper", description="Which paper; the active one when empty", options={"HIDDEN", "SKIP_SAVE"}
    )

    def meant(self, context: bpy.types.Context) -> bpy.types.Object | None:
        return context.scene.objects.get(self.paper) if self.paper else super().meant(context)

    def check(self, paper: bpy.types.Object | None) -> None:
        if paper is None or not is_paper(paper):
            raise StateError(f"There is no paper {self.paper}")
        super().check(paper)

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        drawing_tool.leave_edit_mode(context)
        at = tuple(self.at)
        point = SurfacePoint(at, live.make_session(paper).place_of(at))
        handle = handle_making.add_handle(paper, point)
        empty = handle_making.new_empty(paper, handle.offset.copy(), handle.name)
        handle_making.hook_to(handle, paper, empty)
        select_only(context, empty)
        handle_making.go_on(paper)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(AddHandle)


def unregister() -> None:
    bpy.utils.unregister_class(AddHandle)
