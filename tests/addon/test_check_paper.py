"""Check Paper: papers live, moved, baked and scaled, meshes of others, and what cannot be checked."""

import bpy
import numpy as np
import pytest
from mathutils import Vector


@pytest.fixture
def module(extension):
    return extension("curvefold_addon.bridge.mesh_check")


@pytest.fixture
def paper(paper, live):
    """Folded, turned, moved and made larger."""
    paper.data.curvefold.fold = 60.0
    live.settle(paper.data)
    paper.location = (1.0, 2.0, 3.0)
    paper.rotation_euler = (0.3, 0.2, 0.1)
    paper.scale = (3.0, 3.0, 3.0)
    bpy.context.view_layer.update()
    return paper


@pytest.fixture
def said(extension, monkeypatch):
    """What the operator reports, a list of (kind, sentence)."""
    operator = extension("curvefold_addon.operators.check_paper")
    reports = []
    check = operator.mesh_check.check

    def noted(*arguments):
        found = check(*arguments)
        reports.append(found)
        return found

    monkeypatch.setattr(operator.mesh_check, "check", noted)
    return reports


def run(said):
    """What one check found."""
    assert bpy.ops.curvefold.check_paper() == {"FINISHED"}
    return said[-1]


def selected(mesh):
    return [vertex.index for vertex in mesh.vertices if vertex.select]


def as_plain_mesh(paper):
    """A copy that nothing of this extension is known of, active."""
    item = bpy.data.objects.new("Plain", bpy.data.meshes.new("Plain"))
    vertices = [vertex.co[:] for vertex in paper.data.vertices]
    item.data.from_pydata(vertices, [], [list(face.vertices) for face in paper.data.polygons])
    flat = item.data.uv_layers.new(name="Anything")
    for corner, uv in zip(flat.uv, paper.data.uv_layers["flat"].uv, strict=True):
        corner.vector = 7.0 * uv.vector  # of no particular scale
    bpy.context.collection.objects.link(item)
    bpy.context.view_layer.objects.active = item
    return item


def move_inside(mesh, by):
    """Moves the vertex in the middle of the flat sheet; its index."""
    flat = {loop.vertex_index: mesh.uv_layers[0].uv[loop.index].vector.copy() for loop in mesh.loops}
    middle = sum(flat.values(), start=Vector((0.0, 0.0))) / len(flat)
    index = min(flat, key=lambda k: (flat[k] - middle).length)
    mesh.vertices[index].co.x += by
    mesh.update()
    return index


def around(mesh, index):
    """A vertex and its neighbours."""
    return {vertex for edge in mesh.edges if index in edge.vertices for vertex in edge.vertices}


def test_a_folded_paper_is_paper(paper, said):
    before = selected(paper.data)
    found = run(said)
    assert found.ok
    assert found.sentence.startswith("This is paper: stretch 0.0")
    assert "folded" not in found.sentence
    assert selected(paper.data) == before


def test_a_flat_paper_is_paper_whose_creases_are_not_folded(paper, live, said):
    bpy.ops.curvefold.flatten()
    found = run(said)
    assert found.ok
    assert found.sentence.endswith("none of its creases is folded")


def test_a_moved_vertex_is_found_and_selected(paper, said):
    kept = bytes(paper.data["curvefold_positions"])
    index = move_inside(paper.data, 0.004)
    found = run(said)
    assert not found.ok
    assert found.sentence.startswith("This is not paper: an edge is stretched by")
    (near,) = selected(paper.data)
    assert near in around(paper.data, index)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert selected(paper.data) == [near]
    # It was looked at, and nothing else: neither shape has changed.
    assert bytes(paper.data["curvefold_positions"]) == kept
    assert not run(said).ok


