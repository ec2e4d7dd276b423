"""The photo studio in a scene that is somebody's: what was there is put aside, kept, and comes back.

What is needed for that lies on the studio's collection, so that a saved file has it too.
"""

from collections.abc import Callable, Iterator, Sequence
from math import pi

import bpy

from . import live, paper_material, scene
from .bridge import baking, framing, hooks, linked
from .bridge.pose import View

#: Marks objects that are not rendered because of the picture.
_ASIDE = "curvefold_aside"
_CAMERA, _WORLD, _SETTINGS = "camera_before", "world_before", "settings_before"
#: Where the camera stands, radians, and whether it goes round.
_VIEW, _TURNS = "view", "turns"
THICKNESS = "Curvefold Thickness"
TURNTABLE = "Turntable"

#: What the picture sets that is the user's. They are restored in this order.
_KEPT = (
    "render.engine",
    "cycles.samples",
    "cycles.use_adaptive_sampling",
    "cycles.adaptive_threshold",
    "cycles.max_bounces",
    "cycles.use_denoising",
    "cycles.denoiser",
    "cycles.denoising_input_passes",
    "cycles.denoising_prefilter",
    "eevee.taa_render_samples",
    "eevee.use_raytracing",
    "view_settings.view_transform",
    "view_settings.look",
    "view_settings.exposure",
    "view_settings.gamma",
)

Progress = Callable[[int, int], None]


def set_up(
    target: bpy.types.Scene,
    papers: Sequence[bpy.types.Object],
    stays: Sequence[bpy.types.Object],
    engine: str,
    samples: int,
    progress: Progress,
) -> None:
    """Builds the studio round papers as they stand; the first is who is looked at. What is there is set anew.

    stays: objects that are rendered too; engine: CYCLES or EEVEE; progress: frames done, of all
    """
    motion = watch(target, papers, progress)
    if motion.is_empty:
        return
    home = _home(target)
    view = motion.best_view(scene.STUDIO)
    home[_VIEW] = (view.azimuth, view.elevation)
    if engine == scene.CYCLES:
        scene.cycles_settings(target, samples)
    else:
        scene.eevee_settings(target, samples)
    scene.color_settings(target)
    _frame(target, home, view, motion)
    _put_aside(target, home, [*papers, *stays])
    for paper in papers:
        if not paper.material_slots and linked.is_local(paper.data):
            paper.data.materials.append(paper_material.paper_material())


def turn_round(target: bpy.types.Scene, papers: Sequence[bpy.types.Object], progress: Progress) -> None:
    """Lets camera and light of the picture go round the papers once, over the frames of the scene."""
    _home(target)[_TURNS] = True
    reframe(target, papers, progress)


def reframe(target: bpy.types.Scene, papers: Sequence[bpy.types.Object], progress: Progress) -> None:
    """The camera of the picture holds all frames of the papers again, from where it looks."""
    home = scene.find_home(target)
    if home is None or _VIEW not in home:
        return
    motion = watch(target, papers, progress)
    if not motion.is_empty:
        _frame(target, home, View(*home[_VIEW]), motion)


def remove(target: bpy.types.Scene, papers: Sequence[bpy.types.Object]) -> None:
    """Takes the studio away and gives the scene back what it had."""
    home = scene.find_home(target)
    if home is None:
        return
    _bring_back(target)
    target.camera, target.world = home.get(_CAMERA), home.get(_WORLD)
    if _SETTINGS in home:  # the command line builds it in a scene that had nothing
        _restore(target, home[_SETTINGS].to_dict())
    for paper in papers:
        modifier = paper.modifiers.get(THICKNESS)
        if modifier is not None:
            paper.modifiers.remove(modifier)
    for item in list(home.objects):
        if scene.ROLE in item:
            _remove_item(item)
        elif item.users_collection[:] == (home,):
            target.collection.objects.link(item)
    for child in home.children:
        target.collection.children.link(child)
    bpy.data.collections.remove(home)


def thicken(paper: bpy.types.Object, thickness: float) -> None:
    """Paper of a thickness, metres; of none for 0. The front stays where it is."""
    modifier = paper.modifiers.get(THICKNESS)
    if thickness == 0.0:
        if modifier is not None:
            paper.modifiers.remove(modifier)
        return
    if modifier is None:
        modifier = paper.modifiers.new(THICKNESS, "SOLIDIFY")
    modifier.thickness = thickness
    modifier.offset = -1.0
    modifier.use_even_offset = True
    slots = paper.data.materials
    if linked.is_local(paper.data) and len(slots) == 1 and slots[0] == bpy.data.materials.get(paper_material.NAME):
        slots.append(paper_material.back_material())
    # Both sides of a shell are fronts: the inner one has a material of its own.
    modifier.material_offset = 1 if len(slots) == 2 and slots[1] == _back() else 0


