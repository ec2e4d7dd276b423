"""Papers that follow their handles: which of them have something to do, and doing it for a while.

What a paper is lies in its datablocks (``properties``, ``bridge.state``); a session only works on it, and is
made again whenever it is missing. Nothing here needs a window: ``tick`` is called by the operator that follows,
``settle`` by whoever wants to wait.
"""

import time
import traceback
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import bpy

from .. import solver
from . import kept_rulings
from .bridge import baking, by_hand, controls, drawing, hooks, linked, papers, placing, state
from .bridge.drawing_objects import creases_of, is_part, sheet_of
from .bridge.report import CreaseReport, Report, describe, describe_crease, describe_fault
from .bridge.session import Session, carried_session, stored_session
from .bridge.session import stop as stop_thread
from .bridge.turns import pool

__all__ = ["CreaseReport", "Report", "rebuild", "report", "session", "settle", "wake"]

#: A drawing is folded anew when nobody has changed it for so long, seconds.
DRAWING_RESTS = 0.25
#: Iterations after which a fold that is waited for is left as it is.
SETTLING = 1500
#: Of a fold that is waited for it is said after every so many iterations how far it is.
SAID_EVERY = 10
#: Scales whose difference is a smaller part of them are the same: their rounding.
SAME_SCALE = 1e-5
#: What is said of a paper that does not follow, since following would write over what somebody did to its mesh.
BY_HAND = "Its mesh was changed by hand: Restore the Paper throws that away, Make Ordinary Mesh keeps it"


@dataclass
class _Watch:
    """Who moves whom in a scene, by ``session_uid``. Objects are kept by name: references die on undo.

    papers: mesh -> object that shows it; movers: object or mesh -> papers that follow it; drawings: part of a
    drawing -> papers that are folded from it; objects: how many the scene has.
    """

    objects: int
    papers: dict[int, str] = field(default_factory=dict)
    movers: dict[int, set[int]] = field(default_factory=dict)
    drawings: dict[int, set[int]] = field(default_factory=dict)


_sessions: dict[int, Session] = {}
#: Sessions whose datablocks may have changed under them; they keep nets and models.
_parked: dict[int, Session] = {}
#: Sessions that are being made in the thread.
_making: dict[int, Future[Session]] = {}
#: Papers that may have something to do.
_awake: set[int] = set()
#: Papers that may have been told something since they were last read.
_unread: set[int] = set()
#: When each paper was last shown in a tick, on the clock of ticks.
_shown: dict[int, float] = {}
#: Papers whose drawing or resolution may have changed, and when.
_stale: dict[int, float] = {}
#: Why a paper cannot be folded as it is now.
_faults: dict[int, str] = {}
#: What went wrong with a paper that is not its user's fault; each is printed once.
_broken: dict[int, str] = {}
#: What is known of each scene, by its ``session_uid``.
_watches: dict[int, _Watch] = {}
_start_ticking: Callable[[], None] | None = None


# --- what operators, panels and properties call ------------------------------------------------------------------


def wake(mesh: bpy.types.Mesh) -> None:
    """A value has changed: the paper follows."""
    if mesh.curvefold.is_paper:
        _look_again()
        _broken.pop(mesh.session_uid, None)
        _rouse({mesh.session_uid})


def rebuild(mesh: bpy.types.Mesh) -> None:
    """The drawing or the resolution has changed: the net is made again and takes over the shape."""
    if mesh.curvefold.is_paper:
        _stale[mesh.session_uid] = time.monotonic()
        wake(mesh)


def rehook(mesh: bpy.types.Mesh, handle: bpy.types.PropertyGroup) -> None:
    """A handle has another hook, or none: its point is held where it is."""
    if not linked.is_local(mesh):
        return
    handle.pinned = handle.hook is None
    paper = paper_of(mesh)
    if paper is None:
        return
    try:
        place = make_session(paper).place_of(tuple(handle.at))
    except (solver.CurvefoldError, state.StateError):
        return  # the report says that the handle is off the sheet, or the paper cannot be folded
    if handle.hook is not None:
        place = hooks.offset_in(handle.hook, paper, _evaluated(_scene_of(mesh)), place)
    handle.offset = place


