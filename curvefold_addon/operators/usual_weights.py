"""The solver's own weights again."""

from typing import ClassVar

import bpy

from .. import handle_making
from .on_paper import OnPaper


class UsualWeights(OnPaper, bpy.types.Operator):
    """Set all weights back to their usual values"""

    bl_idname = "curvefold.usual_weights"
    bl_label = "Usual Weights"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        weights = paper.data.curvefold.weights
        for entry in weights.bl_rna.properties:
            if not entry.is_readonly:
                weights.property_unset(entry.identifier)
        handle_making.go_on(paper)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(UsualWeights)


def unregister() -> None:
    bpy.utils.unregister_class(UsualWeights)
