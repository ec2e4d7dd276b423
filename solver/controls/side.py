"""Mountain or valley: a crease held to a side, flipped to it when it is folded to the other (paper, 5.2)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..drive import HALF_ANGLE
from ..errors import DescriptionError
from ..measurement import measure
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.signed_fold import signed_fold, signed_points
from ..optimize.term import gather
from .control import Control, ControlPull, CreaseName, crease_index, crease_name
from .pull import Finding, Lack, Term

#: A bound crease is folded to its side by at least this much, degrees: clear of flat, and less than most folds.
LEAST_ANGLE = 8.0
#: A crease on its way from the other side turns this much an iteration, degrees.
_FLIP_RATE = 1.0
#: A crease that rests on the wrong side is pulled harder, at most so often; then it is left to the paper.
_STIFFER, _STIFFENINGS = 4.0, 2
#: A crease comes from its other side when it is folded there by more than this, degrees.
_CLEAR = 1.0

WORDS = {"V": "valley", "M": "mountain"}
SIGNS = {"V": 1, "M": -1}


@dataclass(frozen=True)
class Side(Control):
    """crease: number from 1, or name. side: "M" mountain or "V" valley."""

    crease: CreaseName
    side: str

    kind = "side"

    def __post_init__(self) -> None:
        crease_name(self.crease)
        if not isinstance(self.side, str) or self.side not in SIGNS:
            raise DescriptionError("'side' must be 'M' or 'V'")


class SidePull(ControlPull):
    """Holds creases to their sides; where the paper cannot have them it gives way and says which."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight * HALF_ANGLE
        self._points = signed_points(net)
        self._point_crease = net.crease_points.crease[self._points]
        self._free = signed_fold(
            net, self._points, np.zeros(len(self._points)), 0, 0.0, "mountains and valleys"
        )  # all points, asking for nothing
        count = len(net.crease_labels)
        self._side = np.zeros(count, dtype=np.int64)  # +1 valley, -1 mountain, 0 free
        self._now = np.zeros(count)  # signed angle asked for now in the side's own direction, degrees
        self._harder, self._times = np.ones(count), np.zeros(count, dtype=np.int64)
        self._flipping = np.zeros(count, dtype=bool)  # on the way from the other side

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        side = np.zeros_like(self._side)
        for label, control in controls:
            try:
                k = crease_index(self._net.crease_labels, control.crease)
            except DescriptionError as error:
                raise DescriptionError(error.message, element=label) from None
            if side[k] == -SIGNS[control.side]:
                raise DescriptionError(f"asks {self._net.crease_labels[k]} for both sides", element=label)
            side[k] = SIGNS[control.side]
        new = side != self._side
        self._side = side
        self._harder[new], self._times[new] = 1.0, 0
        present = self._present(x)
        self._now[new] = np.minimum(LEAST_ANGLE, side * present)[new]
        self._flipping = np.where(new, self._now < -_CLEAR, self._flipping) & (side != 0)

    def turning(self, x: FloatArray) -> frozenset[int]:
        """Creases that come from the other side, until they are folded to theirs or are left to the paper."""
        if self._flipping.any():
            there = (self._now >= LEAST_ANGLE) & ~self._wrong(x)
            self._flipping = self._flipping & ~there & (self._times <= _STIFFENINGS)
        return frozenset(np.flatnonzero(self._flipping).tolist())

    def released(self) -> BoolArray:
        """Driven points (n,) of creases that are still on the way to their side: no drive should hold them."""
        return np.asarray(self._turning()[self._point_crease])

    def terms(self) -> list[Term]:
        mine = np.flatnonzero(self._side[self._point_crease] != 0)
        if len(mine) == 0:
            return []
        crease, free = self._point_crease[mine], self._free
        side = self._side[crease]
        given_up = self._times[crease] > _STIFFENINGS
        return [
            replace(
                free,
                stencil=free.stencil[mine],
                places=np.ascontiguousarray(free.places[:, mine]),
                sine=free.sine[mine],
                flat=free.flat[mine],
                half=side * np.sin(np.radians(self._now[crease]) / 2),
                side=side,
                weight=np.where(given_up, 0.0, self._weight * self._harder[crease]),
            )
        ]

    def asks(self, x: FloatArray) -> bool:
        return self._weight > 0 and bool((self._side != 0).any())

    def sides(self) -> Mapping[int, int]:
        return {int(k): int(self._side[k]) for k in np.flatnonzero(self._side)}

    def begin(self, x: FloatArray) -> None:
        self._now = np.minimum(LEAST_ANGLE, self._side * self._present(x))
        self._flipping[:] = False

    def on_way(self) -> bool:
        return bool(self._turning().any())

    def _turning(self) -> BoolArray:
        """(creases,) those still on the way to their side."""
        return np.asarray((self._side != 0) & (self._now < LEAST_ANGLE) & (self._times <= _STIFFENINGS))

    def move(self, x: FloatArray, pace: float) -> bool:
        turning = self._turning()
        if not turning.any():
            return False
        self._now = np.where(turning, np.minimum(LEAST_ANGLE, self._now + _FLIP_RATE * pace), self._now)
        return True

    def settle(self, x: FloatArray) -> bool:
        """Pull creases harder that rest on the wrong side, and in the end leave them to the paper."""
        wrong = self._wrong(x) & (self._times <= _STIFFENINGS)
        if not wrong.any():
            return False
        self._times[wrong] += 1
        self._harder[wrong] *= _STIFFER
        return True

    def wake(self) -> None:
        self._harder[:], self._times[:] = 1.0, 0

    def mark(self) -> object:
        return self._now

    def go_back(self, mark: object) -> None:
        if isinstance(mark, np.ndarray):
            self._now = mark

    def findings(self, x: FloatArray) -> list[Finding]:
        labels = self._net.crease_labels
        wrong = self._wrong(x)
        result = []
        for k in np.flatnonzero(wrong):
            asked = "V" if self._side[k] > 0 else "M"
            became = found_letters(self._net, x)[int(k)]
            does = f"is a {WORDS[became]}" if became in WORDS else "is flat or changes sides along its length"
            others = [labels[n] for n in _around_one_patch(self._net, int(k)) if self._side[n] and not wrong[n]]
            why = f"; {_listed(others)} around the same patch held" if others else ""
            result.append(Finding(Lack.SIDE, f"{labels[k]} was to be a {WORDS[asked]} but {does}{why}"))
        return result

    def _wrong(self, x: FloatArray) -> BoolArray:
        """(creases,) bound creases that are measured on the other side, on both, or flat."""
        letters = found_letters(self._net, x)
        asked = {1: "V", -1: "M"}
        held = np.isin(np.arange(len(letters)), self._point_crease)
        return np.array(
            [bool(side) and bool(held[k]) and letters[k] != asked[int(side)] for k, side in enumerate(self._side)]
        )

    def _present(self, x: FloatArray) -> FloatArray:
        """(creases,) median signed angle, degrees."""
        result = np.zeros(len(self._side))
        angle = np.degrees(2 * np.arcsin(np.clip(self._half_angles(x), -1, 1)))
        for k in np.unique(self._point_crease):
            result[k] = np.median(angle[self._point_crease == k])
        return result

    def _half_angles(self, x: FloatArray) -> FloatArray:
        return self._free.half_angles(gather(np.ascontiguousarray(x.T), self._free.stencil))


def found_letters(net: PiecewiseDog, x: FloatArray) -> tuple[str, ...]:
    """FOLD letter of what each crease is at x (V,3), net units: V, M, or U where it is flat or changes sides."""
    m = measure(net, net.frame.to_drawing(x))
    return tuple(m.side(k) for k in range(len(net.crease_labels)))


def _around_one_patch(net: PiecewiseDog, crease: int) -> IntArray:
    """Other creases on the border of a patch that the crease borders."""
    points = net.crease_points
    patches = [
        np.where(v[:, 0] >= 0, net.vertex_patch[v[:, 0]], -1) for v in (points.left_vertices, points.right_vertices)
    ]
    mine = np.concatenate([p[points.crease == crease] for p in patches])
    near = np.zeros(len(points.crease), dtype=bool)
    for p in patches:
        near |= np.isin(p, mine[mine >= 0])
    return np.asarray(np.setdiff1d(np.unique(points.crease[near]), [crease]))


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