def settle(
    mesh: bpy.types.Mesh, max_iterations: int = SETTLING, progress: Callable[[int], None] | None = None
) -> None:
    """Folds until the paper rests. Blocking. Raises CurvefoldError or StateError when it cannot be folded.

    progress(iterations) is called every few iterations.
    """
    paper = paper_of(mesh)
    if paper is None:
        return
    check_writable(mesh)
    uid = mesh.session_uid
    found = make_session(paper)
    _note_scale(paper)
    _stale.pop(uid, None)
    wanted = _wanted_source(mesh)
    if not found.source.meets(wanted):
        found.write(mesh)  # marks that somebody took away: they tell what users' layers belong to
        found = carried_session(wanted, found.snapshot())
        adopt(paper, found)
    _faults.pop(uid, None)
    inputs = _inputs(paper, found)
    for done in range(0, max_iterations, SAID_EVERY):
        found.advance(inputs, min(SAID_EVERY, max_iterations - done))
        if found.rest is not None:
            break
        if progress is not None:
            progress(done + SAID_EVERY)
    found.write(mesh)
    kept_rulings.keep(mesh, found)
    found.before = None
    _awake.discard(uid)


def why_it_stays(mesh: bpy.types.Mesh) -> str:
    """Why a paper follows nothing that it is told, a sentence: it is linked, or was changed by hand; else empty."""
    if not linked.is_local(mesh):
        paper = paper_of(mesh)
        return linked.why_not_changeable(mesh.name if paper is None else paper.name, mesh)
    return BY_HAND if by_hand.is_changed(mesh) else ""


def check_follows(mesh: bpy.types.Mesh) -> None:
    """Before a paper is told anything. Raises StateError."""
    reason = why_it_stays(mesh)
    if reason:
        raise state.StateError(reason)


def why_it_does_not_fold(mesh: bpy.types.Mesh) -> str:
    """Why nothing that a paper is told now can be seen, a sentence; else empty.

    Nothing that is written to a mesh in Edit Mode, of whatever object that shows it, lasts, and shape keys hide it;
    what was changed by hand would be lost.
    """
    if reason := why_it_stays(mesh):
        return reason
    if mesh.is_editmode:
        return f"{mesh.name} is in Edit Mode; leave it to fold the paper"
    if baking.is_baked(mesh):
        return f"{mesh.name} is baked; free the bake to fold the paper"
    if mesh.shape_keys is not None:
        return f"{mesh.name} has shape keys, which hide how it folds; remove them"
    return ""


def check_writable(mesh: bpy.types.Mesh) -> None:
    """Before a paper is folded at once. Raises StateError."""
    reason = why_it_does_not_fold(mesh)
    if reason:
        raise state.StateError(reason)


def report(mesh: bpy.types.Mesh) -> Report | None:
    """Facts about the paper from its session; None when it has none. Never triggers work."""
    uid = mesh.session_uid
    fault = why_it_stays(mesh) or _faults.get(uid) or _broken.get(uid, "")
    found = _sessions.get(uid) or _parked.get(uid)
    if found is None:
        return describe_fault(fault) if fault else None
    folding = uid in _awake and mesh.curvefold.live
    return describe(found, mesh.curvefold, fault, folding, bpy.context.scene.unit_settings)


def crease_report(mesh: bpy.types.Mesh, index: int) -> CreaseReport | None:
    """Facts about one crease; None when the paper has no session. Never triggers work."""
    found = _sessions.get(mesh.session_uid) or _parked.get(mesh.session_uid)
    return None if found is None else describe_crease(found, index)


def session(mesh: bpy.types.Mesh) -> Session | None:
    """The paper's session; None when it has none."""
    return _sessions.get(mesh.session_uid)


def make_session(paper: bpy.types.Object) -> Session:
    """The paper's session, made now when it is missing. Raises CurvefoldError, StateError."""
    mesh = paper.data
    uid = mesh.session_uid
    _making.pop(uid, None)
    if uid not in _sessions:
        shape = state.load(mesh)
        _take(paper, _unparked(uid, shape) or stored_session(shape))
    return _sessions[uid]


