"""The resolution as a property of papers, and of the operators that make some."""

from collections.abc import Callable
from typing import Any

from bpy.props import IntProperty

from ..solver.description import AUTO, RESOLUTIONS
from .bridge.state import AUTOMATIC


def resolution_property(soft_max: int, update: Callable[..., None] | None = None) -> Any:
    """Quads along the longer side, 0 for automatic."""
    return IntProperty(
        name="Resolution",
        description="Quads along the longer side of the sheet; 0 is automatic: as many as the drawing needs",
        default=AUTOMATIC,
        min=AUTOMATIC,
        soft_max=soft_max,
        max=RESOLUTIONS[1],
        update=update,
    )


def told(resolution: int) -> int | str:
    """The same as fold descriptions say it."""
    return AUTO if resolution == AUTOMATIC else max(RESOLUTIONS[0], resolution)
