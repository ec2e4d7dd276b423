"""One door for all drawings: the file's suffix says which reader."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..errors import CurvefoldError, ReadError
from .crease_pattern import CreasePattern
from .fold_file import read_fold
from .svg import read_svg

#: Suffix -> reader. A new format is one line here.
READERS: dict[str, Callable[[str | Path], CreasePattern]] = {".svg": read_svg, ".fold": read_fold}


def read_pattern(path: str | Path) -> CreasePattern:
    """The crease pattern in a file, named after it. Raises ReadError and PatternError, both with the file."""
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ReadError(
            f"drawings of this kind ({path.suffix or 'no suffix'}) are not read, only {', '.join(READERS)}",
            file=str(path),
        )
    try:
        pattern = reader(path)
    except CurvefoldError as error:
        raise error.in_file(str(path)) from error
    return CreasePattern(
        pattern.boundary,
        pattern.holes,
        pattern.creases,
        path.stem,
        pattern.unit_mm,
        pattern.notes,
    )
