"""Creases and border cut at their crossings: a planar graph of curves, cleaned of what a hand leaves behind.

Coordinates are those of the caller (the grid's frame, cell lengths); shapely does the noding.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from shapely import LineString, MultiPolygon, Point, Polygon

from ..arrays import BoolArray, FloatArray, IntArray
from ..errors import PatternError
from .curves import CORNER, drop_repeats
from .places import Lines, line_strings, places_along

#: Ends nearer than this to the border, to a crease or to each other are joined; part of the longer side.
SNAP_TOLERANCE = 2e-3
#: An end this near to what it points at is meant to reach it, cells: paper beyond it would be narrower than the net
#: can show. A crease's ends are extended by a part of its length, so that small features stay as they are, and to
#: its own other end by less.
END_REACH, _PART_EXTENDED, _PART_CLOSED = 0.25, 0.25, 0.1
#: An end points along the chord of its last piece of this length, cells, at what lies so many times as far along
#: that direction as it may be away, and to an end or a place whose direction differs by less than these, radians.
_HEADING, _ALONG_HEADING, _TO_AN_END, _TO_A_PLACE = 0.25, 2.0, np.radians(60.0), np.radians(30.0)
#: Nodes nearer than this are one node; part of the longer side. Far above rounding, far below any drawing.
NODE_TOLERANCE = 1e-12
#: So many pairs of a line and an end are snapped one by one.
_MANY_SNAPS = 200_000
#: Slivers are merged one at a time; creases that leave more of them run along each other all over the sheet.
_MAX_SLIVERS = 200

#: Where a vertex of the arrangement comes from.
CROSSING, JUNCTION, END, CORNER_POINT = "crossing", "border junction", "end", "corner"


@dataclass(frozen=True, eq=False)
class Chain:
    """A piece of a crease between two vertices of the arrangement (or a whole closed crease).

    points (P,2) in the direction of its crease; a closed chain repeats its first point.
    """

    points: FloatArray
    crease: int
    closed: bool


@dataclass(frozen=True, eq=False)
class Arrangement:
    """The planar arrangement of a sheet.

    sheet     shapely polygon, holes cut out
    chains    crease pieces between vertices
    vertices  (N,2) crease vertices: crossings, junctions with the border, free ends, corners of creases
    kinds     (N,) what each vertex is
    notes     what was repaired, one sentence each
    """

    sheet: Polygon
    chains: tuple[Chain, ...]
    vertices: FloatArray
    kinds: tuple[str, ...]
    notes: tuple[str, ...]


def sheet_polygon(boundary: FloatArray, holes: tuple[FloatArray, ...]) -> Polygon:
    """The sheet as a valid shapely polygon. Raises PatternError naming the place where it crosses itself."""
    outline = Polygon(boundary)
    if not outline.is_valid:
        raise PatternError("the border crosses itself", element="border", place=_invalid_place(outline))
    rings = []
    for k, hole in enumerate(holes):
        ring = Polygon(hole)
        if not ring.is_valid:
            raise PatternError("the hole crosses itself", element=f"hole {k + 1}", place=_invalid_place(ring))
        rings.append(ring)
    sheet = outline.difference(shapely.union_all(rings)) if rings else outline
    if isinstance(sheet, MultiPolygon):
        raise PatternError(f"the holes cut the sheet into {len(sheet.geoms)} pieces", element="border")
    if sheet.is_empty:
        raise PatternError("the holes leave nothing of the sheet", element="border")
    return sheet


def _invalid_place(polygon: Polygon) -> tuple[float, ...] | None:
    reason = shapely.is_valid_reason(polygon)
    if "[" not in reason:
        return None
    return tuple(float(word) for word in reason.split("[")[1].rstrip("]").split())


def snap_tolerance(sheet: Polygon) -> float:
    """How near is joined on this sheet, and how short is left out; its units."""
    return SNAP_TOLERANCE * _longer_side(sheet)


def _longer_side(sheet: Polygon) -> float:
    x0, y0, x1, y1 = sheet.bounds
    return float(max(x1 - x0, y1 - y0))


def arrange(
    sheet: Polygon,
    lines: list[FloatArray],
    labels: list[str],
    locate: Callable[[FloatArray], FloatArray] = lambda points: points,
) -> Arrangement:
    """Cut crease polylines at their crossings and mend near misses. Lengths are in cells of the net.

    lines   (P,2) arrays, one a crease; closed ones repeat their first point
    labels  names for notes and errors, one a crease
    locate  turns (N,2) places into the user's coordinates, for notes
    Raises PatternError when creases run along each other all over the sheet. Without a crease that is left on it
    the sheet is all there is.
    """
    tolerance, node = snap_tolerance(sheet), NODE_TOLERANCE * _longer_side(sheet)
    notes: list[str] = []
    parts = _trim(sheet, lines, labels, tolerance, notes)
    if not parts:
        return _blank(sheet, notes)
    parts = _snap_ends(sheet, parts, labels, tolerance, notes)
    segments, owner, points = _node(sheet, parts, node)
    segments, owner, points = _merge_vertices(segments, owner, points, tolerance)
    segments, owner = _drop_whiskers(segments, owner, points, tolerance)
    segments, owner = _drop_slivers(segments, owner, points, tolerance, labels, notes, locate)
    if not (owner >= 0).any():
        return _blank(sheet, notes)
    chains, vertices, kinds = _chains(segments, owner, points, lines)
    return Arrangement(sheet, chains, vertices, kinds, tuple(notes))


def _blank(sheet: Polygon, notes: list[str]) -> Arrangement:
    return Arrangement(sheet, (), np.empty((0, 2)), (), tuple(notes))


def _trim(
    sheet: Polygon, lines: list[FloatArray], labels: list[str], tolerance: float, notes: list[str]
) -> list[tuple[FloatArray, int]]:
    parts: list[tuple[FloatArray, int]] = []
    trimmed: list[str] = []
    # Runs along the border are border: keep only what is inside by a hair.
    border = sheet.boundary
    shapely.prepare(sheet)
    for k, points in enumerate(lines):
        line = LineString(points) if len(points) > 1 else LineString()
        if line.length < tolerance:
            notes.append(f"{labels[k]} is shorter than the snap tolerance and was left out")
            continue
        inside = line if sheet.contains(line) else _lines_of(line.intersection(sheet))
        length = inside.length
        if length < tolerance:
            notes.append(f"{labels[k]} lies off the sheet and was left out")
            continue
        if line.length - length > tolerance:
            trimmed.append(labels[k])
        along_border = border.buffer(1e-7 * tolerance)
        if line.intersects(border):
            inside = _lines_of(inside.difference(along_border)) if _overlaps(inside, border) else inside
        pieces = _rejoin(shapely.get_parts(inside), points)
        parts += [(drop_repeats(row), k) for row in _rows_of(pieces[shapely.length(pieces) >= tolerance])]
    if len(trimmed) == 1:
        notes.append(f"{trimmed[0]} sticks out of the sheet and was trimmed at the border")
    elif trimmed:
        notes.append(f"creases stick out of the sheet and were trimmed at the border: {_listed(trimmed)}")
    return parts


def _overlaps(line: LineString, border: LineString) -> bool:
    return bool(_lines_of(line.intersection(border)).length > 0)


def _lines_of(geometry: shapely.Geometry) -> shapely.MultiLineString:
    """The line parts of any geometry."""
    parts = shapely.get_parts(shapely.get_parts(geometry))  # a collection may hold lines of many parts
    lines = shapely.get_type_id(parts) == shapely.GeometryType.LINESTRING
    return shapely.multilinestrings(parts[lines & (shapely.length(parts) > 0)])


def _rows_of(lines: Lines) -> list[FloatArray]:
    """The points (P,2) of each line."""
    coordinates, index = shapely.get_coordinates(lines, return_index=True)
    return np.split(coordinates, np.searchsorted(index, np.arange(1, len(lines)))) if len(lines) else []


def _rejoin(pieces: Lines, points: FloatArray) -> Lines:
    """Join pieces that shapely cut at a self-crossing or at a closed curve's start, and orient them."""
    if len(pieces) < 2:
        return pieces
    merged = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(pieces)))
    rows = _rows_of(merged)
    middles = [len(row) // 2 for row in rows]
    ends = [[row[max(m - 1, 0)], row[min(m, len(row) - 1)]] for row, m in zip(rows, middles, strict=True)]
    along = places_along([points], np.zeros(2 * len(rows), dtype=np.int64), np.concatenate(ends)).reshape(-1, 2)
    return np.where(along[:, 1] >= along[:, 0], merged, shapely.reverse(merged))


def _snap_ends(
    sheet: Polygon,
    parts: list[tuple[FloatArray, int]],
    labels: list[str],
    tolerance: float,
    notes: list[str],
) -> list[tuple[FloatArray, int]]:
    border = sheet.boundary
    ends = [
        (k, side, points[0] if side == 0 else points[-1])
        for k, (points, _) in enumerate(parts)
        if not np.array_equal(points[0], points[-1])
        for side in (0, 1)
    ]
    if not ends:
        return parts
    places = np.array([place for _, _, place in ends])
    target = places.copy()
    moved = np.zeros(len(ends), dtype=bool)
    to_border = shapely.distance(shapely.points(places), border)
    on_border = to_border <= tolerance
    target[on_border] = _nearest_on(border, places[on_border])
    moved |= on_border
    # Ends that meet each other: one common point, the mean; a point on the border wins.
    around = cKDTree(places).query_ball_point(places, tolerance * (1 + 1e-9), return_sorted=True)
    for n, near in enumerate(around):
        if len(near) == 1:
            continue
        close = np.array(near, dtype=np.int64)
        close = close[np.hypot(*(places[close] - places[n]).T) <= tolerance]
        if len(close) > 1 and close[0] == n:
            fixed = close[on_border[close]]
            target[close] = target[fixed[0]] if len(fixed) else places[close].mean(axis=0)
            moved[close] = True
    result = [points.copy() for points, _ in parts]
    lines = line_strings([points for points, _ in parts])
    tree = shapely.STRtree(lines)
    for n, (k, _side, place) in enumerate(ends):
        if moved[n]:
            continue
        # Boxes are enough: what is nearest is measured below, and a predicate costs more than that.
        near = np.sort(tree.query(shapely.box(*(place - tolerance), *(place + tolerance))))
        own = _far_part(parts[k][0], _side, 4 * tolerance)
        candidates = [lines[j] for j in near if j != k] + ([own] if own is not None else [])
        if not candidates:
            continue
        distances = shapely.distance(Point(place), candidates)
        best = int(np.argmin(distances))
        if distances[best] <= tolerance:
            target[n] = _nearest_on(candidates[best], place[None])[0]
            moved[n] = True
    _extend(border, [points for points, _ in parts], ends, tree, lines, target, moved, tolerance)
    joined: list[str] = []
    for n, (k, side, place) in enumerate(ends):
        gap = float(np.hypot(*(target[n] - place)))
        if not moved[n] or gap == 0.0:
            continue
        row = result[k]
        result[k] = np.vstack([target[n][None], row]) if side == 0 else np.vstack([row, target[n][None]])
        if gap > 1e-3 * tolerance:
            joined.append(labels[parts[k][1]])
    if joined:
        notes.append(f"ends that missed by a little were joined: {_listed(joined)}")
    return [(drop_repeats(points), crease) for points, (_, crease) in zip(result, parts, strict=True)]


def _extend(
    border: shapely.Geometry,
    rows: list[FloatArray],
    ends: list[tuple[int, int, FloatArray]],
    tree: shapely.STRtree,
    lines: Lines,
    target: FloatArray,
    moved: BoolArray,
    tolerance: float,
) -> None:
    """Ends (part, side, place) that have not moved yet go on to what they point at; in place of target and moved.

    Those that point at each other meet in the middle. Others go straight on to the first line in their way, or to
    the nearest place where that lies almost straight ahead. What lies sideways is not meant.
    """
    if tolerance >= END_REACH:
        return
    free = np.flatnonzero(~moved)
    places = np.array([ends[n][2] for n in free]).reshape(-1, 2)
    headings = np.array([_heading(rows[ends[n][0]], ends[n][1]) for n in free]).reshape(-1, 2)
    lengths = np.array([_length(rows[ends[n][0]]) for n in free])
    part = np.array([ends[n][0] for n in free], dtype=np.int64)
    reach = np.minimum(END_REACH, _PART_EXTENDED * lengths)
    for members in _meeting(border, places, headings, part, lengths, reach, tree, lines):
        target[free[members]] = places[members].mean(axis=0)
        moved[free[members]] = True
    for m in np.flatnonzero(~moved[free]).tolist():
        if reach[m] <= tolerance:
            continue
        far = _ALONG_HEADING * reach[m]
        around = np.sort(tree.query(shapely.Point(places[m]).buffer(far)))
        own = _far_part(rows[part[m]], ends[free[m]][1], 4 * END_REACH)
        others = [border, *(lines[j] for j in around if j != part[m]), *([own] if own is not None else [])]
        place = _ahead(places[m], headings[m], reach[m], np.array(others, dtype=object))
        if place is not None:
            target[free[m]], moved[free[m]] = place, True


def _meeting(
    border: shapely.Geometry,
    places: FloatArray,
    headings: FloatArray,
    part: IntArray,
    lengths: FloatArray,
    reach: FloatArray,
    tree: shapely.STRtree,
    lines: Lines,
) -> list[IntArray]:
    """Groups of ends that point at each other with nothing between them: all at once, or two by two."""
    if len(places) < 2:
        return []
    pairs = cKDTree(places).query_pairs(END_REACH, output_type="ndarray")
    a, b = pairs.T
    gap = places[b] - places[a]
    distance = np.hypot(*gap.T)
    most = np.minimum(reach[a], reach[b])
    most = np.where(part[a] == part[b], np.minimum(most, _PART_CLOSED * lengths[a]), most)
    facing = np.minimum(_dots(gap, headings[a]), -_dots(gap, headings[b])) > np.cos(_TO_AN_END) * distance
    meant = np.flatnonzero(facing & (distance <= most))
    clear = []
    for k in meant[np.lexsort((b[meant], a[meant], distance[meant]))].tolist():
        between = LineString(places[pairs[k]])
        crossed = np.setdiff1d(tree.query(between, predicate="intersects"), part[pairs[k]])
        if not len(crossed) and not between.intersects(border):
            clear.append(k)
    pairs = pairs[clear]
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(places),) * 2)
    label = connected_components(graph, directed=False)[1]
    result: list[IntArray] = []
    for one in np.unique(label[pairs[:, 0]]):
        members = np.flatnonzero(label == one)
        gap = places[members].mean(axis=0) - places[members]
        distance = np.hypot(*gap.T)
        at_once = (distance <= reach[members]) & (_dots(gap, headings[members]) > np.cos(_TO_AN_END) * distance)
        if at_once.all():
            result.append(members)
            continue
        left = set(members.tolist())
        for pair in pairs[label[pairs[:, 0]] == one]:
            if left >= set(pair.tolist()):
                left -= set(pair.tolist())
                result.append(pair)
    return result


