"""SVG's basic shapes and path data as segments, in the element's own coordinates (y down).

Path data has a parser of its own: svgelements 1.9.6 stops in silence at what it does not understand, does not
know numbers like ``1.``, reflects the wrong control point in ``Q … S``, takes quadratic time for many ``z``.
Its conversion of arcs to centres is used.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise

import svgelements

from .segments import MAX_POINTS, Segment, Subpath, arc, cubic, line, quadratic
from .svg_values import NUMBER, Length, SvgValueError, finite, parse_length, parse_numbers

#: Length of an attribute, its direction ("x", "y" or "" for neither) -> pixels.
Resolve = Callable[[Length, str], float]

SHAPES = frozenset({"path", "line", "polyline", "polygon", "rect", "circle", "ellipse"})
#: Arguments a command takes each time (SVG 1.1, section 8.3).
_ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_BLANK = re.compile(r"[\s,]*")
_NUMBER = re.compile(NUMBER)


def shape_subpaths(tag: str, attributes: Mapping[str, str], resolve: Resolve) -> list[Subpath]:
    """The outline of one shape element; empty when SVG says it is not drawn. Raises SvgValueError."""
    if tag == "path":
        return parse_path(attributes.get("d", ""))
    if tag in ("polyline", "polygon"):
        return _polyline(parse_numbers(attributes.get("points", ""), 2 * MAX_POINTS), tag == "polygon")

    def length(name: str, direction: str) -> float | None:
        text = attributes.get(name, "").strip()
        if not text or text.lower() == "auto":
            return None
        value = resolve(parse_length(text), direction)
        if not math.isfinite(value):
            raise SvgValueError(f"{name} is not finite")
        return value

    if tag == "line":
        x1, y1, x2, y2 = (length(name, name[0]) or 0.0 for name in ("x1", "y1", "x2", "y2"))
        return [Subpath((line((x1, y1), (x2, y2)),), False)]
    if tag == "rect":
        x, y = length("x", "x") or 0.0, length("y", "y") or 0.0
        width, height = length("width", "x") or 0.0, length("height", "y") or 0.0
        return _rectangle(x, y, width, height, length("rx", "x"), length("ry", "y"))
    cx, cy = length("cx", "x") or 0.0, length("cy", "y") or 0.0
    if tag == "circle":
        radius = length("r", "") or 0.0
        return _ellipse(cx, cy, radius, radius)
    rx, ry = length("rx", "x"), length("ry", "y")
    return _ellipse(cx, cy, rx if rx is not None else ry or 0.0, ry if ry is not None else rx or 0.0)


def _polyline(values: list[float], closed: bool) -> list[Subpath]:
    if len(values) % 2:
        raise SvgValueError("points has an odd number of coordinates")
    points = list(zip(values[::2], values[1::2], strict=True))
    if len(points) < 2:
        return []
    if closed:
        points.append(points[0])
    return [Subpath(tuple(line(a, b) for a, b in pairwise(points)), closed)]


def _quarter(cx: float, cy: float, rx: float, ry: float, quarter: int) -> Segment:
    """A quarter of an axis-parallel ellipse, from angle ``quarter`` * 90 degrees on."""
    ends = ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 0))
    (ax, ay), (bx, by) = ends[quarter], ends[quarter + 1]
    start, end = (cx + ax * rx, cy + ay * ry), (cx + bx * rx, cy + by * ry)
    return arc(start, end, (cx, cy), (rx, 0.0), (0.0, ry), quarter * math.pi / 2, math.pi / 2)


def _ellipse(cx: float, cy: float, rx: float, ry: float) -> list[Subpath]:
    if rx <= 0.0 or ry <= 0.0:
        return []
    return [Subpath(tuple(_quarter(cx, cy, rx, ry, k) for k in range(4)), True)]


def _rectangle(
    x: float, y: float, width: float, height: float, rx: float | None, ry: float | None
) -> list[Subpath]:
    if width <= 0.0 or height <= 0.0:
        return []
    # SVG 1.1, section 9.2: one radius stands for both, and both stop at half the side.
    rx, ry = (rx if rx is not None else ry), (ry if ry is not None else rx)
    rx, ry = min(max(rx or 0.0, 0.0), width / 2), min(max(ry or 0.0, 0.0), height / 2)
    right, bottom = x + width, y + height
    if rx == 0.0 or ry == 0.0:
        corners = [(x, y), (right, y), (right, bottom), (x, bottom), (x, y)]
        return [Subpath(tuple(line(a, b) for a, b in pairwise(corners)), True)]
    corner_arcs = [
        _quarter(right - rx, y + ry, rx, ry, 3),
        _quarter(right - rx, bottom - ry, rx, ry, 0),
        _quarter(x + rx, bottom - ry, rx, ry, 1),
        _quarter(x + rx, y + ry, rx, ry, 2),
    ]
    segments: list[Segment] = []
    for k, corner in enumerate(corner_arcs):
        segments += [line(corner_arcs[k - 1].end, corner.start), corner]
    return [Subpath(tuple(segments), True)]


def parse_path(data: str) -> list[Subpath]:
    """Path data as subpaths, each with at least one segment. Raises SvgValueError."""
    subpaths: list[Subpath] = []
    segments: list[Segment] = []
    count = 0
    start = here = 0j
    handle: complex | None = None  # the last control point, for S after C or S, and for T after Q or T
    handle_kind = ""

    for command, values in _commands(data):
        kind = command.upper()
        base = here if command.islower() else 0j
        count += 1
        if count > MAX_POINTS:
            raise SvgValueError(f"the path has more than {MAX_POINTS:,} segments")
        if kind == "M" or kind == "Z":
            if kind == "Z" and here != start:
                segments.append(line((here.real, here.imag), (start.real, start.imag)))
            if segments:
                subpaths.append(Subpath(tuple(segments), kind == "Z"))
            segments = []
            start = here = start if kind == "Z" else base + complex(*values)
            handle_kind = ""
            continue
        new_handle: complex | None = None
        if kind == "L":
            end = base + complex(*values)
        elif kind == "H":
            end = complex(base.real + values[0], here.imag)
        elif kind == "V":
            end = complex(here.real, base.imag + values[0])
        else:
            end = base + complex(*values[-2:])
        if kind in "LHV":
            segments.append(line((here.real, here.imag), (end.real, end.imag)))
        elif kind in "CS":
            if kind == "C":
                first = base + complex(*values[:2])
            else:
                first = 2 * here - handle if handle_kind == "C" and handle is not None else here
            new_handle = base + complex(*values[-4:-2])
            segments.append(cubic([(p.real, p.imag) for p in (here, first, new_handle, end)]))
        elif kind in "QT":
            if kind == "Q":
                new_handle = base + complex(*values[:2])
            else:
                new_handle = 2 * here - handle if handle_kind == "Q" and handle is not None else here
            segments.append(quadratic(here, new_handle, end))
        else:
            segments.extend(_endpoint_arc(here, values, end))
        handle, handle_kind = new_handle, {"S": "C", "T": "Q"}.get(kind, kind)
        here = end
    if segments:
        subpaths.append(Subpath(tuple(segments), False))
    return subpaths


def _endpoint_arc(here: complex, values: list[float], end: complex) -> list[Segment]:
    rx, ry, rotation = abs(values[0]), abs(values[1]), values[2]
    if here == end:
        return []
    # SVG 1.1, appendix F.6.2: a radius of zero makes a line. So do radii that vanish in the arithmetic below.
    if min(rx, ry) <= 1e-12 * abs(end - here):
        return [line((here.real, here.imag), (end.real, end.imag))]
    try:
        drawn = svgelements.Arc(here, rx, ry, rotation, bool(values[3]), bool(values[4]), end)
        centre = (float(drawn.center.x), float(drawn.center.y))
        u = (float(drawn.prx.x) - centre[0], float(drawn.prx.y) - centre[1])
        v = (float(drawn.pry.x) - centre[0], float(drawn.pry.y) - centre[1])
    except (ArithmeticError, ValueError) as error:
        raise SvgValueError("an arc's numbers are out of range") from error
    determinant = u[0] * v[1] - u[1] * v[0]
    if not math.isfinite(determinant) or determinant <= 0.0:
        raise SvgValueError("an arc's numbers are out of range")

    def parameter(point: complex) -> float:
        dx, dy = point.real - centre[0], point.imag - centre[1]
        return math.atan2((u[0] * dy - u[1] * dx) / determinant, (dx * v[1] - dy * v[0]) / determinant)

    # From the two ends rather than svgelements' sweep, whose arc cosine loses half the digits of flat arcs.
    t0 = parameter(here)
    sweep = (parameter(end) - t0) % math.tau
    if not values[4]:
        sweep -= math.tau
    return [arc((here.real, here.imag), (end.real, end.imag), centre, u, v, t0, sweep)]


def _commands(data: str) -> Iterator[tuple[str, list[float]]]:
    """(command letter, its arguments), repeated commands written out. Raises SvgValueError."""
    position = _skip(data, 0)
    first = True
    while position < len(data):
        command = data[position]
        if command.upper() not in _ARGUMENTS:
            raise SvgValueError(f"the path data is not understood at {data[position : position + 20]!r}")
        if first and command not in "Mm":
            raise SvgValueError("the path data does not start with a move")
        first = False
        position = _skip(data, position + 1)
        wanted = _ARGUMENTS[command.upper()]
        if wanted == 0:
            yield command, []
            continue
        while True:
            values: list[float] = []
            for k in range(wanted):
                position, value = _argument(data, position, flag=command in "Aa" and k in (3, 4))
                values.append(value)
            yield command, values
            # More numbers after a move are lines.
            command = {"M": "L", "m": "l"}.get(command, command)
            if position >= len(data) or data[position].upper() in _ARGUMENTS:
                break


def _argument(data: str, position: int, flag: bool) -> tuple[int, float]:
    if flag:
        # Flags may be written without anything between them: "a1 1 0 01.5.5".
        if data[position : position + 1] not in ("0", "1"):
            raise SvgValueError(f"the path data is not understood at {data[position : position + 20]!r}")
        return _skip(data, position + 1), float(data[position])
    match = _NUMBER.match(data, position)
    if match is None:
        found = data[position : position + 20]
        if not found:
            raise SvgValueError("the path data ends in the middle of a command")
        raise SvgValueError(f"the path data is not understood at {found!r}")
    return _skip(data, match.end()), finite(match.group())


def _skip(data: str, position: int) -> int:
    match = _BLANK.match(data, position)
    return position if match is None else match.end()