def watch(target: bpy.types.Scene, papers: Sequence[bpy.types.Object], progress: Progress) -> framing.Motion:
    """The shapes of papers in all frames of a film; the present one where nothing is animated."""
    motion = framing.Motion()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    if not any(_is_film(paper) for paper in papers):
        for paper in papers:
            motion.add(paper, depsgraph)
        return motion
    present = target.frame_current
    kept = [live.keep_shape(paper) for paper in papers]
    frames = range(target.frame_start, target.frame_end + 1)
    try:
        for done, frame in enumerate(frames):
            # Every frame in its turn: the shape depends on the way.
            target.frame_set(frame)
            progress(done, len(frames))
            depsgraph = bpy.context.evaluated_depsgraph_get()
            for paper in papers:
                motion.add(paper, depsgraph)
    finally:
        target.frame_set(present)
        for put_back in kept:
            put_back()
    return motion


def _is_film(paper: bpy.types.Object) -> bool:
    return hooks.is_animated(paper) or baking.is_baked(paper.data)


def _back() -> bpy.types.Material | None:
    return bpy.data.materials.get(paper_material.BACK_NAME)


def _home(target: bpy.types.Scene) -> bpy.types.Collection:
    """The studio's collection; it keeps what the scene has when it is made."""
    home = scene.find_home(target)
    if home is None:
        home = scene.home_of(target)
        if target.camera is not None:
            home[_CAMERA] = target.camera
        if target.world is not None:
            home[_WORLD] = target.world
        home[_SETTINGS] = {path: _read(target, path) for path in _KEPT if _has(target, path)}
    return home


def _frame(target: bpy.types.Scene, home: bpy.types.Collection, view: View, motion: framing.Motion) -> None:
    turns = bool(home.get(_TURNS, False))
    for item in _turning(home):
        item.parent = None
    scene.build(target, home, view, motion.points, turns)
    if turns:
        _turn(target, home, framing.extent(motion.points).centre)


def _turn(target: bpy.types.Scene, home: bpy.types.Collection, centre: tuple[float, float, float]) -> None:
    """Hangs camera and lights on an empty that turns once, over the frames of the scene."""
    pivot = scene.item_of(home, TURNTABLE, lambda name: None)
    pivot.animation_data_clear()
    pivot.location, pivot.rotation_euler = centre, (0.0, 0.0, 0.0)
    bpy.context.view_layer.update()
    for item in _turning(home):
        item.parent = pivot
        item.matrix_parent_inverse = pivot.matrix_world.inverted()
    # Whole a frame after the last one, so that the film can go on and on.
    for frame, turn in ((target.frame_start, 0.0), (target.frame_end + 1, 2.0 * pi)):
        pivot.rotation_euler.z = turn
        pivot.keyframe_insert("rotation_euler", index=2, frame=frame)
    baking.make_linear(pivot)
    # Where it is in the present frame; asking for the frame itself would move the papers on.
    part = (target.frame_current - target.frame_start) / (target.frame_end + 1 - target.frame_start)
    pivot.rotation_euler.z = 2.0 * pi * part


def _turning(home: bpy.types.Collection) -> list[bpy.types.Object]:
    """Camera and lights of the picture."""
    return [item for item in home.objects if scene.ROLE in item and item.type in ("CAMERA", "LIGHT")]


def _put_aside(target: bpy.types.Scene, home: bpy.types.Collection, stays: Sequence[bpy.types.Object]) -> None:
    _bring_back(target)
    for item in target.objects:
        shown = item.hide_render or item.name in home.all_objects or any(above in stays for above in _line(item))
        if not shown and linked.is_local(item):
            item.hide_render = True
            item[_ASIDE] = True


def _bring_back(target: bpy.types.Scene) -> None:
    for item in target.objects:
        if _ASIDE in item and linked.is_local(item):
            item.hide_render = False
            del item[_ASIDE]


def _line(item: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """An object and those above it."""
    above: bpy.types.Object | None = item
    while above is not None:
        yield above
        above = above.parent


def _remove_item(item: bpy.types.Object) -> None:
    data = item.data
    materials = list(data.materials) if isinstance(data, bpy.types.Mesh) else []
    bpy.data.objects.remove(item)
    if data is not None and data.users == 0:
        bpy.data.batch_remove([data])
    bpy.data.batch_remove([material for material in materials if material.users == 0])


def _has(target: bpy.types.Scene, path: str) -> bool:
    group, _, name = path.partition(".")
    return hasattr(getattr(target, group, None), name)


def _read(target: bpy.types.Scene, path: str) -> object:
    group, _, name = path.partition(".")
    return getattr(getattr(target, group), name)


def _restore(target: bpy.types.Scene, values: dict[str, object]) -> None:
    for path in _KEPT:
        if path in values and _has(target, path):
            group, _, name = path.partition(".")
            kind = type(_read(target, path))
            try:
                setattr(getattr(target, group), name, kind(values[path]))
            except TypeError:  # a choice that this Blender does not have
                continue
