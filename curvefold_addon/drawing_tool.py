"""The tool with which a new crease is drawn: it is on loan in Edit Mode, and goes back when the drawing has ended.

Blender keeps a tool for every mode, in the workspace, and what is noted here lies beside it. The tool of a mode can
only be set in that mode, so the former one comes back when Edit Mode is entered again.
"""

import bpy

from .bridge import drawing_objects

#: Blender's name of the tool that draws a curve freehand.
DRAW_TOOL = "builtin.draw"
#: The tool with which Blender begins in every mode.
USUAL_TOOL = "builtin.select_box"
#: Blender's name of Edit Mode for curves.
MODE = "EDIT_CURVE"

#: Custom properties of a workspace: the crease that is drawn, by name; the tool that Edit Mode had before.
DRAWN, FORMER = "curvefold_drawn", "curvefold_former_tool"


def begin(context: bpy.types.Context, crease: bpy.types.Object) -> None:
    """Edit Mode with the tool that draws, for the active object, a new crease."""
    bpy.ops.object.mode_set(mode="EDIT")
    workspace = context.workspace
    if FORMER not in workspace:
        workspace[FORMER] = _present(workspace) or USUAL_TOOL
    workspace[DRAWN] = crease.name
    bpy.ops.wm.tool_set_by_id(name=DRAW_TOOL, space_type="VIEW_3D")


def leave_edit_mode(context: bpy.types.Context) -> None:
    """Object Mode; a crease that was being drawn is finished."""
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
        _finish(context.workspace)


def look() -> None:
    """Something has changed: sees to it that what has to be done now is done, when operators can be called."""
    waiting = any(_ended(window) or _is_due(window) for window in _windows())
    if waiting and not bpy.app.timers.is_registered(take_turns):
        bpy.app.timers.register(take_turns, first_interval=0.0)


def take_turns() -> None:
    """Finishes creases of which Edit Mode was left, and gives the former tool back where it was entered again."""
    for window in _windows():
        if _ended(window):
            _finish(window.workspace)
        elif _is_due(window):
            _give_back(window)


def forget() -> None:
    """Nothing is done any more."""
    if bpy.app.timers.is_registered(take_turns):
        bpy.app.timers.unregister(take_turns)


def _windows() -> list[bpy.types.Window]:
    return [window for manager in bpy.data.window_managers for window in manager.windows]


def _is_editing(window: bpy.types.Window) -> bool:
    active = window.view_layer.objects.active
    return active is not None and active.type == "CURVE" and active.mode == "EDIT"


def _ended(window: bpy.types.Window) -> bool:
    """Whether a crease was drawn in this window and is no longer."""
    return DRAWN in window.workspace and not _is_editing(window)


def _is_due(window: bpy.types.Window) -> bool:
    """Whether the former tool has to come back now."""
    return FORMER in window.workspace and DRAWN not in window.workspace and _is_editing(window)


def _finish(workspace: bpy.types.WorkSpace) -> None:
    if DRAWN not in workspace:
        return
    crease = bpy.data.objects.get(workspace[DRAWN])
    del workspace[DRAWN]
    if crease is not None and crease.type == "CURVE" and drawing_objects.is_crease(crease):
        drawing_objects.drop_dots(crease.data)
        drawing_objects.make_thin(crease.data)


def _give_back(window: bpy.types.Window) -> None:
    workspace = window.workspace
    area = next((area for area in window.screen.areas if area.type == "VIEW_3D"), None)
    if area is None:
        return
    former = workspace[FORMER]
    del workspace[FORMER]
    if _present(workspace) == DRAW_TOOL:  # otherwise another one was chosen meanwhile
        with bpy.context.temp_override(window=window, area=area):
            bpy.ops.wm.tool_set_by_id(name=former, space_type="VIEW_3D")


def _present(workspace: bpy.types.WorkSpace) -> str:
    """The tool of Edit Mode; empty when it never had one."""
    tool = workspace.tools.from_space_view3d_mode(MODE, create=False)
    return "" if tool is None else tool.idname
