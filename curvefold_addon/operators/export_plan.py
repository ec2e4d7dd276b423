"""File > Export > Crease Pattern Plan: the flat sheet of a paper for a machine or a hand, as it is folded."""

from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty

from ... import solver
from ...solver.plan.profile import PAPERS, read_profile
from ...solver.plan.writing import PENS
from .. import live, wording
from ..bridge import baking
from ..bridge.plan_source import plan_source
from ..waiting import busy
from .on_paper import OnPaper

FILTER = ";".join(f"*{suffix}" for suffix in PENS)
SUFFIXES = ", ".join(PENS)
_MM = 1000.0

FORMATS = (
    (".svg", "SVG", "For cutting plotters, lasers and drawing programs"),
    (".dxf", "DXF", "For CAD and lasers"),
    (".pdf", "PDF", "For printers and converters; several pages are one file"),
)
AS_PROFILE, OWN_FILE = "PROFILE", "FILE"
#: The profiles of the house, those that most people want first.
PROFILES = (
    ("origami", "Origami", "For people: black border, red mountains, blue valleys"),
    ("print", "Print at Home", "Pages with marks to join them; valleys dashed, mountains dashes and dots"),
    ("plotter", "Cutting Plotter", "Cricut, Silhouette: real dashes for creases, the outline is cut"),
    ("laser-lightburn", "Laser (LightBurn)", "One colour a layer: red cuts, creases are perforated"),
    ("laser-glowforge", "Laser (Glowforge)", "One step a colour: red cuts, creases are scored"),
    ("two-sided", "Two-Sided Scoring", "Mountains on the front, valleys on a mirrored back, with marks"),
    ("board", "Grooved Board", "V-grooves as wide as each fold needs, on the face that it closes"),
    ("packaging", "Packaging", "PDF with spot colours and processing steps as layers"),
    (OWN_FILE, "Own File", "A profile of your own: a changed copy of one of the others"),
)
TILES = (
    (AS_PROFILE, "As in Profile", "One page, or the paper that the profile names"),
    *((name, name, f"Pages of {name} paper, with marks to join them") for name in PAPERS),
)


class ExportPlan(OnPaper, bpy.types.Operator):
    """Write the flat sheet of the active paper for a plotter, laser, press or printer, with mountains and valleys
    as the paper is folded now
    """

    bl_idname = "curvefold.export_plan"
    bl_label = "Export Plan"
    bl_options: ClassVar[set[str]] = {"PRESET"}
    only_looks = True

    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE", "HIDDEN"})
    check_existing: BoolProperty(default=True, options={"HIDDEN"})
    filter_glob: StringProperty(default=FILTER, options={"HIDDEN"})
    file_format: EnumProperty(name="Format", description="The kind of file", items=FORMATS)
    profile: EnumProperty(name="Profile", description="What the plan is for", items=PROFILES)
    profile_file: StringProperty(
        name="Profile File", description="A TOML file that says how plans are drawn", subtype="FILE_PATH"
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Thickness of the board, which says how wide its grooves are",
        default=0.002,
        min=1e-6,
        soft_max=0.02,
        unit="LENGTH",
        precision=4,
    )
    tile: EnumProperty(name="Pages", description="The paper that the plan is printed on", items=TILES)
    tabs: FloatProperty(
        name="Tabs",
        description="Width of the tabs along borders that are glued; 0 for none",
        default=0.0,
        min=0.0,
        soft_max=0.02,
        max=0.1,
        unit="LENGTH",
        precision=4,
    )
    rulings: BoolProperty(name="Rulings", description="Draw the rulings of the paper as it is folded now")
    scale: FloatProperty(
        name="Scale", description="Factor on the paper's size", default=1.0, min=1e-4, soft_max=100.0, max=1e4
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self.filepath:
            paper = self.meant(context)
            name = bpy.path.clean_name(paper.name)
            folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path()
            self.filepath = str(folder / f"{name} plan{self.file_format}")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context: bpy.types.Context) -> bool:
        """Keeps the name's suffix what the format says, as Blender asks after each change."""
        named = self._named()
        changed = str(named) != self.filepath
        self.filepath = str(named)
        return changed

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(self, "file_format")
        layout.prop(self, "profile")
        if self.profile == OWN_FILE:
            layout.prop(self, "profile_file")
        if self.profile == "board":
            layout.prop(self, "thickness")
        layout.prop(self, "tile")
        layout.prop(self, "tabs")
        layout.prop(self, "rulings")
        layout.prop(self, "scale")

    def act(self, context: bpy.types.Context, paper: bpy.types.Object) -> set[str]:
        if not self.filepath:
            return self.refuse("No file was chosen")
        if baking.is_baked(paper.data):
            return self.refuse("The paper is baked; free its bake to write its plan")
        path = Path(bpy.path.abspath(self.filepath))
        with busy(context):
            session = live.make_session(paper)
            told = live.read_inputs(paper, session, context.scene, context.evaluated_depsgraph_get())
            source = plan_source(session, told, paper.name, self._unit_scale(context), self.rulings)
            result = solver.plan(source, self._description(context))
            files = solver.write_plan(result, path if path.suffix else path.with_suffix(self.file_format))
        for note in result.plan.notes:
            self.report({"INFO"}, wording.readable(note))
        self.report({"INFO"}, wording.readable(f"Wrote {', '.join(file.name for file in files)}"))
        return {"FINISHED"}

    def _named(self) -> Path:
        path = Path(self.filepath)
        return path.with_suffix(self.file_format) if path.suffix.lower() in PENS else path

    def _unit_scale(self, context: bpy.types.Context) -> float:
        return float(context.scene.unit_settings.scale_length * self.scale)

    def _description(self, context: bpy.types.Context) -> solver.PlanDescription:
        own = bpy.path.abspath(self.profile_file) if self.profile == OWN_FILE else self.profile
        profile = read_profile(own)
        scale = _MM * context.scene.unit_settings.scale_length
        return solver.PlanDescription(
            profile,
            # Blender keeps single precision, of which seven digits are meant.
            thickness_mm=float(f"{self.thickness * scale:.7g}") if profile.grooves else None,
            tabs_mm=float(f"{self.tabs * scale:.7g}") or None,
            tile=None if self.tile == AS_PROFILE else self.tile,
            rulings=self.rulings,
        )


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(ExportPlan.bl_idname, text=f"Crease Pattern Plan ({SUFFIXES})")


def register() -> None:
    bpy.utils.register_class(ExportPlan)
    bpy.types.TOPBAR_MT_file_export.append(_menu_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_export.remove(_menu_entry)
    bpy.utils.unregister_class(ExportPlan)
