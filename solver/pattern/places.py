"""Where along a polyline points lie: shapely's number to the last bit, also for many points on a long line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray

#: Shapely's lines (N,).
Lines = NDArray[np.object_]

#: Shapely looks at every segment for every point. From this many of both on, only at the nearest ones.
_MANY_LOOKS = 200_000
#: Distances that differ by less than this part of a coordinate may be the same.
_ROUNDING = 1e-12


def places_along(lines: Sequence[FloatArray], which: IntArray, points: FloatArray) -> FloatArray:
    """Distances (N,) from the start of polyline ``which`` (N,) to where it is nearest to each point (N,2).

    lines   (P,2) arrays; where several places are equally near, the first one counts
    """
    result = np.empty(len(points))
    looks = np.bincount(which, minlength=len(lines)) * np.array([len(line) - 1 for line in lines], dtype=np.int64)
    many = looks > _MANY_LOOKS
    few = np.flatnonzero(~many[which])
    asked, place = np.unique(which[few], return_inverse=True)
    whole = line_strings([lines[k] for k in asked.tolist()])
    result[few] = shapely.line_locate_point(whole[place], shapely.points(points[few]))
    for k in np.flatnonzero(many):
        mine = np.flatnonzero(which == k)
        result[mine] = _on_nearest_segment(lines[k], points[mine])
    return result


def line_strings(lines: Sequence[FloatArray]) -> Lines:
    """The (P,2) arrays as shapely's lines (N,), which single constructors make slowly."""
    if not len(lines):
        return np.empty(0, dtype=object)
    index = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    return np.asarray(shapely.linestrings(np.concatenate(lines), indices=index))


def _on_nearest_segment(line: FloatArray, points: FloatArray) -> FloatArray:
    segments = shapely.linestrings(np.stack([line[:-1], line[1:]], axis=1))
    start = np.concatenate([[0.0], np.cumsum(shapely.length(segments))])
    places = shapely.points(points)
    tree = shapely.STRtree(segments)
    # A point on the line is found by a small reach, which is quicker than asking for the nearest segment. That
    # may be a rounding farther than another: all that are as near are looked at.
    reach = np.full(len(points), 2 * _ROUNDING * np.abs(line).max())
    found = tree.query(places, predicate="dwithin", distance=reach)
    off = np.setdiff1d(np.arange(len(points)), found[0])
    if len(off):
        (asked, _), least = tree.query_nearest(places[off], return_distance=True, all_matches=False)
        reach[off[asked]] += least * (1 + _ROUNDING)
        more = tree.query(places[off], predicate="dwithin", distance=reach[off])
        found = np.concatenate([found, [off[more[0]], more[1]]], axis=1)
    point, segment = found
    order = np.lexsort((segment, shapely.distance(places[point], segments[segment]), point))
    point, segment = point[order], segment[order]
    first = segment[np.searchsorted(point, np.arange(len(points)))]
    return np.asarray(start[first] + shapely.line_locate_point(segments[first], places))
