"""Pairs of points: made to coincide, to share coordinates, or to be at a distance, with a growing pull."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ..arrays import BoolArray, FloatArray, IntArray
from ..drive import MEAN_BUDGET, mean_stretch
from ..errors import DescriptionError, HandleError
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.distance import Distance
from ..objectives.handles import AxisHandles
from .control import Control, ControlPull, number, positive, vector
from .firmness import Firmness
from .pull import Finding, Lack, Term

#: A pair's coordinates or distance change at most this much an iteration, net units; an annulus of 5,000 vertices
#: ends the same at 0.25, 0.5 and 1.0.
_PAIR_RATE = 1.0
#: Pairs that stay apart although the paper is far from stretched are pulled harder, at most so often.
_STIFFER, _STIFFENINGS = 4.0, 5
#: Gaps larger than this at rest are pulled harder, and larger than that are out of reach, net units.
_CLOSE, _REACHED = 0.05, 0.3
#: No fold takes two points farther apart than the sheet between them is long, but for rounding.
_LONGER = 1.0 + 1e-6


@dataclass(frozen=True)
class Pair(Control):
    """Two points of the sheet that are drawn to each other.

    first, second: (x, y) on the flat sheet, drawing units
    axes: the coordinates (of the drawing) that they are to share; all three: they coincide
    distance: None, or how far apart they are to be instead, drawing units
    strength: how hard they are drawn, in parts of the usual weight
    """

    first: tuple[float, float]
    second: tuple[float, float]
    axes: tuple[bool, bool, bool] = (True, True, True)
    distance: float | None = None
    strength: float = 1.0

    kind = "pair"

    def __post_init__(self) -> None:
        for name in ("first", "second"):
            object.__setattr__(self, name, vector(name, getattr(self, name), 2))
        axes = tuple(self.axes) if isinstance(self.axes, Sequence) else ()
        if len(axes) != 3 or not all(isinstance(axis, bool) for axis in axes) or not any(axes):
            raise DescriptionError("'axes' must be three of true and false, not all false")
        object.__setattr__(self, "axes", axes)
        positive("strength", self.strength)
        if self.distance is not None:
            number("distance", self.distance, 0.0)
            if not all(axes):
                raise DescriptionError("a pair has a 'distance' or some 'axes', not both")


class PairPull(ControlPull):
    """All pairs of a paper; how far apart each is to be now comes down step by step."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight
        self._pairs: tuple[Pair, ...] = ()
        self._vertices = np.zeros((0, 8), dtype=np.int64)
        self._coefficients = np.zeros((0, 8))
        self._axes = np.ones((0, 3), dtype=bool)
        self._apart: BoolArray = np.zeros(0, dtype=bool)  # those with a distance
        self._end, self._now = np.zeros(0), np.zeros(0)  # lengths of the gaps in the end and now, net units
        self._direction = np.zeros((0, 3))  # of the gaps that are to close, in the drawing's axes
        self._firmness = Firmness(_STIFFENINGS)

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        pairs = tuple(control for _, control in controls)
        vertices, coefficients = np.zeros((len(pairs), 8), dtype=np.int64), np.zeros((len(pairs), 8))
        for k, (label, pair) in enumerate(controls):
            vertices[k], coefficients[k] = located_pair(self._net, pair.first, pair.second, label)
            self._check_distance(pair, label)
        before = {pair: self._now[k] for k, pair in enumerate(self._pairs)}
        self._pairs, self._vertices, self._coefficients = pairs, vertices, coefficients
        self._axes = np.array([pair.axes for pair in pairs], dtype=bool).reshape(-1, 3)
        self._apart = np.array([bool(pair.distance) for pair in pairs], dtype=bool)
        self._end = np.array([pair.distance or 0.0 for pair in pairs]) / self._net.frame.unit
        gap = self._gap(x)
        present = np.linalg.norm(gap, axis=1)
        self._now = np.array([before.get(pair, present[k]) for k, pair in enumerate(pairs)])
        self._direction = _unit(gap)

    def terms(self) -> list[Term]:
        strength = np.array([pair.strength for pair in self._pairs])
        weight = self._weight * self._firmness.factor * strength
        terms: list[Term] = []
        touch, apart = np.flatnonzero(~self._apart), np.flatnonzero(self._apart)
        if len(touch):
            frame = self._net.frame.axes()
            axes = frame[:, None, :] * self._axes[touch].T[:, :, None]
            target = (self._now[touch, None] * self._direction[touch]) @ frame
            terms.append(
                AxisHandles(self._vertices[touch], self._coefficients[touch], target, axes, weight[touch], "pairs")
            )
        if len(apart):
            terms.append(
                Distance(self._vertices[apart], self._coefficients[apart], self._now[apart], weight[apart])
            )
        return terms

    def asks(self, x: FloatArray) -> bool:
        return self._weight > 0 and bool((np.abs(self._lengths(x) - self._end) > 1e-9).any())

    def on_way(self) -> bool:
        return not np.array_equal(self._end, self._now)

    def move(self, x: FloatArray, pace: float) -> bool:
        away = self._end - self._now
        if not away.any():
            return False
        rate = _PAIR_RATE * pace
        self._now = np.where(np.abs(away) <= rate, self._end, self._now + np.clip(away, -rate, rate))
        # The pair may turn on its way: what is left of its gap keeps the direction that it has.
        gap = self._gap(x)
        clear = np.linalg.norm(gap, axis=1) > 1e-9
        self._direction = np.where(clear[:, None], _unit(gap), self._direction)
        return True

    def settle(self, x: FloatArray) -> bool:
        if not len(self._pairs) or self._firmness.spent:
            return False
        if self._misses(x).max() <= _CLOSE or mean_stretch(self._net, x) > 0.5 * MEAN_BUDGET:
            return False
        self._firmness.change(_STIFFER)
        return True

    def let_go(self, part: float) -> bool:
        self._firmness.let_go(part)
        return bool(self._pairs)

    def wake(self) -> None:
        self._firmness.wake()

    def shortfall(self, x: FloatArray) -> float:
        return float(np.maximum(self._misses(x) - _REACHED, 0.0).sum()) if self._pairs else 0.0

    def mark(self) -> object:
        return self._now

    def go_back(self, mark: object) -> None:
        if isinstance(mark, np.ndarray) and mark.shape == self._now.shape:
            self._now = mark

    def findings(self, x: FloatArray) -> list[Finding]:
        unit = self._net.frame.unit
        lengths, misses = self._lengths(x), self._misses(x)
        result = []
        for k in np.flatnonzero(misses > _REACHED):
            pair = self._pairs[k]
            places = " and ".join(f"({p[0]:.4g}, {p[1]:.4g})" for p in (pair.first, pair.second))
            asked = f"{pair.distance:.4g} were asked" if self._apart[k] else "they were to meet"
            along = "" if all(pair.axes) else f" along {_listed(pair.axes)}"
            if along:
                asked = "they were to be level"
            sentence = f"the points {places} stay {lengths[k] * unit:.3g} apart{along} where {asked}"
            result.append(Finding(Lack.REACH, sentence))
        return result

    def _gap(self, x: FloatArray) -> FloatArray:
        """(n,3) gaps along the drawing's axes, zero along those that do not count, net units."""
        gap = np.einsum("nk,nkc->nc", self._coefficients, x[self._vertices])
        return np.asarray((gap @ self._net.frame.axes().T) * self._axes)

    def _lengths(self, x: FloatArray) -> FloatArray:
        return np.linalg.norm(self._gap(x), axis=1)

    def _misses(self, x: FloatArray) -> FloatArray:
        return np.abs(self._lengths(x) - self._end)

    def _check_distance(self, pair: Pair, label: str) -> None:
        if pair.distance is None:
            return
        outline = shapely.transform(self._net.sheet, self._net.frame.to_drawing)
        line = shapely.LineString([pair.first, pair.second])
        covered = outline.buffer(1e-6 * self._net.frame.unit).covers(line)
        if covered and pair.distance > line.length * _LONGER:
            raise DescriptionError(
                f"asks for a distance of {pair.distance:.4g}, but the sheet between the points is only "
                f"{line.length:.4g} long",
                element=label,
                place=pair.first,
            )


def located_pair(
    net: PiecewiseDog, first: tuple[float, float], second: tuple[float, float], label: str
) -> tuple[IntArray, FloatArray]:
    """Vertices (8,) and coefficients (8,) whose sum of products is first - second.

    Raises DescriptionError, naming ``label``, when a point is off the sheet.
    """
    try:
        (va, wa), (vb, wb) = net.locate(first), net.locate(second)
    except HandleError as error:
        raise DescriptionError(error.message, element=label, place=error.where.place) from None
    return np.concatenate([va, vb]), np.concatenate([wa, -wb])


def _listed(axes: Sequence[bool]) -> str:
    return " and ".join(letter for letter, on in zip("XYZ", axes, strict=True) if on)


def _unit(gap: FloatArray) -> FloatArray:
    return np.asarray(gap / np.maximum(np.linalg.norm(gap, axis=1), 1e-300)[:, None])
