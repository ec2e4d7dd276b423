"""Numbers, lengths, colours and transforms as SVG writes them.

svgelements knows the colour names and the transform functions. It reads what it does not know as black or as
nothing, so everything is checked here before it is asked.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import svgelements

from ..arrays import FloatArray

#: CSS pixels in one unit (CSS Values 3, section 6.2): an inch is 96 px, whatever the screen.
PIXELS = {
    "mm": 96.0 / 25.4,
    "cm": 96.0 / 2.54,
    "q": 96.0 / 101.6,
    "in": 96.0,
    "pt": 96.0 / 72.0,
    "pc": 16.0,
}
#: Units that depend on a font nobody drew with; CSS's initial font size is 16 px.
_FONT_PIXELS = {"em": 16.0, "rem": 16.0, "ex": 8.0, "ch": 8.0}

MM_PER_PIXEL = 25.4 / 96.0

#: Written so that no run of digits can be split in two ways: matching takes linear time.
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?"
#: Characters of one number or length.
MAX_NUMBER = 400
_NUMBER = re.compile(NUMBER)
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([A-Za-z]*|%)\s*\Z")
_SEPARATOR = re.compile(r"[\s,]*")
_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)")
_ARGUMENT = re.compile(rf"({NUMBER})([A-Za-z]*)[\s,]*")
_HEX = re.compile(r"#([0-9a-fA-F]{3}|[0-9a-fA-F]{4}|[0-9a-fA-F]{6}|[0-9a-fA-F]{8})\Z")
_COLOUR_FUNCTION = re.compile(r"(rgb|rgba|hsl|hsla)\(([^()]*)\)\Z")
_COLOUR_ARGUMENT = re.compile(rf"({NUMBER})(%|deg)?")


class SvgValueError(ValueError):
    """What is wrong with one attribute, for a sentence."""


@dataclass(frozen=True)
class Length:
    """A number with its unit, in CSS pixels; ``percent`` when it is a share of the viewport instead."""

    pixels: float
    percent: bool
    unit: str

    def resolve(self, whole: float) -> float:
        """Pixels, where 100 % is ``whole``."""
        return self.pixels * whole / 100.0 if self.percent else self.pixels

    @property
    def absolute(self) -> bool:
        """Whether the unit is one of paper (mm, cm, in, pt, pc, Q)."""
        return self.unit in PIXELS


def finite(text: str) -> float:
    """``text`` as a finite number. Raises SvgValueError."""
    try:
        value = float(text) if len(text) <= MAX_NUMBER else math.nan
    except ValueError as error:
        raise SvgValueError(f"{text[:40]!r} is not a number") from error
    if not math.isfinite(value):
        raise SvgValueError(f"the number {text[:40]!r} is not finite")
    return value


def parse_length(text: str) -> Length:
    """``"10mm"`` -> 37.8 pixels. Raises SvgValueError on rubbish and unknown units."""
    match = _LENGTH.match(text) if len(text) <= MAX_NUMBER else None
    if match is None:
        raise SvgValueError(f"{text.strip()[:40]!r} is not a length")
    value, unit = finite(match.group(1)), match.group(2).lower()
    if unit == "%":
        return Length(value, True, unit)
    scale = PIXELS.get(unit, _FONT_PIXELS.get(unit, 1.0 if unit in ("", "px") else 0.0))
    if scale == 0.0:
        raise SvgValueError(f"the unit {match.group(2)!r} is not supported")
    return Length(value * scale, False, unit)


def parse_numbers(text: str, limit: int) -> list[float]:
    """At most ``limit`` numbers between blanks and commas. Raises SvgValueError on anything else."""
    values: list[float] = []
    position = _end(_SEPARATOR, text, 0)
    while position < len(text):
        match = _NUMBER.match(text, position)
        if match is None:
            raise SvgValueError(f"{text[position : position + 20]!r} is not a number")
        values.append(finite(match.group()))
        if len(values) > limit:
            raise SvgValueError(f"there are more than {limit:,} numbers")
        position = _end(_SEPARATOR, text, match.end())
    return values


def _end(pattern: re.Pattern[str], text: str, position: int) -> int:
    match = pattern.match(text, position)
    return position if match is None else match.end()


@dataclass(frozen=True)
class Colour:
    """Red, green, blue and opacity, each from 0 to 1."""

    red: float
    green: float
    blue: float
    opacity: float = 1.0

    @property
    def hex(self) -> str:
        return "#" + "".join(f"{round(255 * value):02x}" for value in (self.red, self.green, self.blue))

    @property
    def chroma(self) -> float:
        """Distance from grey, 0 to 1."""
        return max(self.red, self.green, self.blue) - min(self.red, self.green, self.blue)

    @property
    def lightness(self) -> float:
        return 0.5 * (max(self.red, self.green, self.blue) + min(self.red, self.green, self.blue))

    @property
    def hue(self) -> float:
        """Degrees on the colour wheel: red 0, yellow 60, green 120, blue 240, magenta 300; 0 for greys."""
        if self.chroma == 0.0:
            return 0.0
        if self.red == max(self.red, self.green, self.blue):
            sixth = (self.green - self.blue) / self.chroma
        elif self.green == max(self.red, self.green, self.blue):
            sixth = 2.0 + (self.blue - self.red) / self.chroma
        else:
            sixth = 4.0 + (self.red - self.green) / self.chroma
        return (60.0 * sixth) % 360.0


#: A paint that is there but has no colour of its own to read: gradients, patterns, unknown words.
UNKNOWN_COLOUR = Colour(0.0, 0.0, 0.0)


def parse_paint(text: str, current: str) -> Colour | None:
    """The colour of a stroke or fill, None for ``none``.

    ``current`` is what ``currentColor`` stands for. A paint server (``url(#gradient) red``) counts as its
    fallback, black without one. Raises SvgValueError on a colour nobody knows.
    """
    word = text.strip().lower()
    if word.startswith("url("):
        fallback = word.partition(")")[2].strip()
        known = fallback and not fallback.startswith("url(")
        return parse_paint(fallback, current) if known else UNKNOWN_COLOUR
    if word in ("context-stroke", "context-fill"):
        return UNKNOWN_COLOUR
    if word == "currentcolor":
        return UNKNOWN_COLOUR if current.strip().lower() == "currentcolor" else parse_paint(current, "black")
    if word in ("none", "transparent", ""):
        return None
    if match := _HEX.match(word):
        digits = match.group(1)
        if len(digits) <= 4:
            digits = "".join(2 * digit for digit in digits)
        values = [int(digits[k : k + 2], 16) / 255.0 for k in range(0, len(digits), 2)]
        return Colour(*values[:3], *values[3:4])
    if match := _COLOUR_FUNCTION.match(word):
        return _colour_function(match.group(1)[:3], match.group(2), text)
    # svgelements answers opaque black to unknown words, so black itself is asked for by name.
    named = svgelements.Color(word if word.isalpha() and len(word) < 40 else "black")
    if named.value is None or (named == "black" and word != "black"):
        raise SvgValueError(f"the colour {text.strip()[:40]!r} is not known")
    return Colour(named.red / 255.0, named.green / 255.0, named.blue / 255.0)


def _colour_function(kind: str, arguments: str, text: str) -> Colour:
    parts = _COLOUR_ARGUMENT.findall(arguments)
    if len(parts) not in (3, 4):
        raise SvgValueError(f"the colour {text.strip()[:40]!r} is not known")
    numbers = [finite(number) / (100.0 if unit == "%" else 1.0) for number, unit in parts]
    opacity = _unit(numbers[3]) if len(numbers) == 4 else 1.0
    if kind == "rgb":
        red, green, blue = (
            _unit(value if unit == "%" else value / 255.0)
            for value, (_, unit) in zip(numbers[:3], parts[:3], strict=True)
        )
        return Colour(red, green, blue, opacity)
    hue, saturation, lightness = numbers[0] / 360.0, _unit(numbers[1]), _unit(numbers[2])
    # CSS Color 3, section 4.2.4.
    high = lightness * (1 + saturation) if lightness <= 0.5 else lightness + saturation * (1 - lightness)
    low = 2 * lightness - high
    red, green, blue = (_hsl_channel(low, high, hue + shift) for shift in (1 / 3, 0.0, -1 / 3))
    return Colour(red, green, blue, opacity)


def _hsl_channel(low: float, high: float, hue: float) -> float:
    hue %= 1.0
    if hue < 1 / 6:
        return low + (high - low) * 6 * hue
    if hue < 1 / 2:
        return high
    if hue < 2 / 3:
        return low + (high - low) * (2 / 3 - hue) * 6
    return low


def _unit(value: float) -> float:
    return min(max(value, 0.0), 1.0)


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
_ANGLES: dict[str, Callable[[float], float]] = {
    "deg": math.radians,
    "": math.radians,
    "rad": float,
    "grad": lambda value: value * math.pi / 200.0,
    "turn": lambda value: value * math.tau,
}
#: Transform functions in one attribute; real ones have a handful.
MAX_TRANSFORMS = 100


def parse_transform(text: str) -> FloatArray:
    """(3,3) matrix of a transform list. Raises SvgValueError."""
    result = np.eye(3)
    if text.strip().lower() in ("", "none"):
        return result
    position = count = 0
    text = text.strip()
    while position < len(text):
        match = _FUNCTION.match(text, position)
        count += 1
        if match is None or count > MAX_TRANSFORMS:
            raise SvgValueError(f"{text[position : position + 30]!r} is not a transform")
        with np.errstate(over="ignore", invalid="ignore"):
            result = result @ _transform(match.group(1), match.group(2))
        position = match.end()
    if not np.isfinite(result).all():
        raise SvgValueError("the transform is not finite")
    return result


def _transform(name: str, arguments: str) -> FloatArray:
    kind = name.lower()
    parts: list[tuple[str, str]] = []
    position = _end(_SEPARATOR, arguments, 0)
    while match := _ARGUMENT.match(arguments, position):
        parts.append((match.group(1), match.group(2)))
        position = match.end()
    if position < len(arguments) or len(parts) not in _TRANSFORMS.get(kind, ()):
        raise SvgValueError(f"{name}({arguments[:30]}) is not a transform")
    if kind in ("rotate", "skewx", "skewy"):
        unit = parts[0][1].lower()
        if unit not in _ANGLES:
            raise SvgValueError(f"the unit {parts[0][1]!r} is not an angle")
        # Radians into svgelements: a bare number is degrees there, and so are these after the division.
        angle = math.degrees(_ANGLES[unit](finite(parts[0][0])))
        values = [angle] + [parse_length(number + unit).pixels for number, unit in parts[1:]]
    else:
        values = [parse_length(number + unit).pixels for number, unit in parts]
    call = f"{kind}({','.join(repr(value) for value in values)})"
    matrix = svgelements.Matrix(call)
    return np.array([[matrix.a, matrix.c, matrix.e], [matrix.b, matrix.d, matrix.f], [0.0, 0.0, 1.0]])
