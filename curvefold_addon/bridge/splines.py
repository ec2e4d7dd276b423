"""Blender's splines as cubic Bezier segments: Bezier ones exactly, NURBS to far below single precision."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

Array = NDArray[np.float64]

#: How far cubics may be from a NURBS curve that they stand for, relative to its size: single precision.
_NURBS_ERROR = 1e-7
#: Cubics in one span of a NURBS curve at most; a usual one needs from 1 to 16, one of degree 39 up to 2,048. When
#: they are doubled, the error falls sixteenfold. Where it does not, weights of both signs have made a pole.
_USUAL_CUBICS_IN_SPAN, _MOST_CUBICS_IN_SPAN = 16, 2048
#: A segment whose handles lie this near to its chord (relative to the chord) is straight: single precision.
_STRAIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class Strand:
    """One spline.

    cubics    (S,4,3) control points; no segment when the spline has fewer than two points
    closed    whether it is cyclic; then the last segment ends where the first one starts
    polyline  whether it consists of straight segments between samples
    """

    cubics: Array
    closed: bool
    polyline: bool

    def transformed(self, matrix: Array) -> Strand:
        """Under an affine (4,4) matrix."""
        return Strand(self.cubics @ matrix[:3, :3].T + matrix[:3, 3], self.closed, self.polyline)


def read_strands(curve: Any) -> list[Strand]:
    """The splines of a Curve datablock in its own coordinates, also while it is edited."""
    return [read_strand(spline) for spline in curve.splines]


def read_strand(spline: Any) -> Strand:
    """One spline of a curve in the curve's own coordinates."""
    if spline.type == "BEZIER":
        return _bezier(spline)
    points = np.empty(4 * len(spline.points))
    spline.points.foreach_get("co", points)
    points = points.reshape(-1, 4)
    if spline.type == "NURBS":
        cubics = nurbs_cubics(
            points, spline.order_u, spline.use_cyclic_u, spline.use_endpoint_u, spline.use_bezier_u
        )
        if cubics is not None:
            return Strand(_straightened(cubics), spline.use_cyclic_u, False)
        # Too few points for its order: Blender shows the control polygon.
    return polyline(points[:, :3], spline.use_cyclic_u)


def polyline(points: Array, closed: bool) -> Strand:
    """Straight segments between (P,3) points."""
    closed = closed and len(points) > 2
    rows = np.vstack([points, points[:1]]) if closed else points
    return Strand(_lines(rows[:-1], rows[1:]), closed, True)


def nurbs_cubics(points: Array, order: int, cyclic: bool, endpoint: bool, bezier: bool) -> Array | None:
    """(S,4,3) cubics of a NURBS curve with (P,4) points x, y, z, weight; None where Blender evaluates none."""
    count, degree = len(points), order - 1
    if count < order or (bezier and ((not endpoint and count <= order) or (cyclic and count % degree))):
        return None
    knots = nurbs_knots(count, order, cyclic, endpoint, bezier)
    weighted = np.column_stack([points[:, :3] * points[:, 3:], points[:, 3]])
    if cyclic:
        weighted = np.vstack([weighted, weighted[:degree]])
    return _weighted_cubics(knots, weighted, degree)


def _weighted_cubics(knots: Array, weighted: Array, degree: int) -> Array:
    """(S,4,3) cubics of a curve with (P,4) control points that are multiplied by their weights."""
    starts, lengths = knots[:-1], np.diff(knots)
    used = (lengths > 0) & (starts >= knots[degree]) & (starts < knots[len(weighted)])
    curve = BSpline(knots, weighted, degree)
    # Taylor's coefficients of every span, highest power first; around its middle high orders keep their digits.
    middles = starts[used] + 0.5 * lengths[used]
    powers = [curve(middles, nu=power) / float(factorial(power)) for power in range(degree, -1, -1)]
    return _hermite_cubics(np.array(powers), lengths[used])


