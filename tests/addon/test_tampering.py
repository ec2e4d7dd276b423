"""Meshes of papers that somebody has changed by hand, or is editing: nothing of it is lost, and it is said."""

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
def folded_paper(paper, live, monkeypatch):
    # Undo is a change of the drawing, too, and nobody waits for it to rest.
    monkeypatch.setattr(live, "DRAWING_RESTS", 0.0)
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


def in_edit_mode(operator, **options):
    def change(paper) -> None:
        edit(paper, (operator, options))

    return change


def join(paper) -> None:
    bpy.ops.mesh.primitive_cube_add(size=0.02)
    cube = bpy.context.active_object
    bpy.context.view_layer.objects.active = paper
    paper.select_set(True)
    cube.select_set(True)
    assert bpy.ops.object.join() == {"FINISHED"}


def apply_modifier(paper) -> None:
    paper.modifiers.new("Thick", "SOLIDIFY").thickness = 0.001
    with bpy.context.temp_override(object=paper, active_object=paper):
        assert bpy.ops.object.modifier_apply(modifier="Thick") == {"FINISHED"}


def apply_transforms(paper) -> None:
    paper.scale = (2.0, 3.0, 2.0)
    paper.rotation_euler = (0.3, 0.2, 0.1)
    paper.location = (0.1, 0.2, 0.3)
    assert bpy.ops.object.transform_apply() == {"FINISHED"}


def move_origin(paper) -> None:
    bpy.context.scene.cursor.location = (0.03, 0.02, 0.01)
    assert bpy.ops.object.origin_set(type="ORIGIN_CURSOR") == {"FINISHED"}


def move_one(paper) -> None:
    mesh = paper.data
    mesh.vertices[3].co.z += 0.01
    mesh.update()


CHANGES = {
    "join": join,
    "subdivide": in_edit_mode(bpy.ops.mesh.subdivide),
    "delete": in_edit_mode(bpy.ops.mesh.delete, type="FACE"),
    "move": in_edit_mode(bpy.ops.transform.translate, value=(0.01, 0.0, 0.0)),
    "turn": in_edit_mode(bpy.ops.transform.rotate, value=0.5),
    "move one": move_one,
    "modifier": apply_modifier,
    "transform": apply_transforms,
    "origin": move_origin,
}
#: Changes that move the whole mesh, which its object can do as well.
AS_ONE = ("move", "turn", "transform", "origin")


def places(paper) -> np.ndarray:
    """(V,3) in the world."""
    bpy.context.view_layer.update()
    return np.array([paper.matrix_world @ vertex.co for vertex in paper.data.vertices])


@pytest.fixture(params=list(CHANGES))
def changed(request, folded_paper):
    """A folded paper that was changed by hand: (what was done, the paper, its shape in the world, the kept one)."""
    bpy.ops.ed.undo_push(message="folded")
    kept = bytes(folded_paper.data["curvefold_positions"])
    CHANGES[request.param](folded_paper)
    return request.param, folded_paper, places(folded_paper), kept


def test_what_was_done_by_hand_stays_and_is_said(changed, live):
    _, paper, before, kept = changed
    mesh = paper.data
    mesh.curvefold.fold = 70.0
    live.rebuild(mesh)
    tick_until_rest(live)
    mesh.keyframe_insert("curvefold.fold", frame=1)
    for frame in (1, 2):
        bpy.context.scene.frame_set(frame)
    assert np.array_equal(places(paper), before)
    assert bytes(mesh["curvefold_positions"]) == kept
    report = live.report(mesh)
    assert (report.state, report.sentence) == ("trouble", live.BY_HAND)


@pytest.mark.parametrize(
    "operator",
    ["settle", "flatten", "fold_anew", "bake", "lock_sides", "free_sides", "usual_weights", "pin", "flip_crease"],
)
def test_operators_leave_what_was_done_by_hand_and_say_it(folded_paper, live, operator):
    join(folded_paper)
    before = places(folded_paper)
    with pytest.raises(RuntimeError, match=live.BY_HAND):
        getattr(bpy.ops.curvefold, operator)()
    assert np.array_equal(places(folded_paper), before)
    assert folded_paper.data.curvefold.use_assignments


