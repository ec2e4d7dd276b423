"""What a .blend says about drawings and papers: the truth that undo, save, copy and append work on.

A drawing is a sheet (its border) with creases as its children; ``Object.curvefold`` tells which is which.
A paper is a mesh; ``Mesh.curvefold`` holds its settings and handles, the bridge keeps its exact shape beside
them, so that linked duplicates show one paper and copies are papers of their own.
"""

from math import pi, radians

import bpy
from bpy.props import (
    BoolProperty,
    BoolVectorProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..solver.description import LEAST_FOLD
from . import control_properties, handle_choice, live, shown_drawing
from .control_properties import SIDES, CreaseSettings, JointSettings, PointAngleSettings, WeightSettings, wake
from .resolution_property import resolution_property

ROLES = (
    ("NONE", "Neither", "No part of a drawing"),
    ("SHEET", "Sheet", "The border of a sheet of paper"),
    ("CREASE", "Crease", "A curve along which its parent, the sheet, is folded"),
)
#: The letters are FOLD's.
ASSIGNMENTS = (
    *SIDES,
    ("F", "Flat", "Drawn, but not folded"),
)


def _rebuild(settings: bpy.types.bpy_struct, context: bpy.types.Context) -> None:
    """The net has to be made again."""
    live.rebuild(settings.id_data)


def _resheet(settings: bpy.types.bpy_struct, context: bpy.types.Context) -> None:
    """Another drawing, or none: a sheet that somebody takes away was not deleted."""
    if settings.sheet is None:
        settings.sheet_scale = 0.0
    _rebuild(settings, context)


def _rehook(handle: bpy.types.bpy_struct, context: bpy.types.Context) -> None:
    """Another hook: the point stays where it is."""
    live.rehook(handle.id_data, handle)


class DrawingSettings(bpy.types.PropertyGroup):
    """What an object is to a drawing."""

    role: EnumProperty(name="Role", items=ROLES, default="NONE")
    assignment: EnumProperty(name="Assignment", items=ASSIGNMENTS, default="U")
    #: What was decided when the file was read from which it comes, a line each.
    notes: StringProperty(options={"HIDDEN"})
    show: BoolProperty(
        name="Show Drawing",
        description="The border and the creases of the sheet are seen in the viewport; the file keeps them anyway",
        get=lambda settings: shown_drawing.is_shown(settings.id_data),
        set=lambda settings, value: shown_drawing.show(settings.id_data, value),
        options={"SKIP_SAVE"},
    )


class HandleSettings(bpy.types.PropertyGroup):
    """A point of the paper that is held or pulled. ``name`` is Blender's own."""

    hook: PointerProperty(
        name="Hook",
        description="The object that pulls; without one the point is pinned where it is",
        type=bpy.types.Object,
        update=_rehook,
    )
    #: Tells a pin from a handle whose hook was removed from the file.
    pinned: BoolProperty(default=False, options={"HIDDEN"})
    at: FloatVectorProperty(name="Point", description="On the flat sheet", size=2, subtype="XYZ", unit="LENGTH")
    offset: FloatVectorProperty(
        name="Target",
        description="In the hook's own coordinates; for a pin in the paper's",
        size=3,
        subtype="XYZ",
        unit="LENGTH",
        update=wake,
    )
    enabled: BoolProperty(name="Enabled", description="Whether the handle acts", default=True, update=wake)
    axes: BoolVectorProperty(
        name="Axes",
        description="The paper's own axes along which the handle acts; it is free along the others",
        size=3,
        default=(True, True, True),
        subtype="XYZ",
        update=wake,
    )
    strength: FloatProperty(
        name="Strength",
        description="How hard the handle pulls, compared with a usual one",
        default=1.0,
        min=0.01,
        soft_max=10.0,
        max=100.0,
        update=wake,
    )


class PaperSettings(bpy.types.PropertyGroup):
    """How a paper folds."""

    is_paper: BoolProperty(default=False, options={"HIDDEN"})
    sheet: PointerProperty(
        name="Drawing", description="The sheet whose drawing is folded", type=bpy.types.Object, update=_resheet
    )
    #: Of a paper that was folded from a file without a sheet: what was decided when that was read, a line each.
    notes: StringProperty(options={"HIDDEN"})
    #: Scales of the sheet and of the paper's object when they were last compared; 0 without a sheet.
    sheet_scale: FloatProperty(default=0.0, options={"HIDDEN"})
    paper_scale: FloatProperty(default=0.0, options={"HIDDEN"})
    resolution: resolution_property(soft_max=80, update=_rebuild)
    live: BoolProperty(
        name="Live", description="The paper follows its handles and its drawing", default=True, update=wake
    )
    fold: FloatProperty(
        name="Fold",
        description="How far all creases are folded, each on the side it chooses; "
        "at zero, a paper with handles, angles, curves or joints is left to them",
        subtype="PERCENTAGE",
        default=0.0,
        min=0.0,
        max=100.0,
        update=wake,
    )
    angle: FloatProperty(
        name="Full Angle",
        description="The fold angle at 100 %",
        subtype="ANGLE",
        default=radians(90.0),
        min=0.0,
        max=pi,
        update=wake,
    )
    least_fold: FloatProperty(
        name="Least Fold",
        description="Where handles alone bend the paper, every crease is folded at least so far, "
        "softly enough that handles stay where they are; at zero, handles may leave creases flat",
        subtype="ANGLE",
        default=radians(LEAST_FOLD),
        min=0.0,
        max=pi,
        update=wake,
    )
    handles: CollectionProperty(type=HandleSettings)
    active_handle: IntProperty(name="Active Handle", default=0, min=0)
    #: What the list shows as active: it goes with the selection, both ways.
    chosen_handle: IntProperty(
        name="Active Handle", get=handle_choice.chosen, set=handle_choice.choose, options={"SKIP_SAVE"}
    )
    #: One entry for each crease of the drawing, in its order (``bridge.controls.match_creases``).
    creases: CollectionProperty(type=CreaseSettings)
    active_crease: IntProperty(name="Active Crease", default=0, min=0)
    use_assignments: BoolProperty(
        name="Mountains and Valleys of the Drawing",
        description="Creases that have no side of their own here are held to that of the drawing",
        default=True,
        update=wake,
    )
    angles: CollectionProperty(type=PointAngleSettings)
    active_angle: IntProperty(name="Active Angle", default=0, min=0)
    joints: CollectionProperty(type=JointSettings)
    active_joint: IntProperty(name="Active Joint", default=0, min=0)
    weights: PointerProperty(type=WeightSettings)
    iterations_per_frame: IntProperty(
        name="Iterations per Frame",
        description="Solver iterations for each frame of an animation, whatever the computer's speed",
        default=10,
        min=1,
        max=1000,
    )


class OverlaySettings(bpy.types.PropertyGroup):
    """What is drawn over papers in the viewports of a scene."""

    show: BoolProperty(name="Paper Overlays", default=True)
    creases: BoolProperty(name="Creases", description="Creases coloured by the side they folded to", default=True)
    angles: BoolProperty(name="Fold Angles", description="Fold angles in figures", default=False)
    stretch: BoolProperty(name="Stretch", description="Where the paper is stretched", default=False)
    rulings: BoolProperty(name="Rulings", description="The straight lines of the bent paper", default=False)
    gauss_image: BoolProperty(
        name="Gauss Image",
        description="The directions that the paper faces, as points of a ball beside it: of bent paper they are "
        "curves, one colour a patch",
        default=False,
    )
    pulls: BoolProperty(
        name="Pull Lines",
        description="From each handle's point to its target, and between points that are joined",
        default=True,
    )
    troubles: BoolProperty(name="Troubles", description="Where a drawing cannot be folded", default=True)


_CLASSES = (DrawingSettings, HandleSettings, PaperSettings, OverlaySettings)


def register() -> None:
    control_properties.register()
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.curvefold = PointerProperty(type=DrawingSettings)
    bpy.types.Mesh.curvefold = PointerProperty(type=PaperSettings)
    bpy.types.Scene.curvefold = PointerProperty(type=OverlaySettings)


def unregister() -> None:
    del bpy.types.Scene.curvefold
    del bpy.types.Mesh.curvefold
    del bpy.types.Object.curvefold
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
    control_properties.unregister()
