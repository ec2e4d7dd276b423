"""A crease pattern laid out on its grid: all that decides how many vertices a net has."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely import LineString

from ..arrays import FloatArray
from ..description import RESOLUTIONS
from ..errors import NetError, PatternError
from ..pattern.arrangement import CROSSING, Arrangement, arrange, sheet_polygon
from ..pattern.crease_pattern import BLANK, Crease, CreasePattern
from ..pattern.curves import sample_crease
from .frame import NetFrame, border_direction
from .grid import OrthogonalGrid, crossings_held, place_grid, snap_vertices
from .overlay import Overlay, overlay
from .topology import Topology, build_topology

#: Samples of a crease are at most this far apart before noding, cell lengths.
_SAMPLE_SPACING = 0.08
#: Where only widths are measured they are this far apart, and what moves a curve by less than this is left out.
_ROUGH_SPACING, _ROUGHNESS = 0.25, 0.01
#: A sheet narrower than this many cells cannot bend in its width.
_MIN_CELLS_ACROSS = 1.0
#: A net of more vertices than this is refused before memory is gone: folding takes about 25 KB a vertex.
MAX_VERTICES = 100_000
#: Curves of a drawing with more points than this are simplified, by at most this part of a cell; a drawing with
#: more points than the second number even then, or with more creases, is no crease pattern.
_MANY_POINTS, _SIMPLIFIED, _MAX_POINTS, _MAX_CREASES = 5_000, 1e-3, 20_000, 1_000
#: Creases that cross more often are refused before they are cut; so many of their segments are looked at.
_MAX_CROSSINGS, _CROSSING_SAMPLE = 20_000, 2_000


@dataclass(frozen=True, eq=False)
class Drawing:
    """A pattern in the grid's frame. Lengths of the arrangement are cells; notes: what was decided."""

    frame: NetFrame
    arrangement: Arrangement
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Layout:
    """A drawing on its grid, cut into pieces of cells that share vertices; resolution: quads that were asked."""

    resolution: int
    drawing: Drawing
    arrangement: Arrangement
    grid: OrthogonalGrid
    over: Overlay
    topology: Topology


def lay_out(pattern: CreasePattern, resolution: int | str) -> Layout:
    """The layout of a pattern with ``resolution`` quads along the sheet's longer side.

    Raises PatternError for a border that crosses itself or a drawing that is too much, and NetError when the
    resolution is out of range or too low.
    """
    if not isinstance(resolution, int | np.integer) or not RESOLUTIONS[0] <= resolution <= RESOLUTIONS[1]:
        raise NetError(f"the resolution must be a whole number from {RESOLUTIONS[0]} to {RESOLUTIONS[1]}")
    drawing = draw(pattern, int(resolution), check=True)
    _check_crossings(drawing.arrangement, int(resolution))
    grid = place_grid(drawing.arrangement)
    arrangement = snap_vertices(drawing.arrangement, grid)
    over = overlay(arrangement, grid)
    topology = build_topology(over, grid)
    if len(topology.vertex_grid) > MAX_VERTICES:
        raise NetError(f"the net has more than {MAX_VERTICES:,} vertices; use a lower resolution")
    return Layout(int(resolution), drawing, arrangement, grid, over, topology)


def draw(pattern: CreasePattern, resolution: int, rough: bool = False, check: bool = False) -> Drawing:
    """A pattern with its creases cut and mended, in cells of ``resolution`` to the longer side.

    rough: creases only as exact as widths need, which is quicker. check: whether a sheet that such cells cannot
    hold is refused. Raises PatternError and NetError.
    """
    if len(pattern.creases) > _MAX_CREASES:
        raise PatternError(
            f"the drawing has {len(pattern.creases):,} creases, more than {_MAX_CREASES:,}", element="creases"
        )
    pattern, note = _simplified(pattern, resolution)
    sheet_polygon(pattern.boundary, pattern.holes)  # in drawing units, so that errors name the user's place
    frame = _frame(pattern, resolution)
    if check:
        _check_size(pattern, frame)
    arrangement = _arrange(pattern, frame, rough)
    return Drawing(frame, arrangement, (*note, *arrangement.notes))


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
    low, high = sheet_extent(pattern, angle)
    corner = NetFrame((0.0, 0.0), angle, 1.0).to_drawing(low[None])[0] + pattern.boundary[0]
    return NetFrame((float(corner[0]), float(corner[1])), angle, float((high - low).max()) / resolution)


def sheet_extent(pattern: CreasePattern, angle: float) -> tuple[FloatArray, FloatArray]:
    """Lower and upper corner (2,) of the turned sheet, drawing units, from the border's first point."""
    turned = NetFrame((0.0, 0.0), angle, 1.0).to_net(pattern.boundary - pattern.boundary[0])
    return turned.min(axis=0), turned.max(axis=0)


def _check_size(pattern: CreasePattern, frame: NetFrame) -> None:
    """Raises NetError where the sheet is thinner than a cell, or holds too many of them."""
    low, high = sheet_extent(pattern, frame.angle)
    (width, height), unit = high - low, frame.unit
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


def _arrange(pattern: CreasePattern, frame: NetFrame, rough: bool) -> Arrangement:
    sheet = sheet_polygon(frame.to_net(pattern.boundary), tuple(frame.to_net(h) for h in pattern.holes))
    folded = [k for k, crease in enumerate(pattern.creases) if crease.assignment != "F"]
    spacing = (_ROUGH_SPACING if rough else _SAMPLE_SPACING) * frame.unit
    lines = [frame.to_net(sample_crease(pattern.creases[k], spacing)) for k in folded]
    if rough:
        lines = [shapely.get_coordinates(LineString(line).simplify(_ROUGHNESS)) for line in lines]
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
    if not arrangement.chains:
        none = "no crease is left to fold" if pattern.creases else "the drawing has no crease"
        notes = (*notes, f"{none}: {BLANK}")
    chains = tuple(replace(chain, crease=folded[chain.crease]) for chain in arrangement.chains)
    return replace(arrangement, chains=chains, notes=notes)


def _crossings(lines: list[FloatArray]) -> int:
    """About how often the segments of polylines cross each other; exact for drawings that are not large."""
    if not lines:
        return 0
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
