"""Meshes of papers that somebody has edited by hand, or is editing: a paper cannot be cut."""

import bpy
import numpy as np
import pytest


def shown(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", values)
    return values


def tick_until_rest(live) -> None:
    assert any(not live.tick(0.05) for _ in range(1000)), "it never rests"


@pytest.fixture
def folded_paper(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    return paper


def edit(paper, *operators) -> None:
    bpy.context.view_layer.objects.active = paper
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    for operator, options in operators:
        operator(**options)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()


@pytest.mark.parametrize("how", ["subdivide", "delete", "move"])
def test_what_was_done_to_the_mesh_is_undone(folded_paper, live, how):
    operators = {
        "subdivide": (bpy.ops.mesh.subdivide, {}),
        "delete": (bpy.ops.mesh.delete, {"type": "FACE"}),
        "move": (bpy.ops.transform.translate, {"value": (0.01, 0.0, 0.0)}),
    }
    mesh = folded_paper.data
    before, kept = shown(mesh), bytes(mesh["curvefold_positions"])
    edit(folded_paper, operators[how])
    assert not np.array_equal(shown(mesh), before)
    tick_until_rest(live)
    assert np.array_equal(shown(mesh), before)
    assert bytes(mesh["curvefold_positions"]) == kept
    assert live.report(mesh).state == "settled"


def test_lost_marks_are_said_and_come_back(folded_paper):
    mesh = folded_paper.data
    mesh.uv_layers.remove(mesh.uv_layers["flat"])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    with pytest.raises(RuntimeError, match="lost its flat layer; settle the paper in Object Mode"):
        bpy.ops.curvefold.pin()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.curvefold.settle() == {"FINISHED"}
    assert "flat" in mesh.uv_layers


@pytest.mark.parametrize("operator", ["settle", "flatten", "fold_anew"])
def test_in_edit_mode_it_is_refused_in_a_sentence(folded_paper, operator):
    mesh = folded_paper.data
    kept = bytes(mesh["curvefold_positions"])
    mesh.curvefold.resolution = 10
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="is in Edit Mode; leave it to fold the paper"):
        getattr(bpy.ops.curvefold, operator)()
    assert bytes(mesh["curvefold_positions"]) == kept
    assert mesh.curvefold.fold == 50.0


def test_a_mesh_that_another_object_edits_is_left_alone(folded_paper, live):
    twin = folded_paper.copy()
    bpy.context.collection.objects.link(twin)
    twin.name = "Another"
    bpy.context.view_layer.objects.active = twin
    bpy.ops.object.mode_set(mode="EDIT")
    mesh = folded_paper.data
    kept = bytes(mesh["curvefold_positions"])
    mesh.curvefold.fold = 70.0
    tick_until_rest(live)
    assert bytes(mesh["curvefold_positions"]) == kept
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert bytes(mesh["curvefold_positions"]) != kept


def test_a_paper_whose_drawing_is_spoilt_still_folds(folded_paper, sheet, live, monkeypatch, cross_border):
    monkeypatch.setattr(live, "DRAWING_RESTS", 0.0)
    cross_border(sheet)
    mesh = folded_paper.data
    live.rebuild(mesh)
    kept = bytes(mesh["curvefold_positions"])
    mesh.curvefold.fold = 70.0
    tick_until_rest(live)
    assert bytes(mesh["curvefold_positions"]) != kept
    assert live.report(mesh).state == "trouble"
    assert "crosses itself" in live.report(mesh).sentence
