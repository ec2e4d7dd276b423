"""Keyframed papers: played, rendered and baked."""

import bpy
import numpy as np
import pytest


def shape(mesh: bpy.types.Mesh) -> bytes:
    return bytes(mesh["curvefold_positions"])


def evaluated(paper: bpy.types.Object) -> np.ndarray:
    seen = paper.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return np.array([vertex.co[:] for vertex in seen.vertices])


@pytest.fixture
def scene():
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 6
    scene.frame_set(1)
    return scene


@pytest.fixture
def folding(paper, live, scene):
    """A paper whose fold is keyframed from 30 % to 50 %."""
    settings = paper.data.curvefold
    settings.iterations_per_frame = 12
    for frame, fold in ((1, 30.0), (6, 50.0)):
        settings.fold = fold
        paper.data.keyframe_insert("curvefold.fold", frame=frame)
    return paper


@pytest.fixture
def dragged(extension, paper, live, scene):
    """A folded paper that three empties hold, one of them keyframed."""
    settings = paper.data.curvefold
    settings.iterations_per_frame = 10
    settings.fold = 50.0
    live.settle(paper.data)
    making = extension("curvefold_addon.handle_making")
    points = extension("curvefold_addon.bridge.surface_points")
    for at in ((0.0, -0.05), (0.0, 0.01), (0.0, 0.05)):
        point = points.SurfacePoint(at, live.session(paper.data).place_of(at))
        handle = making.add_handle(paper, point)
        empty = making.new_empty(paper, point.place, handle.name)
        making.hook_to(handle, paper, empty)
    settings.fold = 0.0
    for frame, lift in ((1, 0.0), (6, 0.006)):
        empty.location.z = point.place[2] + lift
        empty.keyframe_insert("location", frame=frame)
    return paper


def play(scene, paper) -> list[bytes]:
    shapes = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        shapes.append(shape(paper.data))
    return shapes


@pytest.mark.parametrize("kind", ["folding", "dragged"])
def test_playback_is_the_same_each_time_whatever_was_done_before(kind, request, scene, live):
    paper = request.getfixturevalue(kind)
    scene.frame_set(4)
    first = play(scene, paper)
    assert len(set(first)) == len(first), "it moves in every frame"
    scene.frame_set(5)
    live.settle(paper.data)
    assert play(scene, paper) == first
    live.forget()
    assert play(scene, paper) == first, "also by a new session"


def test_the_first_frame_rests_and_the_last_follows(folding, scene, live):
    mesh = folding.data
    scene.frame_set(3)
    scene.frame_set(1)
    assert live.report(mesh).fold_angle == pytest.approx(27.0, abs=1.0)
    play(scene, folding)
    assert live.session(mesh).inputs.angle == pytest.approx(45.0)
    assert live.report(mesh).fold_angle > 30.0


def test_a_jump_settles_when_nobody_can_watch(folding, scene, live):
    scene.frame_set(1)
    scene.frame_set(6)
    assert live.report(folding.data).fold_angle == pytest.approx(45.0, abs=1.0)
    assert live.session(folding.data).rest is not None


def test_iterations_per_frame_are_counted_not_timed(folding, scene, live):
    scene.frame_set(1)
    found = live.session(folding.data)
    assert found.rest is not None
    for frame in (2, 3, 4):
        scene.frame_set(frame)
        assert found.iterations == 12 * (frame - 1)


def test_frames_do_nothing_to_a_paper_that_nothing_animates(paper, live, scene):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    paper.data.curvefold.fold = 40.0
    live.tick(0.02)
    before = shape(paper.data)
    for frame in (3, 1, 2):
        scene.frame_set(frame)
    assert shape(paper.data) == before


def test_while_it_is_played_frames_count_and_not_the_clock(folding, scene, live, monkeypatch):
    scene.frame_set(1)
    scene.frame_set(2)
    before = shape(folding.data)
    monkeypatch.setattr(live, "is_playing", lambda: True)
    live.wake(folding.data)
    assert not live.tick(0.02)
    assert shape(folding.data) == before
    monkeypatch.undo()
    live.wake_all()
    live.tick(0.05)
    assert shape(folding.data) != before


def test_a_hook_that_rides_on_something_animated_counts(extension, dragged, scene):
    hooks = extension("curvefold_addon.bridge.hooks")
    hook = dragged.data.curvefold.handles[0].hook
    dragged.data.curvefold.handles[2].hook.animation_data_clear()
    assert not hooks.is_animated(dragged)
    carrier = bpy.data.objects.new("Carrier", None)
    carrier.keyframe_insert("location", frame=1)
    hook.parent = carrier
    assert hooks.is_animated(dragged)


