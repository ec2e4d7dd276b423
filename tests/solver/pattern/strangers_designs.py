"""Crease patterns of our own, as their authors mean them: millimetres, y up, the sheet's box from (0, 0)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
Rng = np.random.Generator

#: Points that stand for one cubic segment, both ends counted.
_SAMPLES = 17


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve as its author thinks of it.

    beziers   (S,4,2) cubic segments, one after the other, mm
    closed    whether the last one ends where the first one begins
    arc       centre x, y, radius, first and last angle (degrees, counter-clockwise) where it is a part of a circle
    straight  whether every segment is a straight line
    """

    beziers: FloatArray
    closed: bool = False
    arc: tuple[float, float, float, float, float] | None = None
    straight: bool = False

    def points(self, count: int = _SAMPLES) -> FloatArray:
        """(P,2) along the curve, ``count`` on each segment (two, where it is straight); closed: the first again."""
        t = np.linspace(0.0, 1.0, 2 if self.straight else count)
        weights = np.column_stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
        rows = np.einsum("tk,skd->std", weights, self.beziers)
        return np.vstack([rows[0], *rows[1:, 1:]])

    def moved(self, by: ArrayLike) -> Curve:
        by = np.asarray(by, dtype=float)
        arc = self.arc and (self.arc[0] + by[0], self.arc[1] + by[1], *self.arc[2:])
        return replace(self, beziers=self.beziers + by, arc=arc)

    def stretched(self, first: float, last: float) -> Curve:
        """The same curve, longer by ``first`` at its start and ``last`` at its end (mm; negative: shorter)."""
        if self.arc is not None:
            x, y, radius, one, other = self.arc
            turn = np.degrees(1.0 / radius) * np.sign(other - one)
            return arc((x, y), radius, one - first * turn, other + last * turn)
        beziers = self.beziers.copy()
        lengths = [float(np.hypot(*np.diff(Curve(beziers[[k]]).points(), axis=0).T).sum()) for k in (0, -1)]
        beziers[0] = _part(beziers[0], -first / lengths[0], 1.0)
        beziers[-1] = _part(beziers[-1], 0.0, 1.0 + last / lengths[1])
        return replace(self, beziers=beziers)


def _part(bezier: FloatArray, start: float, end: float) -> FloatArray:
    """(4,2) the cubic from one parameter to another one, also beyond its ends (blossoming)."""

    def blossom(*at: float) -> FloatArray:
        points = bezier
        for t in at:
            points = (1 - t) * points[:-1] + t * points[1:]
        return points[0]

    return np.array(
        [blossom(start, start, start), blossom(start, start, end), blossom(start, end, end), blossom(end, end, end)]
    )


@dataclass(frozen=True, eq=False)
class Design:
    """A sheet as its author means it. outline: closed; folds: (curve, FOLD letter); cuts: open slits."""

    name: str
    outline: Curve
    folds: tuple[tuple[Curve, str], ...]
    holes: tuple[Curve, ...] = ()
    cuts: tuple[Curve, ...] = ()

    @property
    def size(self) -> FloatArray:
        """(2,) width and height of the sheet."""
        return np.ptp(self.outline.points(), axis=0)

    @property
    def rectangular(self) -> bool:
        return self.outline.straight and len(self.outline.beziers) == 4 and not self.name.startswith("hexagon")


# --- curves ---------------------------------------------------------------------------------------------


def lines(*points: Sequence[float], closed: bool = False) -> Curve:
    at = np.array(points, dtype=float)
    a, b = (at, np.roll(at, -1, axis=0)) if closed else (at[:-1], at[1:])
    return Curve(np.stack([a, a + (b - a) / 3, b - (b - a) / 3, b], axis=1), closed, straight=True)


def rectangle(width: float, height: float, at: tuple[float, float] = (0.0, 0.0)) -> Curve:
    x, y = at
    return lines((x, y), (x + width, y), (x + width, y + height), (x, y + height), closed=True)


def arc(centre: Sequence[float], radius: float, first: float, last: float) -> Curve:
    parts = max(1, int(np.ceil(abs(last - first) / 90.0 - 1e-9)))
    angles = np.radians(np.linspace(first, last, parts + 1))
    reach = 4.0 / 3.0 * np.tan((angles[1] - angles[0]) / 4.0)
    on = np.column_stack([np.cos(angles), np.sin(angles)])
    along = np.column_stack([-np.sin(angles), np.cos(angles)]) * reach
    unit = np.stack([on[:-1], on[:-1] + along[:-1], on[1:] - along[1:], on[1:]], axis=1)
    whole = abs(abs(last - first) - 360.0) < 1e-9
    return Curve(
        np.asarray(centre, dtype=float) + radius * unit,
        whole,
        (float(centre[0]), float(centre[1]), radius, float(first), float(last)),
    )


def circle(centre: Sequence[float], radius: float) -> Curve:
    return arc(centre, radius, 0.0, 360.0)


