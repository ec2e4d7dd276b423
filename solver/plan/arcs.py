"""Circles through points: whether points lie on an arc, and which."""

from __future__ import annotations

import math

import numpy as np

from .pieces import Arc, ComplexArray

#: A circle this many times larger than what lies on it is a straight line.
_STRAIGHT = 1e5


def circle_through(a: complex, b: complex, c: complex) -> complex | None:
    """The centre of the circle through three points; None where they are as good as on a line."""
    p, q = b - a, c - a
    cross = (p.conjugate() * q).imag
    size = max(abs(p), abs(q), abs(q - p))
    if abs(cross) <= size * size / _STRAIGHT:
        return None
    return a + 1j * (abs(p) ** 2 * q - abs(q) ** 2 * p) / (-2.0 * cross)


def fitted_arc(z: ComplexArray, tolerance: float) -> Arc | None:
    """The arc from the first to the last of points in a row that all are within a tolerance of it."""
    if len(z) < 3:
        return None
    # The centre lies on the perpendicular bisector of the ends: one number is to be found.
    chord = z[-1] - z[0]
    if abs(chord) <= tolerance:
        return None
    middle, normal = 0.5 * (z[0] + z[-1]), 1j * chord / abs(chord)
    inner = z[1:-1] - middle
    x, y = (inner / (chord / abs(chord))).real, (inner * normal.conjugate()).real
    # (x, y) on the circle about (0, h) through (±c/2, 0): x² + y² - c²/4 = 2 h y.
    weight = float(y @ y)
    if weight <= 0.0:
        return None
    height = float(y @ (x * x + y * y - 0.25 * abs(chord) ** 2)) / (2.0 * weight)
    if abs(height) > _STRAIGHT * abs(chord):
        return None
    return _checked(z, middle + height * normal, tolerance)


def fitted_circle(z: ComplexArray, tolerance: float) -> Arc | None:
    """The circle on which all points of a ring are, in the ring's direction, from its first point."""
    mean = z.mean()
    w = z - mean
    matrix = np.column_stack([2 * w.real, 2 * w.imag, np.ones(len(w))])
    (x, y, _), _, rank, _ = np.linalg.lstsq(matrix, np.abs(w) ** 2, rcond=None)
    if rank < 3:
        return None
    centre = complex(mean + x + 1j * y)
    radii = np.abs(z - centre)
    radius = float(radii.mean())
    if np.abs(radii - radius).max() > tolerance:
        return None
    steps = np.angle((np.roll(z, -1) - centre) / (z - centre))
    turn = float(steps.sum())
    if abs(abs(turn) - 2 * math.pi) > 1e-6 or (np.sign(steps) != np.sign(turn)).any():
        return None
    begin = float(np.angle(z[0] - centre))
    start = complex(centre + radius * np.exp(1j * begin))
    return Arc(start, start, centre, radius, begin, math.copysign(2 * math.pi, turn))


def _checked(z: ComplexArray, centre: complex, tolerance: float) -> Arc | None:
    radius = 0.5 * (abs(z[0] - centre) + abs(z[-1] - centre))
    if np.abs(np.abs(z - centre) - radius).max() > tolerance:
        return None
    steps = np.angle((z[1:] - centre) / (z[:-1] - centre))
    sweep = float(steps.sum())
    if (np.sign(steps) != np.sign(sweep)).any() or abs(sweep) >= 2 * math.pi:
        return None
    return Arc.through(complex(z[0]), complex(z[-1]), complex(centre), sweep)
