"""A patch kept flat, or rigid in the shape that it has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import DescriptionError, HandleError
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.volume import Volume, patch_fours
from ..optimize.term import gather
from .control import Control, ControlPull, positive, vector
from .firmness import Firmness
from .pull import Finding, Lack, Term

#: A bent patch becomes flat in so many iterations.
_STEPS = 60
#: A patch is kept when no four of its vertices miss by more than this, net units³ (six times a volume).
_REACHED = 0.02
#: A patch that misses its shape is kept harder, at most so often.
_STIFFER, _STIFFENINGS = 4.0, 5


@dataclass(frozen=True)
class Keep(Control):
    """at: (x, y) on the flat sheet, drawing units: the patch (the piece between creases) that holds it.

    shape: "flat", or "rigid": the shape that it has when the control is set
    strength: how hard it is kept, in parts of the usual weight
    """

    at: tuple[float, float]
    shape: str = "flat"
    strength: float = 1.0

    kind = "keep"

    def __post_init__(self) -> None:
        object.__setattr__(self, "at", vector("at", self.at, 2))
        if self.shape not in ("flat", "rigid"):
            raise DescriptionError("'shape' must be 'flat' or 'rigid'")
        positive("strength", self.strength)


class KeepPull(ControlPull):
    """All patches that are kept."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight
        self._controls: tuple[Keep, ...] = ()
        self._control = np.zeros(0, dtype=np.int64)  # of each four vertices
        self._fours = np.zeros((0, 4), dtype=np.int64)
        self._start, self._end = np.zeros(0), np.zeros(0)
        self._part = 1.0  # of the way from start to end
        self._firmness = Firmness(_STIFFENINGS)

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        patches: dict[int, str] = {}
        fours, owner = [np.zeros((0, 4), dtype=np.int64)], []
        for k, (label, control) in enumerate(controls):
            try:
                vertices, _ = self._net.locate(control.at)
            except HandleError as error:
                raise DescriptionError(error.message, element=label, place=error.where.place) from None
            patch = int(self._net.vertex_patch[vertices[0]])
            if patch in patches:
                raise DescriptionError(f"is about the same patch as {patches[patch]}", element=label)
            patches[patch] = label
            fours.append(patch_fours(self._net, patch))
            owner += [k] * len(fours[-1])
        self._controls = tuple(control for _, control in controls)
        self._fours, self._control = np.vstack(fours), np.array(owner, dtype=np.int64)
        self._start = self._volumes(x)
        rigid = np.array([control.shape == "rigid" for control in self._controls], dtype=bool)
        self._end = np.where(rigid[self._control], self._start, 0.0) if len(rigid) else self._start
        self._part = 0.0 if (self._start != self._end).any() else 1.0

    def terms(self) -> list[Term]:
        if not len(self._fours):
            return []
        strength = np.array([control.strength for control in self._controls])[self._control]
        target = (1 - self._part) * self._start + self._part * self._end
        return [Volume(self._fours, target, self._weight * self._firmness.factor * strength)]

    def on_way(self) -> bool:
        return self._part < 1.0

    def move(self, x: FloatArray, pace: float) -> bool:
        if self._part >= 1.0:
            return False
        self._part = min(1.0, self._part + pace / _STEPS)
        return True

    def settle(self, x: FloatArray) -> bool:
        miss = float(np.abs(self._volumes(x) - self._end).max(initial=0.0))
        if miss <= 0.25 * _REACHED or self._firmness.spent:
            return False
        self._firmness.change(_STIFFER)
        return True

    def wake(self) -> None:
        self._firmness.wake()

    def mark(self) -> object:
        return self._part

    def go_back(self, mark: object) -> None:
        if isinstance(mark, float):
            self._part = mark

    def findings(self, x: FloatArray) -> list[Finding]:
        miss = np.abs(self._volumes(x) - self._end)
        result = []
        for k, control in enumerate(self._controls):
            if miss[self._control == k].max(initial=0.0) > _REACHED:
                place = f"({control.at[0]:.4g}, {control.at[1]:.4g})"
                result.append(Finding(Lack.REACH, f"the patch at {place} could not be kept {control.shape}"))
        return result

    def _volumes(self, x: FloatArray) -> FloatArray:
        zero = Volume(self._fours, np.zeros(len(self._fours)), np.zeros(len(self._fours)))
        return zero.residual(gather(np.ascontiguousarray(x.T), self._fours))[0]
