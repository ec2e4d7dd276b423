"""Drawings in Blender <-> crease patterns: the sheet's local coordinates, in Blender units.

A sheet may be moved, turned and scaled as a whole: its drawing stays the same, and the true size is its
local size times its scale (``unit_mm``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
import shapely
from numpy.typing import NDArray

from ... import solver
from ...solver.pattern.arrangement import sheet_polygon, snap_tolerance
from ...solver.pattern.rings import JOIN, outer_rings
from ...solver.pattern.segments import MAX_POINTS, Curve, Segment, Subpath, sample
from . import drawing_objects
from .evaluated_curves import control_strands, others_than_on_points
from .mesh import metres_per_unit
from .placing import matrix_on, mean_scale, world_matrix
from .splines import Strand, add_bezier_spline, add_poly_spline, read_strands

Array = NDArray[np.float64]

#: What is farther from the sheet's plane than this is said so, relative to the sheet's longer side.
FLAT = 1e-3
#: Scales along x and y that differ by more than this are uneven.
EVEN = 1e-3
#: What is nearer to the border than this is border, in snap tolerances.
_ALONG_BORDER = 1e-3

#: Between the sheets of files that are added together, relative to the width of the first file's.
ROW_GAP = 0.1

DEFAULT_NAME = "Paper Sheet"


@dataclass(frozen=True)
class Trouble:
    """What is wrong or suspicious with a drawing. place: in the world, None when it has none."""

    sentence: str
    place: tuple[float, float, float] | None
    object_name: str


def read_drawing(sheet: Any) -> solver.CreasePattern:
    """The crease pattern of a sheet and its creases, without the creases that are to stay flat.

    Works on what Blender would show now, also while an object is edited. Raises PatternError when the border
    is no border; creases that cannot be used are left out and ``troubles`` names them.
    """
    return _Reading(sheet).pattern()


def troubles(sheet: Any) -> tuple[Trouble, ...]:
    """All that is wrong or suspicious with a drawing."""
    reading = _Reading(sheet)
    try:
        reading.pattern()
    except solver.PatternError as error:
        place = error.where.place
        reading.trouble(error.message, sheet, None if place is None else np.array([*place[:2], 0.0]))
    return tuple(reading.troubles)


def sheet_size(sheet: Any) -> float:
    """The longer side of a sheet's border in its own coordinates; 0 when it has none."""
    strands = read_strands(sheet.data) if sheet.type == "CURVE" else []
    corners = [s.cubics.reshape(-1, 3) for s in strands if len(s.cubics)]
    return float(np.ptp(np.vstack(corners)[:, :2], axis=0).max()) if corners else 0.0


def add_drawings(files: Sequence[Sequence[solver.CreasePattern]], collection: Any, place: Any) -> list[Any]:
    """The sheets of drawings with their creases, in true scale for the current scene.

    Those of a file lie to each other as in the file, and the files in a row; the middle of the first is at
    ``place``, (x, y, z).
    """
    length = _metres_in_a_unit()
    x, y = np.asarray(place)[:2] - 0.5 * _box(files[0], length).sum(axis=0)
    sheets = []
    for patterns, step in zip(files, row(files, length), strict=True):
        for pattern in patterns:
            sheet = add_drawing(pattern, collection)
            middle = 0.5 * _box([pattern], length).sum(axis=0) + step
            sheet.location = (x + middle[0], y + middle[1], place[2])
            sheets.append(sheet)
    return sheets


def row(files: Sequence[Sequence[solver.CreasePattern]], length: float = 1.0) -> list[tuple[float, float]]:
    """How far along x and y the sheets of each file are moved to lie in a row to the right of the first one's.

    length: metres in the unit of the result
    """
    steps, right = [], 0.0
    boxes = [_box(patterns, length) for patterns in files]
    for k, (low, high) in enumerate(boxes):
        first_low, first_high = boxes[0]
        if k == 0:
            right = float(low[0])
        steps.append((right - float(low[0]), 0.5 * float((first_low + first_high - low - high)[1])))
        right += float(high[0] - low[0]) + ROW_GAP * float(first_high[0] - first_low[0])
    return steps


