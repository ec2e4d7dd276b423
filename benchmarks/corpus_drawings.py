"""Random drawings that look like real ones: a family of creases on a sheet of some shape, size and place.

A drawing is a pure function of its seed. It is drawn in a box 1 wide and ``height`` high and then turned,
scaled and moved: a micrometre or a kilometre, at the origin or far from it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, Polygon

import solver
from solver.arrays import FloatArray

Rng = np.random.Generator
#: Pieces of a crease shorter than this are dropped when it is cut at the sheet, part of the shorter side.
_SHORTEST = 0.15
#: Cells between neighbouring creases, and across the sheet, that a resolution must leave.
_CELLS_BETWEEN, _CELLS_ACROSS = 1.8, 4.0
#: Quads along the longer side: least when there is room, and most.
_RESOLUTION_LEAST, _RESOLUTION_MOST = (16, 24), 48


@dataclass(frozen=True, eq=False)
class Box:
    """The box a drawing is made in. height of the box of width 1; size: the shorter side."""

    height: float

    @property
    def size(self) -> float:
        return min(1.0, self.height)

    @property
    def middle(self) -> FloatArray:
        return np.array([0.5, 0.5 * self.height])


@dataclass(frozen=True, eq=False)
class Drawing:
    """pattern in its own units; resolution to fold it at; outline: the sheet in box coordinates.

    to_drawing: box coordinates (N,2) to drawing units; scale: drawing units in one box unit
    """

    family: str
    pattern: solver.CreasePattern
    resolution: int
    box: Box
    outline: Polygon
    turn: float
    scale: float
    origin: FloatArray

    def to_drawing(self, points: FloatArray) -> FloatArray:
        """Box coordinates (N,2) or (N,3) to drawing units."""
        c, s = np.cos(self.turn), np.sin(self.turn)
        moved = np.array(points, dtype=float)
        moved[:, :2] = moved[:, :2] @ np.array([[c, s], [-s, c]])
        moved *= self.scale
        moved[:, :2] += self.origin
        return moved


#: A family draws curves (N,2), with the first point repeated where they are closed, into a box.
Family = Callable[[Rng, Box], list[FloatArray]]


def make_drawing(seed: int) -> Drawing:
    """The drawing of a seed. Families take turns."""
    rng = np.random.default_rng([seed, 1])
    family = list(FAMILIES)[seed % len(FAMILIES)]
    for _ in range(50):
        box = Box(1.0 / _aspect(rng, family))
        outline = _sheet(rng, box, family)
        lines = _cut(FAMILIES[family](rng, box), outline, box)
        if lines and len(lines) <= 30:
            break
    turn = float(rng.choice([0.0, 0.5 * np.pi, rng.uniform(-np.pi, np.pi)], p=[0.4, 0.1, 0.5]))
    scale = float(10.0 ** rng.uniform(-6.0, 3.0)) if rng.random() < 0.5 else float(rng.uniform(50.0, 500.0))
    origin = scale * rng.uniform(-1000.0, 1000.0, 2) if rng.random() < 0.3 else np.zeros(2)
    drawing = Drawing(family, solver.CreasePattern([(0, 0), (1, 0), (0, 1)]), 0, box, outline, turn, scale, origin)
    creases = []
    for line in lines:
        closed = bool(np.array_equal(line[0], line[-1]))
        creases.append(solver.Crease(drawing.to_drawing(line[:-1] if closed else line), closed=closed))
    rings = [shapely.get_coordinates(ring)[:-1] for ring in (outline.exterior, *outline.interiors)]
    pattern = solver.CreasePattern(
        drawing.to_drawing(rings[0]), [drawing.to_drawing(r) for r in rings[1:]], creases, f"{family} {seed}"
    )
    resolution = _resolution(rng, lines, box)
    return Drawing(family, pattern, resolution, box, outline, turn, scale, origin)


def _aspect(rng: Rng, family: str) -> float:
    if family in _ROUNDISH:
        return float(rng.uniform(1.0, 1.6))
    low, high = [(1.0, 1.0), (1.0, 2.0), (2.0, 5.0), (5.0, 20.0)][rng.choice(4, p=[0.3, 0.4, 0.2, 0.1])]
    return float(np.exp(rng.uniform(np.log(low), np.log(high + 1e-12))))


def _resolution(rng: Rng, lines: list[FloatArray], box: Box) -> int:
    """Fine enough to tell neighbouring creases apart and for a strip to bend in its width."""
    longer = max(1.0, box.height)
    gaps = [longer / rng.integers(*_RESOLUTION_LEAST, endpoint=True)]
    shapes = [LineString(line) for line in lines]
    for k, shape in enumerate(shapes):
        others = [other for other in shapes[:k] if not other.intersects(shape)]
        if others:
            # Creases that meet or nearly touch are told apart by their vertices, not by the grid.
            middle = shape.interpolate(np.linspace(0.2, 0.8, 7), normalized=True)
            apart = np.median([shapely.distance(middle, other).min() for other in others])
            gaps.append(max(float(apart), 0.02 * longer) / _CELLS_BETWEEN)
    return int(max(min(np.ceil(longer / min(gaps)), _RESOLUTION_MOST), np.ceil(_CELLS_ACROSS * longer / box.size)))


# --- sheets ---------------------------------------------------------------------------------------------


def _sheet(rng: Rng, box: Box, family: str) -> Polygon:
    w, h = 1.0, box.height
    kind = rng.choice(["rectangle", "disc", "polygon", "trapezoid", "rounded", "notched"],
                      p=[0.5, 0.1, 0.1, 0.1, 0.1, 0.1])  # fmt: skip
    corners = np.array([(0, 0), (w, 0), (w, h), (0, h)], dtype=float)
    if kind == "disc":
        t = np.linspace(0, 2 * np.pi, 72, endpoint=False)
        sheet = Polygon(box.middle + 0.5 * np.column_stack([w * np.cos(t), h * np.sin(t)]))
    elif kind == "polygon":
        t = 2 * np.pi * (np.arange(int(rng.integers(5, 9))) + rng.random()) / 1.0
        t = np.sort(t / max(len(t), 1) % (2 * np.pi))
        sheet = Polygon(box.middle + 0.5 * np.column_stack([w * np.cos(t), h * np.sin(t)]))
    elif kind == "trapezoid":
        cut = rng.uniform(0.05, 0.2) * w
        sheet = Polygon(corners + np.array([(0, 0), (0, 0), (-cut, 0), (cut, 0)]))
    elif kind == "rounded":
        r = 0.15 * box.size
        sheet = shapely.box(r, r, w - r, h - r).buffer(r, quad_segs=6)
    elif kind == "notched":
        a, b = rng.uniform(0.15, 0.35, 2)
        sheet = Polygon([(0, 0), (w, 0), (w, (1 - b) * h), ((1 - a) * w, (1 - b) * h), ((1 - a) * w, h), (0, h)])
    else:
        sheet = Polygon(corners)
    if rng.random() < 0.15 and family not in _WITHOUT_HOLES:
        centre = np.array([rng.uniform(0.25, 0.75), rng.uniform(0.3, 0.7) * h])
        t = np.linspace(0, 2 * np.pi, 24 if rng.random() < 0.5 else 4, endpoint=False)
        hole = centre + rng.uniform(0.08, 0.18) * box.size * np.column_stack([np.cos(t), np.sin(t)])
        cut_out = sheet.difference(Polygon(hole))
        sheet = cut_out if cut_out.geom_type == "Polygon" else sheet
    return shapely.orient_polygons(sheet)


def _cut(lines: list[FloatArray], sheet: Polygon, box: Box) -> list[FloatArray]:
    """The lines inside the sheet, pieces that are too short left out; whole lines keep their points."""
    result = []
    for line in lines:
        shape = LineString(line)
        if sheet.contains(shape):
            result.append(line)
            continue
        for piece in shapely.get_parts(shapely.line_merge(sheet.intersection(shape, grid_size=0))):
            if piece.geom_type == "LineString" and piece.length > _SHORTEST * box.size:
                result.append(shapely.get_coordinates(piece))
    return result


# --- curves ---------------------------------------------------------------------------------------------

_T = np.linspace(0.0, 1.0, 61)


def _count(rng: Rng, most: int) -> int:
    """Few creases mostly, many sometimes."""
    counts = np.array([1, 2, 3, 4, 5, 6, 8, 12])
    weights = np.array([3, 4, 4, 3, 2, 2, 1.5, 1]) * (counts <= most)
    return int(rng.choice(counts, p=weights / weights.sum()))


def _levels(rng: Rng, count: int) -> FloatArray:
    """Places (count,) of stacked creases in (0, 1), unevenly apart."""
    steps = rng.uniform(0.7, 1.3, count + 1)
    return np.cumsum(steps)[:-1] / steps.sum()


def _stack(rng: Rng, box: Box, shapes: list[FloatArray], levels: FloatArray) -> list[FloatArray]:
    """Graphs over (0, 1), given as offsets in parts of the free room, stacked across either side of the box."""
    upright = bool(rng.random() < (0.3 if box.height > 0.5 else 0.85))
    along, across = (box.height, 1.0) if upright else (1.0, box.height)
    result = []
    for shape, level in zip(shapes, levels, strict=True):
        # A little past the border at both ends: it is cut there, whatever the sheet's shape.
        u = -0.02 + 1.04 * _T
        points = np.column_stack([u * along, level * across + shape * min(along, across)])
        result.append(points[:, ::-1] if upright else points)
    return result


def _arc(sag: float, lean: float = 0.0) -> FloatArray:
    return np.asarray(4 * sag * _T * (1 - _T) + lean * (_T - 0.5))


def arcs(rng: Rng, box: Box) -> list[FloatArray]:
    n = _count(rng, 12)
    sag = rng.uniform(0.05, 0.25) * rng.choice([-1, 1])
    shapes = [_arc(sag * rng.uniform(0.5, 1.0) / n**0.5, rng.uniform(-0.1, 0.1) / n) for _ in range(n)]
    return _stack(rng, box, shapes, _levels(rng, n))


def splines(rng: Rng, box: Box) -> list[FloatArray]:
    n = _count(rng, 8)
    base = sum(rng.uniform(-0.1, 0.1) / k * np.sin(np.pi * k * _T + rng.uniform(0, 6)) for k in (1, 2, 3))
    shapes = [base * rng.uniform(0.5, 1.0) + _arc(rng.uniform(-0.05, 0.05)) / n for _ in range(n)]
    return _stack(rng, box, shapes, _levels(rng, n))


def s_curves(rng: Rng, box: Box) -> list[FloatArray]:
    n = _count(rng, 5)
    a, phase = rng.uniform(0.04, 0.14), rng.choice([0.0, np.pi])
    return _stack(rng, box, [a / n**0.5 * np.sin(2 * np.pi * _T + phase)] * n, _levels(rng, n))


def spirals(rng: Rng, box: Box) -> list[FloatArray]:
    turns, start = rng.uniform(0.6, 1.6), rng.uniform(0, 6)
    arms = int(rng.integers(1, 3))
    t = np.linspace(0.0, 1.0, 121)
    r = box.size * (rng.uniform(0.08, 0.14) + 0.32 * t)
    if rng.random() < 0.5:
        r = r * 1.8  # out over the border
    angle = start + 2 * np.pi * turns * t
    return [box.middle + r[:, None] * np.column_stack([np.cos(angle + k * np.pi), np.sin(angle + k * np.pi)])
            for k in range(arms)]  # fmt: skip


def _ring(
    centre: FloatArray, radius: float, squash: float = 1.0, wave: float = 0.0, turn: float = 0.0
) -> FloatArray:
    t = np.linspace(0.0, 2 * np.pi, 97)
    r = radius * (1 + wave * np.cos(3 * t))
    c, s = np.cos(turn), np.sin(turn)
    points = np.column_stack([r * np.cos(t), squash * r * np.sin(t)]) @ np.array([[c, s], [-s, c]])
    points[-1] = points[0]
    return np.asarray(centre + points)


def closed(rng: Rng, box: Box) -> list[FloatArray]:
    if rng.random() < 0.7:
        return [_ring(box.middle + rng.uniform(-0.05, 0.05, 2) * box.size, rng.uniform(0.2, 0.36) * box.size,
                      rng.uniform(0.7, 1.0), rng.uniform(0, 0.1), rng.uniform(0, 3))]  # fmt: skip
    return [_ring(np.array([x, 0.5 * box.height]), rng.uniform(0.14, 0.2) * min(box.height, 0.9),
                  rng.uniform(0.8, 1))
            for x in (0.26, 0.74)]  # fmt: skip


def concentric(rng: Rng, box: Box) -> list[FloatArray]:
    n = int(rng.integers(2, 6))
    if rng.random() < 0.4:
        radii = np.linspace(0.15, 0.44, n) * box.size
        return [_ring(box.middle, float(r)) for r in radii]
    centre = np.array([rng.uniform(-0.2, 0.2), -rng.uniform(0.1, 0.5) * box.size])
    far = float(np.hypot(1.0, box.height))
    t = np.linspace(0.0, np.pi, 121)
    return [centre + r * np.column_stack([np.cos(t), np.sin(t)]) for r in np.linspace(0.45, 0.95, n) * far]


def parallel(rng: Rng, box: Box) -> list[FloatArray]:
    n = int(rng.choice([2, 3, 4, 6, 9, 14, 20, 30]))
    shape = _arc(rng.uniform(0.05, 0.2)) if rng.random() < 0.6 else rng.uniform(0.02, 0.07) * np.sin(4 * np.pi * _T)
    return _stack(rng, box, [shape] * n, (np.arange(n) + 1.0) / (n + 1.0))


def mirrored(rng: Rng, box: Box) -> list[FloatArray]:
    n = int(rng.integers(1, 4))
    levels = 0.5 + np.arange(1, n + 1) * 0.42 / (n + 0.5)
    shapes = [_arc(rng.uniform(-0.4, 0.4) / (n + 1.5)) for _ in range(n)]
    return _stack(rng, box, [*shapes, *(-s for s in shapes)], np.concatenate([levels, 1 - levels]))


def stars(rng: Rng, box: Box) -> list[FloatArray]:
    arms, bow, start = int(rng.integers(3, 9)), rng.uniform(-0.12, 0.12), rng.uniform(0, 6)
    centre = box.middle + rng.uniform(-0.08, 0.08, 2) * box.size
    spread = rng.uniform(-0.25, 0.25, arms) / arms
    result = []
    for k in range(arms):
        angle = start + 2 * np.pi * (k / arms + spread[k])
        way = np.array([np.cos(angle), np.sin(angle)])
        side = np.array([-way[1], way[0]])
        r = 1.5 * _T[:, None]
        result.append(centre + r * way + bow * (r**2 - 0.3 * r) * side)
    return result


def crossings(rng: Rng, box: Box) -> list[FloatArray]:
    one, two = (int(v) for v in rng.integers(1, 4, 2))
    sag = rng.uniform(-0.15, 0.15, 2)
    u = -0.02 + 1.04 * _T
    across = [np.column_stack([u, (level + _arc(sag[0], rng.uniform(-0.1, 0.1))) * box.height])
              for level in _levels(rng, one)]  # fmt: skip
    upward = [np.column_stack([level + _arc(sag[1], rng.uniform(-0.1, 0.1)) * box.size, u * box.height])
              for level in _levels(rng, two)]  # fmt: skip
    return across + upward


def loops(rng: Rng, box: Box) -> list[FloatArray]:
    t = np.linspace(-1.02, 1.02, 161)
    width, height = rng.uniform(0.8, 1.0), rng.uniform(0.5, 0.75) * box.height
    x = 0.5 + width * (rng.uniform(1.6, 2.0) * t**3 - t)
    return [np.column_stack([x, rng.uniform(0.1, 0.25) * box.height + height * (1 - t**2)])]


def cusps(rng: Rng, box: Box) -> list[FloatArray]:
    t = np.linspace(-1.02, 1.02, 121)
    power, depth = rng.uniform(0.4, 0.75), rng.uniform(0.2, 0.5) * box.height * rng.choice([-1, 1])
    middle = rng.uniform(0.4, 0.6)
    base = (0.3 if depth > 0 else 0.7) * box.height
    return [np.column_stack([middle + (0.5 + abs(middle - 0.5)) * t, base + depth * np.abs(t) ** power])]


def hairpins(rng: Rng, box: Box) -> list[FloatArray]:
    t = np.linspace(-1.0, 1.0, 121)
    width, depth = rng.uniform(0.08, 0.16), rng.uniform(0.6, 0.85)
    pin = np.column_stack([rng.uniform(0.4, 0.6) + width * t, box.height * (depth - (depth + 0.02) * t**4)])
    if rng.random() < 0.3:
        return [pin]
    u = -0.02 + 1.04 * _T
    level = rng.uniform(0.3, 0.5)
    return [pin, np.column_stack([u, (level + _arc(rng.uniform(0.03, 0.1), rng.uniform(-0.1, 0.1))) * box.height])]


def t_joints(rng: Rng, box: Box) -> list[FloatArray]:
    u = -0.02 + 1.04 * _T
    bar = np.column_stack([u, (rng.uniform(0.35, 0.5) + _arc(rng.uniform(-0.15, 0.15))) * box.height])
    result = [bar]
    for x in rng.choice([0.25, 0.5, 0.75], int(rng.integers(1, 3)), replace=False):
        foot = np.array([x, np.interp(x, bar[:, 0], bar[:, 1])])
        top = np.array([x + rng.uniform(-0.12, 0.12), 1.02 * box.height])
        side = np.array([-(top - foot)[1], (top - foot)[0]])
        result.append(foot + _T[:, None] * (top - foot) + _arc(rng.uniform(0.03, 0.1))[:, None] * side)
    return result


def near_tangencies(rng: Rng, box: Box) -> list[FloatArray]:
    """Two curves that come within a hair of each other, or touch."""
    gap = float(rng.choice([0.0, 0.004, 0.01, 0.02, 0.04]))
    sag = rng.uniform(0.08, 0.2)
    return _stack(rng, box, [_arc(sag) - sag - 0.5 * gap, -_arc(sag) + sag + 0.5 * gap], np.array([0.5, 0.5]))


def free_ends(rng: Rng, box: Box) -> list[FloatArray]:
    result = []
    for level in _levels(rng, int(rng.integers(1, 4))):
        start, stop = (-0.02, rng.uniform(0.5, 0.8)) if rng.random() < 0.6 else (0.2, 0.8)
        u = start + (stop - start) * _T
        result.append(np.column_stack([u, level * box.height + box.size * _arc(rng.uniform(0.05, 0.12))]))
    return result


def straight(rng: Rng, box: Box) -> list[FloatArray]:
    n = _count(rng, 6)
    return _stack(rng, box, [_arc(0.0, rng.uniform(-0.15, 0.15) / n) for _ in range(n)], _levels(rng, n))


def mixed(rng: Rng, box: Box) -> list[FloatArray]:
    """Straight lines, arcs, S and waves on one sheet, sometimes with a crease that crosses or ends inside."""
    n = int(rng.integers(2, 6))
    kinds = [
        lambda: _arc(rng.uniform(-0.2, 0.2) / n),
        lambda: _arc(0.0, rng.uniform(-0.1, 0.1) / n),
        lambda: 0.15 / n * np.sin(2 * np.pi * _T),
        lambda: 0.1 / n * np.sin(3 * np.pi * _T),
    ]
    result = _stack(rng, box, [kinds[int(rng.integers(4))]() for _ in range(n)], _levels(rng, n))
    if rng.random() < 0.3:
        result += t_joints(rng, box)[1:]
    return result


FAMILIES: dict[str, Family] = {
    "arcs": arcs, "splines": splines, "s": s_curves, "spirals": spirals, "closed": closed,
    "concentric": concentric, "parallel": parallel, "mirrored": mirrored, "stars": stars,
    "crossings": crossings, "loops": loops, "cusps": cusps, "hairpins": hairpins, "t joints": t_joints,
    "near tangencies": near_tangencies, "free ends": free_ends, "straight": straight, "mixed": mixed,
}  # fmt: skip
#: Families whose curves are round, and do not fit a strip.
_ROUNDISH = {"closed", "concentric", "spirals", "stars", "loops", "hairpins"}
#: Families whose middle must be there.
_WITHOUT_HOLES = {"stars", "loops", "cusps", "hairpins", "spirals", "closed"}
