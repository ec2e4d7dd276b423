"""The sidebar tab: what is going on, and what can be done next."""

from typing import ClassVar

import bpy

from . import drawing_context, live, wording
from .bridge import baking, by_hand, drawing_objects
from .bridge.state import AUTOMATIC
from .control_panels import (
    AngleList,
    CreaseList,
    CreasesPanel,
    FlowPanel,
    JointList,
    JointsPanel,
    PointAnglesPanel,
    WeightsPanel,
)
from .operators.add_sample import SampleMenu
from .overlay import trouble_marks
from .panel_parts import PaperPanel, Tab, say, switched_row


class MainPanel(Tab, bpy.types.Panel):
    """How the paper stands, and the next step"""

    bl_label = "Curvefold"
    bl_idname = "CURVEFOLD_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        paper, sheet = live.active_paper(context), drawing_context.active_sheet(context)
        active = context.active_object
        if active is not None and drawing_objects.has_lost_sheet(active):
            say(self.layout, context, f"{active.name} {wording.LOST_CREASE}", "ERROR", alert=True)
        if paper is not None and not _is_drawing(context):
            _draw_standing(self.layout, context, paper)
        elif sheet is not None:
            _draw_sheet(self.layout, context, sheet)
        else:
            _draw_beginning(self.layout, context)


def _is_drawing(context: bpy.types.Context) -> bool:
    """Whether the user is at a drawing, and not at a paper that follows it."""
    return context.active_object is not None and drawing_objects.is_part(context.active_object)


