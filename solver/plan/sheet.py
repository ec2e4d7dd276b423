"""From a drawing and what is known of its fold to the plan."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import shapely

from ..arrays import BoolArray, FloatArray
from ..errors import PatternError
from ..measurement import FLAT_ANGLE
from ..pattern.crease_pattern import Crease
from ..pattern.curves import sample_crease
from ..pattern.places import line_strings
from .crease_parts import CHORD, Part, crease_parts, length_on
from .data import Kind, Plan, PlanStroke
from .fitting import of_cubics, of_points
from .marks import Placed, mark_strokes
from .pieces import Line
from .source import FoldAngles, PlanSource
from .walk import Walk

#: How far a plan's curves may be from the drawing's samples, mm, where nothing else is asked.
TOLERANCE = 0.02
#: A crease that is known by coarse samples is rounded as for a net with so many quads along the sheet.
_FINENESS = 400
#: Fold angles this near the end of a part may be another part's; of the sheet's longer side.
_AT_END = 1e-3
#: Fold angles this far from every part belong to none; of the sheet's longer side.
_OFF = 5e-3
#: Sheets are at least so large, mm: smaller ones are drawings in another unit.
_LEAST_SIZE = 0.5
#: What is said of a fold that is none.
_LIES_FLAT = "the sheet lies flat, so that mountains and valleys are as drawn"
_KINDS = {"M": Kind.MOUNTAIN, "V": Kind.VALLEY}


def make_plan(source: PlanSource, tolerance: float = TOLERANCE) -> Plan:
    """All lines of the sheet. Raises PatternError where a drawing cannot be a plan."""
    pattern, unit = source.pattern, source.unit_mm
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    width, height = ((high - low) * unit).tolist()
    if max(width, height) < _LEAST_SIZE:
        raise PatternError(
            f"the sheet is {width:.3g} mm by {height:.3g} mm, too small to be made; give the drawing's unit"
        )

    placed = placing(source)
    border = of_points(placed(pattern.boundary), True, tolerance)
    holes = [of_points(placed(hole), True, tolerance) for hole in pattern.holes]
    paper = shapely.Polygon(placed(pattern.boundary), [placed(hole) for hole in pattern.holes])
    if not paper.is_valid:
        raise PatternError(
            f"the border and holes cross each other ({shapely.is_valid_reason(paper)}), so the sheet cannot be cut"
        )
    size = max(width, height)
    walks = [_crease_walk(crease, placed, tolerance, size) for crease in pattern.creases]
    drawn = [k for k, walk in enumerate(walks) if walk.pieces]
    parts = [
        Part(drawn[part.crease], part.start, part.end) for part in crease_parts([walks[k] for k in drawn], paper)
    ]
    names = [pattern.crease_label(k) for k in range(len(walks))]
    letters = [crease.assignment for crease in pattern.creases]
    found, notes = _found(source, placed)
    creases = _crease_strokes(walks, parts, names, letters, found, size)
    strokes = [
        PlanStroke(border, Kind.BORDER, "border", tuple(_corners(border))),
        *(PlanStroke(hole, Kind.HOLE, f"hole {k}", tuple(_corners(hole))) for k, hole in enumerate(holes, 1)),
        *creases,
        *_ruling_strokes(source.rulings, placed),
        *mark_strokes(source, placed, creases),
    ]
    return Plan(tuple(strokes), width, height, pattern.name, found is not None, notes)


def placing(source: PlanSource) -> Placed:
    """From the drawing's places (n,2) to the plan's, mm."""
    low = source.pattern.boundary.min(axis=0)

    def placed(points: FloatArray) -> FloatArray:
        return np.asarray((points - low) * source.unit_mm)

    return placed


def _found(source: PlanSource, placed: Placed) -> tuple[FoldAngles | None, tuple[str, ...]]:
    """The fold angles in place, None for a sheet that lies flat; and all notes."""
    if source.found is None:
        return None, source.notes
    if float(np.abs(source.found.degrees).max(initial=0.0)) < FLAT_ANGLE:
        return None, (*source.notes, _LIES_FLAT)
    return FoldAngles(placed(source.found.places), source.found.degrees), source.notes


def _crease_walk(crease: Crease, placed: Placed, tolerance: float, size: float) -> Walk:
    if crease.beziers is not None and len(crease.beziers):
        controls = placed(crease.beziers.reshape(-1, 2)).reshape(-1, 4, 2)
        return of_cubics(controls, crease.closed, tolerance, size)
    scaled = Crease(placed(crease.points), crease.closed, crease.assignment, crease.name)
    points = sample_crease(scaled, size / _FINENESS)
    return of_points(points, crease.closed, tolerance)


def _corners(walk: Walk) -> list[float]:
    return [float(length) for length in walk.starts[1:-1]]


# ---- sides


def _crease_strokes(
    walks: Sequence[Walk],
    parts: Sequence[Part],
    names: Sequence[str],
    letters: Sequence[str],
    found: FoldAngles | None,
    size: float,
) -> list[PlanStroke]:
    """The parts of creases that fold to one side, end to end, are one line."""
    if found is None:
        told: list[_Told] = [(_KINDS.get(letters[part.crease], Kind.FLAT), ()) for part in parts]
    else:
        told = _as_folded(walks, parts, letters, found, size)
    strokes = []
    rows = list(zip(parts, told, strict=True))
    for crease, group in itertools.groupby(rows, lambda row: row[0].crease):
        walk = walks[crease]
        runs = _runs_of_one_kind(list(group), walk)
        strokes += [_stroke(walk, run, names[crease]) for run in runs]
    return strokes


_Told = tuple[Kind, tuple[tuple[float, float], ...]]


def _runs_of_one_kind(rows: list[tuple[Part, _Told]], walk: Walk) -> list[list[tuple[Part, _Told]]]:
    runs: list[list[tuple[Part, _Told]]] = []
    for row in rows:
        if runs and runs[-1][-1][0].end == row[0].start and runs[-1][-1][1][0] is row[1][0]:
            runs[-1].append(row)
        else:
            runs.append([row])
    if walk.closed and len(runs) > 1:
        (first, told), (last, other) = runs[0][0], runs[-1][-1]
        if last.end - walk.length == first.start and told[0] is other[0]:
            around = [
                (Part(part.crease, part.start + walk.length, part.end + walk.length), (kind, _shifted(some, walk)))
                for part, (kind, some) in runs[0]
            ]
            runs = [*runs[1:-1], [*runs[-1], *around]]
    return runs


def _shifted(angles: tuple[tuple[float, float], ...], walk: Walk) -> tuple[tuple[float, float], ...]:
    return tuple((length + walk.length, degrees) for length, degrees in angles)


def _stroke(walk: Walk, run: list[tuple[Part, _Told]], name: str) -> PlanStroke:
    start, end = run[0][0].start, run[-1][0].end
    whole = walk.closed and end - start >= walk.length
    angles = tuple((length - start, degrees) for _, (_, some) in run for length, degrees in some)
    bounds = tuple(part.start - start for part, _ in run[1:])
    pieces = walk.part(start, end) if start or not whole else walk.pieces
    # A closed crease that others meet is whole, and its parts start where they do.
    vertices = (0.0, *bounds) if whole and (bounds or start) else bounds
    return PlanStroke(Walk(pieces, whole), run[0][1][0], name, vertices, angles)


def _as_folded(
    walks: Sequence[Walk],
    parts: Sequence[Part],
    letters: Sequence[str],
    found: FoldAngles,
    size: float,
) -> list[_Told]:
    """What each part folds to, and the angles along it."""
    lines = [Walk(walks[part.crease].part(part.start, part.end)).samples(CHORD) for part in parts]
    if not lines:
        return []
    whole = line_strings([points for points, _ in lines])
    tree = shapely.STRtree(whole)
    points = shapely.points(found.places)
    asked, near = tree.query_nearest(points, max_distance=_OFF * size, all_matches=False)
    told: list[_Told | None] = [None] * len(parts)
    for k, part in enumerate(parts):
        mine = asked[near == k]
        along = shapely.line_locate_point(whole[k], points[mine])
        length = float(shapely.length(whole[k]))
        margin = min(_AT_END * size, 0.2 * length)
        here = (along > margin) & (along < length - margin)
        degrees, along = found.degrees[mine][here], along[here]
        if not len(degrees):
            continue
        order = np.argsort(along, kind="stable")
        angles = tuple(
            (part.start + length_on(lines[k], float(place)), abs(float(value)))
            for place, value in zip(along[order], degrees[order], strict=True)
        )
        told[k] = (_kind(degrees), angles)
    return [_known(told, parts, k, letters) for k in range(len(parts))]


def _kind(degrees: FloatArray) -> Kind:
    if float(np.median(np.abs(degrees))) < FLAT_ANGLE:
        return Kind.FLAT
    folded: BoolArray = np.abs(degrees) >= FLAT_ANGLE
    sides = float(np.sign(degrees[folded]).sum())
    if not sides:
        return Kind.FLAT
    return Kind.VALLEY if sides > 0 else Kind.MOUNTAIN


def _known(told: Sequence[_Told | None], parts: Sequence[Part], k: int, letters: Sequence[str]) -> _Told:
    """What a part folds to; one that is too short to be measured folds as the crease does beside it."""
    mine = told[k]
    if mine is not None:
        return mine
    for m in (k - 1, k + 1):
        if 0 <= m < len(parts) and parts[m].crease == parts[k].crease:
            other = told[m]
            if other is not None:
                return other[0], ()
    return _KINDS.get(letters[parts[k].crease], Kind.FLAT), ()


# ---- rulings


def _ruling_strokes(rulings: FloatArray | None, placed: Placed) -> list[PlanStroke]:
    if rulings is None or not len(rulings):
        return []
    ends = placed(rulings.reshape(-1, 2)).reshape(-1, 2, 2) @ np.array([1.0, 1j])
    return [PlanStroke(Walk((Line(complex(a), complex(b)),)), Kind.RULING, "ruling") for a, b in ends.tolist()]
