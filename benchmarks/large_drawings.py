"""Drawings of thousands of strokes, as programs write them that draw every piece of a line as a stroke.

Every maker takes how many elements (or edges) the drawing has, all counted, and gives the text of the file. The
sheet is a square of 1000 units.
"""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np

SIDE = 1000.0
#: Pieces of a curve that was exploded.
_PIECES = 40
_HEAD = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIDE:g} {SIDE:g}">'
_BORDER = f'<rect width="{SIDE:g}" height="{SIDE:g}" fill="none" stroke="#000"/>'


def class_lines(count: int) -> str:
    """Short lines in rows, whose classes a style sheet colours. No two of them are dashes of one line."""

    def slope(k: int) -> float:
        return 0.2 + 0.6 * (k * 0.618034 % 1.0)

    style = "<style>.m{stroke:#f00}.v{stroke:#00f}.m,.v{fill:none;stroke-width:.5px}</style>"
    rows = [
        f'<line class="{"mv"[k % 2]}" x1="{x:.3f}" y1="{y:.3f}" '
        f'x2="{x + step:.3f}" y2="{y + step * slope(k):.3f}"/>'
        for k, (x, y, step) in enumerate(_cells(count - 3))
    ]
    return "\n".join([_HEAD, style, _BORDER, *rows, "</svg>"])


def style_paths(count: int) -> str:
    """Short curves in rows, each with a style of its own."""
    rows = [
        f'<path id="path{k}" style="fill:none;stroke:#{("ff0000", "0000ff")[k % 2]};stroke-width:0.5" '
        f'd="M {x:.3f},{y:.3f} q {0.5 * step:.3f},{0.3 * step:.3f} {step:.3f},0"/>'
        for k, (x, y, step) in enumerate(_cells(count - 2))
    ]
    return "\n".join([_HEAD, _BORDER, *rows, "</svg>"])


def exploded_curves(count: int) -> str:
    """Waves from side to side, each of forty lines."""
    curves = max(1, (count - 2) // _PIECES)
    x = np.linspace(0.0, SIDE, _PIECES + 1)
    rows = []
    for k in range(curves):
        gap = SIDE / (curves + 1)
        y = gap * (k + 1) + 0.3 * gap * np.sin(x * 4 * np.pi / SIDE)
        colour = ("#f00", "#00f")[k % 2]
        rows += [
            f'<line stroke="{colour}" x1="{x[i]:.3f}" y1="{y[i]:.3f}" x2="{x[i + 1]:.3f}" y2="{y[i + 1]:.3f}"/>'
            for i in range(_PIECES)
        ]
    return "\n".join([_HEAD, _BORDER, *rows, "</svg>"])


def fold_graph(count: int) -> str:
    """A FOLD file of a grid with at most ``count`` edges, mountains across and valleys up."""
    cells = int((np.sqrt(1 + 2 * count) - 1) / 2)  # 2 n (n + 1) edges
    steps = range(cells + 1)
    number = {(i, j): i * (cells + 1) + j for i in steps for j in steps}
    edges, letters = [], []
    for i, j in number:
        for other, rim, letter in (((i + 1, j), j, "M"), ((i, j + 1), i, "V")):
            if other in number:
                edges.append([number[i, j], number[other]])
                letters.append("B" if rim in (0, cells) else letter)
    points = [[round(SIDE * i / cells, 4), round(SIDE * j / cells, 4)] for i, j in number]
    return json.dumps(
        {
            "file_spec": 1.2,
            "frame_classes": ["creasePattern"],
            "vertices_coords": points,
            "edges_vertices": edges,
            "edges_assignment": letters,
        }
    )


def cad_lines(count: int) -> str:
    """A DXF file of short lines in rows, on layers that say what they are."""
    corners = [(0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE)]
    sides = [("cut", *a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    folds = [
        (("mountain", "valley")[k % 2], x, y, x + step, y + 0.3 * step)
        for k, (x, y, step) in enumerate(_cells(count - len(sides)))
    ]
    entities = [
        f"0\nLINE\n8\n{layer}\n10\n{x0:.3f}\n20\n{y0:.3f}\n11\n{x1:.3f}\n21\n{y1:.3f}\n"
        for layer, x0, y0, x1, y1 in (*sides, *folds)
    ]
    return f"0\nSECTION\n2\nENTITIES\n{''.join(entities)}0\nENDSEC\n0\nEOF\n"


def typed_grid(count: int) -> str:
    """A CP file of a grid of at most ``count`` lines, each from one crossing to the next."""
    cells = int((np.sqrt(1 + 2 * count) - 1) / 2)
    cell = SIDE / cells
    rows = []
    for i in range(cells + 1):
        for j in range(cells):
            rim = i in (0, cells)
            a, b, c = cell * i, cell * j, cell * (j + 1)
            rows += [f"{1 if rim else 2} {b:.4f} {a:.4f} {c:.4f} {a:.4f}"]
            rows += [f"{1 if rim else 3} {a:.4f} {b:.4f} {a:.4f} {c:.4f}"]
    return "\n".join(rows) + "\n"


#: Suffix and maker by what the drawing is made of.
LARGE: dict[str, tuple[str, Callable[[int], str]]] = {
    "lines with classes": (".svg", class_lines),
    "paths with styles": (".svg", style_paths),
    "curves of 40 lines": (".svg", exploded_curves),
    "edges of a FOLD file": (".fold", fold_graph),
    "lines of a DXF file": (".dxf", cad_lines),
    "lines of a CP file": (".cp", typed_grid),
}


def _cells(count: int) -> list[tuple[float, float, float]]:
    """(x, y, length) of ``count`` short strokes that do not touch each other."""
    across = int(np.ceil(np.sqrt(count)))
    cell = SIDE / (across + 1)
    return [(cell * (0.6 + k % across), cell * (1 + k // across), 0.8 * cell) for k in range(count)]
