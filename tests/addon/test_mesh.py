"""The folded sheet as a Blender mesh."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def paper(extension, folded):
    return extension("curvefold_addon.bridge.mesh").add_paper(folded, bpy.context.scene.collection, None)


def test_geometry_is_the_solvers(paper, folded):
    surface = folded.net.render_map
    mesh = paper.data
    expected = surface.apply(folded.positions) / 1000.0  # the drawing is in millimetres
    assert len(mesh.vertices) == len(expected)
    assert len(mesh.polygons) == len(surface.face_start) - 1
    assert np.array([v.co[:] for v in mesh.vertices]) == pytest.approx(expected, abs=1e-7)
    first = [int(v) for v in surface.face_vertices[: surface.face_start[1]]]
    assert list(mesh.polygons[0].vertices) == first
    assert not mesh.validate(verbose=True), "Blender had to repair the mesh"


def test_bounding_box_is_fresh(paper, folded):
    expected = folded.net.render_map.apply(folded.positions) / 1000.0
    corners = np.array([corner[:] for corner in paper.bound_box])
    assert corners.min(axis=0) == pytest.approx(expected.min(axis=0), abs=1e-6)
    assert corners.max(axis=0) == pytest.approx(expected.max(axis=0), abs=1e-6)


def test_uv_is_the_flat_sheet_in_metres(paper, folded):
    mesh = paper.data
    flat = np.array([loop.vector[:] for loop in mesh.uv_layers["flat"].uv])
    assert np.ptp(flat, axis=0) == pytest.approx([0.1, 0.1], abs=1e-6)
    area = 0.0
    for polygon in mesh.polygons:
        x, y = flat[list(polygon.loop_indices)].T
        area += 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    assert area == pytest.approx(0.01, rel=1e-5), "the faces cover the sheet once, counter-clockwise"


def test_creases_are_sharp_and_numbered(paper, folded):
    mesh = paper.data
    surface = folded.net.render_map
    wanted = {
        frozenset(map(int, edge)): int(c)
        for edge, c in zip(surface.crease_edges, surface.crease_edge_crease, strict=True)
    }
    assert wanted
    crease = mesh.attributes["crease"].data
    marked = mesh.attributes["crease_edge"].data
    sharp = mesh.attributes["sharp_edge"].data
    for edge in mesh.edges:
        number = wanted.get(frozenset(edge.vertices), -1)
        assert crease[edge.index].value == number
        assert marked[edge.index].value == (number >= 0)
        assert sharp[edge.index].value == (number >= 0)
    assert all(polygon.use_smooth for polygon in mesh.polygons)


def test_patches(paper, folded):
    values = [item.value for item in paper.data.attributes["patch"].data]
    assert values == [int(patch) for patch in folded.net.render_map.face_patch]
    assert set(values) == {0, 1}


def test_a_drawing_without_a_unit_is_in_millimetres(extension):
    mesh = extension("curvefold_addon.bridge.mesh")
    assert mesh.metres_per_unit(None) == 0.001
    assert mesh.metres_per_unit(25.4) == pytest.approx(0.0254)


def test_crease_edges_off_the_faces_are_refused(extension, folded):
    module = extension("curvefold_addon.bridge.mesh")
    mesh = module.build_mesh(folded)
    with pytest.raises(ValueError, match="1 crease edges"):
        module._mark_creases(mesh, np.array([[0, 0]]), np.array([0]))