def adopt(paper: bpy.types.Object, made: Session) -> None:
    """A paper has a new session, and its mesh shows it; a flat one that is asked to be flat rests."""
    papers.show(paper.data, made)
    _sessions[paper.data.session_uid] = made
    controls.match_creases(paper.data.curvefold, made.drawn)
    _look_again()
    made.rest_if_flat(_inputs(paper, made))
    made.write(paper.data)
    _follow_scale(paper)


def flatten(paper: bpy.types.Object) -> None:
    """Lays a paper flat at once; it rests when it is asked to be flat. Raises CurvefoldError, StateError."""
    found = make_session(paper)
    found.lay_flat()
    found.rest_if_flat(_inputs(paper, found))
    found.write(paper.data)
    found.before = None
    wake(paper.data)


def fold_anew(paper: bpy.types.Object) -> bool:
    """Folds a paper from flat in another way, towards what it is told now; whether it is told anything.

    Raises CurvefoldError, StateError.
    """
    found = make_session(paper)
    inputs = _inputs(paper, found)
    if not inputs.pulls:
        return False
    found.fold_anew()
    found.write(paper.data)
    found.before = None
    wake(paper.data)
    return True


def show_again(paper: bpy.types.Object) -> None:
    """The mesh shows what is kept of the paper, whatever it has shown in between.

    Raises CurvefoldError, StateError.
    """
    papers.restore(paper.data, make_session(paper))


def restore(paper: bpy.types.Object) -> bool:
    """The mesh shows what is kept of the paper again, whatever somebody has done to it by hand.

    Where all of it was moved, turned or scaled as one, its objects get that instead, so that it stays where it is;
    whether that was so. Raises CurvefoldError, StateError.
    """
    mesh = paper.data
    found = make_session(paper)
    matrix = by_hand.moved_as_one(mesh, found.net.render_map.apply(found.positions))
    kept = matrix is not None and by_hand.move_objects(mesh, matrix, bpy.data.objects)
    show_again(paper)
    wake(mesh)
    return kept


def keep_shape(paper: bpy.types.Object) -> Callable[[], None]:
    """Keeps in mind how a paper is now; what is returned puts it there again, after frames of a film were shown."""
    mesh = paper.data
    if not _may_move(paper) or not hooks.is_animated(paper):
        return lambda: None
    try:
        found = make_session(paper)
    except (solver.CurvefoldError, state.StateError):
        return lambda: None  # it does not follow the film either
    put_back = found.keep_shape()

    def back() -> None:
        put_back()
        found.write(mesh)
        found.before = None

    return back


def drop(mesh: bpy.types.Mesh) -> None:
    """A mesh is no paper any more: nothing is left of what was known about it."""
    uid = mesh.session_uid
    for known in (_sessions, _parked, _making, _stale, _shown, _faults, _broken):
        known.pop(uid, None)
    kept_rulings.drop(uid)
    for asleep in (_awake, _unread):
        asleep.discard(uid)
    _look_again()


def sheet_here(settings: bpy.types.PropertyGroup) -> bpy.types.Object | None:
    """The sheet of a paper; None where it has none, and where that is not in the scene."""
    sheet = settings.sheet
    return None if sheet is None or sheet.name not in _scene_of(settings.id_data).objects else sheet


def paper_of(mesh: bpy.types.Mesh) -> bpy.types.Object | None:
    """The object that shows a paper, in the present scene if there is one: where hooks are, is seen from it."""
    return _paper(mesh.session_uid, _scenes())


def active_paper(context: bpy.types.Context) -> bpy.types.Object | None:
    """The paper that the user means: the active object, the one that it pulls, or the first by name that follows it
    when it is a sheet or a crease; where nothing is active, the only one of the scene.
    """
    active = context.active_object
    watch = _watched(context.scene)
    if active is None:
        return _paper(next(iter(watch.papers)), [context.scene]) if len(watch.papers) == 1 else None
    if papers.is_paper(active):
        return active
    if is_part(active) and (following := papers_on(sheet_of(active))):
        return following[0]
    followers = sorted(watch.movers.get(active.session_uid, ()))
    return next((_paper(uid, [context.scene]) for uid in followers), None)


