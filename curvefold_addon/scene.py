"""A small photo studio around folded sheets: floor, warm light, a camera, and the settings to take the picture."""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, radians, sin

import bpy
from mathutils import Vector

from .bridge import framing, pose
from .node_tree import node_tree

#: The collection of all that belongs to the studio. Its objects are known by their roles, whatever they are called.
COLLECTION = "Curvefold Picture"
ROLE = "curvefold_role"

#: How high the camera may stand, seen from the paper; which, and from which side, is chosen for each fold.
CAMERA_ELEVATIONS = (radians(34.0), radians(22.0), radians(46.0))
CAMERA_LENS_MM = 85.0
#: Empty border around the paper, relative to its size.
FRAME_MARGIN = 0.18

#: Scene-linear.
GROUND_COLOR = (0.46, 0.33, 0.23, 1.0)
#: The ground reaches beyond anything the camera can see.
GROUND_RADII = 80.0

WORLD_COLOR = (1.0, 0.95, 0.90, 1.0)
WORLD_STRENGTH = 0.5

#: View transform and look, the best that a Blender has: whites that stay white, colours that stay warm.
VIEWS = (("Khronos PBR Neutral", "None"), ("AgX", "AgX - Medium High Contrast"), ("Standard", "None"))

CYCLES = "CYCLES"
#: EEVEE's name from 5.0 on, and before.
EEVEE = ("BLENDER_EEVEE", "BLENDER_EEVEE_NEXT")


@dataclass(frozen=True)
class Lamp:
    """An area light, placed and sized in units of the paper's radius.

    azimuth     relative to the camera's, so that light and camera turn around the paper together
    irradiance  what falls on the paper, before its slant (W/m²); about 3 makes white paper white
    """

    name: str
    azimuth: float
    elevation: float
    distance: float
    size: float
    irradiance: float
    color: tuple[float, float, float]


LAMPS = (
    # Low from the side: it shows the grain, and its size makes shadows that are crisp near the paper only.
    Lamp("Key", radians(-78.0), radians(33.0), 6.0, 0.6, 3.7, (1.0, 0.90, 0.76)),
)

STUDIO = pose.Studio(CAMERA_ELEVATIONS, LAMPS[0].azimuth, LAMPS[0].elevation)


@dataclass(frozen=True)
class PictureSettings:
    """How a picture is rendered. ``threads`` 0 takes every core."""

    width: int = 1600
    height: int = 1000
    samples: int = 24
    threads: int = 0


def set_up(paper: bpy.types.Object, settings: PictureSettings) -> None:
    """Lays the paper on the ground of the current scene, lights it, and points a camera at it."""
    scene = bpy.context.scene
    view = pose.lie_down(paper, STUDIO)
    bpy.context.view_layer.update()
    motion = framing.Motion()
    motion.add(paper, bpy.context.evaluated_depsgraph_get())

    _output_settings(scene, settings)
    cycles_settings(scene, settings.samples)
    color_settings(scene)
    build(scene, home_of(scene), view, motion.points)


def build(
    scene: bpy.types.Scene, home: bpy.types.Collection, view: pose.View, points: framing.Array, turns: bool = False
) -> None:
    """Floor, lights, world and camera around points (N,3) in the world; what is there already is set anew.

    turns: whether the camera is to hold them from all sides
    """
    extent = framing.extent(points)
    centre = Vector(extent.centre)
    _world(scene)
    _ground(home, extent)
    for lamp in LAMPS:
        _area_light(home, lamp, view.azimuth, centre, extent.radius)
    _camera(scene, home, view, framing.turned_round(points) if turns else points)


def home_of(scene: bpy.types.Scene) -> bpy.types.Collection:
    """The studio's collection in a scene, made when it is missing."""
    home = find_home(scene)
    if home is None:
        home = bpy.data.collections.new(COLLECTION)
        home[ROLE] = COLLECTION
        scene.collection.children.link(home)
    return home


def find_home(scene: bpy.types.Scene) -> bpy.types.Collection | None:
    """The studio's collection in a scene; None where there is none."""
    return next((found for found in scene.collection.children_recursive if ROLE in found), None)


def item_of(
    home: bpy.types.Collection, role: str, make: Callable[[str], bpy.types.ID | None] | None = None
) -> bpy.types.Object | None:
    """The studio's object of a role. Where it is missing it is made, with the data that ``make`` makes."""
    found = next((item for item in home.objects if item.get(ROLE) == role), None)
    if found is None and make is not None:
        found = bpy.data.objects.new(role, make(role))
        found[ROLE] = role
        home.objects.link(found)
    return found


def render(path: str) -> None:
    """Takes the picture of the current scene into the PNG file at ``path``."""
    scene = bpy.context.scene
    before = scene.render.filepath
    scene.render.filepath = path
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        scene.render.filepath = before


