"""Add > Paper Sample."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty

from ... import solver
from .. import later_work, samples, wording
from ..drawing_context import in_object_mode
from .import_drawing import add_at_cursor

#: Pictures below each other in the menu, and their size in lines of text.
ROWS = 4
PICTURE = 5.0
#: The same of the buttons with small pictures in the tab.
SMALL_PICTURE = 2.0
_ITEMS = [(name, samples.label(name), f"The drawing {samples.label(name)}") for name in samples.names()]


class AddSample(bpy.types.Operator):
    """Add a sample drawing as a sheet with creases"""

    bl_idname = "curvefold.add_sample"
    bl_label = "Paper Sample"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    sample: EnumProperty(name="Sample", items=_ITEMS)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return in_object_mode(cls, context)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            pattern = solver.read_pattern(samples.drawing(self.sample))
        except solver.CurvefoldError as error:
            self.report({"ERROR"}, wording.readable(str(error)))
            return {"CANCELLED"}
        add_at_cursor(context, [[pattern]])
        return {"FINISHED"}


class SampleMenu(bpy.types.Menu):
    """Sample drawings with pictures of what they fold to"""

    bl_idname = "CURVEFOLD_MT_samples"
    bl_label = "Paper Sample"

    def draw(self, context: bpy.types.Context) -> None:
        names = samples.names()
        row = self.layout.row()
        # Column by column: in a menu, cells below each other are the only ones that line up.
        for start in range(0, len(names), ROWS):
            column = row.column()
            for name in names[start : start + ROWS]:
                column.template_icon(icon_value=samples.icon(name), scale=PICTURE)
                column.operator(AddSample.bl_idname, text=samples.label(name)).sample = name


def draw_buttons(layout: bpy.types.UILayout) -> None:
    """A button for each sample, beside its picture."""
    for name in samples.names():
        row = layout.row(align=True)
        row.template_icon(icon_value=samples.icon(name), scale=SMALL_PICTURE)
        button = row.column()
        button.scale_y = SMALL_PICTURE
        button.operator(AddSample.bl_idname, text=samples.label(name)).sample = name


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.menu(SampleMenu.bl_idname, icon="IMAGE_DATA")


def register() -> None:
    bpy.utils.register_class(AddSample)
    bpy.utils.register_class(SampleMenu)
    bpy.types.VIEW3D_MT_add.append(_menu_entry)


def unregister() -> None:
    bpy.types.VIEW3D_MT_add.remove(_menu_entry)
    bpy.utils.unregister_class(SampleMenu)
    bpy.utils.unregister_class(AddSample)
    samples.forget()
