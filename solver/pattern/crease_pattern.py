"""The drawing: a sheet's border, its holes, and the crease curves on it. Planar, in the drawing's units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray, frozen_array
from ..errors import PatternError

#: FOLD's letters that a crease may carry (FOLD 1.2, edges_assignment).
ASSIGNMENTS = ("M", "V", "F", "U")

#: What is said of a sheet without creases.
BLANK = "the sheet is blank paper and bends by handles"


@dataclass(frozen=True, eq=False, init=False)
class Crease:
    """One crease curve.

    points      (P,2) samples along the curve, drawing units; a closed curve does not repeat its first point
    closed      whether the last point is joined to the first
    assignment  FOLD letter: M mountain, V valley, F flat, U unassigned
    name        for messages; empty when the drawing has none
    beziers     (S,4,2) cubic segments the points were sampled from, or None when only samples are known
    """

    points: FloatArray
    closed: bool
    assignment: str
    name: str
    beziers: FloatArray | None

    def __init__(
        self,
        points: ArrayLike,
        closed: bool = False,
        assignment: str = "U",
        name: str = "",
        beziers: ArrayLike | None = None,
    ) -> None:
        array = _points(points, name or "crease")
        if closed and len(array) > 1 and np.array_equal(array[0], array[-1]):
            array = frozen_array(array[:-1], np.float64, (None, 2), "points")
        if len(array) < (3 if closed else 2):
            raise PatternError("a crease needs at least two points", element=name or "crease")
        if assignment not in ASSIGNMENTS:
            raise PatternError(
                f"unknown assignment {assignment!r}, expected one of {', '.join(ASSIGNMENTS)}",
                element=name or "crease",
            )
        object.__setattr__(self, "points", array)
        object.__setattr__(self, "closed", bool(closed))
        object.__setattr__(self, "assignment", assignment)
        object.__setattr__(self, "name", name)
        object.__setattr__(
            self,
            "beziers",
            None if beziers is None else frozen_array(beziers, np.float64, (None, 4, 2), "beziers"),
        )


@dataclass(frozen=True, eq=False, init=False)
class CreasePattern:
    """A sheet and its creases.

    boundary  (B,2) the border, counter-clockwise, first point not repeated
    holes     tuple of (H,2) rings cut out of the sheet, clockwise, first point not repeated
    creases   tuple of Crease
    name      for messages and file names
    unit_mm   millimetres in one drawing unit, or None when the drawing does not say
    notes     what a reader decided, one sentence each (which stroke became what, and why)
    conflicts  creases that are drawn as a mountain and as a valley, one sentence each; they are unassigned
    Raises PatternError on points that are not finite or a border without area.
    """

    boundary: FloatArray
    holes: tuple[FloatArray, ...]
    creases: tuple[Crease, ...]
    name: str
    unit_mm: float | None
    notes: tuple[str, ...]
    conflicts: tuple[str, ...]

    def __init__(
        self,
        boundary: ArrayLike,
        holes: Sequence[ArrayLike] = (),
        creases: Sequence[Crease] = (),
        name: str = "",
        unit_mm: float | None = None,
        notes: Sequence[str] = (),
        conflicts: Sequence[str] = (),
    ) -> None:
        object.__setattr__(self, "boundary", _ring(boundary, "border", counter_clockwise=True))
        object.__setattr__(
            self,
            "holes",
            tuple(_ring(hole, f"hole {k + 1}", counter_clockwise=False) for k, hole in enumerate(holes)),
        )
        object.__setattr__(self, "creases", tuple(creases))
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "unit_mm", None if unit_mm is None else float(unit_mm))
        object.__setattr__(self, "notes", tuple(notes))
        object.__setattr__(self, "conflicts", tuple(conflicts))

    def named(self, name: str, unit_mm: float | None) -> CreasePattern:
        """The same drawing with another name and unit."""
        return CreasePattern(self.boundary, self.holes, self.creases, name, unit_mm, self.notes, self.conflicts)

    def noted(self, note: str) -> CreasePattern:
        """The same drawing with one more note, the first."""
        notes = (note, *self.notes)
        return CreasePattern(
            self.boundary, self.holes, self.creases, self.name, self.unit_mm, notes, self.conflicts
        )

    def crease_label(self, index: int) -> str:
        """How messages call crease ``index``: its number from 1, and its name when it has one."""
        name = self.creases[index].name
        return f"crease {index + 1} ({name})" if name else f"crease {index + 1}"


def _points(values: ArrayLike, element: str) -> FloatArray:
    try:
        array = frozen_array(values, np.float64, (None, 2), element)
    except (TypeError, ValueError) as error:
        raise PatternError("points must be pairs of numbers", element=element) from error
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(bad):
        raise PatternError(f"point {bad[0] + 1} is not finite", element=element)
    return array


def _ring(values: ArrayLike, element: str, counter_clockwise: bool) -> FloatArray:
    array = _points(values, element)
    if len(array) > 1 and np.array_equal(array[0], array[-1]):
        array = frozen_array(array[:-1], np.float64, (None, 2), element)
    if len(array) < 3:
        raise PatternError("a closed outline needs at least three points", element=element)
    # Shoelace relative to the first point, so that a sheet far from the origin loses no digits.
    x, y = (array - array[0]).T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    if area == 0.0:
        raise PatternError("the outline encloses no area", element=element, place=tuple(array[0]))
    if (area > 0) != counter_clockwise:
        # Reversed, but with the same first point: the start is the user's.
        array = frozen_array(np.roll(array[::-1], 1, axis=0), np.float64, (None, 2), element)
    return array
