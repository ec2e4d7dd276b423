"""What a format of drawings is: its name, its suffixes, and how its bytes become lines with a meaning."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import IO, Any

import shapely

from ..errors import CurvefoldError, PatternError
from .crease_pattern import CreasePattern
from .read_options import ReadOptions
from .sheets import make_patterns
from .source import read_source
from .stroke import Lines


@dataclass(frozen=True)
class DrawingFormat:
    """One format. Its module makes one of these, and ``reading.FORMATS`` lists it.

    name      for dialogs and help: "SVG"
    suffixes  in small letters, the usual one first: (".svg", ".svgz")
    lines     the lines in a file's bytes or text, inflated, and the options it is read with. Raises CurvefoldError
    """

    name: str
    suffixes: tuple[str, ...]
    lines: Callable[[bytes | str, ReadOptions], Lines]

    def read(
        self, source: str | os.PathLike[str] | IO[Any], options: ReadOptions | None = None
    ) -> tuple[CreasePattern, ...]:
        """The crease patterns in a file, one a sheet: a path, or an open file (text or bytes).

        ``notes`` of the results say what every line became and why. Raises ReadError when this is not a readable
        file of the format, PatternError when its drawing is not a crease pattern; both name the file if known.
        """
        data, name = read_source(source)
        options = options or ReadOptions()
        try:
            return make_patterns(self.lines(data, options), options.border)
        except CurvefoldError as error:
            raise (error if name is None else error.in_file(name)) from error
        except (
            ArithmeticError,
            ValueError,
            IndexError,
            KeyError,
            RecursionError,
            MemoryError,
            shapely.errors.ShapelyError,
        ) as error:
            # GEOS reports what it cannot compute as one of its own errors; no drawing may do more than fail.
            raise PatternError(
                f"the drawing cannot be understood ({type(error).__name__}: {error})", file=name
            ) from error
