"""The operator that ticks: it starts when a paper has something to do and ends when all rest.

It must not run all the time: a running modal operator keeps Blender from saving automatically.
"""

import gc
import sys
import time
from typing import ClassVar

import bpy

from .. import live, preferences

#: Between two ticks, seconds: the view is drawn in between.
INTERVAL = 1 / 60

#: A view that takes longer than this from one tick to the next, seconds, is drawn so slowly that waiting would only
#: make it slower: the solver has had that time already.
SLOW = 0.05
#: Then a tick waits for this part of its budget.
SLOW_PART = 0.25

#: Seconds after which the solver's thread hands Python on when Blender asks for it. Python's own 5 ms are paid at
#: every handler and every button that is drawn while papers move.
HAND_ON = 0.001

#: Seconds in which a timer of a hundredth comes for certain, once Blender looks at events again.
SWEEP = 0.05

#: Seconds until it is looked again whether a picture is finished.
AFTER_RENDER = 0.5

_running = False
#: What Python had before.
_switch_interval = 0.0
_timer: bpy.types.Timer | None = None
#: Whether no dead handler of this operator can be left in the window; the timer that sees to it.
_swept = False
_broom: bpy.types.Timer | None = None


class Follow(bpy.types.Operator):
    """Let papers follow their handles until they rest"""

    bl_idname = "curvefold.follow"
    bl_label = "Follow Handles"
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    _ended = 0.0

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        global _running, _switch_interval, _timer
        if _running:
            return {"CANCELLED"}
        _timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        # A collection of all that Blender and its extensions hold takes up to 0.2 s, and building a net brings
        # one about. While papers move, only what is made meanwhile is looked through.
        gc.freeze()
        _switch_interval = sys.getswitchinterval()
        sys.setswitchinterval(HAND_ON)
        _running = True
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        # Timers of other operators arrive too: the clock says when a tick is due.
        pause = time.monotonic() - self._ended
        if event.type != "TIMER" or pause < 0.5 * INTERVAL:
            return {"PASS_THROUGH"}
        if bpy.app.is_job_running("RENDER"):
            return {"PASS_THROUGH"}
        transforming = is_transforming(context.window_manager)
        budget = preferences.budget_seconds()
        more = live.tick(budget if pause < SLOW else SLOW_PART * budget, transforming)
        self._ended = time.monotonic()
        if more or transforming:
            return {"PASS_THROUGH"}
        self.cancel(context)
        return {"FINISHED", "PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        stop(context.window_manager)


def stop(manager: bpy.types.WindowManager) -> None:
    """Leaves nothing of the running operator behind."""
    global _running, _timer
    if _running:
        gc.unfreeze()
        sys.setswitchinterval(_switch_interval)
    _running = False
    if _timer is not None:
        manager.event_timer_remove(_timer)
        _timer = None


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


def _begin() -> float | None:
    manager = bpy.context.window_manager
    if not live.is_at_work() or _running or not len(manager.windows):
        return None
    if bpy.app.is_job_running("RENDER"):
        return AFTER_RENDER
    # A timer has no window of its own.
    window = manager.windows[0]
    if not _is_swept(manager, window):
        return SWEEP
    with bpy.context.temp_override(window=window):
        bpy.ops.curvefold.follow("INVOKE_DEFAULT")
    return None


def _is_swept(manager: bpy.types.WindowManager, window: bpy.types.Window) -> bool:
    """Whether an operator can be added to the window's; if not, an event is sent to make it so.

    Where this one was running when the extension was disabled, Blender keeps a dead handler until the next event
    and crashes (4.3.2) when another is added before.
    """
    global _swept, _broom
    if not _swept and _broom is None:
        _broom = manager.event_timer_add(0.01, window=window)
        return False
    _sweep_away(manager)
    _swept = True
    return True


def _sweep_away(manager: bpy.types.WindowManager) -> None:
    global _broom
    if _broom is not None:
        manager.event_timer_remove(_broom)
        _broom = None


def register() -> None:
    bpy.utils.register_class(Follow)
    live.on_start(start)


def unregister() -> None:
    global _swept
    _swept = False
    live.on_start(None)
    if bpy.app.timers.is_registered(_begin):
        bpy.app.timers.unregister(_begin)
    # Blender drops a running operator whose class goes away, and does not tell it.
    for manager in bpy.data.window_managers:
        stop(manager)
        _sweep_away(manager)
    bpy.utils.unregister_class(Follow)