def bow(a: Sequence[float], b: Sequence[float], sag: float) -> Curve:
    """An arc of a circle from a to b; ``sag`` to the left of the chord."""
    p, q = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    chord = float(np.hypot(*(q - p)))
    radius = (chord**2 / 4 + sag**2) / (2 * abs(sag))
    left = np.array([p[1] - q[1], q[0] - p[0]]) / chord
    centre = 0.5 * (p + q) + left * (sag - np.copysign(radius, sag))
    first, last = (float(np.degrees(np.arctan2(*(point - centre)[::-1]))) for point in (p, q))
    turn = (last - first) % 360.0
    return arc(centre.tolist(), radius, first, first + (turn - 360.0 if sag > 0 else turn))


def smooth(points: ArrayLike) -> Curve:
    """Cubics through points, as drawing programs smooth them (tangents along the neighbours)."""
    at = np.asarray(points, dtype=float)
    tangents = np.gradient(at, axis=0) / 3.0
    return Curve(np.stack([at[:-1], at[:-1] + tangents[:-1], at[1:] - tangents[1:], at[1:]], axis=1))


# --- sheets ---------------------------------------------------------------------------------------------


def _alternating(curves: Sequence[Curve], first: str = "M") -> tuple[tuple[Curve, str], ...]:
    return tuple((curve, "MV"[(k + (first == "V")) % 2]) for k, curve in enumerate(curves))


def s_pleats(rng: Rng) -> Design:
    width, height = rng.uniform(100, 160), rng.uniform(70, 95)
    count, swing = int(rng.integers(2, 6)), rng.uniform(3, 9)
    curves = []
    for k in range(count):
        x = width * (k + 1) / (count + 1)
        curves.append(
            Curve(np.array([[(x, 0), (x + swing, height / 3), (x - swing, 2 * height / 3), (x, height)]]))
        )
    return Design("s-curve pleats", rectangle(width, height), _alternating(curves))


def arcs(rng: Rng) -> Design:
    width, height, sag = rng.uniform(90, 130), rng.uniform(80, 120), rng.uniform(6, 16)
    count = int(rng.integers(2, 5))
    levels = [height * (k + 0.6) / (count + 0.6) for k in range(count)]
    return Design(
        "arcs from border to border",
        rectangle(width, height),
        _alternating([bow((0, y), (width, y), sag) for y in levels], "V"),
    )


def circles(rng: Rng) -> Design:
    side = rng.uniform(90, 120)
    middle, hole = (side / 2, side / 2), side * rng.uniform(0.07, 0.1)
    rings = [circle(middle, side * part) for part in (0.18, 0.28, 0.38)]
    return Design("circles with a hole", rectangle(side, side), _alternating(rings), (circle(middle, hole),))


def lens(rng: Rng) -> Design:
    width, height, sag = rng.uniform(90, 110), rng.uniform(60, 75), rng.uniform(9, 14)
    a, b = (0.2 * width, height / 2), (0.8 * width, 0.53 * height)
    return Design(
        "a closed lens",
        rectangle(width, height),
        (
            (bow(a, b, sag), "M"),
            (bow(a, b, -sag), "M"),
            (lines((0, 0.5 * height), a), "V"),
            (lines(b, (width, 0.53 * height)), "V"),
        ),
    )


def waves(rng: Rng) -> Design:
    width, height = rng.uniform(130, 160), rng.uniform(90, 110)
    count, turns, swing = int(rng.integers(3, 6)), rng.uniform(1.2, 2.2), rng.uniform(2, 5)
    x = np.linspace(0, width, 13)
    curves = [
        smooth(np.column_stack([x, height * (k + 1) / (count + 1) + swing * np.sin(2 * np.pi * turns * x / width)]))
        for k in range(count)
    ]
    return Design("waves", rectangle(width, height), _alternating(curves))


def flaps(rng: Rng) -> Design:
    side, flap = rng.uniform(60, 80), rng.uniform(15, 25)
    a, b, c = 0.0, flap, flap + side
    d, slope = c + flap, 4.0
    outline = lines(
        (b, b), (b + slope, a), (c - slope, a), (c, b), (d, b + slope), (d, c - slope), (c, c), (c - slope, d),
        (b + slope, d), (b, c), (a, c - slope), (a, b + slope), closed=True,
    )  # fmt: skip
    sag = rng.uniform(3, 7)
    corners = [(b, b), (c, b), (c, c), (b, c)]
    folds = [(bow(corners[k], corners[(k + 1) % 4], sag), "V") for k in range(4)]
    return Design("flaps", outline, tuple(folds))


