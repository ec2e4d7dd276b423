"""What the operators that wait for a click on a crease have in common."""

import bpy
from bpy_extras import view3d_utils
from mathutils import Vector

from ... import solver
from .. import drawing_tool, live
from ..bridge import surface_points
from ..bridge.state import StateError
from .on_paper import OnPaper
from .place_handle import view_under

HELP = "Click on a crease of the paper   |   Esc or right click: leave it"


class ClickOnCrease(OnPaper):
    """Waits for one click. ``cursor`` and ``without_mouse``, what to do instead, are the operator's own."""

    cursor: str
    without_mouse: str

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if context.area is None or context.area.type != "VIEW_3D":
            return self.refuse("Creases are clicked in a 3D view")
        drawing_tool.leave_edit_mode(context)
        paper = live.active_paper(context)
        try:
            live.check_follows(paper.data)
        except StateError as error:
            return self.refuse(str(error))
        self._paper = paper.name
        context.window.cursor_modal_set(self.cursor)
        context.workspace.status_text_set(HELP)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self.refuse(self.without_mouse)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        paper = context.scene.objects.get(self._paper)
        if paper is None or (event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"):
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"}
        region, view = view_under(context, event)
        if region is None:
            return {"PASS_THROUGH"}
        mouse = (event.mouse_x - region.x, event.mouse_y - region.y)
        origin = view3d_utils.region_2d_to_origin_3d(region, view, mouse)
        direction = view3d_utils.region_2d_to_vector_3d(region, view, mouse)
        try:
            point = crease_along(paper, origin, direction)
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

    def cancel(self, context: bpy.types.Context) -> None:
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)

    def clicked(self, paper: bpy.types.Object, point: surface_points.CreasePoint) -> None:
        """What the click does. Raises CurvefoldError, StateError."""
        raise NotImplementedError


def crease_along(paper: bpy.types.Object, origin: Vector, direction: Vector) -> surface_points.CreasePoint | None:
    """The point of a crease nearest to where a ray of the world first meets the paper; None when it misses."""
    to_local = paper.matrix_world.inverted_safe()
    return surface_points.crease_under_ray(paper.data, to_local @ origin, to_local.to_3x3() @ direction)
