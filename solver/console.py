"""What consoles cannot show."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def every_word_printable() -> Iterator[None]:
    """While this lasts, printing escapes what the output's encoding lacks, and raises no UnicodeEncodeError.

    Windows' consoles and pipes are often cp1252 or cp850, and names of files need not be text at all.
    """
    before = []
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # None in a program without a console
            before.append((stream, stream.errors))
            stream.reconfigure(errors="backslashreplace")
    try:
        yield
    finally:
        for stream, errors in before:
            stream.reconfigure(errors=errors)
