"""The edges of the paper: which strokes close into the border and the holes, and what the others are then."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..arrays import FloatArray, IntArray
from ..errors import PatternError
from .segments import Curve

#: Ends closer than this, relative to the drawing's longer side, are joined into one outline.
JOIN = 1e-4
#: A vertex made by cutting lines at each other is dropped when it lies this straight between its neighbours.
_COLLINEAR = 1e-9
#: Pairs of pieces whose boxes overlap, and pairs that meet, above which cutting them takes minutes.
MAX_NEAR = 2_000_000
MAX_MEETING = 200_000
#: Lines that are compared with all others at once: bounds the memory, not the result.
_CHUNK = 64


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed outline: points (P,2) without the first repeated, and the same as a polygon.

    members  indices of the curves that lie on it
    """

    points: FloatArray
    polygon: shapely.Polygon
    members: frozenset[int]


def outer_rings(curves: Sequence[Curve], indices: Sequence[int], size: float) -> list[Ring]:
    """The outlines of what the curves ``indices`` enclose together, largest area first.

    Curves are joined at their ends within JOIN and cut at each other; what does not close is left aside.
    """
    tolerance = JOIN * size
    if len(indices) == 1 and curves[indices[0]].closed:
        polygon = shapely.Polygon(curves[indices[0]].points)
        if polygon.is_valid and polygon.area > tolerance * tolerance:
            return [Ring(curves[indices[0]].points, polygon, frozenset(indices))]
    lines = _joined_lines(curves, indices, tolerance)
    if not lines:
        return []
    _check_crossings(lines)
    faces = shapely.get_parts(shapely.polygonize([_noded(lines)]))
    # Faces of no width (a line drawn twice, not quite) are no paper.
    faces = [face for face in faces if face.area > tolerance * tolerance]
    if not faces:
        return []
    union = shapely.coverage_union_all(faces)
    areas = [part for part in shapely.get_parts(union) if isinstance(part, shapely.Polygon)]
    original = {tuple(point) for point in shapely.get_coordinates(lines).tolist()}
    rings = []
    for area in areas:
        exterior = shapely.get_coordinates(area.exterior)[:-1]
        polygon = shapely.Polygon(exterior)
        members = _members(curves, indices, polygon, tolerance)
        rings.append(Ring(_ring_points(curves, members, polygon, original, size), polygon, members))
    return sorted(rings, key=lambda ring: -ring.polygon.area)


def _joined_lines(curves: Sequence[Curve], indices: Sequence[int], tolerance: float) -> list[shapely.LineString]:
    """The curves as lines, open ends within ``tolerance`` moved onto one of them."""
    open_ends = [curves[i].points[[0, -1]] for i in indices if not curves[i].closed]
    moved: dict[int, FloatArray] = {}
    if open_ends:
        ends = np.vstack(open_ends)
        tree = cKDTree(ends)
        if tree.count_neighbors(tree, tolerance) > MAX_NEAR:
            raise PatternError("too many lines end in the same place")
        pairs = tree.query_pairs(tolerance, output_type="ndarray")
        graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(ends), len(ends)))
        _, label = connected_components(graph, directed=False)
        _, first = np.unique(label, return_index=True)
        ends = ends[first[label]].reshape(-1, 2, 2)
        moved = dict(zip((i for i in indices if not curves[i].closed), ends, strict=True))
    lines = []
    for i in indices:
        points = curves[i].points
        if curves[i].closed:
            points = np.vstack([points, points[:1]])
        else:
            points = points.copy()
            points[[0, -1]] = moved[i]
            if len(points) == 2 and np.array_equal(points[0], points[1]):
                continue
        lines.append(shapely.LineString(points))
    return lines


def _noded(lines: Sequence[shapely.LineString]) -> shapely.Geometry:
    """The lines cut where they meet."""
    together = shapely.MultiLineString(lines)
    try:
        return shapely.node(together)
    except shapely.GEOSException:  # lines that nearly coincide can be too much for it
        return shapely.union_all([together])


