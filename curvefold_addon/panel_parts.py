"""What the panels of the sidebar have in common."""

from typing import ClassVar

import bpy

from . import live, wording

#: A text in the language of Blender's interface.
translated = bpy.app.translations.pgettext_iface
#: Height of a line of text among others, in lines of buttons.
LINE = 0.9


def say(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    sentence: str,
    icon: str = "NONE",
    alert: bool = False,
    inset: float = 0.0,
) -> int:
    """A sentence in as many lines as the sidebar needs, and how many these are; red when it is an ``alert``.

    inset: how much narrower than the sidebar the layout is, pixels at a scale of 1
    """
    column = layout.column(align=True)
    column.scale_y = LINE
    column.alert = alert
    width = context.region.width / context.preferences.system.ui_scale - inset
    lines = wording.lines(translated(sentence), width)
    for k, line in enumerate(lines):
        if icon == "NONE":
            column.label(text=line)
        else:
            column.label(text=line, icon=icon if k == 0 else "BLANK1")
    return len(lines)


#: How much narrower the inside of a box is, pixels at a scale of 1.
BOX_INSET = 16.0


class KeptBox:
    """A box of sentences that is as high with few lines as with many, so that nothing below it moves.

    It grows only when there is more to say than it has lines for.
    """

    def __init__(self, layout: bpy.types.UILayout, context: bpy.types.Context, lines: int) -> None:
        self._column = layout.box().column(align=True)
        self._context, self._free = context, lines

    def say(self, sentence: str, icon: str = "NONE", alert: bool = False) -> None:
        self._free -= say(self._column, self._context, sentence, icon, alert, BOX_INSET)

    def button(self, operator: str, icon: str) -> None:
        self._column.operator(operator, icon=icon)
        self._free -= 1

    def fill(self) -> None:
        """The lines that are left over."""
        column = self._column.column(align=True)
        column.scale_y = LINE
        for _ in range(self._free):
            column.label(text="")


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


def paper_settings(layout: bpy.types.UILayout, context: bpy.types.Context) -> bpy.types.PropertyGroup:
    """Those of the paper that is meant; the layout looks disabled where nobody would see what they do.

    In Edit Mode points are chosen for handles and joints, so there it does not.
    """
    mesh = live.active_paper(context).data
    layout.enabled = mesh.is_editmode or not live.why_it_does_not_fold(mesh)
    return mesh.curvefold


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
