"""What can be seen of papers and drawings in the viewport: ``content`` says what, ``painting`` draws it."""

import bpy

from . import content, drawing_watch, painting


def register() -> None:
    # Without a window there is nothing to draw on.
    if not bpy.app.background:
        drawing_watch.register()
        painting.register()


def unregister() -> None:
    painting.unregister()
    drawing_watch.unregister()
    content.forget()
