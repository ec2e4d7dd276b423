"""Curves for the plan: those of the drawing as they are, and the least ones that fit samples.

Lines stay lines, and arcs become arcs again. What is neither is cubics, each as long as the tolerance allows.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..arrays import BoolArray, FloatArray
from ..pattern.curves import CORNER
from .arcs import circle_through, fitted_arc, fitted_circle
from .pieces import Arc, ComplexArray, Cubic, Line, Piece
from .walk import NOTHING, Walk

#: How near a drawing's cubics must be to an arc to be one, a part of the tolerance: a reader of drawings writes
#: arcs as cubics this exactly.
_ARC_OF_CUBICS = 0.05
#: The same relative to the drawing's size, where that is more: twice what the reader allows itself.
_ARC_OF_SIZE = 2e-6
#: A cubic is straight when its control points are this near its chord, relative to the drawing's size.
_STRAIGHT = 1e-9
#: An arc of less, between smooth curves that are no arcs, is a piece of them, radians.
_LEAST_SWEEP = math.radians(10.0)
#: Joints that turn by less are smooth, radians.
_SMOOTH = math.radians(1.0)
#: How far a chord between two samples may be from the curve through them, in tolerances; what would be farther is a
#: straight line that is meant.
_CHORD = 2.5
#: A step this many times longer than those beside it may be a line between curves; then the curve bends at its ends
#: by less than this part of what it does one sample on.
_LONE, _BEGINS = 3.0, 0.5
#: Samples are exactly on an arc within this part of the tolerance, if they are so many and turn so much, radians.
_EXACT, _EXACT_POINTS, _EXACT_SWEEP = 0.01, 9, math.radians(30.0)
#: Runs of more samples are not searched for exact arcs.
_MANY = 4_000
#: Places between two samples at which a cubic is compared with the smooth curve through all of them.
_BETWEEN = 4
#: Rounds in which a cubic's parameters are improved.
_ROUNDS = 8
#: A part of the tolerance that rounding may have.
_SAFE = 0.9


def of_cubics(beziers: FloatArray, closed: bool, tolerance: float, size: float) -> Walk:
    """Cubics (S,4,2) in a row, mm, as they are: straight ones as lines, those on circles as arcs.

    size: the longer side of the drawing, mm
    """
    near = max(_ARC_OF_CUBICS * tolerance, _ARC_OF_SIZE * size)
    controls = beziers[..., 0] + 1j * beziers[..., 1]
    found: list[tuple[Piece, list[Cubic]]] = []
    end: complex | None = None
    for row in controls.tolist():
        if end is not None and abs(row[0] - end) <= 1e-6:
            row[0] = end
        elif end is not None:
            found.append((Line(end, row[0]), []))
        end = row[3]
        cubic = Cubic(*row)
        if cubic.length <= NOTHING:
            continue
        piece = _as_line(cubic, _STRAIGHT * size) or _as_arc(cubic, near) or cubic
        found.append((piece, [cubic]))
    if closed and found and abs(found[-1][0].end - found[0][0].start) > NOTHING:
        found.append((Line(found[-1][0].end, found[0][0].start), []))
    merged = _merged_arcs(found, near, closed)
    pieces: list[Piece] = []
    for k, (piece, originals) in enumerate(merged):
        if isinstance(piece, Arc) and abs(piece.sweep) < _LEAST_SWEEP and originals and _goes_on(merged, k, closed):
            pieces.extend(originals)
        else:
            pieces.append(piece)
    return Walk(tuple(pieces), closed)


def of_points(points: FloatArray, closed: bool, tolerance: float) -> Walk:
    """Points (P,2) in a row, mm; of a closed row without the first again.

    The curve is within the tolerance of every point. Where points are the samples of a curve it is smooth.
    """
    z = _without_straight(points[:, 0] + 1j * points[:, 1], closed)
    if closed and len(z) < 3:
        closed = False
    ring = np.append(z, z[0]) if closed else z
    straight, corner = _straight_parts(ring, closed, _CHORD * tolerance)
    if closed and not straight.any() and not corner.any():
        circle = fitted_circle(z, tolerance)
        if circle is not None:
            return Walk((circle,), True)
        return Walk(tuple(_smooth_run(ring, tolerance, None, None, True)), True)
    if closed:
        # A run must not pass the first point: the ring starts at a corner or beside a straight part.
        first = _first_break(straight, corner)
        ring = np.append(np.roll(z, -first), z[first])
        straight, corner = np.roll(straight, -first), np.append(np.roll(corner[:-1], -first), corner[first])
    pieces: list[Piece] = []
    for a, b in _runs(straight, corner):
        if straight[a]:
            pieces.append(Line(complex(ring[a]), complex(ring[b])))
            continue
        before = _way_of(ring, a, straight[a - 1] if a or closed else False, corner[a], -1)
        after = _way_of(
            ring, b, straight[b % len(straight)] if b < len(straight) or closed else False, corner[b], 1
        )
        pieces.extend(_curved_run(ring[a : b + 1], tolerance, before, after))
    return Walk(tuple(pieces), closed)


# ---- cubics of the drawing


def _as_line(cubic: Cubic, near: float) -> Line | None:
    chord = cubic.end - cubic.start
    if abs(chord) <= near:
        return None
    for control in (cubic.first, cubic.second):
        offset = (control - cubic.start) * chord.conjugate() / abs(chord)
        if abs(offset.imag) > near or not -near <= offset.real <= abs(chord) + near:
            return None
    return Line(cubic.start, cubic.end)


def _as_arc(cubic: Cubic, near: float) -> Arc | None:
    z = np.array([cubic.at(t) for t in np.linspace(0.0, 1.0, 9).tolist()])
    centre = circle_through(complex(z[0]), complex(z[4]), complex(z[8]))
    if centre is None:
        return None
    return fitted_arc(z, near)


def _merged_arcs(
    found: list[tuple[Piece, list[Cubic]]], near: float, closed: bool
) -> list[tuple[Piece, list[Cubic]]]:
    merged: list[tuple[Piece, list[Cubic]]] = []
    for piece, originals in found:
        joined = _one_arc(merged[-1][0], piece, near) if merged else None
        if joined is not None:
            merged[-1] = (joined, [*merged[-1][1], *originals])
        else:
            merged.append((piece, originals))
    if closed and len(merged) > 1:
        joined = _one_arc(merged[-1][0], merged[0][0], near)
        if joined is not None:
            merged = [(joined, [*merged[-1][1], *merged[0][1]]), *merged[1:-1]]
    return merged


def _one_arc(first: Piece, second: Piece, near: float) -> Arc | None:
    """Two arcs in a row as one, where they are on one circle."""
    if not (isinstance(first, Arc) and isinstance(second, Arc)) or first.sweep * second.sweep <= 0:
        return None
    if abs(first.end - second.start) > near or abs(first.sweep + second.sweep) > 2 * math.pi + 1e-3:
        return None
    # As many samples a degree on both, so that the longer one counts for more.
    share = first.length / (first.length + second.length)
    count = min(max(round(32 * share), 2), 30)
    z = [first.at(t) for t in np.linspace(0.0, 1.0, count, endpoint=False).tolist()]
    z += [second.at(t) for t in np.linspace(0.0, 1.0, 33 - count).tolist()]
    if abs(first.start - second.end) <= near:
        return fitted_circle(np.array(z[:-1]), near)
    return fitted_arc(np.array(z), near)


def _goes_on(merged: list[tuple[Piece, list[Cubic]]], k: int, closed: bool) -> bool:
    """Whether a curve that is no line goes on smoothly from a piece on either side."""
    here = merged[k][0]
    for step in (-1, 1):
        m = k + step
        if len(merged) == 1 or (not closed and not 0 <= m < len(merged)):
            continue
        other = merged[m % len(merged)][0]
        ways = (other.way(1.0), here.way(0.0)) if step < 0 else (here.way(1.0), other.way(0.0))
        if not isinstance(other, Line) and all(ways) and abs(np.angle(ways[1] / ways[0])) < _SMOOTH:
            return True
    return False


# ---- samples


def _without_straight(z: ComplexArray, closed: bool) -> ComplexArray:
    """The points without repeats, and without those on a straight way on."""
    keep = np.append(True, np.abs(np.diff(z)) > NOTHING)
    z = z[keep]
    if closed and len(z) > 1 and abs(z[0] - z[-1]) <= NOTHING:
        z = z[:-1]
    if len(z) < 3:
        return z
    before, after = z - np.roll(z, 1), np.roll(z, -1) - z
    cross = np.abs((before.conjugate() * after).imag)
    ahead = (before.conjugate() * after).real > 0
    on_line = ahead & (cross <= 1e-7 * np.maximum(np.abs(before), np.abs(after)))
    if not closed:
        on_line[[0, -1]] = False
    kept = z[~on_line]
    return kept if len(kept) >= 3 or not closed else z


def _straight_parts(ring: ComplexArray, closed: bool, chord: float) -> tuple[BoolArray, BoolArray]:
    """Which steps (P-1,) are straight lines that are meant, and which points (P,) are corners."""
    steps = np.diff(ring)
    turn = np.zeros(len(ring))
    turn[1:-1] = np.abs(np.angle(steps[1:] / steps[:-1]))
    corner = turn > CORNER
    if closed:
        turn[0] = turn[-1] = abs(float(np.angle(steps[0] / steps[-1])))
        corner[0] = corner[-1] = turn[0] > CORNER
    else:
        corner[0] = corner[-1] = True
    bent = np.where(corner, 0.0, turn)
    # A curve that turns by this much at a chord's ends is so far from its middle.
    sagitta = np.abs(steps) * np.maximum(bent[:-1], bent[1:]) / 8.0
    straight = (sagitta > chord) | (corner[:-1] & corner[1:]) | _lone_steps(np.abs(steps), turn, corner, closed)
    return straight, corner


def _lone_steps(lengths: FloatArray, turn: FloatArray, corner: BoolArray, closed: bool) -> BoolArray:
    """Which steps are lines between curves that are finely sampled: longer than their neighbours, and the curve
    begins to turn only behind their ends.
    """
    count = len(lengths)
    steps = np.arange(count)
    result = np.ones(count, dtype=bool)
    # Of each step's first point, and how fast the curve turns there.
    bend = turn[:-1] / (0.5 * (np.roll(lengths, 1) + lengths))
    # At both ends of a step: its point there, the step behind it, and that one's other point.
    for point, behind, outer in ((steps, steps - 1, steps - 1), (steps + 1, steps + 1, steps + 2)):
        loose = corner[point] | (not closed and ((point == 0) | (point == count)))
        unknown = corner[outer % count] | (not closed and ((outer < 1) | (outer >= count)))
        longer = lengths > _LONE * lengths[behind % count]
        begins = (bend[point % count] <= _BEGINS * bend[outer % count]) | unknown
        result &= loose | (longer & begins)
    return result & ~(corner[:-1] & corner[1:])


def _first_break(straight: BoolArray, corner: BoolArray) -> int:
    corners = np.flatnonzero(corner[:-1])
    return int(corners[0]) if len(corners) else int(np.flatnonzero(straight)[0])


def _runs(straight: BoolArray, corner: BoolArray) -> Iterator[tuple[int, int]]:
    """First and last points of each straight step, and of each run of others between corners."""
    a = 0
    for k in range(1, len(straight) + 1):
        if k == len(straight) or corner[k] or straight[k] or straight[k - 1]:
            yield a, k
            a = k


def _way_of(ring: ComplexArray, k: int, beside_straight: bool, corner: bool, step: int) -> complex | None:
    """The direction in which a run leaves or reaches a point that a straight line touches."""
    if corner or not beside_straight:
        return None
    last = len(ring) - 1
    if step < 0:
        way = ring[k] - (ring[k - 1] if k else ring[last - 1])
    else:
        way = (ring[k + 1] if k < last else ring[1]) - ring[k]
    return complex(way / abs(way))


def _curved_run(z: ComplexArray, tolerance: float, before: complex | None, after: complex | None) -> list[Piece]:
    if len(z) == 2:
        return [Line(complex(z[0]), complex(z[1]))]
    if _off_chord(z) <= _ARC_OF_CUBICS * tolerance:
        return [Line(complex(z[0]), complex(z[-1]))]
    arc = fitted_arc(z, _SAFE * tolerance)
    if arc is not None:
        return [arc]
    pieces: list[Piece] = []
    done = 0
    for a, b in _exact_arcs(z, _EXACT * tolerance):
        exact = fitted_arc(z[a : b + 1], tolerance)
        if exact is None:
            continue
        if a > done:
            way = exact.way(0.0)
            pieces.extend(_smooth_run(z[done : a + 1], tolerance, before, way / abs(way), False))
        pieces.append(exact)
        way = exact.way(1.0)
        before, done = way / abs(way), b
    if done < len(z) - 1:
        pieces.extend(_smooth_run(z[done:], tolerance, before, after, False))
    return pieces


def _off_chord(z: ComplexArray) -> float:
    chord = z[-1] - z[0]
    if not chord:
        return math.inf
    return float(np.abs(((z - z[0]) * chord.conjugate()).imag).max() / abs(chord))


def _exact_arcs(z: ComplexArray, near: float) -> Iterator[tuple[int, int]]:
    """Stretches of samples that lie on one circle each, as a drawing's own arcs do."""
    a = 0
    while len(z) <= _MANY and a + _EXACT_POINTS <= len(z):
        middle = _EXACT_POINTS // 2
        centre = circle_through(complex(z[a]), complex(z[a + middle]), complex(z[a + _EXACT_POINTS - 1]))
        if centre is not None:
            off = np.abs(np.abs(z[a:] - centre) - abs(z[a] - centre)) > near
            count = int(np.argmax(off)) if off.any() else len(off)
            if count >= _EXACT_POINTS:
                some = z[a : a + count] - centre
                if abs(float(np.angle(some[1:] / some[:-1]).sum())) >= _EXACT_SWEEP:
                    yield a, a + count - 1
                    a += count - 1
                    continue
        a += 1


