"""Papers that follow: ticks without an event loop, and what Blender does to datablocks in between."""

import gc
import sys
import tracemalloc
from threading import Event

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector

LOST = "Handle 3 is pulled by nothing any more: choose an object for it, or remove it"


def shape(mesh: bpy.types.Mesh) -> tuple[bytes, bytes]:
    """The exact shape and the shown one."""
    shown = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", shown)
    return bytes(mesh["curvefold_positions"]), shown.tobytes()


def tick_until_rest(live, transforming=False, most=3000, each=None) -> int:
    """Ticks as the following operator does; how many it took."""
    for count in range(1, most):
        more = live.tick(0.02, transforming)
        if each is not None:
            each()
        if not more:
            return count
    raise AssertionError("it never rests")


def add_handle(extension, live, paper, at):
    """A handle with an empty where a point of the flat sheet is now; ``at`` in parts of its half width."""
    making = extension("curvefold_addon.handle_making")
    points = extension("curvefold_addon.bridge.surface_points")
    at = (0.05 * at[0], 0.05 * at[1])
    point = points.SurfacePoint(at, live.make_session(paper).place_of(at))
    handle = making.add_handle(paper, point)
    empty = making.new_empty(paper, point.place, handle.name)
    making.hook_to(handle, paper, empty)
    return empty


@pytest.fixture
def held(extension, paper, live):
    """A folded paper that three handles hold at rest: (paper, the empty at its upper border)."""
    settings = paper.data.curvefold
    settings.fold = 50.0
    live.settle(paper.data)
    for at in ((0.0, -1.0), (0.0, 0.2), (0.0, 1.0)):
        dragged = add_handle(extension, live, paper, at)
    settings.fold = 0.0
    live.settle(paper.data)
    facts = live.report(paper.data)
    assert facts.state == "settled", facts.sentence
    assert facts.fold_angle > 10.0
    bpy.context.view_layer.update()
    tick_until_rest(live)
    bpy.ops.ed.undo_push(message="held")
    return paper, dragged


# --- following ------------------------------------------------------------------------------------------------


def test_a_moved_empty_wakes_its_paper_and_it_comes_to_rest(held, live):
    paper, empty = held
    assert not live.is_at_work()
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    assert live.is_at_work(), "the handler has noticed"
    before = shape(paper.data)
    tick_until_rest(live)
    assert shape(paper.data) != before
    assert not live.is_at_work()
    handle = live.session(paper.data)
    reached = handle.place_of(tuple(paper.data.curvefold.handles[2].at))
    assert reached == pytest.approx(tuple(empty.location), abs=0.0015)
    assert live.report(paper.data).state == "settled"


def test_the_session_shows_what_the_mesh_shows(held, live):
    paper, empty = held
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    versions = []
    found = live.session(paper.data)

    def compare():
        versions.append(found.version)
        shown = np.frombuffer(shape(paper.data)[1], dtype=np.float32).reshape(-1, 3)
        assert found.net.render_map.apply(found.positions) == pytest.approx(shown, abs=1e-7)
        assert np.frombuffer(shape(paper.data)[0]) == pytest.approx(found.positions.ravel(), abs=0)

    tick_until_rest(live, each=compare)
    assert versions == sorted(versions)
    assert versions[-1] > versions[0]


def test_what_does_not_matter_wakes_nobody(held, live):
    paper, _ = held
    other = bpy.data.objects.new("Other", None)
    bpy.context.collection.objects.link(other)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    before = shape(paper.data)
    other.location.x = 3.0
    bpy.context.view_layer.update()
    assert not live.is_at_work()
    assert shape(paper.data) == before


def test_moving_the_whole_paper_moves_no_vertex(held, live):
    paper, _ = held
    before = shape(paper.data)
    paper.matrix_world = Matrix.Translation((3, -2, 1)) @ Matrix.Rotation(1.0, 4, (1, 2, 3)) @ Matrix.Scale(7, 4)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(paper.data) == before


def test_a_hook_of_the_world_pulls_when_the_paper_moves(extension, held, live):
    paper, empty = held
    world = empty.matrix_world.copy()
    empty.parent = None
    empty.matrix_world = world
    bpy.context.view_layer.update()
    tick_until_rest(live)
    before = shape(paper.data)
    paper.location.z -= 0.003
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(paper.data) != before
    place = live.session(paper.data).place_of(tuple(paper.data.curvefold.handles[2].at))
    assert (paper.matrix_world @ Vector(place)).z == pytest.approx(empty.matrix_world.translation.z, abs=0.0015)


