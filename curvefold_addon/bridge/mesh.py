"""A folded sheet as a Blender mesh: quads and n-gons, the flat sheet as UVs, creases marked.

What is marked here belongs to the net; what belongs to its shape is in ``mesh_attributes``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solver.net.carry_over import scaled
from . import by_hand, mesh_layers

if TYPE_CHECKING:
    from ...solver import FoldResult, RenderMap

#: The UV map that holds the flat sheet in metres.
FLAT_UV = "flat"
#: The UV map in which the sheet's box is 0 to 1 both ways: an image fills the sheet. New papers are textured by it.
PRINT_UV = "print"
#: Face attribute: the patch (a piece of the sheet between creases) a face belongs to.
PATCH = "patch"
#: Edge attribute: the crease an edge lies on, NO_CREASE elsewhere.
CREASE = "crease"
#: Edge attribute: whether an edge lies on a crease.
ON_CREASE = "on_crease"
NO_CREASE = -1
#: Blender's own attributes: how sharp an edge, or a vertex, stays under Subdivision (0 to 1), ...
CREASE_EDGE, _CREASE_VERTEX = "crease_edge", "crease_vert"
#: ... and whether shading breaks there.
_SHARP_EDGE = "sharp_edge"
#: Attributes of the net's shape, see ``mesh_attributes``.
FOLD_ANGLE, ASSIGNMENT, STRETCH, RULING = "fold_angle", "assignment", "stretch", "ruling"
SHAPE_ATTRIBUTES = (FOLD_ANGLE, ASSIGNMENT, STRETCH, RULING)
_OURS = frozenset(
    {FLAT_UV, PRINT_UV, PATCH, CREASE, ON_CREASE, CREASE_EDGE, _CREASE_VERTEX, _SHARP_EDGE, *SHAPE_ATTRIBUTES}
)
#: Where a border or a crease turns by more than this, Subdivision keeps the corner, degrees.
_CORNER = 30.0

#: A drawing that does not say how large it is, is taken to be in millimetres.
DEFAULT_UNIT_MM = 1.0


def metres_per_unit(unit_mm: float | None) -> float:
    """Metres in one drawing unit."""
    return (DEFAULT_UNIT_MM if unit_mm is None else unit_mm) / 1000.0


def add_paper(result: FoldResult, collection: Any, material: Any) -> Any:
    """A new object of the folded sheet in ``collection``, in true scale."""
    return add_object(build_mesh(result), collection, material)


def add_object(mesh: Any, collection: Any, material: Any) -> Any:
    """A new object of a paper's mesh in ``collection``."""
    if material is not None:
        mesh.materials.append(material)
    paper = bpy.data.objects.new(mesh.name, mesh)
    collection.objects.link(paper)
    return paper


def build_mesh(result: FoldResult) -> Any:
    """A new mesh datablock of the folded sheet, in metres."""
    scale = metres_per_unit(result.pattern.unit_mm)
    mesh = bpy.data.meshes.new(result.pattern.name or "Paper")
    fill(mesh, scaled(result.net, scale).render_map, result.positions * scale)
    return mesh


def fill(mesh: Any, surface: RenderMap, positions: NDArray[np.float64]) -> None:
    """Gives a mesh the geometry of a net at positions (V,3) in place of its own; the flat sheet becomes its UVs.

    What users have put on the old geometry is carried over by its place on the flat sheet (``mesh_layers``).
    """
    theirs = mesh_layers.read(mesh, FLAT_UV, PATCH, _OURS)
    with_rulings = RULING in mesh.attributes
    chosen = mesh_layers.chosen_maps(mesh)
    mesh.clear_geometry()
    corners = np.asarray(surface.face_vertices, dtype=np.int32)
    starts = np.asarray(surface.face_start[:-1], dtype=np.int32)
    shown = surface.apply(positions)

    mesh.vertices.add(len(shown))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(starts))
    mesh.polygons.foreach_set("loop_start", starts)
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.update(calc_edges=True)
    write_positions(mesh, shown)

    mark(mesh, surface)
    if theirs is not None:
        mesh_layers.write(mesh, FLAT_UV, theirs)
    if chosen is not None:
        mesh_layers.choose_maps(mesh, chosen)
    if with_rulings:
        attribute(mesh, RULING, "FLOAT_VECTOR", "FACE")  # they are asked for; what they are is found later
    mesh.update()
    by_hand.note(mesh)


