"""Profiles: how a plan is drawn for a machine or a hand, as small TOML files that users copy and change."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any

from ..errors import DescriptionError
from .data import Kind

#: Where the profiles of the house are.
FOLDER = Path(__file__).parent / "profiles"
_SUFFIX = ".toml"
#: A profile of more bytes is none.
_MAX_BYTES = 100_000
#: Sizes of paper, mm.
PAPERS = {
    "A5": (148.0, 210.0),
    "A4": (210.0, 297.0),
    "A3": (297.0, 420.0),
    "Letter": (215.9, 279.4),
    "Legal": (215.9, 355.6),
    "Tabloid": (279.4, 431.8),
}
FACES = ("front", "back", "both")
PAGES = ("one", "front-and-back", "tiles")
#: Types of processing steps in the group "Structural" of ISO 19593-1.
STEPS = (
    "Cutting", "PartialCutting", "ReversePartialCutting", "Creasing", "ReverseCreasing", "CuttingCreasing",
    "ReverseCuttingCreasing", "PartialCuttingCreasing", "ReversePartialCuttingCreasing", "Drilling", "Gluing",
    "Perforating", "Folding", "Punching",
)  # fmt: skip
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")
_LONGEST = 1000.0


@dataclass(frozen=True)
class Layer:
    """Lines that are done in one go.

    name           of the layer in the file
    kinds          of lines that are drawn in it
    colour         "#rrggbb"
    width_mm       of its lines
    dash_mm        dash and gap, or dash, gap, dot and gap; none: whole lines
    end_margin_mm  what stays free at ends of creases, where they meet, and at the border
    face           of the sheet on which it is done: front, back or both
    spot           name of its spot colour in PDF; none: a colour of the screen
    spot_cmyk      what stands for the spot colour on screens, parts of 1
    step           type of its processing step in PDF (ISO 19593-1)
    """

    name: str
    kinds: tuple[Kind, ...]
    colour: str = "#000000"
    width_mm: float = 0.1
    dash_mm: tuple[float, ...] = ()
    end_margin_mm: float = 0.0
    face: str = "front"
    spot: str = ""
    spot_cmyk: tuple[float, ...] = (0.0, 0.0, 0.0, 1.0)
    step: str = ""


@dataclass(frozen=True)
class Profile:
    """about: a sentence for people; pages: one of PAGES; registration: whether marks align faces and pages.

    page_margin_mm is around the sheet on one page, and around the paper's edge on tiles. groove_passes: lines from
    edge to edge of a groove; 2 are its edges alone. least_bend_radius: of board, in thicknesses.
    """

    name: str
    about: str
    layers: tuple[Layer, ...]
    tolerance_mm: float = 0.02
    page_margin_mm: float = 10.0
    pages: str = "one"
    registration: bool = False
    tile: str = "A4"
    tile_overlap_mm: float = 10.0
    groove_passes: int = 2
    least_bend_radius: float = 10.0

    @property
    def grooves(self) -> bool:
        """Whether it is for board of a thickness."""
        return self.draws(Kind.GROOVE)

    def draws(self, kind: Kind) -> bool:
        return any(kind in layer.kinds for layer in self.layers)


def profile_names() -> tuple[str, ...]:
    """The profiles of the house."""
    return tuple(sorted(path.stem for path in FOLDER.glob(f"*{_SUFFIX}")))


def read_profile(name: str | Path) -> Profile:
    """A profile of the house by its name, or a file. Raises DescriptionError, one sentence with the place."""
    names = profile_names()
    if str(name) in names:
        return _read(FOLDER / f"{name}{_SUFFIX}")
    path = Path(name)
    if path.suffix.lower() != _SUFFIX:
        near = _nearest(str(name), names)
        raise DescriptionError(
            f"there is no profile {str(name)!r}{near}; profiles are {', '.join(names)}, or a file *.toml"
        )
    return _read(path)


def _read(path: Path) -> Profile:
    try:
        if path.stat().st_size > _MAX_BYTES:
            raise DescriptionError("the file is too large for a profile", file=str(path))
        content = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
        return profile_of(content, path.stem)
    except OSError as error:
        raise DescriptionError(f"the profile cannot be read ({error.strerror})", file=str(path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise DescriptionError(f"the profile is not valid TOML ({error})", file=str(path)) from None
    except DescriptionError as error:
        raise (error if error.where.file else error.in_file(str(path))) from None


def profile_of(content: Mapping[str, Any], name: str) -> Profile:
    """A profile from what a TOML file holds. Raises DescriptionError naming the setting."""
    values = _checked(content, Profile, {"name"}, {"layers": "layer"}, "the profile")
    rows = values.pop("layers")
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise DescriptionError("a profile needs layers, each below a line [[layer]]", element="layer")
    layers = []
    for number, row in enumerate(rows, 1):
        label = f"layer {number}" + (f" ({row['name']})" if isinstance(row.get("name"), str) else "")
        layers.append(_layer(_checked(row, Layer, set(), {}, label), label))
    if len({layer.name for layer in layers}) < len(layers):
        raise DescriptionError("two layers have one name", element="layer")
    for key, rule in _PROFILE_RULES.items():
        if key in values:
            values[key] = rule(values[key], key)
    values["about"] = _text(values["about"], "about")
    return Profile(name=name, layers=tuple(layers), **values)


def _layer(values: dict[str, Any], label: str) -> Layer:
    for key, value in values.items():
        values[key] = _LAYER_RULES[key](value, f"{label}, {key}")
    return Layer(**values)


def _checked(
    content: Mapping[str, Any], kind: type, without: set[str], called: dict[str, str], where: str
) -> dict[str, Any]:
    """The settings by the names of the fields. called: names of fields that have another one in the file."""
    known = {called.get(entry.name, entry.name): entry for entry in fields(kind) if entry.name not in without}
    for key in content:
        if key not in known:
            raise DescriptionError(f"{where} has an unknown key {key!r}{_nearest(key, known)}", element=str(key))
    for key, entry in known.items():
        if key not in content and entry.default is MISSING and entry.default_factory is MISSING:
            raise DescriptionError(f"{where} lacks the key {key!r}", element=key)
    return {known[key].name: value for key, value in content.items()}


def _nearest(word: str, known: Sequence[str] | Mapping[str, Any]) -> str:
    """ ", the nearest known one is 'x'" for what is meant by a wrong word."""
    near = difflib.get_close_matches(word.lower(), list(known), 1, 0.0)
    return f", the nearest known one is {near[0]!r}" if near else ""


# ---- what settings may be


def _text(value: Any, element: str) -> str:
    if not isinstance(value, str) or not value.strip():
        raise DescriptionError("it must be text", element=element)
    return value.strip()


def _flag(value: Any, element: str) -> bool:
    if not isinstance(value, bool):
        raise DescriptionError("it must be true or false", element=element)
    return value


def _number(least: float, most: float) -> Callable[[Any, str], float]:
    def rule(value: Any, element: str) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
            raise DescriptionError(f"it must be a number from {least:g} to {most:g}", element=element)
        return float(value)

    return rule


def _whole(least: int, most: int) -> Callable[[Any, str], int]:
    def rule(value: Any, element: str) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            raise DescriptionError(f"it must be a whole number from {least} to {most}", element=element)
        return value

    return rule


def _one_of(words: Sequence[str]) -> Callable[[Any, str], str]:
    def rule(value: Any, element: str) -> str:
        if value not in words:
            near = _nearest(str(value), words)
            raise DescriptionError(
                f"unknown value {value!r}{near}; expected one of {', '.join(words)}", element=element
            )
        return str(value)

    return rule


def _kinds(value: Any, element: str) -> tuple[Kind, ...]:
    if not isinstance(value, list) or not value:
        raise DescriptionError("it must be a list of kinds of lines", element=element)
    rule = _one_of([kind.value for kind in Kind])
    return tuple(Kind(rule(entry, element)) for entry in value)


def _colour(value: Any, element: str) -> str:
    if not isinstance(value, str) or not _COLOUR.fullmatch(value):
        raise DescriptionError('it must be a colour such as "#ff0000"', element=element)
    return value.lower()


def dash_lengths(value: Any, element: str) -> tuple[float, ...]:
    """Lengths of dashes and gaps, mm. Raises DescriptionError."""
    if not isinstance(value, list | tuple) or len(value) not in (0, 2, 4):
        raise DescriptionError(
            "it must be a dash and a gap, or a dash, a gap, a dot and a gap, in mm", element=element
        )
    rule = _number(0.05, _LONGEST)
    return tuple(rule(entry, element) for entry in value)


def _cmyk(value: Any, element: str) -> tuple[float, ...]:
    if not isinstance(value, list) or len(value) != 4:
        raise DescriptionError("it must be four numbers from 0 to 1", element=element)
    return tuple(_number(0.0, 1.0)(entry, element) for entry in value)


_PROFILE_RULES: dict[str, Callable[[Any, str], Any]] = {
    "tolerance_mm": _number(1e-4, 1.0),
    "page_margin_mm": _number(0.0, 100.0),
    "pages": _one_of(PAGES),
    "registration": _flag,
    "tile": _one_of(tuple(PAPERS)),
    "tile_overlap_mm": _number(0.0, 50.0),
    "groove_passes": _whole(2, 99),
    "least_bend_radius": _number(0.0, _LONGEST),
}
_LAYER_RULES: dict[str, Callable[[Any, str], Any]] = {
    "name": _text,
    "kinds": _kinds,
    "colour": _colour,
    "width_mm": _number(0.001, 10.0),
    "dash_mm": dash_lengths,
    "end_margin_mm": _number(0.0, _LONGEST),
    "face": _one_of(FACES),
    "spot": _text,
    "spot_cmyk": _cmyk,
    "step": _one_of(STEPS),
}
