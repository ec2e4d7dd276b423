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
from .operators import add_sample
from .overlay import trouble_marks
from .panel_parts import KeptBox, PaperPanel, Tab, paper_settings, say, switched_row

#: Lines that are kept free for what is said of a paper, and of a drawing.
PAPER_LINES, DRAWING_LINES = 4, 3


class MainPanel(Tab, bpy.types.Panel):
    """How the paper stands, and the next step"""

    bl_label = "Curvefold"
    bl_idname = "CURVEFOLD_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        paper, sheet = live.active_paper(context), drawing_context.active_sheet(context)
        if paper is not None and not _is_drawing(context):
            _draw_paper(self.layout, context, paper)
        elif sheet is not None:
            _draw_sheet(self.layout, context, sheet)
        else:
            _draw_beginning(self.layout, context)


def _is_drawing(context: bpy.types.Context) -> bool:
    """Whether the user is at a drawing, and not at a paper that follows it."""
    return context.active_object is not None and drawing_objects.is_part(context.active_object)


def _draw_beginning(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    column = layout.column(align=True)
    column.scale_y = 1.2
    column.operator_menu_enum("curvefold.add_sheet", "size", text="Paper Sheet", icon="MESH_PLANE")
    column.operator("curvefold.import_drawing", text="Drawing…", icon="FILE_FOLDER")
    layout.operator("curvefold.sheet_from_object", icon="OUTLINER_OB_CURVE")
    box = KeptBox(layout, context, DRAWING_LINES)
    _say_lost(box, context)
    box.say(wording.NO_SHEET, "INFO")
    box.fill()
    layout.label(text="Samples", text_ctxt=wording.CONTEXT)
    add_sample.draw_buttons(layout.column(align=True))


def _say_lost(box: KeptBox, context: bpy.types.Context) -> None:
    active = context.active_object
    if active is not None and drawing_objects.has_lost_sheet(active):
        box.say(f"{active.name} {wording.LOST_CREASE}", "ERROR", alert=True)


def _say_troubles(box: KeptBox, sheet: bpy.types.Object) -> None:
    for trouble in trouble_marks.of_sheet(sheet):
        box.say(trouble.sentence, "ERROR", alert=True)


def _draw_sheet(layout: bpy.types.UILayout, context: bpy.types.Context, sheet: bpy.types.Object) -> None:
    creases = sum(drawing_objects.is_crease(child) for child in sheet.children)
    sheets = drawing_context.meant_sheets(context)
    title = f"{sheet.name}: {wording.count(creases, 'crease')}"
    layout.label(text=title if len(sheets) < 2 else f"{len(sheets)} sheets", icon="OUTLINER_OB_CURVE")
    _draw_drawing_tools(layout, sheet)
    followers = live.papers_on(sheet)
    column = layout.column()
    column.scale_y = 1.5
    if followers:
        column.operator("curvefold.back_to_paper", icon="LOOP_BACK")
        layout.operator("curvefold.make_paper", text="Another Paper", icon="ADD")
        _draw_controls(layout, drawing_context.meant_paper(context), None)
    else:
        column.operator("curvefold.make_paper", icon="MOD_CLOTH")
    box = KeptBox(layout, context, DRAWING_LINES + (PAPER_LINES if followers else 0))
    _say_lost(box, context)
    _say_troubles(box, sheet)
    if context.mode == "EDIT_CURVE" and drawing_objects.is_crease(context.active_object):
        box.say(wording.DRAWING, "INFO")
    elif not creases:
        box.say(wording.NO_CREASE, "INFO")
    elif not followers:
        box.say(wording.SEVERAL if len(sheets) > 1 else wording.READY, "INFO")
    if followers:
        paper = drawing_context.meant_paper(context)
        if len(followers) > 1:
            box.say(f"{paper.name}, one of {len(followers)} papers of this drawing")
        _say_standing(box, paper)
    box.fill()


def _draw_drawing_tools(layout: bpy.types.UILayout, sheet: bpy.types.Object) -> None:
    column = layout.column(align=True)
    column.operator("curvefold.draw_crease", icon="GREASEPENCIL")
    column.operator("curvefold.make_crease", icon="CURVE_DATA")
    row = column.row(align=True)
    row.operator("curvefold.edit_drawing", text="Edit", icon="EDITMODE_HLT")
    _draw_switch(row, sheet)
    active = bpy.context.active_object
    letter = active.curvefold.assignment if active is not None and drawing_objects.is_crease(active) else ""
    column = layout.column(align=True)
    column.label(text="Selected creases fold to")
    # Two in a line, so that no name is cut.
    for pair in ASSIGNMENT_BUTTONS:
        row = column.row(align=True)
        for key, text in pair:
            button = row.operator(
                "curvefold.set_assignment", text=text, text_ctxt=wording.CONTEXT, depress=key == letter
            )
            button.assignment = key


def _draw_switch(layout: bpy.types.UILayout, sheet: bpy.types.Object) -> None:
    """Show Drawing."""
    shown = sheet.curvefold.show
    layout.prop(sheet.curvefold, "show", toggle=True, icon="HIDE_OFF" if shown else "HIDE_ON")


#: The buttons of creases' assignments, line by line.
ASSIGNMENT_BUTTONS = ((("V", "Valley"), ("M", "Mountain")), (("U", "Free"), ("F", "Flat")))


def _draw_paper(layout: bpy.types.UILayout, context: bpy.types.Context, paper: bpy.types.Object) -> None:
    _draw_controls(layout, paper, live.sheet_here(paper.data.curvefold))
    box = KeptBox(layout, context, PAPER_LINES)
    _say_lost(box, context)
    _say_standing(box, paper)
    box.fill()


def _draw_controls(layout: bpy.types.UILayout, paper: bpy.types.Object, sheet: bpy.types.Object | None) -> None:
    """The slider and its buttons; sheet: whose drawing can be shown and hidden there."""
    settings = paper.data.curvefold
    folds = not live.why_it_does_not_fold(paper.data)
    row = layout.row()
    row.scale_y = 1.3
    row.enabled = folds
    row.active = settings.live
    row.prop(settings, "fold", slider=True)
    column = layout.column(align=True)
    row = column.row(align=True)
    part = row.row(align=True)
    part.enabled = folds
    part.prop(settings, "live", toggle=True, icon="PLAY")
    if sheet is not None:
        _draw_switch(row, sheet)
    row = column.row(align=True)
    row.operator("curvefold.flatten", text="Flatten", icon="MESH_PLANE")
    row.operator("curvefold.fold_anew", text="Fold Anew", icon="FILE_REFRESH")


def _say_standing(box: KeptBox, paper: bpy.types.Object) -> None:
    """How a paper stands, what hinders it, and what can be done next."""
    mesh = paper.data
    settings = mesh.curvefold
    report = live.report(mesh)
    if report is None:
        box.say(f"{paper.name}. {wording.ASLEEP}", "PAUSE")
    else:
        box.say(report.sentence, wording.STATE_ICONS[report.state], alert=report.state == "trouble")
        if report.vertices:
            box.say(wording.stretch(report), "BLANK1")
    if by_hand.is_changed(mesh):
        box.button("curvefold.restore_paper", "LOOP_BACK")
        box.button("curvefold.make_ordinary_mesh", "OUTLINER_OB_MESH")
    elif baking.is_baked(mesh):
        box.say(wording.BAKED, "SHAPEKEY_DATA")
    elif mesh.shape_keys is not None:
        box.say(wording.KEYED, "ERROR", alert=True)
    elif mesh.is_editmode:
        box.say(wording.EDITED, "INFO")
    elif not settings.live:
        box.say(wording.NOT_LIVE, "PAUSE")
    elif settings.fold == 0.0 and not settings.handles:
        box.say(wording.NEXT if settings.creases else wording.NEXT_BLANK, "INFO")
    sheet = settings.sheet
    # A paper that has none, and has compared its scale with one, has lost it for good.
    if settings.sheet_scale > 0.0 if sheet is None else drawing_objects.is_deleted(sheet):
        box.say(wording.SHEET_DELETED, "ERROR")
    elif sheet is not None and live.sheet_here(settings) is None:
        box.say(wording.SHEET_ELSEWHERE, "INFO")


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
        settings = paper_settings(self.layout, context)
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
        layout.prop(settings, "least_fold", slider=True)
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
            _draw_drawing_tools(self.layout, sheet)
            box = KeptBox(self.layout, context, DRAWING_LINES)
            _say_troubles(box, sheet)
            box.fill()
        self.layout.operator("curvefold.export_plan", icon="EXPORT")


class NotesPanel(Tab, bpy.types.Panel):
    """What was decided when the drawing was read from its file"""

    bl_idname = "CURVEFOLD_PT_notes"
    bl_label = "Import Notes"
    bl_parent_id = "CURVEFOLD_PT_main"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(_notes(context))

    def draw(self, context: bpy.types.Context) -> None:
        for note in _notes(context).splitlines():
            say(self.layout, context, note, "DOT")


def _notes(context: bpy.types.Context) -> str:
    """Those of the sheet that is meant; of a paper that has none, its own."""
    sheet, paper = drawing_context.active_sheet(context), live.active_paper(context)
    if paper is not None and paper.data.curvefold.notes:
        return paper.data.curvefold.notes
    return "" if sheet is None else sheet.curvefold.notes


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
        # Its name is too long to stand beside the number.
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
        part = column.column()
        part.enabled = not live.why_it_does_not_fold(mesh)
        part.prop(mesh.curvefold, "angle")
        part.prop(mesh.curvefold, "resolution")
        row = column.split(factor=0.4)
        row.label(text="")
        automatic = mesh.curvefold.resolution == AUTOMATIC and report is not None and report.resolution
        row.label(text=f"Automatic: {report.resolution}" if automatic else "")
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
    NotesPanel,
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
