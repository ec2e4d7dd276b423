"""Which lines pass near which points: shapely's own answer, also where thousands of long lines cross."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray

#: Shapely's geometries (N,).
Geometries = NDArray[np.object_]

#: A tree of lines knows their boxes, and long lines that cross have large ones, in which most points are. From this
#: many lines on, the tree is made of their pieces.
_MANY_LINES = 2_000
#: Pieces of a line that is as long as what is drawn.
_PIECES = 16
#: Points that are looked at together, few where each may be near to all lines.
_CHUNK, _CHUNK_OF_PIECES = 64, 4_096
#: Boxes are larger than what they hold by this part of the coordinates.
_ROUNDING = 1e-12


def lines_near(lines: Geometries, points: FloatArray, distance: float) -> Iterator[tuple[IntArray, IntArray]]:
    """Index pairs, some at a time: of points (N,2), and of the lines within ``distance`` of each."""
    places = shapely.points(points)
    if len(lines) < _MANY_LINES:
        tree = shapely.STRtree(lines)
        for start in range(0, len(places), _CHUNK):
            point, line = tree.query(places[start : start + _CHUNK], predicate="dwithin", distance=distance)
            yield point + start, line
        return
    boxes, owner = _pieces(lines, distance)
    tree = shapely.STRtree(boxes)
    for start in range(0, len(places), _CHUNK_OF_PIECES):
        point, piece = tree.query(places[start : start + _CHUNK_OF_PIECES])
        # A line whose pieces are near with more than one box is looked at once.
        point, line = np.divmod(np.unique((point + start) * len(lines) + owner[piece]), len(lines))
        near = shapely.dwithin(lines[line], places[point], distance)
        yield point[near], line[near]


def _pieces(lines: Geometries, distance: float) -> tuple[Geometries, IntArray]:
    """Boxes (B,) of pieces of lines, larger by ``distance``, and whose piece each is (B,)."""
    points, index = shapely.get_coordinates(lines, return_index=True)
    inner = np.flatnonzero(index[1:] == index[:-1])
    begin, way, owner = points[inner], points[inner + 1] - points[inner], index[inner]
    length = np.hypot(way[:, 0], way[:, 1])
    longest = max(float(np.ptp(points, axis=0).max()) / _PIECES, np.finfo(float).tiny)
    count = np.maximum(np.ceil(length / longest), 1.0).astype(np.int64)
    segment = np.repeat(np.arange(len(inner)), count)
    step = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
    ends = [begin[segment] + way[segment] * ((step + k) / count[segment])[:, None] for k in (0, 1)]
    # Short segments that follow one another share a box.
    along = np.concatenate([[0.0], np.cumsum(length)])[:-1][segment]
    group = np.column_stack([owner[segment], np.floor(along / longest), np.where(count[segment] > 1, step, 0)])
    starts = np.flatnonzero(np.concatenate([[True], (group[1:] != group[:-1]).any(axis=1)]))
    margin = distance + _ROUNDING * float(np.abs(points).max())
    low = np.minimum.reduceat(np.minimum(*ends), starts) - margin
    high = np.maximum.reduceat(np.maximum(*ends), starts) + margin
    return shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]), owner[segment][starts]
