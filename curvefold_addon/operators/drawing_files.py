"""What operators that read drawings have in common: which files, how they are read, and what is said of them."""

from collections.abc import Iterable
from pathlib import Path
from typing import ClassVar

import bpy
from bpy.props import CollectionProperty, EnumProperty, FloatProperty, StringProperty

from ... import solver
from .. import wording

#: What the file dialog shows.
FILTER = ";".join(f"*{suffix}" for suffix in solver.DRAWING_SUFFIXES)
#: For menus: ".svg, .fold".
SUFFIXES = ", ".join(solver.DRAWING_SUFFIXES)
#: For descriptions: "SVG or FOLD".
FORMATS = " or ".join(filter(None, (", ".join(solver.DRAWING_FORMATS[:-1]), solver.DRAWING_FORMATS[-1])))

FROM_FILE = "FILE"

BORDERS = (
    ("AUTO", "Automatic", "The outline that is drawn, or the page where none is drawn"),
    ("OUTLINE", "Drawn Outline", "The sheet ends at the outline that is drawn; without one there is no sheet"),
    ("PAGE", "Page", "The page of the drawing is the sheet"),
)
#: The solver's names of units, and that of none.
UNITS = (
    (FROM_FILE, "From File", "What the file says; a drawing that says nothing is in millimetres"),
    ("mm", "Millimetres", "One unit of the drawing is a millimetre"),
    ("cm", "Centimetres", "One unit of the drawing is a centimetre"),
    ("m", "Metres", "One unit of the drawing is a metre"),
    ("in", "Inches", "One unit of the drawing is an inch"),
    ("pt", "Points (1/72 in)", "Illustrator's points"),
    ("px", "Pixels (1/96 in)", "Pixels of the web, and of Inkscape"),
    ("90dpi", "90 dpi", "Pixels of Inkscape before 0.92"),
    ("300dpi", "300 dpi", "Pixels of printed pictures, as in Affinity"),
)


#: The properties that say how a drawing is read.
READING = ("border", "unit", "scale")


class DrawingFiles:
    """A part of such an operator: files that are chosen, dropped, or named by a script, and how they are read.

    How a drawing is read is not remembered: the next one is another drawing, and a dropped one asks nothing.
    """

    #: What the dialog offers.
    choices: ClassVar[tuple[str, ...]] = READING

    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE", "HIDDEN"})
    #: Remembered, so that the dialog opens where the last drawing was.
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"SKIP_SAVE", "HIDDEN"})
    filter_glob: StringProperty(default=FILTER, options={"HIDDEN"})
    border: EnumProperty(
        name="Border", description="What the sheet of paper is", items=BORDERS, options={"SKIP_SAVE"}
    )
    unit: EnumProperty(
        name="Unit", description="What one unit of the drawing is", items=UNITS, options={"SKIP_SAVE"}
    )
    scale: FloatProperty(
        name="Scale",
        description="Factor on the drawing's size, after the unit",
        default=1.0,
        min=1e-6,
        soft_min=1e-3,
        soft_max=1e3,
        max=1e6,
        precision=4,
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.paths():  # dropped
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in self.choices:
            self.layout.prop(self, name)

    def paths(self) -> list[Path]:
        """The files: all that are chosen at once, or the one that is named."""
        names = [entry.name for entry in self.files if entry.name]
        if self.directory and names:
            folder = Path(bpy.path.abspath(self.directory))
            return [folder / name for name in names]
        return [Path(bpy.path.abspath(self.filepath))] if self.filepath else []

    def read_options(self) -> solver.ReadOptions:
        unit = None if self.unit == FROM_FILE else self.unit
        # Blender keeps single precision, of which seven digits are meant.
        return solver.ReadOptions(self.border.lower(), unit=unit, scale=float(f"{self.scale:.7g}"))

    def read_files(self) -> list[tuple[solver.CreasePattern, ...]]:
        """The sheets of each file that can be read; of others, and of what was decided, the user is told."""
        paths = self.paths()
        if not paths:
            self.report({"ERROR"}, "No drawing was chosen")
        found = []
        for path in paths:
            beginning = f"{path.name}: " if len(paths) > 1 else ""
            try:
                patterns = solver.read_patterns(path, self.read_options())
            except solver.CurvefoldError as error:
                self.refuse(error, beginning)
                continue
            self.tell(dict.fromkeys(note for pattern in patterns for note in pattern.notes), beginning)
            if len(patterns) > 1:  # last, since only the last report stays in the status bar
                self.tell([f"it has {len(patterns)} sheets"], beginning)
            found.append(patterns)
        return found

    def tell(self, notes: Iterable[str], beginning: str = "") -> None:
        """What was decided, a report each."""
        for note in notes:
            self.report({"INFO"}, wording.readable(beginning + note))

    def refuse(self, error: solver.CurvefoldError, beginning: str = "") -> None:
        """What was decided before it went wrong, then what went wrong."""
        self.tell(error.notes, beginning)
        self.report({"ERROR"}, wording.readable(str(error)))
