"""What a .blend keeps of a fold."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def state(extension):
    return extension("curvefold_addon.bridge.state")


@pytest.fixture
def folded_paper(extension, folded):
    paper = extension("curvefold_addon.bridge.mesh").add_paper(folded, bpy.context.scene.collection, None)
    extension("curvefold_addon.bridge.papers").keep(paper, folded)
    return paper


def test_bit_for_bit_through_a_file(state, folded, folded_paper, tmp_path):
    name = folded_paper.name
    path = str(tmp_path / "kept.blend")
    before = state.load(folded_paper.data)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=path)

    stored = state.load(bpy.data.objects[name].data)
    assert np.array_equal(stored.positions, folded.positions * 0.001), "metres, from millimetres"
    assert stored.source == before.source
    assert stored.source.resolution == 12
    assert stored.source.scale == 0.001
    assert np.array_equal(stored.rest, before.rest)
    assert stored.rest[0] == pytest.approx(60.0)


def test_a_drawing_comes_back_to_the_last_bit(state, extension):
    solver = extension("solver")
    names = ("hairpin", "circle_in_square", "annulus")
    samples = extension("curvefold_addon.samples")
    for name in names:
        pattern = solver.read_pattern(samples.drawing(name))
        again = state.pattern_of(state.source_of(pattern, 20))
        assert np.array_equal(again.boundary, pattern.boundary)
        assert [np.array_equal(a, b) for a, b in zip(again.holes, pattern.holes, strict=True)] == [True] * len(
            pattern.holes
        )
        assert (again.name, again.unit_mm, again.notes) == (pattern.name, pattern.unit_mm, pattern.notes)
        for one, other in zip(again.creases, pattern.creases, strict=True):
            assert np.array_equal(one.points, other.points)
            assert (one.closed, one.assignment, one.name) == (other.closed, other.assignment, other.name)
            assert (one.beziers is None) == (other.beziers is None)
            assert one.beziers is None or np.array_equal(one.beziers, other.beziers)


def test_the_fold_of_the_command_line_is_a_live_paper_at_rest(folded_paper, folded, live):
    mesh = folded_paper.data
    settings = mesh.curvefold
    assert settings.is_paper
    assert settings.fold * np.degrees(settings.angle) / 100 == pytest.approx(60.0)
    before = bytes(mesh["curvefold_positions"])
    live.settle(mesh)
    assert bytes(mesh["curvefold_positions"]) == before, "it rests"
    assert live.report(mesh).fold_angle == pytest.approx(60.0, abs=1.0)
    # Nobody bound it to the red of its drawing, and nobody does now.
    assert [c.letter for c in live.session(mesh).drawn] == ["U"]
    settings.fold = 50.0
    live.settle(mesh)
    assert live.report(mesh).fold_angle == pytest.approx(30.0, abs=1.0)


def test_handles_of_the_command_line_become_pins(extension, drawing, live):
    solver = extension("solver")
    pattern = solver.read_pattern(drawing)
    handles = tuple(
        solver.Handle(at, (*at, z)) for at, z in (((50.0, 5.0), 20.0), ((50.0, 95.0), 20.0), ((50.0, 50.0), 0.0))
    )
    result = solver.fold(pattern, solver.FoldDescription(resolution=12, angle=None, handles=handles))
    paper = extension("curvefold_addon.bridge.mesh").add_paper(result, bpy.context.scene.collection, None)
    extension("curvefold_addon.bridge.papers").keep(paper, result)
    settings = paper.data.curvefold
    assert settings.fold == 0.0
    assert [(handle.hook, handle.pinned) for handle in settings.handles] == [(None, True)] * 3
    assert settings.handles[0].at[:] == pytest.approx((0.05, 0.005))
    assert settings.handles[0].offset[:] == pytest.approx((0.05, 0.005, 0.02))
    before = bytes(paper.data["curvefold_positions"])
    live.settle(paper.data)
    assert bytes(paper.data["curvefold_positions"]) == before


def test_arrays_of_another_length_are_kept_whole(state):
    """Blender itself would write a longer array into the memory of the shorter one."""
    mesh = bpy.data.meshes.new("mesh")
    for count in (2, 5000, 3):
        positions = np.arange(3.0 * count).reshape(-1, 3)
        state.store(mesh, state.Source("{}", 12), positions)
        state.store_rest(mesh, positions[0] if count == 2 else positions.ravel())
        stored = state.load(mesh)
        assert np.array_equal(stored.positions, positions)
        assert len(stored.rest) == (3 if count == 2 else 3 * count)


def test_other_meshes_carry_none(state):
    mesh = bpy.data.meshes.new("plain")
    assert not state.is_stored(mesh)
    with pytest.raises(state.StateError, match="plain carries no fold"):
        state.load(mesh)


@pytest.mark.parametrize(("change", "age"), [(1, "a newer"), (-1, "an older")])
def test_another_format_is_refused(state, folded_paper, change, age):
    mesh = folded_paper.data
    mesh["curvefold_format"] = state.FORMAT + change
    with pytest.raises(state.StateError, match=f"{age} version"):
        state.load(mesh)


def test_a_shape_of_another_net_is_refused(extension, folded_paper, live):
    mesh = folded_paper.data
    mesh["curvefold_resolution"] = 13
    with pytest.raises(extension("curvefold_addon.bridge.state").StateError, match="does not belong"):
        live.settle(mesh)
