"""The photo studio: the paper lies on the ground, in the picture, lit."""

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view


@pytest.fixture
def studio(extension, folded):
    material = extension("curvefold_addon.paper_material").paper_material()
    paper = extension("curvefold_addon.bridge.mesh").add_paper(folded, bpy.context.scene.collection, material)
    scene = extension("curvefold_addon.scene")
    scene.set_up(paper, scene.PictureSettings(width=160, height=120, samples=4))
    bpy.context.view_layer.update()
    return paper


def test_paper_lies_on_the_ground(extension, studio):
    world = extension("curvefold_addon.bridge.mesh").world_positions(studio)
    assert world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    low = world[world[:, 2] < 1e-4]
    assert len(low) >= 2
    rotation = np.array(studio.matrix_world)[:3, :3]
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-6)
    assert np.linalg.det(rotation) == pytest.approx(1.0, abs=1e-6)


def test_paper_fills_the_picture(extension, studio):
    scene = bpy.context.scene
    world = extension("curvefold_addon.bridge.mesh").world_positions(studio)
    seen = np.array(
        [
            world_to_camera_view(scene, scene.camera, vertex.co @ studio.matrix_world.transposed())
            for vertex in studio.data.vertices
        ]
    )
    assert len(seen) == len(world)
    assert seen[:, :2].min() > 0.0
    assert seen[:, :2].max() < 1.0
    assert np.ptp(seen[:, :2], axis=0).max() > 0.8


def test_picture_shows_light_and_shade(extension, studio, tmp_path):
    path = tmp_path / "picture.png"
    extension("curvefold_addon.scene").render(str(path))
    image = bpy.data.images.load(str(path))
    assert tuple(image.size) == (160, 120)
    pixels = np.array(image.pixels[:]).reshape(120, 160, 4)[:, :, :3].mean(axis=2)
    assert np.ptp(np.percentile(pixels, [1, 99])) > 0.25
    assert pixels.max() > 0.75
    assert np.mean(pixels > 0.99) < 0.02, "blown out"


def test_tent_and_flat_sheet(extension):
    pose = extension("curvefold_addon.bridge.pose")
    flat = np.array([[x, y, 0.0] for x in range(5) for y in range(5)])
    assert [normal.tolist() for normal in pose.resting_normals(flat)] == [[0.0, 0.0, -1.0]]
    # A ridge along y: it stands on its feet, or lies on either wing.
    tent = np.array([[x, y, 1.0 - abs(x - 2) * 0.5] for x in range(5) for y in range(5)])
    normals = pose.resting_normals(tent)
    assert any(normal == pytest.approx([0.0, 0.0, -1.0], abs=1e-9) for normal in normals)
    # Never on its ridge.
    assert not any(normal @ [0.0, 0.0, 1.0] > 0.99 for normal in normals)


def test_material_is_made_once(extension):
    make = extension("curvefold_addon.paper_material").paper_material
    assert make() is make()
