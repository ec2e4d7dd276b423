"""Handles: placed, added, hooked, pinned and removed; flattening and settling."""

from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector


def positions(mesh: bpy.types.Mesh) -> np.ndarray:
    return np.frombuffer(mesh["curvefold_positions"]).reshape(-1, 3).copy()


def select_vertices(paper, *places):
    """Edit Mode with the vertices nearest to these places of the flat sheet selected; their places."""
    mesh = paper.data
    flat = {loop.vertex_index: mesh.uv_layers["flat"].uv[loop.index].vector for loop in mesh.loops}
    chosen = [min(flat, key=lambda k: (flat[k] - Vector(place)).length) for place in places]
    found = [mesh.vertices[k].co.copy() for k in chosen]
    bpy.context.view_layer.objects.active = paper
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_mode(type="VERT")
    bpy.ops.mesh.select_all(action="DESELECT")
    edited = bmesh.from_edit_mesh(mesh)
    edited.verts.ensure_lookup_table()
    for k in chosen:
        edited.verts[k].select = True
    bmesh.update_edit_mesh(mesh)
    return found


@pytest.fixture
def folded_paper(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    return paper


def handles(paper):
    return paper.data.curvefold.handles


# --- by the mouse ---------------------------------------------------------------------------------------------


@pytest.fixture
def placing(extension):
    return extension("curvefold_addon.operators.place_handle")


def test_a_ray_places_a_handle_where_it_meets_the_paper(placing, folded_paper, live):
    paper = folded_paper
    paper.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Rotation(0.7, 4, (1, 0, 1)) @ Matrix.Scale(2, 4)
    bpy.context.view_layer.update()
    place = live.session(paper.data).place_of((0.02, -0.03))
    world = paper.matrix_world @ Vector(place)
    normal = (paper.matrix_world.to_3x3() @ Vector((0, 0, 1))).normalized()
    before = positions(paper.data)
    empty = placing.place_along(bpy.context, paper, placing.MouseRay(world + normal, -normal))
    handle = handles(paper)[0]
    assert handle.name == empty.name == "Handle 1"
    assert handle.at[:] == pytest.approx((0.02, -0.03), abs=1e-4)
    assert handle.hook == empty
    assert empty.parent == paper
    assert tuple(empty.matrix_world.translation) == pytest.approx(tuple(world), abs=1e-4)
    assert (empty.empty_display_type, empty.show_in_front) == ("SPHERE", True)
    assert empty.empty_display_size == pytest.approx(0.0025, rel=0.01)
    assert bpy.context.active_object == empty
    assert empty.select_get()
    assert not paper.select_get()
    assert np.array_equal(positions(paper.data), before), "to be held where it is moves nothing"
    empty.location.z += 0.003
    live.settle(paper.data)
    assert not np.array_equal(positions(paper.data), before)


def test_a_ray_that_misses_places_nothing(placing, paper):
    assert placing.place_along(bpy.context, paper, placing.MouseRay(Vector((9, 9, 1)), Vector((0, 0, -1)))) is None
    assert not handles(paper)
    assert not [thing for thing in bpy.data.objects if thing.type == "EMPTY"]


def test_every_name_is_its_own(placing, paper):
    for x in (-0.03, 0.0, 0.03):
        placing.place_along(bpy.context, paper, placing.MouseRay(Vector((x, 0, 1)), Vector((0, 0, -1))))
    assert [handle.name for handle in handles(paper)] == ["Handle 1", "Handle 2", "Handle 3"]
    assert bpy.ops.curvefold.remove_handle(index=1) == {"FINISHED"}
    placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0.01, 0.02, 1)), Vector((0, 0, -1))))
    assert [handle.name for handle in handles(paper)] == ["Handle 1", "Handle 3", "Handle 2"]
    assert paper.data.curvefold.active_handle == 2


def test_without_a_mouse_it_says_what_to_do_instead(paper):
    with pytest.raises(RuntimeError, match="placed with the mouse"):
        bpy.ops.curvefold.place_handle()