def test_the_net_is_asked_too(paper, live, module):
    session = live.make_session(paper)
    graph = bpy.context.evaluated_depsgraph_get()
    assert module.check(paper, graph, session).ok
    # A wrong angle that the shown mesh hides: its vertices are where they were.
    hidden = np.flatnonzero(np.asarray(abs(session.net.render_map.weights).sum(axis=0)).ravel() == 0)
    session.positions[hidden[0]] += 0.05
    found = module.check(paper, graph, session)
    assert "This is not paper: " in found.sentence
    # Where the mesh shows another shape, it is that shape alone that counts.
    for vertex in paper.data.vertices:
        vertex.co.x += 1.0
    assert module.check(paper, bpy.context.evaluated_depsgraph_get(), session).ok


def test_any_other_mesh_with_its_uv_map(paper, said):
    item = as_plain_mesh(paper)
    assert run(said).sentence.startswith("This is paper: ")
    index = move_inside(item.data, 0.004)
    assert not run(said).ok
    (near,) = selected(item.data)
    assert near in around(item.data, index)


def test_a_mesh_without_a_uv_map_and_one_without_faces(paper):
    item = as_plain_mesh(paper)
    item.data.uv_layers.remove(item.data.uv_layers[0])
    with pytest.raises(RuntimeError, match="Plain has no UV map, which has to be its flat sheet"):
        bpy.ops.curvefold.check_paper()
    item.data.clear_geometry()
    with pytest.raises(RuntimeError, match="Plain has no faces"):
        bpy.ops.curvefold.check_paper()


def test_a_baked_paper_is_checked_at_the_frame_that_is_shown(paper, said):
    bpy.context.scene.frame_end = 2
    assert bpy.ops.curvefold.bake() == {"FINISHED"}
    assert run(said).ok
    keys = paper.data.shape_keys
    for point in keys.key_blocks[1].data:
        point.co.z *= 1.3
    bpy.context.scene.frame_set(1)
    assert run(said).ok
    bpy.context.scene.frame_set(2)
    assert not run(said).ok


def test_modifiers_that_move_vertices_count_and_those_that_make_some_are_left_out(paper, said):
    wave = paper.modifiers.new("Cast", "CAST")
    wave.factor = 0.5
    found = run(said)
    assert found.sentence.startswith("With its modifiers this is not paper: edges are stretched")
    # That is so everywhere; a place is shown all the same.
    assert selected(paper.data) == [found.vertex]
    paper.modifiers.clear()
    paper.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.001
    assert run(said).sentence.startswith("Without its modifiers this is paper: ")


def test_an_object_that_is_scaled_unevenly(paper, said):
    paper.scale.z = 4.0
    assert run(said).sentence.endswith("; the object is scaled unevenly")
    paper.scale = (-3.0, 3.0, 3.0)
    assert run(said).ok


def test_undo_brings_the_selection_back(paper):
    move_inside(paper.data, 0.004)
    before = selected(paper.data)
    bpy.ops.ed.undo_push(message="moved")
    assert bpy.ops.curvefold.check_paper("EXEC_DEFAULT", True) == {"FINISHED"}
    assert selected(bpy.data.objects["Paper"].data) != before
    bpy.ops.ed.undo()
    assert selected(bpy.data.objects["Paper"].data) == before


def test_a_handle_stands_for_its_paper_and_edit_mode_has_to_be_left(paper, said):
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.curvefold.check_paper.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty
    assert not bpy.ops.curvefold.check_paper.poll()
    handle = paper.data.curvefold.handles.add()
    handle.hook = empty
    assert run(said).ok


def test_it_is_in_the_object_menu():
    drawn = bpy.types.VIEW3D_MT_object._dyn_ui_initialize()
    assert any(function.__module__.endswith("check_paper") for function in drawn)


def test_on_the_command_line(extension, folded, tmp_path, capsys):
    main = extension("curvefold_addon.cli").main
    extension("solver").write_results(folded, tmp_path)
    for name in ("folded.obj", "folded.fold"):
        assert main(["verify", str(tmp_path / name)]) == 0
        assert f"{name} is paper: " in capsys.readouterr().err
    assert main(["verify", str(tmp_path / "report.json")]) == 2
