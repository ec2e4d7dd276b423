"""Runs inside the Blender under test: says what is there and where, and records a drag. It presses nothing.

Commands come as files: ``{"name": …, "arguments": {…}}`` in ``command.json``, answered in ``answer.json``. The
folder is the one argument after ``--``.
"""

import hashlib
import importlib
import json
import os
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path

import blf
import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Matrix, Vector

FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
sys.path.insert(0, str(FOLDER))
bits = importlib.import_module("bits")
POLL = 0.1  # seconds
PACKAGE = "bl_ext.user_default.curvefold.curvefold_addon"


def _window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def _view() -> tuple[bpy.types.Area, bpy.types.Region, bpy.types.RegionView3D]:
    """The largest 3D view."""
    areas = [area for area in _window().screen.areas if area.type == "VIEW_3D"]
    area = max(areas, key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return area, region, area.spaces.active.region_3d


def _rectangle(region: bpy.types.Region | bpy.types.Area) -> list[int]:
    """Left, top, right, bottom on the screen; Blender counts from below."""
    height = _window().height
    return [region.x, height - region.y - region.height, region.x + region.width, height - region.y]


def awake() -> bool:
    return True


def regions() -> dict[str, list[int]]:
    """Where the 3D view and its regions are; a hidden one is one pixel wide."""
    area, _, _ = _view()
    return {"AREA": _rectangle(area)} | {region.type: _rectangle(region) for region in area.regions}


def on_screen(points: list[list[float]]) -> list[list[float] | None]:
    """Where points of the scene are on the screen; None behind the eye."""
    _, region, view = _view()
    height = _window().height
    seen = [location_3d_to_region_2d(region, view, Vector(point)) for point in points]
    return [None if p is None else [region.x + p.x, height - region.y - p.y] for p in seen]


def _world(thing: bpy.types.Object) -> np.ndarray:
    """Where a mesh's vertices are in the scene, (V, 3)."""
    matrix = np.array(thing.matrix_world)
    return bits.shown(thing.data) @ matrix[:3, :3].T + matrix[:3, 3]


def _live() -> object:
    return importlib.import_module(f"{PACKAGE}.live")


def _paper_facts(thing: bpy.types.Object) -> dict:
    mesh, settings = thing.data, thing.data.curvefold
    places = bits.shown(mesh)
    report = _live().report(mesh)
    return {
        "vertices": len(mesh.vertices),
        "exact": bits.digest(mesh),
        "hash": hashlib.sha256(places.tobytes()).hexdigest(),
        "height": float(np.ptp(places[:, 2])),
        "finite": bool(np.isfinite(places).all()),
        "corners": _world(thing)[[np.argmin(places @ d) for d in _DIAGONALS]].tolist(),
        "fold": settings.fold,
        "live": settings.live,
        "hooks": [handle.hook.name if handle.hook else None for handle in settings.handles],
        "points": [list(handle.at) for handle in settings.handles],
        "report": None if report is None else _plain(report),
    }


#: Directions in which the four corners of a sheet lie, from the lower left one counter-clockwise.
_DIAGONALS = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]], dtype=np.float32)


def _plain(report: object) -> dict:
    names = (
        "state",
        "sentence",
        "stretch_mean",
        "stretch_max",
        "fold_angle",
        "vertices",
        "iterations",
        "milliseconds",
    )
    return {name: getattr(report, name) for name in names}


def facts() -> dict:
    """What is in the scene and what Blender is doing."""
    objects = {}
    for thing in bpy.context.scene.objects:
        objects[thing.name] = {
            "type": thing.type,
            "role": thing.curvefold.role,
            "parent": thing.parent.name if thing.parent else None,
            "place": list(thing.matrix_world.translation),
            "selected": thing.select_get(),
            "seen": thing.visible_get(),
            "box": [list(thing.matrix_world @ Vector(corner)) for corner in thing.bound_box],
        }
        if thing.type == "CURVE":
            objects[thing.name]["splines"] = [
                max(len(spline.points), len(spline.bezier_points)) for spline in thing.data.splines
            ]
    papers = {
        thing.name: _paper_facts(thing)
        for thing in bpy.context.scene.objects
        if thing.type == "MESH" and thing.data.curvefold.is_paper
    }
    active = bpy.context.view_layer.objects.active
    return {
        "objects": objects,
        "papers": papers,
        "active": active.name if active else None,
        "mode": bpy.context.mode,
        "modal": [operator.bl_idname for operator in _window().modal_operators],
        "file": bpy.data.filepath,
        "opened": _opened,
    }