def test_it_begins_only_in_a_3d_view(placing):
    said = []
    operator = SimpleNamespace(refuse=said.append, what=placing.PlaceHandle.what)
    for area in (None, SimpleNamespace(type="OUTLINER")):
        placing.PlaceHandle.invoke(operator, SimpleNamespace(area=area), None)
    assert said == ["Handles are clicked in a 3D view"] * 2


class Window(SimpleNamespace):
    """As much of a window, and of its 3D view from above, as the operator asks for."""

    def __init__(self):
        calls = []
        side = SimpleNamespace(type="UI", x=150, y=0, width=50, height=100)
        view = SimpleNamespace(perspective_matrix=Matrix())
        main = SimpleNamespace(type="WINDOW", x=0, y=0, width=200, height=100, data=view)
        area = SimpleNamespace(type="VIEW_3D", regions=[main, side])
        super().__init__(
            calls=calls,
            screen=SimpleNamespace(areas=[SimpleNamespace(type="OUTLINER", regions=[]), area]),
            cursor_modal_restore=lambda: calls.append("restored"),
        )


@pytest.fixture
def clicking(extension, placing, paper, monkeypatch):
    """The operator in mid-run, and a function that gives it events; the view's mouse (x, y) is x, y in mm.

    The interface has the scale 0, so that nothing is near the mouse.
    """
    rays = extension("curvefold_addon.mouse_ray")
    cls = placing.PlaceHandle
    window = Window()
    context = SimpleNamespace(
        scene=bpy.context.scene,
        window=window,
        workspace=SimpleNamespace(status_text_set=window.calls.append),
        selected_objects=[],
        view_layer=bpy.context.view_layer,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=0.0)),
    )
    monkeypatch.setattr(
        rays.view3d_utils,
        "region_2d_to_origin_3d",
        lambda region, view, at: Vector((at[0] / 1e3, at[1] / 1e3, 1)),
    )
    monkeypatch.setattr(rays.view3d_utils, "region_2d_to_vector_3d", lambda *_: Vector((0, 0, -1)))
    operator = SimpleNamespace(_paper=paper.name, report=lambda kind, text: window.calls.append(text))
    operator.cancel = lambda c: cls.cancel(operator, c)
    operator.waiting_paper = lambda c: cls.waiting_paper(operator, c)

    def send(kind, x=0, y=0, value="PRESS"):
        return cls.modal(operator, context, SimpleNamespace(type=kind, value=value, mouse_x=x, mouse_y=y))

    return send, window.calls


def test_clicks_place_handles_one_after_another_and_each_can_be_undone(clicking, paper):
    send, _ = clicking
    name = paper.name
    bpy.ops.ed.undo_push(message="before")
    assert send("MOUSEMOVE") == {"PASS_THROUGH"}
    assert send("LEFTMOUSE", 20, 30) == {"RUNNING_MODAL"}
    assert send("LEFTMOUSE", 20, 30, "RELEASE") == {"PASS_THROUGH"}
    assert send("LEFTMOUSE", 40, 10) == {"RUNNING_MODAL"}
    assert [handle.at[:] for handle in handles(paper)] == [
        pytest.approx((0.02, 0.03), abs=1e-6),
        pytest.approx((0.04, 0.01), abs=1e-6),
    ]
    bpy.ops.ed.undo()
    assert len(handles(bpy.data.objects[name])) == 1
    bpy.ops.ed.undo()
    assert not handles(bpy.data.objects[name])


def test_a_click_beside_the_paper_and_one_on_the_sidebar(clicking, paper):
    send, said = clicking
    assert send("LEFTMOUSE", 90, 90) == {"RUNNING_MODAL"}
    assert said == ["There is no paper under the mouse"]
    assert send("LEFTMOUSE", 160, 30) == {"PASS_THROUGH"}, "the panel is the panel's"
    assert not handles(paper)


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE", "RET", "NUMPAD_ENTER"])
def test_keys_that_end_it(clicking, key):
    send, said = clicking
    assert send(key) == {"FINISHED"}
    assert said == ["restored", None]


