"""Plans as PDF: true size, a layer an operation, spot colours, and processing steps as ISO 19593-1 has them.

Written here and not by a library: a page of lines needs a few dozen lines of code, and those libraries that are
small enough to be bundled write neither layers nor spot colours.
"""

from __future__ import annotations

import zlib

from ..errors import CurvefoldError
from .pen import SIGN, Page, number, rgb
from .pieces import Arc, Cubic, Line
from .profile import Layer
from .walk import Walk

#: Points in a millimetre.
_POINTS = 72.0 / 25.4
#: The largest page that readers must show, points.
_LARGEST = 14_400.0
#: Digits after the point, of millimetres, and of points.
_DIGITS, _POINT_DIGITS = 5, 6


class PdfPen:
    """Any number of pages."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._objects: list[bytes] = []
        self._catalog, self._tree = self._reserve(), self._reserve()
        self._pages: list[int] = []
        self._groups: dict[str, int] = {}
        self._spots: dict[str, int] = {}
        self._page: Page | None = None
        self._drawn: list[str] = []
        self._used: dict[str, dict[str, int]] = {}
        self._overprint = self._add("<< /Type /ExtGState /OP true /op true /OPM 1 >>")

    def start_page(self, page: Page) -> None:
        self._finish_page()
        if max(page.width, page.height) * _POINTS > _LARGEST:
            raise CurvefoldError(
                f"the page is {page.width:.0f} mm by {page.height:.0f} mm, and a page of a PDF has "
                f"{_LARGEST / _POINTS:.0f} mm at most; write tiles, SVG or DXF instead"
            )
        self._page = page
        scale = number(_POINTS, 12)
        self._drawn = [f"{scale} 0 0 {scale} 0 0 cm 1 J 1 j"]
        self._used = {"Properties": {}, "ColorSpace": {}, "ExtGState": {}}

    def start_layer(self, layer: Layer) -> None:
        self._close_layer()
        group = self._group(layer)
        self._used["Properties"][f"L{group}"] = group
        self._drawn.append(f"/OC /L{group} BDC {number(layer.width_mm, _DIGITS)} w")
        if layer.spot:
            spot = self._spot(layer)
            self._used["ColorSpace"][f"S{spot}"] = spot
            self._used["ExtGState"]["Over"] = self._overprint
            self._drawn.append(f"/Over gs /S{spot} CS 1 SCN")
        else:
            self._drawn.append(" ".join(number(value / 255.0, 4) for value in rgb(layer.colour)) + " RG")

    def line(self, walk: Walk, name: str) -> None:
        text = [f"{_xy(walk.pieces[0].start)} m"]
        for piece in walk.pieces:
            if isinstance(piece, Line):
                text.append(f"{_xy(piece.end)} l")
            else:
                text += [_curve(cubic) for cubic in (piece.cubics() if isinstance(piece, Arc) else [piece])]
        text.append("s" if walk.closed else "S")
        self._drawn.append(" ".join(text))

    def content(self) -> bytes:
        self._finish_page()
        groups = " ".join(f"{index} 0 R" for index in self._groups.values())
        self._set(
            self._catalog,
            f"<< /Type /Catalog /Pages {self._tree} 0 R /OCProperties << /OCGs [{groups}] "
            f"/D << /Name {_text('Plan')} /Order [{groups}] /ON [{groups}] >> >> "
            "/ViewerPreferences << /PrintScaling /None >> >>",
        )
        pages = " ".join(f"{index} 0 R" for index in self._pages)
        self._set(self._tree, f"<< /Type /Pages /Kids [{pages}] /Count {len(self._pages)} >>")
        information = self._add(f"<< /Title {_text(self._title)} /Creator {_text(SIGN)} >>")
        return self._file(information)

    # ---- parts of pages

    def _close_layer(self) -> None:
        if len(self._drawn) > 1:
            self._drawn.append("EMC")

    def _finish_page(self) -> None:
        if self._page is None:
            return
        self._close_layer()
        width, height = (number(side * _POINTS, _POINT_DIGITS) for side in (self._page.width, self._page.height))
        stream = zlib.compress("\n".join(self._drawn).encode("ascii"), 9)
        drawn = self._add(f"<< /Length {len(stream)} /Filter /FlateDecode >>", stream)
        used = " ".join(
            f"/{kind} << {' '.join(f'/{name} {index} 0 R' for name, index in entries.items())} >>"
            for kind, entries in self._used.items()
        )
        box = f"[0 0 {width} {height}]"
        self._pages.append(
            self._add(
                f"<< /Type /Page /Parent {self._tree} 0 R /MediaBox {box} /CropBox {box} /TrimBox {box} "
                f"/Resources << {used} >> /Contents {drawn} 0 R >>"
            )
        )
        self._page = None

    def _group(self, layer: Layer) -> int:
        if layer.name not in self._groups:
            step = (
                f" /GTS_Metadata << /GTS_ProcStepsGroup /Structural /GTS_ProcStepsType /{layer.step} >>"
                if layer.step
                else ""
            )
            self._groups[layer.name] = self._add(f"<< /Type /OCG /Name {_text(layer.name)}{step} >>")
        return self._groups[layer.name]

    def _spot(self, layer: Layer) -> int:
        if layer.spot not in self._spots:
            full = " ".join(number(value, 4) for value in layer.spot_cmyk)
            self._spots[layer.spot] = self._add(
                f"[/Separation /{_name(layer.spot)} /DeviceCMYK << /FunctionType 2 /Domain [0 1] "
                f"/C0 [0 0 0 0] /C1 [{full}] /N 1 >>]"
            )
        return self._spots[layer.spot]

    # ---- objects

    def _reserve(self) -> int:
        self._objects.append(b"")
        return len(self._objects)

    def _set(self, index: int, text: str, stream: bytes | None = None) -> None:
        body = text.encode("ascii")
        if stream is not None:
            body += b"\nstream\n" + stream + b"\nendstream"
        self._objects[index - 1] = body

    def _add(self, text: str, stream: bytes | None = None) -> int:
        index = self._reserve()
        self._set(index, text, stream)
        return index

    def _file(self, information: int) -> bytes:
        parts = [b"%PDF-1.6\n%\xe2\xe3\xcf\xd3\n"]
        places, at = [], len(parts[0])
        for index, body in enumerate(self._objects, 1):
            places.append(at)
            parts.append(b"%d 0 obj\n%s\nendobj\n" % (index, body))
            at += len(parts[-1])
        count = len(places) + 1
        parts.append(b"xref\n0 %d\n0000000000 65535 f \n" % count)
        parts += [b"%010d 00000 n \n" % place for place in places]
        parts.append(
            b"trailer\n<< /Size %d /Root %d 0 R /Info %d 0 R >>\nstartxref\n%d\n%%%%EOF\n"
            % (count, self._catalog, information, at)
        )
        return b"".join(parts)


def _xy(z: complex) -> str:
    return f"{number(z.real, _DIGITS)} {number(z.imag, _DIGITS)}"


def _curve(cubic: Cubic) -> str:
    return f"{_xy(cubic.first)} {_xy(cubic.second)} {_xy(cubic.end)} c"


def _text(text: str) -> str:
    """A string of a PDF: ASCII as it is, else UTF-16."""
    if text.isascii() and text.isprintable():
        escaped = text.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")
        return f"({escaped})"
    return f"<FEFF{text.encode('utf-16-be', 'replace').hex().upper()}>"


def _name(text: str) -> str:
    """A name of a PDF, without its slash."""
    plain = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_."
    return "".join(chr(byte) if byte in plain else f"#{byte:02X}" for byte in text.encode("utf-8", "replace"))
