"""Rulings and Gauss images that are kept as objects: what they are, undo, files, and what has none."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def paper(paper, live):
    """Folded, turned and moved."""
    paper.data.curvefold.fold = 60.0
    live.settle(paper.data)
    paper.location = (1.0, 2.0, 3.0)
    paper.rotation_euler = (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    return paper


def splines(item):
    """(n,p,3) in the curve's own coordinates."""
    return [np.array([point.co[:3] for point in spline.points]) for spline in item.data.splines]


def material_of(item, spline):
    return item.data.materials[spline.material_index].name


def test_rulings_are_those_of_the_shape_with_a_material_for_each_kind(extension, live, paper):
    assert bpy.ops.curvefold.rulings_as_object() == {"FINISHED"}
    item = bpy.data.objects["Paper Rulings"]
    session = live.session(paper.data)
    solver = extension("solver")
    found = solver.rulings(session.net, session.positions)
    assert np.array(splines(item)) == pytest.approx(found.segments, abs=1e-6)
    names = [material_of(item, spline) for spline in item.data.splines]
    assert names == [f"Curvefold {solver.RulingKind(kind).name.capitalize()} Ruling" for kind in found.kind]
    assert item.data.bevel_depth > 0.0


def test_they_lie_on_the_paper_and_go_with_it(paper):
    bpy.ops.curvefold.rulings_as_object()
    item = bpy.data.objects["Paper Rulings"]
    assert item.parent == paper
    assert bpy.context.active_object == paper
    bpy.context.view_layer.update()
    assert item.matrix_world == paper.matrix_world
    paper.location.x += 5.0
    bpy.context.view_layer.update()
    assert item.matrix_world.translation.x == pytest.approx(6.0)
    vertices = np.array([vertex.co[:] for vertex in paper.data.vertices])
    cell = 0.1 / 12
    for line in splines(item):
        assert all(np.linalg.norm(vertices - end, axis=1).min() < cell for end in line)


def test_a_snapshot_stays_when_the_paper_folds_on(live, paper):
    bpy.ops.curvefold.rulings_as_object()
    before = np.array(splines(bpy.data.objects["Paper Rulings"]))
    paper.data.curvefold.fold = 20.0
    live.settle(paper.data)
    assert np.array_equal(splines(bpy.data.objects["Paper Rulings"]), before)
    assert bpy.ops.curvefold.rulings_as_object() == {"FINISHED"}
    assert "Paper Rulings.001" in bpy.data.objects


def test_the_gauss_image_lies_on_a_ball_beside_the_paper(extension, live, paper):
    assert bpy.ops.curvefold.gauss_image_as_object() == {"FINISHED"}
    item = bpy.data.objects["Paper Gauss Image"]
    session = live.session(paper.data)
    strokes, patch = extension("solver").gauss_image(session.net, session.positions).strokes()
    lines = splines(item)
    assert np.array(lines[: len(strokes)]) == pytest.approx(strokes, abs=1e-6)
    used = [spline.material_index for spline in item.data.splines]
    assert used[: len(strokes)] == patch.tolist()
    circles = lines[len(strokes) :]
    assert len(circles) == 3
    assert set(used[len(strokes) :]) == {len(item.data.materials) - 1}
    assert np.linalg.norm(np.concatenate(circles), axis=1) == pytest.approx(1.0, abs=1e-6)
    assert tuple(item.scale) == pytest.approx((0.025, 0.025, 0.025), rel=1e-3)
    assert item.parent == paper
    vertices = np.array([vertex.co[:] for vertex in paper.data.vertices])
    assert item.location.x - item.scale.x > vertices[:, 0].max()
    assert item.location.z - item.scale.z == pytest.approx(vertices[:, 2].min(), abs=1e-5)


@pytest.mark.parametrize("kind", ["rulings", "gauss_image"])
def test_it_is_there_for_a_render(paper, kind):
    getattr(bpy.ops.curvefold, f"{kind}_as_object")()
    item = paper.children[0]
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    assert len(mesh.polygons) > 4 * len(item.data.splines)
    assert not item.hide_render
    assert paper.users_collection == item.users_collection
    for material in item.data.materials:
        assert any(node.bl_idname == "ShaderNodeBsdfPrincipled" for node in material.node_tree.nodes)


@pytest.mark.parametrize("kind", ["rulings", "gauss_image"])
def test_one_undo_takes_it_away_and_leaves_the_paper(paper, kind):
    before = bytes(paper.data["curvefold_positions"])
    bpy.ops.ed.undo_push(message="folded")
    getattr(bpy.ops.curvefold, f"{kind}_as_object")("EXEC_DEFAULT", True)
    assert len(bpy.data.objects["Paper"].children) == 1
    bpy.ops.ed.undo()
    assert len(bpy.data.objects["Paper"].children) == 0
    assert bytes(bpy.data.objects["Paper"].data["curvefold_positions"]) == before
    bpy.ops.ed.redo()
    assert len(bpy.data.objects["Paper"].children) == 1


def test_a_file_keeps_them(paper, tmp_path):
    bpy.ops.curvefold.rulings_as_object()
    bpy.ops.curvefold.gauss_image_as_object()
    names = ("Paper Rulings", "Paper Gauss Image")
    before = [splines(bpy.data.objects[name]) for name in names]
    path = str(tmp_path / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    for name, lines in zip(names, before, strict=True):
        item = bpy.data.objects[name]
        assert item.parent == bpy.data.objects["Paper"]
        assert all(np.array_equal(a, b) for a, b in zip(splines(item), lines, strict=True))
        assert all(item.data.materials)


def test_materials_are_shared(paper):
    bpy.ops.curvefold.rulings_as_object()
    count = len(bpy.data.materials)
    bpy.ops.curvefold.rulings_as_object()
    assert len(bpy.data.materials) == count


def test_a_paper_that_sleeps_is_asked_too(live, paper):
    live.forget()
    assert bpy.ops.curvefold.rulings_as_object() == {"FINISHED"}


def test_flat_paper_has_no_rulings_but_a_gauss_image(live, paper):
    bpy.ops.curvefold.flatten()
    with pytest.raises(RuntimeError, match="plane"):
        bpy.ops.curvefold.rulings_as_object()
    assert not paper.children
    assert bpy.ops.curvefold.gauss_image_as_object() == {"FINISHED"}


@pytest.mark.parametrize("kind", ["rulings", "gauss_image"])
def test_a_baked_paper_says_what_to_do(paper, kind):
    bpy.context.scene.frame_end = 2
    assert bpy.ops.curvefold.bake() == {"FINISHED"}
    with pytest.raises(RuntimeError, match="free its bake"):
        getattr(bpy.ops.curvefold, f"{kind}_as_object")()
    assert not paper.children
