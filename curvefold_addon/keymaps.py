"""Keys in Object Mode, which the preferences of the extension list and let change."""

import bpy
import rna_keymap_ui

KEYMAP = "Object Mode"
#: Operators and their keys, all with Ctrl and Alt: none that Blender uses.
KEYS = (
    ("curvefold.place_handle", "H"),
    ("curvefold.draw_crease", "K"),
    ("curvefold.edit_drawing", "E"),
)

_added: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def draw(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The keys as the user has them, to be changed."""
    config = context.window_manager.keyconfigs.user
    keymap = config.keymaps.get(KEYMAP)
    if keymap is None:
        return
    column = layout.column()
    names = [name for name, _ in KEYS]
    for item in keymap.keymap_items:
        if item.idname in names:
            column.context_pointer_set("keymap", keymap)
            rna_keymap_ui.draw_kmi([], config, keymap, item, column, 0)


def register() -> None:
    config = bpy.context.window_manager.keyconfigs.addon
    if config is None:
        return
    keymap = config.keymaps.new(name=KEYMAP, space_type="EMPTY")
    for operator, key in KEYS:
        _added.append((keymap, keymap.keymap_items.new(operator, key, "PRESS", ctrl=True, alt=True)))


def unregister() -> None:
    while _added:
        keymap, item = _added.pop()
        keymap.keymap_items.remove(item)
