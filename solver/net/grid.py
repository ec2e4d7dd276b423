"""The orthogonal grid: lines through every crease vertex, as even as possible, cells near to square."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely import Polygon

from ..arrays import FloatArray
from ..pattern.arrangement import CROSSING, JUNCTION, Arrangement

#: Two lines nearer than this cannot both be kept; cell lengths. Thinner cells bend badly.
MIN_GAP = 0.35
#: A crease vertex inside the sheet moves onto a line nearer than this, cell lengths: drawings are rounded, and a
#: vertex that misses a line by a hair leaves slivers.
SNAP_TO_LINE = 1e-3
#: Straight axis-parallel pieces of the border at least this long get a line of their own; cell lengths.
_BORDER_RUN = 0.75
#: Closed curves smaller than this get lines through their middle, so that they cross some; cell lengths.
_SMALL = 2.0


@dataclass(frozen=True, eq=False)
class OrthogonalGrid:
    """xs (X,) and ys (Y,): increasing line positions, cell lengths; notes on lines that were merged."""

    xs: FloatArray
    ys: FloatArray
    notes: tuple[str, ...]


def place_grid(arrangement: Arrangement) -> OrthogonalGrid:
    """Grid lines for an arrangement whose coordinates are in cell lengths (asked cell = 1)."""
    x0, y0, x1, y1 = arrangement.sheet.bounds
    wishes: tuple[list[tuple[int, float]], list[tuple[int, float]]] = ([], [])
    for place, kind in zip(arrangement.vertices, arrangement.kinds, strict=True):
        for axis in (0, 1):
            wishes[axis].append((0 if kind == CROSSING else 2, float(place[axis])))
    _wish_border(arrangement.sheet, wishes)
    _wish_small(arrangement, wishes)
    xs, missed_x = _lines(x0, x1, wishes[0])
    ys, missed_y = _lines(y0, y1, wishes[1])
    notes = []
    missed = missed_x + missed_y
    if missed:
        notes.append(
            f"{missed} grid {'line' if missed == 1 else 'lines'} through crease vertices lay closer than "
            f"{MIN_GAP:g} of a cell to another and merged with it; a finer resolution separates them"
        )
    return OrthogonalGrid(xs, ys, tuple(notes))


def snap_vertices(arrangement: Arrangement, grid: OrthogonalGrid) -> Arrangement:
    """The arrangement with inner crease vertices moved onto grid lines that they miss by less than a hair."""
    inner = np.array([kind != JUNCTION for kind in arrangement.kinds], dtype=bool)
    moved = arrangement.vertices.copy()
    for axis, lines in ((0, grid.xs), (1, grid.ys)):
        nearest = lines[np.abs(moved[:, axis, None] - lines[None]).argmin(axis=1)] if len(moved) else moved[:, axis]
        close = inner & (np.abs(nearest - moved[:, axis]) < SNAP_TO_LINE)
        moved[close, axis] = nearest[close]
    if np.array_equal(moved, arrangement.vertices):
        return arrangement
    target = {tuple(old): new for old, new in zip(arrangement.vertices.tolist(), moved, strict=True)}
    chains = []
    for chain in arrangement.chains:
        points = chain.points.copy()
        for end in (0, -1):
            points[end] = target.get(tuple(points[end].tolist()), points[end])
        chains.append(replace(chain, points=points))
    return replace(arrangement, chains=tuple(chains), vertices=moved)


def crossings_held(sheet: Polygon) -> int:
    """How many crossings can have grid lines of their own on a sheet in cell lengths, at most."""
    x0, y0, x1, y1 = sheet.bounds
    return (int((x1 - x0) / MIN_GAP) + 1) * (int((y1 - y0) / MIN_GAP) + 1)


def _wish_border(sheet: Polygon, wishes: tuple[list[tuple[int, float]], list[tuple[int, float]]]) -> None:
    for ring in (sheet.exterior, *sheet.interiors):
        points = shapely.get_coordinates(ring)
        steps = np.diff(points, axis=0)
        for axis in (0, 1):
            run = (np.abs(steps[:, axis]) < 1e-6) & (np.abs(steps[:, 1 - axis]) > _BORDER_RUN)
            wishes[axis].extend((1, float(value)) for value in points[:-1][run, axis])


def _wish_small(arrangement: Arrangement, wishes: tuple[list[tuple[int, float]], list[tuple[int, float]]]) -> None:
    rings = [chain.points for chain in arrangement.chains if chain.closed]
    rings += [shapely.get_coordinates(hole) for hole in arrangement.sheet.interiors]
    for points in rings:
        low, high = points.min(axis=0), points.max(axis=0)
        if (high - low).max() < _SMALL:
            for axis in (0, 1):
                wishes[axis].append((3, float(0.5 * (low[axis] + high[axis]))))


def _lines(low: float, high: float, wishes: list[tuple[int, float]]) -> tuple[FloatArray, int]:
    """Lines from low to high through the wishes, most urgent first, and how many urgent ones were refused."""
    fixed = [low, high]
    missed: list[float] = []
    for urgency, value in sorted(wishes):
        gaps = np.abs(np.array(fixed) - value)
        if gaps.min() >= MIN_GAP:
            fixed.append(value)
        # They come in order: only the last one can be the same.
        elif gaps.min() > 1e-6 and urgency == 0 and not (missed and value - missed[-1] <= 1e-6):
            missed.append(value)
    marks = np.sort(np.array(fixed))
    parts = [np.linspace(a, b, max(1, int(np.round(b - a))), endpoint=False) for a, b in itertools.pairwise(marks)]
    return np.concatenate([*parts, marks[-1:]]), len(missed)