def _ahead(place: FloatArray, heading: FloatArray, reach: float, others: Lines) -> FloatArray | None:
    """The point (2,) that an end goes on to, if it points at one of the others within its reach."""
    near = shapely.distance(shapely.Point(place), others) <= reach
    if not near.any():
        return None
    ray = LineString([place, place + _ALONG_HEADING * reach * heading])
    hits, line = shapely.get_coordinates(shapely.intersection(ray, others), return_index=True)
    if len(hits):
        first = np.argmin(np.hypot(*(hits - place).T))
        return np.asarray(hits[first]) if near[line[first]] else None
    nearest = np.concatenate([_nearest_on(line, place[None]) for line in others[near]])
    gap = nearest - place
    straight = gap @ heading >= np.cos(_TO_A_PLACE) * np.hypot(*gap.T)
    nearest, gap = nearest[straight], gap[straight]
    return np.asarray(nearest[np.argmin(np.hypot(*gap.T))]) if len(nearest) else None


def _heading(points: FloatArray, side: int) -> FloatArray:
    """The direction (2,) in which a polyline would go on beyond its end ``side``."""
    row = points if side == 0 else points[::-1]
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(row, axis=0).T))])
    back = LineString(row).interpolate(min(_HEADING, 0.5 * float(along[-1])))
    step = row[0] - np.array([back.x, back.y])
    return np.asarray(step / max(float(np.hypot(*step)), 1e-300))


