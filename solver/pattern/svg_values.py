"""Numbers, lengths and angles as SVG and CSS write them, and what a colour is."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

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

#: Unit -> the angle in radians; a number alone is in degrees.
ANGLES: dict[str, Callable[[float], float]] = {
    "deg": math.radians,
    "": math.radians,
    "rad": float,
    "grad": lambda value: value * math.pi / 200.0,
    "turn": lambda value: value * math.tau,
}
