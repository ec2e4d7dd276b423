"""How files of drawings are read in Blender: options, several sheets, several files, and what the user is told."""

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

OPERATORS = ("import_drawing", "fold_drawing")
QUICK = {"resolution": 8, "angle": 0.3}


def call(name, **told):
    return getattr(bpy.ops.curvefold, name)(**told, **(QUICK if name == "fold_drawing" else {}))


def box(item):
    """Lowest and highest corner of an object in the world, x and y."""
    bpy.context.view_layer.update()
    corners = np.array([item.matrix_world @ type(item.location)(corner) for corner in item.bound_box])
    return corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)


@pytest.fixture
def solver(extension):
    return extension("solver")


@pytest.fixture
def told(solver, monkeypatch):
    """Stands in for the readers. ``told.sheets[name]``: what a file holds, patterns or an error; ``told.read``:
    what was read, and how."""

    class Told:
        def __init__(self):
            self.sheets, self.read = {}, []

        def __call__(self, path, options):
            self.read.append((path, options))
            found = self.sheets[path.name]
            if isinstance(found, Exception):
                raise found
            return found

    stand_in = Told()
    monkeypatch.setattr(solver, "read_patterns", stand_in)
    return stand_in


@pytest.fixture
def square(solver):
    """``square(x, y, size)``: a sheet with an arc across, its lower left corner at (x, y); centimetres."""

    def make(x, y, size=10.0, name="", notes=()):
        t = np.linspace(0.0, 1.0, 17)
        arc = np.column_stack([t, 0.4 + t * (1 - t)]) * size + (x, y)
        corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * size + (x, y)
        return solver.CreasePattern(corners, creases=[solver.Crease(arc)], name=name, unit_mm=10.0, notes=notes)

    return make


# --- how it is read -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", OPERATORS)
def test_a_drawing_is_read_as_the_user_chose(solver, told, square, name):
    told.sheets["a.svg"] = (square(0, 0),)
    call(name, filepath="/x/a.svg")
    call(name, filepath="/x/a.svg", border="PAGE", unit="90dpi", scale=0.1)
    expected = [solver.ReadOptions(), solver.ReadOptions("page", unit="90dpi", scale=0.1)]
    assert told.read == [(Path("/x/a.svg"), options) for options in expected]


def test_every_choice_is_one_of_the_solver(solver):
    properties = bpy.ops.curvefold.import_drawing.get_rna_type().properties
    borders = [item.identifier.lower() for item in properties["border"].enum_items]
    assert [solver.ReadOptions(border).border for border in borders] == ["auto", "outline", "page"]
    first, *units = [item.identifier for item in properties["unit"].enum_items]
    assert first == properties["unit"].default == "FILE"
    millimetres = [solver.ReadOptions(unit=unit).unit_mm(None) for unit in units]
    assert millimetres == pytest.approx([1, 10, 1000, 25.4, 25.4 / 72, 25.4 / 96, 25.4 / 90, 25.4 / 300])
    for edge in (properties["scale"].hard_min, properties["scale"].hard_max):
        assert solver.ReadOptions(scale=float(f"{edge:.7g}"))


def test_a_unit_and_a_scale_give_the_size(drawing):
    """The file says 100 mm for 100 units."""
    for told, side in (
        ({}, 0.1),
        ({"unit": "cm"}, 1.0),
        ({"unit": "in", "scale": 0.5}, 1.27),
        ({"scale": 2.0}, 0.2),
    ):
        bpy.ops.curvefold.import_drawing(filepath=str(drawing), **told)
        assert bpy.context.active_object.dimensions.x == pytest.approx(side)
        bpy.ops.curvefold.fold_drawing(filepath=str(drawing), **QUICK, **told)
        assert bpy.context.active_object.dimensions.x == pytest.approx(side, rel=0.01)


@pytest.mark.parametrize(("name", "more"), [("import_drawing", []), ("fold_drawing", ["angle", "resolution"])])
def test_the_choices_are_in_the_dialog_and_asked_anew_for_each_drawing(name, more):
    properties = getattr(bpy.ops.curvefold, name).get_rna_type().properties
    shown = []

    class Layout:
        use_property_split = use_property_decorate = False

        def prop(self, data, name):
            assert name in properties
            shown.append(name)

    cls = getattr(bpy.types, f"CURVEFOLD_OT_{name}")
    cls.draw(SimpleNamespace(layout=Layout(), choices=cls.choices), bpy.context)
    reading = ["border", "unit", "scale"]
    assert shown == [*reading, *more]
    assert all(properties[choice].is_skip_save for choice in reading)


# --- several sheets, several files ----------------------------------------------------------------------------


def test_all_sheets_of_a_file_are_added_as_they_lie_in_it(told, square, extension):
    told.sheets["a.svg"] = (square(100, 50, name="left"), square(115, 60, 20.0, name="right"))
    bpy.context.scene.cursor.location = (1, 2, 3)
    assert call("import_drawing", filepath="/x/a.svg") == {"FINISHED"}
    left, right = (bpy.data.objects[name] for name in ("left", "right"))
    assert bpy.context.active_object == left
    assert set(bpy.context.selected_objects) == {left, right}
    (low, _), (other, high) = box(left), box(right)
    assert other - low == pytest.approx([0.15, 0.10], abs=1e-6)
    assert (low + high) / 2 == pytest.approx([1, 2], abs=1e-6), "around the cursor"
    assert left.location.z == right.location.z == 3
    assert [len(sheet.children) for sheet in (left, right)] == [1, 1]
    read = extension("curvefold_addon.bridge.drawing").read_drawing(right)
    assert np.ptp(read.boundary, axis=0) * read.unit_mm == pytest.approx([200, 200])