def test_ends_when_the_paper_is_gone(clicking, paper):
    send, _ = clicking
    bpy.data.objects.remove(paper)
    assert send("MOUSEMOVE") == {"FINISHED"}


# --- from vertices --------------------------------------------------------------------------------------------


def test_selected_vertices_get_one_empty(folded_paper):
    paper = folded_paper
    before = positions(paper.data)
    places = select_vertices(paper, (-0.05, 0.05), (0.05, 0.05))
    assert bpy.ops.curvefold.add_handles() == {"FINISHED"}
    assert bpy.context.mode == "OBJECT"
    assert len(handles(paper)) == 2
    empty = handles(paper)[0].hook
    assert handles(paper)[1].hook == empty
    assert tuple(empty.location) == pytest.approx(tuple((places[0] + places[1]) / 2), abs=1e-6)
    assert sorted(tuple(handle.at) for handle in handles(paper)) == [
        pytest.approx((-0.05, 0.05), abs=1e-6),
        pytest.approx((0.05, 0.05), abs=1e-6),
    ]
    assert np.array_equal(positions(paper.data), before)
    assert bpy.context.active_object == empty


def test_or_one_each(folded_paper):
    select_vertices(folded_paper, (-0.05, 0.05), (0.05, 0.05))
    assert bpy.ops.curvefold.add_handles(together=False) == {"FINISHED"}
    assert len({handle.hook for handle in handles(folded_paper)}) == 2


@pytest.mark.parametrize("edit", [False, True])
def test_without_a_selection_it_says_so(paper, edit):
    if edit:
        select_vertices(paper)
    with pytest.raises(RuntimeError, match="Select vertices of the paper in Edit Mode first"):
        bpy.ops.curvefold.add_handles()


def test_pinned_vertices_stay(folded_paper, live):
    paper = folded_paper
    place = select_vertices(paper, (0.0, 0.05))[0]
    assert bpy.ops.curvefold.pin() == {"FINISHED"}
    handle = handles(paper)[0]
    assert (handle.hook, handle.pinned) == (None, True)
    assert tuple(handle.offset) == pytest.approx(tuple(place), abs=1e-6)
    paper.data.curvefold.fold = 65.0
    live.settle(paper.data)
    assert live.session(paper.data).place_of(tuple(handle.at)) == pytest.approx(tuple(place), abs=0.002)


def test_the_active_handle_is_pinned_where_it_is(placing, folded_paper, live):
    paper = folded_paper
    placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0.0, 0.02, 1)), Vector((0, 0, -1))))
    handle = handles(paper)[0]
    place = live.session(paper.data).place_of(tuple(handle.at))
    assert bpy.ops.curvefold.pin() == {"FINISHED"}
    assert (handle.hook, handle.pinned) == (None, True)
    assert tuple(handle.offset) == pytest.approx(place, abs=1e-5)
    assert tuple(handle.offset) == pytest.approx(live.session(paper.data).place_of(tuple(handle.at)), abs=1e-5)
    assert "Handle 1" not in bpy.data.objects, "its empty would be a handle that pulls nothing"
    assert bpy.context.active_object == paper


def test_an_object_of_ones_own_stays_when_its_handle_is_pinned(folded_paper):
    paper, mine = folded_paper, loose_empty((0.03, 0.04, 0.0))
    mine.select_set(True)
    bpy.context.view_layer.objects.active = paper
    bpy.ops.curvefold.hook_object()
    bpy.context.view_layer.objects.active = mine
    assert bpy.ops.curvefold.pin() == {"FINISHED"}
    assert bpy.data.objects["Mine"] == mine
    assert bpy.context.active_object == paper


# --- choosing -------------------------------------------------------------------------------------------------


@pytest.fixture
def two(placing, paper):
    """(settings, the empties of two handles); the second was placed last."""
    places = ((0.0, 0.03, 1), (0.0, -0.03, 1))
    empties = [
        placing.place_along(bpy.context, paper, placing.MouseRay(Vector(at), Vector((0, 0, -1)))) for at in places
    ]
    return paper.data.curvefold, empties