def mark(mesh: Any, surface: RenderMap) -> None:
    """Gives a mesh with the geometry of a net the flat sheet as its UVs, and its patches and creases."""
    corners = surface.uv[np.asarray(surface.face_vertices)]
    low, size = surface.uv.min(axis=0), np.ptp(surface.uv, axis=0)
    # A new map may become the active one, and takes the place of none that the user has chosen.
    chosen = mesh_layers.chosen_maps(mesh)
    for name, values in ((FLAT_UV, corners), (PRINT_UV, (corners - low) / size)):
        # By their names: a new layer moves the others.
        if name not in mesh.uv_layers:
            mesh.uv_layers.new(name=name)
        mesh.uv_layers[name].uv.foreach_set("vector", _single(values))
    mesh_layers.choose_maps(mesh, chosen or (PRINT_UV, PRINT_UV))
    attribute(mesh, PATCH, "INT", "FACE").data.foreach_set("value", np.asarray(surface.face_patch, dtype=np.int32))
    _mark_edges(mesh, surface)
    mesh.update()


def write_positions(mesh: Any, positions: NDArray[np.float64]) -> None:
    """New vertex positions (R,3), the paper's units."""
    mesh.attributes["position"].data.foreach_set("vector", _single(positions))
    if len(mesh.vertices):
        # foreach_set on the attribute leaves the bounding box stale in 4.2 to 5.0; one plain write does not.
        mesh.vertices[0].co = mesh.vertices[0].co
    mesh.update()
    by_hand.note(mesh)


def has_geometry_of(mesh: Any, surface: RenderMap) -> bool:
    """Whether a mesh has as many vertices, corners and faces as the net that it is to show."""
    counts = (len(mesh.vertices), len(mesh.loops), len(mesh.polygons))
    return counts == (len(surface.uv), len(surface.face_vertices), len(surface.face_start) - 1)


def is_marked(mesh: Any) -> bool:
    """Whether a mesh still has the marks that ``mark`` gives it: nobody has taken one away, and no earlier version
    made them (``crease_edge`` was the flag that is ``on_crease`` now).
    """
    maps, attributes = mesh.uv_layers, mesh.attributes
    if FLAT_UV not in maps or PRINT_UV not in maps:
        return False
    return all(name in attributes for name in (PATCH, CREASE, ON_CREASE))


def can_be_marked(mesh: Any, surface: RenderMap) -> bool:
    """Whether the faces of a mesh are those of the net, in the same order and the same way round."""
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    return np.array_equal(corners, surface.face_vertices)


def longer_side(mesh: Any) -> float:
    """Of the flat sheet that a mesh shows, in the paper's units."""
    flat = np.empty(2 * len(mesh.loops), dtype=np.float32)
    mesh.uv_layers[FLAT_UV].uv.foreach_get("vector", flat)
    return float(np.ptp(flat.reshape(-1, 2), axis=0).max())


def shows(mesh: Any, positions: NDArray[np.float64]) -> bool:
    """Whether the vertices of a mesh are at (R,3) positions."""
    shown = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", shown)
    return np.array_equal(shown, _single(positions))


def world_positions(paper: Any) -> NDArray[np.float64]:
    """(R,3) vertex positions of an object in the world."""
    mesh = paper.data
    local = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", local)
    matrix = np.array(paper.matrix_world)
    world: NDArray[np.float64] = local.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return world


