"""The right-click menu of the 3D view: what can be done next with the paper, sheet or crease that is active."""

import bpy

from . import drawing_context, live
from .bridge import drawing_objects


def _entries(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    active = context.active_object
    if active is None:
        return
    layout = menu.layout
    if drawing_objects.is_part(active):
        _begin(layout)
        _draw_drawing(layout, context)
    elif live.active_paper(context) is not None:
        _begin(layout)
        _draw_paper(layout, live.active_paper(context))


def _begin(layout: bpy.types.UILayout) -> None:
    layout.separator()
    layout.operator_context = "INVOKE_DEFAULT"
    layout.label(text="Curvefold")


def _draw_drawing(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    layout.operator("curvefold.draw_crease", icon="GREASEPENCIL")
    layout.operator_menu_enum("curvefold.set_assignment", "assignment", text="Selected Creases Fold to")
    sheet = drawing_context.active_sheet(context)
    if sheet is not None and live.papers_on(sheet):
        layout.operator("curvefold.back_to_paper", icon="LOOP_BACK")
    else:
        layout.operator("curvefold.make_paper", icon="MOD_CLOTH")


def _draw_paper(layout: bpy.types.UILayout, paper: bpy.types.Object) -> None:
    layout.operator("curvefold.place_handle", icon="CURSOR")
    layout.operator("curvefold.flatten", icon="MESH_PLANE")
    layout.operator("curvefold.fold_anew", icon="FILE_REFRESH")
    layout.operator("curvefold.edit_drawing", icon="EDITMODE_HLT")
    sheet = live.sheet_here(paper.data.curvefold)
    if sheet is not None:
        layout.prop(sheet.curvefold, "show")
    layout.operator("curvefold.check_paper", icon="VIEWZOOM")


def register() -> None:
    bpy.types.VIEW3D_MT_object_context_menu.append(_entries)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object_context_menu.remove(_entries)