def test_an_empty_with_several_handles_moves_them_rigidly(extension, paper, live):
    making = extension("curvefold_addon.handle_making")
    points = extension("curvefold_addon.bridge.surface_points")
    hooks = extension("curvefold_addon.bridge.hooks")
    empty = making.new_empty(paper, (0.0, 0.05, 0.0), "Both")
    for x in (-0.04, 0.04):
        handle = making.add_handle(paper, points.nearest(paper.data, (x, 0.05, 0.0)))
        making.hook_to(handle, paper, empty)
    motion = Matrix.Translation((0, 0, 0.02)) @ Matrix.Rotation(0.5, 4, "Y") @ Matrix.Scale(0.9, 4)
    empty.matrix_basis = Matrix.Translation((0.0, 0.05, 0.0)) @ motion
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = live.make_session(paper)
    told = hooks.read(paper, bpy.context.scene, depsgraph, found.net.frame.unit, found.why_not_at, found.drawn)
    for handle in told.handles:
        start = Vector((handle.at[0], handle.at[1] - 0.05, 0.0))
        assert handle.target == pytest.approx(tuple(motion @ start + Vector((0, 0.05, 0))), abs=1e-6)


def test_a_hidden_hook_and_a_disabled_one_are_read_all_the_same(held, live):
    paper, empty = held
    before = shape(paper.data)
    empty.hide_set(True)
    paper.location.x = 5.0
    bpy.context.view_layer.update()
    tick_until_rest(live)
    empty.hide_viewport = True
    paper.location.x = 9.0
    bpy.context.view_layer.update()
    live.wake(paper.data)
    tick_until_rest(live)
    assert shape(paper.data) == before


def test_a_deleted_hook_is_said_and_pulls_no_more(held, live):
    paper, empty = held
    with bpy.context.temp_override(selected_objects=[empty], active_object=empty):
        bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert live.is_at_work(), "something is gone from the scene"
    tick_until_rest(live)
    facts = live.report(paper.data)
    assert (facts.state, facts.sentence) == ("trouble", LOST)


def test_a_hook_removed_from_the_file_is_not_a_pin(held, live):
    paper, empty = held
    before = np.frombuffer(shape(paper.data)[0]).reshape(-1, 3).copy()
    bpy.data.objects.remove(empty)
    assert paper.data.curvefold.handles[2].hook is None
    live.wake(paper.data)
    tick_until_rest(live)
    assert live.report(paper.data).sentence == LOST
    # Its target, (0, 0, 0) of a frame that is gone, does not tear the border to the middle.
    after = np.frombuffer(shape(paper.data)[0]).reshape(-1, 3)
    assert np.abs(after - before).max() < 0.02


def test_a_handle_off_the_sheet_and_a_doubled_one_are_said(held, live):
    paper, _ = held
    handles = paper.data.curvefold.handles
    handles[2].at = handles[0].at
    live.settle(paper.data)
    assert live.report(paper.data).sentence == "Handle 3 holds the same point as Handle 1"
    handles[2].at = (3.0, 0.0)
    live.settle(paper.data)
    assert live.report(paper.data).sentence.startswith("Handle 3: the point is off the sheet by")


def test_a_target_out_of_reach_is_said_in_the_units_of_the_scene(held, live):
    paper, empty = held
    bpy.context.scene.unit_settings.system = "METRIC"
    empty.location.z += 0.2
    live.settle(paper.data)
    facts = live.report(paper.data)
    assert facts.state == "trouble"
    assert "cm from its target: out of reach" in facts.sentence


def test_axes_strength_and_switch_of_a_handle_act(held, live):
    paper, empty = held
    handle = paper.data.curvefold.handles[2]
    empty.location.x += 0.02
    handle.axes = (False, True, True)
    live.settle(paper.data)
    place = live.session(paper.data).place_of(tuple(handle.at))
    assert abs(place[0]) < 0.004, "free along x"
    assert place[2] == pytest.approx(empty.location.z, abs=0.0015)
    handle.enabled = False
    assert len(live.session(paper.data).inputs.handles) == 3
    live.settle(paper.data)
    assert len(live.session(paper.data).inputs.handles) == 2
    handle.enabled, handle.strength = True, 4.0
    live.settle(paper.data)
    assert live.session(paper.data).inputs.handles[2].strength == 4.0


