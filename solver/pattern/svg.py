"""SVG drawings -> crease patterns.

Units are the drawing's own (its viewBox), y is turned up about the viewBox: (x, y) -> (x, ymin + ymax - y).
The steps: ``svg_xml`` reads safely, ``svg_walk`` finds what is drawn, ``svg_strokes`` samples it and
asks ``meaning`` what each stroke means alone, and ``sheets`` says what all mean together.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import IO, Any

import shapely

from ..errors import CurvefoldError, PatternError
from .crease_pattern import CreasePattern
from .read_options import ReadOptions
from .sheets import make_patterns
from .source import read_source
from .svg_strokes import lines_of
from .svg_walk import read_drawing
from .svg_xml import parse_svg_tree

#: What is said of a drawing whose width and height are missing, in pixels, or in percent.
NO_SIZE = (
    "the file gives no physical size: one unit is taken for 1 mm (choose another unit or scale when reading it)"
)


def read_svg(
    source: str | os.PathLike[str] | IO[Any], options: ReadOptions | None = None
) -> tuple[CreasePattern, ...]:
    """The crease patterns in an SVG file, one a sheet: a path, or an open file (text or bytes).

    ``notes`` of the results say what every stroke became and why. Raises ReadError when this is not a readable
    SVG file, PatternError when its drawing is not a crease pattern; both name the file if it is known.
    """
    data, name = read_source(source)
    try:
        drawing = read_drawing(parse_svg_tree(data))
        options = options or ReadOptions()
        if drawing.unit_mm is None and options.unit is None:
            drawing = replace(drawing, notes=(*drawing.notes, NO_SIZE))
        return make_patterns(lines_of(drawing), options.border)
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
