"""Blender used in random order: undo, files, copies, deletions, modes, scenes, frames, pictures, and folding in
between. Nothing raises, no paper is lost, and what a mesh shows is what it keeps.

``CURVEFOLD_RANDOM_STEPS`` makes the walk longer, ``CURVEFOLD_RANDOM_SEED`` makes another one.
"""

import hashlib
import math
import os
import random
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

import addon_utils
import bpy
import numpy as np
import pytest
from mathutils import Vector

STEPS = int(os.environ.get("CURVEFOLD_RANDOM_STEPS", "240"))
SEED = int(os.environ.get("CURVEFOLD_RANDOM_SEED", "1"))
#: Steps that start from an empty file: what goes wrong is found again by few.
LENGTH = 60
#: Steps of a walk that is made twice.
REPLAYED = 40
#: More than this becomes slow, not more telling.
MOST_PAPERS, MOST_OBJECTS, MOST_HANDLES, MOST_SCENES = 4, 40, 5, 3
#: Quads along the longer side, automatic among them, and the vertices that automatic may use.
RESOLUTIONS, VERTICES = (0, *range(4, 11)), 200
#: Frames of an animation.
FRAMES = 4
#: Marks meshes that were edited: what they show is their user's affair until the paper moves.
TAMPERED = "tampered"
#: How often a step is taken, by its name.
STEP: dict[str, tuple[Callable[["Walk"], None], int]] = {}
#: Steps after which papers may be fewer.
TAKE_AWAY = {
    "undo",
    "redo",
    "load_the_saved_file",
    "save_and_load",
    "delete",
    "delete_scene",
    "purge",
    "off_and_on",
    "make_ordinary",
}
#: Steps after which a mesh that was changed by hand may be another.
RESHAPE = {*TAKE_AWAY, "tamper", "restore"}


def step(weight: int = 2) -> Callable[[Callable[["Walk"], None]], Callable[["Walk"], None]]:
    def keep(function: Callable[["Walk"], None]) -> Callable[["Walk"], None]:
        STEP[function.__name__] = (function, weight)
        return function

    return keep


@dataclass
class Walk:
    """settled: folds are waited for, so that the same walk ends in the same bits."""

    rng: random.Random
    addon: SimpleNamespace
    folder: Path
    settled: bool
    taken: list[str] = field(default_factory=list)
    changed: dict[int, bytes] = field(default_factory=dict)

    @property
    def scene(self) -> bpy.types.Scene:
        return bpy.context.scene

    def some(self, things):
        """One of them, or nothing: in an order that does not depend on memory."""
        things = sorted(things, key=lambda thing: thing.name)
        return self.rng.choice(things) if things else None

    def papers(self) -> list[bpy.types.Object]:
        return [o for o in bpy.context.view_layer.objects if o.type == "MESH" and o.data.curvefold.is_paper]

    def objects(self, role: str) -> list[bpy.types.Object]:
        return [o for o in bpy.context.view_layer.objects if o.curvefold.role == role]

    def hooks(self) -> list[bpy.types.Object]:
        return [o for o in bpy.context.view_layer.objects if o.type == "EMPTY"]

    def choose(self, *things: bpy.types.Object) -> None:
        """Selects them in Object Mode; the first one is active."""
        to_object_mode()
        bpy.ops.object.select_all(action="DESELECT")
        for thing in things:
            thing.hide_set(False)
            thing.hide_viewport = False
            thing.select_set(True)
        bpy.context.view_layer.objects.active = things[0]

    def paper(self) -> bpy.types.Object | None:
        """Some paper, made the active object."""
        found = self.some(self.papers())
        if found is not None:
            self.choose(found)
        return found

    def full(self) -> bool:
        return len(bpy.data.objects) > MOST_OBJECTS or len(self.papers()) >= MOST_PAPERS


def to_object_mode() -> None:
    if bpy.context.mode != "OBJECT":
        # Blender keeps the mode of what is hidden, and does not let go of it.
        bpy.context.active_object.hide_set(False)
        bpy.context.active_object.hide_viewport = False
        bpy.ops.object.mode_set(mode="OBJECT")


def call(operator, **options) -> None:
    """An operator that may refuse in a sentence, and must not fail otherwise."""
    if not operator.poll():
        return
    try:
        operator(**options)
    except RuntimeError as error:
        if "Traceback" in str(error):
            raise


