"""From a crease pattern to its piecewise DOG."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely
from shapely import LineString, Polygon

from ..arrays import FloatArray, IntArray
from ..description import RESOLUTIONS
from ..errors import NetError, PatternError
from ..pattern.arrangement import CROSSING, Arrangement, arrange, sheet_polygon
from ..pattern.crease_pattern import Crease, CreasePattern
from ..pattern.curves import sample_crease
from .crease_points import find_crease_points
from .frame import NetFrame, border_direction
from .grid import OrthogonalGrid, crossings_held, place_grid, snap_vertices
from .net_points import NodeCopies, node_copies
from .overlay import ON_LINE, Overlay, overlay
from .piecewise_dog import PiecewiseDog, Stitches
from .render_map import build_render_map
from .topology import Topology, build_topology

#: Samples of a crease are at most this far apart before noding, cell lengths.
_SAMPLE_SPACING = 0.08
#: A sheet narrower than this many cells cannot bend in its width.
_MIN_CELLS_ACROSS = 1.0
#: A net of more vertices than this is refused before memory is gone: folding takes about 25 KB a vertex.
MAX_VERTICES = 100_000
#: Curves of a drawing with more points than this are simplified, by at most this part of a cell; a drawing with
#: more points than the second number even then, or with more creases, is no crease pattern.
_MANY_POINTS, _SIMPLIFIED, _MAX_POINTS, _MAX_CREASES = 5_000, 1e-3, 20_000, 1_000
#: Creases that cross more often are refused before they are cut; so many of their segments are looked at.
_MAX_CROSSINGS, _CROSSING_SAMPLE = 20_000, 2_000


def build_net(pattern: CreasePattern, resolution: int = 32) -> PiecewiseDog:
    """The piecewise DOG of a crease pattern with ``resolution`` quads along the sheet's longer side.

    Raises PatternError for a drawing without anything to fold or with a border that crosses itself, and
    NetError when the resolution is out of range or the sheet is too thin for it.
    """
    if not isinstance(resolution, int | np.integer) or not RESOLUTIONS[0] <= resolution <= RESOLUTIONS[1]:
        raise NetError(f"the resolution must be a whole number from {RESOLUTIONS[0]} to {RESOLUTIONS[1]}")
    if not pattern.creases:
        raise PatternError("there is no crease, so there is nothing to fold", element="creases")
    if len(pattern.creases) > _MAX_CREASES:
        raise PatternError(
            f"the drawing has {len(pattern.creases):,} creases, more than {_MAX_CREASES:,}", element="creases"
        )
    pattern, note = _simplified(pattern, resolution)
    sheet_polygon(pattern.boundary, pattern.holes)  # in drawing units, so that errors name the user's place
    frame = _frame(pattern, int(resolution))
    arrangement = _arrange(pattern, frame)
    _check_crossings(arrangement, int(resolution))
    grid = place_grid(arrangement)
    arrangement = snap_vertices(arrangement, grid)
    over = overlay(arrangement, grid)
    topology = build_topology(over, grid)
    if len(topology.vertex_grid) > MAX_VERTICES:
        raise NetError(f"the net has more than {MAX_VERTICES:,} vertices; use a lower resolution")
    net = _assemble(pattern, frame, arrangement, grid, over, topology)
    return replace(net, notes=(*note, *net.notes))


def _simplified(pattern: CreasePattern, resolution: int) -> tuple[CreasePattern, tuple[str, ...]]:
    """The pattern without points that no net of this resolution can show, and a note when some were left out."""
    total = _point_count(pattern)
    if total <= _MANY_POINTS:
        return pattern, ()
    tolerance = _SIMPLIFIED * float(np.ptp(pattern.boundary, axis=0).max()) / resolution
    rings = [_fewer(ring, True, tolerance) for ring in (pattern.boundary, *pattern.holes)]
    creases = [
        Crease(_fewer(c.points, c.closed, tolerance), c.closed, c.assignment, c.name) for c in pattern.creases
    ]
    fewer = CreasePattern(rings[0], rings[1:], creases, pattern.name, pattern.unit_mm, pattern.notes)
    left = _point_count(fewer)
    if left > _MAX_POINTS:
        raise PatternError(
            f"the drawing has {total:,} points, and {left:,} after simplifying its curves; "
            f"more than {_MAX_POINTS:,} are not read"
        )
    return fewer, (f"the drawing's {total:,} points were simplified to {left:,}",)


def _point_count(pattern: CreasePattern) -> int:
    curves = [pattern.boundary, *pattern.holes, *(crease.points for crease in pattern.creases)]
    return sum(len(curve) for curve in curves)


def _fewer(points: FloatArray, closed: bool, tolerance: float) -> FloatArray:
    line = np.vstack([points, points[:1]]) if closed else points
    kept = shapely.get_coordinates(LineString(line - line[0]).simplify(tolerance)) + line[0]
    # Less than a triangle is left of a ring smaller than the tolerance: it stays as it is.
    if len(kept) < (4 if closed else 2):
        return points
    return kept[:-1] if closed else kept


def _frame(pattern: CreasePattern, resolution: int) -> NetFrame:
    angle = border_direction(pattern.boundary)
    turned = NetFrame((0.0, 0.0), angle, 1.0).to_net(pattern.boundary - pattern.boundary[0])
    low, high = turned.min(axis=0), turned.max(axis=0)
    width, height = high - low
    unit = float(max(width, height)) / resolution
    if min(width, height) < _MIN_CELLS_ACROSS * unit:
        needed = int(np.ceil(_MIN_CELLS_ACROSS * max(width, height) / min(width, height)))
        raise NetError(
            f"the sheet is only {min(width, height):.4g} across, less than a cell of {unit:.4g}: "
            f"at least {needed} quads are needed along its longer side",
            element="border",
        )
    cells = round(width * height / unit**2)
    if cells > MAX_VERTICES:
        raise NetError(
            f"the net would have about {cells:,} vertices, more than {MAX_VERTICES:,}; use a lower resolution"
        )
    corner = NetFrame((0.0, 0.0), angle, 1.0).to_drawing(low[None])[0] + pattern.boundary[0]
    return NetFrame((float(corner[0]), float(corner[1])), angle, unit)


def _arrange(pattern: CreasePattern, frame: NetFrame) -> Arrangement:
    sheet = sheet_polygon(frame.to_net(pattern.boundary), tuple(frame.to_net(h) for h in pattern.holes))
    spacing = _SAMPLE_SPACING * frame.unit
    folded = [k for k, crease in enumerate(pattern.creases) if crease.assignment != "F"]
    if not folded:
        raise PatternError("every crease is marked flat (F), so there is nothing to fold", element="creases")
    lines = [frame.to_net(sample_crease(pattern.creases[k], spacing)) for k in folded]
    labels = [pattern.crease_label(k) for k in folded]
    crossings = _crossings(lines)
    if crossings > _MAX_CROSSINGS:
        raise PatternError(
            f"the creases cross about {crossings:,} times, more than {_MAX_CROSSINGS:,}", element="creases"
        )
    arrangement = arrange(sheet, lines, labels, frame.to_drawing)
    notes = arrangement.notes
    if len(folded) < len(pattern.creases):
        flat = ", ".join(pattern.crease_label(k) for k in sorted(set(range(len(pattern.creases))) - set(folded)))
        notes = (*notes, f"marked flat (F) and not folded: {flat}")
    chains = tuple(replace(chain, crease=folded[chain.crease]) for chain in arrangement.chains)
    return replace(arrangement, chains=chains, notes=notes)


def _crossings(lines: list[FloatArray]) -> int:
    """About how often the segments of polylines cross each other; exact for drawings that are not large."""
    segments = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    step = max(1, -(-len(segments) // _CROSSING_SAMPLE))
    sample = shapely.linestrings(segments[::step])
    return len(shapely.STRtree(sample).query(sample, predicate="crosses")[0]) // 2 * step**2


def _check_crossings(arrangement: Arrangement, resolution: int) -> None:
    """Raises NetError where creases cross more often than grid lines can."""
    count, held = arrangement.kinds.count(CROSSING), crossings_held(arrangement.sheet)
    if count > held:
        needed = int(np.ceil(resolution * np.sqrt(count / held)))
        raise NetError(
            f"the creases cross {count:,} times, and {resolution} quads along the longer side leave room for "
            f"{held:,} crossings at most: about {needed} quads are needed",
            element="creases",
        )


def _assemble(
    pattern: CreasePattern,
    frame: NetFrame,
    arrangement: Arrangement,
    grid: OrthogonalGrid,
    over: Overlay,
    topology: Topology,
) -> PiecewiseDog:
    copies = node_copies(over, topology, grid)
    chain_crease = np.array([chain.crease for chain in arrangement.chains], dtype=np.int64)
    flat = np.column_stack([grid.xs[topology.vertex_grid[:, 0]], grid.ys[topology.vertex_grid[:, 1]]])
    rest = frame.to_drawing(flat)
    surface = build_render_map(over, copies, chain_crease, frame.to_drawing(over.points), len(flat))
    points = find_crease_points(arrangement, over, topology, grid)
    polygons = _patch_polygons(arrangement, over, frame)
    notes = list(arrangement.notes) + list(grid.notes)
    lost = sorted({int(chain_crease[chain]) for chain in over.lost_chains})
    if lost:
        labels = ", ".join(pattern.crease_label(k) for k in lost[:4])
        more = f" and {len(lost) - 4} more" if len(lost) > 4 else ""
        notes.append(f"pieces smaller than a cell were left out: {labels}{more}; a finer resolution keeps them")
    if len(points.position) == 0:
        raise NetError("no crease crosses the grid: use a finer resolution", element="creases")
    # Mean grid edge 1, whatever the asked cell was: the weights of the terms are meant for that scale.
    lengths = np.hypot(*(flat[topology.edges[:, 1]] - flat[topology.edges[:, 0]]).T)
    mean = float(lengths.mean())
    return _in_net_units(
        PiecewiseDog(
            rest, flat, frame, topology.quads, topology.quad_patch, topology.vertex_patch, topology.edges,
            lengths, topology.stars, topology.links, topology.neighbours,
            _stitches(over, copies, arrangement), points, surface, polygons, chain_crease,
            tuple(pattern.crease_label(k) for k in range(len(pattern.creases))), tuple(notes),
            grid, topology, arrangement.sheet, over,
        ),
        mean,
    )  # fmt: skip


def _in_net_units(net: PiecewiseDog, mean: float) -> PiecewiseDog:
    """The same net with lengths divided by ``mean`` (cell lengths in, net units out)."""
    points = net.crease_points
    return replace(
        net,
        flat=_frozen(net.flat / mean),
        rest=_frozen(net.rest),
        frame=net.frame.scaled(mean),
        edge_length=_frozen(net.edge_length / mean),
        stitches=replace(net.stitches, position=net.stitches.position / mean),
        crease_points=replace(points, position=points.position / mean, along=points.along / mean),
        grid=OrthogonalGrid(net.grid.xs / mean, net.grid.ys / mean, net.grid.notes),
        sheet=shapely.transform(net.sheet, lambda p: p / mean),
        overlay=replace(net.overlay, points=net.overlay.points / mean),
    )


def _frozen(array: FloatArray) -> FloatArray:
    array.setflags(write=False)
    return array


def _stitches(over: Overlay, copies: NodeCopies, arrangement: Arrangement) -> Stitches:
    """Every node on a grid line, and every crease vertex, that has more than one copy."""
    count = np.diff(copies.start)
    wanted = (over.line_x >= 0) | (over.line_y >= 0)
    if len(arrangement.vertices):
        tree = shapely.STRtree(shapely.points(over.points))
        near = tree.query(shapely.points(arrangement.vertices), predicate="dwithin", distance=ON_LINE)
        wanted[near[1]] = True
    nodes = np.flatnonzero(wanted & (count > 1))
    first = np.repeat(copies.start[nodes], count[nodes] - 1)
    second: IntArray = np.concatenate(
        [np.arange(copies.start[n] + 1, copies.start[n + 1]) for n in nodes] or [np.zeros(0, dtype=np.int64)]
    )
    return Stitches(
        np.hstack([copies.vertices[first], copies.vertices[second]]),
        np.hstack([copies.weights[first], -copies.weights[second]]),
        over.points[copies.node[first]],
    )


def _patch_polygons(arrangement: Arrangement, over: Overlay, frame: NetFrame) -> tuple[Polygon, ...]:
    """One polygon a patch, drawing units: the union of its faces (a free crease end leaves no trace)."""
    face = np.repeat(np.arange(len(over.patch)), np.diff(over.loop_start))
    polygons = shapely.polygons(shapely.linearrings(over.points[over.loop_nodes], indices=face))
    order = np.argsort(over.patch, kind="stable")
    ends = np.cumsum(np.bincount(over.patch))
    result = []
    for faces in np.split(polygons[order], ends[:-1]):
        union = shapely.coverage_union_all(faces)
        if union.geom_type != "Polygon":
            union = shapely.union_all(faces, grid_size=1e-7)
        result.append(shapely.transform(union, frame.to_drawing))
    return tuple(result)
