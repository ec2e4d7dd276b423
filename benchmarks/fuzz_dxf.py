"""DXF files of odd pieces, around a sheet and a crease that would do."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

Tags = list[tuple[Any, Any]]

_VALUES = [
    "0", "1", "-1", "50", "100", "1e3", "1e-9", "1e308", "-1e308", "1e999", "nan", "inf", "", " ", "x", "3,5", "-0",
    "99999999999999999999", "0x10", "256", "257", "-5",
]  # fmt: skip
_KINDS = [
    "LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "VERTEX", "SEQEND", "SPLINE", "INSERT", "TEXT",
    "POINT", "HATCH", "DIMENSION", "ATTRIB", "3DFACE", "RAY", "NOTHING", "",
]  # fmt: skip
_CODES = [
    5, 6, 8, 10, 20, 30, 11, 21, 31, 12, 22, 13, 23, 40, 41, 42, 43, 44, 45, 50, 51, 60, 62, 66, 70, 71, 72, 73, 74,
    90, 100, 210, 220, 230, 330, 370, 420, 999,
]  # fmt: skip
_NAMES = ["a", "b", "c", "0", "*U1", "MOUNTAIN", "valley", "BYLAYER", "", "\x01", "é"]
#: Group codes of whole numbers; most others between 10 and 59 and 210 and 239 are of any numbers.
_WHOLE = range(60, 100)
_WHOLES = [0, 1, 2, 3, 4, 8, 16, 64, 128, -1, 255, 256, 30000]
_REALS = [0.0, 1.0, -1.0, 1e3, 1e-9, 1e308, -1e308, 50.0, 90.0, 360.0, 100.0, -0.0, 1e20]
#: How often a value is of no kind that its group code takes: the whole file is refused then.
_WRONG = 0.01
#: Blocks of one file that refer to each other.
_BLOCKS = ("a", "b", "c")


def made_dxf(rng: Random) -> bytes:
    """The same for the same random numbers."""
    square = [(0, 0), (100, 0), (100, 100), (0, 100), (0, 0)]
    good = [tag for k in range(4) for tag in _line(square[k], square[k + 1], "border")]
    good += _line((0, 40), (100, 60), "valley")
    odd = [tag for _ in range(rng.randrange(6)) for tag in _entity(rng)]
    blocks = [tag for name in _BLOCKS for tag in _block(rng, name)]
    header = [(9, "$ACADVER"), (1, rng.choice(["AC1009", "AC1015", "AC1027", "AC9999", ""]))]
    header += [(9, "$INSUNITS"), (70, rng.choice([0, 1, 4, 99]))]
    layers = [(0, "TABLE"), (2, "LAYER")]
    for name in rng.sample(_NAMES, 3):
        layers += [(0, "LAYER"), (2, name), (70, rng.choice([0, 1])), (62, rng.choice(_WHOLES))]
    layers.append((0, "ENDTAB"))
    sections = [("HEADER", header), ("TABLES", layers), ("BLOCKS", blocks), ("ENTITIES", [*good, *odd])]
    if rng.random() < 0.2:
        rng.shuffle(sections)
    tags: Tags = [tag for name, content in sections for tag in _section(name, content)]
    if rng.random() < 0.3:
        del tags[rng.randrange(len(tags))]
    return "".join(f"{code}\n{value}\n" for code, value in [*tags, (0, "EOF")]).encode("utf-8", "replace")


def _section(name: str, content: Tags) -> Tags:
    return [(0, "SECTION"), (2, name), *content, (0, "ENDSEC")]


def _line(start: Sequence[float], end: Sequence[float], layer: str) -> Tags:
    return [(0, "LINE"), (8, layer), (10, start[0]), (20, start[1]), (11, end[0]), (21, end[1])]


def _entity(rng: Random) -> Tags:
    tags: Tags = [(0, rng.choice(_KINDS)), (8, rng.choice(_NAMES)), (2, rng.choice(_NAMES))]
    for _ in range(rng.randrange(14)):
        code = rng.choice(_CODES)
        tags.append((code, _value(rng, code)))
        if code in (10, 11, 12, 13) and rng.random() < 0.9:  # a point has both, in this order
            tags.append((code + 10, _value(rng, code)))
    return tags


def _value(rng: Random, code: int) -> Any:
    if rng.random() < _WRONG:
        return rng.choice(_VALUES)
    if code in _WHOLE:
        return rng.choice(_WHOLES)
    if 10 <= code < 60 or 210 <= code < 240:
        return rng.choice(_REALS) if rng.random() < 0.4 else rng.uniform(-20.0, 120.0)
    return rng.choice(_NAMES) if code < 10 or code == 100 else rng.choice(_WHOLES)


def _block(rng: Random, name: str) -> Tags:
    content = [tag for _ in range(rng.randrange(3)) for tag in _entity(rng)]
    if rng.random() < 0.5:
        content += [(0, "INSERT"), (2, rng.choice(_BLOCKS)), (10, 5), (20, 5), (41, _value(rng, 41))]
    return [(0, "BLOCK"), (8, "0"), (2, name), (10, 0), (20, 0), *content, (0, "ENDBLK")]
