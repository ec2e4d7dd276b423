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


def why_not_changeable(*things: Any, name: str = "") -> str:
    """Why datablocks cannot be changed for good, a sentence about the first that cannot; empty when all can.

    name: what the user calls it; without one, its own.
    """
    for thing in things:
        if not is_local(thing):
            library = thing.library or thing.override_library.reference.library
            file = bpy.path.basename(library.filepath)
            return f"{name or thing.name} is linked from {file}; make it local to change it"
    return ""
