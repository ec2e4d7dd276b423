"""The drawing of a paper, shown and hidden, and its size as Blender frames it."""

import bpy
import numpy as np
import pytest


def hidden(sheet):
    return {part.name: part.hide_get() for part in (sheet, *sheet.children)}


@pytest.fixture
def sheet_of(paper):
    return paper.data.curvefold.sheet


def test_a_new_paper_hides_its_drawing_which_stays_in_the_file(paper, sheet_of):
    assert set(hidden(sheet_of).values()) == {True}
    assert len(hidden(sheet_of)) == 2
    assert bpy.context.selected_objects == [paper]
    assert all(part.name in bpy.context.scene.objects for part in (sheet_of, *sheet_of.children))


def test_the_switch_shows_it_and_hides_it(paper, sheet_of):
    settings = sheet_of.curvefold
    assert not settings.show
    settings.show = True
    assert set(hidden(sheet_of).values()) == {False}
    assert settings.show
    settings.show = False
    assert set(hidden(sheet_of).values()) == {True}


def test_the_switch_tells_what_blenders_own_hide_has_done(paper, sheet_of):
    sheet_of.children[0].hide_set(False)
    assert sheet_of.curvefold.show
    sheet_of.children[0].hide_set(True)
    assert not sheet_of.curvefold.show


def test_drawing_another_crease_shows_it_again(paper, sheet_of):
    bpy.ops.curvefold.draw_crease()
    assert set(hidden(sheet_of).values()) == {False}
    assert len(sheet_of.children) == 2


def test_editing_the_drawing_shows_all_of_it_in_edit_mode_and_the_way_back_hides_it(paper, sheet_of):
    assert bpy.ops.curvefold.edit_drawing() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_CURVE"
    assert {item.name for item in bpy.context.objects_in_mode} == hidden(sheet_of).keys()
    assert set(hidden(sheet_of).values()) == {False}
    sheet_of.curvefold.show = False
    assert sheet_of.curvefold.show, "what is edited stays"
    assert bpy.ops.curvefold.back_to_paper() == {"FINISHED"}
    assert bpy.context.active_object == paper
    assert bpy.context.mode == "OBJECT"
    assert set(hidden(sheet_of).values()) == {True}


def test_what_is_hidden_with_its_collection_cannot_be_edited(paper, sheet_of):
    collection = bpy.data.collections.new("Drawing")
    bpy.context.scene.collection.children.link(collection)
    for part in (sheet_of, *sheet_of.children):
        for other in part.users_collection:
            other.objects.unlink(part)
        collection.objects.link(part)
    bpy.context.view_layer.layer_collection.children["Drawing"].hide_viewport = True
    with pytest.raises(RuntimeError, match="hidden with its collection"):
        bpy.ops.curvefold.edit_drawing()
    bpy.context.view_layer.layer_collection.children["Drawing"].exclude = True
    bpy.context.view_layer.update()
    assert not sheet_of.curvefold.show, "it is not there at all"


def test_a_hidden_drawing_is_folded_as_it_is_shown(extension, paper, sheet_of, tmp_path):
    read = extension("curvefold_addon.bridge.drawing").read_drawing
    crease = sheet_of.children[0]
    crease.shape_key_add(name="Basis")
    key = crease.shape_key_add(name="Up")
    for point in key.data:
        point.co.y += 0.01
        point.handle_left.y += 0.01
        point.handle_right.y += 0.01
    key.value = 0.5
    bpy.context.view_layer.update()
    before = read(sheet_of).creases[0].points
    assert before[0][1] == pytest.approx(0.01, abs=1e-4), "0.005 where it was drawn"
    path = tmp_path / "hidden.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    sheet = next(item for item in bpy.data.objects if item.curvefold.role == "SHEET")
    assert not sheet.curvefold.show
    assert np.array_equal(read(sheet).creases[0].points, before)


def radii(curve):
    return {point.radius for spline in curve.splines for point in (*spline.bezier_points, *spline.points)}


def test_blender_frames_drawings_as_large_as_they_are(sheet):
    """It counts the radius of points, and a thickness in the dimensions."""
    bpy.ops.curvefold.add_sheet(size="CIRCLE", side=0.1)
    circle = bpy.context.active_object
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.1)
    bpy.ops.curvefold.sheet_from_object()
    made = bpy.context.active_object
    for item in (sheet, *sheet.children, circle, made):
        assert radii(item.data) == {0.0}, item.name
        assert item.data.bevel_depth == 0.0
    bpy.context.view_layer.update()
    assert tuple(circle.dimensions) == pytest.approx((0.1, 0.1, 0.0), abs=1e-6)


def test_a_crease_that_somebody_gave_a_thickness_keeps_it(sheet):
    bpy.ops.curve.primitive_bezier_curve_add(radius=0.02)
    curve = bpy.context.active_object
    curve.data.bevel_depth = 0.001
    sheet.select_set(True)
    bpy.ops.curvefold.make_crease()
    assert curve.curvefold.role == "CREASE"
    assert curve.data.bevel_depth == pytest.approx(0.001)
    assert radii(curve.data) == {1.0}


def test_lines_to_parents_go_with_the_first_handle_and_may_come_back(extension, paper):
    views = [
        area.spaces.active.overlay
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        if area.type == "VIEW_3D"
    ]
    assert views
    bpy.ops.curvefold.add_handle(at=(0.02, 0.03))
    assert {view.show_relationship_lines for view in views} == {False}
    for view in views:
        view.show_relationship_lines = True
    bpy.ops.curvefold.add_handle(at=(0.02, -0.03))
    assert {view.show_relationship_lines for view in views} == {True}
