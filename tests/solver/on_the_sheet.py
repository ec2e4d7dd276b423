"""Points of a sheet in space, and drawings moved as a whole: independent of how a net is numbered."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

import solver


def in_space(net: solver.PiecewiseDog, positions: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(N,3) where points (N,2) of the flat sheet lie in positions (V,3); all in drawing units."""
    result = np.empty((len(places), 3))
    for k, place in enumerate(places):
        vertices, weights = net.locate((float(place[0]), float(place[1])))
        result[k] = weights @ positions[vertices]
    return result


def some_places(net: solver.PiecewiseDog, count: int = 40, margin: float = 0.2) -> np.ndarray:
    """(N,2) places on the sheet at least ``margin`` cells away from every crease and from the border."""
    unit = net.frame.unit
    rng = np.random.default_rng(5)
    inner = [polygon.buffer(-margin * unit) for polygon in net.patch_polygons]
    low_x, low_y, high_x, high_y = shapely.union_all(inner).bounds
    found: list[tuple[float, float]] = []
    while len(found) < count:
        place = (float(rng.uniform(low_x, high_x)), float(rng.uniform(low_y, high_y)))
        if any(polygon.contains(shapely.Point(place)) for polygon in inner):
            found.append(place)
    return np.array(found)


def moved(
    pattern: solver.CreasePattern, matrix: np.ndarray, offset: Sequence[float] = (0, 0)
) -> solver.CreasePattern:
    """The drawing under p -> matrix p + offset."""

    def move(points: np.ndarray) -> np.ndarray:
        return points @ np.asarray(matrix).T + np.asarray(offset)

    return solver.CreasePattern(
        boundary=move(pattern.boundary),
        holes=[move(hole) for hole in pattern.holes],
        creases=[
            solver.Crease(
                points=move(crease.points),
                closed=crease.closed,
                assignment=crease.assignment,
                name=crease.name,
                beziers=None if crease.beziers is None else move(crease.beziers),
            )
            for crease in pattern.creases
        ],
        name=pattern.name,
    )


def moved_in_space(points: np.ndarray, matrix: np.ndarray, offset: Sequence[float] = (0, 0)) -> np.ndarray:
    """(N,3) points under the same motion; heights scale with it and keep their sign."""
    scale = np.sqrt(abs(np.linalg.det(matrix)))
    return np.column_stack([points[:, :2] @ np.asarray(matrix).T + np.asarray(offset), scale * points[:, 2]])
