"""What a click on a paper means that comes near a corner, a crease or the border.

"Near" is measured in pixels, so that it is the same from far and from near; what the paper hides is not near.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils import Vector  # type: ignore[import-not-found]
from numpy.typing import NDArray

from . import mesh as surface
from . import mesh_overlay
from .surface_points import SurfacePoint, layer, tree

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: A corner of the sheet, or a vertex of its creases, is taken within this of the mouse, pixels at a scale of 1 ...
POINT_REACH = 12.0
#: ... a crease point within this, and a point of the border or of a crease within that.
CREASE_POINT_REACH, LINE_REACH = 9.0, 7.0
#: The border has a corner where it turns by more than this, degrees.
CORNER = 25.0
#: What lies deeper than the paper in front of it by more than this, relative to its size, is hidden.
HIDDEN = 2e-3


@dataclass(frozen=True)
class View:
    """How a paper is looked at. matrix: from its local coordinates to Blender's screen space (4,4), -1 to 1.

    size: of the region, and mouse: in it, pixels; scale: of the interface.
    """

    matrix: Any
    size: tuple[float, float]
    mouse: tuple[float, float]
    scale: float = 1.0

    def pixels(self, places: Array) -> Array:
        """(P,2) pixels of places (P,3); not finite behind the eye."""
        matrix = np.array(self.matrix)
        homogeneous = places @ matrix[:, :3].T + matrix[:, 3]
        depth = np.where(homogeneous[:, 3] > 0.0, homogeneous[:, 3], np.nan)
        pixels: Array = (homogeneous[:, :2] / depth[:, None] + 1.0) * 0.5 * np.array(self.size)
        return pixels


def near_mouse(mesh: Any, view: View, origin: Any, direction: Any) -> SurfacePoint | None:
    """The corner, crease or border of a paper that a click is near enough to mean; None for any other point.

    origin, direction: the ray of the mouse, in the paper's local coordinates. Raises StateError.
    """
    near = _Near(mesh, view)
    eye = _Eye(tree(mesh), Vector(origin), Vector(direction).normalized(), view, near.size)
    return next((SurfacePoint(at, place) for place, at in near.candidates() if not eye.is_hidden(place)), None)


class _Eye:
    """Who looks, along parallel rays or from one point."""

    def __init__(self, seen: Any, origin: Any, direction: Any, view: View, size: float) -> None:
        self._seen, self._origin, self._direction = seen, origin, direction
        self._parallel = bool(np.allclose(np.array(view.matrix)[3, :3], 0.0))
        self._size = size

    def is_hidden(self, place: tuple[float, float, float]) -> bool:
        target = Vector(place)
        if self._parallel:
            start = target - self._direction * (target - self._origin).dot(self._direction)
        else:
            start = self._origin
        way = target - start
        return self._seen.ray_cast(start, way.normalized(), way.length - HIDDEN * self._size)[0] is not None


class _Near:
    """The lines and points of a paper near the mouse."""

    def __init__(self, mesh: Any, view: View) -> None:
        self._view, self._mouse = view, np.array(view.mouse, dtype=np.float64)
        self._places = mesh_overlay.shown_positions(mesh)
        self.size = float(np.ptp(self._places, axis=0).max())
        self._flat = _flat_of(mesh)
        crease = np.empty(len(mesh.edges), dtype=np.int32)
        layer(mesh, mesh.attributes, surface.CREASE).data.foreach_get("value", crease)
        ends = surface.edge_ends(mesh).astype(np.int64)
        self._border = ends[surface.edge_uses(mesh) == 1]
        folded = crease != surface.NO_CREASE
        self._creases = ends[folded]
        self._numbers = crease[folded]

    def candidates(self) -> list[tuple[tuple[float, float, float], tuple[float, float]]]:
        """Places and points of the flat sheet, best first."""
        scale = self._view.scale
        points = [
            *self._vertices(self._ends(), POINT_REACH * scale),
            *self._vertices(np.unique(self._creases), CREASE_POINT_REACH * scale),
        ]
        return points + self._on_lines(LINE_REACH * scale)

    def _ends(self) -> Indices:
        """Corners of the sheet, and vertices where creases end or meet."""
        corners = np.flatnonzero(surface.corners_of(self._border, self._flat, CORNER))
        return np.union1d(corners, self._crease_vertices())

    def _crease_vertices(self) -> Indices:
        """Where another number of crease edges than two meet, or two of different creases."""
        if len(self._creases) == 0:
            return np.empty(0, dtype=np.int64)
        count = len(self._places)
        meeting = np.bincount(self._creases.ravel(), minlength=count)
        numbers = self._numbers.repeat(2)
        lowest, highest = np.full(count, numbers.max() + 1), np.full(count, -1)
        np.minimum.at(lowest, self._creases.ravel(), numbers)
        np.maximum.at(highest, self._creases.ravel(), numbers)
        found: Indices = np.flatnonzero((meeting > 0) & ((meeting != 2) | (lowest != highest)))
        return found

    def _vertices(self, chosen: Indices, reach: float) -> list[tuple[Any, Any]]:
        """Those of the vertices that are near, nearest first."""
        gaps = np.linalg.norm(self._view.pixels(self._places[chosen]) - self._mouse, axis=1)
        near = np.flatnonzero(gaps <= reach)  # which NaN is not
        return [
            (tuple(self._places[k].tolist()), tuple(self._flat[k].tolist()))
            for k in chosen[near[np.argsort(gaps[near])]].tolist()
        ]

    def _on_lines(self, reach: float) -> list[tuple[Any, Any]]:
        """The points of edges of the border and of creases that are near, nearest first."""
        edges = np.concatenate([self._border, self._creases])
        if len(edges) == 0:
            return []
        start, end = (self._view.pixels(self._places[edges[:, k]]) for k in (0, 1))
        way = end - start
        with np.errstate(invalid="ignore"):
            part = ((self._mouse - start) * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), 1e-12)
            part = np.clip(part, 0.0, 1.0)
            gaps = np.linalg.norm(start + part[:, None] * way - self._mouse, axis=1)
        near = np.flatnonzero(gaps <= reach)
        found = []
        for k in near[np.argsort(gaps[near])].tolist():
            (a, b), t = edges[k], part[k]
            place, at = ((1.0 - t) * these[a] + t * these[b] for these in (self._places, self._flat))
            found.append((tuple(place.tolist()), tuple(at.tolist())))
        return found


def _flat_of(mesh: Any) -> Array:
    """(V,2) where the vertices are on the flat sheet."""
    vertices = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    corners = np.empty(2 * len(mesh.loops), dtype=np.float32)
    layer(mesh, mesh.uv_layers, surface.FLAT_UV).uv.foreach_get("vector", corners)
    flat = np.zeros((len(mesh.vertices), 2))
    flat[vertices] = corners.reshape(-1, 2)
    return flat