# ---- cubics through samples


def _smooth_run(
    z: ComplexArray, tolerance: float, before: complex | None, after: complex | None, periodic: bool
) -> list[Piece]:
    """Cubics with common tangents through samples in a row, each as long as the tolerance allows."""
    if len(z) == 2:
        return [Line(complex(z[0]), complex(z[1]))]
    along = np.append(0.0, np.cumsum(np.abs(np.diff(z))))
    curve = CubicSpline(along, np.column_stack([z.real, z.imag]), bc_type="periodic" if periodic else "not-a-knot")
    # The curve is compared between the samples too.
    parts = [np.linspace(a, b, _BETWEEN, endpoint=False) for a, b in itertools.pairwise(along.tolist())]
    where = np.append(np.concatenate(parts), along[-1])
    dense = curve(where) @ np.array([1.0, 1j])
    ways = curve(where, 1) @ np.array([1.0, 1j])
    ways = ways / np.maximum(np.abs(ways), np.finfo(float).tiny)
    if before is not None:
        ways[0] = before
    if after is not None:
        ways[-1] = after
    pieces: list[Piece] = []
    start, last = 0, len(dense) - 1
    while start < last:
        cubic, end = _longest(dense, ways, start, last, _SAFE * tolerance)
        pieces.append(cubic)
        start = end
    return pieces


