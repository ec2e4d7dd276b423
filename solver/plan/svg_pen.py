"""Plans as SVG: true size in millimetres, a group a layer, no styles, transforms or dashes by attribute."""

from __future__ import annotations

import math
from xml.sax.saxutils import escape, quoteattr

from .pen import SIGN, Page, number
from .pieces import Arc, Line, Piece
from .profile import Layer
from .walk import Walk

#: Digits after the point, of millimetres.
_DIGITS = 5
#: Arcs of more are written as two: at half a turn a rounding of the ends moves the centre far.
_LONGEST_ARC = math.radians(120.0)


class SvgPen:
    """One page."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._height = 0.0
        self._text: list[str] = []
        self._open = False

    def start_page(self, page: Page) -> None:
        width, height = number(page.width, _DIGITS), number(page.height, _DIGITS)
        self._height = page.height
        self._text = [
            '<?xml version="1.0" encoding="UTF-8"?>',
            '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
            f'width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">',
            f"<title>{escape(_printable(self._title))}</title>",
            f"<desc>{SIGN}</desc>",
        ]

    def start_layer(self, layer: Layer) -> None:
        self._close_layer()
        name = quoteattr(_printable(layer.name))
        identifier = quoteattr("".join(c if c.isalnum() and c.isascii() else "_" for c in layer.name))
        self._text.append(
            f'<g id={identifier} inkscape:groupmode="layer" inkscape:label={name} fill="none" '
            f'stroke="{layer.colour}" stroke-width="{number(layer.width_mm, _DIGITS)}" stroke-linecap="round" '
            'stroke-linejoin="round">'
        )
        self._open = True

    def line(self, walk: Walk, name: str) -> None:
        label = f" inkscape:label={quoteattr(_printable(name))}" if name else ""
        first = walk.pieces[0]
        if walk.closed and isinstance(first, Arc) and first.is_circle and len(walk.pieces) == 1:
            x, y = self._xy(first.centre).split(",")
            self._text.append(f'<circle{label} cx="{x}" cy="{y}" r="{number(first.radius, _DIGITS)}"/>')
            return
        commands = [f"M{self._xy(first.start)}", *(self._command(piece) for piece in walk.pieces)]
        if walk.closed:
            if isinstance(walk.pieces[-1], Line):
                commands.pop()
            commands.append("Z")
        self._text.append(f'<path{label} d="{"".join(commands)}"/>')

    def content(self) -> bytes:
        self._close_layer()
        return ("\n".join([*self._text, "</svg>"]) + "\n").encode("utf-8", "replace")

    def _close_layer(self) -> None:
        if self._open:
            self._text.append("</g>")
        self._open = False

    def _command(self, piece: Piece) -> str:
        if isinstance(piece, Line):
            return f"L{self._xy(piece.end)}"
        if isinstance(piece, Arc):
            if abs(piece.sweep) > _LONGEST_ARC:
                return self._command(piece.part(0.0, 0.5)) + self._command(piece.part(0.5, 1.0))
            radius = number(piece.radius, _DIGITS)
            # y points down in SVG: what turns left turns right.
            return f"A{radius},{radius} 0 0 {int(piece.sweep < 0)} {self._xy(piece.end)}"
        return f"C{self._xy(piece.first)} {self._xy(piece.second)} {self._xy(piece.end)}"

    def _xy(self, z: complex) -> str:
        return f"{number(z.real, _DIGITS)},{number(self._height - z.imag, _DIGITS)}"


def _printable(text: str) -> str:
    """Text without what XML cannot hold."""
    return "".join(c for c in text if c.isprintable())
