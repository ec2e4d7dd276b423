"""What can be seen of papers and drawings in the viewport: ``content`` says what, ``painting`` draws it."""

import bpy

from . import content, painting, trouble_marks


def register() -> None:
    # Without a window there is nothing to draw on.
    if not bpy.app.background:
        trouble_marks.register()
        painting.register()


def unregister() -> None:
    painting.unregister()
    trouble_marks.unregister()
    content.forget()