# --- time goes by ---------------------------------------------------------------------------------------------


@step(12)
def tick(walk):
    if walk.settled:
        wait(walk)
        return
    for _ in range(walk.rng.randint(1, 4)):
        walk.addon.live.tick(walk.rng.choice((0.0, 0.004, 0.02)), walk.rng.random() < 0.3)


@step(4)
def wait(walk):
    for paper in sorted(walk.papers(), key=lambda paper: paper.name):
        # In any mode, of any paper, one that is not live or baked too.
        bpy.context.view_layer.objects.active = paper
        call(bpy.ops.curvefold.settle)


@step(4)
def frame(walk):
    walk.scene.frame_set(walk.rng.randint(1, FRAMES))


@step(1)
def play(walk):
    for number in range(1, FRAMES + 1):
        walk.scene.frame_set(number)


@step(2)
def render(walk):
    scene = walk.scene
    if scene.camera is None:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(camera)
        camera.location.z = 1.0
        scene.camera = camera
    scene.render.engine = walk.rng.choice(("CYCLES", "BLENDER_WORKBENCH"))
    scene.cycles.samples = 1
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.frame_start, scene.frame_end = 1, 2
    scene.render.filepath = str(walk.folder / "picture")
    call(bpy.ops.render.render, animation=walk.rng.random() < 0.3)
    scene.frame_end = FRAMES


# --- folding --------------------------------------------------------------------------------------------------


@step(10)
def drag(walk):
    hook = walk.some(walk.hooks())
    if hook is not None:
        for k in range(3):
            hook.location[k] += walk.rng.uniform(-0.006, 0.006)


@step(1)
def tear(walk):
    hook = walk.some(walk.hooks())
    if hook is not None:
        hook.location.z += walk.rng.choice((0.5, -20.0, 1e6))


@step(4)
def slide(walk):
    paper = walk.paper()
    if paper is not None:
        paper.data.curvefold.fold = walk.rng.choice((0.0, 20.0, 60.0, 100.0))
        paper.data.curvefold.angle = walk.rng.uniform(0.0, math.pi)


def select_vertices(walk, paper, count) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for _ in range(count):
        paper.data.vertices[walk.rng.randrange(len(paper.data.vertices))].select = True
    bpy.ops.object.mode_set(mode="EDIT")


@step(5)
def hold(walk):
    paper = walk.paper()
    if paper is None or len(paper.data.curvefold.handles) >= MOST_HANDLES or not len(paper.data.vertices):
        return
    select_vertices(walk, paper, walk.rng.randint(1, 2))
    operator = walk.rng.choice((bpy.ops.curvefold.pin, bpy.ops.curvefold.add_handles))
    call(operator)


@step(3)
def join(walk):
    paper = walk.paper()
    if paper is None or len(paper.data.curvefold.joints) >= 3 or not len(paper.data.polygons):
        return
    what = walk.rng.randrange(4)
    if what <= 1:
        select_vertices(walk, paper, 2)
        call(bpy.ops.curvefold.join_points, relation=walk.rng.choice(("MEET", "SHARE", "DISTANCE")))
    elif what == 2:
        select_vertices(walk, paper, 0)
        bpy.ops.mesh.select_mode(type="FACE")
        bpy.ops.object.mode_set(mode="OBJECT")
        walk.rng.choice(paper.data.polygons).select = True
        bpy.ops.object.mode_set(mode="EDIT")
        call(bpy.ops.curvefold.keep_patch, shape=walk.rng.choice(("FLAT", "RIGID")))
    else:
        select_opposite_borders(paper)
        call(bpy.ops.curvefold.glue_borders)


def select_opposite_borders(paper) -> None:
    """Edit Mode with the vertices at both ends of the sheet."""
    across = paper.data.uv_layers.get("flat")
    flat = (
        {} if across is None else {loop.vertex_index: across.uv[loop.index].vector.x for loop in paper.data.loops}
    )
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    low, high = min(flat.values(), default=0.0), max(flat.values(), default=0.0)
    for index, x in flat.items():
        paper.data.vertices[index].select = min(x - low, high - x) < 1e-6
    bpy.ops.object.mode_set(mode="EDIT")