def test_a_paper_that_is_not_live_stays(held, live):
    paper, empty = held
    paper.data.curvefold.live = False
    before = shape(paper.data)
    empty.location.z += 0.01
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(paper.data) == before
    paper.data.curvefold.live = True
    tick_until_rest(live)
    assert shape(paper.data) != before


def test_a_paper_in_edit_mode_waits(held, live):
    paper, empty = held
    bpy.context.view_layer.objects.active = paper
    bpy.ops.object.mode_set(mode="EDIT")
    before = bytes(paper.data["curvefold_positions"])
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    assert not live.tick(0.02), "no ticks for nothing"
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    assert live.is_at_work()
    tick_until_rest(live)
    assert bytes(paper.data["curvefold_positions"]) != before


def test_the_fold_slider_drives_and_at_zero_leaves_the_paper_to_its_handles(held, live):
    paper, _ = held
    settings = paper.data.curvefold
    assert live.session(paper.data).inputs.angle is None
    settings.fold = 60.0
    tick_until_rest(live)
    assert live.session(paper.data).inputs.angle == pytest.approx(54.0)
    assert live.report(paper.data).state in ("settled", "trouble")
    for handle in settings.handles:
        handle.enabled = False
    settings.fold = 0.0
    tick_until_rest(live)
    assert live.session(paper.data).inputs.angle == 0.0
    assert live.report(paper.data).fold_angle < 3.0


def test_folding_is_said_while_it_folds(paper, live):
    paper.data.curvefold.fold = 50.0
    seen = set()
    tick_until_rest(live, each=lambda: seen.add(live.report(paper.data).state))
    assert "folding" in seen
    assert live.report(paper.data).state == "settled"


# --- the hand takes it back -----------------------------------------------------------------------------------


def test_a_cancelled_drag_gives_back_every_bit(held, live):
    paper, empty = held
    before, start = shape(paper.data), empty.location.copy()
    for k in range(12):
        empty.location.z = start.z + 0.0007 * (k + 1)
        bpy.context.view_layer.update()
        live.tick(0.02, True)
    assert shape(paper.data) != before
    # The hand holds still until the paper rests there, then takes it back.
    for _ in range(3000):
        live.tick(0.02, True)
        if live.session(paper.data).rest is not None:
            break
    assert live.is_at_work(), "it may yet be taken back"
    empty.location = start
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(paper.data) == before
    assert live.report(paper.data).state == "settled"


def test_a_cancelled_drag_waits_for_no_running_iteration(extension, held, live, monkeypatch):
    paper, empty = held
    before, start = shape(paper.data), empty.location.copy()
    bpy.ops.ed.undo_push(message="before the drag")
    model = extension("curvefold_addon.bridge.worker").FoldModel
    begun, goes_on, ended = Event(), Event(), Event()
    advance = model.advance

    def slow(*arguments):
        begun.set()
        assert goes_on.wait(30.0), "nobody waits for it"
        report = advance(*arguments)
        ended.set()
        return report

    empty.location.z += 0.005
    bpy.context.view_layer.update()
    live.tick(0.02, transforming=True)
    with monkeypatch.context() as patch:
        patch.setattr(model, "advance", slow)
        live.tick(0.0, transforming=True)
        assert begun.wait(30.0)
        empty.location = start
        bpy.context.view_layer.update()
        assert not live.tick(0.0)
        assert not ended.is_set()
        assert shape(paper.data) == before
        empty.location.z += 0.003
        bpy.context.view_layer.update()
        assert live.tick(0.0)
        goes_on.set()
        tick_until_rest(live)
    assert live.report(paper.data).state == "settled"
    reached = live.session(paper.data).place_of(tuple(paper.data.curvefold.handles[2].at))
    assert reached == pytest.approx(tuple(empty.location), abs=0.0015)


def test_passing_the_start_in_a_drag_is_no_cancelling(held, live):
    paper, empty = held
    before, start = shape(paper.data), empty.location.copy()
    empty.location.z += 0.01
    bpy.context.view_layer.update()
    for _ in range(3):
        live.tick(0.02, True)
    empty.location = start
    bpy.context.view_layer.update()
    live.tick(0.02, True)
    assert shape(paper.data) != before


