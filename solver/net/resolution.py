"""How many quads a drawing needs: a few across its pieces of paper, and no more vertices than may be used."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..description import AUTO_VERTICES, RESOLUTIONS, VERTEX_BUDGETS
from ..errors import NetError
from ..pattern.arrangement import CROSSING, Arrangement
from ..pattern.crease_pattern import CreasePattern
from ..pattern.places import line_strings
from .frame import border_direction
from .grid import crossings_held, place_grid
from .layout import Drawing, Layout, draw, lay_out, sheet_extent

#: Cells across a typical piece of paper: with fewer a curved crease of it has no room to bend beside. Two across a
#: narrow one: its crease points then have paper of their own on both sides.
CELLS_TYPICAL, CELLS_NARROW = 4, 2
#: Quads along the longer side that any sheet gets. With 24, closed creases and hairpins driven to 60 degrees are
#: up to ten degrees shallower (circle_in_square, hairpin, loop; ``python -m benchmarks.drawings``).
LEAST_QUADS = 32
#: The drawing is measured in cells of the first number to the longer side, and as many to the width of a narrow
#: sheet as the second, up to the third.
_MEASURED, _MEASURED_ACROSS, _MEASURED_MOST = 48, 24, 480
#: Half width of the slit that a crease leaves which ends inside a piece of paper, cells of measuring.
_SLIT = 1e-3
#: Inscribed circles are found to this part of the square root of their piece's area.
_CIRCLE = 0.02
#: Faces narrower than this are what rounding leaves, cells of measuring.
_NOTHING = 1e-6
#: An estimate of the vertices is trusted up to this part of what may be used; it is off by less than a tenth
#: mostly. Beyond it they are counted. A number is tried that should need the second part.
_SURE, _TRIED = 0.8, 0.98
#: A step that leaves its direction by less than this part follows a grid line.
_ALONG = 1e-6


@dataclass(frozen=True)
class Resolution:
    """quads along the sheet's longer side; sentence: what was chosen and why, and what would be needed instead."""

    quads: int
    sentence: str


def choose_resolution(pattern: CreasePattern, max_vertices: int = AUTO_VERTICES) -> Resolution:
    """As many quads along the sheet's longer side as the drawing needs and ``max_vertices`` allow.

    Four cells fit across a typical piece of paper, two across the narrowest long one, and creases that cross have
    room for lines of their own. A drawing whose fewest quads already need more vertices gets these, and the
    sentence says so. Raises PatternError and NetError as ``build_net`` does.
    """
    return choose_layout(pattern, max_vertices)[0]


def choose_layout(pattern: CreasePattern, max_vertices: int) -> tuple[Resolution, Layout | None]:
    """The choice, and its layout where that had to be made for it."""
    low, high = VERTEX_BUDGETS
    if type(max_vertices) is not int or not low <= max_vertices <= high:
        raise NetError(f"the vertices that may be used must be a whole number from {low:,} to {high:,}")
    sides = np.sort(np.subtract(*sheet_extent(pattern, border_direction(pattern.boundary))[::-1]))
    across = float(sides[1] / sides[0])
    nominal = int(np.clip(np.ceil(_MEASURED_ACROSS * across), _MEASURED, _MEASURED_MOST))
    drawing = draw(pattern, nominal, rough=True)
    needs = _needs(drawing, nominal, across)
    wanted = min(max(need.quads for need in needs), RESOLUTIONS[1])
    least = min(max(RESOLUTIONS[0], int(np.ceil(across)), _room(drawing.arrangement, nominal)), RESOLUTIONS[1])
    quads, layout = _within(pattern, drawing.arrangement, nominal, wanted, least, max_vertices)
    sentence = _sentence(needs, quads, max_vertices)
    if layout is not None and (count := len(layout.topology.vertex_grid)) > max_vertices:
        sentence = f"{sentence}; the drawing cannot have fewer quads, which need {count:,} vertices"
    return Resolution(quads, sentence), layout


@dataclass(frozen=True)
class _Need:
    quads: int
    why: str


def _needs(drawing: Drawing, nominal: int, across: float) -> list[_Need]:
    """What asks for how many quads."""
    arrangement, unit = drawing.arrangement, drawing.frame.unit
    pieces = _pieces(arrangement)
    circles = shapely.maximum_inscribed_circle(pieces, tolerance=_CIRCLE * np.sqrt(shapely.area(pieces)))
    # Beside a spiral, or creases that end in the paper, there is less of it than the largest circle tells.
    widths = np.minimum(2.0 * shapely.length(circles), 4.0 * shapely.area(pieces) / shapely.length(pieces))
    typical = _weighted_median(widths)
    needs = [
        _Need(LEAST_QUADS, "so that paper looks smooth"),
        _Need(int(np.ceil(across)), "so that a cell fits across the sheet"),
        _Need(
            int(np.ceil(CELLS_TYPICAL * nominal / typical)),
            f"so that {CELLS_TYPICAL} cells fit across a typical piece of paper, {typical * unit:.4g} wide",
        ),
    ]
    # Only what is long is a narrow place: a small triangle between three creases may do with a cell.
    narrow = np.flatnonzero(0.5 * shapely.length(pieces) >= typical)
    if len(narrow):
        one = narrow[np.argmin(widths[narrow])]
        x, y = drawing.frame.to_drawing(shapely.get_coordinates(circles[one])[:1])[0]
        width = f"{widths[one] * unit:.4g} wide near ({x:.4g}, {y:.4g})"
        why = f"so that {CELLS_NARROW} cells fit across the narrowest piece of paper, {width}"
        needs.append(_Need(int(np.ceil(CELLS_NARROW * nominal / widths[one])), why))
    crossings = arrangement.kinds.count(CROSSING)
    needs.append(_Need(_room(arrangement, nominal), f"so that {crossings:,} crossings have room"))
    return needs


