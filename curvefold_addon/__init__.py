"""The Blender layer of Curvefold: thin, and without numpy outside ``bridge``."""

# Imported inside the functions: ``python -m curvefold_addon`` loads this package before any extension.


def register() -> None:
    for module in _modules():
        module.register()


def unregister() -> None:
    for module in reversed(_modules()):
        module.unregister()


def _modules():
    from . import (
        cli,
        context_menu,
        drop_drawing,
        handlers,
        keymaps,
        operators,
        overlay,
        panels,
        preferences,
        properties,
        tools,
        translations,
    )

    return (
        translations,
        properties,
        preferences,
        operators,
        drop_drawing,
        cli,
        handlers,
        overlay,
        panels,
        context_menu,
        tools,
        keymaps,
    )
