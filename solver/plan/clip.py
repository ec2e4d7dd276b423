"""What of a line lies in a box, as lines: no file needs a clip path."""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Iterator

import numpy as np

from .pieces import Arc, Cubic, Line, Piece
from .walk import Walk

Box = tuple[float, float, float, float]

#: Parts of a piece shorter than this, in its parameter, are nothing.
_NOTHING = 1e-9


def clipped(walk: Walk, box: Box) -> list[Walk]:
    """The parts of a walk in a box: x and y minimum, x and y maximum."""
    rows: list[list[Piece]] = []
    last_inside = False
    whole = True
    for piece in walk.pieces:
        for part, inside in _parts(piece, box):
            if inside and last_inside:
                rows[-1].append(part)
            elif inside:
                rows.append([part])
            last_inside = inside
            whole = whole and inside
    if whole:
        return [walk]
    if walk.closed and len(rows) > 1 and last_inside and rows[0][0].start == walk.pieces[0].start:
        rows[0] = rows.pop() + rows[0]
    return [Walk(tuple(row)) for row in rows]


def _parts(piece: Piece, box: Box) -> Iterator[tuple[Piece, bool]]:
    """A piece cut at the box's sides, and whether each part is inside."""
    low_x, low_y, high_x, high_y = box
    cuts = sorted(
        t
        for crossing in ((low_x, 0), (high_x, 0), (low_y, 1), (high_y, 1))
        for t in _crossings(piece, *crossing)
        if _NOTHING < t < 1.0 - _NOTHING
    )
    bounds = [0.0, *cuts, 1.0]
    for a, b in itertools.pairwise(bounds):
        if b - a <= _NOTHING:
            continue
        middle = piece.at(0.5 * (a + b))
        inside = low_x <= middle.real <= high_x and low_y <= middle.imag <= high_y
        yield (piece if (a, b) == (0.0, 1.0) else piece.part(a, b)), inside


def _crossings(piece: Piece, value: float, axis: int) -> list[float]:
    """Parameters at which a coordinate (0: x, 1: y) has a value."""

    def coordinate(z: complex) -> float:
        return z.imag if axis else z.real

    if isinstance(piece, Line):
        start, step = coordinate(piece.start), coordinate(piece.end) - coordinate(piece.start)
        return [(value - start) / step] if step else []
    if isinstance(piece, Arc):
        off = (value - coordinate(piece.centre)) / piece.radius
        if abs(off) >= 1.0:
            return []
        angles = [math.asin(off), math.pi - math.asin(off)] if axis else [math.acos(off), -math.acos(off)]
        return [t for angle in angles for t in _turns_to(piece, angle)]
    return _cubic_roots(piece, value, axis)


def _turns_to(arc: Arc, angle: float) -> list[float]:
    turn = cmath.phase(cmath.rect(1.0, angle - arc.begin))
    around = 2 * math.pi
    return [t for k in (-1, 0, 1) if 0.0 <= (t := (turn + k * around) / arc.sweep) <= 1.0]


def _cubic_roots(piece: Cubic, value: float, axis: int) -> list[float]:
    a, b, c, d = (z.imag if axis else z.real for z in piece.points)
    powers = np.array([d - 3 * c + 3 * b - a, 3 * (c - 2 * b + a), 3 * (b - a), a - value])
    size = float(np.abs(powers[:3]).max())
    if not size:
        return []
    powers[np.abs(powers) < 1e-14 * size] = 0.0
    roots = np.roots(powers)
    return [float(root.real) for root in roots if abs(root.imag) < 1e-9]