def _room(arrangement: Arrangement, nominal: int) -> int:
    """The fewest quads with room for the lines of all crossings."""
    crossings, bounds = arrangement.kinds.count(CROSSING), np.array(arrangement.sheet.bounds)
    quads = max(1, int(nominal * np.sqrt(crossings / crossings_held(arrangement.sheet))))
    while quads < RESOLUTIONS[1] and crossings_held(shapely.box(*(bounds * quads / nominal))) < crossings:
        quads += 1
    return quads


def _sentence(needs: list[_Need], quads: int, max_vertices: int) -> str:
    most = max(needs, key=lambda need: need.quads)
    if quads >= most.quads:
        return f"the net has {quads} quads along the longer side, {most.why}"
    limit = (
        f"as many as {max_vertices:,} vertices allow" if quads < RESOLUTIONS[1] else "the most that there may be"
    )
    return f"the net has {quads} quads along the longer side, {limit}; {most.quads:,} would be needed {most.why}"


def _pieces(arrangement: Arrangement) -> NDArray[np.object_]:
    """The patches as polygons, slit where a crease ends inside one."""
    lines = line_strings([chain.points for chain in arrangement.chains])
    noded = shapely.union_all([arrangement.sheet.boundary, *lines])
    rings, bridges, ends, _ = shapely.polygonize_full(shapely.get_parts(noded))
    faces = shapely.get_parts(rings)
    shapely.prepare(arrangement.sheet)
    inside = shapely.contains(arrangement.sheet, shapely.point_on_surface(faces))
    faces = faces[inside & (2.0 * shapely.area(faces) > _NOTHING * shapely.length(faces))]
    slits = np.concatenate([shapely.get_parts(bridges), shapely.get_parts(ends)])
    if len(slits):
        slit = shapely.union_all(shapely.buffer(slits, _SLIT, quad_segs=1))
        touched = np.unique(shapely.STRtree(faces).query(slits, predicate="intersects")[1])
        cut = shapely.get_parts(shapely.difference(faces[touched], slit))
        faces = np.concatenate([np.delete(faces, touched), cut])
        faces = faces[shapely.get_type_id(faces) == shapely.GeometryType.POLYGON]
    return np.asarray(faces)


def _weighted_median(widths: FloatArray) -> float:
    """The width that as much width lies above as below: a hundred slivers count no more than a few broad pieces."""
    ordered = np.sort(widths)
    total = np.cumsum(ordered)
    return float(ordered[np.searchsorted(total, 0.5 * total[-1])])


# --- what the budget allows -----------------------------------------------------------------------------


def _within(
    pattern: CreasePattern, arrangement: Arrangement, nominal: int, wanted: int, least: int, budget: int
) -> tuple[int, Layout | None]:
    """About the largest number up to the wanted one that fits, and its layout if that was made.

    least: the fewest quads that the drawing can have.
    """

    def largest(most: int, bound: float) -> int:
        low, high = least, max(least, most)
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (middle, high) if estimate(middle) <= bound else (low, middle - 1)
        return low

    def estimate(quads: int) -> float:
        return estimated_vertices(arrangement, quads / nominal)

    quads = max(wanted, least)
    if estimate(quads) <= _SURE * budget:
        return quads, None
    quads = largest(quads, budget / _SURE)
    while True:
        layout = lay_out(pattern, quads)
        count = len(layout.topology.vertex_grid)
        if count <= budget:
            return quads, layout
        if quads == least:  # the drawing cannot have fewer, and is not refused for that
            return quads, layout
        quads = largest(quads - 1, _TRIED * budget * estimate(quads) / count)


def estimated_vertices(arrangement: Arrangement, scale: float) -> float:
    """About how many vertices the net of an arrangement has whose cells are ``scale`` times as fine.

    The grid's own vertices on the sheet, and copies along creases: two for each cell that one passes, one for each
    edge that it follows.
    """
    sheet = shapely.transform(arrangement.sheet, lambda points: points * scale)
    chains = tuple(replace(chain, points=chain.points * scale) for chain in arrangement.chains)
    scaled = replace(arrangement, sheet=sheet, chains=chains, vertices=arrangement.vertices * scale)
    grid = place_grid(scaled)
    cells = sheet.area * (len(grid.xs) - 1) * (len(grid.ys) - 1) / (np.ptp(grid.xs) * np.ptp(grid.ys))
    rims = [shapely.get_coordinates(ring) for ring in (sheet.exterior, *sheet.interiors)]
    copies = _passed([chain.points for chain in chains], grid.xs, grid.ys)
    return float(cells + 0.5 * _passed(rims, grid.xs, grid.ys) + 1.0 + copies)


def _passed(lines: list[FloatArray], xs: FloatArray, ys: FloatArray) -> float:
    """Twice the cells that the lines pass, and once the grid edges that they follow."""
    if not lines:
        return 0.0
    points = np.concatenate(lines)
    places = np.column_stack([np.interp(points[:, 0], xs, np.arange(len(xs))),
                              np.interp(points[:, 1], ys, np.arange(len(ys)))])  # fmt: skip
    steps = np.abs(np.diff(places, axis=0))
    steps = np.delete(steps, np.cumsum([len(line) for line in lines])[:-1] - 1, axis=0)
    along = (steps < _ALONG * steps.sum(axis=1, keepdims=True)).any(axis=1)
    return float((steps.sum(axis=1) * np.where(along, 1.0, 2.0)).sum())
