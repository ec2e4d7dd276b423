"""Waits until a paper rests."""

from typing import ClassVar

import bpy

from .. import live
from ..waiting import Waiting
from .on_paper import OnPaper


class Settle(OnPaper, bpy.types.Operator):
    """Fold until the paper rests, and wait for it"""

    bl_idname = "curvefold.settle"
    bl_label = "Settle"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    folds = True

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        with Waiting(context) as waiting:
            live.settle(paper.data, progress=waiting.iterations)
        facts = live.report(paper.data)
        self.report({"WARNING"} if facts.state == "trouble" else {"INFO"}, facts.sentence)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(Settle)


def unregister() -> None:
    bpy.utils.unregister_class(Settle)