def test_the_list_follows_the_selection(two, paper):
    settings, (first, _) = two
    assert settings.chosen_handle == 1
    bpy.context.view_layer.objects.active = first
    assert settings.chosen_handle == 0
    bpy.context.view_layer.objects.active = paper
    assert settings.chosen_handle == 1, "the last one that was chosen in the list"
    bpy.context.view_layer.objects.active = None
    assert settings.chosen_handle == 1


def test_the_selection_follows_the_list(two, paper, live):
    settings, (first, _) = two
    live.tick(0.02)
    assert not live.is_at_work()
    settings.chosen_handle = 0
    assert (bpy.context.active_object, bpy.context.selected_objects) == (first, [first])
    assert settings.chosen_handle == 0
    settings.handles[1].hook = None
    settings.chosen_handle = 1
    assert bpy.context.active_object == paper, "nothing pulls a pin"
    first.hide_set(True)
    settings.chosen_handle = 0
    assert bpy.context.active_object == paper, "nor can be selected what is hidden"
    settings.chosen_handle = 7
    assert bpy.context.active_object == paper


def test_choosing_leaves_edit_mode_alone(two, paper):
    settings, _ = two
    select_vertices(paper)
    settings.chosen_handle = 0
    assert (settings.chosen_handle, bpy.context.active_object, bpy.context.mode) == (0, paper, "EDIT_MESH")


def test_several_handles_of_one_empty_can_each_be_chosen(paper):
    select_vertices(paper, (0.0, 0.03), (0.03, 0.03))
    bpy.ops.curvefold.add_handles()
    settings = paper.data.curvefold
    for index in (0, 1, 0):
        settings.chosen_handle = index
        assert settings.chosen_handle == index
        assert bpy.context.active_object == settings.handles[0].hook


def test_choosing_can_be_undone_with_what_it_selected(two):
    settings, _ = two
    name = settings.id_data.name
    bpy.ops.ed.undo_push(message="two handles")
    settings.chosen_handle = 0
    bpy.ops.ed.undo_push(message="chosen")
    bpy.ops.ed.undo()
    settings = bpy.data.meshes[name].curvefold
    assert (settings.chosen_handle, bpy.context.active_object.name) == (1, "Handle 2")
    bpy.ops.ed.redo()
    settings = bpy.data.meshes[name].curvefold
    assert (settings.chosen_handle, bpy.context.active_object.name) == (0, "Handle 1")


def test_the_handle_of_the_selected_empty_is_removed(two):
    settings, (first, _) = two
    bpy.context.view_layer.objects.active = first
    bpy.ops.curvefold.remove_handle()
    assert [handle.name for handle in settings.handles] == ["Handle 2"]


@pytest.mark.parametrize(
    ("edit", "sentence"), [(True, "Select vertices of the paper first"), (False, "in Edit Mode")]
)
def test_nothing_to_pin(paper, edit, sentence):
    if edit:
        select_vertices(paper)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.curvefold.pin()


# --- existing objects -----------------------------------------------------------------------------------------


def loose_empty(place):
    empty = bpy.data.objects.new("Mine", None)
    bpy.context.collection.objects.link(empty)
    empty.location = place
    bpy.context.view_layer.update()
    return empty


def test_selected_objects_are_hooked_to_the_nearest_points_and_nothing_jumps(folded_paper, live):
    paper = folded_paper
    before = positions(paper.data)
    place = live.session(paper.data).place_of((0.03, 0.04))
    first, second = loose_empty((*place[:2], place[2] + 0.002)), loose_empty((0, 0, -1))
    first.rotation_euler = (0.3, 0.4, 0.5)
    for thing in (first, second, paper):
        thing.select_set(True)
    bpy.context.view_layer.objects.active = paper
    assert bpy.ops.curvefold.hook_object() == {"FINISHED"}
    assert {handle.hook for handle in handles(paper)} == {first, second}
    mine = next(handle for handle in handles(paper) if handle.hook == first)
    assert mine.at[:] == pytest.approx((0.03, 0.04), abs=0.002)
    assert np.array_equal(positions(paper.data), before)
    with pytest.raises(RuntimeError, match="hooks of this paper already"):
        bpy.ops.curvefold.hook_object()