@step(2)
def change_joint(walk):
    paper = walk.paper()
    if paper is None or not len(paper.data.curvefold.joints):
        return
    joint = walk.rng.choice(paper.data.curvefold.joints)
    what = walk.rng.randrange(8)
    if what == 0:
        joint.enabled = not joint.enabled
    elif what == 1:
        joint.relation = walk.rng.choice(("MEET", "SHARE", "DISTANCE"))
    elif what == 2:
        joint.distance = walk.rng.uniform(0.0, 0.15)
    elif what == 3:
        joint.axes = [walk.rng.random() < 0.5 for _ in range(3)]
    elif what == 4:
        joint.shape = walk.rng.choice(("FLAT", "RIGID"))
    elif what == 5:
        joint.bending, joint.reverse = walk.rng.random() < 0.5, walk.rng.random() < 0.5
    elif what == 6:
        joint.strength = walk.rng.uniform(0.01, 5.0)
    else:
        setattr(joint, walk.rng.choice(("first", "second")), [walk.rng.uniform(-0.07, 0.07) for _ in range(2)])


@step(3)
def ask_angles(walk):
    """At vertices of creases; now and then at any."""
    paper = walk.paper()
    if paper is None or len(paper.data.curvefold.angles) >= 4 or not len(paper.data.vertices):
        return
    select_vertices(walk, paper, walk.rng.randrange(2))
    bpy.ops.object.mode_set(mode="OBJECT")
    marks = paper.data.attributes.get("crease")
    creased = [] if marks is None else [e.vertices[0] for e in paper.data.edges if marks.data[e.index].value >= 0]
    for index in walk.rng.sample(creased, min(len(creased), walk.rng.randint(1, 2))):
        paper.data.vertices[index].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    call(bpy.ops.curvefold.add_angles)


@step(3)
def change_angle(walk):
    paper = walk.paper()
    if paper is None or not len(paper.data.curvefold.angles):
        return
    angle = walk.rng.choice(paper.data.curvefold.angles)
    what = walk.rng.randrange(5)
    if what == 0:
        angle.enabled = not angle.enabled
    elif what == 1:
        angle.signed = not angle.signed
    elif what == 2:
        angle.angle = walk.rng.uniform(-math.pi, math.pi)
    elif what == 3:
        angle.strength = walk.rng.uniform(0.01, 5.0)
    else:
        angle.at = [walk.rng.uniform(-0.07, 0.07) for _ in range(2)]


@step(2)
def pick(walk):
    """A click on the paper, or beside it, as the operators that wait for one take it."""
    paper = walk.paper()
    if paper is None or not len(paper.data.vertices) or len(paper.data.curvefold.angles) >= 4:
        return
    normal = paper.matrix_world.to_3x3() @ Vector((0.0, 0.0, 1.0))
    at = paper.matrix_world @ walk.rng.choice(paper.data.vertices).co
    operator = SimpleNamespace()
    try:
        point = walk.addon.clicks.crease_along(paper, walk.addon.clicks.MouseRay(at + normal, -normal))
        if point is not None:
            walk.rng.choice((walk.addon.pick_crease.PickCrease, walk.addon.point_angles.PlaceAngle)).clicked(
                operator, paper, point
            )
    except (walk.addon.solver.CurvefoldError, walk.addon.state.StateError):
        pass  # as the operators do, which say it


@step(3)
def flow(walk):
    paper = walk.paper()
    if paper is None or not len(paper.data.curvefold.creases):
        return
    crease = walk.rng.choice(paper.data.curvefold.creases)
    what = walk.rng.randrange(5)
    if what == 0:
        crease.flow = walk.rng.choice(("NONE", "SHAPE", "SHAPE", "OBJECT"))
    elif what == 1:
        crease.curvature_times, crease.torsion_plus = walk.rng.uniform(0.5, 2.0), walk.rng.uniform(-5.0, 5.0)
    elif what == 2:
        crease.progress = walk.rng.uniform(0.0, 100.0)
    elif what == 3:
        crease.flow_speed = walk.rng.choice((0.01, 0.3, 1.0, 5.0, 100.0))
        crease.flow_strength = walk.rng.choice((0.01, 1.0, 100.0))
    else:
        # Any object can be named from a script.
        crease.curve = walk.rng.choice((None, walk.some([*walk.objects("CREASE"), *walk.papers()])))


