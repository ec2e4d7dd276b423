"""The sidebar's panels about creases, joints and patches of a paper, and about its weights."""

from typing import ClassVar

import bpy

from . import live, wording
from .control_properties import WEIGHTS
from .panel_parts import KeptBox, PaperPanel, paper_settings, settings_column, switched_row

#: More sentences about what cannot be had than this are not shown.
MOST_LACKS = 4
#: Lines that are kept free below the creases, for the active one and what cannot be had.
LINES = 4
#: The part of a line in the list of creases that belongs to the name.
NAME_PART = 0.66


class CreaseList(bpy.types.UIList):
    """The creases of a paper"""

    bl_idname = "CURVEFOLD_UL_creases"

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.PropertyGroup,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
        index: int = 0,
        flt_flag: int = 0,
    ) -> None:
        found = live.crease_report(data.id_data, index)
        side = "U" if found is None else found.found
        row = layout.split(factor=NAME_PART)
        row.label(text=item.name, icon=wording.SIDE_ICONS[side])
        row = row.row(align=True)
        row.alignment = "RIGHT"
        if found is not None:
            row.label(text=wording.angle(found), icon="NONE" if found.folded or side == "U" else "ERROR")
        if item.side in ("V", "M"):
            row.label(text="", icon="LOCKED")


class CreasesPanel(PaperPanel, bpy.types.Panel):
    """What became of each crease, and what it is told"""

    bl_idname = "CURVEFOLD_PT_creases"
    bl_label = "Creases"

    def draw(self, context: bpy.types.Context) -> None:
        settings = paper_settings(self.layout, context)
        row = self.layout.row()
        row.template_list(CreaseList.bl_idname, "", settings, "creases", settings, "active_crease", rows=4)
        column = row.column(align=True)
        column.operator("curvefold.pick_crease", text="", icon="EYEDROPPER")
        column.operator("curvefold.flip_crease", text="", icon="ARROW_LEFTRIGHT")
        column.separator()
        column.operator("curvefold.lock_sides", text="", icon="LOCKED")
        column.operator("curvefold.free_sides", text="", icon="UNLOCKED")
        if settings.active_crease < len(settings.creases):
            _draw_crease(self.layout, settings.creases[settings.active_crease])
        self.layout.prop(settings, "use_assignments", text="Sides of the Drawing Hold")
        box = KeptBox(self.layout, context, LINES)
        found = live.crease_report(settings.id_data, settings.active_crease)
        if found is not None and settings.active_crease < len(settings.creases):
            box.say(f"{settings.creases[settings.active_crease].name}: {wording.crease(found)}", "INFO")
        report = live.report(settings.id_data)
        for lack in () if report is None else report.lacks[:MOST_LACKS]:
            box.say(lack, "ERROR", alert=True)
        box.fill()


def _draw_crease(layout: bpy.types.UILayout, crease: bpy.types.PropertyGroup) -> None:
    layout.row(align=True).prop(crease, "side", expand=True)
    column = settings_column(layout)
    row = column.row(heading="Own Angle", align=True)
    row.prop(crease, "use_angle", text="")
    part = row.row(align=True)
    part.active = crease.use_angle
    part.prop(crease, "angle", text="")
    part.prop(crease, "signed", toggle=True)
    part = column.column()
    part.active = not crease.use_angle
    part.prop(crease, "amount", slider=True)


class FlowPanel(PaperPanel, bpy.types.Panel):
    """The shape in space that the active crease is given"""

    bl_idname = "CURVEFOLD_PT_flow"
    bl_label = "Shape in Space"
    bl_parent_id = "CURVEFOLD_PT_creases"

    def draw(self, context: bpy.types.Context) -> None:
        settings = paper_settings(self.layout, context)
        if settings.active_crease >= len(settings.creases):
            return
        crease = settings.creases[settings.active_crease]
        self.layout.row(align=True).prop(crease, "flow", expand=True)
        column = settings_column(self.layout)
        if crease.flow == "OBJECT":
            column.prop(crease, "curve")
        elif crease.flow == "SHAPE":
            part = column.column(align=True)
            part.use_property_split = False  # their names are too long to stand beside the numbers
            part.prop(crease, "curvature_times")
            part.prop(crease, "curvature_plus")
            part.prop(crease, "torsion_plus")
        if crease.flow != "NONE":
            column.prop(crease, "progress", slider=True)
            found = live.crease_report(settings.id_data, settings.active_crease)
            if found is not None and found.progress is not None:
                column.progress(factor=found.progress, text=wording.progress(found))
            column.prop(crease, "flow_speed")
            column.prop(crease, "flow_strength")


