"""The shape of one net for another: a crease was moved, the resolution has changed, the paper stays where it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely import Polygon

from ..arrays import FloatArray, IntArray
from .frame import NetFrame
from .piecewise_dog import PiecewiseDog

#: Quads that are looked at for each vertex: the nearest middle may belong to a neighbour, as cells differ in size.
_CANDIDATES = 4


def carry_over(old: PiecewiseDog, positions: FloatArray, new: PiecewiseDog) -> FloatArray:
    """Positions (V,3) of ``new`` with the shape that ``old`` has at ``positions``, drawing units.

    Every patch takes its place from the old patch that it overlaps most; beyond that one's quads the shape goes
    on straight. A flat sheet stays exactly flat.
    """
    flat_old = np.column_stack([old.rest, np.zeros(len(old.rest))])
    result = np.column_stack([new.rest, np.zeros(len(new.rest))])
    if np.array_equal(positions, flat_old):
        return result
    points = old.frame.to_net(new.rest)
    source = _sources(old.patch_polygons, new.patch_polygons)
    for patch in np.unique(source).tolist():
        quads = old.quads[old.quad_patch == patch]
        some = source[new.vertex_patch] == patch
        result[some] = _interpolated(old.flat, quads, positions, points[some])
    return result


def scaled(net: PiecewiseDog, factor: float) -> PiecewiseDog:
    """The same net with drawing units ``factor`` times as large."""
    frame = net.frame
    origin = (frame.origin[0] * factor, frame.origin[1] * factor)
    polygons = tuple(shapely.transform(polygon, lambda p: p * factor) for polygon in net.patch_polygons)
    return replace(
        net,
        rest=net.rest * factor,
        frame=NetFrame(origin, frame.angle, frame.unit * factor),
        patch_polygons=polygons,
        render_map=replace(net.render_map, uv=net.render_map.uv * factor),
    )


def _sources(old: tuple[Polygon, ...], new: tuple[Polygon, ...]) -> IntArray:
    """For each new patch the old patch of the largest common area; the nearest where nothing is common."""
    old_shapes = shapely.make_valid(np.array(old, dtype=object))
    new_shapes = shapely.make_valid(np.array(new, dtype=object))
    common = shapely.area(shapely.intersection(new_shapes[:, None], old_shapes[None, :]))
    best = common.argmax(axis=1)
    for patch in np.flatnonzero(common.max(axis=1) <= 0.0).tolist():
        best[patch] = int(shapely.distance(new_shapes[patch], old_shapes).argmin())
    return np.asarray(best, dtype=np.int64)


def _interpolated(flat: FloatArray, quads: IntArray, positions: FloatArray, points: FloatArray) -> FloatArray:
    """Places (N,3) of points (N,2), in the frame of ``flat``: bilinear in the nearest quad, straight outside it."""
    low, high = flat[quads[:, 0]], flat[quads[:, 2]]
    count = min(_CANDIDATES, len(quads))
    _, near = cKDTree(0.5 * (low + high)).query(points, k=count)
    near = np.asarray(near, dtype=np.int64).reshape(len(points), count)
    place = (points[:, None, :] - low[near]) / (high - low)[near]
    outside = np.maximum(np.maximum(-place, place - 1.0), 0.0).max(axis=2)
    pick = outside.argmin(axis=1)
    rows = np.arange(len(points))
    corners = positions[quads[near[rows, pick]]]
    asked = place[rows, pick]
    inside = np.clip(asked, 0.0, 1.0)
    u, v = inside[:, :1], inside[:, 1:]
    along_u = (1 - v) * (corners[:, 1] - corners[:, 0]) + v * (corners[:, 2] - corners[:, 3])
    along_v = (1 - u) * (corners[:, 3] - corners[:, 0]) + u * (corners[:, 2] - corners[:, 1])
    middle = (1 - v) * ((1 - u) * corners[:, 0] + u * corners[:, 1]) + v * (
        (1 - u) * corners[:, 3] + u * corners[:, 2]
    )
    beyond = asked - inside
    return middle + beyond[:, :1] * along_u + beyond[:, 1:] * along_v
