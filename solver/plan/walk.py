"""Going along joined pieces by length: where a length lies, and the part between two lengths."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from .pieces import Motion, Piece

#: Parts shorter than this are nothing, mm.
NOTHING = 1e-9


@dataclass(frozen=True)
class Walk:
    """Joined pieces; a closed walk ends where it starts, and parts of it may pass its start."""

    pieces: tuple[Piece, ...]
    closed: bool = False

    @cached_property
    def starts(self) -> FloatArray:
        """The length at which each piece starts, and that of the whole last."""
        return np.concatenate([[0.0], np.cumsum([piece.length for piece in self.pieces])])

    @property
    def length(self) -> float:
        return float(self.starts[-1])

    def at(self, length: float) -> complex:
        index, t = self.place(length)
        return self.pieces[index].at(t)

    def way(self, length: float) -> complex:
        """The unit direction at a length."""
        index, t = self.place(length)
        way = self.pieces[index].way(t)
        if not way:  # at an end of a cubic whose control point lies on it
            way = self.at(length + 1e-6 * self.length) - self.at(length - 1e-6 * self.length)
        return way / abs(way) if way else 1.0

    def place(self, length: float) -> tuple[int, float]:
        """Which piece a length is on, and the piece's parameter there."""
        if self.closed:
            length %= self.length
        index = int(np.clip(np.searchsorted(self.starts, length, side="right") - 1, 0, len(self.pieces) - 1))
        piece = self.pieces[index]
        inside = min(max(length - float(self.starts[index]), 0.0), piece.length)
        return index, min(max(piece.place(inside), 0.0), 1.0)

    def part(self, a: float, b: float) -> tuple[Piece, ...]:
        """The pieces between two lengths, a < b; of a closed walk b may lie beyond its end."""
        if self.closed and a >= self.length - NOTHING:
            a, b = a - self.length, b - self.length
        if self.closed and b > self.length + NOTHING:
            return self.part(a, self.length) + self.part(0.0, b - self.length)
        found = []
        for index, piece in enumerate(self.pieces):
            low, high = float(self.starts[index]), float(self.starts[index + 1])
            if high - a <= NOTHING or b - low <= NOTHING:
                continue
            first = 0.0 if a - low <= NOTHING else piece.place(a - low)
            last = 1.0 if high - b <= NOTHING else piece.place(b - low)
            if last > first:
                found.append(piece if (first, last) == (0.0, 1.0) else piece.part(first, last))
        return tuple(found)

    def samples(self, tolerance: float) -> tuple[FloatArray, FloatArray]:
        """Points (P,2) whose chords are within a tolerance, and the length (P,) at each."""
        points: list[complex] = [self.pieces[0].start]
        lengths = [0.0]
        for index, piece in enumerate(self.pieces):
            places = np.array(piece.samples(tolerance)[1:])
            points += [piece.at(t) for t in places.tolist()]
            # Equal steps of a cubic's parameter are not equal lengths: chords say where each lies.
            steps = np.abs(np.diff(np.array(points[-len(places) - 1 :])))
            along = np.cumsum(steps)
            whole = float(along[-1]) or 1.0
            lengths += (float(self.starts[index]) + along * (piece.length / whole)).tolist()
        z = np.array(points)
        return np.column_stack([z.real, z.imag]), np.array(lengths)

    def moved(self, motion: Motion) -> Walk:
        return Walk(tuple(piece.moved(motion) for piece in self.pieces), self.closed)

    def reversed(self) -> Walk:
        return Walk(tuple(piece.reversed() for piece in reversed(self.pieces)), self.closed)
