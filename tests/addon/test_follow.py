"""The operator that ticks: it begins when there is something to do, ends when there is not, and cleans up."""

import gc
from contextlib import nullcontext
from types import SimpleNamespace

import bpy
import pytest

TIMER = SimpleNamespace(type="TIMER")


@pytest.fixture
def follow(extension):
    return extension("curvefold_addon.operators.follow")


class Manager(SimpleNamespace):
    """As much of the window manager as the operator asks for."""

    def __init__(self):
        self.timers, self.modal, self.held = [], 0, []
        super().__init__(windows=[SimpleNamespace(modal_operators=self.held)])

    def event_timer_add(self, step, window):
        self.timers.append(step)
        return step

    def event_timer_remove(self, timer):
        self.timers.remove(timer)

    def modal_handler_add(self, operator):
        self.modal += 1


@pytest.fixture
def running(follow, live, monkeypatch):
    """The operator in mid-run without an event loop: (send an event, its manager, what ticks there were)."""
    manager, ticks = Manager(), []
    context = SimpleNamespace(window_manager=manager, window=None)
    cls = follow.Follow
    operator = SimpleNamespace(_ended=0.0)
    operator.cancel = lambda c: cls.cancel(operator, c)
    monkeypatch.setattr(follow, "_running", False)
    monkeypatch.setattr(follow, "_timer", None)
    # Every event comes when a tick is due.
    monkeypatch.setattr(follow.time, "monotonic", (0.02 * k for k in range(1, 10_000)).__next__)
    more = [True]

    def tick(budget, transforming):
        ticks.append((budget, transforming))
        return more[0]

    monkeypatch.setattr(live, "tick", tick)
    assert cls.invoke(operator, context, None) == {"RUNNING_MODAL"}
    send = SimpleNamespace(
        event=lambda event: cls.modal(operator, context, event),
        cancel=lambda: cls.cancel(operator, context),
        invoke=lambda: cls.invoke(operator, context, None),
    )
    yield send, manager, ticks, more
    gc.unfreeze()


def test_ticks_while_there_is_more_and_ends_when_all_rest(running, follow):
    send, manager, ticks, more = running
    assert (manager.timers, manager.modal, follow._running) == ([follow.INTERVAL], 1, True)
    for _ in range(3):
        assert send.event(TIMER) == {"PASS_THROUGH"}
    assert ticks == [(0.02, False)] * 3, "the preference's 20 milliseconds"
    more[0] = False
    assert send.event(TIMER) == {"FINISHED", "PASS_THROUGH"}
    assert (manager.timers, follow._running) == ([], False)


def test_only_while_it_runs_the_collector_leaves_alone_what_was_there_before(running, follow):
    send, _, _, more = running
    assert gc.get_freeze_count() > 10_000, "all that Blender's Python holds"
    more[0] = False
    send.event(TIMER)
    assert gc.get_freeze_count() == 0
    gc.freeze()  # somebody else's, and not to be undone
    follow.stop(Manager())
    assert gc.get_freeze_count() > 0


def test_lets_all_other_events_pass_unread(running):
    send, _, ticks, _ = running
    for kind in ("ESC", "LEFTMOUSE", "MOUSEMOVE", "Z"):
        assert send.event(SimpleNamespace(type=kind)) == {"PASS_THROUGH"}
    assert not ticks


def test_goes_on_while_the_hand_holds_something(running):
    send, manager, ticks, more = running
    more[0] = False
    manager.held.append(SimpleNamespace(bl_idname="TRANSFORM_OT_translate"))
    assert send.event(TIMER) == {"PASS_THROUGH"}
    assert ticks == [(0.02, True)]
    manager.held[0].bl_idname = "VIEW3D_OT_rotate"
    assert send.event(TIMER) == {"FINISHED", "PASS_THROUGH"}


def test_timers_of_others_make_no_extra_ticks(running, follow, monkeypatch):
    send, _, ticks, _ = running
    send.event(TIMER)
    monkeypatch.setattr(follow.time, "monotonic", lambda: 0.04)  # the moment in which that tick has ended
    for _ in range(5):
        assert send.event(TIMER) == {"PASS_THROUGH"}
    assert len(ticks) == 1