def test_a_scene_of_other_units_is_no_other_place(told, square):
    told.sheets["a.svg"] = (square(100, 50, name="left"), square(115, 60, name="right"))
    bpy.context.scene.unit_settings.scale_length = 0.01
    call("import_drawing", filepath="/x/a.svg")
    left, right = (bpy.data.objects[name] for name in ("left", "right"))
    assert box(right)[0] - box(left)[0] == pytest.approx([15, 10], abs=1e-4)


def test_all_sheets_of_a_file_are_folded_where_they_lie_in_it(told, square):
    told.sheets["a.svg"] = (square(100, 50, name="left"), square(115, 60, name="right"))
    assert call("fold_drawing", filepath="/x/a.svg") == {"FINISHED"}
    left, right = (bpy.data.objects[name] for name in ("left", "right"))
    assert bpy.context.active_object == left
    assert set(bpy.context.selected_objects) == {left, right}
    assert left.data != right.data
    for paper, corner in ((left, (1.0, 0.5)), (right, (1.15, 0.6))):
        assert paper.data.curvefold.is_paper
        assert np.add(*box(paper)) / 2 == pytest.approx(np.add(corner, 0.05), abs=0.005)


@pytest.mark.parametrize("name", OPERATORS)
def test_several_files_come_in_a_row(told, square, name):
    told.sheets = {"a.svg": (square(0, 0, name="a"),), "b.svg": (square(500, 70, 20.0, name="b"),)}
    assert call(name, directory="/x", files=[{"name": "a.svg"}, {"name": "b.svg"}]) == {"FINISHED"}
    assert [path for path, _ in told.read] == [Path("/x/a.svg"), Path("/x/b.svg")]
    (a_low, a_high), (b_low, b_high) = (box(bpy.data.objects[key]) for key in "ab")
    assert b_low[0] - a_high[0] == pytest.approx(0.01, abs=0.004)
    assert (b_low + b_high)[1] == pytest.approx((a_low + a_high)[1], abs=0.01)


@pytest.mark.parametrize("name", OPERATORS)
def test_what_one_file_lacks_the_others_do_not(solver, told, square, name):
    told.sheets = {"a.svg": solver.PatternError("it is bad", file="/x/a.svg"), "b.svg": (square(0, 0, name="b"),)}
    with pytest.raises(RuntimeError, match=r"Error: /x/a\.svg: it is bad"):
        call(name, directory="/x", files=[{"name": "a.svg"}, {"name": "b.svg"}])
    assert [item.name for item in bpy.context.selected_objects] == ["b"]


def test_a_sheet_that_cannot_be_folded_is_named_and_the_others_are(solver, told, square):
    thin = solver.CreasePattern(
        [(0, 0), (90, 0), (90, 1), (0, 1)], creases=[solver.Crease([(5, 0), (5, 1)])], name="thin"
    )
    told.sheets["a.svg"] = (thin, square(0, 0, name="b"))
    with pytest.raises(RuntimeError, match=r"Error: thin, .*quads are needed"):
        call("fold_drawing", filepath="/x/a.svg")
    assert [item.name for item in bpy.context.selected_objects] == ["b"]


@pytest.mark.parametrize("name", OPERATORS)
def test_the_dialog_opens_where_the_last_drawing_was(name):
    properties = getattr(bpy.ops.curvefold, name).get_rna_type().properties
    assert not properties["directory"].is_skip_save
    # With these remembered, the next dialog would count as a drop of the same files.
    assert properties["filepath"].is_skip_save
    assert properties["files"].is_skip_save


# --- what is said ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", OPERATORS)
def test_every_note_is_reported_once(told, square, name, capfd):
    notes = ["the page is the sheet", "2 lines were left out"]
    told.sheets["a.svg"] = (square(0, 0, notes=notes), square(20, 0, notes=notes[:1]))
    call(name, filepath="/x/a.svg")
    said = capfd.readouterr().out.splitlines()
    for note in ("it has 2 sheets", *notes):
        assert said.count(f"Info: {note}") == 1
    infos = [line for line in said if line.startswith("Info: ")]
    assert infos.index("Info: it has 2 sheets") == len(notes), "the last of them stays in the status bar"


@pytest.mark.parametrize("name", OPERATORS)
def test_a_refusal_tells_its_notes_first(solver, told, name, capfd):
    told.sheets["a.svg"] = solver.PatternError("no border", file="a.svg", notes=("5 strokes were taken for cuts",))
    with pytest.raises(RuntimeError, match=r"Error: a\.svg: no border"):
        call(name, filepath="/x/a.svg")
    said = capfd.readouterr().out.splitlines()
    assert said.index("Info: 5 strokes were taken for cuts") < said.index("Error: a.svg: no border")
    assert not bpy.data.objects


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have only names that are text")
@pytest.mark.parametrize("name", OPERATORS)
def test_a_name_that_is_no_text(drawing, broken_drawing, tmp_path, name):
    folder = tmp_path / os.fsdecode(b"f\xe4cher")
    folder.mkdir()
    good, bad = folder / os.fsdecode(b"\xe4.svg"), folder / os.fsdecode(b"\xe5.svg")
    drawing.rename(good)
    broken_drawing.rename(bad)
    assert call(name, filepath=str(good)) == {"FINISHED"}
    assert [item.name for item in bpy.context.selected_objects] == ["\ufffd"]
    with pytest.raises(RuntimeError, match=r"f\\udce4cher/\\udce5\.svg"):
        call(name, filepath=str(bad))
    # Scripts cannot choose several files with such names, but the dialog can.
    chosen = SimpleNamespace(directory=str(folder), files=[good, bad], filepath="")
    assert getattr(bpy.types, f"CURVEFOLD_OT_{name}").paths(chosen) == [good, bad]
