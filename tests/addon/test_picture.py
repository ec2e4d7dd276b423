"""A picture in one click: what is seen, what of the user's is kept, and films."""

import json
import struct

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector


@pytest.fixture
def folded_paper(paper, live):
    paper.data.curvefold.fold = 60.0
    live.settle(paper.data)
    return paper


@pytest.fixture
def things(folded_paper):
    """What Blender's default scene has, beside a folded paper."""
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    cube = bpy.context.active_object
    light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (7.0, -7.0, 5.0)
    for item in (light, camera):
        scene.collection.objects.link(item)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("World")
    scene.render.resolution_x, scene.render.resolution_y = 192, 108
    for item in bpy.context.selected_objects:
        item.select_set(False)
    folded_paper.select_set(True)
    bpy.context.view_layer.objects.active = folded_paper
    bpy.context.view_layer.update()
    return {"cube": cube, "light": light, "camera": camera, "world": scene.world}


def corners_seen():
    """(N,2) where the vertices of all papers are in the picture, 0 to 1."""
    scene = bpy.context.scene
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    seen = []
    for item in scene.objects:
        if item.type == "MESH" and item.data.curvefold.is_paper:
            shown = item.evaluated_get(depsgraph)
            seen += [
                world_to_camera_view(scene, scene.camera, item.matrix_world @ v.co) for v in shown.data.vertices
            ]
    return np.array(seen)[:, :2]


def inventory():
    return {
        name: sorted(item.name for item in getattr(bpy.data, name))
        for name in ("objects", "meshes", "materials", "worlds", "cameras", "lights", "collections", "actions")
    }


def state():
    scene = bpy.context.scene
    settings = [scene.render.engine, scene.cycles.samples, scene.view_settings.view_transform]
    shown = {item.name: (item.hide_render, [tuple(row) for row in item.matrix_world]) for item in scene.objects}
    return settings, shown, scene.camera, scene.world, scene.frame_current


@pytest.mark.parametrize("engine", ["CYCLES", "EEVEE"])
def test_the_picture_of_a_default_scene_shows_the_paper_large(things, extension, tmp_path, engine):
    paper = bpy.context.active_object
    place = paper.matrix_world.copy()
    assert bpy.ops.curvefold.set_up_picture(engine=engine, samples=4) == {"FINISHED"}
    seen = corners_seen()
    assert seen.min() > 0.03
    assert seen.max() < 0.97
    assert np.ptp(seen, axis=0).max() > 0.7
    assert paper.matrix_world == place, "the user's paper stays where it is"
    assert bpy.context.scene.render.engine in (
        (engine,) if engine == "CYCLES" else extension("curvefold_addon.scene").EEVEE
    )
    if engine == "EEVEE":
        return  # it needs a screen's driver, which not every machine that tests has
    path = tmp_path / "picture.png"
    extension("curvefold_addon.scene").render(str(path))
    image = bpy.data.images.load(str(path))
    pixels = np.array(image.pixels[:]).reshape(108, 192, 4)[:, :, :3].mean(axis=2)
    columns, rows = (seen * [191, 107]).astype(int).T
    assert np.median(pixels[rows, columns]) > 0.5, "paper, not the cube around it"
    assert np.mean(pixels > 0.99) < 0.02, "blown out"


def test_nothing_of_the_users_is_lost(things):
    before, there = state(), inventory()
    bpy.ops.curvefold.set_up_picture()
    assert all(set(there[name]) <= set(now) for name, now in inventory().items())
    assert things["cube"].hide_render
    assert things["light"].hide_render
    assert bpy.ops.curvefold.remove_picture() == {"FINISHED"}
    assert state() == before
    left = inventory()
    left["worlds"].remove("Studio")
    assert left == there
    assert not bpy.ops.curvefold.remove_picture.poll()


