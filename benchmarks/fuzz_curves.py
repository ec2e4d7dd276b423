"""Hostile drawings out of Blender objects: what is a border and what are creases, as JSON. Needs no Blender."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import cos, pi, sin
from random import Random
from typing import Any

#: Coordinates that single precision holds badly or not at all.
ODD = (float("nan"), float("inf"), float("-inf"), 3.4e38, -1e38, 1e20, -1e-38, 1e-20, 0.0)
#: What else could stand where a curve is expected: all that Blender converts a curve to, or from.
TYPES = ("CURVE",) * 30 + ("MESH", "EMPTY", "FONT", "SURFACE")
#: Modifiers: of control points, and of what is made of them.
MODIFIERS = (None,) * 12 + ("HOOK", "ARRAY", "WAVE", "CURVE", "SOFT_BODY")
HANDLE_TYPES = ("FREE", "VECTOR", "ALIGNED", "AUTO")

Item = dict[str, Any]
Point = list[float]


def made_drawing(rng: Random) -> bytes:
    """A sheet and its creases, of which most are true and some are spoilt."""
    size = rng.choice((1.0, 1.0, 1.0, 10.0 ** rng.uniform(-6, 6)))
    drawing: Item = {
        "sheet": _item(rng, _border(rng, size), 0.15),
        "creases": [_item(rng, _crease(rng, size), 0.3) for _ in range(rng.choice((0, 1, 1, 1, 1, 2, 2, 5)))],
        "sheet_from_object": rng.random() < 0.3,
        "resolution": rng.choice((4, 4, 6, 6, 10)),
        "unit": rng.choice((1.0, 1.0, 1e-3, 1e-9, 1e9)),
        "shown": rng.random() < 0.5,
        "looked_at": rng.random() < 0.3,
        "made": rng.random() < 0.15,
    }
    if rng.random() < 0.02 and drawing["creases"]:
        drawing["creases"] = drawing["creases"] * rng.choice((2, 20))
    if rng.random() < 0.3:
        drawing["later"] = _item(rng, _crease(rng, size), 0.5)
    if rng.random() < 0.1:
        drawing["later_border"] = _item(rng, _border(rng, size), 0.5)
    return json.dumps(drawing).encode()


# --- true ones --------------------------------------------------------------------------------------------------


def _border(rng: Random, size: float) -> list[Item]:
    h = 0.5 * size
    kind = rng.randrange(7)
    if kind <= 2:
        found = [_poly([[-h, -h], [h, -h], [h, h], [-h, h]], True)]
    elif kind == 3:
        found = [_smooth(_ring(h, 4), True)]
    elif kind == 4:
        found = [_nurbs(rng, _ring(h, 8), True)]
    elif kind == 5:  # open, its ends all but meet
        found = [_poly([[-h, -h], [h, -h], [h, h], [-h, h], [-h, -h * (1 - 1e-4)]], False)]
    else:
        found = [_poly([[-h, -h], [h, -h]], False), _poly([[h, -h], [0, h], [-h, -h]], False)]
    if rng.random() < 0.2:
        found.append(_poly([[0.4 * x, 0.4 * y] for x, y in _ring(h, rng.choice((3, 5)))], True))
    return found


def _crease(rng: Random, size: float) -> list[Item]:
    h = 0.5 * size
    y = rng.uniform(-h, h)
    kind = rng.randrange(6)
    if kind == 0:
        return [_poly([[-1.1 * h, y], [1.1 * h, rng.uniform(-h, h)]], False)]
    if kind == 1:
        return [_smooth([[-h, y], [0.0, y + 0.3 * h], [h, y]], False)]
    if kind == 2:
        return [_nurbs(rng, [[-h + 0.4 * h * k, rng.uniform(-h, h)] for k in range(6)], False)]
    if kind == 3:
        return [_smooth(_ring(0.5 * h, 4), True)]
    if kind == 4:
        count = rng.choice((5, 5, 60, 60, 600))
        return [_poly([[h * cos(0.1 * k), 0.9 * h * sin(0.07 * k)] for k in range(count)], False)]
    loop = [0.0, 0.2 * h, -0.6 * h, 0.9 * h, 0.6 * h, 0.9 * h]
    return [{"type": "BEZIER", "points": [[*loop[4:], 0.0, *loop[:2], 0.0, *loop[2:4], 0.0]] * 2, "cyclic": True}]


def _ring(radius: float, count: int) -> list[Point]:
    return [[radius * cos(2 * pi * k / count), radius * sin(2 * pi * k / count)] for k in range(count)]


def _poly(points: list[Point], cyclic: bool) -> Item:
    return {"type": "POLY", "points": [[*point, 0.0, 1.0] for point in points], "cyclic": cyclic}


def _nurbs(rng: Random, points: list[Point], cyclic: bool) -> Item:
    flags = {"order": rng.choice((2, 3, 4, 4, 6)), "endpoint": rng.random() < 0.5, "bezier": rng.random() < 0.2}
    return {**_poly(points, cyclic), "type": "NURBS", **flags}


def _smooth(points: list[Point], cyclic: bool) -> Item:
    """Through these points, with handles along the line between the neighbours."""
    rows = []
    for k, (x, y) in enumerate(points):
        (x0, y0), (x1, y1) = points[k - 1], points[(k + 1) % len(points)]
        dx, dy = (x1 - x0) / 6, (y1 - y0) / 6
        rows.append([x - dx, y - dy, 0.0, x, y, 0.0, x + dx, y + dy, 0.0])
    return {"type": "BEZIER", "points": rows, "cyclic": cyclic}


# --- spoilt ones ------------------------------------------------------------------------------------------------


def _item(rng: Random, splines: list[Item], badness: float) -> Item:
    """An object; each thing about it is spoilt with this probability, divided among them."""
    item: Item = {
        "type": "CURVE",
        "splines": splines,
        "dimensions": rng.choice(("2D", "3D")),
        "by_operator": rng.random() < 0.3,
        "assignment": rng.choice("UUUMVF"),
        "above": [],
    }
    while rng.random() < badness:
        rng.choice(_SPOILERS)(rng, item)
    return item


def _spoil_points(rng: Random, item: Item) -> None:
    for spline in item["splines"]:
        rows = spline["points"]
        if not rows or len(rows) > 500:
            continue
        row = rng.choice(rows)
        kind = rng.randrange(7)
        if kind == 0:
            row[rng.randrange(len(row))] = rng.choice(ODD)
        elif kind == 1:  # off the plane
            row[2] += rng.choice((1e-4, 0.1, -50.0, 1e30))
        elif kind == 2:
            del rows[rng.randrange(3) :]
        elif kind == 3:
            rows[:] = [list(row) for _ in rows]
        elif kind == 4:
            rows.extend(list(other) for other in rows[::-1])
        elif kind == 5:
            factor = rng.choice((1e-30, 1e-7, 1e-3, 1e6, 1e37, -1.0, 0.0))
            rows[:] = [[factor * value for value in other[:3]] + other[3:] for other in rows]
        else:
            rows[:] = [[rng.uniform(-1, 1) for _ in other] for other in rows * rng.choice((1, 1, 4))]


def _spoil_splines(rng: Random, item: Item) -> None:
    splines = item["splines"]
    kind = rng.randrange(4)
    if kind == 0:
        splines.clear()
    elif kind == 1:
        splines.append({"type": rng.choice(("POLY", "NURBS", "BEZIER")), "points": [], "cyclic": True})
    elif kind == 2 and splines:
        splines.extend([splines[0]] * rng.choice((1, 1, 30)))
    else:
        points = [[rng.uniform(-1, 1) for _ in range(4)] for _ in range(rng.randrange(1, 9))]
        splines.append({"type": "NURBS", "points": points, "cyclic": rng.random() < 0.5})


def _spoil_kind_of_spline(rng: Random, item: Item) -> None:
    for spline in item["splines"]:
        spline["cyclic"] = rng.random() < 0.5
        spline["order"] = rng.choice((0, 1, 2, 3, 5, 64))
        spline["endpoint"], spline["bezier"] = rng.random() < 0.5, rng.random() < 0.5
        spline["resolution"] = rng.choice((0, 1, 64, 1024))
        spline["handles"] = rng.choice(HANDLE_TYPES)
        if spline["type"] != "BEZIER" and spline["points"]:
            if rng.random() < 0.5:
                spline["type"] = "NURBS"
            for row in spline["points"]:
                row[3] = rng.choice((1.0, 1.0, 0.0, -1.0, 1e-30, 1e30))


def _place(rng: Random) -> Item:
    return {
        "location": [rng.choice((0.0, 0.0, 1.0, 1e6, 1e30)) * rng.uniform(-1, 1) for _ in range(3)],
        "rotation": [rng.choice((0.0, 0.0, pi / 2, 1.0, 1e10)) for _ in range(3)],
        "scale": [rng.choice((1.0, 1.0, -1.0, 2.0, 0.0, 1e-12, 1e12, *ODD)) for _ in range(3)],
    }


def _spoil_place(rng: Random, item: Item) -> None:
    item["place"] = _place(rng)


def _spoil_parents(rng: Random, item: Item) -> None:
    item["above"] = [_place(rng) for _ in range(rng.randrange(1, 4))]
    # An inverse that shears, as parenting to a turned and scaled object leaves it.
    item["inverse"] = [rng.choice((0.0, 1.0, rng.uniform(-2, 2), rng.choice(ODD))) for _ in range(16)]


def _spoil_other_things(rng: Random, item: Item) -> None:
    item["type"] = rng.choice(TYPES)
    item["modifier"] = rng.choice(MODIFIERS)
    item["shape_key"] = rng.random() < 0.2
    item["constraint"] = rng.random() < 0.1
    item["hidden"] = rng.random() < 0.2
    item["shares"] = rng.random() < 0.2


_SPOILERS: tuple[Callable[[Random, Item], None], ...] = (
    _spoil_points,
    _spoil_points,
    _spoil_points,
    _spoil_splines,
    _spoil_kind_of_spline,
    _spoil_place,
    _spoil_parents,
    _spoil_other_things,
)
