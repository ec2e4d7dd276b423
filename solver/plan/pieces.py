"""Pieces of plan lines: straight lines, circular arcs and cubics. Points are complex numbers, millimetres, y up."""

from __future__ import annotations

import cmath
import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

ComplexArray = NDArray[np.complex128]

#: Nodes and weights that integrate the speed of a part of a cubic.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)  # type: ignore[no-untyped-call]
#: A cubic's length is integrated in so many equal parts.
_PARTS = 16
#: Newton steps to a place at a given length, and the part of the length that is near enough.
_STEPS, _NEAR = 20, 1e-12
#: An arc is drawn as cubics of at most this angle, radians: their error is 3e-4 of the radius at 90 degrees, and it
#: falls with the sixth power of the angle.
_ARC_STEP = math.pi / 8


@dataclass(frozen=True)
class Motion:
    """A similarity of the plane: z goes to ``factor * z + shift``, or with ``mirrored`` to ``factor * conj(z) +
    shift``.
    """

    factor: complex = 1.0
    shift: complex = 0.0
    mirrored: bool = False

    def at(self, z: complex) -> complex:
        return self.factor * (z.conjugate() if self.mirrored else z) + self.shift


@dataclass(frozen=True)
class Line:
    """A straight line from start to end."""

    start: complex
    end: complex

    @property
    def length(self) -> float:
        return abs(self.end - self.start)

    def at(self, t: float) -> complex:
        """The point at a parameter from 0 to 1."""
        return self.start + t * (self.end - self.start)

    def way(self, t: float) -> complex:
        """The derivative by the parameter."""
        return self.end - self.start

    def place(self, length: float) -> float:
        """The parameter at a length from the start."""
        return length / self.length if self.length else 0.0

    def part(self, a: float, b: float) -> Line:
        """The piece between two parameters."""
        return Line(self.start if a == 0.0 else self.at(a), self.end if b == 1.0 else self.at(b))

    def reversed(self) -> Line:
        return Line(self.end, self.start)

    def moved(self, motion: Motion) -> Line:
        return Line(motion.at(self.start), motion.at(self.end))

    def samples(self, tolerance: float) -> list[float]:
        """Parameters whose chords are within a tolerance of the piece, both ends included."""
        return [0.0, 1.0]


@dataclass(frozen=True)
class Arc:
    """A part of a circle. begin: the angle of the start, radians; sweep: signed, counter-clockwise positive.

    The ends are kept as they are known, so that neighbours share them.
    """

    start: complex
    end: complex
    centre: complex
    radius: float
    begin: float
    sweep: float

    @staticmethod
    def through(start: complex, end: complex, centre: complex, sweep: float) -> Arc:
        """The arc about a centre; the radius is the mean of both ends'."""
        radius = 0.5 * (abs(start - centre) + abs(end - centre))
        return Arc(start, end, centre, radius, cmath.phase(start - centre), sweep)

    @property
    def length(self) -> float:
        return self.radius * abs(self.sweep)

    @property
    def is_circle(self) -> bool:
        return abs(abs(self.sweep) - 2 * math.pi) < 1e-9

    def at(self, t: float) -> complex:
        return self.centre + cmath.rect(self.radius, self.begin + t * self.sweep)

    def way(self, t: float) -> complex:
        return 1j * self.sweep * cmath.rect(self.radius, self.begin + t * self.sweep)

    def place(self, length: float) -> float:
        return length / self.length if self.length else 0.0

    def part(self, a: float, b: float) -> Arc:
        start = self.start if a == 0.0 else self.at(a)
        end = self.end if b == 1.0 else self.at(b)
        return Arc(start, end, self.centre, self.radius, self.begin + a * self.sweep, (b - a) * self.sweep)

    def reversed(self) -> Arc:
        return Arc(self.end, self.start, self.centre, self.radius, self.begin + self.sweep, -self.sweep)

    def moved(self, motion: Motion) -> Arc:
        turn = cmath.phase(motion.factor)
        begin, sweep = (-self.begin, -self.sweep) if motion.mirrored else (self.begin, self.sweep)
        return Arc(
            motion.at(self.start),
            motion.at(self.end),
            motion.at(self.centre),
            self.radius * abs(motion.factor),
            begin + turn,
            sweep,
        )

    def samples(self, tolerance: float) -> list[float]:
        step = 2.0 * math.acos(max(1.0 - tolerance / self.radius, 0.5)) if self.radius > 0 else math.pi
        count = max(math.ceil(abs(self.sweep) / step), 2)
        return [k / count for k in range(count + 1)]

    def cubics(self) -> list[Cubic]:
        """The same as cubics, for pens without arcs: within 2e-7 of the radius."""
        count = max(math.ceil(abs(self.sweep) / _ARC_STEP), 1)
        handle = 4.0 / 3.0 * math.tan(self.sweep / count / 4.0) * count / self.sweep if self.sweep else 0.0
        found = []
        for k in range(count):
            a, b = k / count, (k + 1) / count
            start = self.start if k == 0 else self.at(a)
            end = self.end if k == count - 1 else self.at(b)
            step = handle / count
            found.append(Cubic(start, start + step * self.way(a), end - step * self.way(b), end))
        return found


