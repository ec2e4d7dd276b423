"""Rulings and Gauss images as objects that can be kept, rendered and exported: Curve objects, a spline a line."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ...solver import FoldResult, PiecewiseDog, RulingKind, gauss_image, rulings
from ...solver.arrays import FloatArray, IntArray
from ...solver.net.carry_over import scaled
from . import linked
from .drawn import Color
from .gauss_ball import BALL, PATCH_COLORS, beside, box, great_circles, longer_side
from .mesh import metres_per_unit
from .overlay import RULING_COLORS

#: Radius of a ruling's line, relative to the sheet's longer side: a line that shows in a small picture.
_RULING_LINE = 1.5e-3
#: Radii of the lines of a Gauss image and of the circles round its ball, relative to the ball.
_IMAGE_LINE, _CIRCLE_LINE = 8e-3, 3e-3

#: A name and a display colour (sRGB).
Look = tuple[str, Color]

RULING_LOOKS: tuple[Look, ...] = tuple(
    (f"Curvefold {kind.name.capitalize()} Ruling", RULING_COLORS[kind]) for kind in RulingKind
)
PATCH_LOOKS: tuple[Look, ...] = tuple(
    (f"Curvefold Patch {number}", color) for number, color in enumerate(PATCH_COLORS, 1)
)
BALL_LOOK: Look = ("Curvefold Gauss Ball", BALL)


def add_rulings(paper: Any, net: PiecewiseDog, positions: FloatArray, materials: list[Any]) -> Any:
    """The rulings of a paper at positions (V,3) as its child; None where it has none.

    materials: one for each of RULING_LOOKS.
    """
    found = rulings(net, positions)
    if len(found.segments) == 0:
        return None
    curve = _new_curve(f"{paper.name} Rulings", materials, _RULING_LINE * longer_side(net))
    _add_lines(curve, found.segments, found.kind)
    return _add_child(paper, curve)


def add_gauss_image(paper: Any, net: PiecewiseDog, positions: FloatArray, materials: list[Any]) -> Any:
    """The Gauss image of a paper at positions (V,3) on a ball beside it, as its child.

    The curve's own coordinates are those of the unit ball. materials: one for each of PATCH_LOOKS, then the ball's.
    """
    strokes, patch = gauss_image(net, positions).strokes()
    curve = _new_curve(f"{paper.name} Gauss Image", materials, _IMAGE_LINE)
    _add_lines(curve, strokes, patch % len(PATCH_LOOKS))
    for circle in great_circles():
        spline = _add_spline(curve, circle, len(PATCH_LOOKS))
        spline.use_cyclic_u = True
        spline.points.foreach_set("radius", np.full(len(circle), _CIRCLE_LINE / _IMAGE_LINE, dtype=np.float32))
    low, high = box(net.render_map.apply(positions))
    place = beside(low, high, longer_side(net), (1.0, 0.0, 0.0))
    item = _add_child(paper, curve)
    # On the table, where the paper lies on one.
    item.location = (*place.centre[:2], low[2] + place.radius)
    item.scale = (place.radius,) * 3
    return item


def in_metres(result: FoldResult) -> tuple[PiecewiseDog, FloatArray]:
    """Net and positions of a fold in the units of its paper in Blender."""
    scale = metres_per_unit(result.pattern.unit_mm)
    return scaled(result.net, scale), result.positions * scale


def _new_curve(name: str, materials: list[Any], line: float) -> Any:
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = line
    curve.bevel_resolution = 1
    curve.use_fill_caps = True
    for material in materials:
        curve.materials.append(material)
    return curve


def _add_lines(curve: Any, segments: FloatArray, material: IntArray) -> None:
    for ends, index in zip(segments, material.tolist(), strict=True):
        _add_spline(curve, ends, index)


def _add_spline(curve: Any, points: FloatArray, material: int) -> Any:
    spline = curve.splines.new("POLY")
    spline.points.add(len(points) - 1)
    values = np.column_stack([points, np.ones(len(points))]).astype(np.float32)
    spline.points.foreach_set("co", values.ravel())
    spline.material_index = material
    return spline


def _add_child(paper: Any, curve: Any) -> Any:
    item = bpy.data.objects.new(curve.name, curve)
    for collection in linked.homes_beside(paper):
        collection.objects.link(item)
    item.parent = paper
    return item
