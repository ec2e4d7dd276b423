"""What other programs' libraries find in the files of plans: lengths of lines by layer, in millimetres."""

from __future__ import annotations

import io
import math
from collections import defaultdict
from typing import Any

import ezdxf
import numpy as np
import pypdf
import svgelements
from pypdf.generic import ContentStream

MM = 72.0 / 25.4


def svg_lengths(data: bytes) -> dict[str, float]:
    """By the labels of layers."""
    found: dict[str, float] = defaultdict(float)
    # 25.4 pixels to the inch: a pixel is a millimetre.
    for group in svgelements.SVG.parse(io.BytesIO(data), ppi=25.4, reify=True):
        if isinstance(group, svgelements.Group):
            label = group.values["{http://www.inkscape.org/namespaces/inkscape}label"]
            found[label] += sum(_svg_length(shape) for shape in group)
    return dict(found)


def _svg_length(shape: Any) -> float:
    return sum(_segment_length(segment) for segment in svgelements.Path(shape))


def _segment_length(segment: Any) -> float:
    if isinstance(segment, svgelements.Move):
        return 0.0
    if isinstance(segment, svgelements.Arc):
        return abs(float(segment.sweep)) * float(segment.rx)
    if isinstance(segment, svgelements.CubicBezier):
        controls = (segment.start, segment.control1, segment.control2, segment.end)
        return cubic_length(*(np.array([point.x, point.y]) for point in controls))
    return float(segment.length()) if segment.start is not None and segment.end is not None else 0.0


def pdf_points(data: bytes) -> list[Any]:
    """Of the first page, millimetres."""
    reader = pypdf.PdfReader(io.BytesIO(data))
    found: list[Any] = []
    here = start = np.zeros(2)
    t = np.linspace(0.0, 1.0, 400)[:, None]
    s = 1.0 - t
    for operands, operator in ContentStream(reader.pages[0].get_contents(), reader).operations:
        values = np.array([float(v) for v in operands if isinstance(v, int | float)])
        if operator == b"m":
            here = start = values
        elif operator == b"l":
            found.append(np.array([here, values]))
            here = values
        elif operator == b"c":
            a, b, c = values.reshape(3, 2)
            found.append(s**3 * here + 3 * s * s * t * a + 3 * s * t * t * b + t**3 * c)
            here = c
        elif operator == b"s" and (here != start).any():
            found.append(np.array([here, start]))
    return found


def polyline_length(points: Any) -> float:
    return float(np.hypot(*np.diff(np.asarray(points, dtype=float)[:, :2], axis=0).T).sum())


def svg_points(data: bytes, height: float) -> list[Any]:
    """Polylines (P,2) along all lines, y up as on the page of this height."""
    found = []
    for shape in svgelements.SVG.parse(io.BytesIO(data), ppi=25.4, reify=True).elements():
        if isinstance(shape, svgelements.Shape):
            for segment in svgelements.Path(shape):
                if not isinstance(segment, svgelements.Move) and segment.start != segment.end:
                    places = [segment.point(t) for t in np.linspace(0.0, 1.0, 400)]
                    found.append(np.array([(point.x, height - point.y) for point in places]))
    return found


def dxf_points(data: bytes) -> list[Any]:
    return [row for entity in read_dxf(data).modelspace() for row in _dxf_rows(entity)]


def _dxf_rows(entity: Any) -> list[Any]:
    if entity.dxftype() == "LWPOLYLINE":
        return [row for part in entity.virtual_entities() for row in _dxf_rows(part)]
    straight = entity.dxftype() == "LINE"
    points = [entity.dxf.start, entity.dxf.end] if straight else list(entity.flattening(1e-4))
    return [np.array([(point.x, point.y) for point in points])]


def cubic_length(a: Any, b: Any, c: Any, d: Any) -> float:
    t = np.linspace(0.0, 1.0, 2_000)[:, None]
    s = 1.0 - t
    return polyline_length(s**3 * a + 3 * s * s * t * b + 3 * s * t * t * c + t**3 * d)


def read_dxf(data: bytes) -> Any:
    return ezdxf.read(io.StringIO(data.decode("utf-8")))


def dxf_lengths(data: bytes) -> dict[str, float]:
    found: dict[str, float] = defaultdict(float)
    for entity in read_dxf(data).modelspace():
        found[entity.dxf.layer] += dxf_length(entity)
    return dict(found)


def dxf_length(entity: Any) -> float:
    kind = entity.dxftype()
    if kind == "LINE":
        return float(entity.dxf.start.distance(entity.dxf.end))
    if kind == "CIRCLE":
        return 2 * math.pi * float(entity.dxf.radius)
    if kind == "ARC":
        return float(entity.dxf.radius) * math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0)
    if kind == "LWPOLYLINE":
        return sum(dxf_length(part) for part in entity.virtual_entities())
    return polyline_length([(p.x, p.y) for p in entity.construction_tool().approximate(2_000)])


def pdf_lengths(data: bytes) -> list[dict[str, float]]:
    """Of each page, by the names of layers."""
    reader = pypdf.PdfReader(io.BytesIO(data))
    return [_page_lengths(page, reader) for page in reader.pages]


def _page_lengths(page: Any, reader: Any) -> dict[str, float]:
    names = {key: group.get_object()["/Name"] for key, group in page["/Resources"]["/Properties"].items()}
    found: dict[str, float] = defaultdict(float)
    layer, scale, here, start = "", 1.0, np.zeros(2), np.zeros(2)
    for operands, operator in ContentStream(page.get_contents(), reader).operations:
        values = [float(v) for v in operands if isinstance(v, int | float)]
        if operator == b"cm":
            scale = values[0] / MM
        elif operator == b"BDC":
            layer = names[operands[1]]
        elif operator == b"m":
            here = start = np.array(values)
        elif operator == b"l":
            found[layer] += scale * float(np.hypot(*(np.array(values) - here)))
            here = np.array(values)
        elif operator == b"c":
            a, b, c = np.array(values).reshape(3, 2)
            found[layer] += scale * cubic_length(here, a, b, c)
            here = c
        elif operator == b"s":
            found[layer] += scale * float(np.hypot(*(start - here)))
    return dict(found)
