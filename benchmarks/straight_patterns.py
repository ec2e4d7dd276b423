"""Straight crease patterns with mountains and valleys drawn, as origami tessellations and bases are.

Each is lines (letter, start, end) on a sheet, drawing units; ``svg`` writes them as most programs do: a red
mountain, a blue valley, the border black.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Point = tuple[float, float]
Line = tuple[str, Point, Point]
_COLOURS = {"M": "#ff0000", "V": "#0000ff"}
_OTHER = {"M": "V", "V": "M"}


@dataclass(frozen=True)
class StraightPattern:
    """A sheet from the origin to size, and its creases; rigid: whether its faces can stay flat while it folds."""

    name: str
    size: Point
    lines: tuple[Line, ...]
    rigid: bool = True

    def svg(self) -> str:
        width, height = self.size
        rows = [f'<rect width="{width:g}" height="{height:g}" fill="none" stroke="#000000"/>']
        for letter, (x1, y1), (x2, y2) in self.lines:
            place = f'x1="{x1:.6f}" y1="{y1:.6f}" x2="{x2:.6f}" y2="{y2:.6f}"'
            rows.append(f'<line {place} stroke="{_COLOURS[letter]}"/>')
        box = f'viewBox="0 0 {width:g} {height:g}"'
        return f'<svg xmlns="http://www.w3.org/2000/svg" {box}>\n' + "\n".join(rows) + "\n</svg>\n"


def miura(columns: int, rows: int, lean: float = 0.3) -> StraightPattern:
    """Miura-ori of columns × rows cells. lean: of the zigzags, parts of a cell."""
    cell = 10.0
    lines: list[Line] = []

    def at(i: int, j: int) -> Point:
        return i * cell, j * cell + (lean * cell if i % 2 else 0.0) - 0.5 * lean * cell

    for j in range(1, rows):
        side = "M" if j % 2 else "V"
        lines += [(side, at(i, j), at(i + 1, j)) for i in range(columns)]
    for i in range(1, columns):
        ends = [(i * cell, 0.0), *(at(i, j) for j in range(1, rows)), (i * cell, rows * cell)]
        for j in range(rows):
            lines.append(("V" if (i + j) % 2 else "M", ends[j], ends[j + 1]))
    return StraightPattern(f"miura {columns} × {rows}", (columns * cell, rows * cell), tuple(lines))


def waterbomb_base() -> StraightPattern:
    """Both diagonals one side, one middle line the other."""
    corners = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
    lines: list[Line] = [("M", corner, (50.0, 50.0)) for corner in corners]
    lines += [("V", (0.0, 50.0), (50.0, 50.0)), ("V", (50.0, 50.0), (100.0, 50.0))]
    return StraightPattern("waterbomb base", (100.0, 100.0), tuple(lines))


def preliminary_base() -> StraightPattern:
    """Both middle lines one side, one diagonal the other."""
    middles = [(50.0, 0.0), (100.0, 50.0), (50.0, 100.0), (0.0, 50.0)]
    lines: list[Line] = [("V", middle, (50.0, 50.0)) for middle in middles]
    lines += [("M", (0.0, 0.0), (50.0, 50.0)), ("M", (50.0, 50.0), (100.0, 100.0))]
    return StraightPattern("preliminary base", (100.0, 100.0), tuple(lines))


def bird_base() -> StraightPattern:
    """The bird base of the crane: its petal folds need faces that bend."""
    c, t = (50.0, 50.0), 50.0 * np.tan(np.pi / 8)
    lines: list[Line] = []
    corners = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
    for k, (x, y) in enumerate(corners):
        lines.append(("V" if k % 2 else "M", (x, y), c))
    for k in range(4):
        turn = np.pi / 2 * k

        def rotated(x: float, y: float, turn: float = turn) -> Point:
            u, v = x - 50.0, y - 50.0
            return (50.0 + u * np.cos(turn) - v * np.sin(turn), 50.0 + u * np.sin(turn) + v * np.cos(turn))

        foot = rotated(50.0, t)
        lines += [("M", rotated(0.0, 0.0), foot), ("M", rotated(100.0, 0.0), foot)]
        lines += [("V", foot, c), ("M", rotated(50.0, 0.0), foot)]
    return StraightPattern("bird base", (100.0, 100.0), tuple(lines), rigid=False)


def square_twist() -> StraightPattern:
    """The square twist: a turned square whose four pleats run off to the border."""
    lines: list[Line] = []
    inner = [(40.0, 35.0), (65.0, 40.0), (60.0, 65.0), (35.0, 60.0)]
    along = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]
    for k in range(4):
        here, after = inner[k], inner[(k + 1) % 4]
        lines.append(("M" if k % 2 else "V", here, after))
        letter = "V" if k % 2 else "M"
        for point, side in ((here, letter), (after, _OTHER[letter])):
            lines.append((side, point, _to_border(point, along[k])))
    return StraightPattern("square twist", (100.0, 100.0), tuple(lines))


def yoshimura(columns: int, rows: int) -> StraightPattern:
    """Diamonds: zigzags are mountains, their diagonals valleys."""
    width, height = 20.0, 12.0
    lines: list[Line] = []
    for j in range(rows):
        if j:
            lines.append(("V", (0.0, j * height), (columns * width, j * height)))
        for i in range(columns):
            middle, low, high = (i + 0.5) * width, j * height, (j + 1) * height
            one, other = (low, high) if j % 2 else (high, low)
            lines += [("M", (i * width, one), (middle, other)), ("M", (middle, other), ((i + 1) * width, one))]
    return StraightPattern(f"yoshimura {columns} × {rows}", (columns * width, rows * height), tuple(lines))


def kresling(columns: int, rows: int) -> StraightPattern:
    """Sheared cells with their diagonals, laid out flat: rows are mountains, diagonals valleys."""
    cell, lean = 20.0, 6.0
    lines: list[Line] = []
    width, height = columns * cell, rows * cell
    for j in range(1, rows):
        lines.append(("M", (0.0, j * cell), (width, j * cell)))
    for j in range(rows):
        low, high = j * cell, (j + 1) * cell
        for i in range(-2, columns + 1):
            start = i * cell + lean * j
            for letter, end in (("M", start + lean), ("V", start + lean + cell)):
                cut = _cut((start, low), (end, high), width)
                if cut is not None:
                    lines.append((letter, *cut))
    return StraightPattern(f"kresling {columns} × {rows}", (width, height), tuple(lines), rigid=False)


def all_patterns() -> Sequence[StraightPattern]:
    """Small and large ones of each kind."""
    return (miura(8, 8), miura(12, 12), waterbomb_base(), preliminary_base(), bird_base(), square_twist(),
            yoshimura(4, 4), kresling(4, 3))  # fmt: skip


def _to_border(point: Point, along: Point) -> Point:
    ways = [((100.0 if d > 0 else 0.0) - p) / d for p, d in zip(point, along, strict=True) if d]
    return point[0] + ways[0] * along[0], point[1] + ways[0] * along[1]


def _cut(start: Point, end: Point, width: float) -> tuple[Point, Point] | None:
    """The part of a line with 0 < x < width, None where there is none."""
    (x1, y1), (x2, y2) = start, end
    if x2 <= 1e-9 or x1 >= width - 1e-9:
        return None
    low, high = max(0.0, -x1 / (x2 - x1)), min(1.0, (width - x1) / (x2 - x1))
    return (x1 + low * (x2 - x1), y1 + low * (y2 - y1)), (x1 + high * (x2 - x1), y1 + high * (y2 - y1))