def _check_crossings(lines: Sequence[shapely.LineString]) -> None:
    """Raises PatternError when cutting the lines at each other would take too long."""
    coordinates, owner = shapely.get_coordinates(lines, return_index=True)
    joined = owner[:-1] == owner[1:]
    ends = np.stack([coordinates[:-1][joined], coordinates[1:][joined]], axis=1)
    pieces = shapely.linestrings(ends)
    tree = shapely.STRtree(pieces)
    near = meeting = 0
    # Neighbours along a line always meet: each piece with itself and two others.
    free = 3 * len(pieces)
    for start in range(0, len(pieces), _CHUNK):
        first, second = tree.query(pieces[start : start + _CHUNK])
        near += len(first)
        if near <= MAX_NEAR + free:
            meeting += int(shapely.intersects(pieces[start + first], pieces[second]).sum())
        if near > MAX_NEAR + free or meeting > MAX_MEETING + free:
            raise PatternError("the lines that could be the border cross each other too often to be one")


def _near_pairs(tree: shapely.STRtree, lines: FloatArray, distance: float) -> tuple[IntArray, IntArray]:
    """Index pairs of lines within ``distance``. Raises PatternError when there are too many."""
    found: list[IntArray] = []
    count = 0
    for start in range(0, len(lines), _CHUNK):
        pairs = tree.query(lines[start : start + _CHUNK], predicate="dwithin", distance=distance)
        pairs[0] += start
        count += pairs.shape[1]
        if count > MAX_NEAR:
            raise PatternError("too many lines lie in the same place")
        found.append(pairs)
    first, second = np.concatenate(found, axis=1)
    return first, second


def _members(
    curves: Sequence[Curve], indices: Sequence[int], polygon: shapely.Polygon, tolerance: float
) -> frozenset[int]:
    """The curves that lie on the polygon's exterior over their whole length."""
    lines = np.array([curve_line(curves[i]) for i in indices])
    band = polygon.exterior.buffer(2.0 * tolerance)
    shapely.prepare(band)
    return frozenset(i for i, inside in zip(indices, shapely.covers(band, lines), strict=True) if inside)


def _ring_points(
    curves: Sequence[Curve],
    members: frozenset[int],
    polygon: shapely.Polygon,
    original: set[tuple[float, ...]],
    size: float,
) -> FloatArray:
    # One closed stroke: as it was drawn, its first point first.
    for i in members:
        curve = curves[i]
        if curve.closed and len(curve.points) >= 3:
            own = shapely.Polygon(curve.points)
            if own.is_valid and abs(own.area - polygon.area) <= 1e-9 * polygon.area:
                return curve.points
    points = shapely.get_coordinates(polygon.exterior)[:-1]
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    chord, offset = after - before, points - before
    length = np.maximum(np.hypot(*chord.T), np.finfo(float).tiny)
    height = np.abs(chord[:, 0] * offset[:, 1] - chord[:, 1] * offset[:, 0]) / length
    drawn = np.array([tuple(point) in original for point in points.tolist()])
    keep = drawn | (height > _COLLINEAR * size)
    return np.asarray(points[keep] if keep.sum() >= 3 else points, dtype=np.float64)


def curve_line(curve: Curve) -> shapely.LineString:
    points = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
    return shapely.LineString(points)


def share_inside(polygon: shapely.Polygon, curves: Sequence[Curve], tolerance: float) -> float:
    """How much of the curves' length lies in ``polygon``, 0 to 1; 1 when there are none."""
    if not curves:
        return 1.0
    lines = np.array([curve_line(curve) for curve in curves])
    grown = polygon.buffer(tolerance)
    shapely.prepare(grown)
    total = float(shapely.length(lines).sum())
    covered = shapely.covers(grown, lines)
    inside = float(shapely.length(lines[covered]).sum())
    rest = lines[~covered & shapely.intersects(grown, lines)]
    if len(rest):
        inside += float(shapely.length(shapely.intersection(rest, grown)).sum())
    return inside / total if total > 0 else 1.0


def touching_groups(curves: Sequence[Curve], indices: Sequence[int], tolerance: float) -> list[list[int]]:
    """``indices`` in groups whose curves touch each other, directly or through others."""
    if not indices:
        return []
    lines = np.array([curve_line(curves[i]) for i in indices])
    tree = shapely.STRtree(lines)
    first, second = _near_pairs(tree, lines, tolerance)
    graph = coo_matrix((np.ones(len(first)), (first, second)), shape=(len(lines), len(lines)))
    count, label = connected_components(graph, directed=False)
    groups: list[list[int]] = [[] for _ in range(count)]
    for index, group in zip(indices, label, strict=True):
        groups[group].append(index)
    return groups
