"""What is linked from another .blend, where changes do not last."""

from __future__ import annotations

from typing import Any

import bpy


def is_local(thing: Any) -> bool:
    """Whether what is changed in a datablock is saved with this file.

    Of a library override only what its library allows to be overridden is saved, which neither geometry nor the
    settings of papers and creases are.
    """
    return thing.library is None and thing.override_library is None


def why_not_changeable(name: str, *things: Any) -> str:
    """Why one of ``things`` cannot be changed for good, a sentence; empty when all can. name: what it is about."""
    for thing in things:
        if not is_local(thing):
            library = thing.library or thing.override_library.reference.library
            return f"{name} is linked from {bpy.path.basename(library.filepath)}; make it local to change it"
    return ""


def why_not_this(item: Any) -> str:
    """Why an object, with its data, cannot be changed for good, a sentence; empty when it can."""
    return why_not_changeable(item.name, item, *([] if item.data is None else [item.data]))


def homes_beside(item: Any) -> list[Any]:
    """The collections for a new object that belongs to ``item``: its own, without those that cannot be changed."""
    homes = [collection for collection in item.users_collection if is_local(collection)]
    return homes or [new_home()]


def new_home() -> Any:
    """The collection for a new object: the active one; where that cannot be changed, the scene's."""
    active = bpy.context.collection
    return active if active is not None and is_local(active) else bpy.context.scene.collection
