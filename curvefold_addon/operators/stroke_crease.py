"""What a stroke of the mouse does with the toolbar's tool for creases."""

from typing import ClassVar

import bpy

from .draw_crease import DrawCrease


class StrokeCrease(bpy.types.Operator):
    """Begin a new crease on the sheet with the stroke that is drawn; Tab ends it"""

    bl_idname = "curvefold.stroke_crease"
    bl_label = "Stroke Crease"
    # Beginning a crease and drawing it have undo steps of their own.
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return DrawCrease.poll.__func__(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.ops.curvefold.draw_crease("EXEC_DEFAULT", True) != {"FINISHED"}:
            return {"CANCELLED"}
        bpy.ops.curve.draw("INVOKE_DEFAULT", wait_for_input=False)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(StrokeCrease)


def unregister() -> None:
    bpy.utils.unregister_class(StrokeCrease)
