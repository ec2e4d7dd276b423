"""Plain materials of lines that are kept as objects."""

from collections.abc import Iterable

import bpy
from mathutils import Color

from .bridge import line_objects
from .node_tree import node_tree

ROUGHNESS = 0.6


def of_rulings() -> list[bpy.types.Material]:
    """One for each kind of ruling."""
    return _materials(line_objects.RULING_LOOKS)


def of_gauss_images() -> list[bpy.types.Material]:
    """One for each patch in turn, and the ball's."""
    return _materials((*line_objects.PATCH_LOOKS, line_objects.BALL_LOOK))


def _materials(looks: Iterable[line_objects.Look]) -> list[bpy.types.Material]:
    return [bpy.data.materials.get(name) or _new(name, color) for name, color in looks]


def _new(name: str, display: tuple[float, float, float, float]) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    color = (*Color(display[:3]).from_srgb_to_scene_linear(), 1.0)
    material.diffuse_color = color
    tree = node_tree(material)
    tree.nodes.clear()
    surface = tree.nodes.new("ShaderNodeBsdfPrincipled")
    surface.inputs["Base Color"].default_value = color
    surface.inputs["Roughness"].default_value = ROUGHNESS
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    return material
