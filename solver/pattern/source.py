"""The bytes or the text of a file that is to be read, whatever its format."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import IO, Any

from ..errors import ReadError
from .text import inflate

#: A drawing of this size is not a crease pattern; parsing it would take minutes and gigabytes.
MAX_BYTES = 64 * 1024 * 1024


def read_source(source: str | os.PathLike[str] | IO[Any]) -> tuple[bytes | str, str | None]:
    """What is in a path or an open file, inflated if it is compressed (gzip), and the file's name if known.

    Raises ReadError.
    """
    if isinstance(source, (str, os.PathLike)):
        path = Path(source)
        try:
            status = path.stat()
            if not stat.S_ISREG(status.st_mode):
                raise ReadError("this is not a file", file=str(path))
            if status.st_size > MAX_BYTES:
                raise _too_large(status.st_size, str(path))
            with open(path, "rb") as file:
                data: bytes | str = file.read(MAX_BYTES + 1)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise ReadError(f"the file cannot be read ({reason})", file=str(path)) from error
        name: str | None = str(path)
    else:
        attribute = getattr(source, "name", None)
        name = attribute if isinstance(attribute, str) else None
        try:
            data = source.read(MAX_BYTES + 1)
        except (OSError, ValueError) as error:
            raise ReadError(f"the file cannot be read ({error})", file=name) from error
    if len(data) > MAX_BYTES:
        raise _too_large(len(data), name)
    if isinstance(data, bytes):
        try:
            data = inflate(data, MAX_BYTES)
        except ReadError as error:
            raise error if name is None else error.in_file(name) from error
    return data, name


def _too_large(size: int, file: str | None) -> ReadError:
    return ReadError(
        f"the file has {size / 2**20:.0f} MB, and drawings above {MAX_BYTES / 2**20:.0f} MB are not read",
        file=file,
    )