def _box(patterns: Sequence[solver.CreasePattern], length: float) -> Array:
    """(2,2) the lowest and the highest corner of sheets, in units of ``length`` metres."""
    points = np.vstack([pattern.boundary * (metres_per_unit(pattern.unit_mm) / length) for pattern in patterns])
    return np.array([points.min(axis=0), points.max(axis=0)])


def _metres_in_a_unit() -> float:
    return float(bpy.context.scene.unit_settings.scale_length)


def add_drawing(pattern: solver.CreasePattern, collection: Any) -> Any:
    """A sheet with its creases, in true scale for the current scene, centred on the world's origin."""
    scale = metres_per_unit(pattern.unit_mm) / _metres_in_a_unit()
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    middle = 0.5 * (low + high)

    def placed(points: Array) -> Array:
        flat = (points - middle) * scale
        return np.concatenate([flat, np.zeros((*flat.shape[:-1], 1))], axis=-1)

    border = drawing_objects.new_curve(pattern.name or DEFAULT_NAME)
    for ring in (pattern.boundary, *pattern.holes):
        add_poly_spline(border, placed(ring), closed=True)
    sheet = drawing_objects.new_sheet(border, collection)
    drawing_objects.keep_notes(sheet.curvefold, pattern.notes)
    for k, crease in enumerate(pattern.creases):
        curve = drawing_objects.new_curve(crease.name or f"Crease {k + 1}")
        if crease.beziers is None:
            add_poly_spline(curve, placed(crease.points), crease.closed)
        else:
            add_bezier_spline(curve, placed(_whole(crease)), crease.closed)
        drawing_objects.new_crease(curve, sheet, crease.assignment)
    return sheet


def _whole(crease: solver.Crease) -> Array:
    """(S,4,2) cubics of a crease; those of a closed one end where they start."""
    assert crease.beziers is not None
    start, end = crease.beziers[0, 0], crease.beziers[-1, 3]
    size = float(np.ptp(crease.points, axis=0).max())
    if not crease.closed or np.abs(end - start).max() <= 1e-9 * size:
        return crease.beziers
    step = (start - end) / 3.0
    return np.concatenate([crease.beziers, [[end, end + step, start - step, start]]])


def shown_strands(curve_object: Any) -> list[Strand]:
    """The splines of a Curve object as hooks, shape keys and modifiers on control points leave them."""
    return control_strands(curve_object, bpy.context.evaluated_depsgraph_get())