def test_hooking_needs_others_and_the_paper_last(paper):
    assert not bpy.ops.curvefold.hook_object.poll()
    empty = loose_empty((0, 0, 0))
    empty.select_set(True)
    assert bpy.ops.curvefold.hook_object.poll()
    bpy.context.view_layer.objects.active = empty
    assert not bpy.ops.curvefold.hook_object.poll()


def test_another_hook_or_none_keeps_the_point_where_it_is(placing, folded_paper, live):
    """As the panel's field does it."""
    paper = folded_paper
    placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0.0, 0.02, 1)), Vector((0, 0, -1))))
    before = positions(paper.data)
    handle = handles(paper)[0]
    handle.hook = loose_empty((0.3, 0.3, 0.3))
    live.settle(paper.data)
    assert np.array_equal(positions(paper.data), before)
    assert not handle.pinned
    handle.hook = None
    live.settle(paper.data)
    assert np.array_equal(positions(paper.data), before)
    assert handle.pinned


# --- removing -------------------------------------------------------------------------------------------------


def test_a_removed_handle_takes_its_empty_with_it(placing, paper):
    empty = placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0, 0, 1)), Vector((0, 0, -1))))
    name = empty.name
    assert bpy.ops.curvefold.remove_handle() == {"FINISHED"}
    assert not handles(paper)
    assert name not in bpy.data.objects
    assert bpy.context.active_object == paper, "the next can be removed at once"


def test_but_not_one_that_is_needed(placing, paper):
    select_vertices(paper, (-0.05, 0.05), (0.05, 0.05))
    bpy.ops.curvefold.add_handles()
    shared = handles(paper)[0].hook
    bpy.ops.curvefold.remove_handle(index=0)
    assert shared.name in bpy.data.objects, "another handle hangs on it"
    follower = loose_empty((0, 0, 0))
    follower.parent = shared
    bpy.context.view_layer.objects.active = paper
    bpy.ops.curvefold.remove_handle()
    assert shared.name in bpy.data.objects, "it has a child"


def test_nor_one_that_is_the_users(paper):
    empty = loose_empty((0, 0, 0))
    empty.select_set(True)
    bpy.ops.curvefold.hook_object()
    assert bpy.ops.curvefold.remove_handle() == {"FINISHED"}
    assert empty.name in bpy.data.objects


@pytest.mark.parametrize("index", [-1, 5])
def test_no_such_handle(paper, index):
    with pytest.raises(RuntimeError, match="no such handle"):
        bpy.ops.curvefold.remove_handle(index=index)


# --- flattening and settling ----------------------------------------------------------------------------------


def test_flatten_lays_paper_and_handles_flat(placing, folded_paper, live):
    paper = folded_paper
    ours = placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0.0, 0.04, 1)), Vector((0, 0, -1))))
    mine = loose_empty((0.02, -0.02, 0.1))
    mine.select_set(True)
    bpy.context.view_layer.objects.active = paper
    bpy.ops.curvefold.hook_object()
    select_vertices(paper, (0.05, 0.05))
    bpy.ops.curvefold.pin()
    assert bpy.ops.curvefold.flatten("EXEC_DEFAULT", True) == {"FINISHED"}
    mesh = paper.data
    assert mesh.curvefold.fold == 0.0
    assert not positions(mesh)[:, 2].any()
    assert tuple(ours.location) == pytest.approx((*handles(paper)[0].at, 0.0), abs=1e-7)
    assert tuple(mine.location) == pytest.approx((0.02, -0.02, 0.1)), "what is not ours is not moved"
    bpy.context.view_layer.update()
    while live.tick(0.02):
        pass
    assert not positions(mesh)[:, 2].any(), "and it stays"
    assert live.report(mesh).sentence == "Flat"
    ours.location.z += 0.01
    live.settle(mesh)
    assert positions(mesh)[:, 2].any(), "the handles are there as before"


