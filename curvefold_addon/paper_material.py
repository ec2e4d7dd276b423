"""Two-sided paper: another colour on the back, fine fibres, a little light coming through.

The colours are plain inputs of two Principled shaders, multiplied by the grain: that is what exporters understand.
glTF has one colour for both sides, that of the first Principled shader. Up to 5.1 that is the one that was made
first; later the exporter follows the links, and begins with the last input of a node.
"""

import bpy

from .bridge.mesh import PRINT_UV
from .node_tree import node_tree

NAME = "Curvefold Paper"
#: Of the inner side of paper with a thickness, where both sides are fronts.
BACK_NAME = "Curvefold Paper Back"

Color = tuple[float, float, float, float]

#: Scene-linear colours. The front is the side that looks up when the sheet lies flat.
FRONT: Color = (0.86, 0.82, 0.75, 1.0)
BACK: Color = (0.78, 0.19, 0.08, 1.0)

#: Light that goes through; copy paper lets through about a tenth, thin paper a quarter.
TRANSLUCENCY = 0.18
ROUGHNESS = 0.8
SPECULAR = 0.25
#: Grains, fibres and clouds of the pulp across the sheet. Relative to it: a stamp and a poster look alike.
GRAINS, FIBRES, CLOUDS = 380.0, 60.0, 22.0
#: Fibres are so many times as long as they are wide, and lie at this angle to the sheet (radians).
FIBRE_LENGTH, FIBRE_ANGLE = 6.0, 0.5
#: How far each lightens and darkens the colour.
GRAIN_CONTRAST, FIBRE_CONTRAST, CLOUD_CONTRAST = 0.06, 0.03, 0.03
#: What of the relief is felt in the shading, and how deep it is, metres.
RELIEF, RELIEF_DEPTH = 0.24, 0.0004

Node = bpy.types.Node
Socket = bpy.types.NodeSocket
Tree = bpy.types.NodeTree


def paper_material(front: Color = FRONT, back: Color = BACK) -> bpy.types.Material:
    """The paper, made when it is not in the file yet."""
    return bpy.data.materials.get(NAME) or _new(NAME, front, back)


def back_material(back: Color = BACK) -> bpy.types.Material:
    """Paper that has the colour of the back on both sides, made when it is not in the file yet."""
    return bpy.data.materials.get(BACK_NAME) or _new(BACK_NAME, back, back)


def _new(name: str, front: Color, back: Color) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    material.diffuse_color = front
    tree = node_tree(material)
    nodes, link = tree.nodes, tree.links.new
    nodes.clear()

    place = nodes.new("ShaderNodeUVMap")
    place.uv_map = PRINT_UV
    along = nodes.new("ShaderNodeMapping")
    along.inputs["Rotation"].default_value[2] = FIBRE_ANGLE
    along.inputs["Scale"].default_value = (1.0, FIBRE_LENGTH, 1.0)
    link(place.outputs["UV"], along.inputs["Vector"])
    grains = _noise(tree, place.outputs["UV"], GRAINS, detail=2.0)
    fibres = _noise(tree, along.outputs["Vector"], FIBRES, detail=1.0, distortion=1.5)
    clouds = _noise(tree, place.outputs["UV"], CLOUDS, detail=3.0)
    shade = _sum(
        tree,
        _sum(tree, _around(tree, grains, 1.0, GRAIN_CONTRAST), _around(tree, fibres, 0.0, FIBRE_CONTRAST)),
        _around(tree, clouds, 0.0, CLOUD_CONTRAST),
    )
    bump = nodes.new("ShaderNodeBump")
    bump.inputs["Strength"].default_value = RELIEF
    bump.inputs["Distance"].default_value = RELIEF_DEPTH
    link(_sum(tree, grains, fibres), bump.inputs["Height"])

    sides = nodes.new("ShaderNodeMixShader")
    facing = nodes.new("ShaderNodeMath")
    facing.operation = "SUBTRACT"
    facing.inputs[0].default_value = 1.0
    link(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], facing.inputs[1])
    link(facing.outputs["Value"], sides.inputs["Fac"])
    for slot, color in ((2, front), (1, back)):
        link(_surface(tree, color, shade, bump.outputs["Normal"]), sides.inputs[slot])

    # What shines through has passed the ink of both sides, so it has one hue on either side.
    through = nodes.new("ShaderNodeBsdfTranslucent")
    through.inputs["Color"].default_value = tuple(0.7 * f + 0.3 * b for f, b in zip(front, back, strict=True))
    paper = nodes.new("ShaderNodeMixShader")
    paper.inputs["Fac"].default_value = TRANSLUCENCY
    link(sides.outputs["Shader"], paper.inputs[1])
    link(through.outputs["BSDF"], paper.inputs[2])
    output = nodes.new("ShaderNodeOutputMaterial")
    link(paper.outputs["Shader"], output.inputs["Surface"])
    return material


def _surface(tree: Tree, color: Color, shade: Socket, normal: Socket) -> Socket:
    tinted = tree.nodes.new("ShaderNodeMix")
    tinted.data_type = "RGBA"
    tinted.blend_type = "MULTIPLY"
    # The node has sockets of one name for every data type; the identifiers tell them apart.
    inputs = {socket.identifier: socket for socket in tinted.inputs}
    inputs["Factor_Float"].default_value = 1.0
    inputs["A_Color"].default_value = color
    tree.links.new(shade, inputs["B_Color"])
    result = next(socket for socket in tinted.outputs if socket.identifier == "Result_Color")
    surface = tree.nodes.new("ShaderNodeBsdfPrincipled")
    surface.inputs["Roughness"].default_value = ROUGHNESS
    surface.inputs["Specular IOR Level"].default_value = SPECULAR
    tree.links.new(result, surface.inputs["Base Color"])
    tree.links.new(normal, surface.inputs["Normal"])
    return surface.outputs["BSDF"]


def _noise(tree: Tree, vector: Socket, scale: float, detail: float, distortion: float = 0.0) -> Socket:
    node = tree.nodes.new("ShaderNodeTexNoise")
    node.noise_dimensions = "2D"
    node.inputs["Scale"].default_value = scale
    node.inputs["Detail"].default_value = detail
    node.inputs["Distortion"].default_value = distortion
    tree.links.new(vector, node.inputs["Vector"])
    return node.outputs[0]  # "Fac", "Factor" in some versions


def _around(tree: Tree, noise: Socket, middle: float, contrast: float) -> Socket:
    """A noise, which lies mostly between 0.25 and 0.75, as ``middle`` give or take ``contrast``."""
    node = tree.nodes.new("ShaderNodeMapRange")
    node.inputs["From Min"].default_value, node.inputs["From Max"].default_value = 0.25, 0.75
    node.inputs["To Min"].default_value, node.inputs["To Max"].default_value = middle - contrast, middle + contrast
    tree.links.new(noise, node.inputs["Value"])
    return node.outputs["Result"]


def _sum(tree: Tree, first: Socket, second: Socket) -> Socket:
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = "ADD"
    tree.links.new(first, node.inputs[0])
    tree.links.new(second, node.inputs[1])
    return node.outputs["Value"]
