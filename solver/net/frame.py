"""The grid's own frame: the one place where lengths change between drawing units and net units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray

#: Border edges within this angle of each other count as one direction, radians.
_SAME_DIRECTION = np.radians(0.02)
#: A direction must hold this part of the border's length before the grid turns with it.
_DOMINANT_PART = 0.25


@dataclass(frozen=True)
class NetFrame:
    """A similarity: net = turn(-angle) (drawing - origin) / unit.

    origin  drawing coordinates of the net's (0, 0)
    angle   direction of the net's x axis in the drawing, radians
    unit    drawing units in one net unit
    """

    origin: tuple[float, float]
    angle: float
    unit: float

    def to_net(self, points: FloatArray) -> FloatArray:
        """(N,2) or (N,3) drawing coordinates to net units; z is only scaled."""
        result = np.array(points, dtype=np.float64)
        plane = (result[:, :2] - np.asarray(self.origin)) @ self._turn()
        result[:, :2] = plane
        result /= self.unit
        return result

    def to_drawing(self, points: FloatArray) -> FloatArray:
        """(N,2) or (N,3) net coordinates to drawing units; the inverse of ``to_net``."""
        result = np.array(points, dtype=np.float64) * self.unit
        result[:, :2] = result[:, :2] @ self._turn().T + np.asarray(self.origin)
        return result

    def axes(self) -> FloatArray:
        """(3,3) the drawing's x, y and z axes, one a row, in net coordinates."""
        result = np.eye(3)
        result[:2, :2] = self._turn()
        return result

    def scaled(self, factor: float) -> NetFrame:
        """The frame whose unit is ``factor`` times as long."""
        return NetFrame(self.origin, self.angle, self.unit * factor)

    def _turn(self) -> FloatArray:
        c, s = (1.0, 0.0) if self.angle == 0.0 else (np.cos(self.angle), np.sin(self.angle))
        return np.array([[c, -s], [s, c]])


def border_direction(boundary: FloatArray) -> float:
    """The direction, in (-45°, 45°] as radians, that most of a border's length follows modulo a right angle.

    boundary (B,2) ring. Zero when no direction stands out (a circle): then the drawing's own axes serve.
    A sheet drawn at a slant so gets a grid along its edges instead of a saw-toothed border.
    """
    steps = np.roll(boundary, -1, axis=0) - boundary
    lengths = np.hypot(*steps.T)
    directions = np.arctan2(steps[:, 1], steps[:, 0])
    quarter = np.pi / 2
    folded = (directions + quarter / 2) % quarter - quarter / 2
    total = lengths.sum()
    long_edges = np.flatnonzero(lengths > 0.02 * total)
    best, best_length = 0.0, 0.0
    for k in long_edges:
        gap = np.abs(folded - folded[k])
        near = np.minimum(gap, quarter - gap) < _SAME_DIRECTION
        length = float(lengths[near].sum())
        # Ties go to the direction nearest to the drawing's axes.
        if length > best_length * (1 + 1e-9) or (
            length > best_length * (1 - 1e-9) and abs(folded[k]) < abs(best) - 1e-12
        ):
            best, best_length = float(folded[k]), length
    if best_length < _DOMINANT_PART * total or abs(best) < 1e-9:
        return 0.0
    return best