def _longest(z: ComplexArray, ways: ComplexArray, start: int, last: int, tolerance: float) -> tuple[Cubic, int]:
    """The longest stretch from a point on that one cubic fits, and where it ends."""
    cubic = _fitted(z[start : last + 1], ways[start], ways[last], tolerance)
    if cubic is not None:
        return cubic, last
    good, bad = start + 1, last
    best = _hermite(z[start], z[good], ways[start], ways[good])
    while bad - good > 1:
        middle = (good + bad) // 2
        cubic = _fitted(z[start : middle + 1], ways[start], ways[middle], tolerance)
        if cubic is None:
            bad = middle
        else:
            good, best = middle, cubic
    return best, good


def _hermite(a: complex, b: complex, way: complex, end: complex) -> Cubic:
    third = abs(b - a) / 3.0
    return Cubic(complex(a), complex(a + third * way), complex(b - third * end), complex(b))


def _fitted(z: ComplexArray, way: complex, end: complex, tolerance: float) -> Cubic | None:
    """The cubic with these ends and tangents that is nearest to points, None if it is farther than allowed."""
    steps = np.abs(np.diff(z))
    whole = float(steps.sum())
    if len(z) < 3:
        return _hermite(z[0], z[-1], way, end)
    t = np.append(0.0, np.cumsum(steps) / whole)
    for _ in range(_ROUNDS):
        cubic = _least_squares(z, t, way, end, whole)
        if cubic is None:
            return None
        off = _at(cubic, t) - z
        if float(np.abs(off).max()) <= tolerance:
            return cubic
        t = _improved(cubic, z, t)
    return None


