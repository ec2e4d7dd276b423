"""CP and OPX files of the same lines: (type, x0, y0, x1, y1), y pointing down."""

from __future__ import annotations

from collections.abc import Sequence

Row = tuple[int, float, float, float, float]

SQUARE: tuple[Row, ...] = (
    (1, -200, -200, 200, -200),
    (1, 200, -200, 200, 200),
    (1, 200, 200, -200, 200),
    (1, -200, 200, -200, -200),
)


def cp(rows: Sequence[Row], separator: str = " ", ending: str = "\n") -> bytes:
    return "".join(separator.join(map(str, row)) + ending for row in rows).encode()


def opx(rows: Sequence[Row]) -> bytes:
    """As Java's XMLEncoder writes it: numbers that are 0 are left out, as is what a new object has anyway."""
    lines = "".join(
        f'<void index="{k}"><object class="oripa.OriLineProxy">{_numbers(row)}</object></void>\n'
        for k, row in enumerate(rows)
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<java version="1.5.0_06" class="java.beans.XMLDecoder">\n'
        '<object class="oripa.DataSet"><void property="mainVersion"><int>1</int></void>\n'
        f'<void property="lines"><array class="oripa.OriLineProxy" length="{len(rows)}">\n{lines}</array></void>\n'
        '<void property="paperSize"><double>400.0</double></void>'
        '<void property="title"><string>型 &amp; crane</string></void></object></java>\n'
    ).encode()


def _numbers(row: Row) -> str:
    kind, x0, y0, x1, y1 = row
    parts = [f'<void property="type"><int>{kind}</int></void>'] if kind else []
    for name, value in (("x0", x0), ("x1", x1), ("y0", y0), ("y1", y1)):
        if value:
            parts.append(f'<void property="{name}"><double>{float(value)}</double></void>')
    return "".join(parts)
