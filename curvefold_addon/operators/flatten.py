"""Back to the flat sheet."""

from typing import ClassVar

import bpy

from .. import handle_making, live
from .on_paper import OnPaper


class Flatten(OnPaper, bpy.types.Operator):
    """Lay the paper flat and its handles with it, and set the fold to zero"""

    bl_idname = "curvefold.flatten"
    bl_label = "Flatten"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    folds = True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        live.make_session(paper)  # before anything is changed: a paper that cannot be read stays as it is
        handle_making.lay_flat(paper)
        live.flatten(paper)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(Flatten)


def unregister() -> None:
    bpy.utils.unregister_class(Flatten)