def test_the_paper_is_restored_and_follows_again(changed, live):
    how, paper, before, kept = changed
    mesh = paper.data
    assert bpy.ops.curvefold.restore_paper() == {"FINISHED"}
    assert bytes(mesh["curvefold_positions"]) == kept
    assert live.report(mesh).state == "settled"
    if how in AS_ONE:
        assert np.allclose(places(paper), before, atol=1e-6), "its object has moved instead of its mesh"
    else:
        assert np.array_equal(np.array(paper.matrix_world), np.eye(4))
    mesh.curvefold.fold = 60.0
    tick_until_rest(live)
    assert bytes(mesh["curvefold_positions"]) != kept
    assert not bpy.ops.curvefold.restore_paper.poll()


def test_handles_stay_where_they_are_when_a_placed_paper_is_restored(folded_paper, live):
    hook = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(hook)
    hook.parent, hook.location = folded_paper, (0.01, 0.02, 0.03)
    apply_transforms(folded_paper)
    bpy.context.view_layer.update()
    before = hook.matrix_world.copy()
    assert bpy.ops.curvefold.restore_paper() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert np.allclose(np.array(hook.matrix_world), np.array(before), atol=1e-6)


def test_undo_takes_back_what_was_done_by_hand(folded_paper, live):
    name = folded_paper.name
    bpy.ops.ed.undo_push(message="folded")
    before = shown(folded_paper.data)
    join(folded_paper)
    bpy.ops.ed.undo_push(message="join")
    tick_until_rest(live)
    bpy.ops.ed.undo()
    mesh = bpy.data.objects[name].data
    tick_until_rest(live)
    assert np.array_equal(shown(mesh), before)
    assert live.report(mesh).state == "settled"
    bpy.ops.ed.redo()
    mesh = bpy.data.objects[name].data
    tick_until_rest(live)
    assert len(shown(mesh)) > len(before)
    assert live.report(mesh).sentence == live.BY_HAND
    assert bpy.ops.curvefold.restore_paper() == {"FINISHED"}
    bpy.ops.ed.undo_push(message="restored")
    bpy.ops.ed.undo()
    mesh = bpy.data.objects[name].data
    tick_until_rest(live)
    assert len(shown(mesh)) > len(before), "restoring can be taken back, too"


def test_undo_of_an_operator_in_edit_mode_is_no_change_by_hand(folded_paper, live):
    """Undo leads the mesh in Edit Mode to an older shape than its properties."""
    name = folded_paper.name
    bpy.ops.ed.undo_push(message="folded")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.ed.undo_push(message="edit")
    bpy.ops.object.mode_set(mode="OBJECT")
    folded_paper.data.curvefold.fold = 80.0
    tick_until_rest(live)
    bpy.ops.ed.undo_push(message="slid")
    bpy.ops.ed.undo()
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    mesh = bpy.data.objects[name].data
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert live.report(mesh).state == "settled", live.report(mesh).sentence


