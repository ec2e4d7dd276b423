"""The drawing laid over the grid: nodes, segments and the faces (cell pieces) that they bound.

Every face lies in one grid cell and in one patch. Noding by shapely, faces by half-edge traversal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from shapely import LineString, Polygon

from ..arrays import BoolArray, FloatArray, IntArray
from ..pattern.arrangement import Arrangement, nearest_line, segments_of
from ..pattern.places import line_strings
from .grid import OrthogonalGrid

#: Noding grid, cell lengths: nodes snap to multiples of it. Far above rounding at 1,000 cells.
NODE = 1e-11
#: A point this near to a line lies on it, cell lengths (snapping moves nodes by about NODE).
ON_LINE = 2e-9
#: Pieces of a cell smaller than this part of it carry no quad of their own.
MIN_PIECE = 1e-6
#: The crease points around a patch must span this area, cells; below it the patch joins a neighbour.
#: A hinge must be this long, twice over (a hull's outline), cell lengths.
MIN_HOLD, MIN_HINGE = 0.02, 2.0


@dataclass(frozen=True, eq=False)
class Overlay:
    """points (N,2) nodes; line_x, line_y (N,) grid line through a node or -1.

    segments (S,2) nodes; chain (S,) crease chain or -1; border (S,) on the sheet's rim
    left, right (S,) face on each side of the segment's direction, -1 outside the sheet
    loop_start (F+1,), loop_nodes (L,) the faces' outlines, counter-clockwise
    cell (F,2) grid cell of a face; patch (F,) patch of a face; area (F,)
    """

    points: FloatArray
    line_x: IntArray
    line_y: IntArray
    segments: IntArray
    chain: IntArray
    border: BoolArray
    left: IntArray
    right: IntArray
    loop_start: IntArray
    loop_nodes: IntArray
    cell: IntArray
    patch: IntArray
    area: FloatArray
    lost_chains: tuple[int, ...]


def overlay(arrangement: Arrangement, grid: OrthogonalGrid) -> Overlay:
    """Lay an arrangement over its grid. All coordinates in cell lengths."""
    sheet = arrangement.sheet
    chains = line_strings([chain.points for chain in arrangement.chains])
    x0, x1, y0, y1 = grid.xs[0], grid.xs[-1], grid.ys[0], grid.ys[-1]
    verticals = [LineString([(x, y0), (x, y1)]) for x in grid.xs]
    horizontals = [LineString([(x0, y), (x1, y)]) for y in grid.ys]
    merged = shapely.union_all([sheet.boundary, *chains, *verticals, *horizontals], grid_size=NODE)
    segments, points = segments_of(merged, NODE)
    line_x, line_y = _line_of(points[:, 0], grid.xs), _line_of(points[:, 1], grid.ys)
    middle = 0.5 * (points[segments[:, 0]] + points[segments[:, 1]])
    rims = line_strings([shapely.get_coordinates(ring) for ring in (sheet.exterior, *sheet.interiors)])
    border = nearest_line(rims, middle, ON_LINE) >= 0
    chain = nearest_line(chains, middle, ON_LINE)
    chain[border] = -1
    shapely.prepare(sheet)
    keep = border | (chain >= 0) | shapely.contains_xy(sheet, middle)
    segments, chain, border = segments[keep], chain[keep], border[keep]
    keep = _main_component(segments, len(points), line_x, line_y)
    keep &= _not_dangling(segments, keep, len(points))
    lost = sorted(set(chain[~keep].tolist()) - set(chain[keep].tolist()) - {-1})
    segments, chain, border = segments[keep], chain[keep], border[keep]
    while True:
        left, right, loop_start, loop_nodes, area = _faces(points, segments, border, sheet)
        island = _islands(points, line_x, line_y, segments, chain, border, left, right, area)
        if not island.any():
            break
        lost = sorted(set(lost) | set(chain[island].tolist()))
        keep = ~island
        keep &= _not_dangling(segments, keep, len(points))
        segments, chain, border = segments[keep], chain[keep], border[keep]
    centre = np.add.reduceat(points[loop_nodes], loop_start[:-1], axis=0) / np.diff(loop_start)[:, None]
    cell = np.column_stack(
        [
            np.clip(np.searchsorted(grid.xs, centre[:, 0]) - 1, 0, len(grid.xs) - 2),
            np.clip(np.searchsorted(grid.ys, centre[:, 1]) - 1, 0, len(grid.ys) - 2),
        ]
    )
    through = (chain < 0) & ~border & (left >= 0) & (right >= 0)
    patch = _components(left[through], right[through], len(area))
    return Overlay(
        points,
        line_x,
        line_y,
        segments,
        chain,
        border,
        left,
        right,
        loop_start,
        loop_nodes,
        cell,
        patch,
        area,
        tuple(lost),
    )


def _islands(
    points: FloatArray,
    line_x: IntArray,
    line_y: IntArray,
    segments: IntArray,
    chain: IntArray,
    border: BoolArray,
    left: IntArray,
    right: IntArray,
    area: FloatArray,
) -> BoolArray:
    """Crease segments (S,) to give up around patches that too few crease points would hold; all False: none.

    A patch hangs on its neighbours at points on grid lines; where these span no area it could turn freely.
    A patch that another one joins waits for the next turn.
    """
    inner = ~border & (left >= 0) & (right >= 0)
    through = inner & (chain < 0)
    patch = _components(left[through], right[through], len(area))
    given = np.zeros(len(segments), dtype=bool)
    count = int(patch.max()) + 1
    # Every rim segment twice: for the patch on its left and for the one on its right.
    rim = np.flatnonzero(inner & (chain >= 0))
    rim = rim[patch[left[rim]] != patch[right[rim]]]
    sides = np.concatenate([patch[left[rim]], patch[right[rim]]])
    order = np.lexsort((np.tile(rim, 2), sides))
    mine, other = np.tile(rim, 2)[order], np.concatenate([sides[len(rim) :], sides[: len(rim)]])[order]
    start = np.searchsorted(sides[order], np.arange(count + 1))
    area_held, length_held = _holds(points, (line_x >= 0) | (line_y >= 0), segments[mine], sides[order], count)
    small = np.bincount(patch, weights=area) <= MIN_PIECE
    loose = small | ((area_held < MIN_HOLD) & (length_held < MIN_HINGE))
    lengths = np.hypot(*(points[segments[:, 1]] - points[segments[:, 0]]).T)
    joins, joined = np.zeros((2, count), dtype=bool)
    for one in np.flatnonzero(loose & (np.diff(start) > 0)).tolist():
        own = slice(start[one], start[one + 1])
        around, place = np.unique(other[own], return_inverse=True)
        most = int(around[np.bincount(place, weights=lengths[mine[own]]).argmax()])
        if joined[one] or joins[most]:
            continue
        joins[one] = joined[most] = True
        given[mine[own][other[own] == most]] = True
    return given


def _holds(
    points: FloatArray, held: BoolArray, rims: IntArray, patches: IntArray, count: int
) -> tuple[FloatArray, FloatArray]:
    """Area and outline (count,) of what the held nodes of the rim segments (R,2) of each patch span."""
    pairs = np.unique(np.column_stack([np.repeat(patches, 2), rims.ravel()]), axis=0)
    pairs = pairs[held[pairs[:, 1]]]
    some, group = np.unique(pairs[:, 0], return_inverse=True)
    hulls = shapely.convex_hull(shapely.multipoints(points[pairs[:, 1]], indices=group))
    areas, outlines = np.zeros((2, count))
    areas[some], outlines[some] = shapely.area(hulls), shapely.length(hulls)
    return areas, outlines


def _line_of(values: FloatArray, lines: FloatArray) -> IntArray:
    near = np.clip(np.searchsorted(lines, values), 1, len(lines) - 1)
    near = np.where(values - lines[near - 1] < lines[near] - values, near - 1, near)
    return np.where(np.abs(lines[near] - values) <= ON_LINE, near, -1)


def _components(a: IntArray, b: IntArray, count: int) -> IntArray:
    """Label (count,) of the connected component of each of ``count`` things joined by pairs (a, b)."""
    graph = coo_matrix((np.ones(len(a)), (a, b)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _main_component(segments: IntArray, count: int, line_x: IntArray, line_y: IntArray) -> BoolArray:
    """Segments of the component that most grid vertices belong to: lone curves inside a cell drop out."""
    label = _components(segments[:, 0], segments[:, 1], count)
    # Grid vertices off the sheet have no segments left. Where the sheet has none at all, most nodes decide.
    used = np.bincount(segments.ravel(), minlength=count) > 0
    corner = used & (line_x >= 0) & (line_y >= 0)
    main = np.bincount(label, weights=corner + used / (count + 1.0)).argmax()
    return np.asarray(label[segments[:, 0]] == main)


def _not_dangling(segments: IntArray, alive: BoolArray, count: int) -> BoolArray:
    """False for dead ends inside a cell: they bound no face."""
    keep = alive.copy()
    while True:
        degree = np.bincount(segments[keep].ravel(), minlength=count)
        dead = keep & ((degree[segments] == 1).any(axis=1))
        if not dead.any():
            return keep
        keep &= ~dead


def _faces(
    points: FloatArray, segments: IntArray, border: BoolArray, sheet: Polygon
) -> tuple[IntArray, IntArray, IntArray, IntArray, FloatArray]:
    count = len(segments)
    tail = np.concatenate([segments[:, 0], segments[:, 1]])
    head = np.concatenate([segments[:, 1], segments[:, 0]])
    direction = points[head] - points[tail]
    angle = np.arctan2(direction[:, 1], direction[:, 0])
    order = np.lexsort((angle, tail))
    rank = np.empty(2 * count, dtype=np.int64)
    rank[order] = np.arange(2 * count)
    start = np.searchsorted(tail[order], np.arange(len(points) + 1))
    # After half-edge h comes, around its head, the one clockwise before h's twin: the face on the left.
    twin = np.concatenate([np.arange(count, 2 * count), np.arange(count)])
    position = rank[twin] - 1
    first = start[head]
    position = np.where(position < first, start[head + 1] - 1, position)
    following = order[position]
    label = np.full(2 * count, -1, dtype=np.int64)
    loops: list[list[int]] = []
    next_list = following.tolist()
    seen = bytearray(2 * count)
    for h in range(2 * count):
        if seen[h]:
            continue
        loop = []
        while not seen[h]:
            seen[h] = 1
            loop.append(h)
            h = next_list[h]
        loops.append(loop)
    starts = np.concatenate([[0], np.cumsum([len(loop) for loop in loops])])
    flat = np.array([h for loop in loops for h in loop], dtype=np.int64)
    p, q = points[tail[flat]], points[head[flat]]
    # Cross products about each loop's first point keep small faces accurate.
    base = points[tail[flat[starts[:-1]]]].repeat(np.diff(starts), axis=0)
    cross = (p - base)[:, 0] * (q - base)[:, 1] - (p - base)[:, 1] * (q - base)[:, 0]
    area = 0.5 * np.add.reduceat(cross, starts[:-1])
    inside = area > 0
    # Walked from inside, a hole's rim encloses area too.
    rim = np.logical_and.reduceat(np.concatenate([border, border])[flat], starts[:-1])
    for k in np.flatnonzero(inside & rim):
        ring = Polygon(points[tail[flat[starts[k] : starts[k + 1]]]])
        inside[k] = sheet.contains(ring.representative_point())
    number = np.where(inside, np.cumsum(inside) - 1, -1)
    label[flat] = number.repeat(np.diff(starts))
    kept = inside.repeat(np.diff(starts))
    lengths = np.diff(starts)[inside]
    loop_start = np.concatenate([[0], np.cumsum(lengths)])
    return label[:count], label[count:], loop_start, tail[flat][kept], area[inside]
