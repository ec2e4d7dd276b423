"""Two stretches of the border glued together, with bending across the seam (paper, Fig. 15)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely import LineString
from shapely.ops import substring

from ..arrays import FloatArray
from ..drive import MEAN_BUDGET, mean_stretch
from ..errors import DescriptionError
from ..net.piecewise_dog import PiecewiseDog
from ..optimize.term import LinearTerm
from .control import Control, ControlPull, flag, positive
from .control import vector as numbers
from .firmness import Firmness
from .pair import located_pair
from .pull import Finding, Lack, Term

#: Borders whose lengths differ by more than this part cannot be glued.
_EQUAL = 0.01
#: The ends of a seam may lie this far off the border, net units.
_ON_BORDER = 0.5
#: Borders come nearer at most this far an iteration, net units: four times as fast, a strip of twenty creases
#: closes to a ring with a third more stretch.
_SEAM_RATE = 0.25
#: Bending across the seam grows to its weight in so many iterations after the borders have met.
_BENDING_STEPS = 30
#: A seam that stays open although the paper is far from stretched is pulled harder, at most so often.
_STIFFER, _STIFFENINGS = 4.0, 5
#: Gaps larger than this at rest are pulled harder, and larger than that are an open seam, net units.
_CLOSE, _REACHED = 0.02, 0.2

Ends = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Glue(Control):
    """first, second: each the two ends of a stretch of the border, (x, y), drawing units; the first end of one
    meets the first end of the other. A stretch is the shorter way along the border.

    bending: whether the paper bends across the seam like anywhere else; else it may have a kink there
    strength: how hard the borders are drawn together, in parts of the usual weight
    """

    first: Ends
    second: Ends
    bending: bool = True
    strength: float = 1.0

    kind = "glue"

    def __post_init__(self) -> None:
        for name in ("first", "second"):
            value = getattr(self, name)
            if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 2:
                raise DescriptionError(f"{name!r} must be two points")
            object.__setattr__(self, name, tuple(numbers(name, point, 2) for point in value))
        flag("bending", self.bending)
        positive("strength", self.strength)


class GluePull(ControlPull):
    """All seams: pairs of border points a net unit apart whose gaps close together."""

    def __init__(self, net: PiecewiseDog, weight: float, bending: float) -> None:
        self._net, self._weight, self._bending_weight = net, weight, bending
        self._controls: tuple[Glue, ...] = ()
        self._clear()

    def _clear(self) -> None:
        self._vertices, self._coefficients = np.zeros((0, 8), dtype=np.int64), np.zeros((0, 8))
        self._across, self._across_coefficients = np.zeros((0, 16), dtype=np.int64), np.zeros((0, 16))
        self._across_weight = np.zeros(0)
        self._strength = np.zeros(0)
        self._seam = np.zeros(0, dtype=np.int64)
        self._gap = np.zeros((0, 3))  # what the pairs' gaps are asked to be now, net units
        self._open, self._bent = 0.0, 0.0  # parts of the gaps that are left, and of the bending that is there
        self._firmness = Firmness(_STIFFENINGS)

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        self._clear()
        self._controls = tuple(control for _, control in controls)
        pairs, across, weights, strength, seam = [], [], [], [], []
        for k, (label, control) in enumerate(controls):
            first, second = (_stretch(self._net, ends, label) for ends in (control.first, control.second))
            if abs(first.length - second.length) > _EQUAL * max(first.length, second.length):
                unit = self._net.frame.unit
                raise DescriptionError(
                    f"the borders to be glued are {first.length * unit:.4g} and {second.length * unit:.4g} long",
                    element=label,
                )
            if first.intersection(second).length > _ON_BORDER:
                raise DescriptionError("the borders to be glued overlap", element=label)
            count = max(2, round(first.length) + 1)
            spacing = first.length / (count - 1)
            places = [_spread(line, count) for line in (first, second)]
            inner = [_inward(self._net, line, count) for line in (first, second)]
            to_drawing = self._net.frame.to_drawing
            for n in range(count):
                a, b = (tuple(to_drawing(p[n : n + 1])[0].tolist()) for p in places)
                pairs.append(located_pair(self._net, a, b, label))
                strength.append(control.strength * (0.5 if n in (0, count - 1) else 1.0))
                seam.append(k)
                if control.bending and all(np.isfinite(p[n]).all() for p in inner):
                    c, d = (tuple(to_drawing(p[n : n + 1])[0].tolist()) for p in inner)
                    (va, wa), (vb, wb) = located_pair(self._net, c, a, label), located_pair(self._net, d, b, label)
                    across.append((np.concatenate([va, vb]), np.concatenate([wa, wb])))
                    weights.append(0.5 * spacing * self._bending_weight)
        if not pairs:
            return
        self._vertices, self._coefficients = (np.array(part) for part in zip(*pairs, strict=True))
        if across:
            self._across, self._across_coefficients = (np.array(part) for part in zip(*across, strict=True))
        self._across_weight, self._strength = np.array(weights), np.array(strength)
        self._seam = np.array(seam, dtype=np.int64)
        self._gap = self._gaps(x)
        self._open = float(np.linalg.norm(self._gap, axis=1).max())

    def terms(self) -> list[Term]:
        if not len(self._vertices):
            return []
        weight = self._weight * self._firmness.factor * self._strength
        terms: list[Term] = [LinearTerm("seams", self._vertices, self._coefficients, self._gap, weight)]
        if len(self._across):
            terms.append(
                LinearTerm(
                    "seam bending", self._across, self._across_coefficients, np.zeros((len(self._across), 3)),
                    self._bent * self._across_weight,
                )
            )  # fmt: skip
        return terms

    def asks(self, x: FloatArray) -> bool:
        return self._weight > 0 and bool(np.abs(self._gaps(x)).max(initial=0.0) > 1e-9)

    def on_way(self) -> bool:
        return self._open > 0.0 or (self._bent < 1.0 and len(self._across) > 0)

    def move(self, x: FloatArray, pace: float) -> bool:
        if self._open > 0.0:
            left = max(0.0, self._open - _SEAM_RATE * pace)
            present = self._gaps(x)
            largest = max(float(np.linalg.norm(present, axis=1).max()), 1e-300)
            # The gaps turn and even out on their way: what is left of them keeps the shape that they have.
            self._gap = present * (left / max(largest, left))
            self._open = left
            return True
        if self._bent < 1.0 and len(self._across):
            self._bent = min(1.0, self._bent + pace / _BENDING_STEPS)
            return True
        return False

    def settle(self, x: FloatArray) -> bool:
        if not len(self._vertices) or self._firmness.spent:
            return False
        widest = float(np.linalg.norm(self._gaps(x), axis=1).max())
        if widest <= _CLOSE or mean_stretch(self._net, x) > 0.5 * MEAN_BUDGET:
            return False
        self._firmness.change(_STIFFER)
        return True

    def let_go(self, part: float) -> bool:
        self._firmness.let_go(part)
        return len(self._vertices) > 0

    def wake(self) -> None:
        """A seam that was let go is held again, as hard as before: with the usual strength it would gape."""
        self._firmness.take_hold()

    def shortfall(self, x: FloatArray) -> float:
        return float(np.maximum(np.linalg.norm(self._gaps(x), axis=1) - _REACHED, 0.0).sum())

    def mark(self) -> object:
        return self._gap, self._open, self._bent

    def go_back(self, mark: object) -> None:
        if isinstance(mark, tuple) and len(mark[0]) == len(self._gap):
            self._gap, self._open, self._bent = mark

    def findings(self, x: FloatArray) -> list[Finding]:
        gaps = np.linalg.norm(self._gaps(x), axis=1)
        result = []
        for k, control in enumerate(self._controls):
            widest = float(gaps[self._seam == k].max(initial=0.0))
            if widest > _REACHED:
                (ax, ay), (bx, by) = control.first[0], control.second[0]
                result.append(
                    Finding(
                        Lack.REACH,
                        f"the seam from ({ax:.4g}, {ay:.4g}) and ({bx:.4g}, {by:.4g}) on stays open by "
                        f"{widest * self._net.frame.unit:.3g}",
                    )
                )
        return result

    def _gaps(self, x: FloatArray) -> FloatArray:
        """(n,3) present gaps, net units."""
        return np.asarray(np.einsum("nk,nkc->nc", self._coefficients, x[self._vertices]))


def _stretch(net: PiecewiseDog, ends: Ends, label: str) -> LineString:
    """The shorter way along the border (or a hole's) from one end to the other, net units."""
    places = net.frame.to_net(np.array(ends))
    rings = [net.sheet.exterior, *net.sheet.interiors]
    ring = min(rings, key=lambda r: max(r.distance(shapely.Point(p)) for p in places))
    for place, end in zip(places, ends, strict=True):
        if ring.distance(shapely.Point(place)) > _ON_BORDER:
            raise DescriptionError("the point is not on the border", element=label, place=end)
    a, b = (float(ring.project(shapely.Point(place))) for place in places)
    if abs(a - b) < 1e-6:
        raise DescriptionError("both ends of a border are the same point", element=label, place=ends[0])
    low, high = min(a, b), max(a, b)
    inside, outside = high - low, ring.length - (high - low)
    if inside <= outside:
        return substring(ring, a, b)
    around = np.vstack(
        [
            shapely.get_coordinates(substring(ring, high, ring.length)),
            shapely.get_coordinates(substring(ring, 0.0, low))[1:],
        ]
    )
    return LineString(around if a == high else around[::-1])


def _spread(line: LineString, count: int) -> FloatArray:
    """So many points (count,2) at equal distances along a line."""
    at = np.linspace(0.0, line.length, count)
    return np.asarray(shapely.get_coordinates(shapely.line_interpolate_point(line, at)))


def _inward(net: PiecewiseDog, line: LineString, count: int) -> FloatArray:
    """The points a net unit inside the sheet from ``_spread``; NaN where there is no sheet."""
    at = np.linspace(0.0, line.length, count)
    step = 0.25
    near = [
        shapely.get_coordinates(shapely.line_interpolate_point(line, np.clip(at + s, 0.0, line.length)))
        for s in (-step, step)
    ]
    along = near[1] - near[0]
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
    points = _spread(line, count)
    for side in (1.0, -1.0):
        inner = points + side * normal
        inside = shapely.covers(net.sheet.buffer(1e-6), shapely.points(inner))
        if inside.mean() > 0.5:
            return np.asarray(np.where(inside[:, None], inner, np.nan))
    return np.full_like(points, np.nan)
