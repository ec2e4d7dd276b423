"""Blender's *Lock Interface*, which is on as long as papers of a scene follow its frames.

A film is rendered beside the window, in a thread of its own, and papers write their shapes there. Blender must not
draw them meanwhile. It reads the switch when a render is asked for, before any handler is told of it, so the switch
has to be on by then.
"""

import bpy

from . import live

#: Marks scenes where the switch was off before.
_OURS = "curvefold_locked"


def look(scene: bpy.types.Scene) -> None:
    """Sets the switch of a scene as its papers need it, and gives it back when none does any more."""
    if scene.library is not None or bpy.app.is_job_running("RENDER"):
        return
    if live.follow_frames(scene):
        if not scene.render.use_lock_interface:
            scene.render.use_lock_interface = True
            scene[_OURS] = True
    elif _OURS in scene:
        del scene[_OURS]
        scene.render.use_lock_interface = False


def look_at_all() -> None:
    """The same with every scene."""
    for scene in bpy.data.scenes:
        look(scene)
