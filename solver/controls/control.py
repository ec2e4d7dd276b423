"""What may be asked of a paper besides handles and the drive, as data that goes to and from JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import MISSING, dataclass, fields
from typing import Any, ClassVar

from ..arrays import FloatArray
from ..errors import DescriptionError
from .pull import Pull

CreaseName = int | str


@dataclass(frozen=True)
class Control:
    """Base of all controls: frozen dataclasses of numbers, words and tuples that check themselves.

    Raises DescriptionError, naming the field, when a value is not what it should be.
    """

    kind: ClassVar[str]


class ControlPull(Pull):
    """All controls of one kind at work."""

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        """Replace the controls: (label, control) each, in the present shape x (V,3), net units.

        Raises DescriptionError naming the label when a control does not fit the net.
        """
        raise NotImplementedError


def read_fields(cls: type[Control], entry: dict[str, Any]) -> Control:
    """A control from the fields of a JSON object. Raises DescriptionError on unknown and missing fields."""
    names = {field.name: field for field in fields(cls)}
    unknown = sorted(set(entry) - set(names) - {"kind"})
    if unknown:
        raise DescriptionError(f"{unknown[0]!r} is no setting of {cls.kind!r}; it has {', '.join(names)}")
    missing = [n for n, f in names.items() if f.default is MISSING and n not in entry]
    if missing:
        raise DescriptionError(f"{cls.kind!r} needs {missing[0]!r}")
    return cls(**{name: value for name, value in entry.items() if name != "kind"})


def is_number(value: Any) -> bool:
    """Whether it is a finite number, not too large for a float."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # JSON may hold whole numbers of any length
        return False


def number(name: str, value: Any, least: float = -math.inf, most: float = math.inf) -> float:
    """A finite number within bounds."""
    if not is_number(value):
        raise DescriptionError(f"{name!r} must be a number")
    if not least <= value <= most:
        bounds = f"from {least:g} to {most:g}" if math.isfinite(most) else f"of at least {least:g}"
        raise DescriptionError(f"{name!r} must be a number {bounds}")
    return float(value)


def positive(name: str, value: Any) -> float:
    """A finite number above zero."""
    result = number(name, value)
    if result <= 0:
        raise DescriptionError(f"{name!r} must be a positive number")
    return result


def flag(name: str, value: Any) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise DescriptionError(f"{name!r} must be true or false")
    return value


def vector(name: str, value: Any, count: int) -> tuple[float, ...]:
    """So many finite numbers."""
    if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != count:
        raise DescriptionError(f"{name!r} must be {count} numbers")
    return tuple(number(name, v) for v in value)


def crease_name(value: Any) -> CreaseName:
    """A crease by its number from 1, as messages call it, or by its name in the drawing."""
    if isinstance(value, bool) or not isinstance(value, int | str) or value == "":
        raise DescriptionError("'crease' must be a crease's number, from 1, or its name")
    return value


def crease_index(labels: Sequence[str], name: CreaseName) -> int:
    """Index of a crease among a net's labels. Raises DescriptionError when there is no such crease."""
    if isinstance(name, int):
        if 1 <= name <= len(labels):
            return name - 1
        raise DescriptionError(f"there is no crease {name}: the drawing has {len(labels)}")
    named = [k for k, label in enumerate(labels) if label == f"crease {k + 1} ({name})"]
    if not named:
        raise DescriptionError(f"there is no crease called {name!r}")
    if len(named) > 1:
        raise DescriptionError(f"several creases are called {name!r}; use their numbers")
    return named[0]
