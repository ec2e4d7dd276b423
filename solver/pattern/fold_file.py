"""FOLD files (1.0 to 1.2, JSON) -> crease patterns.

Units are the frame's own, y is up as in the file. The steps: ``fold_file_frames`` reads safely and chooses the
frame that is a drawing, ``fold_file_values`` checks its lists, ``fold_file_graph`` mends vertices and edges,
``fold_file_strokes`` joins edges into lines, and ``sheets`` says what is border, hole and crease.
"""

from __future__ import annotations

import os
from typing import IO, Any

import shapely

from ..errors import CurvefoldError, PatternError
from .crease_pattern import CreasePattern
from .fold_file_frames import choose_frame, parse_fold
from .fold_file_graph import edge_graph
from .fold_file_strokes import lines_of
from .read_options import ReadOptions
from .sheets import make_patterns
from .source import read_source

#: Millimetres in one frame_unit (FOLD 1.2); "unit" and what is not listed here say nothing.
_UNIT_MM = {"in": 25.4, "pt": 25.4 / 72, "m": 1000.0, "cm": 10.0, "mm": 1.0, "um": 1e-3, "nm": 1e-6}
#: Many programs draw on a square of one unit, which nobody means to be a millimetre. A sheet below the first size,
#: in units that say nothing, has units of the second, mm.
_SMALL, _UNIT_OF_SMALL = 10.0, 100.0


def read_fold(
    source: str | os.PathLike[str] | IO[Any], options: ReadOptions | None = None
) -> tuple[CreasePattern, ...]:
    """The crease patterns in a FOLD file, one a sheet: a path, or an open file (text or bytes).

    ``notes`` of the results say which frame was read, what its edges became and what was left out. Raises ReadError
    when this is not a readable FOLD file, PatternError when it holds no drawing; both name the file if it is known.
    """
    data, name = read_source(source)
    try:
        frame = choose_frame(parse_fold(data))
        graph = edge_graph(frame)
        notes = [*frame.notes, *graph.notes]
        unit = frame.get("frame_unit")
        unit_mm = _UNIT_MM.get(unit) if isinstance(unit, str) else None
        if unit_mm is None and graph.size < _SMALL:
            unit_mm = _UNIT_OF_SMALL
            notes.append(f"the file gives no unit, so that one is taken for {unit_mm:g} mm")
        lines = lines_of(graph, unit_mm, tuple(notes))
        return make_patterns(lines, (options or ReadOptions()).border)
    except CurvefoldError as error:
        raise (error if name is None else error.in_file(name)) from error
    except (ArithmeticError, ValueError, IndexError, MemoryError, shapely.errors.ShapelyError) as error:
        # GEOS reports what it cannot compute as one of its own errors; no drawing may do more than fail.
        raise PatternError(
            f"the drawing cannot be understood ({type(error).__name__}: {error})", file=name
        ) from error
