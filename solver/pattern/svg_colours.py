"""Colours and paints as CSS writes them (CSS Color 4 and 5), in the end red, green and blue of sRGB.

Colours outside of sRGB are clipped channel by channel, as browsers show them on an ordinary screen.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np
import svgelements

from ..arrays import FloatArray
from .css_syntax import split_parts
from .svg_values import ANGLES, NUMBER, UNKNOWN_COLOUR, Colour, SvgValueError, finite

_HEX = re.compile(r"#([0-9a-f]{3}|[0-9a-f]{4}|[0-9a-f]{6}|[0-9a-f]{8})\Z")
_FUNCTION = re.compile(r"([a-z][-a-z0-9]*)\(")
_COMPONENT = re.compile(rf"({NUMBER})(%|[a-z]*)\Z")
#: Characters of one colour; real ones have at most a hundred.
MAX_COLOUR = 1_000

#: Colours that are whatever the reader's system is set to (CSS Color 4, section 6.2): for text and lines, black.
SYSTEM_COLOURS = frozenset(
    {"accentcolor", "accentcolortext", "activetext", "buttonborder", "buttonface", "buttontext"}
    | {"canvas", "canvastext", "field", "fieldtext", "graytext", "highlight", "highlighttext"}
    | {"linktext", "mark", "marktext", "selecteditem", "selecteditemtext", "visitedtext", "windowtext"}
    | {"window", "windowframe", "menu", "menutext", "infobackground", "infotext", "activecaption"}
    | {"captiontext"}
)


def parse_paint(text: str, current: str = "black") -> Colour | None:
    """The colour of a stroke or fill, None for ``none``.

    ``current`` is what ``currentColor`` stands for. A paint server (``url(#gradient) red``) counts as its
    fallback, black without one. Raises SvgValueError on a colour nobody knows.
    """
    word = text.strip().lower()
    if word.startswith("url("):
        fallback = word.partition(")")[2].strip()
        known = fallback not in ("", "none") and not fallback.startswith("url(")
        return parse_paint(fallback, current) if known else UNKNOWN_COLOUR
    if word in ("context-stroke", "context-fill"):
        return UNKNOWN_COLOUR
    if word in ("none", ""):
        return None
    colour = parse_colour(text, current)
    return None if colour == _TRANSPARENT else colour


#: Names that svgelements 1.9.6 does not know, or not well.
_CORRECTED = {"rebeccapurple": "#663399", "aliceblue": "#f0f8ff"}
_TRANSPARENT = Colour(0.0, 0.0, 0.0, 0.0)


def parse_colour(text: str, current: str = "black") -> Colour:
    """One colour. Raises SvgValueError on a colour nobody knows."""
    word = text.strip().lower()
    if word == "currentcolor":
        return UNKNOWN_COLOUR if current.strip().lower() == "currentcolor" else parse_colour(current)
    try:
        colour = _colour(word, current) if len(word) <= MAX_COLOUR else None
    except (ArithmeticError, ValueError):
        colour = None
    if colour is None or not all(map(math.isfinite, (colour.red, colour.green, colour.blue, colour.opacity))):
        raise SvgValueError(f"the colour {text.strip()[:40]!r} is not known")
    return colour


def _colour(word: str, current: str) -> Colour | None:
    if match := _HEX.match(word):
        digits = match.group(1)
        if len(digits) <= 4:
            digits = "".join(2 * digit for digit in digits)
        values = [int(digits[k : k + 2], 16) / 255.0 for k in range(0, len(digits), 2)]
        return Colour(*values[:3], *values[3:4])
    if word.isalpha():
        return _named(word)
    # SVG 1.1, section 11.2, and SVG 2: the colour of a screen, and the same one for a printing press after it.
    for press in ("icc-color(", "device-cmyk("):
        before, found, _ = word.partition(press)
        if found and before.strip():
            return _colour(before.strip(), current) if word.endswith(")") else None
    match = _FUNCTION.match(word)
    if match is None or not word.endswith(")"):
        return None
    return _of_function(match.group(1), word[match.end() : -1], current)


def _named(word: str) -> Colour | None:
    if word == "transparent":
        return _TRANSPARENT
    if word in SYSTEM_COLOURS:
        return UNKNOWN_COLOUR
    if word in _CORRECTED:
        return _colour(_CORRECTED[word], word)
    # svgelements answers opaque black to unknown words, so black itself is asked for by name.
    named = svgelements.Color(word if len(word) < 40 else "black")
    if named.value is None or (named == "black" and word != "black"):
        return None
    return Colour(named.red / 255.0, named.green / 255.0, named.blue / 255.0)


def _of_function(name: str, inside: str, current: str) -> Colour | None:
    parts = [part.strip() for part in split_parts(inside, ",")]
    if name == "light-dark":
        return parse_colour(parts[0], current) if len(parts) == 2 else None
    if name == "device-cmyk":
        if len(parts) == 5:  # CMYK with commas
            parts = [" ".join(parts[:4]), parts[4]] if "(" in parts[4] or "#" in parts[4] else [" ".join(parts[:4])]
        elif len(parts) == 4:
            parts = [" ".join(parts)]
        return parse_colour(parts[1], current) if len(parts) == 2 else _from_cmyk(parts[0])
    legacy = len(parts) > 1
    if legacy:
        if name not in ("rgb", "rgba", "hsl", "hsla") or len(parts) not in (3, 4):
            return None
        words, alpha = parts[:3], parts[3:]
    else:
        body, slash, after = inside.partition("/")
        words, alpha = body.split(), [after.strip()] if slash else []
    if name == "color":
        space, words = (words[0], words[1:]) if words else ("", [])
        name = space if space in _PRIMARIES or space in _XYZ_SPACES else ""
    if len(words) != 3 or name not in _RANGES:
        return None
    ranges = _RANGES[name]
    values = [_component(word, whole) for word, whole in zip(words, ranges, strict=True)]
    opacity = _component(alpha[0], 1.0) if alpha else 1.0
    if opacity is None or None in values:
        return None
    numbers = [value for value in values if value is not None]
    with np.errstate(over="ignore", invalid="ignore"):
        red, green, blue = (_unit(value) for value in _to_srgb(name, numbers))
    return Colour(red, green, blue, _unit(opacity))


#: What 100 % is in each component; 0 stands for an angle (CSS Color 4, sections 5, 7, 8, 9 and 10).
_RANGES: dict[str, tuple[float, float, float]] = {
    **dict.fromkeys(("rgb", "rgba"), (255.0, 255.0, 255.0)),
    **dict.fromkeys(("hsl", "hsla", "hwb"), (0.0, 100.0, 100.0)),
    "lab": (100.0, 125.0, 125.0),
    "lch": (100.0, 150.0, 0.0),
    "oklab": (1.0, 0.4, 0.4),
    "oklch": (1.0, 0.4, 0.0),
}


def _component(word: str, whole: float) -> float | None:
    """One number of a colour, None when it is none; the keyword ``none`` is 0."""
    if word == "none":
        return 0.0
    match = _COMPONENT.match(word)
    if match is None:
        return None
    number, unit = finite(match.group(1)), match.group(2)
    if whole == 0.0:
        return math.degrees(ANGLES[unit](number)) if unit in ANGLES else None
    if unit == "%":
        return number * whole / 100.0
    return number if unit == "" else None


def _to_srgb(name: str, values: Sequence[float]) -> Sequence[float]:
    a, b, c = values
    if name in ("rgb", "rgba"):
        return [value / 255.0 for value in values]
    if name in ("hsl", "hsla"):
        return _from_hsl(a, max(b, 0.0) / 100.0, c / 100.0)
    if name == "hwb":
        white, black = max(b, 0.0) / 100.0, max(c, 0.0) / 100.0
        if white + black >= 1.0:
            return [white / (white + black)] * 3
        return [value * (1.0 - white - black) + white for value in _from_hsl(a, 1.0, 0.5)]
    if name in ("lch", "oklch"):
        b, c = b * math.cos(math.radians(c)), b * math.sin(math.radians(c))
    if name in ("lab", "lch"):
        return _from_xyz(_D50_TO_D65 @ _lab_to_xyz(a, b, c))
    if name in ("oklab", "oklch"):
        return _from_xyz(_OKLAB_TO_XYZ @ (_OKLAB_TO_CONES @ [a, b, c]) ** 3)
    if name == "srgb":
        return values
    if name in _XYZ_SPACES:
        return _from_xyz(np.array(values) if name != "xyz-d50" else _D50_TO_D65 @ values)
    linear = np.array([_linear(name, value) for value in values])
    if name == "srgb-linear":
        return [_srgb_curve(value) for value in linear]
    xyz = _PRIMARIES[name] @ linear
    return _from_xyz(_D50_TO_D65 @ xyz if name == "prophoto-rgb" else xyz)


def _from_hsl(hue: float, saturation: float, lightness: float) -> list[float]:
    """CSS Color 4, section 7.1. Hue in degrees, the others from 0 to 1."""

    def channel(n: float) -> float:
        k = (n + hue / 30.0) % 12.0
        return lightness - saturation * min(lightness, 1.0 - lightness) * max(-1.0, min(k - 3.0, 9.0 - k, 1.0))

    return [channel(0.0), channel(8.0), channel(4.0)]


def _from_cmyk(inside: str) -> Colour | None:
    """CSS Color 5, section 10.3: without a profile of the press, by subtraction."""
    body, slash, after = inside.partition("/")
    values = [_component(word, 1.0) for word in body.split()]
    opacity = _component(after.strip(), 1.0) if slash else 1.0
    inks = [_unit(value) for value in values if value is not None]
    if len(values) != 4 or len(inks) != 4 or opacity is None:
        return None
    red, green, blue = (1.0 - min(1.0, ink * (1.0 - inks[3]) + inks[3]) for ink in inks[:3])
    return Colour(red, green, blue, _unit(opacity))


def _linear(space: str, value: float) -> float:
    """Light in proportion to it, from a component of ``space`` (CSS Color 4, section 10)."""
    size = abs(value)
    if space in ("srgb", "display-p3"):
        light = size / 12.92 if size <= 0.04045 else ((size + 0.055) / 1.055) ** 2.4
    elif space == "a98-rgb":
        light = size ** (563.0 / 256.0)
    elif space == "prophoto-rgb":
        light = size / 16.0 if size <= 16.0 / 512.0 else size**1.8
    elif space == "rec2020":
        low, slope = 0.018053968510807, 1.09929682680944
        light = size / 4.5 if size < 4.5 * low else ((size + slope - 1.0) / slope) ** (1.0 / 0.45)
    else:
        light = size
    return math.copysign(light, value)


def _srgb_curve(light: float) -> float:
    size = abs(light)
    value = 12.92 * size if size <= 0.0031308 else 1.055 * size ** (1.0 / 2.4) - 0.055
    return math.copysign(value, light)


def _from_xyz(xyz: FloatArray) -> list[float]:
    return [_srgb_curve(float(light)) for light in _XYZ_TO_SRGB @ xyz]


def _lab_to_xyz(lightness: float, a: float, b: float) -> FloatArray:
    """XYZ under D50 (CIE 15:2004)."""
    kappa, epsilon = 24389.0 / 27.0, 216.0 / 24389.0
    y = (lightness + 16.0) / 116.0
    cubes = [value**3 for value in (y + a / 500.0, y, y - b / 200.0)]
    roots = (y + a / 500.0, y, y - b / 200.0)
    parts = [
        cube if cube > epsilon else (116.0 * root - 16.0) / kappa for cube, root in zip(cubes, roots, strict=True)
    ]
    return np.array(parts) * _white(*_D50)


def _white(x: float, y: float) -> FloatArray:
    return np.array([x / y, 1.0, (1.0 - x - y) / y])


def _rgb_to_xyz(white: tuple[float, float], *corners: tuple[float, float]) -> FloatArray:
    """(3,3) from linear red, green and blue to XYZ; the ``corners`` are scaled so that their sum is white."""
    columns = np.column_stack([_white(*corner) for corner in corners])
    return np.asarray(columns * np.linalg.solve(columns, _white(*white)))


#: Chromaticities of the white points (CSS Color 4, section 10.9) and of the corners of each space.
_D65, _D50 = (0.3127, 0.3290), (0.3457, 0.3585)
_SRGB = _rgb_to_xyz(_D65, (0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
_XYZ_TO_SRGB: FloatArray = np.linalg.inv(_SRGB)
_PRIMARIES: dict[str, FloatArray] = {
    "srgb": _SRGB,
    "srgb-linear": _SRGB,
    "display-p3": _rgb_to_xyz(_D65, (0.680, 0.320), (0.265, 0.690), (0.150, 0.060)),
    "a98-rgb": _rgb_to_xyz(_D65, (0.64, 0.33), (0.21, 0.71), (0.15, 0.06)),
    "prophoto-rgb": _rgb_to_xyz(_D50, (0.734699, 0.265301), (0.159597, 0.840403), (0.036598, 0.000105)),
    "rec2020": _rgb_to_xyz(_D65, (0.708, 0.292), (0.170, 0.797), (0.131, 0.046)),
}
_XYZ_SPACES = frozenset({"xyz", "xyz-d50", "xyz-d65"})
_RANGES |= dict.fromkeys((*_PRIMARIES, *_XYZ_SPACES), (1.0, 1.0, 1.0))

#: Bradford's cone responses, in which white points are adapted.
_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
_D50_TO_D65: FloatArray = np.linalg.solve(
    _BRADFORD, np.diag((_BRADFORD @ _white(*_D65)) / (_BRADFORD @ _white(*_D50))) @ _BRADFORD
)
#: Oklab (B. Ottosson, 2020): from L, a, b to the cube roots of the cones' responses, and from these to XYZ.
_OKLAB_TO_CONES: FloatArray = np.linalg.inv(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
_OKLAB_TO_XYZ: FloatArray = np.linalg.inv(
    [
        [0.8189330101, 0.3618667424, -0.1288597137],
        [0.0329845436, 0.9293118715, 0.0361456387],
        [0.0482003018, 0.2643662691, 0.6338517070],
    ]
)


def _unit(value: float) -> float:
    return min(max(value, 0.0), 1.0)