def said() -> list[str]:
    """What Blender has told its user, as its info editor shows it. For the idle: an area changes to and fro."""
    text = bpy.context.window_manager.clipboard
    with bpy.context.temp_override(window=_window()):
        area = _view()[0]
        old = area.type
        area.type = "INFO"
        try:
            with bpy.context.temp_override(window=_window(), area=area, region=area.regions[-1]):
                bpy.ops.info.select_all(action="SELECT")
                bpy.ops.info.report_copy()
        finally:
            area.type = old
    found = bpy.context.window_manager.clipboard
    bpy.context.window_manager.clipboard = text
    return found.splitlines()


def lettering(text: str, style: str = "widget") -> dict:
    """How Blender draws a text: rows of grey from 0 to 255, the first at the top."""
    preferences = bpy.context.preferences
    points = getattr(preferences.ui_styles[0], style).points
    blf.size(0, points * preferences.system.ui_scale)
    width, height = (int(side) + 4 + round(points) for side in blf.dimensions(0, text))
    screen = gpu.types.GPUOffScreen(width, height)
    with screen.bind():
        buffer = gpu.state.active_framebuffer_get()
        buffer.clear(color=(0.0, 0.0, 0.0, 1.0))
        with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_identity()
            gpu.matrix.load_projection_matrix(
                Matrix(((2 / width, 0, 0, -1), (0, 2 / height, 0, -1), (0, 0, 1, 0), (0, 0, 0, 1)))
            )
            gpu.state.blend_set("ALPHA")
            blf.color(0, 1.0, 1.0, 1.0, 1.0)
            blf.position(0, 2, 2 + round(0.25 * points), 0)
            blf.draw(0, text)
            gpu.state.blend_set("NONE")
        pixels = buffer.read_color(0, 0, width, height, 1, 0, "UBYTE")
    screen.free()
    pixels.dimensions = width * height
    rows = np.array(pixels, dtype=np.uint8).reshape(height, width)[::-1]
    return {"rows": rows.tolist()}


def prepare(sample: str, resolution: int, points: list[list[float]]) -> None:
    """An empty scene with a sample's paper in view, and handles near points of the sheet, from 0 to 1 each way."""
    area, region, view = _view()
    with bpy.context.temp_override(window=_window(), area=area, region=region):
        view.view_location, view.view_distance = (0.0, 0.0, 0.0), 1.0
        bits.new_paper(sample, resolution, points)
        bpy.ops.ed.undo_push(message="Prepare")


def _in_view(function: Callable[..., object], *arguments: object) -> object:
    """As an operator that a person calls with the mouse over the 3D view."""
    area, region, _ = _view()
    with bpy.context.temp_override(window=_window(), area=area, region=region):
        return function(*arguments)


def waited_for() -> str:
    return _in_view(bits.waited_for)


def at_once(drawing: str) -> str:
    return _in_view(bits.at_once, drawing)


def folding() -> None:
    """The paper of ``waited_for``, left to fold by itself."""
    paper = _in_view(bits.new_paper, bits.SAMPLE, bits.RESOLUTION, [])
    paper.data.curvefold.fold = bits.FOLD


def animated() -> str:
    return _in_view(bits.animated).name


#: Whole frames that were rendered: [number, digest of the paper as it is kept, whether the interface was locked].
_filmed: list[list] = []