def test_what_was_done_by_hand_survives_a_file(folded_paper, live, tmp_path):
    name = folded_paper.name
    join(folded_paper)
    before = shown(folded_paper.data)
    path = str(tmp_path / "joined.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    mesh = bpy.data.objects[name].data
    tick_until_rest(live)
    assert np.array_equal(shown(mesh), before)
    assert live.report(mesh).sentence == live.BY_HAND


def test_a_bake_into_which_something_was_joined_keeps_it_when_it_is_freed(folded_paper, live):
    bpy.context.scene.frame_end = 2
    assert bpy.ops.curvefold.bake() == {"FINISHED"}
    join(folded_paper)
    count = len(folded_paper.data.vertices)
    assert bpy.ops.curvefold.free_bake() == {"FINISHED"}
    tick_until_rest(live)
    assert len(folded_paper.data.vertices) == count
    assert live.report(folded_paper.data).sentence == live.BY_HAND


def test_what_moves_no_vertex_is_no_change(folded_paper, live):
    mesh = folded_paper.data
    bpy.ops.object.transform_apply()
    edit(folded_paper, (bpy.ops.mesh.mark_seam, {}))
    folded_paper.vertex_groups.new(name="Mine")
    mesh.uv_layers.new(name="Texture")
    assert live.report(mesh).state == "settled"
    mesh.curvefold.fold = 60.0
    tick_until_rest(live)
    assert live.report(mesh).state == "settled"


# --- ordinary meshes ----------------------------------------------------------------------------------------------


def test_a_paper_becomes_an_ordinary_mesh(changed, live):
    _, paper, before, _ = changed
    mesh = paper.data
    hook = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(hook)
    mesh.curvefold.handles.add().hook = hook
    users = hook.users
    assert bpy.ops.curvefold.make_ordinary_mesh() == {"FINISHED"}
    assert np.array_equal(places(paper), before)
    assert not mesh.curvefold.is_paper
    # Before 5.0, Blender puts an empty group into every mesh whose settings are asked for.
    assert not mesh.get("curvefold"), mesh["curvefold"].to_dict()
    assert not [key for key in mesh.keys() if key.startswith("curvefold_")]  # noqa: SIM118
    assert (len(mesh.curvefold.handles), mesh.curvefold.sheet) == (0, None)
    assert hook.users == users - 1
    assert (live.session(mesh), live.report(mesh)) == (None, None)
    assert live.active_paper(bpy.context) is None
    tick_until_rest(live)
    assert np.array_equal(places(paper), before)


def test_undo_makes_it_a_paper_again(folded_paper, live):
    name, kept = folded_paper.name, bytes(folded_paper.data["curvefold_positions"])
    bpy.ops.ed.undo_push(message="folded")
    assert bpy.ops.curvefold.make_ordinary_mesh() == {"FINISHED"}
    bpy.ops.ed.undo_push(message="ordinary")
    bpy.ops.ed.undo()
    mesh = bpy.data.objects[name].data
    assert mesh.curvefold.is_paper
    mesh.curvefold.fold = 60.0
    tick_until_rest(live)
    assert bytes(mesh["curvefold_positions"]) != kept


def test_several_papers_become_ordinary_and_a_linked_duplicate_stays_one(folded_paper, live):
    twin, other = folded_paper.copy(), folded_paper.copy()
    other.data = folded_paper.data.copy()
    for item in (twin, other):
        bpy.context.collection.objects.link(item)
    bpy.context.view_layer.update()
    bpy.ops.object.select_all(action="DESELECT")
    for item in (folded_paper, other):
        item.select_set(True)
    before = shown(folded_paper.data)
    assert bpy.ops.curvefold.make_ordinary_mesh() == {"FINISHED"}
    assert [item.data.curvefold.is_paper for item in (folded_paper, other, twin)] == [False, False, True]
    twin.data.curvefold.fold = 70.0
    tick_until_rest(live)
    assert np.array_equal(shown(folded_paper.data), before)
    assert not np.array_equal(shown(twin.data), before)


def test_a_baked_paper_keeps_its_shape_keys(folded_paper):
    bpy.context.scene.frame_end = 2
    bpy.ops.curvefold.bake()
    assert bpy.ops.curvefold.make_ordinary_mesh() == {"FINISHED"}
    assert len(folded_paper.data.shape_keys.key_blocks) == 2
    assert not bpy.ops.curvefold.free_bake.poll()


# --- marks, modes and drawings ------------------------------------------------------------------------------------


def test_lost_marks_are_said_and_come_back(folded_paper):
    mesh = folded_paper.data
    colors = mesh.color_attributes.new("Mine", "FLOAT_COLOR", "POINT")
    colors.data[3].color = (0.25, 0.5, 0.75, 1.0)
    mesh.uv_layers.remove(mesh.uv_layers["flat"])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    with pytest.raises(RuntimeError, match="lost its flat layer; settle the paper in Object Mode"):
        bpy.ops.curvefold.pin()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.curvefold.settle() == {"FINISHED"}
    assert "flat" in mesh.uv_layers
    assert tuple(mesh.color_attributes["Mine"].data[3].color) == (0.25, 0.5, 0.75, 1.0), "nothing else is made anew"


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