def edges_of(mesh: Any, pairs: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n,) the edges of a mesh between pairs (n,2) of its vertices. Raises ValueError where there is none."""
    count = len(mesh.edges)
    keys = _edge_keys(edge_ends(mesh), len(mesh.vertices))
    wanted = _edge_keys(np.asarray(pairs).reshape(-1, 2), len(mesh.vertices))
    order = np.argsort(keys)
    slot = np.searchsorted(keys, wanted, sorter=order)
    found = slot < count
    found[found] = keys[order[slot[found]]] == wanted[found]
    if not found.all():
        raise ValueError(f"{np.count_nonzero(~found)} crease edges of the surface are not edges of its faces")
    edges: NDArray[np.int64] = order[slot]
    return edges


def edge_ends(mesh: Any) -> NDArray[np.int32]:
    """(E,2) vertices of the edges."""
    ends = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends)
    return ends.reshape(-1, 2)


def edge_uses(mesh: Any) -> NDArray[np.int64]:
    """(E,) how many faces each edge has: one on the border."""
    edges = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    return np.bincount(edges, minlength=len(mesh.edges))


def corners_of(lines: NDArray[Any], flat: NDArray[np.float64], degrees: float) -> NDArray[np.bool_]:
    """(R,) whether exactly two of the edges lines (n,2) meet at a vertex flat (R,2), and turn there by more than
    ``degrees``.
    """
    step = flat[lines[:, 1]] - flat[lines[:, 0]]
    step /= np.maximum(np.linalg.norm(step, axis=1), 1e-300)[:, None]
    away = np.zeros_like(flat)
    np.add.at(away, lines[:, 0], step)
    np.subtract.at(away, lines[:, 1], step)
    straight = 2.0 * np.sin(np.radians(degrees) / 2.0)
    two: NDArray[np.bool_] = np.bincount(lines.ravel(), minlength=len(flat)) == 2
    return two & (np.linalg.norm(away, axis=1) > straight)


def attribute(mesh: Any, name: str, data_type: str, domain: str) -> Any:
    """An attribute of that kind, made when it is missing. One of another kind is the user's: it makes room."""
    found = mesh.attributes.get(name)
    if found is not None and (found.data_type, found.domain) != (data_type, domain):
        found.name = f"{name}.user"
        found = None
    return found or mesh.attributes.new(name, data_type, domain)


def _mark_edges(mesh: Any, surface: RenderMap) -> None:
    """Creases with their numbers; what is sharp in shading; what stays under Subdivision, the border too."""
    edges = edges_of(mesh, surface.crease_edges)
    number = np.full(len(mesh.edges), NO_CREASE, dtype=np.int32)
    number[edges] = surface.crease_edge_crease
    on_crease = np.zeros(len(mesh.edges), dtype=bool)
    on_crease[edges] = True
    kept = on_crease | (edge_uses(mesh) == 1)
    if _has_old_flag(mesh):
        mesh.attributes.remove(mesh.attributes[CREASE_EDGE])
    attribute(mesh, CREASE, "INT", "EDGE").data.foreach_set("value", number)
    attribute(mesh, ON_CREASE, "BOOLEAN", "EDGE").data.foreach_set("value", on_crease)
    # A border has no other side to be shaded with, but paper with a thickness has an edge there.
    attribute(mesh, _SHARP_EDGE, "BOOLEAN", "EDGE").data.foreach_set("value", kept)
    attribute(mesh, CREASE_EDGE, "FLOAT", "EDGE").data.foreach_set("value", kept.astype(np.float32))
    # Where more than two meet, Subdivision keeps the vertex by itself.
    corner = corners_of(edge_ends(mesh)[kept], surface.uv, _CORNER)
    attribute(mesh, _CREASE_VERTEX, "FLOAT", "POINT").data.foreach_set("value", corner.astype(np.float32))


def _has_old_flag(mesh: Any) -> bool:
    """Whether a version before wrote the flag of creases under the name of Blender's own attribute."""
    found = mesh.attributes.get(CREASE_EDGE)
    return found is not None and found.data_type == "BOOLEAN"


def _edge_keys(ends: NDArray[Any], vertices: int) -> NDArray[np.int64]:
    """One number for each undirected edge."""
    ordered = np.sort(ends.astype(np.int64), axis=1)
    keys: NDArray[np.int64] = ordered[:, 0] * vertices + ordered[:, 1]
    return keys


def _single(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """Flat single precision, as Blender's arrays want it."""
    return np.ascontiguousarray(values, dtype=np.float32).ravel()