def test_a_finished_drag_cannot_be_taken_back_by_the_next(held, live):
    paper, empty = held
    first = shape(paper.data)
    empty.location.z += 0.003
    bpy.context.view_layer.update()
    tick_until_rest(live)
    second, middle = shape(paper.data), empty.location.copy()
    empty.location.z += 0.003
    bpy.context.view_layer.update()
    live.tick(0.02, True)
    empty.location = middle
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(paper.data) == second
    assert second != first


def test_a_slider_taken_back_gives_back_every_bit(paper, live):
    settings = paper.data.curvefold
    settings.fold = 40.0
    tick_until_rest(live)
    before = shape(paper.data)
    settings.fold = 100.0
    while shape(paper.data) == before:
        live.tick(0.001)
    settings.fold = 40.0
    tick_until_rest(live)
    assert shape(paper.data) == before


# --- undo, files, copies --------------------------------------------------------------------------------------


def test_undo_and_redo_are_bit_exact(held, live):
    paper, empty = held
    name, hook = paper.name, empty.name
    shapes = [shape(paper.data)]
    for _ in range(2):
        bpy.data.objects[hook].location.z += 0.003
        bpy.context.view_layer.update()
        tick_until_rest(live)
        bpy.ops.ed.undo_push(message="drag")
        shapes.append(shape(bpy.data.objects[name].data))
    assert len(set(shapes)) == 3
    for step, expected in ((bpy.ops.ed.undo, 1), (bpy.ops.ed.undo, 0), (bpy.ops.ed.redo, 1), (bpy.ops.ed.redo, 2)):
        step()
        assert shape(bpy.data.objects[name].data) == shapes[expected]
        bpy.context.view_layer.update()
        tick_until_rest(live)
        assert shape(bpy.data.objects[name].data) == shapes[expected], "and rests there"


def test_an_undo_step_of_mid_motion_leads_to_what_was_seen(held, live):
    """Blender keeps an undo step when the hand lets go; the paper came to rest after that."""
    paper, empty = held
    name, hook = paper.name, empty.name
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    live.tick(0.0, True)
    live.tick(0.02, True)
    middle = shape(paper.data)
    bpy.ops.ed.undo_push(message="drag")
    tick_until_rest(live)
    seen = shape(paper.data)
    assert seen != middle
    bpy.data.objects[hook].location.z += 0.003
    bpy.context.view_layer.update()
    tick_until_rest(live)
    bpy.ops.ed.undo_push(message="another drag")
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(bpy.data.objects[name].data) == seen


def test_an_undo_step_from_before_the_motion_was_shown_leads_to_what_was_seen(held, live):
    """A slow computer shows nothing of a quick drag before the hand lets go."""
    paper, empty = held
    name = paper.name
    before = shape(paper.data)
    bpy.ops.ed.undo_push(message="before")
    empty.location.z += 0.004
    bpy.ops.ed.undo_push(message="drag")
    # On its way the paper passed somewhere else, so that going there again ends in other bits.
    way = empty.location.copy()
    empty.location.x += 0.005
    bpy.context.view_layer.update()
    for _ in range(4):
        live.tick(0.05, True)
    empty.location = way
    bpy.context.view_layer.update()
    tick_until_rest(live)
    seen = shape(paper.data)
    for step, expected in ((bpy.ops.ed.undo, before), (bpy.ops.ed.redo, seen), (bpy.ops.ed.undo, before)):
        step()
        bpy.context.view_layer.update()
        tick_until_rest(live)
        assert shape(bpy.data.objects[name].data) == expected


def test_undo_in_mid_motion_is_safe(held, live):
    paper, empty = held
    name, before = paper.name, shape(paper.data)
    empty.location.z += 0.006
    bpy.context.view_layer.update()
    for _ in range(4):
        live.tick(0.005)
    bpy.ops.ed.undo_push(message="drag")
    assert live.tick(0.0), "a job is running"
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    assert shape(bpy.data.objects[name].data) == before
    tick_until_rest(live)
    assert shape(bpy.data.objects[name].data) == before