@step(2)
def hook(walk):
    paper = walk.paper()
    if paper is None or walk.full():
        return
    things = walk.hooks()
    if walk.rng.random() < 0.5 or not things:
        empty = bpy.data.objects.new("Hook", None)
        walk.scene.collection.objects.link(empty)
        empty.location = [walk.rng.uniform(-0.05, 0.05) for _ in range(3)]
        bpy.context.view_layer.update()
        things = [empty]
    walk.choose(paper, walk.some(things))
    call(bpy.ops.curvefold.hook_object)


@step(3)
def change_handle(walk):
    paper = walk.paper()
    if paper is None or not len(paper.data.curvefold.handles):
        return
    handle = walk.rng.choice(paper.data.curvefold.handles)
    what = walk.rng.randrange(6)
    if what == 0:
        handle.enabled = not handle.enabled
    elif what == 1:
        handle.axes = [walk.rng.random() < 0.5 for _ in range(3)]
    elif what == 2:
        handle.strength = walk.rng.uniform(0.01, 5.0)
    elif what == 3:
        handle.offset = [walk.rng.uniform(-0.05, 0.05) for _ in range(3)]
    elif what == 4:
        # Anything may be a hook, the paper itself too.
        handle.hook = walk.some([*walk.hooks(), *walk.papers()])
    else:
        handle.at = [walk.rng.uniform(-0.07, 0.07) for _ in range(2)]


@step(2)
def remove(walk):
    paper = walk.paper()
    if paper is not None:
        operators = bpy.ops.curvefold
        call(walk.rng.choice((operators.remove_handle, operators.remove_joint, operators.remove_angle)))


@step(3)
def change_crease(walk):
    paper = walk.paper()
    if paper is None or not len(paper.data.curvefold.creases):
        return
    crease = walk.rng.choice(paper.data.curvefold.creases)
    what = walk.rng.randrange(4)
    if what == 0:
        crease.side = walk.rng.choice("UVM")
    elif what == 1:
        crease.amount = walk.rng.uniform(0.0, 100.0)
    elif what == 2:
        crease.use_angle = not crease.use_angle
    else:
        crease.angle = walk.rng.uniform(-math.pi, math.pi)


@step(2)
def sides(walk):
    paper = walk.paper()
    if paper is not None:
        operators = bpy.ops.curvefold
        call(walk.rng.choice((operators.flip_crease, operators.lock_sides, operators.free_sides)))


@step(2)
def flatten(walk):
    if walk.paper() is not None:
        call(bpy.ops.curvefold.flatten)


@step(1)
def fold_anew(walk):
    if walk.paper() is not None:
        call(bpy.ops.curvefold.fold_anew)


@step(2)
def resolve(walk):
    paper = walk.paper()
    if paper is not None:
        paper.data.curvefold.resolution = walk.rng.choice(RESOLUTIONS)


@step(2)
def switch(walk):
    paper = walk.paper()
    if paper is not None:
        paper.data.curvefold.live = walk.rng.random() < 0.8


@step(1)
def weigh(walk):
    paper = walk.paper()
    if paper is not None:
        paper.data.curvefold.weights.bending *= walk.rng.choice((0.5, 2.0))


@step(1)
def keyframe(walk):
    paper = walk.paper()
    hook = walk.some(walk.hooks())
    thing, path = walk.rng.choice(((paper and paper.data, "curvefold.fold"), (hook, "location")))
    if thing is not None:
        thing.keyframe_insert(path, frame=walk.rng.randint(1, FRAMES))


@step(1)
def bake(walk):
    walk.scene.frame_start, walk.scene.frame_end = 1, FRAMES
    if walk.paper() is not None:
        call(walk.rng.choice((bpy.ops.curvefold.bake, bpy.ops.curvefold.free_bake)))


# --- drawing --------------------------------------------------------------------------------------------------


@step(3)
def make_paper(walk):
    sheet = walk.some(walk.objects("SHEET"))
    if sheet is not None and not walk.full():
        walk.choose(sheet)
        call(bpy.ops.curvefold.make_paper, resolution=walk.rng.choice(RESOLUTIONS))


@step(1)
def sample(walk):
    if not walk.full():
        to_object_mode()
        call(bpy.ops.curvefold.add_sample, sample=walk.rng.choice(("one_arc", "lens", "crossing")))


