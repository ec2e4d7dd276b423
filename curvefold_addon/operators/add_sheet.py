"""Add > Paper Sheet."""

from typing import ClassVar

import bpy
from bpy.props import EnumProperty, FloatProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add

from .. import later_work, looking
from ..bridge import drawing_objects, linked
from ..drawing_context import in_object_mode

#: Shorter and longer side in metres: ISO 216 and ANSI.
PAPERS = {
    "A3": (0.297, 0.420),
    "A4": (0.210, 0.297),
    "A5": (0.148, 0.210),
    "A6": (0.105, 0.148),
    "LETTER": (0.2159, 0.2794),
}
#: Side of a new square, diameter of a new circle, metres.
SIDE = 0.20
#: Handles of a quarter circle, relative to its radius.
QUARTER = 0.5522847498

SIZES = (
    ("A3", "A3", "297 × 420 mm"),
    ("A4", "A4", "210 × 297 mm"),
    ("A5", "A5", "148 × 210 mm"),
    ("A6", "A6", "105 × 148 mm"),
    ("LETTER", "Letter", "8.5 × 11 inches"),
    ("SQUARE", "Square", "A square, 200 mm unless told otherwise"),
    ("CIRCLE", "Circle", "A circle, 200 mm across unless told otherwise"),
    ("OWN", "Own Size", "A rectangle of a width and a height of your own"),
)
#: What can be chosen of sizes that have no upright and lying sheet.
_CHOICES = {"SQUARE": ("side",), "CIRCLE": ("side",), "OWN": ("width", "height")}


class AddSheet(bpy.types.Operator, AddObjectHelper):
    """Add a sheet of paper to draw creases on"""

    bl_idname = "curvefold.add_sheet"
    bl_label = "Paper Sheet"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}

    size: EnumProperty(name="Size", items=SIZES, default="A4")
    orientation: EnumProperty(
        name="Orientation",
        items=(("PORTRAIT", "Portrait", "Upright"), ("LANDSCAPE", "Landscape", "Lying")),
        default="PORTRAIT",
    )
    side: FloatProperty(
        name="Side",
        description="Side of the square, diameter of the circle",
        unit="LENGTH",
        min=1e-6,
        options={"SKIP_SAVE"},
    )

    width: FloatProperty(
        name="Width", description="Of a sheet of your own size", unit="LENGTH", min=1e-6, precision=4
    )
    height: FloatProperty(
        name="Height", description="Of a sheet of your own size", unit="LENGTH", min=1e-6, precision=4
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return in_object_mode(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "size")
        for name in _CHOICES.get(self.size, ("orientation",)):
            layout.prop(self, name)
        layout.prop(self, "align")
        layout.prop(self, "location")
        layout.prop(self, "rotation")

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._propose(context)
        # Only the user knows that size; all others are made at once, and adjusted afterwards.
        return context.window_manager.invoke_props_dialog(self) if self.size == "OWN" else self.execute(context)

    def _propose(self, context: bpy.types.Context) -> None:
        """Lengths that nobody has chosen are those of usual sheets, in the scene's units."""
        unit = context.scene.unit_settings.scale_length
        width, height = PAPERS["A4"]
        for name, length in (("side", SIDE), ("width", width), ("height", height)):
            if not self.properties.is_property_set(name):
                setattr(self, name, length / unit)

    @later_work.kept
    def execute(self, context: bpy.types.Context) -> set[str]:
        self._propose(context)
        unit = context.scene.unit_settings.scale_length
        label = next(name for key, name, _ in SIZES if key == self.size)
        curve = drawing_objects.new_curve(f"{label} Sheet")
        if self.size == "CIRCLE":
            _circle(curve, self.side / 2.0)
        elif self.size == "SQUARE":
            _rectangle(curve, self.side, self.side)
        elif self.size == "OWN":
            _rectangle(curve, self.width, self.height)
        else:
            width, height = (length / unit for length in PAPERS[self.size])
            _rectangle(curve, *((width, height) if self.orientation == "PORTRAIT" else (height, width)))
        if linked.new_home() == context.collection:
            sheet = object_data_add(context, curve, operator=self)
        else:
            with context.temp_override(layer_collection=context.view_layer.layer_collection):
                sheet = object_data_add(context, curve, operator=self)
        drawing_objects.mark_sheet(sheet)
        looking.show(context, sheet)
        return {"FINISHED"}


def _rectangle(curve: bpy.types.Curve, width: float, height: float) -> None:
    spline = curve.splines.new("POLY")
    spline.points.add(3)
    for point, (x, y) in zip(spline.points, ((-1, -1), (1, -1), (1, 1), (-1, 1)), strict=True):
        point.co = (0.5 * x * width, 0.5 * y * height, 0.0, 1.0)
    spline.use_cyclic_u = True


def _circle(curve: bpy.types.Curve, radius: float) -> None:
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(3)
    for point, (x, y) in zip(spline.bezier_points, ((1, 0), (0, 1), (-1, 0), (0, -1)), strict=True):
        point.handle_left_type = point.handle_right_type = "ALIGNED"
        point.co = (radius * x, radius * y, 0.0)
        point.handle_left = (radius * (x + QUARTER * y), radius * (y - QUARTER * x), 0.0)
        point.handle_right = (radius * (x - QUARTER * y), radius * (y + QUARTER * x), 0.0)
    spline.use_cyclic_u = True


def _menu_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator_menu_enum(AddSheet.bl_idname, "size", text="Paper Sheet", icon="MESH_PLANE")


def register() -> None:
    bpy.utils.register_class(AddSheet)
    bpy.types.VIEW3D_MT_add.append(_menu_entry)


def unregister() -> None:
    bpy.types.VIEW3D_MT_add.remove(_menu_entry)
    bpy.utils.unregister_class(AddSheet)
