"""What is said of a drawing that does not tell its size."""

from __future__ import annotations

#: A drawing without a unit that could be one.
NO_SIZE = (
    "the file gives no physical size: one unit is taken for 1 mm (choose another unit or scale when reading it)"
)
#: Many programs draw on a square of one unit, which nobody means to be a millimetre. A sheet below the first size,
#: in units that say nothing, has units of the second, mm.
_SMALL, _UNIT_OF_SMALL = 10.0, 100.0


def unit_of_small(size: float) -> tuple[float | None, tuple[str, ...]]:
    """Millimetres in a unit that says nothing, of a sheet of this size, and a note; None for a size that could be
    meant in millimetres.

    >>> unit_of_small(1.0)[0], unit_of_small(400.0)
    (100.0, (None, ()))
    """
    if not size < _SMALL:
        return None, ()
    return _UNIT_OF_SMALL, (f"the file gives no unit, so that one is taken for {_UNIT_OF_SMALL:g} mm",)
