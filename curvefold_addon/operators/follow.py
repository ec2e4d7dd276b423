"""The operator that ticks: it starts when a paper has something to do and ends when all rest.

It must not run all the time: a running modal operator keeps Blender from saving automatically.
"""

import time
from typing import ClassVar

import bpy

from .. import live, preferences

#: Between two ticks, seconds: the view is drawn in between.
INTERVAL = 1 / 60

_running = False


class Follow(bpy.types.Operator):
    """Let papers follow their handles until they rest"""

    bl_idname = "curvefold.follow"
    bl_label = "Follow Handles"
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    _timer = None
    _ended = 0.0

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        global _running
        if _running:
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        _running = True
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        # Timers of other operators arrive too: the clock says when a tick is due.
        if event.type != "TIMER" or time.monotonic() - self._ended < 0.5 * INTERVAL:
            return {"PASS_THROUGH"}
        if bpy.app.is_job_running("RENDER"):
            return {"PASS_THROUGH"}
        transforming = is_transforming(context.window_manager)
        more = live.tick(preferences.budget_seconds(), transforming)
        self._ended = time.monotonic()
        if more or transforming:
            return {"PASS_THROUGH"}
        self.cancel(context)
        return {"FINISHED", "PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        global _running
        _running = False
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None


def is_transforming(manager: bpy.types.WindowManager) -> bool:
    """Whether the user is moving, turning or scaling something with the mouse."""
    return any(
        operator.bl_idname.startswith("TRANSFORM_OT")
        for window in manager.windows
        for operator in window.modal_operators
    )


def start() -> None:
    """Begins to tick soon, unless it does already. Operators cannot be called from where changes are noticed."""
    if not _running and not bpy.app.timers.is_registered(_begin):
        bpy.app.timers.register(_begin, first_interval=0.0)


def _begin() -> None:
    windows = bpy.context.window_manager.windows
    if live.is_at_work() and not _running and len(windows):
        # A timer has no window of its own.
        with bpy.context.temp_override(window=windows[0]):
            bpy.ops.curvefold.follow("INVOKE_DEFAULT")


def register() -> None:
    bpy.utils.register_class(Follow)
    live.on_start(start)


def unregister() -> None:
    live.on_start(None)
    if bpy.app.timers.is_registered(_begin):
        bpy.app.timers.unregister(_begin)
    bpy.utils.unregister_class(Follow)