def papers_on(sheet: bpy.types.Object | None) -> list[bpy.types.Object]:
    """The papers of the scene that follow a sheet's drawing, by name."""
    if sheet is None:
        return []
    scene = bpy.context.scene
    found = [_paper(uid, [scene]) for uid in tuple(_watched(scene).drawings.get(sheet.session_uid, ()))]
    return sorted((paper for paper in found if paper is not None), key=lambda paper: paper.name)


def is_playing() -> bool:
    """Whether an animation is played in some window."""
    return any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)


def is_at_work() -> bool:
    """Whether some paper may have something to do."""
    return bool(_awake)


# --- what handlers and the following operator call ---------------------------------------------------------------


def notice(scene: bpy.types.Scene, changed: Iterable[bpy.types.ID]) -> None:
    """Datablocks have changed as a scene shows them: wakes its papers that follow them."""
    watch = _watched(scene)
    roused = set()
    if watch.objects != len(scene.objects):
        # Something was added or removed: a hook, perhaps.
        _look_again()
        watch = _watched(scene)
        roused.update(watch.papers)
    for datablock in changed:
        uid = datablock.original.session_uid
        roused.update(watch.movers.get(uid, ()))
        for paper in watch.drawings.get(uid, ()):
            _stale[paper] = time.monotonic()
            roused.add(paper)
    _rouse(roused)


def tick(budget: float, transforming: bool = False) -> bool:
    """Follows for ``budget`` seconds; whether there is more to do. Never raises.

    Papers are told first, the thread has the time that is left, and then they show what it has found. Where that
    takes longer than the budget, those that were not shown go first the next time, after the active one.

    transforming: whether the user holds something in the hand.
    """
    begin = time.perf_counter()
    deadline = begin + budget
    waiting = _in_order()
    told: list[_Told] = []
    half = begin + 0.5 * budget
    for place, uid in enumerate(waiting):
        if place and time.perf_counter() > half:
            break
        if paper := _guarded(uid, partial(_tell, uid, place == 0, deadline, transforming)):
            told.append(paper)
    for paper in told:
        _guarded(paper.uid, partial(paper.session.wait, deadline if len(told) == 1 else half))
    for place, paper in enumerate(told):
        if place and time.perf_counter() > deadline:
            break
        _shown[paper.uid] = begin
        _guarded(paper.uid, partial(_show, paper, transforming))
    return bool(_awake)