def _length(points: FloatArray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def _dots(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("nc,nc->n", first, second))


def _nearest_on(line: shapely.Geometry, places: FloatArray) -> FloatArray:
    """The points (N,2) of a line that are nearest to the places (N,2)."""
    along = shapely.line_locate_point(line, shapely.points(places))
    return np.asarray(shapely.get_coordinates(shapely.line_interpolate_point(line, along)))


def _listed(labels: list[str]) -> str:
    """The different labels, the first few by name."""
    names = list(dict.fromkeys(labels))
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")


def _far_part(points: FloatArray, side: int, distance: float) -> LineString | None:
    """The polyline without the part within ``distance`` (along it) of its end ``side``."""
    row = points if side == 0 else points[::-1]
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(row, axis=0).T))])
    rest = row[along > distance]
    return LineString(rest) if len(rest) > 1 else None


def _node(
    sheet: Polygon, parts: list[tuple[FloatArray, int]], node: float
) -> tuple[IntArray, IntArray, FloatArray]:
    """Segments (S,2) of node indices, the crease that owns each (-1 border), node coordinates (N,2)."""
    creases = line_strings([points for points, _ in parts])
    # Targets of snapped ends lie on their line only up to rounding: put a node there.
    ends = np.array([p for points, _ in parts for p in (points[0], points[-1])])
    border = shapely.snap(sheet.boundary, shapely.MultiPoint(ends), 10 * node)
    creases = _snapped(creases, ends, 10 * node)
    merged = shapely.union_all([border, *creases], grid_size=node)
    segments, points = segments_of(merged, node)
    middle = 0.5 * (points[segments[:, 0]] + points[segments[:, 1]])
    owner = nearest_line(creases, middle, 50 * node)
    owner = np.where(owner >= 0, np.array([crease for _, crease in parts])[owner], -1)
    on_border = shapely.distance(shapely.points(middle), border) < 50 * node
    owner[on_border] = -1
    keep = (owner >= 0) | on_border
    return segments[keep], owner[keep], points


