"""Which drawings a batch is about: those of a folder, those of a list, or a single one."""

import codecs
import os
import re
from dataclasses import dataclass
from pathlib import Path

from .. import solver

#: A list of drawings that is longer is none.
MAX_LIST_BYTES = 1 << 20

#: How text begins that says how it is encoded, and the encoding: Windows' editors and shells write lists like that.
_BEGINNINGS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
#: What macOS leaves on foreign disks and in archives: a companion of each file, and a folder of them.
_COMPANION, _COMPANIONS = "._", "__MACOSX"


class BatchError(Exception):
    """The batch itself cannot run. ``str()`` is one sentence."""


@dataclass(frozen=True)
class Found:
    """drawings: in the order in which they are folded; hidden: how many hidden files were passed over."""

    drawings: tuple[Path, ...]
    hidden: int


def find_drawings(source: Path) -> Found:
    """The drawings in a folder, by name, or in a list, in its order. Raises BatchError.

    Hidden files of a folder are passed over, and in a list what macOS leaves beside files.
    """
    try:
        if source.is_dir():
            paths = sorted(path for path in source.iterdir() if path.suffix.lower() in solver.DRAWING_SUFFIXES)
            shown = [path for path in paths if not path.name.startswith(".")]
        elif source.suffix.lower() in solver.DRAWING_SUFFIXES:
            shown = paths = [source]
        else:
            lines = [line.strip() for line in re.split(r"\r\n|\r|\n", _list_text(source))]
            paths = [source.parent / line for line in lines if line and not line.startswith("#")]
            shown = [path for path in paths if not _is_companion(path)]
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text"
        raise BatchError(f"{source}: cannot be read: {reason}") from error
    hidden = len(paths) - len(shown)
    if not shown:
        but = f" but {hidden} hidden" if hidden else ""
        raise BatchError(f"{source}: holds no drawings{but} ({', '.join(solver.DRAWING_SUFFIXES)})")
    return Found(tuple(shown), hidden)


def count_sheets(drawing: Path, options: solver.ReadOptions) -> int:
    """How many sheets a drawing has; 1 where one is chosen, and where it cannot be read.

    Whatever is wrong with it, its own process says so.
    """
    if options.sheet is not None:
        return 1
    try:
        return len(solver.read_patterns(drawing, options))
    except Exception:
        return 1


def _is_companion(path: Path) -> bool:
    return path.name.startswith(_COMPANION) or _COMPANIONS in path.parts


def _list_text(source: Path) -> str:
    """The text of a list. Raises OSError, UnicodeDecodeError, BatchError."""
    with source.open("rb") as stream:
        data = stream.read(MAX_LIST_BYTES + 1)
    if len(data) > MAX_LIST_BYTES:
        raise BatchError(f"{source}: cannot be read: it is too long for a list of drawings")
    encoding = next((name for beginning, name in _BEGINNINGS if data.startswith(beginning)), None)
    # Without a word about it, a name is what the system calls the file, which need not be UTF-8.
    text = os.fsdecode(data) if encoding is None else data.decode(encoding)
    if "\0" in text:
        raise BatchError(f"{source}: cannot be read: it is not text")
    return text