@step(4)
def bend(walk):
    crease = walk.some(walk.objects("CREASE"))
    if crease is None:
        return
    to_object_mode()
    spline = crease.data.splines[0]
    points = spline.bezier_points if spline.type == "BEZIER" else spline.points
    walk.rng.choice(points).co[1] += walk.rng.uniform(-0.01, 0.01)
    crease.data.update_tag()


@step(1)
def draw(walk):
    sheet = walk.some(walk.objects("SHEET"))
    if sheet is None or walk.full():
        return
    curve = bpy.data.curves.new("Line", "CURVE")
    spline = curve.splines.new("POLY")
    spline.points.add(1)
    for point, x in zip(spline.points, (-1.0, 1.0), strict=True):
        point.co = (x, walk.rng.uniform(-0.05, 0.05), 0.0, 1.0)
    thing = bpy.data.objects.new("Line", curve)
    walk.scene.collection.objects.link(thing)
    bpy.context.view_layer.update()
    walk.choose(sheet, thing)
    call(bpy.ops.curvefold.make_crease)


@step(1)
def assign(walk):
    crease = walk.some(walk.objects("CREASE"))
    if crease is not None:
        walk.choose(crease)
        call(bpy.ops.curvefold.set_assignment, assignment=walk.rng.choice("UVMF"))


@step(1)
def other_drawing(walk):
    paper = walk.paper()
    if paper is not None:
        # Any object can be named, even one that is no drawing.
        paper.data.curvefold.sheet = walk.rng.choice((None, walk.some(bpy.context.view_layer.objects)))


# --- Blender --------------------------------------------------------------------------------------------------


@step(7)
def undo(walk):
    for _ in range(walk.rng.randint(1, 3)):
        call(bpy.ops.ed.undo)
    if walk.rng.random() < 0.5:
        redo(walk)


@step(2)
def redo(walk):
    for _ in range(walk.rng.randint(1, 2)):
        call(bpy.ops.ed.redo)


@step(2)
def save_and_load(walk):
    path = str(walk.folder / "kept.blend")
    to_object_mode()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


@step(1)
def load_the_saved_file(walk):
    path = walk.folder / "kept.blend"
    if path.exists():
        bpy.ops.wm.open_mainfile(filepath=str(path))


@step(2)
def delete(walk):
    things = list(bpy.context.view_layer.objects)
    if len(things) < 6:
        return
    thing = walk.some(things)
    if walk.rng.random() < 0.5:
        walk.choose(thing)
        call(bpy.ops.object.delete)
    else:
        bpy.data.objects.remove(thing)


@step(1)
def purge(walk):
    bpy.ops.outliner.orphans_purge(do_recursive=True)


@step(3)
def duplicate(walk):
    thing = walk.some(bpy.context.view_layer.objects)
    if thing is not None and not walk.full():
        walk.choose(thing)
        call(bpy.ops.object.duplicate, linked=walk.rng.random() < 0.5)


@step(1)
def single_user(walk):
    paper = walk.paper()
    if paper is not None:
        call(bpy.ops.object.make_single_user, object=True, obdata=True)


@step(2)
def rename(walk):
    things = [*bpy.data.objects, *bpy.data.meshes, *bpy.data.curves, *bpy.data.scenes]
    # Names are given again and again, so that some come to another thing.
    walk.rng.choice(things).name = walk.rng.choice(("Paper", "Sheet", "Crease", "Größe 1", "Hook", "x" * 60))


@step(3)
def mode(walk):
    thing = walk.some([*walk.papers(), *walk.objects("CREASE")])
    if thing is not None:
        walk.choose(thing)
        modes = ("EDIT", "SCULPT", "VERTEX_PAINT") if thing.type == "MESH" else ("EDIT",)
        call(bpy.ops.object.mode_set, mode=walk.rng.choice(modes))


