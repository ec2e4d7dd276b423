"""DXF files written by hand from the DXF reference: pairs of a group code and a value, a line each."""

from __future__ import annotations

from typing import Any

Tags = list[tuple[int, Any]]

#: A border from (0, 0) to (100, 80), in pieces so that every version knows them.
CORNERS = ((0, 0), (100, 0), (100, 80), (0, 80))


def entity(kind: str, *tags: tuple[int, Any], layer: str = "0") -> Tags:
    return [(0, kind), (8, layer), *tags]


def line(start: tuple[float, float], end: tuple[float, float], *tags: tuple[int, Any], layer: str = "0") -> Tags:
    (x0, y0), (x1, y1) = start, end
    return entity("LINE", *tags, (10, x0), (20, y0), (11, x1), (21, y1), layer=layer)


def border() -> Tags:
    return [tag for a, b in zip(CORNERS, (*CORNERS[1:], CORNERS[0]), strict=True) for tag in line(a, b)]


def layer(name: str, colour: int, flags: int = 0, linetype: str = "CONTINUOUS") -> Tags:
    """A line of the table of layers: a negative colour is that of a layer that is off, flag 1 says frozen."""
    return [(0, "LAYER"), (2, name), (70, flags), (62, colour), (6, linetype)]


def linetype(name: str, *lengths: float) -> Tags:
    return [
        (0, "LTYPE"), (2, name), (70, 0), (3, ""), (72, 65), (73, len(lengths)), (40, sum(map(abs, lengths))),
        *((49, length) for length in lengths),
    ]  # fmt: skip


def block(name: str, *entities: Tags, base: tuple[float, float] = (0, 0)) -> Tags:
    content = [tag for one in entities for tag in one]
    return [
        (0, "BLOCK"),
        (8, "0"),
        (2, name),
        (70, 0),
        (10, base[0]),
        (20, base[1]),
        (3, name),
        *content,
        (0, "ENDBLK"),
    ]


def insert(name: str, place: tuple[float, float], *tags: tuple[int, Any], layer: str = "0") -> Tags:
    return entity("INSERT", (2, name), (10, place[0]), (20, place[1]), *tags, layer=layer)


def r12(
    *entities: Tags, header: Tags | None = None, layers: Tags | None = None, linetypes: Tags | None = None,
    blocks: Tags | None = None,
) -> bytes:  # fmt: skip
    """A whole file as R12 has it, which is what most programs still write."""
    tables = [
        *(_table("LTYPE", linetypes) if linetypes else []),
        *(_table("LAYER", layers) if layers else []),
    ]
    tags = [
        *_section("HEADER", [(9, "$ACADVER"), (1, "AC1009"), *(header or [])]),
        *(_section("TABLES", tables) if tables else []),
        *(_section("BLOCKS", blocks) if blocks else []),
        *_section("ENTITIES", [tag for one in entities for tag in one]),
        (0, "EOF"),
    ]
    return text(tags)


def text(tags: Tags) -> bytes:
    return "".join(f"{code:>3}\n{value}\n" for code, value in tags).encode()


def _section(name: str, content: Tags) -> Tags:
    return [(0, "SECTION"), (2, name), *content, (0, "ENDSEC")]


def _table(name: str, content: Tags) -> Tags:
    return [(0, "TABLE"), (2, name), (70, 9), *content, (0, "ENDTAB")]
