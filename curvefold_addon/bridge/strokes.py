"""Grease pencil strokes as smooth curves: what the hand meant, without its trembling."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.interpolate import BSpline, splprep

from .splines import bspline_cubics

Array = NDArray[np.float64]

#: Object types: before Blender 4.3, and since.
TYPES = ("GPENCIL", "GREASEPENCIL")

#: Turns above this are corners that were meant: simplified to the tolerance, a smooth stroke turns by less at
#: each point unless its radius is below 13 tolerances.
_CORNER = np.radians(45.0)
#: Mean distance from the stroke, relative to the tolerance: the largest is about three times as much.
_MEAN = 0.3


def read_strokes(pencil: Any) -> list[tuple[Array, bool]]:
    """(P,3) points, in the object's coordinates, and whether it is closed, of each stroke that is shown now."""
    read = _strokes_before_4_3 if pencil.type == "GPENCIL" else _strokes
    return [stroke for layer in pencil.data.layers if not layer.hide for stroke in read(layer)]


def _strokes(layer: Any) -> Iterator[tuple[Array, bool]]:
    frame, matrix = layer.current_frame(), np.array(layer.matrix_local, dtype=np.float64)
    for stroke in () if frame is None else frame.drawing.strokes:
        yield _moved([point.position[:] for point in stroke.points], matrix), bool(stroke.cyclic)


def _strokes_before_4_3(layer: Any) -> Iterator[tuple[Array, bool]]:
    frame, matrix = layer.active_frame, np.array(layer.matrix_layer, dtype=np.float64)
    for stroke in () if frame is None else frame.strokes:
        yield _moved([point.co[:] for point in stroke.points], matrix), bool(stroke.use_cyclic)


def _moved(places: list[tuple[float, float, float]], matrix: Array) -> Array:
    points = np.array(places, dtype=np.float64).reshape(-1, 3)
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def smooth_cubics(points: Array, closed: bool, tolerance: float) -> Array | None:
    """(S,4,2) joined cubics within about ``tolerance`` of a stroke (P,2); None for a dot.

    Sharp turns stay corners. Those of a closed stroke end where they start.
    """
    if len(points) == 0:
        return None
    points = points[np.concatenate([[True], (np.diff(points, axis=0) != 0.0).any(axis=1)])]
    if closed and len(points) > 2 and (points[0] != points[-1]).any():
        points = np.vstack([points, points[:1]])
    if len(points) < 2 or shapely.LineString(points).length <= tolerance:
        return None
    corners = _corners(points, tolerance)
    runs = [points[a : b + 1] for a, b in itertools.pairwise([0, *corners, len(points) - 1])]
    whole = closed and not corners
    return np.concatenate([_smooth_run(run, whole, tolerance) for run in runs])


def _corners(points: Array, tolerance: float) -> list[int]:
    """Inner points at which the stroke, seen from a little away, turns sharply."""
    simple = shapely.get_coordinates(shapely.simplify(shapely.LineString(points), tolerance))
    steps = np.diff(simple, axis=0)
    turn = np.abs(np.angle(np.exp(1j * np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))))))
    sharp = simple[1:-1][turn > _CORNER]
    found = [int(np.argmin(np.hypot(*(points - corner).T))) for corner in sharp]
    return sorted({k for k in found if 0 < k < len(points) - 1})


def _smooth_run(points: Array, closed: bool, tolerance: float) -> Array:
    if len(points) < 5:
        steps = np.diff(points, axis=0)[:, None]
        return np.asarray(points[:-1, None] + steps * np.array([0.0, 1 / 3, 2 / 3, 1.0])[:, None])
    # As few knots as keep the mean distance.
    weights = np.ones(len(points))
    if not closed:
        weights[[0, -1]] = 1e3  # the ends stay
    (knots, columns, degree), _ = splprep(
        points.T, w=weights, s=len(points) * (_MEAN * tolerance) ** 2, k=3, per=int(closed)
    )
    return bspline_cubics(BSpline(knots, np.array(columns).T, degree))
