"""Curvefold, a Blender extension that folds paper along curves.

Nothing is imported at module level: the test runner reads this file too, and has no Blender.
"""


def register() -> None:
    from . import curvefold_addon

    curvefold_addon.register()


def unregister() -> None:
    from . import curvefold_addon

    curvefold_addon.unregister()
