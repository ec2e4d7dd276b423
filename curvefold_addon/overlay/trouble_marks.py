"""What is wrong with the drawings in the file."""

import bpy

from ..bridge import drawing
from .drawing_watch import Kept

_troubles = Kept(lambda sheet: drawing.troubles(sheet))


def of_sheet(sheet: bpy.types.Object) -> tuple[drawing.Trouble, ...]:
    """The troubles of a sheet's drawing."""
    return _troubles.of(sheet)