def box_blank(rng: Rng) -> Design:
    w, h, deep, tab = rng.uniform(35, 45), rng.uniform(55, 70), rng.uniform(18, 24), 9.0
    x = np.cumsum([tab, w, deep, w, deep])
    top = h + 0.6 * deep
    outline = lines(
        (0, 3), (tab, 0), (x[4], 0), (x[4], h), (x[3], h), (x[3] - 2, top), (x[2] + 2, top), (x[2], h),
        (tab, h), (0, h - 3), closed=True,
    )  # fmt: skip
    folds = [(lines((at, 0), (at, h)), "V") for at in x[:4]]
    folds.append((bow((x[2], h), (x[3], h), -rng.uniform(3, 5)), "M"))
    return Design("a box blank", outline, tuple(folds))


def spiral(rng: Rng) -> Design:
    side = rng.uniform(95, 115)
    angles = np.linspace(0, rng.uniform(1.4, 1.7) * 2 * np.pi, 19)
    radii = side * np.linspace(0.1, 0.42, len(angles))
    at = side / 2 + np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
    return Design("a spiral", rectangle(side, side), ((smooth(at), "M"), (_to_side(at[-1], at[-2], side), "M")))


def _to_side(end: FloatArray, before: FloatArray, side: float) -> Curve:
    """A straight line on from the end of a curve to the border of a square."""
    way = end - before
    far = [((side if d > 0 else 0.0) - p) / d for p, d in zip(end, way, strict=True) if abs(d) > 1e-9]
    return lines(end.tolist(), (end + min(far) * way).tolist())


def arc_tessellation(rng: Rng) -> Design:
    cell, across, up = rng.uniform(28, 36), int(rng.integers(2, 5)), int(rng.integers(2, 4))
    sag = cell * rng.uniform(0.1, 0.16)
    folds = []
    for row in range(1, up):
        for k in range(across):
            a, b = (k * cell, row * cell), ((k + 1) * cell, row * cell)
            folds.append((bow(a, b, sag if (k + row) % 2 else -sag), "M" if row % 2 else "V"))
    for column in range(1, across):
        for k in range(up):
            a, b = (column * cell, k * cell), (column * cell, (k + 1) * cell)
            folds.append((lines(a, b), "V" if (k + column) % 2 else "M"))
    return Design("a tessellation of arcs", rectangle(across * cell, up * cell), tuple(folds))


def twist(rng: Rng) -> Design:
    side, half = rng.uniform(95, 110), rng.uniform(11, 15)
    m = side / 2
    turn = np.radians(30)
    rotate = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    corners = m + np.array([(-half, -half), (half, -half), (half, half), (-half, half)]) @ rotate.T
    folds = [(lines(corners[k], corners[(k + 1) % 4]), "M") for k in range(4)]
    for k in range(4):
        out = np.array([(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])[k]
        for corner, letter in ((corners[k], "V"), (corners[(k + 1) % 4], "M")):
            reach = (m - float((corner - m) @ out)) * out
            folds.append((lines(corner, corner + reach), letter))
    return Design("a straight twist", rectangle(side, side), tuple(folds))


def ring(rng: Rng) -> Design:
    radius = rng.uniform(45, 60)
    middle = (radius, radius)
    rings = [circle(middle, radius * part) for part in (0.5, 0.75)]
    return Design("a round sheet", circle(middle, radius), _alternating(rings), (circle(middle, 0.25 * radius),))


def fan(rng: Rng) -> Design:
    width, height, count = rng.uniform(120, 150), rng.uniform(70, 85), int(rng.integers(3, 6))
    curves = []
    for k in range(count):
        part = (k + 1) / (count + 1)
        sag = rng.uniform(4, 8)
        curves.append(bow((width * (0.3 + 0.4 * part), 0), (width * part, height), sag if k % 2 else -sag))
    return Design("a fan", rectangle(width, height), _alternating(curves))


def hexagon(rng: Rng) -> Design:
    radius, sag = rng.uniform(50, 65), rng.uniform(4, 9)
    angles = np.radians(np.arange(6) * 60)
    corners = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    corners -= corners.min(axis=0)
    inner = corners.mean(axis=0)
    small = inner + 0.45 * (corners - inner)
    folds = [(bow(corners[k], small[k], sag), "M") for k in range(6)]
    folds += [(lines(small[k], small[(k + 1) % 6]), "V") for k in range(6)]
    return Design("hexagon", lines(*corners, closed=True), tuple(folds))


def window(rng: Rng) -> Design:
    width, height = rng.uniform(100, 130), rng.uniform(75, 95)
    folds = _alternating(
        [bow((0, 0.42 * height), (width, 0.42 * height), 8), bow((0, 0.7 * height), (width, 0.7 * height), 8)]
    )
    slot = rectangle(0.22 * width, 0.12 * height, (0.18 * width, 0.12 * height))
    slit = lines((0.6 * width, 0.2 * height), (0.85 * width, 0.2 * height))
    return Design("a window and a slit", rectangle(width, height), folds, (slot,), (slit,))


DESIGNS: tuple[Callable[[Rng], Design], ...] = (
    s_pleats, arcs, circles, lens, waves, flaps, box_blank, spiral, arc_tessellation, twist, ring, fan, hexagon,
    window,
)  # fmt: skip
