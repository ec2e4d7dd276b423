"""Papers that follow the frames of a scene, played or rendered: frames count, whatever the clock says.

Whole frames fold a paper on, each from the one before. What is shown between two of them, for motion blur, lies
between their shapes, so that a film is the same with it.
"""

from collections.abc import Callable

import bpy

from .. import solver
from . import kept_rulings, live
from .bridge import state
from .bridge.session import Session

#: What is done at a frame that is gone to for a moment.
_errand: Callable[[bpy.types.Scene, bpy.types.Depsgraph], None] | None = None


def frame_changed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """A frame of an evaluated scene, which need not be the one that is shown, or a time between two."""
    if _errand is not None:
        _errand(scene, depsgraph)
    elif scene.frame_subframe:
        _show_between(scene, depsgraph)
    else:
        _each(_follow_frame, scene, depsgraph)


def _each(
    act: Callable[[bpy.types.Object, Session, bpy.types.Scene, bpy.types.Depsgraph], None],
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph,
) -> None:
    """Does the same with all papers that follow the frames."""
    for paper in live.animated_papers(scene, depsgraph):
        try:
            act(paper, live.make_session(paper), scene, depsgraph)
        except (solver.CurvefoldError, state.StateError) as error:
            live.note_fault(paper.data, str(error))  # the other papers go on


def _follow_frame(
    paper: bpy.types.Object, found: Session, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> None:
    film, frame = found.film, scene.frame_current
    inputs = live.read_inputs(paper, found, scene, depsgraph)
    if not film.is_at(frame, inputs):
        lately = film.shape_of(frame, inputs)
        if lately is None and frame < scene.frame_start:
            lately = film.first_shape(frame)
        # A picture is made of several looks at its frame, and at those beside it.
        if lately is not None and depsgraph.mode == "RENDER":
            found.show(paper.data, lately)
            return
        step = 0 if film.frame is None else frame - film.frame
        if frame == scene.frame_start:
            film.begin(frame, inputs, live.SETTLING)
        elif 0 < step <= _longest_step(scene):
            film.follow(frame, inputs, step * paper.data.curvefold.iterations_per_frame)
        elif _must_wait(depsgraph):
            film.follow(frame, inputs, live.SETTLING)
        else:
            film.leave(frame)
            live.wake(paper.data)
            return
    found.write(paper.data)
    kept_rulings.keep(paper.data, found)
    found.before = None


def _show_between(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Papers as they are between two whole frames, which are gone to only where one of them is not known yet."""
    if _must_wait(depsgraph) and not all(_is_begun(found, scene) for found in _sessions(scene, depsgraph)):
        _visit(scene, max(scene.frame_current, scene.frame_start), lambda *stage: _each(_follow_frame, *stage))
    waiting = {found.film.frame for found in _sessions(scene, depsgraph) if _is_waiting(found, scene)}
    for frame in sorted(waiting):
        _visit(scene, frame + _longest_step(scene), lambda *stage: _each(_look_ahead, *stage))
    _each(_show, scene, depsgraph)


def _sessions(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> list[Session]:
    """Of the papers that follow the frames."""
    sessions: list[Session] = []
    _each(lambda paper, found, *stage: sessions.append(found), scene, depsgraph)
    return sessions


def _is_begun(found: Session, scene: bpy.types.Scene) -> bool:
    """Whether the frame before the time that is shown is known."""
    return _shape(found, scene) is not None or _is_waiting(found, scene)


def _is_waiting(found: Session, scene: bpy.types.Scene) -> bool:
    """Whether only the frame after the time that is shown is not known."""
    before = found.film.last_shape(_time(scene), _longest_step(scene))
    return before is not None and _shape(found, scene) is None


def _shape(found: Session, scene: bpy.types.Scene) -> object | None:
    """Of a paper between two frames. It stands still before the first frame of the scene and after the last."""
    film, time = found.film, _time(scene)
    shape = film.shape_at(time)
    if shape is None:
        shape = film.first_shape(time)
    if shape is None and time > scene.frame_end:
        shape = film.last_shape(time, within=1.0)
    return shape


def _show(paper: bpy.types.Object, found: Session, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    shape = _shape(found, scene)
    if shape is not None:
        found.show(paper.data, shape)
    else:
        live.wake(paper.data)


def _look_ahead(
    paper: bpy.types.Object, found: Session, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> None:
    film, frame = found.film, scene.frame_current
    if film.is_known and film.frame is not None and frame == film.frame + _longest_step(scene):
        inputs = live.read_inputs(paper, found, scene, depsgraph)
        film.look_ahead(frame, inputs, _longest_step(scene) * paper.data.curvefold.iterations_per_frame)


def _visit(
    scene: bpy.types.Scene, frame: int, errand: Callable[[bpy.types.Scene, bpy.types.Depsgraph], None]
) -> None:
    """Does something at another frame, and comes back."""
    global _errand
    here, part = scene.frame_current, scene.frame_subframe
    try:
        _errand = errand
        scene.frame_set(frame)
        _errand = _nothing
        scene.frame_set(here, subframe=part)
    finally:
        _errand = None


def _nothing(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """The errand on the way back."""


def _must_wait(depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether a paper has to be ready at once, since nobody sees it on its way."""
    return bool(bpy.app.background or depsgraph.mode == "RENDER" or _errand is not None)


def _longest_step(scene: bpy.types.Scene) -> int:
    """Frames from one that is rendered to the next."""
    return max(1, scene.frame_step)


def _time(scene: bpy.types.Scene) -> float:
    return float(scene.frame_current + scene.frame_subframe)
