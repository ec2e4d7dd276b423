"""Numbers about an object that a camera needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .mesh import world_positions


@dataclass(frozen=True)
class Extent:
    """Middle of the bounding box, and the radius of the sphere around it that holds every vertex, metres."""

    centre: tuple[float, float, float]
    radius: float


def extent(paper: Any) -> Extent:
    """How large an object is and where."""
    points = world_positions(paper)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = float(np.linalg.norm(points - centre, axis=1).max())
    return Extent((float(centre[0]), float(centre[1]), float(centre[2])), radius)


def outline_coordinates(paper: Any, margin: float) -> list[float]:
    """Vertices x, y, z, x, … grown about the middle by ``margin`` (0.1: a tenth), for camera_fit_coords."""
    points = world_positions(paper)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    grown: list[float] = (centre + (points - centre) * (1.0 + margin)).ravel().tolist()
    return grown
