"""One entity of a DXF file -> its outlines in the drawing's plane: lines, arcs and cubics, curves kept.

Entities of a plane of their own (extrusion direction) and of blocks that are scaled, mirrored or tilted are seen
from above: an affine map of the plane, which arcs and cubics survive exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..dxf_library import dxf_library
from ..errors import PatternError
from .nurbs import spline_segments
from .segments import MAX_COORDINATE, Segment, Subpath, arc, line

#: How far cubics may be from a spline that they only approximate, parts of the spline's size.
_SPLINE_TOLERANCE = 1e-7
#: A bulge below this is a straight line: it is an arc that leaves its chord by half of this part of its length.
_STRAIGHT_BULGE = 1e-7
#: POLYLINE's vertices that are no points of the line (group code 70): the frame of a spline.
_FRAME_VERTEX = 16
_FULL = 2.0 * math.pi
#: An extrusion direction with less than this in x and in y takes its x axis from the y axis around it.
_NEARLY_UP = 1.0 / 64.0
#: How far ends of an ellipse may be from a whole turn, radians: files round to six digits.
_WHOLE_TURN = 1e-6


def subpaths_of(entity: Any, matrix: FloatArray) -> list[Subpath]:
    """The outlines of an entity of one of KINDS, under a (4,4) ``matrix`` of row vectors. Raises PatternError."""
    with np.errstate(over="ignore", invalid="ignore"):
        subpaths = list(_SHAPES[entity.dxftype()](entity, matrix))
    for subpath in subpaths:
        if not all(np.abs(segment.points).max() < MAX_COORDINATE for segment in subpath.segments):
            raise PatternError("its coordinates are not finite, or too large to be a drawing")
    return subpaths


def _line(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    ends = _seen([entity.dxf.start, entity.dxf.end], matrix)
    yield Subpath((line(*ends),), False)


def _circle(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    yield _round(entity, matrix, 0.0, _FULL)


def _arc(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    begin, end = math.radians(entity.dxf.start_angle), math.radians(entity.dxf.end_angle)
    yield _round(entity, matrix, begin, _sweep(begin, end))


def _round(entity: Any, matrix: FloatArray, begin: float, sweep: float) -> Subpath:
    own = _own_plane(entity) @ matrix
    radius = float(entity.dxf.radius)
    return _turned(_seen([entity.dxf.center], own)[0], radius * own[0, :2], radius * own[1, :2], begin, sweep)


def _ellipse(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    major = np.array(tuple(entity.dxf.major_axis))
    normal = np.array(tuple(entity.dxf.extrusion))
    length = float(np.linalg.norm(normal))
    normal = normal / length if length > 0.0 else np.array([0.0, 0.0, 1.0])
    minor = float(entity.dxf.ratio) * np.cross(normal, major)
    begin, end = float(entity.dxf.start_param), float(entity.dxf.end_param)
    u, v = np.array([major, minor]) @ matrix[:3, :2]
    yield _turned(_seen([entity.dxf.center], matrix)[0], u, v, begin, _sweep(begin, end))


def _sweep(begin: float, end: float) -> float:
    """From an angle to the next one counter-clockwise; a whole turn where they are the same."""
    sweep = (end - begin) % _FULL
    return _FULL if min(sweep, _FULL - sweep) < _WHOLE_TURN else sweep


def _turned(centre: FloatArray, u: FloatArray, v: FloatArray, begin: float, sweep: float) -> Subpath:
    whole = sweep == _FULL
    start, end = (centre + math.cos(t) * u + math.sin(t) * v for t in (begin, begin if whole else begin + sweep))
    return Subpath((arc(start, end, centre, u, v, begin, sweep),), whole)


def _light_polyline(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    own = _own_plane(entity) @ matrix
    height = float(entity.dxf.elevation)
    points = np.array(entity.get_points("xyb"), dtype=np.float64).reshape(-1, 3)
    yield from _bulged(points[:, :2], points[:, 2], height, bool(entity.closed), own)


def _polyline(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        raise PatternError("it is a mesh of faces and no line")
    vertices = [one.dxf for one in entity.vertices if not one.dxf.get("flags", 0) & _FRAME_VERTEX]
    points = np.array([tuple(vertex.location) for vertex in vertices], dtype=np.float64).reshape(-1, 3)
    if entity.is_3d_polyline:
        yield from _bulged(_seen(points, matrix), np.zeros(len(points)), 0.0, bool(entity.is_closed), np.eye(4))
        return
    bulges = np.array([vertex.get("bulge", 0.0) for vertex in vertices], dtype=np.float64)
    height = float(entity.dxf.get("elevation", (0.0, 0.0, 0.0))[2])
    own = _own_plane(entity) @ matrix
    yield from _bulged(points[:, :2], bulges, height, bool(entity.is_closed), own)


def _bulged(
    points: FloatArray, bulges: FloatArray, height: float, closed: bool, matrix: FloatArray
) -> Iterator[Subpath]:
    """A polyline (P,2). A bulge is the tangent of a quarter of the angle by which the arc to the next one turns."""
    plane = np.eye(3)
    plane[:2, :2], plane[:2, 2] = matrix[:2, :2].T, matrix[3, :2] + height * matrix[2, :2]
    count = len(points) if closed else len(points) - 1
    segments = [
        _side(points[k], points[(k + 1) % len(points)], float(bulges[k])).transformed(plane)
        for k in range(count)
        if (points[k] != points[(k + 1) % len(points)]).any()
    ]
    if segments:
        yield Subpath(tuple(segments), closed)


def _side(start: FloatArray, end: FloatArray, bulge: float) -> Segment:
    if not abs(bulge) > _STRAIGHT_BULGE:
        return line(start, end)
    chord = end - start
    left = np.array([-chord[1], chord[0]])
    centre = 0.5 * (start + end) + left * (1.0 - bulge * bulge) / (4.0 * bulge)
    u = start - centre
    return arc(start, end, centre, u, np.array([-u[1], u[0]]), 0.0, 4.0 * math.atan(bulge))


def _spline(entity: Any, matrix: FloatArray) -> Iterator[Subpath]:
    controls = np.array(entity.control_points, dtype=np.float64).reshape(-1, 3)
    knots, weights = np.array(entity.knots, dtype=np.float64), np.array(entity.weights, dtype=np.float64)
    degree = int(entity.dxf.degree)
    if not len(controls):
        if len(entity.fit_points) < 2:
            raise PatternError("it is a spline without points")
        through = dxf_library().math.fit_points_to_cad_cv(entity.fit_points, _end_tangents(entity))
        controls = np.array([tuple(point) for point in through.control_points])
        knots, weights, degree = np.array(through.knots()), np.array(through.weights()), through.degree
    seen = _seen(controls, matrix)
    if not len(weights):
        weights = np.ones(len(seen))
    tolerance = _SPLINE_TOLERANCE * float(np.ptp(seen, axis=0).max())
    yield Subpath(spline_segments(seen, weights, knots, degree, tolerance), bool(entity.closed))


def _end_tangents(entity: Any) -> list[Any] | None:
    tangents = [entity.dxf.get("start_tangent"), entity.dxf.get("end_tangent")]
    return tangents if all(tangent is not None and tangent.magnitude > 0.0 for tangent in tangents) else None


def _seen(points: Any, matrix: FloatArray) -> FloatArray:
    """Points (P,3) from above, (P,2)."""
    array = np.array([tuple(point) for point in points], dtype=np.float64).reshape(-1, 3)
    return np.asarray(array @ matrix[:3, :2] + matrix[3, :2])


def _own_plane(entity: Any) -> FloatArray:
    """(4,4) from the entity's own coordinate system to that around it, by its extrusion direction (DXF reference,
    arbitrary axis algorithm).
    """
    matrix = np.eye(4)
    normal = np.array(tuple(entity.dxf.get("extrusion", (0.0, 0.0, 1.0))))
    length = float(np.linalg.norm(normal))
    if (length > 0.0 and normal[:2].any()) or normal[2] < 0.0:
        z = normal / length
        x = np.cross([0.0, 1.0, 0.0] if np.abs(z[:2]).max() < _NEARLY_UP else [0.0, 0.0, 1.0], z)
        x /= np.linalg.norm(x)
        matrix[:3, :3] = x, np.cross(z, x), z
    return matrix


_SHAPES: dict[str, Callable[[Any, FloatArray], Iterator[Subpath]]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _light_polyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
}
#: Entities that are lines.
KINDS = frozenset(_SHAPES)