@step(2)
def tamper(walk):
    """What Blender lets anybody do to a mesh."""
    paper = walk.paper()
    if paper is None or not len(paper.data.vertices):
        return
    what = walk.rng.randrange(7)
    mesh = paper.data
    mesh[TAMPERED] = True
    if what == 0:
        select_vertices(walk, paper, 1)
        bpy.ops.mesh.delete(type="VERT")
    elif what == 1:
        select_vertices(walk, paper, 1)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide()
    elif what == 2:
        select_vertices(walk, paper, 1)
        bpy.ops.transform.translate(value=(0.01, 0.0, 0.0))
    elif what == 3:
        call(bpy.ops.object.shade_flat)
    elif what == 4:
        mesh.uv_layers.remove(mesh.uv_layers[0]) if len(mesh.uv_layers) else mesh.uv_layers.new()
    elif what == 5:
        bpy.ops.mesh.primitive_cube_add(size=0.01)
        cube = bpy.context.active_object
        walk.choose(paper, cube)
        call(bpy.ops.object.join)
    else:
        paper.scale = [walk.rng.choice((0.5, 2.0, -1.0)) for _ in range(3)]
        if mesh.users == 1:
            call(bpy.ops.object.transform_apply)
    # An undo step of Edit Mode keeps the geometry and not the mark.
    to_object_mode()


@step(3)
def restore(walk):
    if walk.paper() is not None:
        call(bpy.ops.curvefold.restore_paper)


@step(1)
def make_ordinary(walk):
    if len(walk.papers()) > 1 and walk.paper() is not None:
        call(bpy.ops.curvefold.make_ordinary_mesh)


@step(2)
def hide(walk):
    thing = walk.some(bpy.context.view_layer.objects)
    if thing is not None:
        thing.hide_viewport = not thing.hide_viewport


@step(2)
def place(walk):
    thing = walk.some(bpy.context.view_layer.objects)
    if thing is not None:
        thing.rotation_euler.x = walk.rng.uniform(-1.0, 1.0)
        thing.location.x += walk.rng.uniform(-0.01, 0.01)


@step(2)
def scene(walk):
    to_object_mode()
    bpy.context.window.scene = walk.some(bpy.data.scenes)


@step(1)
def new_scene(walk):
    if len(bpy.data.scenes) < MOST_SCENES and not walk.full():
        to_object_mode()
        bpy.ops.scene.new(type=walk.rng.choice(("NEW", "LINK_COPY", "FULL_COPY")))


@step(1)
def delete_scene(walk):
    to_object_mode()
    call(bpy.ops.scene.delete)


