"""What is seen at the pointer while an operator holds Blender up."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Self

import bpy

#: Iterations after which a fold whose end nobody knows is shown as half done.
HALF = 100


class Waiting:
    """Shows a number at the pointer: how far something has come, as a part of 1."""

    def __init__(self, context: bpy.types.Context) -> None:
        self._manager = context.window_manager

    def __enter__(self) -> Self:
        self._manager.progress_begin(0.0, 1.0)
        return self

    def __exit__(self, *_: object) -> None:
        self._manager.progress_end()

    def of_all(self, done: int, number: int) -> None:
        """So many are done of a number that is known."""
        self._manager.progress_update(done / number)

    def iterations(self, done: int, *_: object) -> None:
        """So many iterations are done, of as many as it takes."""
        self._manager.progress_update(done / (done + HALF))


@contextmanager
def busy(context: bpy.types.Context) -> Iterator[None]:
    """Shows that Blender is at work, where nobody can say how far it is."""
    window = context.window
    if window is None:
        yield
        return
    window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        window.cursor_modal_restore()
