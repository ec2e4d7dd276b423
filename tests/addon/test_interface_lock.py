"""Lock Interface is on as long as papers of a scene follow its frames, and is given back."""

import bpy
import pytest


@pytest.fixture
def scene():
    assert not bpy.context.scene.render.use_lock_interface
    return bpy.context.scene


@pytest.fixture
def folding(paper, scene):
    for frame, fold in ((1, 30.0), (6, 50.0)):
        paper.data.curvefold.fold = fold
        paper.data.keyframe_insert("curvefold.fold", frame=frame)
    bpy.context.view_layer.update()
    return paper


def is_locked(scene) -> bool:
    bpy.context.view_layer.update()
    return scene.render.use_lock_interface


def test_a_paper_that_nothing_animates_locks_nothing(paper, scene):
    paper.data.curvefold.fold = 50.0
    assert not is_locked(scene)


def test_keys_lock_it_and_it_is_given_back_without_them(folding, scene):
    assert is_locked(scene)
    folding.data.animation_data_clear()
    assert not is_locked(scene)
    assert "curvefold_locked" not in scene


@pytest.mark.parametrize("way", ["baked", "not live", "deleted"])
def test_it_is_given_back_when_the_paper_follows_no_longer(folding, scene, way):
    assert is_locked(scene)
    if way == "baked":
        scene.frame_end = 3
        assert bpy.ops.curvefold.bake() == {"FINISHED"}
    elif way == "not live":
        folding.data.curvefold.live = False
        folding.data.update_tag()
    else:
        bpy.data.objects.remove(folding)
    assert not is_locked(scene)


def test_a_user_who_had_it_on_keeps_it(paper, scene):
    scene.render.use_lock_interface = True
    paper.data.keyframe_insert("curvefold.fold", frame=1)
    assert is_locked(scene)
    paper.data.animation_data_clear()
    assert is_locked(scene)


def test_it_is_given_back_after_saving_and_opening_too(folding, scene, tmp_path):
    assert is_locked(scene)
    path = str(tmp_path / "film.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    assert is_locked(scene)
    bpy.data.objects["Paper"].data.animation_data_clear()
    assert not is_locked(scene)


def test_scenes_of_files_made_before_are_locked_when_they_are_opened(folding, extension, tmp_path):
    scene = bpy.data.scenes.new("Hidden")
    scene.collection.objects.link(folding)
    del bpy.context.scene["curvefold_locked"]
    for each in bpy.data.scenes:
        each.render.use_lock_interface = False
    path = str(tmp_path / "film.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert all(each.render.use_lock_interface for each in bpy.data.scenes)
