"""What the operators that wait for a click on a crease have in common."""

import bpy

from ... import solver
from ..bridge import surface_points
from ..bridge.state import StateError
from ..mouse_ray import MouseRay, point_on, ray_of
from .on_paper import AwaitsClicks


class ClickOnCrease(AwaitsClicks):
    """Waits for one click. ``cursor`` and ``without_mouse`` are the operator's own."""

    what = "Creases"
    help = "Click on a crease of the paper   |   Esc or right click: leave it"

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        paper = self.waiting_paper(context)
        if paper is None or (event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"):
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"}
        ray = ray_of(context, event)
        if ray is None:
            return {"PASS_THROUGH"}
        try:
            point = crease_along(paper, ray)
            if point is None:
                self.report({"INFO"}, "There is no crease under the mouse")
                return {"RUNNING_MODAL"}
            self.clicked(paper, point)
        except (solver.CurvefoldError, StateError) as error:
            self.cancel(context)
            return self.refuse(str(error))
        self.cancel(context)
        for area in context.window.screen.areas:
            area.tag_redraw()
        return {"FINISHED"}

    def clicked(self, paper: bpy.types.Object, point: surface_points.CreasePoint) -> None:
        """What the click does. Raises CurvefoldError, StateError."""
        raise NotImplementedError


def crease_along(paper: bpy.types.Object, ray: MouseRay) -> surface_points.CreasePoint | None:
    """The point of a crease nearest to where the mouse points on a paper; None beside it. Raises StateError."""
    point = point_on(paper, ray)
    return None if point is None else surface_points.crease_nearest(paper.data, point.place)
