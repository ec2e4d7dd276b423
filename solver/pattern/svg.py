"""SVG drawings -> lines with a meaning.

Units are the drawing's own (its viewBox), y is turned up about the viewBox: (x, y) -> (x, ymin + ymax - y).
The steps: ``svg_xml`` reads safely, ``svg_walk`` finds what is drawn, and ``svg_strokes`` samples it and
asks ``meaning`` what each stroke means alone.
"""

from __future__ import annotations

from dataclasses import replace

from .drawing_format import DrawingFormat
from .read_options import ReadOptions
from .sizes import NO_SIZE
from .stroke import Lines
from .svg_strokes import lines_of
from .svg_walk import read_drawing
from .svg_xml import parse_svg_tree


def _lines(data: bytes | str, options: ReadOptions) -> Lines:
    drawing = read_drawing(parse_svg_tree(data))
    if drawing.unit_mm is None and options.unit is None:
        drawing = replace(drawing, notes=(*drawing.notes, NO_SIZE))
    return lines_of(drawing)


SVG = DrawingFormat("SVG", (".svg", ".svgz"), _lines)
read_svg = SVG.read
