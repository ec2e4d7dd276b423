"""From the controls of a fold that is finished to the settings of the paper that goes on from it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import bpy
import numpy as np

from ...solver import Amount, Angle, Curve, Glue, Keep, Pair, Side, Weights
from ...solver.controls.control import Control, crease_index
from ...solver.controls.space_curve import resampled
from .controls import DrawnCrease

#: So many straight pieces stand for a curve in space.
_PIECES = 96


def keep_controls(
    paper: Any, controls: Sequence[Control], weights: Weights, drawn: Sequence[DrawnCrease], scale: float
) -> None:
    """Says in the paper object's settings what the controls say. scale: the paper's units in one of the drawing's.

    Curves given by points become curve objects that ride on the paper.
    """
    settings = paper.data.curvefold
    labels = [crease.label for crease in drawn]
    for entry in fields(Weights):
        setattr(settings.weights, entry.name, getattr(weights, entry.name))
    for control in controls:
        if isinstance(control, Pair | Keep | Glue):
            _keep_joint(settings.joints.add(), control, len(settings.joints), scale)
        elif isinstance(control, Angle) and control.at is not None:
            _keep_angle(settings.angles.add(), control, len(settings.angles), scale)
        elif isinstance(control, Side | Amount | Angle | Curve) and control.crease is not None:
            crease = settings.creases[crease_index(labels, control.crease)]
            _keep_crease(crease, control, scale)
            if isinstance(control, Curve) and control.points is not None:
                crease.flow, crease.curve = "OBJECT", _curve_object(paper, crease.name, control.points, scale)


def _keep_crease(crease: Any, control: Side | Amount | Angle | Curve, scale: float) -> None:
    if isinstance(control, Side):
        crease.side = control.side
    elif isinstance(control, Amount):
        crease.amount = 100.0 * control.part
    elif isinstance(control, Angle):
        crease.use_angle, crease.signed, crease.angle = True, control.signed, math.radians(control.degrees)
    else:
        crease.flow, crease.progress = "SHAPE", 100.0 * control.progress
        crease.flow_speed, crease.flow_strength = control.speed, control.strength
        crease.curvature_times = control.curvature_times
        crease.curvature_plus, crease.torsion_plus = control.curvature_plus / scale, control.torsion_plus / scale


def _curve_object(paper: Any, name: str, points: Sequence[Sequence[float]], scale: float) -> Any:
    """A new curve object, a child of the paper, along points (n,3) in the drawing's units."""
    given = np.array(points) * scale
    length = float(np.linalg.norm(np.diff(given, axis=0), axis=1).sum())
    places = resampled(given, np.linspace(0.0, length, _PIECES + 1))
    curve = bpy.data.curves.new(f"{name} Target", "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("POLY")
    spline.points.add(len(places) - 1)
    spline.points.foreach_set("co", np.column_stack([places, np.ones(len(places))]).ravel())
    item = bpy.data.objects.new(curve.name, curve)
    item.parent = paper
    item.hide_render = True
    for collection in paper.users_collection:
        collection.objects.link(item)
    return item


def _keep_angle(angle: Any, control: Angle, number: int, scale: float) -> None:
    assert control.at is not None
    angle.name = f"Angle {number}"
    angle.at = _scaled(control.at, scale)
    angle.angle, angle.signed, angle.strength = math.radians(control.degrees), control.signed, control.strength


def _keep_joint(joint: Any, control: Pair | Keep | Glue, number: int, scale: float) -> None:
    joint.name = f"Joint {number}"
    joint.strength = control.strength
    if isinstance(control, Keep):
        joint.family, joint.shape, joint.first = "PATCH", control.shape.upper(), _scaled(control.at, scale)
    elif isinstance(control, Glue):
        joint.family, joint.bending = "BORDERS", control.bending
        ends = [_scaled(end, scale) for end in (*control.first, *control.second)]
        joint.first, joint.second, joint.third, joint.fourth = ends
    else:
        joint.first, joint.second = _scaled(control.first, scale), _scaled(control.second, scale)
        joint.axes = control.axes
        joint.relation = "MEET" if all(control.axes) else "SHARE"
        if control.distance is not None:
            joint.relation, joint.distance = "DISTANCE", control.distance * scale


def _scaled(point: Sequence[float], scale: float) -> tuple[float, float]:
    return point[0] * scale, point[1] * scale