def _snapped(lines: Lines, ends: FloatArray, within: float) -> Lines:
    """The lines with points where ends (N,2) lie on them."""
    if len(lines) * len(ends) <= _MANY_SNAPS:
        return np.asarray(shapely.snap(lines, shapely.MultiPoint(ends), within))
    # Shapely looks at all ends for every line: here it is told the near ones alone, once, in the same order.
    ends = ends[np.sort(np.unique(ends, axis=0, return_index=True)[1])]
    line, end = shapely.STRtree(shapely.points(ends)).query(lines, predicate="dwithin", distance=2 * within)
    order = np.lexsort((end, line))
    near = shapely.multipoints(ends[end[order]], indices=line[order])
    return np.asarray(shapely.snap(lines, near, within))


def segments_of(lines: shapely.Geometry, node: float) -> tuple[IntArray, FloatArray]:
    """Unique undirected segments (S,2) of node indices and node coordinates (N,2) of noded lines."""
    coordinates, index = shapely.get_coordinates(shapely.get_parts(lines), return_index=True)
    # unique by value on the noding grid; the first occurrence keeps its exact coordinates
    keys = np.round(coordinates / node).astype(np.int64)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    inverse = inverse.reshape(-1)
    joined = index[1:] == index[:-1]
    segments = np.column_stack([inverse[:-1], inverse[1:]])[joined]
    segments = np.sort(segments[segments[:, 0] != segments[:, 1]], axis=1)
    return np.unique(segments, axis=0), coordinates[first]