def bspline_cubics(curve: BSpline) -> Array:
    """(S,4,2) cubics of a planar cubic spline."""
    flat = np.column_stack([curve.c, np.zeros(len(curve.c)), np.ones(len(curve.c))])
    return _weighted_cubics(curve.t, flat, curve.k)[..., :2]


def nurbs_knots(count: int, order: int, cyclic: bool, endpoint: bool, bezier: bool) -> Array:
    """The knots Blender gives a NURBS curve: uniform, with ends and Bezier joints repeated."""
    size = count + 2 * order - 1 if cyclic else count + order
    inner = order - 1 if bezier else 1
    first = (order - 1 if cyclic else order) if endpoint else (min(2, inner) if bezier else 1)
    tail = 2 * order - 1 if cyclic else (order if endpoint else 0)
    lead = 1 if endpoint and cyclic else 0
    free = size - lead - tail
    # ``first`` equal knots, then groups of ``inner``.
    steps = np.maximum(np.arange(free) - first + inner, 0) // inner
    # Where the tail starts the next group would: one more only if the last one is full.
    after = max(free - first + inner, 0) // inner
    knots = np.concatenate([np.zeros(lead), steps + lead, np.zeros(tail)]).astype(np.float64)
    for k in range(tail):  # one by one: with few points the tail repeats its own beginning
        knots[size - tail + k] = after + lead + knots[k] - knots[0]
    return knots


def _hermite_cubics(coefficients: Array, lengths: Array) -> Array:
    """Cubics along weighted polynomials (order, pieces, 4), highest power of the distance from the middle of the
    piece first: for each piece as many as it needs."""
    found: dict[int, Array] = {}
    open_pieces = np.arange(len(lengths))
    before = np.full(len(lengths), np.inf)
    parts, size = 1, 0.0
    while len(open_pieces):
        place, tangent = _evaluate(coefficients[:, open_pieces], lengths[open_pieces], 2 * parts)
        start, middle, end = place[:, :-2:2], place[:, 1::2], place[:, 2::2]
        third = tangent / (3.0 * parts)
        first, second = start + third[:, :-2:2], end - third[:, 2::2]
        miss = np.abs(0.125 * (start + end) + 0.375 * (first + second) - middle).max(axis=(1, 2))
        size = np.fmax(size, np.ptp(place, axis=(0, 1)).max())
        enough = (miss <= _NURBS_ERROR * size) | (parts >= _MOST_CUBICS_IN_SPAN)
        if parts > _USUAL_CUBICS_IN_SPAN:
            enough |= ~(miss < 0.5 * before)
        cubics = np.stack([start, first, second, end], axis=2)
        found |= zip(open_pieces[enough].tolist(), cubics[enough], strict=True)
        open_pieces, before = open_pieces[~enough], miss[~enough]
        parts *= 2
    return np.concatenate([found[piece] for piece in range(len(lengths))])


def _evaluate(coefficients: Array, lengths: Array, parts: int) -> tuple[Array, Array]:
    """Places and derivatives by the share of the piece (pieces, parts + 1, 3)."""
    at = np.linspace(-0.5, 0.5, parts + 1)[None, :, None] * lengths[:, None, None]
    value = np.zeros((len(lengths), parts + 1, 4))
    slope = np.zeros_like(value)
    for row in coefficients:
        slope = slope * at + value
        value = value * at + row[:, None, :]
    place = value[..., :3] / value[..., 3:]
    tangent = (slope[..., :3] - slope[..., 3:] * place) / value[..., 3:]
    return place, tangent * lengths[:, None, None]


def _bezier(spline: Any) -> Strand:
    count = len(spline.bezier_points)
    rows = {}
    for name in ("co", "handle_left", "handle_right"):
        values = np.empty(3 * count)
        spline.bezier_points.foreach_get(name, values)
        rows[name] = values.reshape(-1, 3)
    closed = spline.use_cyclic_u and count > 1
    start = np.arange(count if closed else count - 1)
    end = (start + 1) % max(count, 1)
    cubics = np.stack(
        [rows["co"][start], rows["handle_right"][start], rows["handle_left"][end], rows["co"][end]], axis=1
    )
    return Strand(_straightened(cubics), closed, False)


