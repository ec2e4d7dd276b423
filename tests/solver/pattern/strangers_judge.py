"""Whether what was read is what the author meant."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import numpy as np
import shapely

from solver import CreasePattern
from tests.solver.pattern.strangers_designs import FloatArray
from tests.solver.pattern.strangers_habits import MeantSheet

#: Area of a sheet, size of a unit and length of creases may be wrong by this part.
_PART = 0.01
#: A crease is where it was meant within this part of the longer side of its sheet: ends may miss by 1 %.
_BAND = 0.012
#: How much of a meant crease has to be covered by what was read.
_COVERED = 0.98
#: Creases that were read for one that was meant, at most, and how many more in all: a curve that was drawn as many
#: strokes is one, but may be cut where others meet it.
_PIECES, _MORE = 3, 4


def faults(
    meant: Sequence[MeantSheet], unit: float, unit_mm: float | None, read: Sequence[CreasePattern]
) -> list[str]:
    """What is wrong, one clause each; empty when all is read as meant.

    unit: units of the drawing in a millimetre; unit_mm: millimetres in one unit, None where nothing says so
    """
    if len(read) != len(meant):
        return [f"{len(read)} sheets instead of {len(meant)}"]
    found = min(
        (
            [_sheet_faults(one, unit, pattern) for one, pattern in zip(meant, order, strict=True)]
            for order in permutations(read)
        ),
        key=lambda lists: sum(map(len, lists)),
    )
    wrong = [fault for one in found for fault in one]
    if unit_mm is not None and read and not _close(read[0].unit_mm or 1.0, unit_mm):
        wrong.append(f"a unit is {read[0].unit_mm} mm instead of {unit_mm:.4g}")
    return wrong


def _close(value: float, right: float) -> bool:
    return abs(value - right) <= _PART * abs(right)


def _sheet_faults(meant: MeantSheet, unit: float, read: CreasePattern) -> list[str]:
    outline = shapely.Polygon(meant.outline)
    # The two have other origins. Both outlines are the same where anything is right.
    boundary = read.boundary / unit
    move = np.asarray(outline.bounds[:2]) - boundary.min(axis=0)
    sheet = shapely.Polygon(boundary + move)
    wrong = []
    if not _close(sheet.area, outline.area):
        wrong.append(f"the sheet has {sheet.area / outline.area:.1%} of its area")
    if len(read.holes) != len(meant.holes):
        wrong.append(f"{len(read.holes)} holes instead of {len(meant.holes)}")
    elif meant.holes:
        area = sum(shapely.Polygon(hole / unit).area for hole in read.holes)
        right = sum(shapely.Polygon(hole).area for hole in meant.holes)
        if not _close(area, right):
            wrong.append(f"the holes have {area / right:.1%} of their area")
    band = _BAND * float(np.ptp(meant.outline, axis=0).max())
    inner = outline.buffer(-band)
    creases = [(_line(crease.points / unit + move, crease.closed), crease.assignment) for crease in read.creases]
    all_read = shapely.union_all([line for line, _ in creases])
    for k, (points, letters) in enumerate(meant.folds, 1):
        line = shapely.LineString(points)
        if _covered(line, all_read, band) < _COVERED:
            wrong.append(f"crease {k} ({letters[0]}) is covered to {_covered(line, all_read, band):.0%}")
            continue
        right_side = shapely.union_all([one for one, letter in creases if letter in letters])
        if _covered(line, right_side, band) < _COVERED:
            # What lies on the line, not what only crosses it.
            others = {c for one, c in creases if _covered(one, line, band) > _COVERED and c not in letters}
            wrong.append(
                f"crease {k} is read as {'/'.join(sorted(others)) or 'another side'} instead of {letters[0]}"
            )
    wrong += _too_much(meant, [shapely.intersection(line, inner) for line, _ in creases], band)
    if len(creases) > _PIECES * len(meant.folds) + _MORE:
        wrong.append(f"{len(creases)} creases instead of {len(meant.folds)}")
    return wrong


def _too_much(meant: MeantSheet, inside: list[shapely.Geometry], band: float) -> list[str]:
    """Creases where nothing is meant to be folded."""
    room = shapely.union_all([shapely.LineString(points).buffer(band) for points, _ in meant.folds])
    extra = sum(float(shapely.difference(line, room).length) for line in inside)
    whole = sum(float(shapely.LineString(points).length) for points, _ in meant.folds)
    if extra <= _PART * (whole or float(shapely.LineString(meant.outline).length)):
        return []
    cuts = shapely.union_all([shapely.LineString(points).buffer(band) for points in (*meant.cuts, *meant.holes)])
    on_cuts = sum(float(shapely.intersection(line, cuts).length) for line in inside)
    what = "a cut" if on_cuts > 0.5 * extra else "what is none"
    return [f"{what} is read as a crease ({extra:.3g} mm beside {whole:.3g} that are meant)"]


def _line(points: FloatArray, closed: bool) -> shapely.LineString:
    return shapely.LineString(np.vstack([points, points[:1]]) if closed else points)


def _covered(line: shapely.Geometry, by: shapely.Geometry, band: float) -> float:
    if by.is_empty:
        return 0.0
    return float(shapely.intersection(line, by.buffer(band)).length / line.length)
