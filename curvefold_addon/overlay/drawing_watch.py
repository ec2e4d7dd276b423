"""What is found out about the drawings in the file, looked for when a drawing has changed and not before."""

from collections.abc import Callable
from typing import Generic, TypeVar

import bpy
from bpy.app.handlers import persistent

Found = TypeVar("Found")

_kept: list["Kept"] = []
_watching = False
#: Objects in the file when something was looked for: no update names an object that is gone.
_objects = 0


class Kept(Generic[Found]):
    """What ``find`` says of an object of a drawing, kept until a drawing changes."""

    def __init__(self, find: Callable[[bpy.types.Object], Found]) -> None:
        self._find = find
        self.found: dict[int, Found] = {}
        _kept.append(self)

    def of(self, part: bpy.types.Object) -> Found:
        global _objects
        if not _watching:
            return self._find(part)
        if len(bpy.data.objects) != _objects:
            _objects = len(bpy.data.objects)
            _forget()
        if part.session_uid not in self.found:
            self.found[part.session_uid] = self._find(part)
        return self.found[part.session_uid]


def _forget() -> None:
    for kept in _kept:
        kept.found.clear()


@persistent
def _on_depsgraph(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        thing = update.id
        if isinstance(thing, bpy.types.Object) and thing.curvefold.role != "NONE":
            _forget()
            return


@persistent
def _on_change(*_: object) -> None:
    _forget()


_HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _on_depsgraph),
    (bpy.app.handlers.undo_post, _on_change),
    (bpy.app.handlers.redo_post, _on_change),
    (bpy.app.handlers.load_post, _on_change),
)


def register() -> None:
    global _watching
    for handlers, function in _HANDLERS:
        handlers.append(function)
    _watching = True


def unregister() -> None:
    global _watching
    _watching = False
    _forget()
    for handlers, function in _HANDLERS:
        if function in handlers:
            handlers.remove(function)