def _straightened(cubics: Array) -> Array:
    """Cubics that are straight but for rounding, made exactly straight."""
    chord = cubics[:, 3] - cubics[:, 0]
    length = np.linalg.norm(chord, axis=1)
    direction = chord / np.maximum(length, np.finfo(float).tiny)[:, None]
    offset = cubics[:, 1:3] - cubics[:, :1]
    along = np.einsum("shd,sd->sh", offset, direction)
    across = np.linalg.norm(offset - along[..., None] * direction[:, None], axis=2)
    slack = _STRAIGHT * length
    straight = ((across <= slack[:, None]) & (along >= -slack[:, None]) & (along <= (length + slack)[:, None])).all(
        axis=1
    )
    result = cubics.copy()
    result[straight] = _lines(cubics[straight, 0], cubics[straight, 3])
    return result


def _lines(starts: Array, ends: Array) -> Array:
    third = (ends - starts) / 3.0
    return np.stack([starts, starts + third, ends - third, ends], axis=1)


def add_bezier_spline(curve: Any, cubics: Array, closed: bool) -> None:
    """A Bezier spline of (S,4,3) joined cubics; with ``closed`` the last one ends where the first starts."""
    spline = curve.splines.new("BEZIER")
    points = cubics[:, 0] if closed else np.vstack([cubics[:, 0], cubics[-1:, 3]])
    before = np.roll(cubics[:, 2], 1, axis=0) if closed else np.vstack([points[:1], cubics[:, 2]])
    after = cubics[:, 1] if closed else np.vstack([cubics[:, 1], points[-1:]])
    if not closed:
        # The free handles at the ends go on as the curve does.
        before[0], after[-1] = 2 * points[0] - after[0], 2 * points[-1] - before[-1]
    spline.bezier_points.add(len(points) - 1)
    spline.use_cyclic_u = closed
    # Types first: setting them may move handles.
    kinds = list(_handle_kinds(points, before, after, closed))
    for point, (left, right) in zip(spline.bezier_points, kinds, strict=True):
        point.handle_left_type, point.handle_right_type = left, right
    for name, values in (("co", points), ("handle_left", before), ("handle_right", after)):
        spline.bezier_points.foreach_set(name, np.ascontiguousarray(values, dtype=np.float32).ravel())


def _handle_kinds(points: Array, before: Array, after: Array, closed: bool) -> Iterator[tuple[str, str]]:
    """Handle types that keep the shape when a neighbour is moved: straight, smooth, or neither."""
    forward = np.roll(points, -1, axis=0) - points
    straight = np.linalg.norm(after - points - forward / 3.0, axis=1) <= _STRAIGHT * np.linalg.norm(forward, axis=1)
    back = np.roll(forward, 1, axis=0)
    into = np.linalg.norm(points - before - back / 3.0, axis=1) <= _STRAIGHT * np.linalg.norm(back, axis=1)
    left, right = points - before, after - points
    lengths = np.linalg.norm(left, axis=1) * np.linalg.norm(right, axis=1)
    smooth = np.linalg.norm(np.cross(left, right), axis=1) <= _STRAIGHT * lengths
    smooth &= (left * right).sum(axis=1) > 0
    if not closed:
        straight[-1], into[0] = False, False
    for k in range(len(points)):
        if smooth[k] and not (straight[k] or into[k]):
            yield "ALIGNED", "ALIGNED"
        else:
            yield ("VECTOR" if into[k] else "FREE"), ("VECTOR" if straight[k] else "FREE")


def add_poly_spline(curve: Any, points: Array, closed: bool) -> None:
    """A poly spline through (P,3) points."""
    spline = curve.splines.new("POLY")
    spline.points.add(len(points) - 1)
    rows = np.column_stack([points, np.ones(len(points))])
    spline.points.foreach_set("co", np.ascontiguousarray(rows, dtype=np.float32).ravel())
    spline.use_cyclic_u = closed
