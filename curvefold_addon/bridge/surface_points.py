"""Points of a paper as Blender shows it: what lies under the mouse, what is nearest, what is selected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bmesh  # type: ignore[import-not-found]
from mathutils import Vector  # type: ignore[import-not-found]
from mathutils.bvhtree import BVHTree  # type: ignore[import-not-found]
from mathutils.geometry import (  # type: ignore[import-not-found]
    barycentric_transform,
    intersect_point_line,
    intersect_point_tri,
)

from .mesh import CREASE, FLAT_UV, NO_CREASE, PATCH
from .state import StateError

Point = tuple[float, float]


@dataclass(frozen=True)
class SurfacePoint:
    """at: on the flat sheet; place: in the paper's local coordinates."""

    at: tuple[float, float]
    place: tuple[float, float, float]


@dataclass(frozen=True)
class CreasePoint:
    """A point of a crease, whose number is from 0. at: on the flat sheet."""

    crease: int
    at: Point


def under_ray(mesh: Any, origin: Any, direction: Any) -> SurfacePoint | None:
    """The first point of the paper along a ray in its local coordinates."""
    place, _, face, _ = tree(mesh).ray_cast(Vector(origin), Vector(direction))
    return None if place is None else on_face(mesh, face, place)


def crease_nearest(mesh: Any, place: Any) -> CreasePoint | None:
    """The point of a crease that is nearest to a place of the paper in its local coordinates.

    None on a paper without creases. Raises StateError.
    """
    place = Vector(place)
    best, best_gap, best_part = None, float("inf"), 0.0
    for edge, item in zip(mesh.edges, layer(mesh, mesh.attributes, CREASE).data, strict=True):
        if item.value == NO_CREASE:
            continue
        start, end = (mesh.vertices[k].co for k in edge.vertices)
        _, part = intersect_point_line(place, start, end)
        part = max(0.0, min(1.0, part))
        gap = (place - start.lerp(end, part)).length
        if gap < best_gap:
            best, best_gap, best_part = (item.value, *edge.vertices), gap, part
    if best is None:
        return None
    number, first, second = best
    start, end = _flat_places(mesh, (first, second))
    x, y = start.lerp(end, best_part)
    return CreasePoint(int(number), (x, y))


def nearest(mesh: Any, place: Any) -> SurfacePoint:
    """The point of the paper that is nearest to a place in its local coordinates."""
    found, _, face, _ = tree(mesh).find_nearest(Vector(place))
    return on_face(mesh, face, found)


def selected(mesh: Any) -> list[SurfacePoint]:
    """The selected vertices of a mesh in Edit Mode."""
    edited = bmesh.from_edit_mesh(mesh)
    flat = layer(mesh, edited.loops.layers.uv, FLAT_UV)
    points = []
    for vertex in edited.verts:
        if vertex.select and vertex.link_loops:
            x, y = vertex.link_loops[0][flat].uv
            points.append(SurfacePoint((x, y), tuple(vertex.co)))
    return points


def selected_on_creases(mesh: Any) -> list[Point]:
    """On the flat sheet, the vertices on creases that are selected in Edit Mode. Raises StateError."""
    edited = bmesh.from_edit_mesh(mesh)
    flat, crease = layer(mesh, edited.loops.layers.uv, FLAT_UV), layer(mesh, edited.edges.layers.int, CREASE)
    points = []
    for vertex in edited.verts:
        if vertex.select and vertex.link_loops and any(e[crease] != NO_CREASE for e in vertex.link_edges):
            x, y = vertex.link_loops[0][flat].uv
            points.append((x, y))
    return points


def selected_patches(mesh: Any) -> list[Point]:
    """A point of the flat sheet in each patch of which a face is selected in Edit Mode."""
    edited = bmesh.from_edit_mesh(mesh)
    flat, patch = layer(mesh, edited.loops.layers.uv, FLAT_UV), layer(mesh, edited.faces.layers.int, PATCH)
    largest: dict[int, Any] = {}
    for face in edited.faces:
        if face.select and (face[patch] not in largest or face.calc_area() > largest[face[patch]].calc_area()):
            largest[face[patch]] = face
    points = []
    for _, face in sorted(largest.items()):
        middle = sum((loop[flat].uv for loop in face.loops), Vector((0.0, 0.0))) / len(face.loops)
        points.append((middle.x, middle.y))
    return points


def selected_borders(mesh: Any) -> list[tuple[Point, Point]]:
    """Ends, on the flat sheet, of each stretch of the border whose vertices are selected in Edit Mode."""
    edited = bmesh.from_edit_mesh(mesh)
    flat = layer(mesh, edited.loops.layers.uv, FLAT_UV)
    edges = [e for e in edited.edges if e.is_boundary and all(v.select for v in e.verts)]
    near: dict[Any, list[Any]] = {}
    for edge in edges:
        for vertex in edge.verts:
            near.setdefault(vertex, []).append(edge.other_vert(vertex))
    stretches = []
    ends = sorted((v for v, others in near.items() if len(others) == 1), key=lambda v: v.index)
    seen: set[Any] = set()
    for end in ends:
        if end in seen:
            continue
        seen.add(end)
        last = end
        while onward := [vertex for vertex in near[last] if vertex not in seen]:
            last = onward[0]
            seen.add(last)
        places = [vertex.link_loops[0][flat].uv for vertex in (end, last)]
        stretches.append(((places[0].x, places[0].y), (places[1].x, places[1].y)))
    return stretches


def layer(mesh: Any, layers: Any, name: str) -> Any:
    """One of a paper's layers. Raises StateError when somebody has taken it away.

    The paper is mended when it is next written.
    """
    layer = layers.get(name)
    if layer is None:
        raise StateError(f"{mesh.name} has lost its {name} layer; settle the paper in Object Mode to mend it")
    return layer


def _flat_places(mesh: Any, vertices: Sequence[int]) -> list[Any]:
    """Where vertices are on the flat sheet."""
    flat = layer(mesh, mesh.uv_layers, FLAT_UV).uv
    found = {loop.vertex_index: loop.index for loop in mesh.loops if loop.vertex_index in vertices}
    return [flat[found[vertex]].vector.copy() for vertex in vertices]


def tree(mesh: Any) -> Any:
    """Of the paper itself, without modifiers, so that faces can be told."""
    return BVHTree.FromPolygons(
        [vertex.co for vertex in mesh.vertices], [tuple(polygon.vertices) for polygon in mesh.polygons]
    )


def on_face(mesh: Any, face: int, place: Any) -> SurfacePoint:
    """A place on a face of the paper."""
    flat = layer(mesh, mesh.uv_layers, FLAT_UV).uv
    mesh.calc_loop_triangles()
    best, best_gap = None, float("inf")
    for triangle in mesh.loop_triangles:
        if triangle.polygon_index != face:
            continue
        corners = [mesh.vertices[v].co for v in triangle.vertices]
        sheet = [Vector((*flat[loop].vector, 0.0)) for loop in triangle.loops]
        inside = intersect_point_tri(place, *corners)
        gap = 0.0 if inside is not None else min((place - corner).length for corner in corners)
        if gap < best_gap:
            best, best_gap = barycentric_transform(place, *corners, *sheet), gap
    assert best is not None  # every face has triangles
    return SurfacePoint((best.x, best.y), tuple(place))
