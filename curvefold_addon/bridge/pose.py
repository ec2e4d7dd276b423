"""How a folded sheet lies on a table, and from where it looks best."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from mathutils import Matrix, Vector  # type: ignore[import-not-found]
from mathutils.bvhtree import BVHTree  # type: ignore[import-not-found]
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

#: A resting face must reach at least this far around the centre of mass, relative to the sheet's size.
_MARGIN = 0.02
#: Facets of the hull whose normals differ by less than this (1 - cosine) are one face to stand on.
_SAME_NORMAL = 1e-4
#: Resting faces that are looked at; the largest supports first.
_MOST_POSES = 6
#: Camera azimuths that are tried.
_AZIMUTHS = 24
#: Faces that stand for the whole sheet when a view is judged.
_MOST_FACES = 500
#: Width of a picture over its height, when a view is judged.
_ASPECT = 1.6

#: What makes a good picture: paper fills the frame, both sides are seen (a share of the smaller one above the
#: limit gains nothing more), light and shade differ, it is bright, and the sheet lies rather than stands,
#: with the front up if it can.
_FILLED, _BOTH_SIDES, _SHADING, _BRIGHT, _LYING, _FRONT_UP = 4.0, 8.0, 3.0, 1.0, 3.0, 0.6
#: Faces that are seen at less than this (sine) are slivers, and what share of the seen ones costs.
_SLIVER, _SLIVERS = 0.25, 3.0
_ENOUGH_OF_A_SIDE = 0.12
#: Better by less than this is not better: of equally good views the first is taken, on every machine.
_HAIR = 1e-6

Array = NDArray[np.float64]
_DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class Studio:
    """Angles in radians; the key light's azimuth is relative to the camera's."""

    camera_elevations: tuple[float, ...]
    key_azimuth: float
    key_elevation: float


@dataclass(frozen=True)
class View:
    """Where to look from, radians."""

    azimuth: float
    elevation: float


def lie_down(paper: Any, studio: Studio) -> View:
    """Lays an object stably on z = 0, centred on the origin, and says from where it looks best.

    Every face of the convex hull that the sheet can stand on without falling over is tried, from all around.
    """
    points = _local_positions(paper.data)
    sheet = Sheet(paper.data)
    best, best_score, best_view = np.eye(3), -np.inf, View(0.0, studio.camera_elevations[0])
    for normal in resting_normals(points):
        turn = _down_to_ground(normal)
        front_up = float(normal @ _DOWN)
        view, score = best_view_of(sheet, turn, studio)
        score += _LYING * abs(front_up) + _FRONT_UP * front_up
        if score > best_score + _HAIR:
            best, best_score, best_view = turn, score, view
    # A Matrix, because a plain list would be taken column by column.
    paper.matrix_world = Matrix(_onto_ground(points, best).tolist())
    return best_view


def best_view_of(sheet: Sheet, turn: Array, studio: Studio) -> tuple[View, float]:
    """From where a sheet turned by ``turn`` (3,3) looks best, and how good that is."""
    best, best_score = View(0.0, studio.camera_elevations[0]), -np.inf
    for elevation in studio.camera_elevations:
        for k in range(_AZIMUTHS):
            view = View(k * 2.0 * np.pi / _AZIMUTHS, elevation)
            score = sheet.judge(turn, view, studio)
            if score > best_score + _HAIR:
                best, best_score = view, score
    return best, best_score


def resting_normals(points: Array) -> list[Array]:
    """Outward normals of the hull faces that points (N,3) can stand on; straight down for a flat sheet."""
    extent = np.ptp(points, axis=0)
    if extent[2] < 1e-3 * extent.max():
        return [_DOWN]
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return [_DOWN]
    centre = points.mean(axis=0)
    found: list[tuple[float, Array]] = []
    for normal, offset, support in _hull_faces(hull):
        foot = centre - (normal @ centre + offset) * normal
        margin = _inside(foot, points[support], normal)
        if margin > _MARGIN * extent.max():
            found.append((margin, normal))
    found.sort(key=lambda pair: -pair[0])
    return [normal for _, normal in found[:_MOST_POSES]] or [_DOWN]


class Sheet:
    """A sheet's faces, thinned out, and what hides them: one shape of a mesh, whatever becomes of it."""

    def __init__(self, mesh: Any) -> None:
        points = _local_positions(mesh)
        count = len(mesh.polygons)
        normals = np.empty(3 * count, dtype=np.float32)
        middles = np.empty(3 * count, dtype=np.float32)
        areas = np.empty(count, dtype=np.float32)
        mesh.polygons.foreach_get("normal", normals)
        mesh.polygons.foreach_get("center", middles)
        mesh.polygons.foreach_get("area", areas)
        picked = slice(None, None, max(1, count // _MOST_FACES))
        self._normals = normals.reshape(-1, 3).astype(np.float64)[picked]
        self._middles = middles.reshape(-1, 3).astype(np.float64)[picked]
        self._areas = areas.astype(np.float64)[picked]
        self._area = float(areas.sum())
        self._areas /= self._areas.sum()
        self._points = points
        self._size = float(np.ptp(points, axis=0).max())
        self._tree = BVHTree.FromPolygons(points.tolist(), [tuple(polygon.vertices) for polygon in mesh.polygons])

    def judge(self, turn: Array, camera: View, studio: Studio) -> float:
        """How good a picture is, of the sheet turned by ``turn``, from ``camera``."""
        # Directions are turned back instead of turning the sheet.
        view = _direction(camera.azimuth, camera.elevation) @ turn
        light = _direction(camera.azimuth + studio.key_azimuth, studio.key_elevation) @ turn
        facing = self._normals @ view
        seen = self._unhidden(view) * self._areas
        weights = seen * np.abs(facing)
        front, back = float(weights[facing > 0].sum()), float(weights[facing < 0].sum())
        total = front + back
        if total == 0.0:
            return 0.0
        lit = np.clip(self._normals @ light * np.sign(facing), 0.0, None)
        mean = float(weights @ lit) / total
        contrast = float(np.sqrt(weights @ (lit - mean) ** 2 / total))
        sides = min(front / total, back / total, _ENOUGH_OF_A_SIDE)
        filled = total * self._area / self._frame(turn, camera)
        slivers = float(seen[np.abs(facing) < _SLIVER].sum() / seen.sum())
        return -_SLIVERS * slivers + _FILLED * filled + _BOTH_SIDES * sides + _SHADING * contrast + _BRIGHT * mean

    def _frame(self, turn: Array, camera: View) -> float:
        """Area of the picture, of usual shape, that just holds the sheet."""
        right = np.array([-np.sin(camera.azimuth), np.cos(camera.azimuth), 0.0])
        up = np.cross(_direction(camera.azimuth, camera.elevation), right)
        seen = self._points @ (np.array([right, up]) @ turn).T
        width, height = np.ptp(seen, axis=0)
        width = max(width, _ASPECT * height)
        return float(width * width / _ASPECT)

    def _unhidden(self, view: Array) -> Array:
        direction = Vector(view.tolist())
        starts = self._middles + view * (1e-4 * self._size)
        return np.array([self._tree.ray_cast(Vector(start), direction)[0] is None for start in starts], dtype=float)


def _local_positions(mesh: Any) -> Array:
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", points)
    return points.reshape(-1, 3).astype(np.float64)


def _hull_faces(hull: Any) -> Iterator[tuple[Array, float, NDArray[np.int64]]]:
    """(normal, offset, vertices) of the hull's faces; triangles in one plane are one face."""
    normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
    done = np.zeros(len(normals), dtype=bool)
    for k in range(len(normals)):
        if not done[k]:
            same = normals @ normals[k] > 1.0 - _SAME_NORMAL
            done |= same
            yield normals[k], float(offsets[k]), np.unique(hull.simplices[same])


def _inside(foot: Array, support: Array, normal: Array) -> float:
    """Distance of ``foot`` to the outline of the planar ``support``, negative outside."""
    turn = _down_to_ground(normal)
    outline = (support @ turn.T)[:, :2]
    point = (turn @ foot)[:2]
    try:
        edges = ConvexHull(outline).equations
    except (QhullError, ValueError):
        return -np.inf
    return float(-(edges[:, :2] @ point + edges[:, 2]).max())


def _down_to_ground(normal: Array) -> Array:
    """The smallest rotation that takes ``normal`` to straight down."""
    cosine = float(normal @ _DOWN)
    if cosine < -1.0 + 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    axis = np.cross(normal, _DOWN)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    rotation: Array = np.eye(3) + cross + cross @ cross / (1.0 + cosine)
    return rotation


def _onto_ground(points: Array, turn: Array) -> Array:
    """(4,4): the turn, then the move that puts the lowest point on z = 0 and the middle over the origin."""
    turned = points @ turn.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    matrix[:3, 3] = [-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, -low[2]]
    return matrix


def _direction(azimuth: float, elevation: float) -> Array:
    flat = np.cos(elevation)
    return np.array([np.cos(azimuth) * flat, np.sin(azimuth) * flat, np.sin(elevation)])