@step(1)
def off_and_on(walk):
    """The extension is switched off; then there are only meshes."""
    to_object_mode()
    addon_utils.disable(walk.addon.package, default_set=True)
    what = walk.rng.randrange(4)
    if what == 0:
        walk.scene.frame_set(walk.rng.randint(1, FRAMES))
    elif what == 1:
        call(bpy.ops.ed.undo)
    elif what == 2:
        path = str(walk.folder / "without.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        bpy.ops.ed.undo_push(message="opened")
    assert addon_utils.enable(walk.addon.package, default_set=True) is not None


# --- the walk -------------------------------------------------------------------------------------------------


def shown(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def check(walk: Walk) -> None:
    """Every paper of the file is whole, and nothing has gone wrong unseen."""
    addon = walk.addon
    assert not addon.live._broken, addon.live._broken
    assert not addon.handlers._said, addon.handlers._said
    changed: dict[int, bytes] = {}
    edited = {thing.data.name for thing in bpy.data.objects if thing.mode != "OBJECT" and thing.data}
    for mesh in bpy.data.meshes:
        if not mesh.curvefold.is_paper:
            continue
        kept = addon.state.load(mesh)
        net = addon.nets.net_of(kept.source)
        assert kept.positions.shape == (len(net.rest), 3), mesh.name
        assert np.isfinite(kept.positions).all(), mesh.name
        report = addon.live.report(mesh)
        assert report is None or (report.sentence and report.state in ("settled", "folding", "trouble"))
        found = addon.live.session(mesh)
        if found is not None:
            assert found.source == kept.source, mesh.name
            assert np.array_equal(found.positions, kept.positions), mesh.name
        if addon.by_hand.is_changed(mesh) and mesh.name not in edited:
            present = shown(mesh).tobytes()
            before = walk.changed.get(mesh.session_uid, present)
            assert present == before or walk.taken[-1] in RESHAPE, f"{mesh.name} was changed by hand"
            changed[mesh.session_uid] = present
        if mesh.name in edited or mesh.shape_keys is not None or TAMPERED in mesh:
            continue
        assert np.array_equal(shown(mesh), net.render_map.apply(kept.positions).astype(np.float32)), mesh.name
    alive = {mesh.session_uid for mesh in bpy.data.meshes}
    lost = alive & walk.changed.keys() - changed.keys()
    assert not lost or edited or walk.taken[-1] in RESHAPE, "what was done by hand is lost"
    walk.changed = changed


def papers_of_file() -> int:
    return sum(mesh.curvefold.is_paper for mesh in bpy.data.meshes)


def begin(walk: Walk, drawing: Path) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    walk.addon.handlers._said.clear()
    item = walk.addon.drawing.add_drawing(walk.addon.solver.read_pattern(drawing), bpy.context.collection)
    walk.choose(item)
    assert bpy.ops.curvefold.make_paper(resolution=8, fold=40.0) == {"FINISHED"}
    bpy.ops.ed.undo_push(message="begin")


def go(walk: Walk, steps: int, said: Callable[[], str]) -> list[str]:
    """Takes the steps; the bits of all papers after each of them."""
    names = sorted(STEP)
    weights = [STEP[name][1] for name in names]
    seen = []
    for _ in range(steps):
        name = walk.rng.choices(names, weights)[0]
        walk.taken.append(name)
        before = papers_of_file()
        try:
            STEP[name][0](walk)
            bpy.context.view_layer.update()
            check(walk)
            assert papers_of_file() >= before or name in TAKE_AWAY, "a paper is lost"
            assert "Traceback" not in (words := said()), words
        except Exception as error:
            words = "".join(traceback.format_exception(error)[-4:])
            raise AssertionError(
                f"{len(walk.taken)} steps, the last {', '.join(walk.taken[-8:])}\n{words}"
            ) from None
        if name not in ("undo", "redo"):
            bpy.ops.ed.undo_push(message=name)
        seen.append(bits())
    return seen


def bits() -> str:
    """Names and exact shapes of all papers."""
    kept = hashlib.sha256()
    for mesh in sorted(bpy.data.meshes, key=lambda mesh: mesh.name):
        if mesh.curvefold.is_paper:
            kept.update(mesh.name.encode() + bytes(mesh["curvefold_positions"]))
    return kept.hexdigest()


@pytest.fixture
def addon(extension, pytestconfig, monkeypatch):
    live = extension("curvefold_addon.live")
    # A drawing need not rest before it is folded anew.
    monkeypatch.setattr(live, "DRAWING_RESTS", 0.0)
    names = ("by_hand", "drawing", "nets", "session", "state")
    bridge = {name: extension(f"curvefold_addon.bridge.{name}") for name in names}
    monkeypatch.setattr(bridge["nets"], "LIVE_VERTICES", VERTICES)
    solver = extension("solver")
    package = solver.__package__.rpartition(".")[0]
    handlers = extension("curvefold_addon.handlers")
    clicking = {"clicks": "click_on_crease", "pick_crease": "pick_crease", "point_angles": "point_angles"}
    clicking = {key: extension(f"curvefold_addon.operators.{name}") for key, name in clicking.items()}
    return SimpleNamespace(live=live, handlers=handlers, solver=solver, package=package, **bridge, **clicking)


@pytest.mark.parametrize("seed", range(SEED, SEED + max(1, STEPS // LENGTH)))
def test_nothing_is_lost_and_nothing_raises(addon, drawing, tmp_path, capfd, seed):
    walk = Walk(random.Random(seed), addon, tmp_path, settled=False)
    begin(walk, drawing)
    go(walk, LENGTH, lambda: capfd.readouterr().err)


@pytest.mark.parametrize("seed", range(SEED, SEED + max(1, STEPS // LENGTH // 4)))
def test_the_same_steps_lead_to_the_same_bits(addon, drawing, tmp_path, capfd, seed):
    seen = []
    for turn in range(2):
        folder = tmp_path / str(turn)
        folder.mkdir()
        walk = Walk(random.Random(1000 + seed), addon, folder, settled=True)
        begin(walk, drawing)
        seen.append(go(walk, REPLAYED, lambda: capfd.readouterr().err))
    differ = [k for k, (one, other) in enumerate(zip(*seen, strict=True)) if one != other]
    assert not differ, f"first after {', '.join(walk.taken[: differ[0] + 1])}"
