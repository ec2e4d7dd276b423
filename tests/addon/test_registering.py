"""Switching the extension off and on again."""

import addon_utils
import bpy

TYPES = (bpy.types.Object, bpy.types.Mesh, bpy.types.Scene)
MENUS = ("VIEW3D_MT_object_context_menu", "VIEW3D_MT_add", "VIEW3D_MT_object", "TOPBAR_MT_file_import")


def test_everything_is_there(extension):
    assert hasattr(bpy.types, "CURVEFOLD_OT_fold_drawing")
    assert extension("curvefold_addon.cli")._command is not None


def test_off_and_on_again(extension):
    package = extension("solver").__package__.rpartition(".")[0]
    for _ in range(2):
        addon_utils.disable(package, default_set=True)
        assert not hasattr(bpy.types, "CURVEFOLD_OT_fold_drawing")
        assert addon_utils.enable(package, default_set=True) is not None
        assert hasattr(bpy.types, "CURVEFOLD_OT_fold_drawing")


def left_behind(package):
    """What an extension may leave in Blender: classes, menu entries, handlers, keys, tools, types' properties."""
    from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active

    kinds = (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu, bpy.types.UIList, bpy.types.PropertyGroup)
    registered = [
        cls.__name__
        for kind in (*kinds, bpy.types.AddonPreferences)
        for cls in kind.__subclasses__()
        if cls.__module__.startswith(package) and cls.is_registered
    ]
    functions = [
        function for name in MENUS for function in getattr(getattr(bpy.types, name).draw, "_draw_funcs", ())
    ] + [
        function
        for name in dir(bpy.app.handlers)
        if isinstance(getattr(bpy.app.handlers, name), list)
        for function in getattr(bpy.app.handlers, name)
    ]
    keys = [
        item.idname
        for config in (bpy.context.window_manager.keyconfigs.addon, bpy.context.window_manager.keyconfigs.default)
        for keymap in config.keymaps
        for item in keymap.keymap_items
        if item.idname.startswith("curvefold.")
    ]
    tools = [tool.idname for tool in _tools(VIEW3D_PT_tools_active._tools["OBJECT"])]
    return (
        registered,
        [function.__module__ for function in functions if function.__module__.startswith(package)],
        keys,
        [name for name in tools if name.startswith("curvefold.")],
        [
            kind.__name__
            for kind in (bpy.types.Object, bpy.types.Mesh, bpy.types.Scene)
            if hasattr(kind, "curvefold")
        ],
        # Of the interface's own languages a module has none.
        bpy.app.translations.pgettext_iface("Fold Anew"),
    )


def _tools(group):
    for tool in group:
        if isinstance(tool, (list, tuple)) and not hasattr(tool, "idname"):
            yield from _tools(tool)
        elif hasattr(tool, "idname"):
            yield tool


def test_switched_off_it_leaves_nothing_behind(extension):
    package = extension("solver").__package__.rpartition(".")[0]
    found = left_behind(package)
    assert all(found), "everything is looked at"
    assert set(found[3]) == {"curvefold.handle_tool", "curvefold.crease_tool"}
    addon_utils.disable(package, default_set=True)
    try:
        assert left_behind(package) == ([], [], [], [], [], "Fold Anew")
    finally:
        addon_utils.enable(package, default_set=True)
    assert left_behind(package) == found
