"""Films with motion blur: what lies between two frames, and frames that do not mind it."""

import bpy
import numpy as np
import pytest

#: Frames of the film.
FRAMES = range(1, 7)


def kept(mesh: bpy.types.Mesh) -> np.ndarray:
    return np.frombuffer(mesh["curvefold_positions"], dtype=np.float64).reshape(-1, 3)


def shown(mesh: bpy.types.Mesh) -> np.ndarray:
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.reshape(-1, 3)


@pytest.fixture
def scene():
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
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
def made(extension, monkeypatch):
    """How many iterations were made at frames of films."""
    worker = extension("curvefold_addon.bridge.worker")
    advance, made = worker.Worker.advance, []

    def counted(self, inputs, iterations):
        step = advance(self, inputs, iterations)
        made.append(step.report.iterations)
        return step

    monkeypatch.setattr(worker.Worker, "advance", counted)
    return made


def play(scene, mesh, times) -> list[np.ndarray]:
    shapes = []
    for time in times:
        scene.frame_set(int(np.floor(time)), subframe=time - np.floor(time))
        if time == int(time):
            shapes.append(kept(mesh))
    return shapes


def test_frames_and_iterations_are_the_same_with_motion_blur(folding, scene, live, made):
    mesh = folding.data
    plain = play(scene, mesh, FRAMES)
    first = sum(made)
    live.forget()
    made.clear()
    # As Cycles looks at a frame: the frame itself, both ends of its shutter, and the frame again.
    looks = [time for frame in FRAMES for time in (frame, frame - 0.25, frame + 0.25, frame)]
    blurred = play(scene, mesh, looks)
    for k, shape in enumerate(blurred):
        assert np.abs(shape - plain[k // 2]).max() <= 1e-12
    assert sum(made) == first


def test_between_two_frames_the_paper_is_between_their_shapes(folding, scene):
    mesh = folding.data
    shapes = []
    for frame in FRAMES:
        scene.frame_set(frame)
        shapes.append(shown(mesh))
    scene.frame_set(1)
    scene.frame_set(2)
    for time in (1.75, 2.25, 2.5):
        scene.frame_set(int(time), subframe=time % 1.0)
        low, part = int(time) - 1, time % 1.0
        wanted = (1.0 - part) * shapes[low] + part * shapes[low + 1]
        assert np.abs(shown(mesh) - wanted).max() <= 1e-7
    # The film begins with its first frame and ends with its last.
    for frame in FRAMES:
        scene.frame_set(frame)
    scene.frame_set(6, subframe=0.25)
    assert np.array_equal(shown(mesh), shapes[5])
    scene.frame_set(1)
    scene.frame_set(0, subframe=0.75)
    assert np.array_equal(shown(mesh), shapes[0])


def test_a_time_that_is_jumped_to_lies_between_its_frames(folding, scene):
    mesh = folding.data
    scene.frame_set(4, subframe=0.5)
    assert scene.frame_float == 4.5
    between = shown(mesh)
    scene.frame_set(4)
    one = shown(mesh)
    scene.frame_set(5)
    assert not np.array_equal(one, shown(mesh))
    assert np.abs(between - (one + shown(mesh)) / 2).max() <= 1e-7


def test_a_hand_goes_on_from_the_frame_and_not_from_what_was_seen_ahead(folding, scene, live):
    mesh = folding.data
    scene.frame_set(1)
    scene.frame_set(2)
    before = kept(mesh)
    scene.frame_set(2, subframe=0.25)
    assert np.array_equal(kept(mesh), before), "what is kept is the frame"
    found = live.session(mesh)
    assert found.ahead is not None
    folding.data.animation_data_clear()
    mesh.curvefold.fold = 32.0
    live.settle(mesh)
    assert found.ahead is None
    assert found.rest is not None
    assert np.array_equal(kept(mesh), found.positions)
    assert np.array_equal(shown(mesh), found.net.render_map.apply(found.positions).astype(np.float32))


@pytest.mark.parametrize(("shutter", "position"), [(0.5, "CENTER"), (1.0, "START"), (2.0, "CENTER")])
def test_cycles_renders_the_same_frames_with_motion_blur(folding, scene, tmp_path, made, shutter, position):
    mesh = folding.data
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.filepath = str(tmp_path / "frame")
    scene.render.motion_blur_shutter = shutter
    scene.render.motion_blur_position = position
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    seen, looks = [], set()

    def rendered(*_):
        seen.append(shown(bpy.data.objects["Paper"].data))

    def looked(scene, depsgraph):
        looks.add(scene.frame_float)

    films = []
    bpy.app.handlers.render_post.append(rendered)
    bpy.app.handlers.frame_change_post.append(looked)
    try:
        for blur in (False, True):
            scene.render.use_motion_blur = blur
            scene.frame_set(1)
            seen.clear()
            made.clear()
            bpy.ops.render.render(animation=True)
            films.append((list(seen), sum(made)))
    finally:
        bpy.app.handlers.render_post.remove(rendered)
        bpy.app.handlers.frame_change_post.remove(looked)
    (plain, iterations), (blurred, with_blur) = films
    assert len(looks) > len(FRAMES), "the shutter was open"
    assert len(plain) == len(blurred) == len(FRAMES)
    for one, other in zip(plain, blurred, strict=True):
        assert np.array_equal(one, other)
    assert len({shape.tobytes() for shape in plain}) == len(FRAMES)
    assert iterations <= with_blur <= iterations + 12, "one frame more, at most, where the last shutter ends"
    assert mesh == folding.data