class AngleList(bpy.types.UIList):
    """The angles at single points of a paper's creases"""

    bl_idname = "CURVEFOLD_UL_angles"

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.PropertyGroup,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
        index: int = 0,
        flt_flag: int = 0,
    ) -> None:
        row = switched_row(layout, item)
        row.prop(item, "name", text="", emboss=False)
        row.prop(item, "angle", text="")


class PointAnglesPanel(PaperPanel, bpy.types.Panel):
    """Fold angles at single points of creases"""

    bl_idname = "CURVEFOLD_PT_point_angles"
    bl_label = "Angles at Points"
    bl_parent_id = "CURVEFOLD_PT_creases"

    def draw(self, context: bpy.types.Context) -> None:
        settings = paper_settings(self.layout, context)
        row = self.layout.row(align=True)
        row.operator("curvefold.place_angle", icon="CURSOR")
        row.operator("curvefold.add_angles", text="At Vertices", icon="VERTEXSEL")
        if not settings.angles:
            return
        row = self.layout.row()
        row.template_list(AngleList.bl_idname, "", settings, "angles", settings, "active_angle", rows=3)
        row.operator("curvefold.remove_angle", text="", icon="REMOVE")
        if settings.active_angle < len(settings.angles):
            angle = settings.angles[settings.active_angle]
            column = settings_column(self.layout)
            column.active = angle.enabled
            row = column.row(align=True)
            row.prop(angle, "angle")
            row.prop(angle, "signed", toggle=True)
            column.prop(angle, "strength")


class JointList(bpy.types.UIList):
    """The joints of a paper"""

    bl_idname = "CURVEFOLD_UL_joints"

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.PropertyGroup,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.PropertyGroup,
        active_property: str,
        index: int = 0,
        flt_flag: int = 0,
    ) -> None:
        row = switched_row(layout, item)
        row.prop(item, "name", text="", emboss=False, icon=wording.JOINT_ICONS[item.family])


class JointsPanel(PaperPanel, bpy.types.Panel):
    """Points and borders that are drawn together, and patches that keep their shape"""

    bl_idname = "CURVEFOLD_PT_joints"
    bl_label = "Joints"

    def draw(self, context: bpy.types.Context) -> None:
        settings = paper_settings(self.layout, context)
        column = self.layout.column(align=True)
        column.operator("curvefold.join_points", icon=wording.JOINT_ICONS["POINTS"])
        row = column.row(align=True)
        row.operator("curvefold.glue_borders", text="Glue Borders", icon=wording.JOINT_ICONS["BORDERS"])
        row.operator("curvefold.keep_patch", text="Keep Patch", icon=wording.JOINT_ICONS["PATCH"])
        if not settings.joints:
            return
        row = self.layout.row()
        row.template_list(JointList.bl_idname, "", settings, "joints", settings, "active_joint", rows=3)
        row.operator("curvefold.remove_joint", text="", icon="REMOVE")
        if settings.active_joint < len(settings.joints):
            _draw_joint(self.layout.column(), settings.joints[settings.active_joint])


def _draw_joint(layout: bpy.types.UILayout, joint: bpy.types.PropertyGroup) -> None:
    layout.active = joint.enabled
    if joint.family == "POINTS":
        layout.row(align=True).prop(joint, "relation", expand=True)
    elif joint.family == "PATCH":
        layout.row(align=True).prop(joint, "shape", expand=True)
    column = settings_column(layout)
    if joint.family == "POINTS":
        if joint.relation == "DISTANCE":
            column.prop(joint, "distance")
        elif joint.relation == "SHARE":
            row = column.row(heading="Along", align=True)
            for k, axis in enumerate("XYZ"):
                row.prop(joint, "axes", index=k, text=axis, toggle=True)
    elif joint.family == "BORDERS":
        column.prop(joint, "bending")
        column.prop(joint, "reverse")
    column.prop(joint, "strength")


class WeightsPanel(PaperPanel, bpy.types.Panel):
    """What counts how much when the paper cannot have everything"""

    bl_idname = "CURVEFOLD_PT_weights"
    bl_label = "Weights"
    bl_parent_id = "CURVEFOLD_PT_advanced"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = paper_settings(self.layout, context)
        # Their names are too long to stand beside the numbers.
        column = self.layout.column()
        for name, _, _ in WEIGHTS:
            column.prop(settings.weights, name)
        column.operator("curvefold.usual_weights", icon="LOOP_BACK")