def test_it_comes_back_from_a_saved_file(things, tmp_path):
    bpy.ops.curvefold.set_up_picture()
    path = str(tmp_path / "picture.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    bpy.ops.curvefold.remove_picture()
    scene = bpy.context.scene
    assert (scene.camera.name, scene.world.name) == ("Camera", "World")
    assert not any(item.hide_render for item in scene.objects if item.type in ("MESH", "LIGHT"))


@pytest.mark.parametrize("again", [False, True], ids=["as it is", "set up again"])
def test_a_picture_of_the_command_line_can_be_removed(folded_paper, extension, again):
    scene = extension("curvefold_addon.scene")
    scene.set_up(folded_paper, scene.PictureSettings())
    if again:
        bpy.ops.curvefold.set_up_picture()
    assert bpy.ops.curvefold.remove_picture() == {"FINISHED"}
    assert {item.type for item in bpy.context.scene.objects} == {"MESH", "CURVE"}
    assert bpy.context.scene.camera is None
    assert not bpy.ops.curvefold.remove_picture.poll()


def test_twice_is_once(things):
    bpy.ops.curvefold.set_up_picture()
    there, first = inventory(), state()
    bpy.ops.curvefold.set_up_picture()
    assert inventory() == there
    assert state()[1].keys() == first[1].keys()
    assert np.array(bpy.context.scene.camera.matrix_world) == pytest.approx(np.array(first[1]["Camera.001"][1]))
    bpy.ops.curvefold.remove_picture()
    assert bpy.context.scene.camera == things["camera"]


def test_what_is_selected_or_hangs_on_the_paper_stays_in_the_picture(things, folded_paper):
    child = bpy.data.objects.new("Child", None)
    child.parent = folded_paper
    bpy.context.collection.objects.link(child)
    things["cube"].select_set(True)
    bpy.ops.curvefold.set_up_picture()
    assert (things["cube"].hide_render, child.hide_render, folded_paper.hide_render) == (False, False, False)
    assert things["light"].hide_render


def test_what_was_not_rendered_before_is_not_afterwards(things):
    things["cube"].hide_render = True
    bpy.ops.curvefold.set_up_picture()
    bpy.ops.curvefold.remove_picture()
    assert things["cube"].hide_render


def test_materials_of_the_users_stay(things, folded_paper):
    own = bpy.data.materials.new("Mine")
    folded_paper.data.materials.clear()
    folded_paper.data.materials.append(own)
    bpy.ops.curvefold.set_up_picture(thickness=0.001)
    assert [slot.material for slot in folded_paper.material_slots] == [own]


def test_paper_with_a_thickness_has_two_colours(things, folded_paper):
    bpy.ops.curvefold.set_up_picture(thickness=0.001)
    shown = folded_paper.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    count = len(folded_paper.data.polygons)
    assert len(shown.polygons) > 2 * count
    back = [polygon for polygon in shown.polygons if polygon.material_index == 1]
    assert len(back) == count
    assert [slot.material.name for slot in folded_paper.material_slots] == [
        "Curvefold Paper",
        "Curvefold Paper Back",
    ]
    bpy.ops.curvefold.set_up_picture(thickness=0.0)
    assert not folded_paper.modifiers


@pytest.fixture
def film(paper, live):
    """A paper that folds in eight frames, moved by a parent."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 8
    scene.frame_set(1)
    for frame, fold in ((1, 0.0), (8, 60.0)):
        paper.data.curvefold.fold = fold
        paper.data.keyframe_insert("curvefold.fold", frame=frame)
    for frame, x in ((1, 0.0), (8, 0.2)):
        paper.location.x = x
        paper.keyframe_insert("location", frame=frame)
    scene.frame_set(3)
    return paper


def test_all_frames_of_a_film_are_in_the_picture(film, live):
    scene = bpy.context.scene
    shape = bytes(film.data["curvefold_positions"])
    assert bpy.ops.curvefold.set_up_picture() == {"FINISHED"}
    assert scene.frame_current == 3
    assert bytes(film.data["curvefold_positions"]) == shape, "the paper is as it was"
    widest = []
    for frame in range(1, 9):
        scene.frame_set(frame)
        seen = corners_seen()
        assert seen.min() > 0.01
        assert seen.max() < 0.99
        widest.append(seen)
    assert np.ptp(np.concatenate(widest), axis=0).max() > 0.7


def test_turntable_goes_once_round_and_holds_the_paper(things, folded_paper):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 12
    scene.frame_set(1)
    assert bpy.ops.curvefold.animate_picture(kind="TURNTABLE") == {"FINISHED"}
    bpy.ops.curvefold.animate_picture(kind="TURNTABLE")
    middle = Vector(np.mean([folded_paper.matrix_world @ v.co for v in folded_paper.data.vertices], axis=0))
    bearings = []
    for frame in range(1, 14):
        scene.frame_set(frame)
        seen = corners_seen()
        assert seen.min() > 0.01
        assert seen.max() < 0.99
        x, y, _ = scene.camera.matrix_world.translation - middle
        bearings.append(np.arctan2(y, x))
    steps = np.degrees(np.diff(np.unwrap(bearings)))
    assert steps.sum() == pytest.approx(360.0, abs=0.1)
    assert steps == pytest.approx(30.0, abs=6.0)
    bpy.ops.curvefold.remove_picture()
    assert scene.camera == things["camera"]


def test_folding_film_begins_flat_and_ends_as_the_slider_was(folded_paper, live):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 11
    scene.frame_set(1)
    assert bpy.ops.curvefold.animate_picture(kind="FOLDING") == {"FINISHED"}
    folds = []
    for frame in (1, 5, 9, 11):
        scene.frame_set(frame)
        folds.append(folded_paper.data.curvefold.fold)
    assert folds[0] == 0.0
    assert 0.0 < folds[1] < 60.0
    assert folds[2:] == [60.0, 60.0]
    with pytest.raises(RuntimeError, match="animated already"):
        bpy.ops.curvefold.animate_picture(kind="FOLDING")


def test_gltf_keeps_the_colour_of_the_paper(folded_paper, extension, tmp_path):
    path = tmp_path / "paper.glb"
    bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLB", use_selection=True)
    content = path.read_bytes()
    length = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20 : 20 + length])
    (material,) = document["materials"]
    front = extension("curvefold_addon.paper_material").FRONT
    assert material["pbrMetallicRoughness"]["baseColorFactor"][:3] == pytest.approx(front[:3], abs=1e-3)
    assert material["doubleSided"] is True
    first = document["meshes"][0]["primitives"][0]
    assert "TEXCOORD_0" in first["attributes"]


def test_an_image_dropped_on_a_paper_fills_the_sheet(folded_paper, extension, tmp_path):
    """Red grows along x and green along y of the image: seen from above, so do they along the sheet."""
    scene = bpy.context.scene
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 64, 64
    image = bpy.data.images.new("Print", 64, 64, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    y, x = np.mgrid[0:64, 0:64] / 63.0
    image.pixels.foreach_set(np.stack([x, y, 0 * x, 1 + 0 * x], axis=-1).astype(np.float32).ravel())
    material = bpy.data.materials.new("Print")
    extension("curvefold_addon.node_tree").node_tree(material)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    texture, glow = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeEmission")
    texture.image = image
    links.new(texture.outputs["Color"], glow.inputs["Color"])
    links.new(glow.outputs["Emission"], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    folded_paper.data.materials.clear()
    folded_paper.data.materials.append(material)
    folded_paper.data.curvefold.fold = 0.0
    extension("curvefold_addon.live").flatten(folded_paper)
    camera = bpy.data.objects.new("Above", bpy.data.cameras.new("Above"))
    camera.data.type, camera.data.ortho_scale, camera.location.z = "ORTHO", 0.1, 1.0
    scene.collection.objects.link(camera)
    points = np.array([folded_paper.matrix_world @ v.co for v in folded_paper.data.vertices])
    camera.location.xy = ((points.min(axis=0) + points.max(axis=0)) / 2)[:2]
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 4, False
    scene.view_settings.view_transform = "Raw"
    path = tmp_path / "print.png"
    extension("curvefold_addon.scene").render(str(path))
    seen = np.array(bpy.data.images.load(str(path)).pixels[:]).reshape(64, 64, 4)
    assert seen[8:-8, 8:-8, 0] == pytest.approx(np.tile(x[0], (64, 1))[8:-8, 8:-8], abs=0.04)
    assert seen[8:-8, 8:-8, 1] == pytest.approx(np.tile(x[0], (64, 1)).T[8:-8, 8:-8], abs=0.04)
