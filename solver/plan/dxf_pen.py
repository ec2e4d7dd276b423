"""Plans as DXF (R2000): millimetres, one layer an operation, arcs as arcs, closed outlines as one polyline."""

from __future__ import annotations

import io
import itertools
import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ..dxf_library import dxf_library
from .pen import SIGN, Page, rgb
from .pieces import Arc, Cubic, Line, Piece
from .profile import Layer
from .walk import Walk

_VERSION = "R2000"
#: $INSUNITS and $MEASUREMENT for millimetres.
_MILLIMETRES, _METRIC = 4, 1
#: AutoCAD's first colours by their numbers; the nearest one stands for a layer's.
_COLOURS = {
    1: "#ff0000", 2: "#ffff00", 3: "#00ff00", 4: "#00ffff", 5: "#0000ff", 6: "#ff00ff", 7: "#000000",
    8: "#808080", 9: "#c0c0c0", 30: "#ff7f00", 94: "#008000", 134: "#008080",
}  # fmt: skip
#: What names of layers may not have, and how long they may be.
_NOT_IN_NAMES = re.compile(r'[<>/\\":;?*|=,`\x00-\x1f]')
_LONGEST_NAME = 255


class DxfPen:
    """One page. Raises CurvefoldError where the library that writes DXF is missing."""

    def __init__(self, title: str) -> None:
        self._ezdxf = ezdxf = dxf_library()
        with _without_times(ezdxf.options):
            self._document: Any = ezdxf.new(_VERSION)
        header = self._document.header
        header["$INSUNITS"], header["$MEASUREMENT"] = _MILLIMETRES, _METRIC
        self._document.ezdxf_metadata()["CURVEFOLD"] = SIGN
        self._space: Any = self._document.modelspace()
        self._look: dict[str, Any] = {}

    def start_page(self, page: Page) -> None:
        self._space.reset_extents((0.0, 0.0, 0.0), (page.width, page.height, 0.0))
        self._space.reset_limits((0.0, 0.0), (page.width, page.height))

    def start_layer(self, layer: Layer) -> None:
        name = _NOT_IN_NAMES.sub("_", layer.name)[:_LONGEST_NAME]
        if name not in self._document.layers:
            self._document.layers.add(name, color=_nearest_colour(layer.colour))
        self._look = {"layer": name}

    def line(self, walk: Walk, name: str) -> None:
        pieces = walk.pieces
        if not any(isinstance(piece, Cubic) for piece in pieces):
            self._without_cubics(pieces, walk.closed)
        elif all(isinstance(piece, Cubic) for piece in pieces):
            self._spline(pieces, walk.closed)
        else:
            # A polyline has no cubics: each run of one sort is an entity, end to end.
            for cubic, run in itertools.groupby(pieces, lambda piece: isinstance(piece, Cubic)):
                some = tuple(run)
                if cubic:
                    self._spline(some, False)
                else:
                    self._without_cubics(some, False)

    def content(self) -> bytes:
        stream = io.StringIO()
        with _without_times(self._ezdxf.options):
            self._document.write(stream)
        return stream.getvalue().encode(self._document.encoding, "replace")

    def _without_cubics(self, pieces: Sequence[Piece], closed: bool) -> None:
        only = pieces[0]
        if len(pieces) == 1 and isinstance(only, Line):
            self._space.add_line(_xy(only.start), _xy(only.end), dxfattribs=self._look)
        elif len(pieces) == 1 and isinstance(only, Arc) and only.is_circle:
            self._space.add_circle(_xy(only.centre), only.radius, dxfattribs=self._look)
        elif len(pieces) == 1 and isinstance(only, Arc):
            begin, end = math.degrees(only.begin), math.degrees(only.begin + only.sweep)
            self._space.add_arc(
                _xy(only.centre),
                only.radius,
                begin,
                end,
                is_counter_clockwise=only.sweep > 0,
                dxfattribs=self._look,
            )
        else:
            rows = [(*_xy(piece.start), _bulge(piece)) for piece in pieces]
            if not closed:
                rows.append((*_xy(pieces[-1].end), 0.0))
            self._space.add_lwpolyline(rows, format="xyb", close=closed, dxfattribs=self._look)

    def _spline(self, pieces: Sequence[Piece], closed: bool) -> None:
        cubics = [piece for piece in pieces if isinstance(piece, Cubic)]
        points = [cubics[0].start]
        for cubic in cubics:
            points += [cubic.first, cubic.second, cubic.end]
        knots = [0.0] * 4 + [float(k) for k in range(1, len(cubics)) for _ in range(3)] + [float(len(cubics))] * 4
        spline = self._space.add_spline(dxfattribs=self._look)
        spline.dxf.degree = 3
        spline.control_points = [(*_xy(point), 0.0) for point in points]
        spline.knots = knots
        if closed:
            spline.closed = True


@contextmanager
def _without_times(options: Any) -> Iterator[None]:
    """The same plan is the same file: no times and no random names in it."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def _xy(z: complex) -> tuple[float, float]:
    return z.real, z.imag


def _bulge(piece: Piece) -> float:
    return math.tan(piece.sweep / 4.0) if isinstance(piece, Arc) else 0.0


def _nearest_colour(colour: str) -> int:
    wanted = rgb(colour)

    def off(known: str) -> int:
        return sum((a - b) ** 2 for a, b in zip(wanted, rgb(known), strict=True))

    return min(_COLOURS, key=lambda number: off(_COLOURS[number]))
