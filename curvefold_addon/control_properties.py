"""What a .blend says about the creases, joints and patches of a paper."""

from math import pi

import bpy
from bpy.props import (
    BoolProperty,
    BoolVectorProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    PointerProperty,
)

from .. import solver
from ..solver.description import MOST_WEIGHT
from . import live

SIDES = (
    ("U", "Free", "The paper chooses the side"),
    ("V", "Valley", "Folds towards the front"),
    ("M", "Mountain", "Folds towards the back"),
)

FLOWS = (
    ("NONE", "None", "The crease takes what shape it likes"),
    ("SHAPE", "Curvature", "The crease gets another curvature and torsion, anywhere in space"),
    ("OBJECT", "Curve", "The crease follows a curve object"),
)


def wake(settings: bpy.types.bpy_struct, context: bpy.types.Context) -> None:
    """A value has changed: the paper moves."""
    live.wake(settings.id_data)


class CreaseSettings(bpy.types.PropertyGroup):
    """How one crease folds. ``name`` is Blender's own: that of the crease in the drawing."""

    side: EnumProperty(name="Side", description="The side to which it is held", items=SIDES, update=wake)
    amount: FloatProperty(
        name="Amount",
        description="How much of the paper's fold this crease takes",
        subtype="PERCENTAGE",
        default=100.0,
        min=0.0,
        max=200.0,
        soft_max=100.0,
        update=wake,
    )
    use_angle: BoolProperty(name="Own Angle", description="Fold it to an angle of its own", update=wake)
    angle: FloatProperty(
        name="Angle",
        description="The angle to which it is folded; with Signed, a valley is positive and a mountain negative",
        subtype="ANGLE",
        default=pi / 3,
        min=-pi,
        max=pi,
        update=wake,
    )
    signed: BoolProperty(
        name="Signed", description="The sign of the angle counts; else the paper chooses the side", update=wake
    )
    flow: EnumProperty(name="Flow", items=FLOWS, default="NONE", update=wake)
    curve: PointerProperty(
        name="Curve",
        description="The curve object that the crease follows",
        type=bpy.types.Object,
        poll=lambda self, item: item.type == "CURVE" and item.curvefold.role == "NONE",
        update=wake,
    )
    curvature_times: FloatProperty(
        name="Curvature Times",
        description="The drawn curvature is multiplied by this; folding only makes a crease sharper",
        default=1.2,
        min=0.0,
        soft_min=1.0,
        soft_max=3.0,
        update=wake,
    )
    curvature_plus: FloatProperty(
        name="Curvature Plus",
        description="Added to the curvature, in one over the length unit",
        update=wake,
    )
    torsion_plus: FloatProperty(
        name="Torsion", description="How much the curve winds, in radians over the length unit", update=wake
    )
    progress: FloatProperty(
        name="Progress",
        description="The part of the way from the flat crease to the curve",
        subtype="PERCENTAGE",
        default=100.0,
        min=0.0,
        max=100.0,
        update=wake,
    )
    flow_speed: FloatProperty(
        name="Speed",
        description="How fast the crease goes there, compared with the usual; slower is gentler to the paper",
        default=1.0,
        min=0.01,
        soft_min=0.1,
        soft_max=5.0,
        max=100.0,
        update=wake,
    )
    flow_strength: FloatProperty(
        name="Strength",
        description="How hard the curve pulls, compared with a usual one",
        default=1.0,
        min=0.01,
        soft_max=10.0,
        max=100.0,
        update=wake,
    )


class PointAngleSettings(bpy.types.PropertyGroup):
    """A fold angle at one point of a crease. ``name`` is Blender's own."""

    enabled: BoolProperty(name="Enabled", description="Whether it acts", default=True, update=wake)
    at: FloatVectorProperty(
        name="Point", description="On the flat sheet", size=2, subtype="XYZ", unit="LENGTH", update=wake
    )
    angle: FloatProperty(
        name="Angle",
        description="The fold angle at this point; with Signed, a valley is positive and a mountain negative",
        subtype="ANGLE",
        default=pi / 3,
        min=-pi,
        max=pi,
        update=wake,
    )
    signed: BoolProperty(
        name="Signed", description="The sign of the angle counts; else the paper chooses the side", update=wake
    )
    strength: FloatProperty(
        name="Strength",
        description="How hard it pulls, compared with a usual one",
        default=1.0,
        min=0.01,
        soft_max=10.0,
        max=100.0,
        update=wake,
    )


