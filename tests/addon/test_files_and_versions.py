"""The extension switched off and on, files without it, and files of other versions of it: no paper is lost."""

import subprocess
import sys

import addon_utils
import bpy
import numpy as np
import pytest

#: Opens a file in a Blender that does not know the extension; shows, renders, and saves it again.
WITHOUT = """
import os, sys
import bpy
import numpy as np

source, shown, picture, saved = sys.argv[1:]
bpy.ops.wm.open_mainfile(filepath=source)
assert not hasattr(bpy.types.Mesh, "curvefold"), "the extension is there"
mesh = bpy.data.objects["Paper"].evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
mesh.attributes["position"].data.foreach_get("vector", values)
np.save(shown, values)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = 1
scene.render.film_transparent = True
scene.render.image_settings.color_mode = "RGBA"
scene.render.resolution_x = scene.render.resolution_y = 32
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
bpy.ops.wm.save_as_mainfile(filepath=saved)
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture
def addon(extension):
    return extension("solver").__package__.rpartition(".")[0]


@pytest.fixture
def folded_paper(paper, live):
    """Folded, and held by an empty. Its name: references die when files are opened."""
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    hook = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(hook)
    hook.location = (0.0, 0.05, 0.03)
    bpy.context.view_layer.update()
    paper.select_set(True)
    hook.select_set(True)
    bpy.context.view_layer.objects.active = paper
    assert bpy.ops.curvefold.hook_object() == {"FINISHED"}
    assert paper.name == "Paper"
    return paper.name


def kept(name: str) -> bytes:
    return bytes(bpy.data.objects[name].data["curvefold_positions"])


def shown(name: str) -> np.ndarray:
    mesh = bpy.data.objects[name].data
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", values)
    return values


def told(name: str) -> tuple:
    settings = bpy.data.objects[name].data.curvefold
    handles = [(entry.name, entry.hook.name, tuple(entry.at), tuple(entry.offset)) for entry in settings.handles]
    return settings.is_paper, settings.fold, settings.resolution, settings.sheet.name, handles


def tick_until_rest(live) -> None:
    assert any(not live.tick(0.05) for _ in range(1000)), "it never rests"


def follows(name: str, live) -> None:
    """The paper is as live as it was."""
    before = kept(name)
    bpy.data.objects["Hook"].location.z += 0.003
    bpy.context.view_layer.update()
    assert live.is_at_work()
    tick_until_rest(live)
    assert kept(name) != before
    assert live.report(bpy.data.objects[name].data).state == "settled"


# --- off and on -------------------------------------------------------------------------------------------------


def test_off_and_on_with_a_folded_paper_open(folded_paper, addon, live):
    before, seen, asked = kept(folded_paper), shown(folded_paper), told(folded_paper)
    addon_utils.disable(addon, default_set=True)
    bpy.data.objects["Hook"].location.x += 0.0
    bpy.context.view_layer.update()
    bpy.context.scene.frame_set(3)
    assert kept(folded_paper) == before
    assert np.array_equal(shown(folded_paper), seen)
    addon_utils.enable(addon, default_set=True)
    assert told(folded_paper) == asked
    assert kept(folded_paper) == before
    follows(folded_paper, live)


def test_off_in_mid_motion(folded_paper, addon, live):
    bpy.data.objects["Hook"].location.z += 0.01
    bpy.context.view_layer.update()
    assert live.tick(0.0), "a job is running"
    addon_utils.disable(addon, default_set=True)
    before = kept(folded_paper)
    addon_utils.enable(addon, default_set=True)
    assert kept(folded_paper) == before
    follows(folded_paper, live)


def test_off_while_another_file_is_opened(folded_paper, addon, live, tmp_path):
    before, asked = kept(folded_paper), told(folded_paper)
    path = str(tmp_path / "paper.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.disable(addon, default_set=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    addon_utils.enable(addon, default_set=True)
    assert (kept(folded_paper), told(folded_paper)) == (before, asked)
    follows(folded_paper, live)


# --- without the extension ----------------------------------------------------------------------------------------


def test_a_blender_without_the_extension_shows_renders_and_keeps_it(folded_paper, live, tmp_path):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    camera.location.z = 0.5
    bpy.context.scene.camera = camera
    before, seen, asked = kept(folded_paper), shown(folded_paper), told(folded_paper)
    source, values, picture, saved = (str(tmp_path / name) for name in ("a.blend", "a.npy", "a.png", "b.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=source)
    script = tmp_path / "without.py"
    script.write_text(WITHOUT)
    done = subprocess.run(
        [sys.executable, str(script), source, values, picture, saved],
        capture_output=True,
        text=True,
        timeout=120,
        env={"BLENDER_USER_RESOURCES": str(tmp_path / "user"), "PATH": "", "OPENBLAS_NUM_THREADS": "1"},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert np.array_equal(np.load(values), seen)
    image = bpy.data.images.load(picture)
    covered = np.array(image.pixels).reshape(-1, 4)[:, 3] > 0.5
    assert 0.05 < covered.mean() < 0.95, "the paper, and something beside it"

    bpy.ops.wm.open_mainfile(filepath=saved)
    assert (kept(folded_paper), told(folded_paper)) == (before, asked)
    assert np.array_equal(shown(folded_paper), seen)
    follows(folded_paper, live)


# --- other versions -----------------------------------------------------------------------------------------------


def test_the_version_of_the_format_is_kept(extension, folded_paper):
    state = extension("curvefold_addon.bridge.state")
    assert bpy.data.objects[folded_paper].data["curvefold_format"] == state.FORMAT


@pytest.mark.parametrize(("change", "age"), [(1, "a newer"), (-1, "an older")])
def test_a_file_of_another_version_is_answered_and_left_alone(
    extension, folded_paper, live, tmp_path, capfd, change, age
):
    state = extension("curvefold_addon.bridge.state")
    mesh = bpy.data.objects[folded_paper].data
    # Animated, so that frames look at it too.
    mesh.keyframe_insert("curvefold.fold", frame=1)
    before, seen = kept(folded_paper), shown(folded_paper)
    mesh["curvefold_format"] = state.FORMAT + change
    path = str(tmp_path / "other.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    mesh = bpy.data.objects[folded_paper].data
    sentence = f"Paper was folded by {age} version of Curvefold"
    tick_until_rest(live)
    assert (live.report(mesh).state, live.report(mesh).sentence) == ("trouble", sentence)
    for frame in (1, 2, 5):
        bpy.context.scene.frame_set(frame)
    mesh.curvefold.resolution = 20
    mesh.curvefold.handles[0].hook = None
    bpy.context.view_layer.update()
    tick_until_rest(live)
    bpy.context.view_layer.objects.active = bpy.data.objects[folded_paper]
    for operator in ("settle", "flatten", "fold_anew", "lock_sides", "pin", "bake"):
        mesh.curvefold.live = True
        with pytest.raises(RuntimeError, match=sentence):
            getattr(bpy.ops.curvefold, operator)()
    assert "Traceback" not in capfd.readouterr().err
    assert kept(folded_paper) == before
    assert np.array_equal(shown(folded_paper), seen)
    assert mesh["curvefold_format"] == state.FORMAT + change
    assert mesh.shape_keys is None

    # The version that made it goes on as if nothing had been.
    bpy.ops.wm.open_mainfile(filepath=path)
    bpy.data.objects[folded_paper].data["curvefold_format"] = state.FORMAT
    live.wake(bpy.data.objects[folded_paper].data)
    tick_until_rest(live)
    follows(folded_paper, live)