def test_undo_of_something_else_moves_no_paper(held, live):
    paper, empty = held
    name = paper.name
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    live.tick(0.02)
    bpy.ops.ed.undo_push(message="drag")
    tick_until_rest(live)
    seen = shape(paper.data)
    bpy.context.scene.render.fps = 12
    bpy.ops.ed.undo_push(message="something else")
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(bpy.data.objects[name].data) == seen


def test_save_and_load_are_bit_exact_and_it_goes_on(held, live, tmp_path):
    paper, empty = held
    name, hook, before = paper.name, empty.name, shape(paper.data)
    path = str(tmp_path / "paper.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert live.is_at_work(), "it looks whether there is something to do"
    tick_until_rest(live)
    assert shape(bpy.data.objects[name].data) == before
    assert live.report(bpy.data.objects[name].data).state == "settled"
    bpy.data.objects[hook].location.z += 0.003
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(bpy.data.objects[name].data) != before


def test_a_file_saved_in_mid_motion_goes_on_when_it_is_opened(held, live, tmp_path):
    paper, empty = held
    name = paper.name
    empty.location.z += 0.006
    bpy.context.view_layer.update()
    live.tick(0.0)
    live.tick(0.02)
    middle = shape(paper.data)
    path = str(tmp_path / "paper.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert shape(bpy.data.objects[name].data) == middle
    tick_until_rest(live)
    assert shape(bpy.data.objects[name].data) != middle
    assert live.report(bpy.data.objects[name].data).state == "settled"


@pytest.mark.parametrize("in_motion", [True, False])
def test_enabled_again_it_goes_on_and_moves_nothing_that_rests(extension, held, live, in_motion):
    paper, empty = held
    if in_motion:
        empty.location.z += 0.006
        bpy.context.view_layer.update()
        live.tick(0.0)
        live.tick(0.02)
    before = shape(paper.data)
    addon = sys.modules[extension("solver").__name__.rpartition(".")[0]]
    addon.unregister()
    assert not live.is_at_work()
    addon.register()
    handlers = extension("curvefold_addon.handlers")
    assert bpy.app.timers.is_registered(handlers._enabled)
    assert handlers._enabled() is None, "once is enough"
    assert live.is_at_work()
    tick_until_rest(live)
    assert (shape(paper.data) != before) is in_motion
    assert live.report(paper.data).state == "settled"


def test_a_copy_is_a_paper_of_its_own(held, live):
    paper, _ = held
    before = shape(paper.data)
    copy = paper.copy()
    copy.data = paper.data.copy()
    bpy.context.collection.objects.link(copy)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(copy.data) == before
    copy.data.curvefold.fold = 70.0
    tick_until_rest(live)
    assert shape(copy.data) != before
    assert shape(paper.data) == before


def test_a_linked_duplicate_shows_the_same_paper(held, live):
    paper, empty = held
    twin = paper.copy()
    bpy.context.collection.objects.link(twin)
    twin.location.x = 1.0
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert twin.data == paper.data
    assert live.report(twin.data).state == "settled"
    bpy.data.objects.remove(paper)
    empty.parent = None
    bpy.context.view_layer.update()
    assert live.paper_of(twin.data) == twin


def test_deleting_a_paper_in_mid_motion(held, live):
    paper, empty = held
    empty.location.z += 0.004
    bpy.context.view_layer.update()
    live.tick(0.0)
    mesh = paper.data
    bpy.data.objects.remove(paper)
    tick_until_rest(live)
    bpy.data.meshes.remove(mesh)
    bpy.context.view_layer.update()
    tick_until_rest(live)


def test_append_is_bit_exact_and_needs_no_drawing(held, live, tmp_path):
    paper, _ = held
    name, before = paper.name, shape(paper.data)
    path = str(tmp_path / "paper.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.append(directory=path + "/Object/", filename=name)
    mesh = bpy.data.objects[name].data
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(mesh) == before
    mesh.curvefold.handles[2].hook = None
    for thing in list(bpy.data.objects):
        if thing.type == "CURVE":
            bpy.data.objects.remove(thing)
    mesh.curvefold.fold = 30.0
    tick_until_rest(live)
    assert shape(mesh) != before


def test_a_linked_paper_is_left_alone(held, live, tmp_path):
    paper, _ = held
    name, before = paper.name, shape(paper.data)
    path = str(tmp_path / "paper.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.link(directory=path + "/Object/", filename=name)
    mesh = bpy.data.objects[name].data
    assert mesh.library is not None
    live.wake(mesh)
    tick_until_rest(live)
    assert shape(mesh) == before


# --- the drawing changes --------------------------------------------------------------------------------------


def bend(crease, by):
    for point in crease.data.splines[0].bezier_points:
        point.co.y += by
        point.handle_left.y += by
        point.handle_right.y += by
    crease.data.update_tag()
    bpy.context.view_layer.update()


@pytest.fixture
def at_once(live, monkeypatch):
    """Drawings are folded anew without waiting for the hand to rest."""
    monkeypatch.setattr(live, "DRAWING_RESTS", 0.0)


def test_an_edited_drawing_is_folded_anew_and_keeps_its_shape(held, sheet, live, at_once):
    paper, _ = held
    before = live.session(paper.data)
    places = [before.place_of(tuple(handle.at)) for handle in paper.data.curvefold.handles]
    source = before.source
    bend(sheet.children[0], 0.003)
    assert live.is_at_work()
    tick_until_rest(live)
    after = live.session(paper.data)
    assert after.source != source
    assert [handle.name for handle in paper.data.curvefold.handles] == ["Handle 1", "Handle 2", "Handle 3"]
    for handle, place in zip(paper.data.curvefold.handles, places, strict=True):
        assert after.place_of(tuple(handle.at)) == pytest.approx(place, abs=0.0025)
    assert len(paper.data.vertices) == len(after.net.render_map.uv)
    facts = live.report(paper.data)
    assert facts.state == "settled", facts.sentence
    assert facts.fold_angle > 5.0


def test_a_flat_paper_stays_flat_when_its_drawing_changes(paper, sheet, live, at_once):
    bend(sheet.children[0], 0.003)
    tick_until_rest(live)
    assert np.frombuffer(shape(paper.data)[0]).reshape(-1, 3)[:, 2].any() == np.False_
    assert live.report(paper.data).sentence == "Flat"


def test_a_drawing_that_only_moves_or_is_renamed_moves_no_paper(held, sheet, live, at_once):
    paper, _ = held
    before = shape(paper.data)
    sheet.location.x += 1.0
    sheet.children[0].name = "Spine"
    bpy.context.view_layer.update()
    live.rebuild(paper.data)
    tick_until_rest(live)
    assert shape(paper.data) == before
    assert "Spine" in live.report(paper.data).creases[0].label


def test_another_side_in_the_drawing_flips_the_crease(paper, sheet, live, at_once):
    paper.data.curvefold.fold = 40.0
    tick_until_rest(live)
    found = live.report(paper.data).creases[0].found
    other = "M" if found == "V" else "V"
    sheet.children[0].curvefold.assignment = other
    live.rebuild(paper.data)
    tick_until_rest(live)
    assert live.report(paper.data).creases[0].found == other


def test_another_resolution_keeps_the_shape(held, live, at_once):
    paper, _ = held
    angle = live.report(paper.data).fold_angle
    before = len(paper.data.vertices)
    paper.data.curvefold.resolution = 18
    tick_until_rest(live)
    assert len(paper.data.vertices) > before
    assert live.report(paper.data).fold_angle == pytest.approx(angle, abs=4.0)
    paper.data.curvefold.resolution = 12
    live.settle(paper.data)
    assert len(paper.data.vertices) == before


def test_a_drawing_that_cannot_be_folded_is_said_and_the_paper_stays(held, sheet, live, at_once, cross_border):
    paper, _ = held
    before = shape(paper.data)
    cross_border(sheet)
    live.rebuild(paper.data)
    tick_until_rest(live)
    assert shape(paper.data) == before
    facts = live.report(paper.data)
    assert facts.state == "trouble"
    assert "crosses itself" in facts.sentence


def test_a_paper_whose_drawing_was_deleted_goes_on(held, sheet, live, at_once):
    paper, empty = held
    before = shape(paper.data)
    for thing in (*sheet.children, sheet):
        bpy.data.objects.remove(thing)
    live.rebuild(paper.data)
    tick_until_rest(live)
    assert shape(paper.data) == before
    empty.location.z += 0.003
    bpy.context.view_layer.update()
    tick_until_rest(live)
    assert shape(paper.data) != before


def test_a_drawing_in_the_hand_is_not_folded_yet(paper, sheet, live, at_once):
    vertices = live.session(paper.data).net
    bend(sheet.children[0], 0.003)
    for _ in range(5):
        assert live.tick(0.02, True)
    assert live.session(paper.data).net is vertices
    tick_until_rest(live)
    assert live.session(paper.data).net is not vertices


# --- stability ------------------------------------------------------------------------------------------------


def test_a_drag_there_and_back_has_no_kicks_no_flips_and_little_hysteresis(held, live):
    """Bounds in cells (about 8 mm): a tick moves no vertex by more than 1, no crease changes its side, and after
    the way back every vertex is within 0.35 of where it was."""
    paper, empty = held
    session = live.session(paper.data)
    cell = session.net.frame.unit
    start, before = empty.location.copy(), session.positions.copy()
    found = live.report(paper.data).creases[0].found
    last = before
    steps = [*range(1, 41), *range(39, -1, -1)]
    for step in steps:
        empty.location.z = start.z + 0.01 * step / 40
        empty.location.y = start.y - 0.008 * step / 40
        bpy.context.view_layer.update()
        iterations = session.iterations
        live.tick(0.01, True)
        jump = np.abs(session.positions - last).max() / cell
        assert jump < 1.0, f"{jump:.2f} cells in {session.iterations - iterations} iterations"
        last = session.positions
    live.tick(0.01, True)
    session.before = None  # what follows is the way back of a hand, not a cancelled drag
    tick_until_rest(live)
    assert live.report(paper.data).creases[0].found == found
    assert live.report(paper.data).creases[0].folded
    assert np.abs(session.positions - before).max() < 0.35 * cell


def test_a_thousand_ticks_leave_nothing_behind(held, live):
    _, empty = held
    start = empty.location.z

    def work(ticks):
        for k in range(ticks):
            empty.location.z = start + 0.002 * np.sin(0.1 * k)
            bpy.context.view_layer.update()
            live.tick(0.0)

    work(100)
    blocks = {name: len(getattr(bpy.data, name)) for name in ("objects", "meshes", "materials", "actions")}
    gc.collect()
    tracemalloc.start()
    first = tracemalloc.get_traced_memory()[0]
    work(1000)
    gc.collect()
    grown = tracemalloc.get_traced_memory()[0] - first
    tracemalloc.stop()
    assert {name: len(getattr(bpy.data, name)) for name in blocks} == blocks
    # A shape of this net takes 5 kB: were one kept each tick, there would be 5 MB.
    assert grown < 500_000


# --- nothing raises -------------------------------------------------------------------------------------------


def test_a_paper_whose_state_is_spoilt_is_said_and_stops(extension, held, live):
    paper, _ = held
    mesh = paper.data
    live.park()
    mesh["curvefold_positions"] = [1.0, 2.0]
    mesh["curvefold_pattern"] = "not a drawing"
    assert live.is_at_work()
    tick_until_rest(live)
    assert live.report(mesh) is None or live.report(mesh).state == "trouble"


def test_an_error_that_is_not_the_users_is_printed_once(held, live, monkeypatch, capsys):
    paper, empty = held

    def broken(*arguments):
        raise ZeroDivisionError("surprise")

    monkeypatch.setattr(live.hooks, "read", broken)
    for _ in range(3):
        empty.location.z += 0.001
        bpy.context.view_layer.update()
        assert not live.tick(0.02)
    assert capsys.readouterr().err.count("Traceback") == 1
    assert live.report(paper.data).state == "trouble"
    monkeypatch.undo()
    live.wake(paper.data)
    tick_until_rest(live)
    assert live.report(paper.data).state == "settled"


@pytest.mark.parametrize("name", ["depsgraph_changed", "frame_changed", "undone", "file_opened", "file_closes"])
def test_handlers_never_raise(extension, live, monkeypatch, capsys, name):
    handlers = extension("curvefold_addon.handlers")

    def broken(*arguments):
        raise ZeroDivisionError(name)

    for function in ("notice", "animated_papers", "park", "forget"):
        monkeypatch.setattr(live, function, broken)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for _ in range(2):
        getattr(handlers, name)(bpy.context.scene, depsgraph)
    assert capsys.readouterr().err.count("Traceback") == 1
