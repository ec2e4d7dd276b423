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


def test_print_is_the_box_of_the_sheet(paper):
    maps = paper.data.uv_layers
    flat, printed = (np.array([loop.vector[:] for loop in maps[name].uv]) for name in ("flat", "print"))
    assert (printed.min(axis=0), printed.max(axis=0)) == (pytest.approx([0, 0]), pytest.approx([1, 1]))
    assert printed == pytest.approx(flat / 0.1, abs=1e-5), "the picture's lower left corner is the sheet's"


def test_images_are_put_on_by_the_print_map(paper):
    maps = paper.data.uv_layers
    assert maps.active.name == "print"
    assert [layer.name for layer in maps if layer.active_render] == ["print"]


def test_creases_are_sharp_and_numbered(paper, folded):
    mesh = paper.data
    surface = folded.net.render_map
    wanted = {
        frozenset(map(int, edge)): int(c)
        for edge, c in zip(surface.crease_edges, surface.crease_edge_crease, strict=True)
    }
    assert wanted
    border = borders(mesh)
    assert border
    for edge in mesh.edges:
        number = wanted.get(frozenset(edge.vertices), -1)
        kept = number >= 0 or edge.index in border
        assert mesh.attributes["crease"].data[edge.index].value == number
        assert mesh.attributes["on_crease"].data[edge.index].value == (number >= 0)
        assert mesh.attributes["crease_edge"].data[edge.index].value == float(kept)
        assert mesh.attributes["sharp_edge"].data[edge.index].value == kept
    assert all(polygon.use_smooth for polygon in mesh.polygons)


def borders(mesh):
    """Edges with one face."""
    count = np.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))
    return set(np.flatnonzero(count == 1).tolist())


def test_subdivision_keeps_creases_border_and_corners(paper):
    mesh = paper.data
    modifier = paper.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2

    def moved():
        """How far each vertex is moved, metres; the first of the fine ones are the coarse ones."""
        shown = paper.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        before = np.array([v.co[:] for v in mesh.vertices])
        return np.linalg.norm(np.array([v.co[:] for v in shown.vertices])[: len(before)] - before, axis=1)

    kept = {v for e in mesh.edges if mesh.attributes["crease_edge"].data[e.index].value for v in e.vertices}
    inside = [v for v in range(len(mesh.vertices)) if v in kept]
    flat = {loop.vertex_index: mesh.uv_layers["flat"].uv[loop.index].vector for loop in mesh.loops}
    corners = [v for v, (x, y) in flat.items() if {round(x, 6), round(y, 6)} <= {0.0, 0.1}]
    assert len(corners) == 4
    with_them = moved()
    assert with_them[corners].max() < 1e-6
    assert with_them[inside].max() < 4e-4
    for name in ("crease_edge", "crease_vert"):
        mesh.attributes.remove(mesh.attributes[name])
    mesh.update()
    without = moved()
    assert without[inside].max() > 3 * with_them[inside].max()
    assert without[corners].min() > 5e-4


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
        module.edges_of(mesh, np.array([[0, 0]]))
