"""How far the angle drive takes one crease, in parts of the angle it is set to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..drive import AngleDrive
from ..errors import DescriptionError
from .control import Control, ControlPull, CreaseName, crease_index, crease_name, number


@dataclass(frozen=True)
class Amount(Control):
    """crease: number from 1, or name. part: of the drive's angle, 0 (stays flat if it can) to 2."""

    crease: CreaseName
    part: float

    kind = "amount"

    def __post_init__(self) -> None:
        crease_name(self.crease)
        number("part", self.part, 0.0, 2.0)


class AmountPull(ControlPull):
    """Pulls at nothing itself: it tells the drive how far to take each crease."""

    def __init__(self, labels: Sequence[str], drive: AngleDrive) -> None:
        self._labels, self._drive = labels, drive

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        amount = np.ones(len(self._labels))
        told = np.zeros(len(self._labels), dtype=bool)
        for label, control in controls:
            try:
                k = crease_index(self._labels, control.crease)
            except DescriptionError as error:
                raise DescriptionError(error.message, element=label) from None
            if told[k] and amount[k] != control.part:
                raise DescriptionError(f"gives {self._labels[k]} another amount than an earlier one", element=label)
            amount[k], told[k] = control.part, True
        self._drive.set_amounts(amount)
