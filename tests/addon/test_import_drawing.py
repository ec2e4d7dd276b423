"""Drawings as curves: imported, dropped, and the samples."""

import itertools
import json

import bpy
import numpy as np
import pytest


def test_a_drawing_is_added_at_the_cursor_in_true_scale(extension, drawing):
    bpy.context.scene.cursor.location = (1, 2, 3)
    bpy.context.scene.unit_settings.scale_length = 0.01
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.curvefold.import_drawing("EXEC_DEFAULT", True, filepath=str(drawing)) == {"FINISHED"}
    sheet = bpy.context.active_object
    assert bpy.context.selected_objects == [sheet]
    assert sheet.name == "arc"
    assert tuple(sheet.location) == (1, 2, 3)
    assert [child.curvefold.role for child in sheet.children] == ["CREASE"]
    assert tuple(sheet.dimensions) == pytest.approx((10, 10, 0))
    pattern = extension("curvefold_addon.bridge.drawing").read_drawing(sheet)
    assert np.ptp(pattern.boundary, axis=0) * pattern.unit_mm == pytest.approx([100, 100])
    bpy.ops.ed.undo()
    assert not bpy.data.objects


def test_what_was_decided_is_kept_with_what_was_made(extension, drawing):
    drawing.write_text(drawing.read_text().replace("</svg>", "<text stroke='red'>cut</text></svg>"))
    notes = extension("solver").read_pattern(drawing).notes
    assert notes
    bpy.ops.curvefold.import_drawing(filepath=str(drawing))
    assert bpy.context.active_object.curvefold.notes.splitlines() == list(notes)
    bpy.ops.curvefold.fold_drawing(filepath=str(drawing), resolution=10)
    assert bpy.context.active_object.data.curvefold.notes.splitlines() == list(notes)


@pytest.fixture
def fold_file(tmp_path):
    """A square of 100 mm with one arc of 16 edges across, folded in the file's own frame and flat in a second."""
    arc = [(100 * k / 16, 45 + 60 * (k / 16) * (1 - k / 16)) for k in range(17)]
    points = [(0, 0), (100, 0), (100, 45), (100, 100), (0, 100), (0, 45), *arc[1:-1]]
    chain = [5, *range(6, 21), 2]
    content = {
        "frame_classes": ["foldedForm"],
        "frame_unit": "mm",
        "vertices_coords": [(x, y, 0.01 * x * y) for x, y in points],
        "edges_vertices": [*([k, (k + 1) % 6] for k in range(6)), *itertools.pairwise(chain)],
        "edges_assignment": [*"BBBBBB", *["V"] * 16],
        "file_frames": [
            {
                "frame_classes": ["creasePattern"],
                "frame_parent": 0,
                "frame_inherit": True,
                "vertices_coords": points,
            }
        ],
    }
    path = tmp_path / "folded arc.fold"
    path.write_text(json.dumps(content))
    return path


def test_a_fold_file_is_a_drawing(extension, fold_file):
    bpy.context.scene.unit_settings.scale_length = 0.01
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.curvefold.import_drawing("EXEC_DEFAULT", True, filepath=str(fold_file)) == {"FINISHED"}
    sheet = bpy.context.active_object
    assert sheet.name == "folded arc"
    assert tuple(sheet.dimensions) == pytest.approx((10, 10, 0))
    (crease,) = sheet.children
    assert (crease.name, crease.curvefold.assignment) == ("valley 1", "V")
    assert crease.parent == sheet
    pattern = extension("curvefold_addon.bridge.drawing").read_drawing(sheet)
    assert np.ptp(pattern.boundary, axis=0) * pattern.unit_mm == pytest.approx([100, 100])
    assert [len(one.points) for one in pattern.creases] == [17]
    bpy.ops.ed.undo()
    assert not bpy.data.objects


def test_a_fold_file_is_folded(fold_file):
    assert bpy.ops.curvefold.fold_drawing(filepath=str(fold_file), resolution=12) == {"FINISHED"}
    paper = bpy.context.active_object
    assert paper.data.curvefold.is_paper
    heights = [vertex.co.z for vertex in paper.data.vertices]
    assert max(heights) - min(heights) > 0.005
    assert max(paper.dimensions) < 0.11


def test_a_folded_form_is_one_sentence(fold_file):
    content = json.loads(fold_file.read_text())
    del content["file_frames"]
    fold_file.write_text(json.dumps(content))
    for operator in (bpy.ops.curvefold.import_drawing, bpy.ops.curvefold.fold_drawing):
        with pytest.raises(RuntimeError, match=r"folded arc\.fold: it holds only a folded form"):
            operator(filepath=str(fold_file))
    assert not bpy.data.objects


def test_all_kinds_of_files_are_offered(extension):
    suffixes, formats = extension("solver").DRAWING_SUFFIXES, extension("solver").DRAWING_FORMATS
    assert {".svg", ".fold"} <= set(suffixes)
    for name in ("import_drawing", "fold_drawing"):
        properties = getattr(bpy.ops.curvefold, name).get_rna_type().properties
        assert properties["filter_glob"].default.split(";") == [f"*{suffix}" for suffix in suffixes]
        description = getattr(bpy.ops.curvefold, name).get_rna_type().description
        assert all(one in description for one in formats)
    assert bpy.types.CURVEFOLD_FH_drawing.bl_file_extensions.split(";") == list(suffixes)


