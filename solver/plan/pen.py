"""Pens: what pages are drawn with, whatever the format of the file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from .profile import Layer
from .walk import Walk

#: What files of plans say of themselves: a file without it is somebody's own, and not written over.
SIGN = "Curvefold plan"


@dataclass(frozen=True)
class PageLayer:
    """What is drawn in one go: lines with their names."""

    layer: Layer
    lines: tuple[tuple[Walk, str], ...]


@dataclass(frozen=True)
class Page:
    """One page, mm; y is up, and the origin is the lowest left corner. name: what tells it from others."""

    name: str
    width: float
    height: float
    layers: tuple[PageLayer, ...]


class Pen(Protocol):
    """Draws pages, millimetres with y up."""

    def start_page(self, page: Page) -> None: ...

    def start_layer(self, layer: Layer) -> None: ...

    def line(self, walk: Walk, name: str) -> None: ...

    def content(self) -> bytes:
        """The whole file."""
        ...


def draw(pages: Iterable[Page], pen: Pen) -> bytes:
    """Pages as the content of a file."""
    for page in pages:
        pen.start_page(page)
        for part in page.layers:
            pen.start_layer(part.layer)
            for walk, name in part.lines:
                pen.line(walk, name)
    return pen.content()


def number(value: float, digits: int) -> str:
    """A number without needless digits, and never in powers of ten."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def rgb(colour: str) -> Sequence[int]:
    """Red, green and blue, 0 to 255, of "#rrggbb"."""
    return tuple(int(colour[k : k + 2], 16) for k in (1, 3, 5))