class _Reading:
    """One look at a drawing; collects troubles on the way. Not reusable."""

    def __init__(self, sheet: Any) -> None:
        self.troubles: list[Trouble] = []
        self._sheet = sheet
        self._world = world_matrix(sheet)
        self._size = 0.0
        self._inner = shapely.Polygon()  # the sheet without what is border

    def trouble(self, what: str, item: Any, place: Array | None) -> None:
        """``place`` (3,) in the sheet's coordinates."""
        world = None
        if place is not None:
            x, y, z = self._world[:3, :3] @ place + self._world[:3, 3]
            world = (float(x), float(y), float(z))
        self.troubles.append(Trouble(f"{item.name}: {what}", world, item.name))

    def pattern(self) -> solver.CreasePattern:
        sheet = self._sheet
        unit_mm = self._unit_mm()
        boundary, holes = self._border()
        try:
            polygon = sheet_polygon(boundary, tuple(holes))
        except solver.PatternError as error:
            raise solver.PatternError(error.message, element=sheet.name, place=error.where.place) from error
        shapely.prepare(polygon)
        self._inner = polygon.buffer(-_ALONG_BORDER * snap_tolerance(polygon))
        shapely.prepare(self._inner)
        drawn = drawing_objects.creases_of(sheet)
        folded = [item for item in drawn if item.curvefold.assignment != "F"]
        # A sheet without any crease is one on which nobody has drawn yet: no trouble.
        if drawn and not folded:
            self.trouble("all its creases are Flat, so there is nothing to fold", sheet, None)
        creases = [crease for item in folded for crease in self._creases(item, polygon)]
        return solver.CreasePattern(boundary, holes, creases, sheet.name, unit_mm)

    def _unit_mm(self) -> float:
        x, y = self._world[:3, 0], self._world[:3, 1]
        area = float(np.linalg.norm(np.cross(x, y)))
        longer, shorter = np.linalg.norm(x), np.linalg.norm(y)
        if not abs(np.linalg.det(self._world[:3, :3])) > 0.0:
            raise solver.PatternError("its scale is zero", element=self._sheet.name)
        if abs(longer - shorter) > EVEN * max(longer, shorter) or area < (1 - EVEN) * longer * shorter:
            self.trouble(
                "it is scaled unevenly, so the paper is not as it looks; apply its scale", self._sheet, None
            )
        return 1000.0 * _metres_in_a_unit() * mean_scale(self._sheet)

    # ---- the border

    def _border(self) -> tuple[Array, list[Array]]:
        sheet = self._sheet
        if sheet.type != "CURVE":
            raise solver.PatternError("it is no longer a curve, so it has no border", element=sheet.name)
        strands = self._strands(sheet, np.eye(4))
        if strands:
            self._size = float(np.ptp(_hull(strands)[:, :2], axis=0).max())
        if not self._size > 0.0:
            raise solver.PatternError("it has no border: its curve is empty", element=sheet.name)
        self._check_flat(strands, sheet, "its border leaves its own plane by {}", "")
        curves = [curve for curve in (self._curve(strand, sheet) for strand in strands) if curve is not None]
        curves = [self._mended(curve) for curve in curves]
        closed = [curve for curve in curves if curve.closed]
        if not closed:
            rings = outer_rings(curves, range(len(curves)), self._size)
            if not rings:
                end = curves[0].points[-1] if curves else np.zeros(2)
                raise solver.PatternError("its border is not closed", element=sheet.name, place=tuple(end))
            return rings[0].points, []
        areas = [_area(curve.points) for curve in closed]
        outline = closed[int(np.argmax(areas))]
        polygon = shapely.Polygon(outline.points)
        if len(curves) == 1 or not polygon.is_valid:  # which is judged later, with its place
            return outline.points, []
        holes = []
        inside = polygon.buffer(JOIN * self._size)
        for curve in curves:
            if curve is outline:
                continue
            start = np.array([*curve.points[0], 0.0])
            if not curve.closed:
                self.trouble("a part of its border is not closed and is left out", sheet, start)
            elif not shapely.covers(inside, shapely.LineString(curve.points)):
                self.trouble("a part of its border lies beside the largest one and is left out", sheet, start)
            else:
                holes.append(curve.points)
        return outline.points, holes

    def _mended(self, curve: Curve) -> Curve:
        """Closed, when its ends all but meet."""
        points = curve.points
        if not curve.closed and len(points) > 3 and np.hypot(*(points[0] - points[-1])) <= JOIN * self._size:
            return Curve(points[:-1], True, None)
        return curve

    # ---- creases

    def _creases(self, item: Any, sheet: shapely.Polygon) -> list[solver.Crease]:
        if item.type != "CURVE":
            self.trouble("it is no longer a curve, so it is left out", item, None)
            return []
        self._check_modifiers(item)
        try:
            strands = self._strands(item, matrix_on(self._sheet, item))
        except solver.PatternError as error:
            self.trouble(f"{error.message}, so it is left out", item, None)
            return []
        if not strands:
            if item.mode != "EDIT":  # otherwise it is about to be drawn
                self.trouble("it is empty: draw a curve in it, or delete it", item, None)
            return []
        self._check_flat(strands, item, "it leaves the sheet's plane by {}", "; what lies below or above is folded")
        found = []
        for k, strand in enumerate(strands):
            name = item.name if len(strands) == 1 else f"{item.name} part {k + 1}"
            curve = self._curve(strand, item)
            if curve is None:
                self.trouble(f"{_part(strands, k)} has no length and is left out", item, _start(strand))
            elif self._is_on(sheet, curve, item, _part(strands, k)):
                found.append(
                    solver.Crease(curve.points, curve.closed, item.curvefold.assignment, name, curve.beziers)
                )
        return found

    def _is_on(self, sheet: shapely.Polygon, curve: Curve, item: Any, label: str) -> bool:
        """Whether there is something to fold; by the same measures as the net's."""
        tolerance = snap_tolerance(sheet)
        points = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
        line = shapely.LineString(points)
        middle = np.array([*shapely.get_coordinates(line.interpolate(0.5, normalized=True))[0], 0.0])
        if line.length < tolerance:
            self.trouble(f"{label} is too short to be folded and is left out", item, middle)
            return False
        if shapely.contains_properly(sheet, line):
            return True
        # Enough of it lies well inside, mostly; what follows cuts a line at all places where it crosses itself.
        segments = shapely.linestrings(np.stack([points[:-1], points[1:]], axis=1))
        if shapely.length(segments[shapely.contains_properly(self._inner, segments)]).sum() >= tolerance:
            return True
        # Crossing itself is allowed, and all parts are asked for, so that nothing has to be valid.
        inside = shapely.intersection(line, sheet)
        if inside.length < tolerance:
            self.trouble(f"{label} lies off the sheet and is left out", item, middle)
            return False
        if shapely.difference(inside, sheet.boundary.buffer(_ALONG_BORDER * tolerance)).length < tolerance:
            self.trouble(f"{label} runs along the border, where nothing can fold, and is left out", item, middle)
            return False
        return True

    def _check_modifiers(self, item: Any) -> None:
        for modifier in others_than_on_points(item.modifiers):
            if modifier.show_viewport:
                self.trouble(f"the paper does not see its modifier {modifier.name}; apply it", item, None)

    # ---- both

    def _strands(self, item: Any, matrix: Array) -> list[Strand]:
        """The splines of an object that have a segment, in the sheet's coordinates. Raises PatternError."""
        strands = []
        for strand in shown_strands(item):
            if not len(strand.cubics):
                continue  # a click beside everything leaves a spline of one point, which is no line
            strand = strand.transformed(matrix)
            if not np.isfinite(strand.cubics).all():
                raise solver.PatternError("a point of it is not finite", element=item.name)
            strands.append(strand)
        return strands

    def _check_flat(self, strands: list[Strand], item: Any, what: str, then: str) -> None:
        hull = _hull(strands)
        worst = hull[int(np.argmax(np.abs(hull[:, 2])))]
        if abs(worst[2]) > FLAT * self._size:
            height = abs(float(worst[2])) * float(np.linalg.norm(self._world[:3, 2]))
            self.trouble(what.format(length_text(height)) + then, item, worst)

    def _curve(self, strand: Strand, item: Any) -> Curve | None:
        """A strand as the solver's samples; None without length. Raises PatternError when it is too fine."""
        flat = strand.cubics[..., :2]
        if strand.polyline:
            return _sampled_already(flat, strand.closed)
        segments = tuple(Segment("cubic", control) for control in flat)
        try:
            return sample(Subpath(segments, strand.closed), self._size, MAX_POINTS)
        except solver.PatternError as error:
            raise solver.PatternError(error.message, element=item.name) from error