def test_flatten_can_be_undone(folded_paper):
    name, before = folded_paper.name, positions(folded_paper.data)
    bpy.ops.ed.undo_push(message="folded")
    bpy.ops.curvefold.flatten("EXEC_DEFAULT", True)
    bpy.ops.ed.undo()
    assert np.array_equal(positions(bpy.data.objects[name].data), before)


def test_settle_waits_and_says_how_it_stands(paper, capfd):
    paper.data.curvefold.fold = 50.0
    assert bpy.ops.curvefold.settle() == {"FINISHED"}
    assert "Settled" in capfd.readouterr().out
    assert positions(paper.data)[:, 2].any()


def test_folded_anew_a_paper_opens_first_and_then_follows_its_handles(extension, placing, folded_paper, live):
    mesh = folded_paper.data
    mesh.curvefold.fold = 0.0
    empty = placing.place_along(
        bpy.context, folded_paper, placing.MouseRay(Vector((0.0, 0.04, 1)), Vector((0, 0, -1)))
    )
    empty.location.z = 0.01
    bpy.context.view_layer.update()
    live.settle(mesh)
    assert live.fold_anew(folded_paper)
    assert not positions(mesh)[:, 2].any()
    angles, found = [], live.session(mesh)
    while live.tick(0.02):
        angles.append(np.nanmedian(extension("solver").measure(found.net, found.positions).fold_angle))
    assert max(angles) > 55
    assert angles[-1] < 30, "it was opened wider than its handle asks"
    assert tuple(found.place_of(tuple(handles(folded_paper)[0].at))) == pytest.approx(
        tuple(empty.location), abs=1e-3
    )


def test_folding_anew_waits_without_a_window_and_can_be_undone(folded_paper, live):
    name, before = folded_paper.name, positions(folded_paper.data)
    bpy.ops.ed.undo_push(message="folded")
    assert bpy.ops.curvefold.fold_anew("EXEC_DEFAULT", True) == {"FINISHED"}
    assert live.report(folded_paper.data).state == "settled"
    assert not np.array_equal(positions(folded_paper.data), before)
    bpy.ops.ed.undo()
    assert np.array_equal(positions(bpy.data.objects[name].data), before)


def test_what_is_told_nothing_is_not_folded_anew(paper):
    with pytest.raises(RuntimeError, match="Nothing pulls at this paper"):
        bpy.ops.curvefold.fold_anew()
    assert not positions(paper.data)[:, 2].any()


OPERATORS = (
    "place_handle",
    "add_handles",
    "pin",
    "remove_handle",
    "flatten",
    "fold_anew",
    "settle",
    "bake",
    "free_bake",
)


@pytest.mark.parametrize("name", OPERATORS)
def test_all_need_a_paper(name):
    assert not getattr(bpy.ops.curvefold, name).poll()


@pytest.mark.parametrize("name", ["flatten", "fold_anew", "settle"])
def test_a_spoilt_paper_is_one_sentence(extension, paper, name):
    extension("curvefold_addon.live").forget()
    paper.data["curvefold_format"] = 99
    with pytest.raises(RuntimeError, match="newer version") as caught:
        getattr(bpy.ops.curvefold, name)()
    assert "Traceback" not in str(caught.value)


def test_a_handle_stands_for_its_paper(placing, paper, live):
    empty = placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0, 0, 1)), Vector((0, 0, -1))))
    assert bpy.context.active_object == empty
    assert live.active_paper(bpy.context) == paper
    assert bpy.ops.curvefold.settle() == {"FINISHED"}


def test_where_nothing_is_active_the_only_paper_is_meant(placing, paper, sheet, live):
    empty = placing.place_along(bpy.context, paper, placing.MouseRay(Vector((0, 0, 1)), Vector((0, 0, -1))))
    bpy.data.objects.remove(empty)  # as Delete does: now nothing is active
    assert bpy.context.active_object is None
    assert live.active_paper(bpy.context) == paper
    bpy.context.view_layer.objects.active = sheet
    bpy.ops.object.select_all(action="DESELECT")
    sheet.select_set(True)
    assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
    bpy.context.view_layer.objects.active = None
    assert live.active_paper(bpy.context) is None, "there are two"
