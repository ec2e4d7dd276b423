"""What the panels of the sidebar have in common."""

from typing import ClassVar

import bpy

from . import live, wording


def say(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    sentence: str,
    icon: str = "NONE",
    alert: bool = False,
) -> None:
    """A sentence in as many lines as the sidebar needs; red when it is an ``alert``."""
    column = layout.column(align=True)
    column.scale_y = 0.9
    column.alert = alert
    width = context.region.width / context.preferences.system.ui_scale
    for k, line in enumerate(wording.lines(sentence, width)):
        if icon == "NONE":
            column.label(text=line)
        else:
            column.label(text=line, icon=icon if k == 0 else "BLANK1")


class Tab:
    """A panel of the sidebar tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Curvefold"


class PaperPanel(Tab):
    """A closed panel about the paper that is meant."""

    bl_parent_id = "CURVEFOLD_PT_main"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return live.active_paper(context) is not None


def switched_row(layout: bpy.types.UILayout, entry: bpy.types.PropertyGroup) -> bpy.types.UILayout:
    """A row of a list for what can be switched off: the switch, and room for the rest, grey when it is off."""
    row = layout.row(align=True)
    row.prop(entry, "enabled", text="")
    row = row.row(align=True)
    row.active = entry.enabled
    return row


def settings_column(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """A column of settings with their names beside them."""
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column
