"""Numbers about papers that a camera needs: where they are in all frames, and from where they look best."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from . import pose
from .mesh import world_positions

Array = NDArray[np.float64]

#: Places of a full turn that stand for all of them.
_TURNS = 36


@dataclass(frozen=True)
class Extent:
    """Middle of the bounding box, the radius of the sphere around it that holds every point, and the lowest point's
    height, metres.
    """

    centre: tuple[float, float, float]
    radius: float
    floor: float


class Motion:
    """The shapes that papers go through. ``add`` them frame by frame."""

    def __init__(self) -> None:
        self._points: list[Array] = []
        self._depth = -1.0
        self._sheet: pose.Sheet | None = None
        self._turn: Array = np.eye(3)

    def add(self, paper: Any, depsgraph: Any) -> None:
        """A paper as it is now, with its modifiers and shape keys. The first one is who is looked at."""
        seen = paper.evaluated_get(depsgraph)
        points = world_positions(seen)
        if len(points) == 0:
            return
        self._points.append(_outer(points))
        # The more it is folded, the more there is to see.
        depth = float(np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[-1])
        if depth > self._depth + 1e-9 and len(seen.data.polygons):
            self._depth, self._sheet = depth, pose.Sheet(seen.data)
            self._turn = np.array(paper.matrix_world.decompose()[1].to_matrix())

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to see."""
        return self._sheet is None

    @property
    def points(self) -> Array:
        """(N,3) points in the world whose hull holds every shape."""
        return np.concatenate(self._points)

    def best_view(self, studio: pose.Studio) -> pose.View:
        """From where the shape that is folded most looks best."""
        assert self._sheet is not None
        return pose.best_view_of(self._sheet, self._turn, studio)[0]


def extent(points: Array) -> Extent:
    """How large points (N,3) are together and where."""
    low, high = points.min(axis=0), points.max(axis=0)
    centre = (low + high) / 2
    radius = float(np.linalg.norm(points - centre, axis=1).max())
    return Extent((float(centre[0]), float(centre[1]), float(centre[2])), radius, float(low[2]))


def turned_round(points: Array) -> Array:
    """Points (N,3) on their way round the vertical through their middle."""
    centre = np.array(extent(points).centre)
    away = points - centre
    angles = np.linspace(0.0, 2.0 * np.pi, _TURNS, endpoint=False)[:, None]
    x = np.cos(angles) * away[:, 0] - np.sin(angles) * away[:, 1]
    y = np.sin(angles) * away[:, 0] + np.cos(angles) * away[:, 1]
    z = np.broadcast_to(away[:, 2], x.shape)
    return _outer(np.stack([x, y, z], axis=-1).reshape(-1, 3) + centre)


def grown(points: Array, margin: float) -> list[float]:
    """Points as x, y, z, x, … grown about their middle by ``margin`` (0.1: a tenth), for camera_fit_coords."""
    centre = np.array(extent(points).centre)
    values: list[float] = (centre + (points - centre) * (1.0 + margin)).ravel().tolist()
    return values


def _outer(points: Array) -> Array:
    """Those of points that span their hull; all of them where they are flat."""
    try:
        return points[ConvexHull(points).vertices]
    except (QhullError, ValueError):
        return points
