"""From the flat sheet in another way."""

from typing import ClassVar

import bpy

from .. import live
from .on_paper import OnPaper


class FoldAnew(OnPaper, bpy.types.Operator):
    """Start from the flat sheet again and fold along all creases before the handles pull: a way out when stuck"""

    bl_idname = "curvefold.fold_anew"
    bl_label = "Fold Anew"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    folds = True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if not live.fold_anew(paper):
            return self.refuse("Nothing pulls at this paper: move a handle or the slider first")
        if bpy.app.background:
            live.settle(paper.data)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(FoldAnew)


def unregister() -> None:
    bpy.utils.unregister_class(FoldAnew)
