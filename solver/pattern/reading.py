"""One door for all drawings: the file's suffix says which reader."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..errors import CurvefoldError, PatternError, ReadError
from .cp import CP
from .crease_pattern import CreasePattern
from .drawing_format import DrawingFormat
from .dxf import DXF
from .fold_file import FOLD
from .opx import OPX
from .read_options import ReadOptions
from .svg import SVG

#: Every format that is read. A new one is a module that makes a DrawingFormat, and one entry here: commands,
#: dialogs, dropped files, batches and help texts follow.
FORMATS: tuple[DrawingFormat, ...] = (SVG, FOLD, DXF, CP, OPX)
#: Suffix -> reader of all sheets of a file.
READERS: dict[str, Callable[[str | Path, ReadOptions], tuple[CreasePattern, ...]]] = {
    suffix: one.read for one in FORMATS for suffix in one.suffixes
}
#: The suffixes of all drawings that are read, in small letters.
DRAWING_SUFFIXES: tuple[str, ...] = tuple(READERS)
#: The names of their formats, for dialogs and help.
DRAWING_FORMATS: tuple[str, ...] = tuple(one.name for one in FORMATS)


def read_patterns(path: str | Path, options: ReadOptions | None = None) -> tuple[CreasePattern, ...]:
    """All sheets in a file, in its order, named after it; "name 1", "name 2", ... where there are several.

    Just one where ``options.sheet`` chooses it. Raises ReadError and PatternError, both with the file and with
    the notes that were made so far.
    """
    path, options = Path(path), options or ReadOptions()
    # Readers inflate what is compressed, whatever it is called: x.svg.gz is x.svg.
    base = path.with_suffix("") if path.suffix.lower() == ".gz" else path
    reader = READERS.get(base.suffix.lower())
    if reader is None:
        raise ReadError(
            f"drawings of this kind ({path.suffix or 'no suffix'}) are not read, only {', '.join(READERS)}",
            file=str(path),
        )
    try:
        patterns = reader(path, options)
        if options.sheet is not None and options.sheet > len(patterns):
            held = "1 sheet" if len(patterns) == 1 else f"{len(patterns)} sheets"
            raise PatternError(f"it has {held}, and sheet {options.sheet} is asked for")
    except CurvefoldError as error:
        raise error.in_file(str(path)) from error
    stem = _readable(base.stem)
    several = len(patterns) > 1
    named = [
        pattern.named(f"{stem} {number}" if several else stem, options.unit_mm(pattern.unit_mm))
        for number, pattern in enumerate(patterns, 1)
    ]
    if options.sheet is None:
        return tuple(named)
    chosen = named[options.sheet - 1]
    return (chosen.noted(f"sheet {options.sheet} of {len(named)} in the file") if several else chosen,)


def read_pattern(path: str | Path, options: ReadOptions | None = None) -> CreasePattern:
    """The crease pattern in a file; of several sheets the one that ``options`` choose, else the first, with a note.

    Raises as ``read_patterns``.
    """
    options = options or ReadOptions()
    patterns = read_patterns(path, options)
    if len(patterns) == 1:
        return patterns[0]
    note = f"the file has {len(patterns)} sheets: this is the first one (choose another one by its number)"
    return patterns[0].noted(note)


def _readable(name: str) -> str:
    """A name of a file as text: bytes that are no UTF-8 become question marks."""
    return name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
