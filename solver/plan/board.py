"""V-grooves for board: as wide along each crease as its fold needs, on the face that the fold closes.

A groove whose walls meet when the board is folded by an angle is ``2 t tan(angle / 2)`` wide at the face, for board
of thickness ``t`` that keeps its hinge on the other face.
"""

from __future__ import annotations

import math

import numpy as np
import shapely

from ..arrays import FloatArray
from ..errors import PatternError
from .crease_parts import CHORD
from .data import CREASES, Kind, Plan, PlanStroke
from .fitting import of_points
from .pieces import ComplexArray, Line, Piece
from .walk import Walk

#: Folds of more cannot be grooved, degrees: the groove would be more than 11 thicknesses wide.
_MOST_ANGLE = 160.0
#: Fold angles are smoothed along a crease over this part of its length: a net's angles waver by a degree or two.
_SMOOTHING = 0.04
#: Places along a crease at which a groove is measured, mm, and how many there are at least and at most.
_SPACING, _LEAST, _MOST = 0.5, 33, 2_000
#: The end of a crease this near the edge of the sheet is on it, mm.
_ON_EDGE = 0.5
#: How far a groove runs beyond an edge that it meets at a slant, in halves of its width.
_BEYOND = 3.0


def with_grooves(plan: Plan, thickness: float, passes: int, least_bend_radius: float, tolerance: float) -> Plan:
    """The plan with grooves for board.

    passes             lines from edge to edge of a groove, 2 or more
    least_bend_radius  that the board can be bent to, in thicknesses
    Raises PatternError where the fold is not known, or the board cannot take it.
    """
    folds = plan.having(Kind.MOUNTAIN, Kind.VALLEY)
    if plan.having(*CREASES) and not plan.folded:
        raise PatternError(
            "grooves are as wide as creases fold, which a drawing does not say; "
            "give a folded file or a folder of results"
        )
    edges = [stroke.walk.samples(CHORD)[0] for stroke in plan.having(Kind.BORDER, Kind.HOLE)]
    rings = shapely.multilinestrings([np.vstack([points, points[:1]]) for points in edges])
    grooves = [
        PlanStroke(walk, Kind.GROOVE, stroke.name, back=stroke.kind is Kind.MOUNTAIN)
        for stroke in folds
        for walk in _grooves(stroke, thickness, passes, least_bend_radius, tolerance, rings)
    ]
    return Plan((*plan.strokes, *grooves), plan.width, plan.height, plan.name, plan.folded, plan.notes)


def groove_width(thickness: float, degrees: FloatArray) -> FloatArray:
    """Widths at the face (n,), in the unit of the thickness."""
    return np.asarray(2.0 * thickness * np.tan(np.radians(degrees) / 2.0))


def _grooves(
    stroke: PlanStroke,
    thickness: float,
    passes: int,
    least_bend_radius: float,
    tolerance: float,
    edges: shapely.MultiLineString,
) -> list[Walk]:
    walk = stroke.walk
    whole = walk.closed and not stroke.vertices
    found: list[Walk] = []
    for start, end in stroke.parts:
        count = int(np.clip((end - start) / _SPACING, _LEAST, _MOST))
        along = np.linspace(start, end, count)
        if whole:
            along = along[:-1]
        degrees = _angles(stroke, along, start, end)
        # Just inside the ends: a corner has two directions.
        inside = np.clip(along, start + 1e-6, end - 1e-6) if not whole else along
        ways = np.array([walk.way(length) for length in inside.tolist()])
        points = np.array([walk.at(length) for length in along.tolist()])
        half = 0.5 * groove_width(thickness, degrees)
        _check(stroke, points, ways, along, degrees, half, thickness, least_bend_radius)
        if not whole:
            points, ways, half = _beyond_edges(points, ways, half, edges)
        found += _lines(points, ways, half, passes, whole, tolerance)
    return found


def _angles(stroke: PlanStroke, along: FloatArray, start: float, end: float) -> FloatArray:
    """Fold angles, degrees, at lengths of a part."""
    around = stroke.walk.length if stroke.walk.closed else math.inf
    known = np.array([(length, degrees) for length, degrees in stroke.angles]).reshape(-1, 2)
    if stroke.walk.closed:
        known = np.concatenate([known + np.array([shift, 0.0]) for shift in (-around, 0.0, around)])
    slack = 0.05 * (end - start) if stroke.walk.closed else 0.0
    mine = known[(known[:, 0] >= start - slack) & (known[:, 0] <= end + slack)]
    if not len(mine):
        mine = known
    if not len(mine):
        raise PatternError("its fold angle is not known, so no groove can be made", element=stroke.name)
    mine = mine[np.argsort(mine[:, 0], kind="stable")]
    reach = max(_SMOOTHING * (end - start), 1e-9)
    weights = np.exp(-0.5 * ((along[:, None] - mine[None, :, 0]) / reach) ** 2) + 1e-12
    smooth = (weights @ mine[:, 1]) / weights.sum(axis=1)
    return np.asarray(smooth)