@dataclass(frozen=True)
class Cubic:
    """A cubic Bezier curve."""

    start: complex
    first: complex
    second: complex
    end: complex

    @property
    def points(self) -> tuple[complex, complex, complex, complex]:
        return self.start, self.first, self.second, self.end

    @cached_property
    def _lengths(self) -> NDArray[np.float64]:
        """The length from the start to each of the equal parts' ends, 0 first."""
        width = 1.0 / _PARTS
        t = (np.arange(_PARTS)[:, None] + 0.5 * (_NODES + 1.0)[None, :]) * width
        speed = np.abs(self._ways(t))
        return np.concatenate([[0.0], np.cumsum(speed @ _WEIGHTS * 0.5 * width)])

    @property
    def length(self) -> float:
        return float(self._lengths[-1])

    def at(self, t: float) -> complex:
        s = 1.0 - t
        return s**3 * self.start + 3 * s * s * t * self.first + 3 * s * t * t * self.second + t**3 * self.end

    def way(self, t: float) -> complex:
        return complex(self._ways(np.array([t]))[0])

    def _ways(self, t: NDArray[np.float64]) -> ComplexArray:
        s = 1.0 - t
        return np.asarray(
            3 * s * s * (self.first - self.start)
            + 6 * s * t * (self.second - self.first)
            + 3 * t * t * (self.end - self.second)
        )

    def place(self, length: float) -> float:
        lengths = self._lengths
        if length <= 0.0 or not lengths[-1]:
            return 0.0
        if length >= lengths[-1]:
            return 1.0
        part = int(np.searchsorted(lengths, length, side="right")) - 1
        low, high = part / _PARTS, (part + 1) / _PARTS
        wanted = length - float(lengths[part])
        t = low + (high - low) * wanted / float(lengths[part + 1] - lengths[part])
        begin = low
        for _ in range(_STEPS):
            nodes = begin + 0.5 * (t - begin) * (_NODES + 1.0)
            gone = float(np.abs(self._ways(nodes)) @ _WEIGHTS * 0.5 * (t - begin))
            if abs(gone - wanted) <= _NEAR * float(lengths[-1]):
                break
            low, high = (t, high) if gone < wanted else (low, t)
            speed = abs(self.way(t))
            step = t + (wanted - gone) / speed if speed else low
            t = step if low < step < high else 0.5 * (low + high)
        return t

    def part(self, a: float, b: float) -> Cubic:
        # The blossom: every control point of a part is linear in each of its three parameters.
        def blossom(u: float, v: float, w: float) -> complex:
            one = [p + u * (q - p) for p, q in itertools.pairwise(self.points)]
            two = [p + v * (q - p) for p, q in itertools.pairwise(one)]
            return two[0] + w * (two[1] - two[0])

        start = self.start if a == 0.0 else blossom(a, a, a)
        end = self.end if b == 1.0 else blossom(b, b, b)
        return Cubic(start, blossom(a, a, b), blossom(a, b, b), end)

    def reversed(self) -> Cubic:
        return Cubic(self.end, self.second, self.first, self.start)

    def moved(self, motion: Motion) -> Cubic:
        return Cubic(*(motion.at(point) for point in self.points))

    def samples(self, tolerance: float) -> list[float]:
        bend = max(abs(self.start - 2 * self.first + self.second), abs(self.first - 2 * self.second + self.end))
        # |B''| <= 6 bend, and a chord's sagitta is at most |B''| h^2 / 8.
        count = max(math.ceil(math.sqrt(6.0 * bend / (8.0 * tolerance))), 4)
        return [k / count for k in range(count + 1)]


Piece = Line | Arc | Cubic