def nearest_line(lines: Lines, points: FloatArray, within: float) -> IntArray:
    """Index (N,) of the first line within a distance of each point, -1 where there is none."""
    result = np.full(len(points), -1, dtype=np.int64)
    # By segments: a tree of whole curves has boxes that hold half of the sheet.
    coordinates, line = shapely.get_coordinates(lines, return_index=True)
    joined = np.flatnonzero(line[1:] == line[:-1])
    tree = shapely.STRtree(shapely.linestrings(np.stack([coordinates[joined], coordinates[joined + 1]], axis=1)))
    which, segment = tree.query(shapely.points(points), predicate="dwithin", distance=within)
    owner = line[joined][segment]
    order = np.argsort(-owner, kind="stable")  # the lowest index is written last and stays
    result[which[order]] = owner[order]
    return result


def _merge_vertices(
    segments: IntArray, owner: IntArray, points: FloatArray, tolerance: float
) -> tuple[IntArray, IntArray, FloatArray]:
    """One vertex where several lie within the tolerance: creases that should meet in a point but just miss.

    A vertex on the border stays on the border; what was between the merged vertices disappears.
    """
    count = len(points)
    on_border = np.zeros(count, dtype=bool)
    on_border[segments[owner < 0].ravel()] = True
    crease_degree = _degrees(segments[owner >= 0], count)
    special = (crease_degree > 0) & (on_border | (crease_degree != 2))
    marks = np.flatnonzero(special)
    if len(marks) < 2:
        return segments, owner, points
    pairs = cKDTree(points[marks]).query_pairs(tolerance, output_type="ndarray")
    if len(pairs) == 0:
        return segments, owner, points
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(marks),) * 2)
    _, label = connected_components(graph, directed=False)
    target = np.arange(count)
    points = points.copy()
    tree = cKDTree(points)
    members_of = np.split(marks[np.argsort(label, kind="stable")], np.cumsum(np.bincount(label))[:-1])
    moved: list[int] = []
    for members in members_of:
        if len(members) == 1:
            continue
        rim = members[on_border[members]]
        # One border junction each: two junctions nearer than the tolerance would otherwise pull the border in.
        keep = int(rim[0]) if len(rim) else int(members[0])
        if not len(rim):
            points[keep] = points[members].mean(axis=0)
            moved.append(keep)
        reach = np.hypot(*(points[members] - points[keep]).T).max() * (1 + 1e-9)
        # The tree knows where points were: those that have moved since are looked at as well.
        near = np.unique([*tree.query_ball_point(points[keep], reach * (1 + 1e-9)), *moved])
        near = near[np.hypot(*(points[near] - points[keep]).T) <= reach]
        inside = near[~on_border[near] | np.isin(near, members)]
        target[inside] = keep
    segments = np.sort(target[segments], axis=1)
    alive = segments[:, 0] != segments[:, 1]
    segments, owner = segments[alive], owner[alive]
    # Border first, then the earlier crease, where two segments have become one.
    order = np.lexsort((owner, segments[:, 1], segments[:, 0]))
    segments, owner = segments[order], owner[order]
    first = np.ones(len(segments), dtype=bool)
    first[1:] = (segments[1:] != segments[:-1]).any(axis=1)
    return segments[first], owner[first], points