def _check(
    stroke: PlanStroke,
    points: ComplexArray,
    ways: ComplexArray,
    along: FloatArray,
    degrees: FloatArray,
    half: FloatArray,
    thickness: float,
    least_bend_radius: float,
) -> None:
    worst = int(np.argmax(degrees))
    if degrees[worst] > _MOST_ANGLE:
        raise PatternError(
            f"it folds by {degrees[worst]:.0f}°, and grooves are made for {_MOST_ANGLE:.0f}° at most",
            element=stroke.name,
            place=(float(points[worst].real), float(points[worst].imag)),
        )
    turns = np.abs(np.angle(ways[1:] / ways[:-1])) / np.maximum(np.diff(along), 1e-12)
    bend = np.append(turns, turns[-1])
    # Paper on both sides of a crease bends by its curvature times tan(angle / 2): that of the board, too.
    curved = bend * np.tan(np.radians(degrees) / 2.0)
    worst = int(np.argmax(curved))
    radius = 1.0 / curved[worst] if curved[worst] > 0 else math.inf
    place = (float(points[worst].real), float(points[worst].imag))
    if radius < least_bend_radius * thickness:
        raise PatternError(
            f"board of {thickness:g} mm would bend to a radius of {radius:.3g} mm beside it, and "
            f"{least_bend_radius * thickness:g} mm is the least that it can; take thinner board, a smaller fold "
            "angle or a gentler curve",
            element=stroke.name,
            place=place,
        )
    if (bend * half).max() >= 1.0:
        worst = int(np.argmax(bend * half))
        raise PatternError(
            f"its groove would be {2 * half[worst]:.3g} mm wide where the crease has a radius of "
            f"{1.0 / bend[worst]:.3g} mm; take thinner board or a gentler curve",
            element=stroke.name,
            place=(float(points[worst].real), float(points[worst].imag)),
        )


def _beyond_edges(
    points: ComplexArray, ways: ComplexArray, half: FloatArray, edges: shapely.MultiLineString
) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """The groove a little longer where it meets the edge of the sheet, so that a slanted one is grooved whole."""
    for end, sign in ((0, -1.0), (-1, 1.0)):
        at, way = complex(points[end]), complex(ways[end]) * sign
        if edges.distance(shapely.Point(at.real, at.imag)) > _ON_EDGE:
            continue
        line = _edge_direction(at, edges)
        across = abs((line.conjugate() * way).imag)
        slant = min(abs((line.conjugate() * way).real) / max(across, 1e-9), _BEYOND)
        step = half[end] * slant
        if step <= CHORD:
            continue
        more = at + way * step
        points = np.append(more, points) if end == 0 else np.append(points, more)
        ways = np.append(ways[0], ways) if end == 0 else np.append(ways, ways[-1])
        half = np.append(half[0], half) if end == 0 else np.append(half, half[-1])
    return points, ways, half


def _edge_direction(at: complex, edges: shapely.MultiLineString) -> complex:
    ring = min(edges.geoms, key=lambda one: one.distance(shapely.Point(at.real, at.imag)))
    along = ring.project(shapely.Point(at.real, at.imag))
    a, b = (ring.interpolate((along + step) % ring.length) for step in (-0.01, 0.01))
    way = complex(b.x - a.x, b.y - a.y)
    return way / abs(way) if way else 1.0


def _lines(
    points: ComplexArray, ways: ComplexArray, half: FloatArray, passes: int, closed: bool, tolerance: float
) -> list[Walk]:
    """The edges of a groove, one outline where they have ends, and the passes between them."""
    shares = np.linspace(1.0, -1.0, passes).tolist()
    rows = [points + 1j * ways * half * share for share in shares]
    walks = [of_points(np.column_stack([row.real, row.imag]), closed, tolerance) for row in rows]
    if closed:
        return walks
    left, right = walks[0], walks[-1].reversed()
    pieces: tuple[Piece, ...] = (
        *right.pieces,
        Line(right.pieces[-1].end, left.pieces[0].start),
        *left.pieces,
        Line(left.pieces[-1].end, right.pieces[0].start),
    )
    return [Walk(pieces, True), *walks[1:-1]]