def _sampled_already(lines: Array, closed: bool) -> Curve | None:
    points = np.vstack([lines[:, 0], lines[-1:, 3]])
    points = points[np.concatenate([[True], (np.diff(points, axis=0) != 0.0).any(axis=1)])]
    joined = bool((points[0] == points[-1]).all())
    closed = (closed or joined) and len(points) >= 4
    if closed and joined:
        points = points[:-1]
    # Samples of a curve that nobody knows: the solver rounds what is not a corner.
    return Curve(points, closed, None) if len(points) > 1 else None


def _hull(strands: list[Strand]) -> Array:
    return np.vstack([strand.cubics.reshape(-1, 3) for strand in strands])


def _start(strand: Strand) -> Array:
    return np.array([*strand.cubics[0, 0, :2], 0.0])


def _part(strands: list[Strand], k: int) -> str:
    return "it" if len(strands) == 1 else f"part {k + 1}"


def _area(points: Array) -> float:
    return abs(float(shapely.Polygon(points).area))


def length_text(value: float) -> str:
    """A length in Blender units as the scene's units write it."""
    units = bpy.context.scene.unit_settings
    if units.system == "NONE":
        return f"{value:.3g}"
    text: str = bpy.utils.units.to_string(units.system, "LENGTH", value * units.scale_length, precision=2)
    return text
