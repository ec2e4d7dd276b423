"""What tests of papers in Blender look at, and how they make and select what they need."""

import bmesh
import bpy
from mathutils import Vector


def shape(mesh: bpy.types.Mesh) -> bytes:
    """The exact shape that is kept with a paper."""
    return bytes(mesh["curvefold_positions"])


def rests(live, paper: bpy.types.Object) -> bool:
    """Whether there is nothing left to fold."""
    before = shape(paper.data)
    live.settle(paper.data)
    return shape(paper.data) == before


def paper_of(extension, folder, svg: str, **options: object) -> bpy.types.Object:
    """A paper of a drawing, active; the options are those of Make Paper."""
    path = folder / "drawing.svg"
    path.write_text(svg)
    pattern = extension("solver").read_pattern(path)
    sheet = extension("curvefold_addon.bridge.drawing").add_drawing(pattern, bpy.context.collection)
    bpy.context.view_layer.objects.active = sheet
    assert bpy.ops.curvefold.make_paper(**options) == {"FINISHED"}
    return bpy.context.active_object


def edit(paper: bpy.types.Object):
    """Edit Mode with nothing selected; its BMesh, to be kept as long as the flat places of its vertices."""
    bpy.context.view_layer.objects.active = paper
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    edited = bmesh.from_edit_mesh(paper.data)
    layer = edited.loops.layers.uv["flat"]
    return edited, {v: v.link_loops[0][layer].uv.copy() for v in edited.verts if v.link_loops}


def select_vertices(paper: bpy.types.Object, *places: tuple[float, float]) -> None:
    """Edit Mode with the vertices selected that are nearest to these flat places."""
    _edited, flat = edit(paper)
    for place in places:
        min(flat, key=lambda v: (flat[v] - Vector(place)).length).select = True
    bmesh.update_edit_mesh(paper.data)
