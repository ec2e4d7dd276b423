"""Tools in the toolbar of the 3D view: one places and drags handles, the other draws creases."""

import bpy


class HandleTool(bpy.types.WorkSpaceTool):
    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = "curvefold.handle_tool"
    bl_label = "Paper Handles"
    bl_description = "Click on a paper to place a handle, or press on one, and drag it"
    bl_icon = "ops.transform.push_pull"
    bl_widget = None
    bl_keymap = (
        ("curvefold.take_handle", {"type": "LEFTMOUSE", "value": "PRESS"}, None),
        (
            "transform.translate",
            {"type": "LEFTMOUSE", "value": "CLICK_DRAG"},
            {"properties": [("release_confirm", True)]},
        ),
    )


class CreaseTool(bpy.types.WorkSpaceTool):
    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = "curvefold.crease_tool"
    bl_label = "Paper Creases"
    bl_description = "Draw a crease on the sheet; Tab ends it"
    bl_icon = "ops.curve.draw"
    bl_widget = None
    bl_keymap = (("curvefold.stroke_crease", {"type": "LEFTMOUSE", "value": "PRESS"}, None),)


#: In the order of the toolbar, each with what it stands below.
_TOOLS = ((HandleTool, {"builtin.measure"}, True), (CreaseTool, {HandleTool.bl_idname}, False))


def register() -> None:
    for tool, after, separator in _TOOLS:
        bpy.utils.register_tool(tool, after=after, separator=separator)


def unregister() -> None:
    for tool, _, _ in reversed(_TOOLS):
        bpy.utils.unregister_tool(tool)
