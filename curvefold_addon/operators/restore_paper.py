"""Back to the paper that is kept, from a mesh that was changed by hand."""

from typing import ClassVar

import bpy

from .. import handle_making, live
from ..bridge import by_hand
from ..bridge.state import StateError
from .on_paper import OnPaper


class RestorePaper(OnPaper, bpy.types.Operator):
    """Throw away what was done to the mesh by hand, so that the paper follows again"""

    bl_idname = "curvefold.restore_paper"
    bl_label = "Restore the Paper"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        if not by_hand.is_changed(live.active_paper(context).data):
            cls.poll_message_set("Its mesh was not changed by hand")
            return False
        return True

    def check(self, paper: bpy.types.Object) -> None:
        mesh = paper.data
        if mesh.is_editmode:
            raise StateError(f"{mesh.name} is in Edit Mode; leave it to restore the paper")
        if mesh.shape_keys is not None:
            raise StateError(f"{mesh.name} has shape keys, which hide how it folds; remove them")

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if live.restore(paper):
            self.report({"INFO"}, f"{paper.name} stays where it is: its object was moved, turned or scaled instead")
        handle_making.go_on(paper)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(RestorePaper)


def unregister() -> None:
    bpy.utils.unregister_class(RestorePaper)
