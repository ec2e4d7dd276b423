"""Computed styles: what an element looks like after inheritance, var() and currentColor."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from .css_syntax import split_parts
from .svg_colours import SYSTEM_COLOURS, parse_paint
from .svg_css import MAX_KEPT, WIDE, Style, understood
from .svg_values import UNKNOWN_COLOUR, Colour, SvgValueError, parse_length

#: Properties handed down to children, with the values they start from (SVG 1.1, appendix N).
INHERITED = {
    "stroke": "none",
    "fill": "black",
    "color": "black",
    "visibility": "visible",
    "stroke-width": "1",
    "stroke-dasharray": "none",
    "stroke-opacity": "1",
    "fill-opacity": "1",
}
#: Characters that var() may make of one property, and how many var() are followed for it.
MAX_SUBSTITUTED = 10_000
_MAX_VAR = 50
#: Custom properties that are known at one place.
MAX_CUSTOM = 500
#: What a var() is that stands for nothing: no value of a property has this character.
_NOTHING = "\0"

_VAR = re.compile(r"\bvar\(", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Computed:
    """The look of an element, the same object for elements that look the same.

    stroke, fill    colours, None where nothing is painted; their own opacity is in them
    stroke_width    length as written
    stroke_opacity, fill_opacity, opacity   0 to 1, the last one of the element alone
    dashes          pixels, empty for a solid line
    declared        whether a stroke or a fill is said, here or around
    problems        what is not as it is written, one sentence each
    own             property -> value of what is not inherited, after var()
    """

    stroke: Colour | None
    fill: Colour | None
    stroke_width: str
    stroke_opacity: float
    fill_opacity: float
    opacity: float
    dashes: tuple[float, ...]
    visible: bool
    declared: bool
    problems: tuple[str, ...]
    own: Mapping[str, str]
    inherited: Mapping[str, str]
    custom: Mapping[str, str]


class Styler:
    """Makes computed styles, each kind once. Not reusable for another file."""

    def __init__(self) -> None:
        self._known: dict[tuple[Style, Computed], Computed] = {}
        self.initial = self._compute(Style({}, {}), {}, {})

    def compute(self, style: Style, parent: Computed) -> Computed:
        """The look of an element with ``style`` inside one that looks like ``parent``."""
        known = self._known.get((style, parent))
        if known is None:
            known = self._compute(style, parent.inherited, parent.custom)
            if len(self._known) > MAX_KEPT:
                self._known.clear()
            self._known[style, parent] = known
        return known

    def _compute(self, style: Style, inherited: Mapping[str, str], custom: Mapping[str, str]) -> Computed:
        own_custom = {name: value for name, value in style.values.items() if name.startswith("--")}
        if own_custom:
            custom = dict([*custom.items(), *own_custom.items()][-MAX_CUSTOM:])
        problems: list[str] = []
        unknown = dict(style.unknown)
        values: dict[str, str] = {}
        for name, value in style.values.items():
            if name.startswith("--"):
                continue
            if "(" in value and _VAR.search(value):
                replaced = _substitute(value, custom)
                if replaced is None or not understood(name, replaced):
                    unknown[name] = value
                    continue
                value = replaced
            values[name] = value
        given = dict(inherited)
        for name, initial in INHERITED.items():
            value = values.pop(name, "")
            word = value.lower()
            if word == "initial":
                given[name] = initial
            elif value and word not in WIDE:
                given[name] = value
            elif name in unknown and name in ("stroke", "fill") and name not in given:
                # Nobody else says how it is painted, and that it is painted is meant.
                given[name] = unknown[name]
        own = {name: value for name, value in values.items() if value.lower() not in WIDE}

        def number(name: str) -> float:
            return _share(own.get(name, "1") if name == "opacity" else given.get(name, "1"))

        def paint(name: str) -> Colour | None:
            text = given.get(name, INHERITED[name])
            try:
                colour = parse_paint(text, given.get("color", INHERITED["color"]))
            except SvgValueError as problem:
                problems.append(f"whose colour is not used: {problem}")
                return UNKNOWN_COLOUR
            if text.lower() in SYSTEM_COLOURS:
                problems.append(f"read as black: the colour {text!r} is whatever the screen's settings say")
            return colour

        return Computed(
            paint("stroke"),
            paint("fill"),
            given.get("stroke-width", INHERITED["stroke-width"]),
            number("stroke-opacity"),
            number("fill-opacity"),
            number("opacity"),
            _dashes(given.get("stroke-dasharray", INHERITED["stroke-dasharray"])),
            given.get("visibility", "visible").lower() == "visible",
            "stroke" in given or "fill" in given,
            tuple(problems),
            own,
            given,
            custom,
        )


def _substitute(text: str, custom: Mapping[str, str]) -> str | None:
    """``text`` with what its var() stand for, None when one of them stands for nothing (CSS Variables 1)."""
    for _ in range(_MAX_VAR):
        found = [match.span() for match in _VAR.finditer(text)]
        if not found:
            return None if _NOTHING in text else text.strip()
        # The last one first: there is none in its brackets.
        start, inside = found[-1]
        end, depth = inside, 1
        while end < len(text) and depth:
            depth += (text[end] == "(") - (text[end] == ")")
            end += 1
        name, *fallback = split_parts(text[inside : end - (depth == 0)], ",")
        value = custom.get(name.strip())
        if value is None:
            value = ",".join(fallback) if fallback else _NOTHING
        text = text[:start] + value + text[end:]
        if len(text) > MAX_SUBSTITUTED:
            return None
    return None


def _dashes(text: str) -> tuple[float, ...]:
    if text.strip().lower() in ("", "none"):
        return ()
    try:
        lengths = [parse_length(part) for part in text.replace(",", " ").split(None, 32)[:32]]
    except SvgValueError:
        return ()
    values = tuple(length.pixels for length in lengths)
    # SVG 1.1, section 11.4: nothing but zeros, or anything negative, is a solid line.
    return values if values and min(values) >= 0.0 and sum(values) > 0.0 else ()


def _share(text: str) -> float:
    try:
        length = parse_length(text)
    except SvgValueError:
        return 1.0
    return min(max(length.resolve(1.0), 0.0), 1.0)
