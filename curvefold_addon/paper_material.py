"""Two-sided paper: another colour on the back, fine fibres, a little light coming through."""

import bpy

from .node_tree import node_tree

NAME = "Curvefold Paper"

Color = tuple[float, float, float, float]

#: Scene-linear colours. The front is the side that looks up when the sheet lies flat.
FRONT: Color = (0.84, 0.81, 0.74, 1.0)
BACK: Color = (0.50, 0.085, 0.045, 1.0)

#: Light that goes through; copy paper lets through about a tenth.
TRANSLUCENCY = 0.10
ROUGHNESS = 0.85
#: Fibres across the sheet. Relative to the sheet, so that a stamp and a poster look like the same paper.
FIBRES = 420.0
CLOUDS = 28.0
FIBRE_RELIEF = 0.10
#: How much the cloudiness of the pulp lightens and darkens the colour.
CLOUD_CONTRAST = 0.05

Node = bpy.types.Node
Socket = bpy.types.NodeSocket


def paper_material(front: Color = FRONT, back: Color = BACK) -> bpy.types.Material:
    """The paper, made when it is not in the file yet."""
    material = bpy.data.materials.get(NAME)
    if material is None:
        material = bpy.data.materials.new(NAME)
        _build(material, front, back)
    return material


def _build(material: bpy.types.Material, front: Color, back: Color) -> None:
    material.diffuse_color = front
    tree = node_tree(material)
    nodes, link = tree.nodes, tree.links.new
    nodes.clear()

    geometry = nodes.new("ShaderNodeNewGeometry")
    # "Generated" runs from 0 to 1 across the object, whatever its size.
    coordinates = nodes.new("ShaderNodeTexCoord")
    fibres = _noise(tree, coordinates.outputs["Generated"], FIBRES, detail=3.0)
    clouds = _noise(tree, coordinates.outputs["Generated"], CLOUDS, detail=4.0)

    sides = _mix(tree, "MIX", geometry.outputs["Backfacing"], front, back)
    shade = nodes.new("ShaderNodeMapRange")
    shade.inputs["To Min"].default_value = 1.0 - CLOUD_CONTRAST
    shade.inputs["To Max"].default_value = 1.0 + CLOUD_CONTRAST
    link(clouds, shade.inputs["Value"])
    tinted = nodes.new("ShaderNodeVectorMath")
    tinted.operation = "SCALE"
    link(sides, tinted.inputs[0])
    link(shade.outputs["Result"], tinted.inputs["Scale"])
    color = tinted.outputs["Vector"]

    bump = nodes.new("ShaderNodeBump")
    bump.inputs["Strength"].default_value = FIBRE_RELIEF
    bump.inputs["Distance"].default_value = 0.001
    link(fibres, bump.inputs["Height"])

    surface = nodes.new("ShaderNodeBsdfPrincipled")
    surface.inputs["Roughness"].default_value = ROUGHNESS
    surface.inputs["Specular IOR Level"].default_value = 0.2
    link(color, surface.inputs["Base Color"])
    link(bump.outputs["Normal"], surface.inputs["Normal"])

    # What shines through has passed the ink of both sides, so it has one hue on either side.
    through = nodes.new("ShaderNodeBsdfTranslucent")
    through.inputs["Color"].default_value = tuple(0.7 * f + 0.3 * b for f, b in zip(front, back, strict=True))

    paper = nodes.new("ShaderNodeMixShader")
    paper.inputs["Fac"].default_value = TRANSLUCENCY
    link(surface.outputs["BSDF"], paper.inputs[1])
    link(through.outputs["BSDF"], paper.inputs[2])
    output = nodes.new("ShaderNodeOutputMaterial")
    link(paper.outputs["Shader"], output.inputs["Surface"])


def _noise(tree: bpy.types.NodeTree, vector: Socket, scale: float, detail: float) -> Socket:
    node = tree.nodes.new("ShaderNodeTexNoise")
    node.inputs["Scale"].default_value = scale
    node.inputs["Detail"].default_value = detail
    tree.links.new(vector, node.inputs["Vector"])
    return node.outputs["Fac"]


def _mix(tree: bpy.types.NodeTree, blend: str, factor: Socket, first: Color, second: Color) -> Socket:
    node = tree.nodes.new("ShaderNodeMix")
    node.data_type = "RGBA"
    node.blend_type = blend
    # The node has sockets of one name for every data type; the identifiers tell them apart.
    inputs = {socket.identifier: socket for socket in node.inputs}
    inputs["A_Color"].default_value = first
    inputs["B_Color"].default_value = second
    tree.links.new(factor, inputs["Factor_Float"])
    return next(socket for socket in node.outputs if socket.identifier == "Result_Color")