def test_a_bad_drawing_is_one_sentence(broken_drawing):
    with pytest.raises(RuntimeError, match=r"broken\.svg") as caught:
        bpy.ops.curvefold.import_drawing(filepath=str(broken_drawing))
    assert "Traceback" not in str(caught.value)
    assert not bpy.data.objects


def test_no_drawing():
    with pytest.raises(RuntimeError, match="No drawing was chosen"):
        bpy.ops.curvefold.import_drawing()


def test_only_in_object_mode(drawing):
    bpy.ops.curvefold.import_drawing(filepath=str(drawing))
    bpy.ops.object.mode_set(mode="EDIT")
    for operator in (bpy.ops.curvefold.import_drawing, bpy.ops.curvefold.add_sample):
        with pytest.raises(RuntimeError, match="Works in Object Mode"):
            operator()
    bpy.ops.object.mode_set(mode="OBJECT")


def test_a_dropped_drawing(extension, drawing, fold_file):
    handler = bpy.types.CURVEFOLD_FH_drawing
    assert handler.bl_import_operator == "curvefold.import_drawing"
    window = bpy.context.window_manager.windows[0]
    areas = {area.type: area for area in window.screen.areas}
    with bpy.context.temp_override(window=window, area=areas["VIEW_3D"]):
        assert handler.poll_drop(bpy.context)
        # Blender's own handlers read SVG too; then it asks, which needs a window. Ours alone is called at once.
        others = [
            other
            for other in bpy.types.FileHandler.__subclasses__()
            if other is not handler and ".svg" in other.bl_file_extensions
        ]
        for other in others:
            bpy.utils.unregister_class(other)
        try:
            bpy.ops.wm.drop_import_file(
                "INVOKE_DEFAULT", directory=str(drawing.parent), files=[{"name": drawing.name}]
            )
        finally:
            for other in others:
                bpy.utils.register_class(other)
    assert bpy.context.active_object.name == "arc"
    with bpy.context.temp_override(window=window, area=areas["VIEW_3D"]):
        # Nobody else reads these.
        assert bpy.ops.wm.drop_import_file(
            "INVOKE_DEFAULT", directory=str(fold_file.parent), files=[{"name": fold_file.name}]
        ) == {"FINISHED"}
    assert bpy.context.active_object.name == "folded arc"
    (fold_file.parent / "other.fold").write_bytes(fold_file.read_bytes())
    both = [{"name": fold_file.name}, {"name": "other.fold"}]
    with bpy.context.temp_override(window=window, area=areas["VIEW_3D"]):
        bpy.ops.wm.drop_import_file("INVOKE_DEFAULT", directory=str(fold_file.parent), files=both)
    assert [item.name for item in bpy.context.selected_objects] == ["folded arc.001", "other"]
    with bpy.context.temp_override(window=window, area=areas["OUTLINER"]):
        assert not handler.poll_drop(bpy.context)


def test_every_sample_can_be_added(extension):
    samples = extension("curvefold_addon.samples")
    read = extension("curvefold_addon.bridge.drawing").read_drawing
    assert len(samples.names()) >= 19
    for name in samples.names():
        assert bpy.ops.curvefold.add_sample(sample=name) == {"FINISHED"}
        sheet = bpy.context.active_object
        assert sheet.name == name
        assert read(sheet).creases
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def test_a_sample_that_is_broken(extension, broken_drawing, monkeypatch):
    samples = extension("curvefold_addon.samples")
    monkeypatch.setattr(samples, "drawing", lambda name: broken_drawing)
    with pytest.raises(RuntimeError, match=r"broken\.svg"):
        bpy.ops.curvefold.add_sample(sample="lens")
    assert not bpy.data.objects


def test_every_sample_has_a_small_picture(extension):
    samples = extension("curvefold_addon.samples")
    pictures = sorted((samples.FOLDER / "previews").glob("*.png"))
    assert [path.stem for path in pictures] == samples.names()
    assert sum(path.stat().st_size for path in pictures) < 150_000
    for name in samples.names():
        samples.icon(name)  # a number only where there is a screen
        assert tuple(samples._previews[name].image_size) == (128, 128)
    assert samples.icon("no such sample") == 0


def test_the_menu_offers_every_sample(extension):
    """The menu's own drawing, on a layout that writes down what it is told."""
    add_sample, samples = extension("curvefold_addon.operators.add_sample"), extension("curvefold_addon.samples")
    chosen, shown = [], []

    class Layout:
        def row(self):
            return self

        def column(self):
            return self

        def template_icon(self, icon_value, scale):
            shown.append(icon_value)

        def operator(self, name, text):
            chosen.append(Entry())
            return chosen[-1]

    class Entry:
        sample = ""

    class Menu:
        layout = Layout()

    add_sample.SampleMenu.draw(Menu(), bpy.context)
    assert [entry.sample for entry in chosen] == samples.names()
    assert shown == [samples.icon(name) for name in samples.names()]
