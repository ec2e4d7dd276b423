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
from .near_lines import Geometries, lines_near
from .places import line_strings
from .segments import Curve

#: Ends closer than this, relative to the drawing's longer side, are joined into one outline.
JOIN = 1e-4
#: A vertex made by cutting lines at each other is dropped when it lies this straight between its neighbours.
_COLLINEAR = 1e-9
#: Lines whose directions have a smaller cross product run side by side: they have no corner.
_PARALLEL = 0.1
#: Pairs of pieces whose boxes overlap, and pairs that meet, above which cutting them takes minutes.
MAX_NEAR = 2_000_000
MAX_MEETING = 200_000
#: Lines that are compared with all others at once: bounds the memory, not the result.
_CHUNK = 64


@dataclass(frozen=True, eq=False)
class Gap:
    """Where two ends of an outline did not meet: the middle between them, and how far they are apart."""

    place: FloatArray
    width: float


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed outline: points (P,2) without the first repeated, and the same as a polygon.

    members  indices of the curves that lie on it
    gaps     where it had to be closed
    """

    points: FloatArray
    polygon: shapely.Polygon
    members: frozenset[int]
    gaps: tuple[Gap, ...] = ()


def outer_rings(curves: Sequence[Curve], indices: Sequence[int], size: float, reach: float = JOIN) -> list[Ring]:
    """The outlines of what the curves ``indices`` enclose together, largest area first.

    Curves are joined at their ends within JOIN and cut at each other; what does not close is left aside. Ends that
    nothing meets are joined with each other, or with a line, within ``reach``, a part of ``size``.
    """
    tolerance = JOIN * size
    if len(indices) == 1 and curves[indices[0]].closed:
        polygon = shapely.Polygon(curves[indices[0]].points)
        if polygon.is_valid and polygon.area > tolerance * tolerance:
            return [Ring(curves[indices[0]].points, polygon, frozenset(indices))]
    rows, gaps = _joined_rows(curves, indices, tolerance, max(reach * size, tolerance))
    lines = line_strings(list(rows.values()))
    if not len(lines):
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
    tree, owners = shapely.STRtree(lines), list(rows)
    rings = []
    for area in areas:
        exterior = shapely.get_coordinates(area.exterior)[:-1]
        polygon = shapely.Polygon(exterior)
        # The lines that lie on the exterior over their whole length.
        band = polygon.exterior.buffer(2.0 * tolerance)
        members = frozenset(owners[k] for k in tree.query(band, predicate="covers").tolist())
        rings.append(
            Ring(
                _ring_points(curves, members, polygon, original, size),
                polygon,
                members,
                tuple(g for g in gaps if polygon.exterior.distance(shapely.Point(g.place)) <= g.width),
            )
        )
    return sorted(rings, key=lambda ring: -ring.polygon.area)


def meeting_places(points: FloatArray, tolerance: float) -> IntArray:
    """(N,) a number for each place where points (N,2) lie within ``tolerance`` of each other, directly or through
    others. Raises PatternError when too many do.
    """
    places, which = np.unique(points, axis=0, return_inverse=True)
    tree = cKDTree(places)
    if tree.count_neighbors(tree, tolerance) > MAX_NEAR:
        raise PatternError("too many lines end in the same place")
    pairs = tree.query_pairs(tolerance, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(places),) * 2)
    label = connected_components(graph, directed=False)[1]
    return np.asarray(label[which.reshape(-1)], dtype=np.int64)


def loose_ends(ends: FloatArray, tolerance: float) -> IntArray:
    """Indices of the ends (N,2) that no other end meets within ``tolerance``."""
    label = meeting_places(ends, tolerance)
    return np.flatnonzero(np.bincount(label)[label] == 1)


def _joined_rows(
    curves: Sequence[Curve], indices: Sequence[int], tolerance: float, reach: float
) -> tuple[dict[int, FloatArray], list[Gap]]:
    """The points of each curve, closed ones with the first repeated; those without length left out.

    Open ends within ``tolerance`` are moved onto one of them, and loose ones within ``reach``.

    What had to be moved by more than ``tolerance`` is a gap.
    """
    open_ = [i for i in indices if not curves[i].closed]
    gaps: list[Gap] = []
    rows = {i: curves[i].points for i in indices}
    if open_:
        drawn = np.vstack([curves[i].points[[0, -1]] for i in open_])
        label = meeting_places(drawn, tolerance)
        _, first = np.unique(label, return_index=True)
        ends = drawn[first[label]]
        loose = np.flatnonzero(np.bincount(label)[label] == 1)
        if reach > tolerance and len(loose):
            ends, gaps = _reached(curves, indices, open_, ends, loose, tolerance, reach)
        for k, i in enumerate(open_):
            points = curves[i].points.copy()
            points[[0, -1]] = ends[2 * k : 2 * k + 2]
            rows[i] = points
    for i in indices:
        if curves[i].closed:
            rows[i] = np.vstack([rows[i], rows[i][:1]])
        elif len(rows[i]) == 2 and np.array_equal(rows[i][0], rows[i][1]):
            del rows[i]
    return rows, gaps


def _reached(
    curves: Sequence[Curve],
    indices: Sequence[int],
    open_: Sequence[int],
    ends: FloatArray,
    loose: IntArray,
    tolerance: float,
    reach: float,
) -> tuple[FloatArray, list[Gap]]:
    """``ends`` with the loose ones moved: onto the loose one that is nearest, both ways, or else onto a line."""
    ends, gaps = ends.copy(), []
    left = set(loose.tolist())
    if len(loose) > 1:
        distance, place = cKDTree(ends[loose]).query(ends[loose], k=2)
        nearest = np.where(place[:, 0] == np.arange(len(loose)), place[:, 1], place[:, 0])
        for k, other in enumerate(nearest.tolist()):
            if k < other and nearest[other] == k and distance[k, 1] <= reach:
                a, b = int(loose[k]), int(loose[other])
                gaps.append(Gap(0.5 * (ends[a] + ends[b]), float(distance[k, 1])))
                ends[[a, b]] = _meeting(
                    ends[[a, b]], [_way_out(curves[open_[end // 2]], end) for end in (a, b)], reach
                )
                left -= {a, b}
    lines = curve_lines([curves[i] for i in indices])
    tree = shapely.STRtree(lines)
    for k in sorted(left):
        point = shapely.Point(ends[k])
        near = [j for j in tree.query(point, predicate="dwithin", distance=reach) if indices[j] != open_[k // 2]]
        if not near:
            continue
        line = lines[near[int(np.argmin(shapely.distance(lines[near], point)))]]
        along = shapely.line_locate_point(line, point)
        target = shapely.get_coordinates(shapely.line_interpolate_point(line, along))[0]
        width = float(np.hypot(*(target - ends[k])))
        if width > tolerance:
            gaps.append(Gap(0.5 * (target + ends[k]), width))
            # A hair beyond the line, so that the two are cut at each other whatever is rounded.
            ends[k] = target + (target - ends[k]) * (1e-3 * tolerance / width)
    return ends, gaps


def _way_out(curve: Curve, end: int) -> FloatArray:
    """(2,) the direction in which an open curve would go on beyond its first (even ``end``) or last point."""
    inner, outer = (1, 0) if end % 2 == 0 else (-2, -1)
    way = curve.points[outer] - curve.points[inner]
    return np.asarray(way / max(float(np.hypot(*way)), np.finfo(float).tiny))


def _meeting(ends: FloatArray, ways: Sequence[FloatArray], reach: float) -> FloatArray:
    """Where two ends (2,2) meet: in the corner that both go straight on to, if it is near, else at the first."""
    cross = ways[0][0] * ways[1][1] - ways[0][1] * ways[1][0]
    if abs(cross) > _PARALLEL:
        gap = ends[1] - ends[0]
        on = (gap[0] * ways[1][1] - gap[1] * ways[1][0]) / cross
        corner = ends[0] + on * ways[0]
        if np.hypot(*(corner - ends).T).max() <= reach:
            return corner
    return np.asarray(ends[0])


def _noded(lines: Geometries) -> shapely.Geometry:
    """The lines cut where they meet."""
    together = shapely.multilinestrings(lines)
    try:
        return shapely.node(together)
    except shapely.GEOSException:  # lines that nearly coincide can be too much for it
        return shapely.union_all([together])


def _check_crossings(lines: Geometries) -> None:
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


def near_pairs(tree: shapely.STRtree, lines: Geometries, distance: float) -> tuple[IntArray, IntArray]:
    """Index pairs: ``lines``, and what in ``tree`` is within ``distance`` of each.

    Raises PatternError when there are too many.
    """
    found: list[IntArray] = []
    count = 0
    for start in range(0, len(lines), _CHUNK):
        pairs = tree.query(lines[start : start + _CHUNK], predicate="dwithin", distance=distance)
        pairs[0] += start
        count += pairs.shape[1]
        if count > MAX_NEAR:
            raise too_near()
        found.append(pairs)
    first, second = np.concatenate(found, axis=1)
    return first, second


def too_near() -> PatternError:
    return PatternError("too many lines lie in the same place")


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


def curve_lines(curves: Sequence[Curve]) -> Geometries:
    """The curves as lines (N,), closed ones with their first point repeated."""
    rows = [np.vstack([c.points, c.points[:1]]) if c.closed else c.points for c in curves]
    return line_strings(rows)


def lines_at(lines: Geometries, points: FloatArray, tolerance: float) -> IntArray:
    """(N,) how many of the lines pass within ``tolerance`` of each point (N,2)."""
    counts = np.zeros(len(points), dtype=np.int64)
    for point, _ in lines_near(lines, points, tolerance):
        counts += np.bincount(point, minlength=len(points))
    return counts


def touching_groups(curves: Sequence[Curve], indices: Sequence[int], tolerance: float) -> list[list[int]]:
    """``indices`` in groups whose curves touch each other, directly or through others."""
    if not indices:
        return []
    lines = curve_lines([curves[i] for i in indices])
    tree = shapely.STRtree(lines)
    first, second = near_pairs(tree, lines, tolerance)
    graph = coo_matrix((np.ones(len(first)), (first, second)), shape=(len(lines), len(lines)))
    count, label = connected_components(graph, directed=False)
    groups: list[list[int]] = [[] for _ in range(count)]
    for index, group in zip(indices, label, strict=True):
        groups[group].append(index)
    return groups
