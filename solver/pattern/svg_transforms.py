"""Transforms of SVG's attribute and of CSS's properties as (3,3) matrices."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

import numpy as np

from ..arrays import FloatArray
from .svg_values import ANGLES, NUMBER, SvgValueError, finite, parse_length

_SEPARATOR = re.compile(r"[\s,]*")
_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)")
_CSS_FUNCTION = re.compile(r"\s*([A-Za-z0-9]+)\(([^()]*)\)")
_ARGUMENT = re.compile(rf"({NUMBER})(%|[A-Za-z]*)[\s,]*")
#: Function -> the numbers of arguments it may have (SVG 1.1, section 7.6).
_TRANSFORMS = {
    "matrix": (6,),
    "translate": (1, 2),
    "translatex": (1,),
    "translatey": (1,),
    "scale": (1, 2),
    "scalex": (1,),
    "scaley": (1,),
    "rotate": (1, 3),
    "skewx": (1,),
    "skewy": (1,),
}
#: The same of CSS Transforms 1 and 2, as far as they stay in the plane.
_CSS_TRANSFORMS = {**_TRANSFORMS, "rotate": (1,), "rotatez": (1,), "skew": (1, 2)}
_TURNS = frozenset({"rotate", "rotatez", "skew", "skewx", "skewy"})
#: Transform functions in one attribute; real ones have a handful.
MAX_TRANSFORMS = 100

#: Words of transform-origin: which axis (0 is x), and the share of the box.
_PLACES = {"left": (0, 0.0), "right": (0, 1.0), "top": (1, 0.0), "bottom": (1, 1.0)}


#: a, b, c, d, e, f of SVG's matrix().
_Affine = tuple[float, ...]
#: From a function's name and what is in its brackets to its arguments as numbers.
_Values = Callable[[str, str], list[float]]
_IDENTITY: _Affine = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


def parse_transform(text: str) -> FloatArray:
    """(3,3) matrix of the transform attribute. Raises SvgValueError."""
    return _matrix(*_product(text, _FUNCTION, _svg_values))


def css_transform(text: str, width: float = 1.0, height: float = 1.0) -> FloatArray:
    """(3,3) matrix of the transform property, in a box of the given size. Raises SvgValueError."""
    box = (width, height)
    return _matrix(*_product(text, _CSS_FUNCTION, lambda name, inside: _css_values(name, inside, box)))


def css_translate(text: str, width: float = 1.0, height: float = 1.0) -> FloatArray:
    """(3,3) matrix of the translate property: one or two lengths, or percentages of the box."""
    return css_transform(f"translate({','.join(_words(text, 2))})", width, height)


def css_rotate(text: str) -> FloatArray:
    """(3,3) matrix of the rotate property: an angle, about z."""
    words = _words(text, 2)
    return css_transform(f"rotate({words[-1] if words[0].lower() == 'z' or len(words) == 1 else ''})")


def css_scale(text: str) -> FloatArray:
    """(3,3) matrix of the scale property: one or two factors."""
    return css_transform(f"scale({','.join(_words(text, 2))})")


def css_origin(text: str, box: Sequence[float]) -> tuple[float, float]:
    """The point of transform-origin in ``box`` (x, y, width, height). Raises SvgValueError."""
    words = [word.lower() for word in _words(text, 3)[:2]]  # the third one is z
    named = [word in _PLACES or word == "center" for word in words]
    # Two words may come in either order, a word and a length may not: "top left", but not "top 20px".
    if all(named) and any(_PLACES.get(word, (k, 0.0))[0] != k for k, word in enumerate(words)):
        words = [*words, "center"][:2][::-1]
    places = [0.5 * box[2], 0.5 * box[3]]
    for axis, word in enumerate(words):
        if word in _PLACES and _PLACES[word][0] != axis:
            raise SvgValueError(f"{text[:40]!r} is not an origin")
        share = 0.5 if word == "center" else _PLACES[word][1] if word in _PLACES else None
        whole = box[axis + 2]
        places[axis] = parse_length(word).resolve(whole) if share is None else share * whole
    return box[0] + places[0], box[1] + places[1]


def about(matrix: FloatArray, x: float, y: float) -> FloatArray:
    """``matrix`` with (x, y) in place of the origin."""
    if x == y == 0.0:
        return matrix
    there, back = np.eye(3), np.eye(3)
    there[:2, 2], back[:2, 2] = (x, y), (-x, -y)
    return np.asarray(there @ matrix @ back)


def _words(text: str, limit: int) -> list[str]:
    words = text.split()
    if not 1 <= len(words) <= limit:
        raise SvgValueError(f"{text[:40]!r} is not a transform")
    return words


def _matrix(a: float, b: float, c: float, d: float, e: float, f: float) -> FloatArray:
    return np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])


def _product(text: str, function: re.Pattern[str], values: _Values) -> _Affine:
    """All functions in ``text``, the first one outermost. Raises SvgValueError."""
    text = text.strip()
    result = _IDENTITY
    if text.lower() in ("", "none"):
        return result
    position = count = 0
    while position < len(text):
        match = function.match(text, position)
        count += 1
        if match is None or count > MAX_TRANSFORMS:
            raise SvgValueError(f"{text[position : position + 30]!r} is not a transform")
        name, arguments = match.groups()
        result = _times(result, _affine(name.lower(), values(name, arguments)))
        position = match.end()
    if not all(map(math.isfinite, result)):
        raise SvgValueError("the transform is not finite")
    return result


def _times(m: _Affine, n: _Affine) -> _Affine:
    return (
        m[0] * n[0] + m[2] * n[1],
        m[1] * n[0] + m[3] * n[1],
        m[0] * n[2] + m[2] * n[3],
        m[1] * n[2] + m[3] * n[3],
        m[0] * n[4] + m[2] * n[5] + m[4],
        m[1] * n[4] + m[3] * n[5] + m[5],
    )


def _affine(kind: str, values: list[float]) -> _Affine:
    """One function whose arguments are numbers, angles in radians."""
    first = values[0]
    second = values[1] if len(values) > 1 else None
    if kind == "matrix":
        return tuple(values)
    if kind.startswith("translate"):
        x, y = (0.0, first) if kind == "translatey" else (first, second or 0.0)
        return (1.0, 0.0, 0.0, 1.0, x, y)
    if kind.startswith("scale"):
        x = 1.0 if kind == "scaley" else first
        y = 1.0 if kind == "scalex" else first if second is None else second
        return (x, 0.0, 0.0, y, 0.0, 0.0)
    if kind.startswith("rotate"):
        cos, sin = _cos_sin(first)
        turn: _Affine = (cos, sin, -sin, cos, 0.0, 0.0)
        if len(values) == 3:
            x, y = values[1:]
            turn = _times(_times((1.0, 0.0, 0.0, 1.0, x, y), turn), (1.0, 0.0, 0.0, 1.0, -x, -y))
        return turn
    x, y = (0.0, first) if kind == "skewy" else (first, second or 0.0)
    return (1.0, math.tan(y), math.tan(x), 1.0, 0.0, 0.0)


def _cos_sin(angle: float) -> tuple[float, float]:
    """Exact for quarter turns, which otherwise leave 6e-17 where 0 is meant."""
    quarters = angle / (math.pi / 2)
    if quarters == round(quarters):
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarters) % 4]
    return math.cos(angle), math.sin(angle)


def _arguments(name: str, text: str, counts: Sequence[int]) -> list[tuple[str, str]]:
    """(number, unit) of each argument. Raises SvgValueError."""
    parts: list[tuple[str, str]] = []
    match = _SEPARATOR.match(text)
    position = match.end() if match else 0
    while match := _ARGUMENT.match(text, position):
        parts.append((match.group(1), match.group(2)))
        position = match.end()
    if position < len(text) or len(parts) not in counts:
        raise SvgValueError(f"{name}({text[:30]}) is not a transform")
    return parts


def _angle(number: str, unit: str) -> float:
    if unit.lower() not in ANGLES:
        raise SvgValueError(f"the unit {unit!r} is not an angle")
    return ANGLES[unit.lower()](finite(number))


def _svg_values(name: str, text: str) -> list[float]:
    """Arguments as the attribute has them: numbers, degrees and pixels."""
    kind = name.lower()
    parts = _arguments(name, text, _TRANSFORMS.get(kind, ()))
    values = [_angle(*parts[0])] if kind in _TURNS else []
    for number, unit in parts[len(values) :]:
        length = parse_length(number + unit)
        if length.percent:
            raise SvgValueError(f"{name}({text[:30]}) is not a transform")
        values.append(length.pixels)
    return values


def _css_values(name: str, text: str, box: tuple[float, float]) -> list[float]:
    """Arguments as CSS has them: lengths and angles have units unless they are 0, the other ones have none."""
    kind = name.lower()
    values: list[float] = []
    for k, (number, unit) in enumerate(_arguments(name, text, _CSS_TRANSFORMS.get(kind, ()))):
        value = finite(number)
        if kind in _TURNS:
            bad = not unit and value != 0.0
            values.append(_angle(number, unit))
        elif kind.startswith("translate"):
            bad = not unit and value != 0.0
            values.append(parse_length(number + unit).resolve(box[1 if kind == "translatey" else k]))
        else:
            bad = unit not in (("", "%") if kind.startswith("scale") else ("",))
            values.append(value / 100.0 if unit == "%" else value)
        if bad:
            raise SvgValueError(f"{name}({text[:30]}) is not a transform in CSS")
    return values