def _draw_beginning(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    say(layout, context, wording.NO_SHEET, "INFO")
    column = layout.column(align=True)
    column.scale_y = 1.2
    column.operator_menu_enum("curvefold.add_sheet", "size", text="Paper Sheet", icon="MESH_PLANE")
    column.menu(SampleMenu.bl_idname, text="Sample", icon="IMAGE_DATA")
    column.operator("curvefold.import_drawing", text="Drawing…", icon="FILE_FOLDER")
    if bpy.ops.curvefold.sheet_from_object.poll():
        layout.operator("curvefold.sheet_from_object", icon="OUTLINER_OB_CURVE")


def _draw_sheet(layout: bpy.types.UILayout, context: bpy.types.Context, sheet: bpy.types.Object) -> None:
    creases = sum(drawing_objects.is_crease(child) for child in sheet.children)
    layout.label(text=f"{sheet.name}: {wording.count(creases, 'crease')}", icon="OUTLINER_OB_CURVE")
    _draw_drawing_tools(layout, context, sheet)
    if context.mode == "EDIT_CURVE" and drawing_objects.is_crease(context.active_object):
        say(layout, context, wording.DRAWING, "INFO")
    elif not creases:
        say(layout, context, wording.NO_CREASE, "INFO")
    followers = live.papers_on(sheet)
    if followers:
        _draw_followers(layout, context, followers)
        return
    column = layout.column()
    column.scale_y = 1.5
    column.operator("curvefold.make_paper", icon="MOD_CLOTH")


def _draw_followers(layout: bpy.types.UILayout, context: bpy.types.Context, papers: list[bpy.types.Object]) -> None:
    """How the papers of a drawing stand that are there already."""
    paper = drawing_context.meant_paper(context)
    if len(papers) > 1:
        layout.label(text=f"{paper.name}, one of {len(papers)} papers of this drawing")
    _draw_standing(layout, context, paper)
    column = layout.column()
    column.scale_y = 1.5
    column.operator("curvefold.back_to_paper", icon="LOOP_BACK")
    layout.operator("curvefold.make_paper", text="Another Paper", icon="ADD")


def _draw_drawing_tools(layout: bpy.types.UILayout, context: bpy.types.Context, sheet: bpy.types.Object) -> None:
    for trouble in trouble_marks.of_sheet(sheet):
        say(layout, context, trouble.sentence, "ERROR", alert=True)
    column = layout.column(align=True)
    column.operator("curvefold.draw_crease", icon="GREASEPENCIL")
    if bpy.ops.curvefold.make_crease.poll():
        column.operator("curvefold.make_crease", icon="CURVE_DATA")
    if bpy.ops.curvefold.set_assignment.poll():
        column = layout.column(align=True)
        column.label(text="Selected creases fold to")
        row = column.row(align=True)
        for letter, text in (("V", "Valley"), ("M", "Mountain"), ("U", "Free"), ("F", "Flat")):
            active = context.active_object is not None and context.active_object.curvefold.assignment == letter
            row.operator("curvefold.set_assignment", text=text, depress=active).assignment = letter


def _draw_standing(layout: bpy.types.UILayout, context: bpy.types.Context, paper: bpy.types.Object) -> None:
    mesh = paper.data
    settings = mesh.curvefold
    report = live.report(mesh)
    box = layout.box()
    if report is None:
        say(box, context, f"{paper.name}. {wording.ASLEEP}", "PAUSE")
    else:
        trouble = report.state == "trouble"
        say(box, context, report.sentence, wording.STATE_ICONS[report.state], alert=trouble)
        if report.vertices:
            say(box, context, wording.stretch(report), "BLANK1")
    if by_hand.is_changed(mesh):
        column = box.column(align=True)
        column.operator("curvefold.restore_paper", icon="LOOP_BACK")
        column.operator("curvefold.make_ordinary_mesh", icon="OUTLINER_OB_MESH")
    elif baking.is_baked(mesh):
        say(box, context, wording.BAKED, "SHAPEKEY_DATA")
    elif mesh.shape_keys is not None:
        say(box, context, wording.KEYED, "ERROR", alert=True)
    elif not settings.live:
        say(box, context, wording.NOT_LIVE, "PAUSE")
    elif settings.fold == 0.0 and not settings.handles:
        say(box, context, wording.NEXT if settings.creases else wording.NEXT_BLANK, "INFO")
    sheet = settings.sheet
    # A paper that has none, and has compared its scale with one, has lost it for good.
    if settings.sheet_scale > 0.0 if sheet is None else drawing_objects.is_deleted(sheet):
        say(box, context, wording.SHEET_DELETED, "ERROR")
    elif sheet is not None and live.sheet_here(settings) is None:
        say(box, context, wording.SHEET_ELSEWHERE, "INFO")
    column = layout.column()
    column.scale_y = 1.3
    column.prop(settings, "fold", slider=True)
    row = layout.row(align=True)
    row.prop(settings, "live", toggle=True, icon="PLAY")
    row.operator("curvefold.flatten", text="Flatten", icon="MESH_PLANE")
    if report is not None and report.state == "trouble" and not live.why_it_stays(mesh):
        layout.operator("curvefold.fold_anew", icon="FILE_REFRESH")


class HandleList(bpy.types.UIList):
    """The handles of a paper"""

    bl_idname = "CURVEFOLD_UL_handles"

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
        row.prop(item, "name", text="", emboss=False, icon="PINNED" if item.hook is None else "EMPTY_AXIS")


class HandlesPanel(PaperPanel, bpy.types.Panel):
    """Points of the paper that are held or pulled"""

    bl_idname = "CURVEFOLD_PT_handles"
    bl_label = "Handles"
    bl_options: ClassVar[set[str]] = set()

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = live.active_paper(context).data.curvefold
        column = layout.column(align=True)
        column.operator("curvefold.place_handle", icon="CURSOR")
        row = column.row(align=True)
        row.operator("curvefold.add_handles", text="At Vertices", icon="VERTEXSEL")
        row.operator("curvefold.hook_object", text="Hook Selected", icon="HOOK")
        if not settings.handles:
            return
        row = layout.row()
        row.template_list(HandleList.bl_idname, "", settings, "handles", settings, "chosen_handle", rows=3)
        column = row.column(align=True)
        column.operator("curvefold.remove_handle", text="", icon="REMOVE")
        column.operator("curvefold.pin", text="", icon="PINNED")
        chosen = settings.chosen_handle
        if chosen >= len(settings.handles):
            return
        handle = settings.handles[chosen]
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.active = handle.enabled
        column.prop(handle, "hook", text="Pulled by")
        row = column.row(heading="Along", align=True)
        for k, axis in enumerate("XYZ"):
            row.prop(handle, "axes", index=k, text=axis, toggle=True)
        column.prop(handle, "strength")


class DrawingPanel(PaperPanel, bpy.types.Panel):
    """The drawing from which the paper is folded"""

    bl_idname = "CURVEFOLD_PT_drawing"
    bl_label = "Drawing"

    def draw(self, context: bpy.types.Context) -> None:
        settings = live.active_paper(context).data.curvefold
        self.layout.prop(settings, "sheet", text="")
        # With a part of the drawing active, the main panel has them.
        sheet = live.sheet_here(settings)
        if sheet is not None and not _is_drawing(context):
            _draw_drawing_tools(self.layout, context, sheet)


class OverlaysPanel(Tab, bpy.types.Panel):
    """What is drawn over papers and drawings"""

    bl_idname = "CURVEFOLD_PT_overlays"
    bl_label = "Overlays"
    bl_parent_id = "CURVEFOLD_PT_main"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return live.active_paper(context) is not None or drawing_context.active_sheet(context) is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.curvefold, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.curvefold
        column = self.layout.column(align=True)
        column.active = settings.show
        for name in ("creases", "angles", "rulings", "gauss_image", "pulls", "stretch", "troubles"):
            column.prop(settings, name)
        if settings.show and settings.stretch:
            say(column, context, "Green from 0.3 %, yellow from 0.6 %, red from 1 %", "BLANK1")
        paper = live.active_paper(context)
        if paper is None:
            return
        if settings.show and (settings.rulings or settings.gauss_image):
            if baking.is_baked(paper.data):
                say(column, context, wording.NO_RULINGS_BAKED, "INFO")
            elif live.session(paper.data) is None:
                say(column, context, wording.NO_RULINGS_ASLEEP, "INFO")
        column = self.layout.column(align=True)
        column.operator("curvefold.rulings_as_object", icon="OUTLINER_OB_CURVE")
        column.operator("curvefold.gauss_image_as_object", icon="OUTLINER_OB_CURVE")
        column.operator("curvefold.rulings_as_attribute", icon="SPREADSHEET")


class AnimationPanel(PaperPanel, bpy.types.Panel):
    """Playing and baking"""

    bl_idname = "CURVEFOLD_PT_animation"
    bl_label = "Animation"

    def draw(self, context: bpy.types.Context) -> None:
        mesh = live.active_paper(context).data
        column = self.layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(mesh.curvefold, "iterations_per_frame")
        if baking.is_baked(mesh):
            column.operator("curvefold.free_bake", icon="TRASH")
        else:
            column.operator("curvefold.bake", icon="SHAPEKEY_DATA")


class PicturePanel(PaperPanel, bpy.types.Panel):
    """A picture or a film of the paper"""

    bl_idname = "CURVEFOLD_PT_picture"
    bl_label = "Picture"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator("curvefold.set_up_picture", icon="OUTLINER_OB_CAMERA")
        column.operator("curvefold.remove_picture", icon="TRASH")
        column.operator_menu_enum("curvefold.animate_picture", "kind", text="Animate", icon="RENDER_ANIMATION")


class AdvancedPanel(PaperPanel, bpy.types.Panel):
    """How finely and how far"""

    bl_idname = "CURVEFOLD_PT_advanced"
    bl_label = "Advanced"

    def draw(self, context: bpy.types.Context) -> None:
        mesh = live.active_paper(context).data
        report = live.report(mesh)
        column = self.layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(mesh.curvefold, "angle")
        column.prop(mesh.curvefold, "resolution")
        if mesh.curvefold.resolution == AUTOMATIC and report is not None and report.resolution:
            row = column.split(factor=0.4)
            row.label(text="")
            row.label(text=f"Automatic: {report.resolution}")
        column.operator("curvefold.settle", text="Fold until Settled", icon="CHECKMARK")
        column.operator("curvefold.check_paper", icon="VIEWZOOM")
        column.operator("curvefold.make_ordinary_mesh", icon="OUTLINER_OB_MESH")
        if report is not None and report.vertices:
            say(column, context, wording.effort(report))


_CLASSES = (
    HandleList,
    CreaseList,
    JointList,
    MainPanel,
    HandlesPanel,
    CreasesPanel,
    AngleList,
    PointAnglesPanel,
    FlowPanel,
    JointsPanel,
    DrawingPanel,
    OverlaysPanel,
    AnimationPanel,
    PicturePanel,
    AdvancedPanel,
    WeightsPanel,
)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