def test_a_render_shows_the_paper_of_its_frame(folding, scene, tmp_path, live):
    """The evaluated shapes while Workbench renders are those of playing."""
    played = play(scene, folding)
    seen = []

    def look(scene, depsgraph=None):
        seen.append(shape(bpy.data.objects["Paper"].data))

    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = str(tmp_path / "frame")
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.app.handlers.render_post.append(look)
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.remove(look)
    assert len(list(tmp_path.glob("frame*.png"))) == 6
    assert seen == played


# --- baking ---------------------------------------------------------------------------------------------------


def shown_while_playing(scene, paper):
    shapes = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        shapes.append(evaluated(paper))
    return shapes


def test_a_bake_plays_the_same_without_a_solver(folding, scene, live, tmp_path):
    played = shown_while_playing(scene, folding)
    scene.frame_set(2)
    assert bpy.ops.curvefold.bake("EXEC_DEFAULT", True) == {"FINISHED"}
    assert scene.frame_current == 2
    mesh = folding.data
    assert not mesh.curvefold.live
    keys = mesh.shape_keys
    assert not keys.use_relative
    assert len(keys.key_blocks) == 6
    path = str(tmp_path / "baked.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    paper = bpy.data.objects["Paper"]
    again = shown_while_playing(bpy.context.scene, paper)
    for one, other in zip(again, played, strict=True):
        assert one == pytest.approx(other, abs=1e-7)
    assert live.session(paper.data) is None, "nothing was solved"
    # Between frames the shapes are blended.
    bpy.context.scene.frame_set(2, subframe=0.5)
    assert evaluated(paper) == pytest.approx((played[1] + played[2]) / 2, abs=1e-6)


def test_free_bake_gives_the_live_paper_back(folding, scene, live):
    bpy.ops.curvefold.bake()
    kept = shape(folding.data)
    scene.frame_set(1)
    assert bpy.ops.curvefold.free_bake("EXEC_DEFAULT", True) == {"FINISHED"}
    mesh = folding.data
    assert mesh.shape_keys is None
    assert mesh.curvefold.live
    assert shape(mesh) == kept
    found = live.session(mesh)
    shown = np.array([vertex.co[:] for vertex in mesh.vertices])
    assert shown == pytest.approx(found.net.render_map.apply(found.positions), abs=1e-7)
    first = play(scene, folding)
    assert len(set(first)) == 6


@pytest.mark.parametrize("operator", ["settle", "flatten", "fold_anew"])
def test_what_shape_keys_would_hide_is_not_done(folding, operator):
    mesh = folding.data
    bpy.ops.curvefold.bake()
    mesh.curvefold.resolution += 4
    frames = [np.array([point.co[:] for point in block.data]) for block in mesh.shape_keys.key_blocks]
    with pytest.raises(RuntimeError, match="is baked; free the bake"):
        getattr(bpy.ops.curvefold, operator)()
    assert len(mesh.vertices) == len(frames[0]), "the bake fits its mesh"
    bpy.ops.curvefold.free_bake()
    folding.shape_key_add(name="Mine")
    with pytest.raises(RuntimeError, match="has shape keys, which hide how it folds"):
        getattr(bpy.ops.curvefold, operator)()


def test_a_live_paper_with_shape_keys_of_its_own_waits_until_they_are_gone(folding, live):
    mesh = folding.data
    folding.shape_key_add(name="Mine")
    kept = shape(mesh)
    mesh.curvefold.fold = 80.0
    assert any(not live.tick(0.02) for _ in range(1000))
    assert shape(mesh) == kept
    folding.shape_key_clear()
    bpy.context.view_layer.update()
    assert any(not live.tick(0.02) for _ in range(3000))
    assert shape(mesh) != kept


def test_baking_says_why_it_cannot(folding):
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Leave Edit Mode"):
        bpy.ops.curvefold.bake()
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(RuntimeError, match="not baked"):
        bpy.ops.curvefold.free_bake()
    bpy.ops.curvefold.bake()
    with pytest.raises(RuntimeError, match="baked already"):
        bpy.ops.curvefold.bake()
    bpy.ops.curvefold.free_bake()
    folding.shape_key_add(name="Mine")
    with pytest.raises(RuntimeError, match="shape keys of its own"):
        bpy.ops.curvefold.bake()
    folding.shape_key_clear()
    folding.data.curvefold.live = False
    with pytest.raises(RuntimeError, match="not live"):
        bpy.ops.curvefold.bake()
