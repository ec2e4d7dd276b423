"""All kinds of control: a new one is one file and one line here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ..drive import AngleDrive
from ..errors import DescriptionError
from ..net.piecewise_dog import PiecewiseDog
from .amount import Amount, AmountPull
from .angle import Angle, AnglePull
from .control import Control, ControlPull, read_fields
from .curve import Curve, CurvePull
from .glue import Glue, GluePull
from .keep import Keep, KeepPull
from .pair import Pair, PairPull
from .side import Side, SidePull

if TYPE_CHECKING:
    from ..description import Weights


@dataclass(frozen=True)
class Kind:
    """A kind of control, and what sets all controls of that kind to work on a net."""

    control: type[Control]
    pull: Callable[[PiecewiseDog, Weights, AngleDrive], ControlPull]


#: In the order in which they pull.
KINDS = (
    Kind(Amount, lambda net, weights, drive: AmountPull(net.crease_labels, drive)),
    Kind(Side, lambda net, weights, drive: SidePull(net, weights.sides)),
    Kind(Angle, lambda net, weights, drive: AnglePull(net, weights.fold_angle)),
    Kind(Pair, lambda net, weights, drive: PairPull(net, weights.pairs)),
    Kind(Keep, lambda net, weights, drive: KeepPull(net, weights.patches)),
    Kind(Curve, lambda net, weights, drive: CurvePull(net, weights.curves)),
    Kind(Glue, lambda net, weights, drive: GluePull(net, weights.pairs, weights.bending)),
)
BY_NAME = {kind.control.kind: kind.control for kind in KINDS}


def control_to_json(control: Control) -> dict[str, Any]:
    """A JSON object with the control's kind; ``controls_from_json`` reads it back."""
    return {"kind": control.kind, **asdict(control)}


def controls_from_json(data: Any) -> tuple[Control, ...]:
    """Controls from a JSON list. Raises DescriptionError naming the entry by its number from 1."""
    if not isinstance(data, list | tuple):
        raise DescriptionError("must be a list of controls, each with a 'kind'", element="controls")
    result = []
    for k, entry in enumerate(data):
        kind = entry.get("kind") if isinstance(entry, dict) else None
        if not isinstance(kind, str) or kind not in BY_NAME:
            raise DescriptionError(f"needs a 'kind' out of {', '.join(BY_NAME)}", element=f"control {k + 1}")
        try:
            result.append(read_fields(BY_NAME[kind], entry))
        except DescriptionError as error:
            raise DescriptionError(error.message, element=control_label(k, kind)) from None
    return tuple(result)


def control_label(index: int, kind: str) -> str:
    """How messages call a control."""
    return f"control {index + 1} ({kind})"
