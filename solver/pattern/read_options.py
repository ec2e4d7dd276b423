"""What a user may choose about how a drawing is read, for every format."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ..errors import DescriptionError

#: What is taken for the border of the sheet: the outline that is drawn, or else the page; or always one of them.
BORDERS = ("auto", "outline", "page")
#: Millimetres in one unit that a user may name. An inch has 72 points, and 96 of CSS's pixels.
UNITS_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "pt": 25.4 / 72, "px": 25.4 / 96}
#: Programs that draw in dots of their own: Illustrator 72 to the inch, Inkscape before 0.92 90, Affinity up to 300.
_DPI = re.compile(r"(\d{1,4}(?:\.\d{1,6})?)\s*dpi")
#: A factor beyond these is a slip of the hand.
_SCALES = (1e-6, 1e6)


@dataclass(frozen=True)
class ReadOptions:
    """How a drawing is read.

    border  one of BORDERS
    sheet   which of several sheets, counted from 1 as the file has them; None for all, or the first
    unit    what one unit of the drawing is: one of UNITS_MM, or "90dpi"; None for what the file says
    scale   factor on the drawing's size, after the unit
    Raises DescriptionError on anything else.
    """

    border: str = "auto"
    sheet: int | None = None
    unit: str | None = None
    scale: float = 1.0

    def __post_init__(self) -> None:
        if self.border not in BORDERS:
            raise DescriptionError(f"must be one of {', '.join(BORDERS)}", element="border")
        if self.sheet is not None and (type(self.sheet) is not int or self.sheet < 1):
            raise DescriptionError("must be a whole number from 1", element="sheet")
        if self.unit is not None:
            unit_in_mm(self.unit)
        if type(self.scale) not in (int, float) or not _SCALES[0] <= self.scale <= _SCALES[1]:
            raise DescriptionError(f"must be a number from {_SCALES[0]:g} to {_SCALES[1]:g}", element="scale")

    def unit_mm(self, given: float | None) -> float | None:
        """Millimetres in one unit of the drawing, where the file gives ``given`` or says nothing (None)."""
        unit = given if self.unit is None else unit_in_mm(self.unit)
        if self.scale == 1.0:
            return unit
        return (1.0 if unit is None else unit) * self.scale


def unit_in_mm(unit: str) -> float:
    """Millimetres in a named unit. Raises DescriptionError.

    >>> unit_in_mm("cm"), unit_in_mm("254dpi")
    (10.0, 0.1)
    """
    if unit in UNITS_MM:
        return UNITS_MM[unit]
    match = _DPI.fullmatch(unit) if isinstance(unit, str) else None
    dots = float(match.group(1)) if match else math.nan
    if not dots > 0.0:
        raise DescriptionError(
            f"must be one of {', '.join(UNITS_MM)}, or dots to the inch such as 90dpi", element="unit"
        )
    return 25.4 / dots