def _degrees(segments: IntArray, count: int) -> IntArray:
    return np.bincount(segments.ravel(), minlength=count)


def _drop_whiskers(
    segments: IntArray, owner: IntArray, points: FloatArray, tolerance: float
) -> tuple[IntArray, IntArray]:
    """Remove dead ends shorter than the tolerance: a crease drawn a little past another one."""
    neighbours: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for s, (a, b) in enumerate(segments.tolist()):
        neighbours[a].append((b, s))
        neighbours[b].append((a, s))
    drop: set[int] = set()
    for start in [n for n, around in neighbours.items() if len(around) == 1]:
        node, length, path = start, 0.0, []
        came = -1
        while True:
            onward = [(m, s) for m, s in neighbours[node] if s != came]
            if node != start and len(onward) != 1:
                break
            other, came = onward[0]
            length += float(np.hypot(*(points[other] - points[node])))
            path.append(came)
            node = other
            if length >= tolerance:
                break
        if length < tolerance and len(neighbours[node]) > 2:
            drop.update(path)
    if not drop:
        return segments, owner
    keep = np.ones(len(segments), dtype=bool)
    keep[list(drop)] = False
    return segments[keep], owner[keep]


def _drop_slivers(
    segments: IntArray,
    owner: IntArray,
    points: FloatArray,
    tolerance: float,
    labels: list[str],
    notes: list[str],
    locate: Callable[[FloatArray], FloatArray],
) -> tuple[IntArray, IntArray]:
    """Remove one side of every face thinner than the tolerance (curves drawn twice)."""
    lines = shapely.linestrings(points[segments])
    middles = shapely.points(0.5 * (points[segments[:, 0]] + points[segments[:, 1]]))
    for _ in range(20):
        faces = shapely.get_parts(shapely.polygonize(lines))
        if len(faces) == 0:
            return segments, owner
        width = 2 * shapely.area(faces) / shapely.length(faces)
        thin = np.flatnonzero(width < 0.5 * tolerance)
        if len(thin) == 0:
            return segments, owner
        face = faces[thin[0]]
        if len(thin) > _MAX_SLIVERS:
            raise PatternError(
                f"the creases leave {len(thin):,} pieces of paper between them that are thinner than a thousandth "
                "of the sheet, which no net can hold",
                element="creases",
                place=tuple(locate(shapely.get_coordinates(face.representative_point()))[0].tolist()),
            )
        around = shapely.distance(middles, face.boundary) < 1e-6 * tolerance
        candidates = np.unique(owner[around & (owner >= 0)])
        if len(candidates) == 0:
            return segments, owner
        # The later crease gives way; a crease that doubles back on itself loses half of the sliver's rim.
        loser = candidates[-1]
        drop = around & (owner == loser)
        if len(candidates) == 1 and not (around & (owner == -1)).any():
            rim = shapely.get_coordinates(face.exterior)
            half = LineString(rim[: len(rim) // 2 + 1])
            drop &= shapely.distance(middles, half) < 1e-6 * tolerance
        x, y = locate(shapely.get_coordinates(face.representative_point()))[0]
        notes.append(f"{labels[loser]} runs along another line near ({x:.4g}, {y:.4g}) and was merged with it")
        segments, owner, lines, middles = segments[~drop], owner[~drop], lines[~drop], middles[~drop]
    return segments, owner


def _chains(
    segments: IntArray, owner: IntArray, points: FloatArray, lines: list[FloatArray]
) -> tuple[tuple[Chain, ...], FloatArray, tuple[str, ...]]:
    count = len(points)
    crease = owner >= 0
    crease_degree = _degrees(segments[crease], count)
    border_degree = _degrees(segments[~crease], count)
    neighbours: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for s in np.flatnonzero(crease).tolist():
        a, b = segments[s].tolist()
        neighbours[a].append((b, s))
        neighbours[b].append((a, s))
    kinds: dict[int, str] = {}
    for n, around in neighbours.items():
        if border_degree[n] > 0:
            kinds[n] = JUNCTION
        elif crease_degree[n] == 1:
            kinds[n] = END
        elif crease_degree[n] > 2:
            kinds[n] = CROSSING
        else:
            (a, _), (b, _) = around
            u, v = points[n] - points[a], points[b] - points[n]
            turn = abs(np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v))
            if turn > CORNER:
                kinds[n] = CORNER_POINT
            elif owner[around[0][1]] != owner[around[1][1]]:
                kinds[n] = CROSSING
    used: set[int] = set()
    rows: list[FloatArray] = []
    creases: list[int] = []
    closed: list[bool] = []

    def walk(start: int, first: tuple[int, int]) -> None:
        path, (node, segment) = [start], first
        mark = segment
        while True:
            used.add(segment)
            path.append(node)
            if node in kinds or node == start:
                break
            node, segment = next((m, s) for m, s in neighbours[node] if s != segment)
        rows.append(points[np.array(path)])
        creases.append(int(owner[mark]))
        closed.append(path[0] == path[-1] and start not in kinds)

    for n in sorted(kinds):
        for step in sorted(neighbours[n]):
            if step[1] not in used:
                walk(n, step)
    for n in sorted(neighbours):
        for step in sorted(neighbours[n]):
            if step[1] not in used:
                walk(n, step)
    which = np.array(creases, dtype=np.int64)
    rows = _turned(rows, lines, which)
    chains = [
        Chain(rows[k], creases[k], closed[k]) for k in np.lexsort((_starts(rows, lines, which), which)).tolist()
    ]
    order = sorted(kinds)
    vertices = points[np.array(order, dtype=np.int64)].reshape(-1, 2)
    return tuple(chains), vertices, tuple(kinds[n] for n in order)


def _starts(rows: list[FloatArray], lines: list[FloatArray], which: IntArray) -> FloatArray:
    """Where along their creases ``which`` the chains lie: their middles."""
    a, b = _middle_segments(rows)
    return places_along(lines, which, 0.5 * (a + b))


def _turned(rows: list[FloatArray], lines: list[FloatArray], which: IntArray) -> list[FloatArray]:
    """The chains turned to run in the directions of their creases ``which``."""
    a, b = _middle_segments(rows)
    # Two points a quarter of the middle segment in: away from crossings and from a closed line's start.
    quarters = np.concatenate([0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b])
    near, far = places_along(lines, np.tile(which, 2), quarters).reshape(2, -1)
    return [row if ahead else row[::-1] for row, ahead in zip(rows, far >= near, strict=True)]


def _middle_segments(rows: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    ends = np.array([row[len(row) // 2 - 1 : len(row) // 2 + 1] for row in rows])
    return ends[:, 0], ends[:, 1]
