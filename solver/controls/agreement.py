"""Controls of different kinds that contradict each other by their words alone."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import DescriptionError
from .angle import Angle
from .control import Control, CreaseName, crease_index
from .side import SIGNS, WORDS, Side


def check_agreement(told: Sequence[tuple[str, Control]], labels: Sequence[str]) -> None:
    """Raises DescriptionError where a signed angle is on the other side than its crease is held to.

    told: (label, control) each; labels: of the creases
    """
    sides: dict[int, str] = {}
    for label, control in told:
        if isinstance(control, Side):
            sides[_crease(labels, control.crease, label)] = control.side
    for label, control in told:
        if not isinstance(control, Angle) or not control.signed or control.crease is None:
            continue
        k = _crease(labels, control.crease, label)
        if k in sides and control.degrees * SIGNS[sides[k]] < 0:
            raise DescriptionError(
                f"{labels[k]} is to be a {WORDS[sides[k]]}, which has no angle of {control.degrees:g}°",
                element=label,
            )


def _crease(labels: Sequence[str], name: CreaseName, label: str) -> int:
    try:
        return crease_index(labels, name)
    except DescriptionError as error:
        raise DescriptionError(error.message, element=label) from None