FAMILIES = (
    ("POINTS", "Points", "Two points of the sheet"),
    ("BORDERS", "Borders", "Two stretches of the border"),
    ("PATCH", "Patch", "The piece between creases"),
)
RELATIONS = (
    ("MEET", "Meet", "They come to the same place"),
    ("SHARE", "Share", "They share some of their coordinates"),
    ("DISTANCE", "Distance", "They are so far apart"),
)
SHAPES = (
    ("FLAT", "Flat", "It stays plane, or becomes so"),
    ("RIGID", "Rigid", "It stays bent as it is; in an animation, which begins flat, it stays plane"),
)


def _point(name: str) -> object:
    return FloatVectorProperty(
        name=name, description="On the flat sheet", size=2, subtype="XYZ", unit="LENGTH", update=wake
    )


class JointSettings(bpy.types.PropertyGroup):
    """Points or borders that are drawn together, or a patch that keeps its shape. ``name`` is Blender's own.

    first and second: the points, or the ends of one border, whose other one ends at third and fourth; first: in
    the patch.
    """

    family: EnumProperty(name="Family", items=FAMILIES, default="POINTS", options={"HIDDEN"})
    enabled: BoolProperty(name="Enabled", description="Whether it acts", default=True, update=wake)
    first: _point("First")
    second: _point("Second")
    third: _point("Third")
    fourth: _point("Fourth")
    relation: EnumProperty(name="They", items=RELATIONS, default="MEET", update=wake)
    axes: BoolVectorProperty(
        name="Axes",
        description="The coordinates that they share, along the paper's own axes",
        size=3,
        default=(False, False, True),
        subtype="XYZ",
        update=wake,
    )
    distance: FloatProperty(
        name="Distance", description="How far apart they are to be", min=0.0, unit="LENGTH", update=wake
    )
    shape: EnumProperty(name="Keep", items=SHAPES, default="FLAT", update=wake)
    bending: BoolProperty(
        name="Bend Across",
        description="The paper goes on smoothly across the seam; else it may have a kink there",
        default=True,
        update=wake,
    )
    reverse: BoolProperty(
        name="Other Way Round", description="Glue the ends of one border to the opposite ends", update=wake
    )
    strength: FloatProperty(
        name="Strength",
        description="How hard it pulls, compared with a usual one",
        default=1.0,
        min=0.01,
        soft_max=10.0,
        max=100.0,
        update=wake,
    )


def _weight(name: str, default: float, words: str, description: str) -> object:
    return FloatProperty(
        name=words,
        description=description,
        default=default,
        min=0.0 if name not in _NEEDED else 1e-3,
        max=MOST_WEIGHT,
        soft_max=100.0 * default,
        options=set(),  # the solver begins anew with other weights, so they are no matter for animation
        update=wake,
    )


#: Paper without these is none.
_NEEDED = ("bending", "isometry", "continuity")
#: (the solver's name, in words, description)
WEIGHTS = (
    ("bending", "Stiffness", "How much the paper resists bending"),
    ("isometry", "Resist Stretching", "How much the paper resists being stretched"),
    ("continuity", "Hold Together", "How tightly the pieces between the creases are joined"),
    ("handles", "Pull of Handles", "How hard handles pull"),
    ("fold_angle", "Pull of Angles", "How hard creases are driven to their fold angles"),
    ("drive", "Fold", "How hard the Fold slider pulls all creases"),
    ("least_fold", "Least Fold", "How hard creases are pulled to their least fold beside handles"),
    ("fold_condition", "Keep Folded", "How hard creases are kept folded along all of their length"),
    ("sides", "Pull of Sides", "How hard creases are held to valley and mountain"),
    ("pairs", "Pull of Joints", "How hard joined points and glued borders are drawn together"),
    ("patches", "Pull of Patches", "How hard patches are kept in their shape"),
    ("curves", "Pull of Curves", "How hard creases are drawn to the curves that they are given"),
)


class WeightSettings(bpy.types.PropertyGroup):
    """What counts how much when the paper cannot have everything."""

    __annotations__ = {  # Blender reads its properties from here
        name: _weight(name, getattr(solver.Weights(), name), words, description)
        for name, words, description in WEIGHTS
    }


_CLASSES = (CreaseSettings, PointAngleSettings, JointSettings, WeightSettings)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