def _least_squares(
    z: ComplexArray, t: NDArray[np.float64], way: complex, end: complex, whole: float
) -> Cubic | None:
    s = 1.0 - t
    fixed = (s**3 + 3 * s * s * t) * z[0] + (t**3 + 3 * s * t * t) * z[-1]
    one, two = 3 * s * s * t * way, -3 * s * t * t * end
    matrix = np.column_stack([np.append(one.real, one.imag), np.append(two.real, two.imag)])
    wanted = z - fixed
    normal = matrix.T @ matrix
    if abs(np.linalg.det(normal)) <= 1e-14 * normal.trace() ** 2:
        handles = np.full(2, whole / 3.0)
    else:
        handles = np.linalg.solve(normal, matrix.T @ np.append(wanted.real, wanted.imag))
    if (handles <= 1e-6 * whole).any() or (handles > 3.0 * whole).any():
        return None
    first, second = z[0] + handles[0] * way, z[-1] - handles[1] * end
    return Cubic(complex(z[0]), complex(first), complex(second), complex(z[-1]))


def _at(cubic: Cubic, t: NDArray[np.float64]) -> ComplexArray:
    s = 1.0 - t
    a, b, c, d = cubic.points
    return np.asarray(s**3 * a + 3 * s * s * t * b + 3 * s * t * t * c + t**3 * d)


def _improved(cubic: Cubic, z: ComplexArray, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Parameters nearer to the points: one Newton step each, kept in order."""
    a, b, c, d = cubic.points
    s = 1.0 - t
    off = _at(cubic, t) - z
    way = 3 * s * s * (b - a) + 6 * s * t * (c - b) + 3 * t * t * (d - c)
    bend = 6 * s * (c - 2 * b + a) + 6 * t * (d - 2 * c + b)
    slope = np.abs(way) ** 2 + (off * bend.conjugate()).real
    step = np.where(slope > 0, (off * way.conjugate()).real / np.where(slope > 0, slope, 1.0), 0.0)
    moved = np.clip(t - step, 0.0, 1.0)
    moved[0], moved[-1] = 0.0, 1.0
    return np.maximum.accumulate(moved)
