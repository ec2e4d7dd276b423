"""A folded sheet as a Blender mesh: quads and n-gons, the flat sheet as UVs, creases marked."""

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
#: Face attribute: the patch (a piece of the sheet between creases) a face belongs to.
PATCH = "patch"
#: Edge attribute: the crease an edge lies on, NO_CREASE elsewhere.
CREASE = "crease"
#: Edge attribute: whether an edge lies on a crease.
CREASE_EDGE = "crease_edge"
NO_CREASE = -1
#: Blender's own attribute of that meaning.
_SHARP_EDGE = "sharp_edge"
_OURS = frozenset({FLAT_UV, PATCH, CREASE, CREASE_EDGE, _SHARP_EDGE})

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
    mesh.update()
    by_hand.note(mesh)


def mark(mesh: Any, surface: RenderMap) -> None:
    """Gives a mesh with the geometry of a net the flat sheet as its UVs, and its patches and creases."""
    # By their names: a new layer moves the others.
    if FLAT_UV not in mesh.uv_layers:
        mesh.uv_layers.new(name=FLAT_UV)
    mesh.uv_layers[FLAT_UV].uv.foreach_set("vector", _single(surface.uv[np.asarray(surface.face_vertices)]))
    _attribute(mesh, PATCH, "INT", "FACE").data.foreach_set("value", np.asarray(surface.face_patch, dtype=np.int32))
    _mark_creases(mesh, surface.crease_edges, surface.crease_edge_crease)
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
    """Whether a mesh still has the marks that ``mark`` gave it: nobody has taken one away."""
    return FLAT_UV in mesh.uv_layers and all(name in mesh.attributes for name in (PATCH, CREASE, CREASE_EDGE))


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


def _mark_creases(mesh: Any, crease_edges: NDArray[np.int64], creases: NDArray[np.int64]) -> None:
    count = len(mesh.edges)
    ends = np.empty(2 * count, dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends)
    keys = _edge_keys(ends.reshape(-1, 2), len(mesh.vertices))
    wanted = _edge_keys(np.asarray(crease_edges).reshape(-1, 2), len(mesh.vertices))
    order = np.argsort(keys)
    slot = np.searchsorted(keys, wanted, sorter=order)
    found = slot < count
    found[found] = keys[order[slot[found]]] == wanted[found]
    if not found.all():
        raise ValueError(f"{np.count_nonzero(~found)} crease edges of the surface are not edges of its faces")
    edges = order[slot]

    number = np.full(count, NO_CREASE, dtype=np.int32)
    number[edges] = creases
    on_crease = np.zeros(count, dtype=bool)
    on_crease[edges] = True
    _attribute(mesh, CREASE, "INT", "EDGE").data.foreach_set("value", number)
    # Everything is shaded smooth but the creases. Blender reads the second; the first one is ours to keep.
    for name in (CREASE_EDGE, _SHARP_EDGE):
        _attribute(mesh, name, "BOOLEAN", "EDGE").data.foreach_set("value", on_crease)


def _attribute(mesh: Any, name: str, data_type: str, domain: str) -> Any:
    """An attribute of that kind, made when it is missing. One of another kind is the user's: it makes room."""
    found = mesh.attributes.get(name)
    if found is not None and (found.data_type, found.domain) != (data_type, domain):
        found.name = f"{name}.user"
        found = None
    return found or mesh.attributes.new(name, data_type, domain)


def _edge_keys(ends: NDArray[Any], vertices: int) -> NDArray[np.int64]:
    """One number for each undirected edge."""
    ordered = np.sort(ends.astype(np.int64), axis=1)
    keys: NDArray[np.int64] = ordered[:, 0] * vertices + ordered[:, 1]
    return keys


def _single(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """Flat single precision, as Blender's arrays want it."""
    return np.ascontiguousarray(values, dtype=np.float32).ravel()