def film() -> None:
    """An animated paper, and a small film of it with motion blur to be rendered."""
    paper = _in_view(bits.animated)
    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location.z = 1.0
    scene.collection.objects.link(scene.camera)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.render.use_motion_blur = True
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.render.filepath = str(FOLDER / "film" / "frame")
    _filmed.clear()

    @persistent
    def note(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        if depsgraph.mode == "RENDER" and not scene.frame_subframe:
            mesh = bpy.data.objects[name].data
            _filmed.append([scene.frame_current, bits.digest(mesh), scene.render.use_lock_interface])

    name = paper.name
    bpy.app.handlers.frame_change_post.append(note)


def filmed() -> dict:
    """The whole frames so far, whether more come, and whether the interface would be locked."""
    return {
        "frames": _filmed,
        "rendering": bpy.app.is_job_running("RENDER"),
        "locks": bpy.context.scene.render.use_lock_interface,
    }


def still() -> None:
    """The paper of the film is animated no more."""
    for thing in bpy.context.scene.objects:
        thing.animation_data_clear()
        if thing.data is not None:
            thing.data.animation_data_clear()


def save_automatically(minutes: int) -> None:
    paths = bpy.context.preferences.filepaths
    paths.use_auto_save_temporary_files = True
    paths.auto_save_time = minutes


class _Recorder:
    """Notes when the hook moves, when the paper is written, and what every frame shows."""

    def __init__(self) -> None:
        self.paper = self.hook = ""
        self.vertex = 0
        self.events: list[list] = []
        self.on = False

    def start(self, paper: str, hook: str) -> None:
        self.paper, self.hook, self.events, self.on = paper, hook, [], True
        # The vertex that the handle holds: with the paper at rest, the nearest one.
        place = np.array(bpy.data.objects[hook].matrix_world.translation)
        self.vertex = int(np.argmin(np.linalg.norm(_world(bpy.data.objects[paper]) - place, axis=1)))

    def note(self, kind: str) -> None:
        paper, hook = bpy.data.objects.get(self.paper), bpy.data.objects.get(self.hook)
        if paper is None or hook is None:
            return
        point = paper.matrix_world @ paper.data.vertices[self.vertex].co
        clocks = [time.thread_time(), time.process_time()]
        self.events.append([time.perf_counter(), kind, list(hook.matrix_world.translation), list(point), *clocks])


_recorder = _Recorder()


def record(paper: str, hook: str) -> None:
    _recorder.start(paper, hook)


def recorded() -> dict:
    """The events since ``record``: [seconds, what, hook's place, its point on the paper, and the processor time of
    this thread and of all]. What: "hook", "paper", "tick" to "ticked", and "draw" to "frame".
    """
    _recorder.on = False
    return {"events": _recorder.events}


@persistent
def _updated(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not _recorder.on:
        return
    for update in depsgraph.updates:
        thing = update.id
        if isinstance(thing, bpy.types.Object):
            if thing.name == _recorder.hook and update.is_updated_transform:
                _recorder.note("hook")
            if thing.name == _recorder.paper and update.is_updated_geometry:
                _recorder.note("paper")


def _draws() -> None:
    if _recorder.on:
        _recorder.note("draw")


def _drawn() -> None:
    if _recorder.on:
        _recorder.note("frame")


def _watch_ticks() -> None:
    live = _live()
    tick = live.tick

    def watched(*arguments: object, **options: object) -> bool:
        if not _recorder.on:
            return tick(*arguments, **options)
        _recorder.note("tick")
        more = tick(*arguments, **options)
        _recorder.note("ticked")
        return more

    live.tick = watched


_opened = 0


@persistent
def _count(*_: object) -> None:
    global _opened
    _opened += 1


_COMMANDS = (
    *(awake, regions, on_screen, facts, said, lettering, prepare, save_automatically, record, recorded),
    *(film, filmed, still, waited_for, at_once, folding, animated, bits.watch_frames, bits.seen_frames),
)


def _poll() -> float:
    order = FOLDER / "command.json"
    if not order.exists():
        return POLL
    command = json.loads(order.read_text())
    order.unlink()
    functions = {function.__name__: function for function in _COMMANDS}
    try:
        answer = {"answer": functions[command["name"]](**command["arguments"])}
    except Exception:
        answer = {"error": traceback.format_exc()}
    part = FOLDER / "answer.part"
    part.write_text(json.dumps(answer))
    os.replace(part, FOLDER / "answer.json")
    return POLL


bpy.app.handlers.depsgraph_update_post.append(_updated)
bpy.app.handlers.load_post.append(_count)
bits.watch()
_watch_ticks()
bpy.types.SpaceView3D.draw_handler_add(_draws, (), "WINDOW", "PRE_VIEW")
bpy.types.SpaceView3D.draw_handler_add(_drawn, (), "WINDOW", "POST_PIXEL")
bpy.app.timers.register(_poll, persistent=True)
