"""Sheets that are deleted, moved to another scene, or scaled: what their papers and creases do and say."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix


@pytest.fixture
def folded_paper(paper, live, monkeypatch):
    monkeypatch.setattr(live, "DRAWING_RESTS", 0.0)
    # Blender's operators work on what is seen.
    paper.data.curvefold.sheet.curvefold.show = True
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    return paper


@pytest.fixture
def sidebar(extension, monkeypatch):
    """What the tab says now."""
    panels, wording = extension("curvefold_addon.panels"), extension("curvefold_addon.wording")

    def said() -> list[str]:
        sentences = []
        with monkeypatch.context() as patch:
            patch.setattr(panels.KeptBox, "say", lambda box, text, *icon, **options: sentences.append(text))
            panels.MainPanel.draw(Anything(), bpy.context)
        return sentences

    said.wording = wording
    return said


class Anything:
    """Stands in for a panel and its layout."""

    def __getattr__(self, name):
        return Anything()

    def __call__(self, *arguments, **options):
        return Anything()


def tick_until_rest(live) -> None:
    assert any(not live.tick(0.05) for _ in range(1000)), "it never rests"


def choose(*items) -> None:
    """Selects objects; the first one is active."""
    for item in bpy.context.selected_objects:
        item.select_set(False)
    for item in items:
        item.select_set(True)
    bpy.context.view_layer.objects.active = items[0]


def delete(sheet) -> None:
    choose(sheet)
    assert bpy.ops.object.delete() == {"FINISHED"}
    bpy.context.view_layer.update()


def remove(sheet) -> None:
    bpy.data.objects.remove(sheet)
    bpy.context.view_layer.update()


def size(item) -> np.ndarray:
    """Of the flat sheet of a paper, or the border of a sheet, in the world."""
    bpy.context.view_layer.update()
    if item.type == "CURVE":
        points = np.array([item.matrix_world @ point.co.xyz for point in item.data.splines[0].points])
    else:
        flat = [item.matrix_world @ entry.vector.to_3d() for entry in item.data.uv_layers["flat"].uv]
        points = np.array(flat)
    return np.ptp(points, axis=0)[:2]


# --- deleted ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("how", [delete, remove])
def test_a_paper_whose_sheet_is_deleted_says_so_and_folds_on(folded_paper, sheet, live, sidebar, how):
    choose(folded_paper)
    assert sidebar.wording.SHEET_DELETED not in sidebar()
    before = bytes(folded_paper.data["curvefold_positions"])
    how(sheet)
    tick_until_rest(live)
    choose(folded_paper)
    assert sidebar.wording.SHEET_DELETED in sidebar()
    assert bytes(folded_paper.data["curvefold_positions"]) == before
    folded_paper.data.curvefold.fold = 70.0
    tick_until_rest(live)
    assert bytes(folded_paper.data["curvefold_positions"]) != before
    folded_paper.data.curvefold.sheet = None
    assert sidebar.wording.SHEET_DELETED not in sidebar(), "whoever takes it away knows"


def test_it_still_says_so_in_a_file(folded_paper, sheet, sidebar, tmp_path):
    delete(sheet)
    path, name = str(tmp_path / "paper.blend"), folded_paper.name
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    choose(bpy.data.objects[name])
    assert sidebar.wording.SHEET_DELETED in sidebar()


def test_a_sheet_in_another_scene_is_not_deleted(folded_paper, sheet, sidebar):
    other = bpy.data.scenes.new("Other")
    other.collection.objects.link(sheet)
    for collection in bpy.context.scene.collection, *bpy.context.scene.collection.children:
        if sheet.name in collection.objects:
            collection.objects.unlink(sheet)
    choose(folded_paper)
    assert sidebar.wording.SHEET_ELSEWHERE in sidebar()
    assert sidebar.wording.SHEET_DELETED not in sidebar()


def test_nobody_draws_on_a_deleted_sheet(folded_paper, sheet):
    delete(sheet)
    choose(folded_paper)
    assert not bpy.ops.curvefold.draw_crease.poll()


@pytest.mark.parametrize("with_paper", [True, False])
def test_a_crease_without_its_sheet_says_so_and_is_put_on_another(request, sheet, sidebar, with_paper):
    if with_paper:  # which keeps the deleted sheet
        request.getfixturevalue("folded_paper")
    crease = sheet.children[0]
    crease.curvefold.assignment = "M"
    choose(crease)
    assert not [text for text in sidebar() if sidebar.wording.LOST_CREASE in text]
    delete(sheet)
    choose(crease)
    sentence = f"{crease.name} {sidebar.wording.LOST_CREASE}"
    assert sentence in sidebar()
    bpy.ops.curvefold.add_sheet(size="SQUARE")
    other = bpy.context.active_object
    choose(other, crease)
    assert bpy.ops.curvefold.make_crease() == {"FINISHED"}
    assert (crease.parent, crease.curvefold.assignment) == (other, "M")
    choose(crease)
    assert sentence not in sidebar()


# --- scaled -------------------------------------------------------------------------------------------------------


def test_a_paper_is_as_large_as_its_scaled_sheet_at_once(folded_paper, sheet, live):
    kept = bytes(folded_paper.data["curvefold_positions"])
    sheet.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert size(folded_paper) == pytest.approx([0.2, 0.2])
    assert bytes(folded_paper.data["curvefold_positions"]) == kept, "its net stays the same"
    # And it stays so when the scale is applied.
    choose(sheet)
    assert bpy.ops.object.transform_apply(location=False, rotation=False) == {"FINISHED"}
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert size(sheet) == pytest.approx([0.2, 0.2])
    assert size(folded_paper) == pytest.approx([0.2, 0.2])
    assert tuple(folded_paper.scale) == pytest.approx((1.0, 1.0, 1.0))


def test_without_a_window_it_follows_when_it_is_settled(folded_paper, sheet, live):
    sheet.scale = (3.0, 3.0, 3.0)
    live.settle(folded_paper.data)
    assert size(folded_paper) == pytest.approx([0.3, 0.3])


def test_a_paper_of_a_scaled_sheet_begins_and_stays_as_large(sheet, live):
    sheet.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
    made = bpy.context.active_object
    assert size(made) == pytest.approx([0.2, 0.2])
    choose(sheet)
    bpy.ops.object.transform_apply(location=False, rotation=False)
    live.settle(made.data)
    assert size(made) == pytest.approx([0.2, 0.2]), "it was twice that"


def test_what_is_scaled_together_stays_together(folded_paper, sheet, live):
    for item in (sheet, folded_paper):
        item.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert size(folded_paper) == pytest.approx([0.2, 0.2])
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    for item in (sheet, folded_paper):
        item.parent = parent
    parent.matrix_world = Matrix.Scale(0.5, 4)
    bpy.context.view_layer.update()
    live.rebuild(folded_paper.data)
    tick_until_rest(live)
    assert size(folded_paper) == pytest.approx([0.1, 0.1])


def test_a_paper_that_is_scaled_alone_keeps_that(folded_paper, sheet, live):
    folded_paper.scale = (3.0, 3.0, 3.0)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert size(folded_paper) == pytest.approx([0.3, 0.3])
    sheet.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert size(folded_paper) == pytest.approx([0.6, 0.6])


def test_other_units_scale_nothing(folded_paper, sheet, live):
    bpy.context.scene.unit_settings.scale_length = 0.01
    live.rebuild(folded_paper.data)
    tick_until_rest(live)
    assert size(folded_paper) == pytest.approx([0.1, 0.1])


def test_undo_and_redo_of_a_scaled_sheet(folded_paper, sheet, live):
    paper, name = folded_paper.name, sheet.name
    bpy.ops.ed.undo_push(message="folded")
    sheet.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="scaled")
    tick_until_rest(live)
    for step, expected in ((bpy.ops.ed.undo, 0.1), (bpy.ops.ed.redo, 0.2), (bpy.ops.ed.undo, 0.1)):
        step()
        bpy.context.view_layer.update()
        tick_until_rest(live)
        assert size(bpy.data.objects[name]) == pytest.approx([expected] * 2)
        assert size(bpy.data.objects[paper]) == pytest.approx([expected] * 2)
