"""The extension's preferences."""

import bpy
from bpy.props import IntProperty

from ..solver.optimize.kernel import linear_algebra
from . import keymaps

#: The package of the whole extension.
EXTENSION = __package__.rpartition(".")[0]

DEFAULT_BUDGET_MS = 20


class CurvefoldPreferences(bpy.types.AddonPreferences):
    """How Curvefold works on this computer."""

    bl_idname = EXTENSION

    budget: IntProperty(
        name="Time per Tick",
        description="Milliseconds that a paper may hold up the view each time it moves; "
        "longer is faster folding, shorter a smoother view",
        default=DEFAULT_BUDGET_MS,
        min=5,
        max=200,
    )

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "budget")
        self.layout.label(text=f"Linear algebra: {linear_algebra().phrase}")
        self.layout.label(text="Keys in Object Mode")
        keymaps.draw(self.layout, context)


def budget_seconds() -> float:
    """How long a tick may take."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return (DEFAULT_BUDGET_MS if addon is None else addon.preferences.budget) / 1000.0


def register() -> None:
    bpy.utils.register_class(CurvefoldPreferences)


def unregister() -> None:
    bpy.utils.unregister_class(CurvefoldPreferences)
