"""CP and OPX files of odd pieces, around a sheet and a crease that would do."""

from __future__ import annotations

from random import Random
from typing import Any

_GOOD = (
    (1, -50, -50, 50, -50),
    (1, 50, -50, 50, 50),
    (1, 50, 50, -50, 50),
    (1, -50, 50, -50, -50),
    (2, -50, 9, 50, 0),
)
_VALUES = ["nan", "inf", "1e308", "-1e308", "1e999", "", "x", "1,5", "0x1", "9" * 400, "-0", "1e-300", "٣"]
_WORDS = ["#", "//", "\0", "\x85", " ", "2", "<java>", "é", "1 2 3 4 5 6 7"]
_ELEMENTS = [
    "<object class='oripa.OriLineProxy'>", "</object>", "<void property='x0'>", "</void>", "<double>", "</double>",
    "<int>2</int>", "<double>5</double>", "<void property='type'>", "<object class='java.lang.ProcessBuilder'>",
    "<array length='99999999999'>", "</array>", "text", "&amp;", "&x;", "<object idref='a'/>", "<null/>",
    "<void property='x0'><double>nan</double></void>", "<void property='y1'><int>1e308</int></void>",
]  # fmt: skip


def made_cp(rng: Random) -> bytes:
    """The same for the same random numbers."""
    rows = [" ".join(map(str, row)) for row in (*_GOOD, *(_row(rng) for _ in range(rng.randrange(8))))]
    for _ in range(rng.randrange(3)):
        rows.insert(rng.randrange(len(rows) + 1), rng.choice(_WORDS))
    return rng.choice(["\n", "\n", "\r\n", "\r"]).join(rows).encode(rng.choice(["utf-8", "utf-8", "utf-16"]))


def made_opx(rng: Random) -> bytes:
    """The same for the same random numbers."""
    parts = [_line(row) for row in (*_GOOD, *(_row(rng) for _ in range(rng.randrange(8))))]
    for _ in range(rng.randrange(3)):
        parts.insert(rng.randrange(len(parts) + 1), rng.choice(_ELEMENTS))
    return f"<java><object class='oripa.DataSet'>{''.join(parts)}</object></java>".encode()


def _row(rng: Random) -> tuple[Any, ...]:
    ends = [rng.choice(_VALUES) if rng.random() < 0.03 else rng.uniform(-60.0, 60.0) for _ in range(4)]
    return (rng.choice([0, 1, 2, 2, 3, 3, 4, 7, -1, 10**30]), *ends)


def _line(row: tuple[Any, ...]) -> str:
    names = zip(("type", "x0", "y0", "x1", "y1"), ("int", *["double"] * 4), row, strict=True)
    numbers = "".join(f"<void property='{name}'><{kind}>{value}</{kind}></void>" for name, kind, value in names)
    return f"<void><object class='oripa.OriLineProxy'>{numbers}</object></void>"
