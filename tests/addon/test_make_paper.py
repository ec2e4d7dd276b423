"""From a drawing to a paper."""

import bpy
import numpy as np
import pytest


def shown(mesh: bpy.types.Mesh) -> np.ndarray:
    return np.array([vertex.co[:] for vertex in mesh.vertices])


def test_the_paper_lies_flat_on_its_drawing(sheet, live):
    sheet.location = (0.3, -0.2, 0.5)
    sheet.rotation_euler = (0.4, 0.1, 1.0)
    bpy.context.view_layer.update()
    assert bpy.ops.curvefold.make_paper("EXEC_DEFAULT", True, resolution=12) == {"FINISHED"}
    paper = bpy.context.active_object
    assert paper.select_get()
    assert [thing.name for thing in bpy.context.selected_objects] == [paper.name]
    mesh = paper.data
    positions = shown(mesh)
    assert positions[:, 2] == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(positions, axis=0) == pytest.approx([0.1, 0.1, 0.0], abs=1e-6)
    flat = {loop.vertex_index: mesh.uv_layers["flat"].uv[loop.index].vector[:] for loop in mesh.loops}
    assert np.array([flat[k] for k in range(len(positions))]) == pytest.approx(positions[:, :2], abs=1e-7)
    assert np.array(paper.matrix_world) == pytest.approx(np.array(sheet.matrix_world), abs=1e-6)
    assert mesh.curvefold.is_paper
    assert mesh.curvefold.sheet == sheet
    assert mesh.materials[0].name == "Curvefold Paper"
    assert live.report(mesh).sentence == "Flat"


def test_folds_at_once_when_asked(sheet, live):
    bpy.ops.curvefold.make_paper(resolution=12, fold=50.0)
    mesh = bpy.context.active_object.data
    facts = live.report(mesh)
    assert facts.state == "settled"
    assert facts.fold_angle == pytest.approx(45.0, abs=2.0)
    assert facts.creases[0].folded
    assert facts.creases[0].found in ("M", "V")
    assert 0 < facts.stretch_mean < 0.003
    assert facts.iterations > 0
    assert np.ptp(shown(mesh)[:, 2]) > 0.005


@pytest.mark.parametrize("letter", ["M", "V"])
def test_folds_to_the_side_that_the_drawing_says(sheet, live, letter):
    sheet.children[0].curvefold.assignment = letter
    bpy.ops.curvefold.make_paper(resolution=12, fold=50.0)
    assert live.report(bpy.context.active_object.data).creases[0].found == letter


def test_a_crease_stands_for_its_sheet(sheet):
    bpy.context.view_layer.objects.active = sheet.children[0]
    assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
    assert bpy.context.active_object.data.curvefold.sheet == sheet


def test_leaves_edit_mode(sheet):
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
    assert bpy.context.mode == "OBJECT"


def test_can_be_undone(sheet):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.curvefold.make_paper("EXEC_DEFAULT", True, resolution=12)
    bpy.ops.ed.undo()
    assert not bpy.data.meshes
    bpy.ops.ed.redo()
    assert bpy.data.objects["Paper"].data.curvefold.is_paper


def test_needs_a_drawing():
    assert not bpy.ops.curvefold.make_paper.poll()
    with pytest.raises(RuntimeError, match="poll"):
        bpy.ops.curvefold.make_paper()


@pytest.mark.parametrize("resolution", [0, 4, 12])
def test_a_drawing_that_cannot_be_folded_is_one_sentence_and_leaves_nothing(sheet, cross_border, resolution):
    cross_border(sheet)
    with pytest.raises(RuntimeError, match="crosses itself") as caught:
        bpy.ops.curvefold.make_paper(resolution=resolution)
    assert "Traceback" not in str(caught.value)
    assert not bpy.data.meshes
    assert bpy.context.active_object == sheet


def sheets_with_arcs(count):
    made = []
    for k in range(count):
        bpy.ops.curvefold.add_sample(sample="one_arc")
        made.append(bpy.context.active_object)
        made[-1].location.x = float(k)
    for sheet in made:
        sheet.select_set(True)
    bpy.context.view_layer.update()
    return made


def papers():
    return [item for item in bpy.data.objects if item.type == "MESH" and item.data.curvefold.is_paper]


def test_of_each_selected_sheet_a_paper_is_made():
    sheets = sheets_with_arcs(3)
    assert bpy.ops.curvefold.make_paper(resolution=8) == {"FINISHED"}
    assert {paper.data.curvefold.sheet for paper in papers()} == set(sheets)
    assert sorted(paper.location.x for paper in papers()) == [0.0, 1.0, 2.0]
    assert set(bpy.context.selected_objects) == set(papers())
    assert not any(sheet.curvefold.show for sheet in sheets)


def test_of_sheets_of_which_some_have_a_paper_the_others_get_one():
    first, second, third = sheets_with_arcs(3)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = second
    bpy.ops.curvefold.make_paper(resolution=8)
    for sheet in (first, second, third):
        sheet.curvefold.show = True
        sheet.select_set(True)
    bpy.context.view_layer.objects.active = first
    bpy.ops.curvefold.make_paper(resolution=8)
    assert sorted(paper.data.curvefold.sheet.name for paper in papers()) == sorted(
        sheet.name for sheet in (first, second, third)
    )


def test_a_sheet_of_which_no_paper_can_be_made_stops_no_other(cross_border):
    first, second = sheets_with_arcs(2)
    bpy.ops.curvefold.add_sheet(size="SQUARE")
    broken = bpy.context.active_object
    cross_border(broken)
    for sheet in (first, second):
        sheet.select_set(True)
    assert bpy.ops.curvefold.make_paper(resolution=8) == {"FINISHED"}
    assert {paper.data.curvefold.sheet for paper in papers()} == {first, second}
    assert broken.curvefold.show


def test_what_is_selected_beside_the_active_sheet_is_not_meant():
    sheets = sheets_with_arcs(2)
    bpy.ops.curvefold.add_sheet()
    other = bpy.context.active_object
    for sheet in sheets:
        sheet.select_set(True)
    other.select_set(False)
    bpy.ops.curvefold.make_paper(resolution=8)
    assert [paper.data.curvefold.sheet for paper in papers()] == [other]
