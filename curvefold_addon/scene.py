"""A small photo studio around a folded sheet, and the Cycles settings to take its picture."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

import bpy
from mathutils import Vector

from .bridge import framing, pose
from .node_tree import node_tree

#: How high the camera may stand, seen from the paper; which, and from which side, is chosen for each fold.
CAMERA_ELEVATIONS = (radians(34.0), radians(22.0), radians(46.0))
CAMERA_LENS_MM = 70.0
#: Empty border around the paper, relative to its size.
FRAME_MARGIN = 0.12

GROUND_COLOR = (0.30, 0.33, 0.36, 1.0)
#: The ground reaches beyond anything the camera can see.
GROUND_RADII = 60.0

WORLD_COLOR = (0.80, 0.88, 1.0, 1.0)
WORLD_STRENGTH = 0.45

LOOKS = ("AgX - Medium High Contrast", "Medium High Contrast", "None")


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
    Lamp("Key", radians(-122.0), radians(40.0), 4.0, 1.5, 6.0, (1.0, 0.95, 0.88)),
    Lamp("Fill", radians(45.0), radians(30.0), 5.0, 4.0, 0.6, (0.86, 0.92, 1.0)),
)


@dataclass(frozen=True)
class PictureSettings:
    """How a picture is rendered. ``threads`` 0 takes every core."""

    width: int = 960
    height: int = 720
    samples: int = 48
    threads: int = 0


def set_up(paper: bpy.types.Object, settings: PictureSettings) -> None:
    """Lays the paper on the ground of the current scene, lights it, and points a camera at it."""
    scene = bpy.context.scene
    key = LAMPS[0]
    view = pose.lie_down(paper, pose.Studio(CAMERA_ELEVATIONS, key.azimuth, key.elevation))
    bpy.context.view_layer.update()
    extent = framing.extent(paper)
    centre = Vector(extent.centre)

    _render_settings(scene, settings)
    _world(scene)
    _ground(scene, extent.radius)
    for lamp in LAMPS:
        _area_light(scene, lamp, view.azimuth, centre, extent.radius)
    _camera(scene, paper, view, centre, extent.radius)


def render(path: str) -> None:
    """Takes the picture of the current scene into the PNG file at ``path``."""
    scene = bpy.context.scene
    before = scene.render.filepath
    scene.render.filepath = path
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        scene.render.filepath = before


def _render_settings(scene: bpy.types.Scene, settings: PictureSettings) -> None:
    render = scene.render
    render.engine = "CYCLES"
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
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = settings.samples
    cycles.use_adaptive_sampling = True
    cycles.adaptive_threshold = 0.04
    cycles.max_bounces = 4
    cycles.seed = 0
    cycles.use_denoising = True
    try:
        cycles.denoiser = "OPENIMAGEDENOISE"
    except TypeError:  # this Blender was built without it
        cycles.use_denoising = False
    scene.view_settings.view_transform = "AgX"
    for look in LOOKS:
        try:
            scene.view_settings.look = look
            break
        except TypeError:  # the name of this look in another version
            continue


def _world(scene: bpy.types.Scene) -> None:
    world = bpy.data.worlds.new("Studio")
    tree = node_tree(world)
    tree.nodes.clear()
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = WORLD_COLOR
    background.inputs["Strength"].default_value = WORLD_STRENGTH
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    scene.world = world


def _ground(scene: bpy.types.Scene, radius: float) -> None:
    half = GROUND_RADII * radius
    mesh = bpy.data.meshes.new("Ground")
    corners = [(-half, -half, 0.0), (half, -half, 0.0), (half, half, 0.0), (-half, half, 0.0)]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("Ground")
    shader = node_tree(material).nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = GROUND_COLOR
    shader.inputs["Roughness"].default_value = 1.0
    shader.inputs["Specular IOR Level"].default_value = 0.0
    mesh.materials.append(material)
    ground = bpy.data.objects.new("Ground", mesh)
    # A hair below the paper, which lies on z = 0 and may be flat.
    ground.location.z = -2e-4 * radius
    scene.collection.objects.link(ground)


def _area_light(scene: bpy.types.Scene, lamp: Lamp, azimuth: float, centre: Vector, radius: float) -> None:
    light = bpy.data.lights.new(lamp.name, "AREA")
    light.shape = "DISK"
    light.size = lamp.size * radius
    light.color = lamp.color
    distance = lamp.distance * radius
    # A disk of power P gives P / (pi d²) straight ahead at distance d.
    light.energy = lamp.irradiance * pi * distance**2
    direction = _direction(azimuth + lamp.azimuth, lamp.elevation)
    light_object = bpy.data.objects.new(lamp.name, light)
    light_object.location = centre + direction * distance
    light_object.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(light_object)


def _camera(
    scene: bpy.types.Scene, paper: bpy.types.Object, view: pose.View, centre: Vector, radius: float
) -> None:
    camera = bpy.data.cameras.new("Camera")
    camera.lens = CAMERA_LENS_MM
    camera_object = bpy.data.objects.new("Camera", camera)
    direction = _direction(view.azimuth, view.elevation)
    camera_object.location = centre + direction * 10.0 * radius
    camera_object.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(camera_object)
    scene.camera = camera_object
    bpy.context.view_layer.update()

    coordinates = framing.outline_coordinates(paper, FRAME_MARGIN)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera_object.location = camera_object.camera_fit_coords(depsgraph, coordinates)[0]
    distance = (camera_object.location - centre).length
    camera.clip_start = 0.01 * distance
    camera.clip_end = 10.0 * GROUND_RADII * radius


def _direction(azimuth: float, elevation: float) -> Vector:
    return Vector((cos(azimuth) * cos(elevation), sin(azimuth) * cos(elevation), sin(elevation)))
