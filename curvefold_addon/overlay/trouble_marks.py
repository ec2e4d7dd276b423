"""What is wrong with the drawings in the file, looked for when a drawing has changed and not before."""

import bpy
from bpy.app.handlers import persistent

from ..bridge import drawing

_found: dict[int, tuple[drawing.Trouble, ...]] = {}
_watching = False
#: Objects in the file when troubles were looked for: no update names an object that is gone.
_objects = 0


def of_sheet(sheet: bpy.types.Object) -> tuple[drawing.Trouble, ...]:
    """The troubles of a sheet's drawing."""
    global _objects
    if not _watching:
        return drawing.troubles(sheet)
    if len(bpy.data.objects) != _objects:
        _objects = len(bpy.data.objects)
        _found.clear()
    if sheet.session_uid not in _found:
        _found[sheet.session_uid] = drawing.troubles(sheet)
    return _found[sheet.session_uid]


@persistent
def _on_depsgraph(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        thing = update.id
        if isinstance(thing, bpy.types.Object) and thing.curvefold.role != "NONE":
            _found.clear()
            return


@persistent
def _on_change(*_: object) -> None:
    _found.clear()


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
    _found.clear()
    for handlers, function in _HANDLERS:
        if function in handlers:
            handlers.remove(function)
