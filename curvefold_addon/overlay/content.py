"""What is drawn over each paper now. Computed for what is switched on, kept while the shape stays the same."""

import time
from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from .. import live
from ..bridge import baking, by_hand, mesh_overlay
from ..bridge import overlay as arrays
from ..bridge.papers import is_paper

#: A shape is at rest, and worth finding rulings for, when it is the same after this many seconds.
REST = 0.12
#: A moving one gets new rulings after this many; between, the old ones go with it.
MOVING = 1.0


@dataclass
class _Kept:
    """Of one mesh. rulings: the last ones found, and in which shape.

    looked_at: the shape at the last look; asked: when rulings were asked for.
    """

    shape: arrays.PaperShape
    triangles: arrays.Indices
    rulings: arrays.Rulings | None = None
    rulings_of: arrays.PaperShape | None = None
    looked_at: arrays.PaperShape | None = None
    asked: float = 0.0


@dataclass
class _KeptMesh:
    """Of a mesh nobody works on. counts: of its parts; played: its shape keys and their time, if it has any."""

    counts: tuple[int, int, int, int]
    parts: mesh_overlay.MeshParts | None
    shape: mesh_overlay.MeshShape | None = None
    played: tuple[int, float] | None = None


@dataclass(frozen=True)
class PaperContent:
    """What is drawn over one paper, in the coordinates of ``paper``; None: switched off, or not there yet.

    pulls: of handles, of joints, and of angles at points
    """

    paper: bpy.types.Object
    creases: arrays.Lines | None
    stretch: arrays.Surface | None
    rulings: arrays.Lines | None
    gauss_image: arrays.GaussBall | None
    pulls: tuple[arrays.Pulls, ...]
    angles: tuple[arrays.Label, ...]


_kept: dict[int, _Kept] = {}
_meshes: dict[int, _KeptMesh] = {}
_finder: arrays.RulingFinder | None = None


def papers(context: bpy.types.Context) -> Iterator[bpy.types.Object]:
    """The papers that the context's viewport shows."""
    if not any(mesh.curvefold.is_paper for mesh in bpy.data.meshes):
        return
    for item in context.view_layer.objects:
        if is_paper(item) and item.mode != "EDIT" and item.visible_in_viewport_get(context.space_data):
            yield item


def of_paper(paper: bpy.types.Object, settings: bpy.types.PropertyGroup) -> PaperContent | None:
    """What ``settings`` ask to be drawn over a paper. None when its mesh is no longer that of a paper."""
    mesh = paper.data
    session = live.session(mesh)
    if session is None or baking.is_baked(mesh) or by_hand.is_changed(mesh):
        return _of_mesh(paper, settings)
    kept = _kept.get(mesh.session_uid)
    if kept is None or not kept.shape.is_of(session.net, session.positions):
        shape = arrays.PaperShape(session.net, session.positions)
        if len(mesh.vertices) != len(shape.shown):
            return None
        if kept is not None and kept.shape.net is session.net:
            kept.shape = shape
        else:
            _forget_the_dead()
            kept = _kept[mesh.session_uid] = _Kept(shape, arrays.shown_triangles(mesh))
    shape = kept.shape
    inputs = session.inputs
    return PaperContent(
        paper,
        shape.creases() if settings.creases else None,
        shape.stretch(kept.triangles) if settings.stretch else None,
        _rulings(kept) if settings.rulings else None,
        shape.gauss_ball() if settings.gauss_image else None,
        (shape.pulls(inputs.handles), shape.joints(inputs.controls), shape.asked_angles(inputs.controls))
        if settings.pulls and inputs is not None
        else (),
        shape.angles() if settings.angles else (),
    )


def _of_mesh(paper: bpy.types.Object, settings: bpy.types.PropertyGroup) -> PaperContent | None:
    """The same of a paper that is baked or that nobody works on, as far as its mesh shows it."""
    mesh = paper.data
    if not (settings.creases or settings.stretch or settings.angles):
        return None
    kept = _meshes.get(mesh.session_uid)
    if kept is None or kept.counts != mesh_overlay.counts(mesh):
        _forget_the_dead()
        parts = mesh_overlay.parts_of(mesh, arrays.shown_triangles(mesh))
        kept = _meshes[mesh.session_uid] = _KeptMesh(mesh_overlay.counts(mesh), parts)
    if kept.parts is None:
        return None
    keys = mesh.shape_keys
    played = None if keys is None else (keys.session_uid, keys.eval_time)
    if kept.shape is None or played is None or played != kept.played:
        positions = mesh_overlay.shown_positions(mesh)
        if kept.shape is None or not mesh_overlay.same(positions, kept.shape.positions):
            kept.shape = mesh_overlay.MeshShape(kept.parts, positions)
        kept.played = played
    shape = kept.shape
    return PaperContent(
        paper,
        shape.creases() if settings.creases else None,
        shape.stretch() if settings.stretch else None,
        None,
        None,
        (),
        shape.angles() if settings.angles else (),
    )


def forget() -> None:
    """Drops everything that is kept."""
    global _finder
    _kept.clear()
    _meshes.clear()
    if bpy.app.timers.is_registered(_look_for_rulings):
        bpy.app.timers.unregister(_look_for_rulings)
    if _finder is not None:
        _finder.stop()
        _finder = None


def is_kept(uid: int) -> bool:
    """Whether something is kept for the mesh with this ``session_uid``."""
    return uid in _kept or uid in _meshes


def _forget_the_dead() -> None:
    alive = {mesh.session_uid for mesh in bpy.data.meshes}
    for kept in (_kept, _meshes):
        for uid in [uid for uid in kept if uid not in alive]:
            del kept[uid]


def _rulings(kept: _Kept) -> arrays.Lines | None:
    if kept.rulings_of is not kept.shape and not bpy.app.timers.is_registered(_look_for_rulings):
        bpy.app.timers.register(_look_for_rulings, first_interval=REST)
    return None if kept.rulings is None else kept.shape.rulings(kept.rulings)


def _look_for_rulings() -> float | None:
    """One look: takes what was found, asks for what has come to rest; seconds to the next, None for never."""
    global _finder
    if _finder is None:
        _finder = arrays.RulingFinder()
    found = _finder.take()
    for kept in _kept.values():
        if found is not None and kept.shape.net is found[0].net:
            kept.rulings_of, kept.rulings = found
            redraw()
        due = kept.looked_at is kept.shape or time.monotonic() - kept.asked > MOVING
        if kept.rulings_of is not kept.shape and due and _finder.ask(kept.shape):
            kept.asked = time.monotonic()
        kept.looked_at = kept.shape
    waiting = _finder.busy or any(kept.rulings_of is not kept.shape for kept in _kept.values())
    return REST if waiting else None


def redraw() -> None:
    """Has all 3D views drawn again."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
