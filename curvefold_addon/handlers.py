"""Blender's own events, passed on. None of these ever raises: it would be said on every redraw."""

import functools
import traceback
from collections.abc import Callable

import bpy
from bpy.app.handlers import persistent

from . import drawing_tool, film, interface_lock, later_work, live

_said: set[str] = set()


def _quiet(handler: Callable[..., None]) -> Callable[..., None]:
    """The handler, whose errors are printed once each instead of raised."""

    @persistent
    @functools.wraps(handler)
    def quiet(*arguments: object) -> None:
        try:
            handler(*arguments)
        except Exception as error:
            if repr(error) not in _said:
                _said.add(repr(error))
                traceback.print_exc()

    return quiet


@_quiet
def depsgraph_changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    live.notice(scene, [update.id for update in depsgraph.updates])
    interface_lock.look(scene)
    drawing_tool.look()


@_quiet
def frame_changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    film.frame_changed(scene, depsgraph)
    if depsgraph.mode != "RENDER":
        interface_lock.look(scene)


@_quiet
def playback_ended(*_: object) -> None:
    live.wake_all()


@_quiet
def undo_begins(*_: object) -> None:
    later_work.undo_begins()


@_quiet
def undone(*_: object) -> None:
    live.park()
    interface_lock.look_at_all()
    drawing_tool.look()


@_quiet
def file_closes(*_: object) -> None:
    live.forget()


@_quiet
def file_opened(*_: object) -> None:
    live.forget()
    live.wake_all()
    interface_lock.look_at_all()


@_quiet
def _enabled() -> None:
    """The file that was open when the extension was enabled: an unfinished fold in it goes on."""
    live.wake_all()
    interface_lock.look_at_all()


_HANDLERS = (
    ("depsgraph_update_post", depsgraph_changed),
    ("frame_change_post", frame_changed),
    ("animation_playback_post", playback_ended),
    ("undo_pre", undo_begins),
    ("undo_post", undone),
    ("redo_post", undone),
    ("load_pre", file_closes),
    ("load_post", file_opened),
)


def register() -> None:
    for name, handler in _HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)
    # Nothing can be asked about the file while an extension is being enabled.
    bpy.app.timers.register(_enabled, first_interval=0.0)


def unregister() -> None:
    for name, handler in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
    if bpy.app.timers.is_registered(_enabled):
        bpy.app.timers.unregister(_enabled)
    drawing_tool.forget()
    live.forget()
