"""Papers in scenes that no window shows: whoever evaluates their scene moves them."""

import bpy
import numpy as np
import pytest


def shape(mesh: bpy.types.Mesh) -> bytes:
    return bytes(mesh["curvefold_positions"])


@pytest.fixture
def hidden(paper):
    """A paper whose fold is keyframed from 30 % to 50 %, in a scene that is not the present one."""
    mesh = paper.data
    mesh.curvefold.iterations_per_frame = 12
    for frame, fold in ((1, 30.0), (6, 50.0)):
        mesh.curvefold.fold = fold
        mesh.keyframe_insert("curvefold.fold", frame=frame)
    scene = bpy.data.scenes.new("Hidden")
    for item in list(bpy.context.scene.objects):
        for collection in list(item.users_collection):
            collection.objects.unlink(item)
        scene.collection.objects.link(item)
    scene.frame_start, scene.frame_end = 1, 6
    assert paper.name not in bpy.context.scene.objects
    return scene


def play(scene, mesh) -> list[bytes]:
    shapes = []
    for frame in range(1, 7):
        scene.frame_set(frame)
        shapes.append(shape(mesh))
    return shapes


def test_frames_of_a_scene_that_is_not_shown_move_its_papers(hidden, live):
    mesh = bpy.data.objects["Paper"].data
    frame = bpy.context.scene.frame_current
    films = [play(hidden, mesh) for _ in range(2)]
    assert len(set(films[0])) == 6, "it moves in every frame"
    assert films[0] == films[1]
    assert bpy.context.scene.frame_current == frame
    assert live.session(mesh).inputs.angle == pytest.approx(45.0)


def test_frames_of_the_shown_scene_leave_papers_of_others_alone(hidden):
    mesh = bpy.data.objects["Paper"].data
    hidden.frame_set(2)
    before = shape(mesh)
    for frame in (3, 4):
        bpy.context.scene.frame_set(frame)
    assert shape(mesh) == before


def test_a_scene_that_is_not_shown_renders_its_papers(hidden, tmp_path):
    mesh = bpy.data.objects["Paper"].data
    played = play(hidden, mesh)
    hidden.render.engine = "BLENDER_WORKBENCH"
    hidden.render.resolution_x = hidden.render.resolution_y = 16
    hidden.render.filepath = str(tmp_path / "frame")
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    hidden.collection.objects.link(camera)
    hidden.camera = camera
    seen = []

    def rendered(*_):
        seen.append(shape(bpy.data.objects["Paper"].data))

    bpy.app.handlers.render_post.append(rendered)
    try:
        bpy.ops.render.render(animation=True, scene=hidden.name)
    finally:
        bpy.app.handlers.render_post.remove(rendered)
    assert seen == played
    assert len(set(seen)) == 6


def test_scenes_have_films_of_their_own(hidden, paper, live):
    """One paper in two scenes with ends of their own: each scene begins with its own first frame."""
    other = bpy.data.scenes.new("Other")
    for item in hidden.objects:
        other.collection.objects.link(item)
    other.frame_start, other.frame_end = 4, 6
    first = play(hidden, paper.data)
    other.frame_set(4)
    other.frame_set(5)
    short = shape(paper.data)
    assert short != first[4], "it began at frame 4"
    assert play(hidden, paper.data) == first


def test_a_paper_of_another_scene_settles_as_its_scene_says(hidden, live):
    mesh = bpy.data.objects["Paper"].data
    hidden.frame_set(6)
    mesh.animation_data_clear()
    mesh.curvefold.fold = 40.0
    live.settle(mesh)
    assert live.session(mesh).inputs.angle == pytest.approx(36.0)
    assert live.session(mesh).rest is not None
    assert np.isfinite(live.session(mesh).positions).all()


def test_a_change_in_another_scene_wakes_its_papers(hidden, live):
    mesh = bpy.data.objects["Paper"].data
    hidden.view_layers[0].update()
    while live.tick(0.02):
        pass
    assert not live.is_at_work()
    bpy.data.objects["Paper"].location.x += 1.0
    hidden.view_layers[0].update()
    assert live.is_at_work()
    assert mesh.session_uid in live._awake