def test_where_drawing_takes_long_it_waits_less_for_the_solver(running, follow, monkeypatch):
    send, _, ticks, _ = running
    send.event(TIMER)
    monkeypatch.setattr(follow.time, "monotonic", (0.04 + 0.06 * k for k in range(1, 10)).__next__)
    send.event(TIMER)
    assert ticks == [(0.02, False), (0.005, False)]


def test_waits_for_a_render(running, monkeypatch, follow):
    send, _, ticks, _ = running
    app = SimpleNamespace(is_job_running=lambda kind: kind == "RENDER")
    monkeypatch.setattr(follow, "bpy", SimpleNamespace(app=app))
    assert send.event(TIMER) == {"PASS_THROUGH"}
    assert not ticks


def test_one_is_enough(running):
    send, manager, _, _ = running
    assert send.invoke() == {"CANCELLED"}
    assert manager.modal == 1


def test_cancelled_from_outside_it_leaves_no_timer_and_can_begin_again(running, follow):
    send, manager, _, _ = running
    send.cancel()
    assert (manager.timers, follow._running) == ([], False)
    assert send.invoke() == {"RUNNING_MODAL"}


def test_disabled_in_mid_run_it_leaves_no_timer_and_can_begin_again(running, follow, monkeypatch):
    send, manager, _, _ = running
    app = SimpleNamespace(
        app=bpy.app, utils=bpy.utils, data=SimpleNamespace(window_managers=[manager]), types=bpy.types, ops=bpy.ops
    )
    monkeypatch.setattr(follow, "bpy", app)
    follow.unregister()
    follow.register()
    assert (manager.timers, follow._running) == ([], False)
    assert send.invoke() == {"RUNNING_MODAL"}


def test_begins_by_a_timer_only_once(follow, monkeypatch):
    monkeypatch.setattr(follow, "_running", False)
    follow.start()
    follow.start()
    assert bpy.app.timers.is_registered(follow._begin)
    bpy.app.timers.unregister(follow._begin)
    monkeypatch.setattr(follow, "_running", True)
    follow.start()
    assert not bpy.app.timers.is_registered(follow._begin)


def test_the_first_beginning_waits_for_an_event_that_sweeps_out_dead_handlers(follow, live, monkeypatch):
    manager, begun = Manager(), []
    context = SimpleNamespace(window_manager=manager, temp_override=lambda window: nullcontext())
    operators = SimpleNamespace(curvefold=SimpleNamespace(follow=begun.append))
    renders = [True]
    app = SimpleNamespace(is_job_running=lambda kind: kind == "RENDER" and renders[0])
    monkeypatch.setattr(follow, "bpy", SimpleNamespace(context=context, ops=operators, app=app))
    monkeypatch.setattr(live, "is_at_work", lambda: True)
    for name, value in (("_running", False), ("_swept", False), ("_broom", None)):
        monkeypatch.setattr(follow, name, value)
    assert follow._begin() == follow.AFTER_RENDER, "a picture is made first"
    assert (manager.timers, begun) == ([], [])
    renders[0] = False
    assert follow._begin() == follow.SWEEP, "comes again"
    assert (len(manager.timers), begun) == (1, [])
    assert follow._begin() is None
    assert (manager.timers, begun) == ([], ["INVOKE_DEFAULT"])
    assert follow._begin() is None
    assert (manager.timers, len(begun)) == ([], 2), "once is enough"


def test_without_a_window_nothing_is_started(paper, follow):
    paper.data.curvefold.fold = 20.0
    assert not bpy.app.timers.is_registered(follow._begin)


def test_the_budget_is_a_preference(extension):
    preferences = extension("curvefold_addon.preferences")
    addon = bpy.context.preferences.addons[preferences.EXTENSION]
    assert preferences.budget_seconds() == 0.02
    addon.preferences.budget = 35
    try:
        assert preferences.budget_seconds() == pytest.approx(0.035)
    finally:
        addon.preferences.property_unset("budget")
