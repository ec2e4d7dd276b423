"""What users have put on a paper's mesh (groups, UV maps, colours, materials): carried over to new geometry.

Everything is found again by its place on the flat sheet. Values of points and corners are interpolated, those of
faces come from the face in which the new one's middle lies. What lies on edges is not carried over.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import bpy
import numpy as np
import shapely
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: How Blender's types are read: the property's name, numbers in one value, whether between two values are others.
_TYPES = {
    "FLOAT": ("value", 1, True),
    "FLOAT2": ("vector", 2, True),
    "FLOAT_VECTOR": ("vector", 3, True),
    "FLOAT_COLOR": ("color", 4, True),
    "BYTE_COLOR": ("color", 4, True),
    "INT": ("value", 1, False),
    "INT8": ("value", 1, False),
    "INT32_2D": ("value", 2, False),
    "BOOLEAN": ("value", 1, False),
    "QUATERNION": ("value", 4, False),
}
_EXACT = {"INT": np.int32, "INT8": np.int32, "INT32_2D": np.int32, "BOOLEAN": np.bool_}
#: A corner is looked for so far from its place towards the middle of its face: it belongs to that side of a seam.
_INWARDS = 0.05
#: Triangles smaller than this part of the largest are no place to look.
_FLAT_TRIANGLE = 1e-9
#: Weights of a vertex group below this are none.
_NO_WEIGHT = 1e-4
#: Decimals of a weight: what differs only by rounding is one weight.
_DIGITS = 6


@dataclass(frozen=True, eq=False)
class _Values:
    """One attribute. values (n, width)."""

    name: str
    data_type: str
    domain: str
    values: NDArray[Any]


@dataclass(frozen=True, eq=False)
class _Group:
    """One vertex group. weights (V,); members (V,) tell a weight of zero from none."""

    name: str
    locked: bool
    weights: Array
    members: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Layers:
    """What is carried over from a mesh, and the triangles of its flat sheet."""

    values: tuple[_Values, ...]
    groups: tuple[_Group, ...]
    active_group: int
    color_shown: str
    color_rendered: str
    sheet: _Sheet


@dataclass(frozen=True, eq=False)
class _Sheet:
    """Triangles (T,3,2) of a mesh on the flat sheet; their vertices and corners (T,3), faces and patches (T,)."""

    triangles: Array
    vertices: Indices
    corners: Indices
    faces: Indices
    patches: Indices

    def find(self, points: Array) -> Indices:
        """(N,) the triangles that hold points (N,2), or are nearest to them."""
        return _nearest(self._polygons, points)

    def find_in(self, patches: Indices, points: Array) -> Indices:
        """The same, among the triangles of patches (N,)."""
        found: Indices = np.empty(len(points), dtype=np.int64)
        for patch in np.unique(patches):
            wanted, there = patches == patch, np.flatnonzero(self.patches == patch)
            found[wanted] = there[_nearest(self._polygons[there], points[wanted])]
        return found

    @cached_property
    def _polygons(self) -> NDArray[Any]:
        polygons: NDArray[Any] = shapely.polygons(np.concatenate([self.triangles, self.triangles[:, :1]], axis=1))
        return polygons

    def weights(self, triangles: Indices, points: Array) -> Array:
        """(N,3) of the corners of triangles (N,) whose sums are points (N,2), outside a triangle too."""
        a, b, c = np.moveaxis(self.triangles[triangles], 1, 0)
        area = _cross(b - a, c - a)
        second, third = _cross(points - a, c - a) / area, _cross(b - a, points - a) / area
        return np.stack([1.0 - second - third, second, third], axis=-1)


def read(mesh: Any, flat_uv: str, patch: str, ours: frozenset[str]) -> Layers | None:
    """What users have put on a mesh; None when there is nothing, or nothing tells where it is.

    flat_uv: the UV map that is the flat sheet; patch: the number of each face's patch; ours: attributes that are
    not the user's.
    """
    if flat_uv not in mesh.uv_layers or not len(mesh.polygons):
        return None
    values = tuple(_read_values(mesh, ours))
    owner = _owner(mesh)
    groups = () if owner is None else tuple(_read_groups(mesh, owner))
    if not values and not groups:
        return None
    sheet = _read_sheet(mesh, flat_uv, patch)
    if not len(sheet.triangles):
        return None
    return Layers(
        values,
        groups,
        0 if owner is None else owner.vertex_groups.active_index,
        mesh.attributes.active_color_name,
        mesh.attributes.default_color_name,
        sheet,
    )


def write(mesh: Any, flat_uv: str, layers: Layers) -> None:
    """Puts them on the new geometry of a mesh, which has its flat UV map."""
    flat = np.empty(2 * len(mesh.loops), dtype=np.float32)
    mesh.uv_layers[flat_uv].uv.foreach_get("vector", flat)
    corners = flat.reshape(-1, 2).astype(np.float64)
    corner_vertex = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corner_vertex)
    points = np.zeros((len(mesh.vertices), 2))
    points[corner_vertex] = corners
    sizes = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    face = np.repeat(np.arange(len(sizes)), sizes)
    middles = np.stack([np.bincount(face, corners[:, k], len(sizes)) / sizes for k in range(2)], axis=-1)

    sheet = layers.sheet
    places = {}
    domains = {entry.domain for entry in layers.values}
    if "POINT" in domains or layers.groups:
        places["POINT"] = _Place(sheet, sheet.find(points), points, sheet.vertices)
    in_middle = sheet.find(middles) if domains & {"CORNER", "FACE"} else np.empty(0, dtype=np.int64)
    if "CORNER" in domains:
        # A map may be torn between two faces, and mostly is at a crease.
        inside = corners + _INWARDS * (middles[face] - corners)
        triangles = sheet.find_in(sheet.patches[in_middle][face], inside)
        places["CORNER"] = _Place(sheet, triangles, corners, sheet.corners)
    if "FACE" in domains:
        places["FACE"] = _Place(sheet, in_middle, middles, np.repeat(sheet.faces[:, None], 3, axis=1))
    for entry in layers.values:
        _write_values(mesh, entry, places[entry.domain])
    if layers.groups:
        _write_groups(mesh, layers, places["POINT"])
    _write_choices(mesh, layers)


def chosen_maps(mesh: Any) -> tuple[str, str] | None:
    """Which UV map is shown and which is rendered, empty where none is chosen; None where there is none.

    In 5.2 none is chosen any more when the chosen one was removed; before, the next one was.
    """
    if not len(mesh.uv_layers):
        return None
    shown = mesh.uv_layers.active
    rendered = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    return "" if shown is None else shown.name, rendered


def choose_maps(mesh: Any, chosen: tuple[str, str]) -> None:
    """Shows and renders these UV maps, as far as they are there."""
    shown, rendered = (mesh.uv_layers.get(name) for name in chosen)
    if shown is not None:
        mesh.uv_layers.active = shown
    if rendered is not None:
        rendered.active_render = True


class _Place:
    """Where values come from: three sources (N,3) with their weights (N,3), and the nearest one (N,)."""

    def __init__(self, sheet: _Sheet, triangles: Indices, points: Array, sources: Indices) -> None:
        self._sources = sources[triangles]
        self._weights = sheet.weights(triangles, points)
        held = np.clip(self._weights, 0.0, None)
        self._held = held / held.sum(axis=1, keepdims=True)
        nearest = self._held.argmax(axis=1)[:, None]
        self._nearest = np.take_along_axis(self._sources, nearest, axis=1)[:, 0]

    def between(self, values: NDArray[Any], beyond: bool) -> Array:
        """(N, …) interpolated values; ``beyond`` the old sheet they go on as they are at its border."""
        result: Array = np.einsum("nk,nk...->n...", self._weights if beyond else self._held, values[self._sources])
        return result

    def nearest(self, values: NDArray[Any]) -> NDArray[Any]:
        """(N, …) the values of the nearest sources."""
        found: NDArray[Any] = values[self._nearest]
        return found


def _read_values(mesh: Any, ours: frozenset[str]) -> list[_Values]:
    found = []
    for attribute in mesh.attributes:
        skipped = attribute.is_internal or attribute.is_required or attribute.name in ours
        if skipped or attribute.domain == "EDGE" or attribute.data_type not in _TYPES:
            continue
        name, width, _ = _TYPES[attribute.data_type]
        flat = np.empty(width * len(attribute.data), dtype=_EXACT.get(attribute.data_type, np.float32))
        attribute.data.foreach_get(name, flat)
        found.append(_Values(attribute.name, attribute.data_type, attribute.domain, flat.reshape(-1, width)))
    return found


def _write_values(mesh: Any, entry: _Values, place: _Place) -> None:
    name, _, between = _TYPES[entry.data_type]
    if between and entry.domain != "FACE":
        values = place.between(entry.values, beyond=entry.data_type == "FLOAT2").astype(np.float32)
    else:
        values = place.nearest(entry.values)
    attribute = mesh.attributes.new(entry.name, entry.data_type, entry.domain)
    attribute.data.foreach_set(name, np.ascontiguousarray(values).ravel())


def _read_groups(mesh: Any, owner: Any) -> list[_Group]:
    count = len(owner.vertex_groups)
    if not count:
        return []
    weights = np.zeros((count, len(mesh.vertices)))
    members = np.zeros((count, len(mesh.vertices)), dtype=bool)
    for k, vertex in enumerate(mesh.vertices):
        for element in vertex.groups:
            if element.group < count:
                weights[element.group, k] = element.weight
                members[element.group, k] = True
    return [_Group(g.name, g.lock_weight, weights[k], members[k]) for k, g in enumerate(owner.vertex_groups)]


def _write_groups(mesh: Any, layers: Layers, place: _Place) -> None:
    owner = _owner(mesh)
    if owner is None:
        return
    for entry in layers.groups:
        group = owner.vertex_groups.new(name=entry.name)
        weights = place.between(entry.weights, beyond=False).round(_DIGITS)
        members = (weights > _NO_WEIGHT) | place.nearest(entry.members)
        # Vertices of one weight are added together: most have none, or all of it.
        order = np.flatnonzero(members)
        for weight in np.unique(weights[order]):
            group.add(order[weights[order] == weight].tolist(), float(weight), "REPLACE")
        group.lock_weight = entry.locked
    owner.vertex_groups.active_index = layers.active_group


def _write_choices(mesh: Any, layers: Layers) -> None:
    """Which of several colours are shown and rendered."""
    mesh.attributes.active_color_name = layers.color_shown
    mesh.attributes.default_color_name = layers.color_rendered


def _read_sheet(mesh: Any, flat_uv: str, patch: str) -> _Sheet:
    flat = np.empty(2 * len(mesh.loops), dtype=np.float32)
    mesh.uv_layers[flat_uv].uv.foreach_get("vector", flat)
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    vertices, corners = np.empty(3 * count, dtype=np.int32), np.empty(3 * count, dtype=np.int32)
    faces = np.empty(count, dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", vertices)
    mesh.loop_triangles.foreach_get("loops", corners)
    mesh.loop_triangles.foreach_get("polygon_index", faces)
    vertices, corners = vertices.reshape(-1, 3), corners.reshape(-1, 3)
    patches = np.zeros(len(mesh.polygons), dtype=np.int32)
    if patch in mesh.attributes:
        mesh.attributes[patch].data.foreach_get("value", patches)
    triangles = flat.reshape(-1, 2).astype(np.float64)[corners]
    area = np.abs(_cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]))
    good = area > _FLAT_TRIANGLE * area.max(initial=0.0)
    return _Sheet(
        triangles[good],
        vertices[good].astype(np.int64),
        corners[good].astype(np.int64),
        faces[good].astype(np.int64),
        patches[faces[good]].astype(np.int64),
    )


def _owner(mesh: Any) -> Any:
    """An object that shows a mesh: vertex groups can only be reached through one."""
    return next((item for item in bpy.data.objects if item.data == mesh), None)


def _nearest(polygons: NDArray[Any], points: Array) -> Indices:
    """(N,) which of some polygons holds each of points (N,2), or is nearest to it."""
    tree, places = shapely.STRtree(polygons), shapely.points(points)
    nearest: Indices = np.full(len(points), -1, dtype=np.int64)
    which, found = tree.query(places, predicate="intersects")
    nearest[which] = found
    # Much slower, and for few.
    outside = np.flatnonzero(nearest < 0)
    which, found = tree.query_nearest(places[outside], all_matches=False)
    nearest[outside[which]] = found
    return nearest


def _cross(first: Array, second: Array) -> Array:
    product: Array = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    return product
