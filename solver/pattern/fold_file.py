"""FOLD files (1.0 to 1.2, JSON) -> lines with a meaning.

Units are the frame's own, y is up as in the file. The steps: ``fold_file_frames`` reads safely and chooses the
frame that is a drawing, ``fold_file_values`` checks its lists, ``fold_file_graph`` mends vertices and edges, and
``fold_file_strokes`` joins edges into lines.
"""

from __future__ import annotations

from .drawing_format import DrawingFormat
from .fold_file_frames import choose_frame, parse_fold
from .fold_file_graph import edge_graph
from .fold_file_strokes import lines_of
from .read_options import ReadOptions
from .sizes import unit_of_small
from .stroke import Lines

#: Millimetres in one frame_unit (FOLD 1.2); "unit" and what is not listed here say nothing.
_UNIT_MM = {"in": 25.4, "pt": 25.4 / 72, "m": 1000.0, "cm": 10.0, "mm": 1.0, "um": 1e-3, "nm": 1e-6}


def _lines(data: bytes | str, _options: ReadOptions) -> Lines:
    """The notes say which frame was read, what its edges became and what was left out."""
    frame = choose_frame(parse_fold(data))
    graph = edge_graph(frame)
    notes = [*frame.notes, *graph.notes]
    unit = frame.get("frame_unit")
    unit_mm = _UNIT_MM.get(unit) if isinstance(unit, str) else None
    if unit_mm is None:
        unit_mm, said = unit_of_small(graph.size)
        notes += said
    return lines_of(graph, unit_mm, tuple(notes))


FOLD = DrawingFormat("FOLD", (".fold",), _lines)
read_fold = FOLD.read