def use_eevee(scene: bpy.types.Scene) -> None:
    """Renders with EEVEE, whatever this Blender calls it."""
    for name in EEVEE:
        try:
            scene.render.engine = name
        except TypeError:
            continue
        return


def cycles_settings(scene: bpy.types.Scene, samples: int) -> None:
    """Renders with Cycles: few samples, denoised with the grain of the paper left in."""
    scene.render.engine = CYCLES
    cycles = scene.cycles
    cycles.samples = samples
    cycles.use_adaptive_sampling = True
    cycles.adaptive_threshold = 0.02
    cycles.max_bounces = 4
    cycles.use_denoising = True
    try:
        cycles.denoiser = "OPENIMAGEDENOISE"
        cycles.denoising_input_passes = "RGB_ALBEDO_NORMAL"
        cycles.denoising_prefilter = "ACCURATE"
    except TypeError:  # this Blender was built without it
        cycles.use_denoising = False


def eevee_settings(scene: bpy.types.Scene, samples: int) -> None:
    """Renders with EEVEE, with light that bounces off the paper."""
    use_eevee(scene)
    scene.eevee.taa_render_samples = samples
    scene.eevee.use_raytracing = True


def color_settings(scene: bpy.types.Scene) -> None:
    """The view transform and look of the picture."""
    settings = scene.view_settings
    for transform, look in VIEWS:
        try:
            settings.view_transform = transform
            settings.look = look
        except TypeError:  # another version has others
            continue
        break
    settings.exposure, settings.gamma = 0.0, 1.0


def _output_settings(scene: bpy.types.Scene, settings: PictureSettings) -> None:
    render = scene.render
    render.resolution_x = settings.width
    render.resolution_y = settings.height
    render.resolution_percentage = 100
    render.image_settings.file_format = "PNG"
    render.image_settings.color_mode = "RGB"
    render.filepath = "//picture.png"
    render.use_file_extension = False
    if settings.threads > 0:
        render.threads_mode = "FIXED"
        render.threads = settings.threads
    scene.cycles.device = "CPU"
    scene.cycles.seed = 0


def _world(scene: bpy.types.Scene) -> None:
    world = next((found for found in bpy.data.worlds if found.get(ROLE) == COLLECTION), None)
    if world is None:
        world = bpy.data.worlds.new("Studio")
        world[ROLE] = COLLECTION
    tree = node_tree(world)
    tree.nodes.clear()
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = WORLD_COLOR
    background.inputs["Strength"].default_value = WORLD_STRENGTH
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    scene.world = world


def _ground(home: bpy.types.Collection, extent: framing.Extent) -> None:
    ground = item_of(home, "Floor", _floor_mesh)
    half = GROUND_RADII * extent.radius
    ground.scale = (half, half, 1.0)
    # A hair below the paper, which may be flat.
    ground.location = (extent.centre[0], extent.centre[1], extent.floor - 2e-4 * extent.radius)


def _floor_mesh(name: str) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    corners = [(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new(name)
    material.diffuse_color = GROUND_COLOR
    shader = node_tree(material).nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = GROUND_COLOR
    shader.inputs["Roughness"].default_value = 0.9
    shader.inputs["Specular IOR Level"].default_value = 0.1
    mesh.materials.append(material)
    return mesh


def _area_light(home: bpy.types.Collection, lamp: Lamp, azimuth: float, centre: Vector, radius: float) -> None:
    item = item_of(home, lamp.name, lambda name: bpy.data.lights.new(name, "AREA"))
    light = item.data
    light.shape = "DISK"
    light.size = lamp.size * radius
    light.color = lamp.color
    distance = lamp.distance * radius
    # A disk of power P gives P / (pi d²) straight ahead at distance d.
    light.energy = lamp.irradiance * pi * distance**2
    _place(item, centre, _direction(azimuth + lamp.azimuth, lamp.elevation), distance)


def _camera(scene: bpy.types.Scene, home: bpy.types.Collection, view: pose.View, points: framing.Array) -> None:
    item = item_of(home, "Camera", bpy.data.cameras.new)
    camera = item.data
    camera.lens = CAMERA_LENS_MM
    extent = framing.extent(points)
    centre = Vector(extent.centre)
    direction = _direction(view.azimuth, view.elevation)
    _place(item, centre, direction, 10.0 * extent.radius)
    scene.camera = item
    bpy.context.view_layer.update()

    depsgraph = bpy.context.evaluated_depsgraph_get()
    item.location = item.camera_fit_coords(depsgraph, framing.grown(points, FRAME_MARGIN))[0]
    camera.clip_start = 0.01 * (item.location - centre).length
    camera.clip_end = 10.0 * GROUND_RADII * extent.radius


def _place(item: bpy.types.Object, centre: Vector, direction: Vector, distance: float) -> None:
    item.location = centre + direction * distance
    item.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()


def _direction(azimuth: float, elevation: float) -> Vector:
    return Vector((cos(azimuth) * cos(elevation), sin(azimuth) * cos(elevation), sin(elevation)))
