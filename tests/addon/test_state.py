"""What a .blend keeps of a fold."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def state(extension):
    return extension("curvefold_addon.bridge.state")


def test_bit_for_bit_through_a_file(extension, state, folded, tmp_path):
    paper = extension("curvefold_addon.bridge.mesh").add_paper(folded, bpy.context.scene.collection, None)
    state.store(paper.data, folded)
    name = paper.name
    path = str(tmp_path / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=path)

    stored = state.load(bpy.data.objects[name].data)
    assert np.array_equal(stored.positions, folded.positions)
    assert stored.description["resolution"] == 12
    assert stored.description["angle"] == 60.0
    assert np.array_equal(stored.pattern["boundary"], folded.pattern.boundary)
    assert np.array_equal(stored.pattern["creases"][0]["points"], folded.pattern.creases[0].points)
    assert stored.pattern["unit_mm"] == pytest.approx(folded.pattern.unit_mm)


def test_other_meshes_carry_none(state):
    mesh = bpy.data.meshes.new("plain")
    assert not state.is_stored(mesh)
    with pytest.raises(state.StateError, match="plain carries no fold"):
        state.load(mesh)


def test_a_newer_format_is_refused(extension, state, folded):
    mesh = extension("curvefold_addon.bridge.mesh").build_mesh(folded)
    state.store(mesh, folded)
    mesh["curvefold_format"] = state.FORMAT + 1
    with pytest.raises(state.StateError, match="newer version"):
        state.load(mesh)
