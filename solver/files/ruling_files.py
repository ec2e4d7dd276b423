"""The files that show how a fold is bent: its rulings in space and on the flat sheet, and its Gauss image."""

from __future__ import annotations

from xml.sax.saxutils import escape

import numpy as np

from ..arrays import FloatArray
from ..fold import FoldResult
from ..gauss_image import GaussImage, gauss_image
from ..pattern.crease_pattern import CreasePattern
from ..rulings import RulingKind, Rulings, rulings
from .line_obj import line_obj_text

RULINGS_OBJ, RULINGS_SVG, GAUSS_IMAGE_OBJ = "rulings.obj", "rulings.svg", "gauss_image.obj"
RULING_FILES = (RULINGS_OBJ, RULINGS_SVG, GAUSS_IMAGE_OBJ)

#: Of kinds of rulings. The reader of drawings takes none of these hues for a crease, a border or a cut: a drawing
#: with its rulings is read as the drawing.
RULING_INK = {
    RulingKind.CYLINDRICAL: "#2f9a9a",
    RulingKind.CONICAL: "#be8c3c",
    RulingKind.GENERAL: "#8c8c8c",
}
_CREASE_INK = {"M": "#ff0000", "V": "#0000ff", "U": "#ff00ff", "F": "#b4b4b4"}
_BORDER_INK = "#000000"
#: Widths of lines, relative to the sheet's longer side: those of a ball pen and of a fine liner on a letter.
_CREASE_WIDTH, _RULING_WIDTH = 3e-3, 1e-3


def rulings_obj(found: Rulings, name: str, comment: str = "") -> str:
    """The rulings in space as lines of an OBJ file, in groups by their kind, in the order of the kinds."""
    order = np.argsort(found.kind, kind="stable")
    kinds = [RulingKind(kind).name.lower() for kind in found.kind[order]]
    ends = found.segments[order].reshape(-1, 3)
    return line_obj_text(ends, np.arange(len(ends)).reshape(-1, 2), kinds, name, comment)


def gauss_image_obj(image: GaussImage, name: str, comment: str = "") -> str:
    """The Gauss image as lines of an OBJ file on the unit sphere, in groups by patch; quads that are not shown
    are left out, and shown ones without a neighbour are points.
    """
    shown = np.flatnonzero(image.shown)
    lines = image.lines
    patch = image.patch[lines[:, 0]]
    order = np.argsort(patch, kind="stable")
    number = np.zeros(len(image.normals), dtype=np.int64)
    number[shown] = np.arange(len(shown))
    groups = [f"patch_{k}" for k in patch[order].tolist()]
    return line_obj_text(image.normals[shown], number[lines[order]], groups, name, comment)


def rulings_svg(pattern: CreasePattern, found: Rulings) -> str:
    """The flat sheet in true scale: border, creases in the colours of their assignment, rulings by their kind."""
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    size = float((high - low).max())
    margin = 0.5 * _CREASE_WIDTH * size
    width, height = ((high - low) + 2 * margin).tolist()
    unit = pattern.unit_mm
    scale = "" if unit is None else f'width="{width * unit:.10g}mm" height="{height * unit:.10g}mm" '

    def points(line: FloatArray) -> str:
        # An SVG's y points down.
        places = np.column_stack([line[:, 0] - low[0] + margin, high[1] - line[:, 1] + margin])
        return " ".join(f"{x:.10g},{y:.10g}" for x, y in places.tolist())

    def ring(line: FloatArray) -> str:
        return f'<polygon points="{points(line)}"/>'

    def group(names: str, ink: str, part: float, shapes: list[str]) -> list[str]:
        return [f'<g id="{names}" stroke="{ink}" stroke-width="{part * size:.6g}">', *shapes, "</g>"]

    text = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {scale}'
        f'viewBox="0 0 {width:.10g} {height:.10g}" fill="none" stroke-linejoin="round">',
        f"<title>{escape(pattern.name)}</title>" if pattern.name else "<title>rulings</title>",
    ]
    for kind in RulingKind:
        lines = [f'<polyline points="{points(line)}"/>' for line in found.flat[found.kind == kind]]
        if lines:
            text += group(f"rulings-{kind.name.lower()}", RULING_INK[kind], _RULING_WIDTH, lines)
    text += group("border", _BORDER_INK, _CREASE_WIDTH, [ring(line) for line in (pattern.boundary, *pattern.holes)])
    for letter, ink in _CREASE_INK.items():
        mine = [crease for crease in pattern.creases if crease.assignment == letter]
        shapes = [
            ring(crease.points) if crease.closed else f'<polyline points="{points(crease.points)}"/>'
            for crease in mine
        ]
        if shapes:
            text += group(f"creases-{letter}", ink, _CREASE_WIDTH, shapes)
    return "\n".join([*text, "</svg>"]) + "\n"


def ruling_texts(result: FoldResult) -> tuple[dict[str, str], dict[str, int | float]]:
    """The three files by their names, and what the report says of the rulings."""
    found = rulings(result.net, result.positions)
    image = gauss_image(result.net, result.positions)
    name = result.pattern.name or "folded"
    comment = f"folded by Curvefold: {result.detail}"
    texts = {
        RULINGS_OBJ: rulings_obj(found, f"{name} rulings", comment),
        RULINGS_SVG: rulings_svg(result.pattern, found),
        GAUSS_IMAGE_OBJ: gauss_image_obj(image, f"{name} Gauss image", comment),
    }
    return texts, found.summary(result.net)