def animated_papers(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> list[bpy.types.Object]:
    """The papers of a scene that follow its frames, as far as the evaluated scene has them."""
    found = [_paper(uid, [scene]) for uid in list(_watched(scene).papers)]
    return [
        paper
        for paper in found
        if paper is not None
        and _may_move(paper)
        and hooks.is_animated(paper)
        and paper.evaluated_get(depsgraph).is_evaluated
    ]


def follow_frames(scene: bpy.types.Scene) -> bool:
    """Whether some paper of a scene follows its frames."""
    found = [_paper(uid, [scene]) for uid in list(_watched(scene).papers)]
    return any(
        paper is not None
        and paper.data.curvefold.live
        and paper.data.shape_keys is None
        and linked.is_local(paper.data)
        and hooks.is_animated(paper)
        for paper in found
    )


def read_inputs(
    paper: bpy.types.Object, found: Session, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> hooks.Inputs:
    """What a paper is told in an evaluated scene."""
    return hooks.read(paper, scene, depsgraph, found.net.frame.unit, found.why_not_at, found.drawn)


def note_fault(mesh: bpy.types.Mesh, fault: str) -> None:
    """Why a paper cannot be folded as it is now."""
    _faults[mesh.session_uid] = fault


def park() -> None:
    """Undo and redo have changed datablocks under the sessions: they look again before they go on."""
    _parked.update(_sessions)
    _sessions.clear()
    _making.clear()
    kept_rulings.forget()
    _stale.clear()
    _faults.clear()
    _broken.clear()
    _look_again()
    _awake.clear()
    for uid in _shown_papers():
        paper = _paper(uid, _shown_scenes())
        if paper is not None:
            paper.update_tag()  # Blender does not see that its scale was changed after the step was written
    _rouse(_shown_papers())


def forget() -> None:
    """Another file: nothing of the old one is left."""
    _sessions.clear()
    _parked.clear()
    _making.clear()
    kept_rulings.forget()
    _stale.clear()
    _faults.clear()
    _broken.clear()
    _awake.clear()
    _unread.clear()
    _shown.clear()
    _look_again()
    stop_thread()


def wake_all() -> None:
    """Every live paper looks whether it has something to do."""
    _rouse(_shown_papers())


def on_start(start: Callable[[], None] | None) -> None:
    """Who sees to it that ticks come when a paper has something to do."""
    global _start_ticking
    _start_ticking = start


# --- inside ------------------------------------------------------------------------------------------------------


def _rouse(papers: set[int]) -> None:
    _awake.update(papers)
    _unread.update(papers)
    # Without a window nothing ticks.
    if _awake and _start_ticking is not None and not bpy.app.background:
        _start_ticking()


def _look_again() -> None:
    _watches.clear()


def _watched(scene: bpy.types.Scene) -> _Watch:
    uid = scene.session_uid
    if uid not in _watches:
        _watches[uid] = _look(scene)
    return _watches[uid]


def _shown_scenes() -> list[bpy.types.Scene]:
    """The present scene, and those that other windows show."""
    shown = [bpy.context.scene]
    for manager in bpy.data.window_managers:
        shown += [window.scene for window in manager.windows if window.scene not in shown]
    return shown


def _scenes() -> list[bpy.types.Scene]:
    """All scenes, those that are shown first."""
    shown = _shown_scenes()
    return [*shown, *(scene for scene in bpy.data.scenes if scene not in shown)]


def _shown_papers() -> set[int]:
    return {uid for scene in _shown_scenes() for uid in _watched(scene).papers}


def _scene_of(mesh: bpy.types.Mesh) -> bpy.types.Scene:
    """The scene in which a paper follows what it is told."""
    uid = mesh.session_uid
    return next((scene for scene in _scenes() if uid in _watched(scene).papers), bpy.context.scene)


def _evaluated(scene: bpy.types.Scene) -> bpy.types.Depsgraph:
    """A scene as it is shown, up to date."""
    if scene == bpy.context.scene:
        return bpy.context.evaluated_depsgraph_get()
    windows = (window for manager in bpy.data.window_managers for window in manager.windows)
    layer = next((window.view_layer for window in windows if window.scene == scene), scene.view_layers[0])
    layer.update()
    return layer.depsgraph


def _look(scene: bpy.types.Scene) -> _Watch:
    watch = _Watch(len(scene.objects))
    known = {mesh.session_uid for mesh in bpy.data.meshes if mesh.curvefold.is_paper}
    if not known:
        return watch
    shown: dict[int, bpy.types.Object] = {}
    for thing in scene.objects:
        if thing.type == "MESH" and thing.data.session_uid in known:
            shown.setdefault(thing.data.session_uid, thing)
    for uid, paper in shown.items():
        watch.papers[uid] = paper.name
        settings = paper.data.curvefold
        movers = hooks.movers(settings)
        for mover in (paper, paper.data, *movers, *hooks.shapes_of(movers)):
            watch.movers.setdefault(mover.session_uid, set()).add(uid)
        if settings.sheet is not None:
            for part in (settings.sheet, *creases_of(settings.sheet)):
                watch.drawings.setdefault(part.session_uid, set()).add(uid)
    return watch


def _paper(uid: int, scenes: Sequence[bpy.types.Scene]) -> bpy.types.Object | None:
    """The object that shows a paper, in the first of the scenes that has one."""
    for _ in range(2):
        for scene in scenes:
            name = _watched(scene).papers.get(uid)
            paper = None if name is None else scene.objects.get(name)
            if paper is not None and paper.type == "MESH" and paper.data.session_uid == uid:
                return paper
        _look_again()  # renamed, removed, or made since
    # What is linked may have the same name.
    meshes = (
        thing
        for scene in scenes
        if uid in _watched(scene).papers
        for thing in scene.objects
        if thing.type == "MESH"
    )
    return next((thing for thing in meshes if thing.data.session_uid == uid), None)


def _may_move(paper: bpy.types.Object) -> bool:
    mesh = paper.data
    if not mesh.curvefold.live or mesh.is_editmode or mesh.shape_keys is not None:
        return False
    return not why_it_stays(mesh)


def _inputs(paper: bpy.types.Object, found: Session) -> hooks.Inputs:
    scene = _scene_of(paper.data)
    return read_inputs(paper, found, scene, _evaluated(scene))


def _wanted_source(mesh: bpy.types.Mesh) -> state.Source:
    """What the paper should be folded from now, with the resolution of its settings. Raises PatternError,
    StateError.
    """
    settings = mesh.curvefold
    stored = state.load_source(mesh)
    sheet = sheet_here(settings)
    # A paper whose drawing is gone keeps it.
    if sheet is None:
        return stored.told(settings.resolution)
    drawn = drawing.read_drawing(sheet)
    # Creases are gone when the last one is deleted, or when the paper was appended to another file without them.
    if not drawn.creases and state.pattern_of(stored).creases:
        raise solver.PatternError(
            "it has no crease any more, so the paper keeps those it has; draw another one, or make another paper",
            element=sheet.name,
        )
    return state.source_of(drawn, settings.resolution)


def _follow_scale(paper: bpy.types.Object) -> None:
    """The paper's net is as large as its sheet in the sheet's own coordinates: where the sheet's scale has changed,
    what shows the paper is scaled with it, unless somebody has done that already.
    """
    settings = paper.data.curvefold
    sheet = sheet_here(settings)
    if sheet is None:
        return
    grown = _ratio(placing.mean_scale(sheet), settings.sheet_scale)
    followed = _ratio(placing.mean_scale(paper), settings.paper_scale)
    if grown != 1.0 and followed == 1.0:
        for item in bpy.data.objects:
            if item.data == paper.data:
                item.scale *= grown
    settings.sheet_scale, settings.paper_scale = placing.mean_scale(sheet), placing.mean_scale(paper)


def _note_scale(paper: bpy.types.Object) -> None:
    """Keeps in mind that somebody has scaled the paper alone; where the sheet was scaled, it is looked at anew."""
    settings = paper.data.curvefold
    sheet = sheet_here(settings)
    if sheet is None:
        return
    if _ratio(placing.mean_scale(sheet), settings.sheet_scale) != 1.0:
        _stale.setdefault(paper.data.session_uid, time.monotonic())  # undo tells nobody
        return
    own = placing.mean_scale(paper)
    if settings.sheet_scale == 0.0 or _ratio(own, settings.paper_scale) != 1.0:
        settings.sheet_scale, settings.paper_scale = placing.mean_scale(sheet), own


def _ratio(now: float, before: float) -> float:
    """How many times as large a scale has become; 1 where that is rounding, or not known."""
    if not (now > 0.0 and before > 0.0) or abs(now - before) <= SAME_SCALE * before:
        return 1.0
    return now / before


def _unparked(uid: int, shape: state.StoredShape) -> Session | None:
    parked = _parked.pop(uid, None)
    if parked is None or parked.source != shape.source:
        return None
    parked.reload(shape)
    return parked


def _take(paper: bpy.types.Object, made: Session) -> None:
    """A session that goes on from what the mesh carries."""
    _sessions[paper.data.session_uid] = made
    if linked.is_local(paper.data):
        controls.match_creases(paper.data.curvefold, made.drawn)
    if made.rest is not None:
        made.ruled = made.version  # the file keeps the rulings of a paper that rests
    made.take_up(_inputs(paper, made))


@dataclass(frozen=True, eq=False)
class _Told:
    """A paper that was told what to do in a tick."""

    uid: int
    mesh: bpy.types.Mesh
    session: Session
    inputs: hooks.Inputs


def _in_order() -> list[int]:
    """Papers that may have something to do: the active one, then those that were shown longest ago."""
    active = active_paper(bpy.context)
    first = None if active is None else active.data.session_uid
    return sorted(_awake, key=lambda uid: (uid != first, _shown.get(uid, 0.0), uid))


def _guarded(uid: int, act: Callable[[], Any]) -> Any:
    """What ``act`` returns; None when it raises, and then the paper sleeps and says why."""
    try:
        return act()
    except (solver.CurvefoldError, state.StateError) as error:
        _faults[uid] = str(error)
    except Exception as error:
        if _broken.get(uid) != repr(error):
            _broken[uid] = repr(error)
            traceback.print_exc()
    _awake.discard(uid)
    return None


def _tell(uid: int, first: bool, deadline: float, transforming: bool) -> _Told | None:
    """Tells a paper what its datablocks ask for now; None when it has nothing to show yet, or nothing to do."""
    paper = _paper(uid, _shown_scenes())
    # Leaving another mode is a change, and wakes it again.
    if paper is None or not _may_move(paper) or paper.mode != "OBJECT":
        _awake.discard(uid)
        return None
    mesh = paper.data
    _note_scale(paper)
    if is_playing() and hooks.is_animated(paper):
        _awake.discard(uid)
        return None  # frames count, not the clock; the end of the playback wakes it
    if not _is_made(paper, deadline if first else 0.0):
        return None
    found = _sessions[uid]
    if uid in _stale and not transforming and time.monotonic() - _stale[uid] >= DRAWING_RESTS:
        del _stale[uid]
        try:
            wanted = _wanted_source(mesh)
        except (solver.CurvefoldError, state.StateError) as error:
            _faults[uid] = str(error)  # it goes on as it was
            _follow_scale(paper)
        else:
            if not found.source.meets(wanted):
                found.write(mesh)  # what undo may just have led to
                _making[uid] = pool().submit(carried_session, wanted, found.snapshot())
                return None
            _faults.pop(uid, None)
            _follow_scale(paper)
    if uid in _unread or found.inputs is None:
        inputs = _inputs(paper, found)
        _unread.discard(uid)
    else:
        inputs = found.inputs
    if not transforming and found.is_back_at_start(inputs):
        found.return_to_start()
    else:
        found.ask(inputs, first)
    return _Told(uid, mesh, found, inputs)


def _is_made(paper: bpy.types.Object, deadline: float) -> bool:
    """Whether a paper has its session, new when it was made anew; waits for it until ``deadline``."""
    mesh = paper.data
    uid = mesh.session_uid
    if uid not in _making and uid not in _sessions:
        shape = state.load(mesh)
        parked = _unparked(uid, shape)
        if parked is None:
            _making[uid] = pool().submit(stored_session, shape)
        else:
            _take(paper, parked)
    if uid not in _making:
        return True
    try:
        made = _making[uid].result(timeout=max(0.0, deadline - time.perf_counter()))
    except TimeoutError:
        return False
    except (solver.CurvefoldError, state.StateError) as error:
        if uid not in _sessions:
            raise
        _faults[uid] = str(error)  # the drawing cannot be folded; the paper goes on as it was
    else:
        _faults.pop(uid, None)
        _unread.add(uid)
        if uid in _sessions:
            adopt(paper, made)
        else:
            _take(paper, made)
    finally:
        if uid in _making and _making[uid].done():
            del _making[uid]
    return True


def _show(paper: _Told, transforming: bool) -> None:
    """Shows what the thread has found; a paper that has no more to do sleeps."""
    found, mesh = paper.session, paper.mesh
    found.collect()
    found.write(mesh)
    rests = found.rests_with(paper.inputs)
    if rests and not transforming:
        found.before = None
    more = rests and not transforming and kept_rulings.find(mesh, found)
    # A hand that holds still may yet be taken back.
    if more or not rests or paper.uid in _stale or (transforming and found.before is not None):
        return
    _awake.discard(paper.uid)
