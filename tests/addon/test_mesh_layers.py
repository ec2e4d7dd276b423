"""What users have put on a paper's mesh, when the mesh is made anew."""

import bpy
import numpy as np
import pytest


def read(layer, name, width, kind=np.float32):
    flat = np.empty(width * len(layer), dtype=kind)
    layer.foreach_get(name, flat)
    return flat.reshape(-1, width)


def flat_of(mesh):
    """(corners (L,2), vertex of each corner, face of each corner)."""
    vertices = read(mesh.loops, "vertex_index", 1, np.int32).ravel()
    sizes = read(mesh.polygons, "loop_total", 1, np.int32).ravel()
    return read(mesh.uv_layers["flat"].uv, "vector", 2), vertices, np.repeat(np.arange(len(sizes)), sizes)


def patches(mesh):
    return read(mesh.attributes["patch"].data, "value", 1, np.int32).ravel()


def weights_of(paper, index):
    values = np.zeros(len(paper.data.vertices))
    for k, vertex in enumerate(paper.data.vertices):
        for element in vertex.groups:
            if element.group == index:
                values[k] = element.weight
    return values


def weighted(paper, index):
    """Area of a group, each part as much as its weight, and its middle in space."""
    mesh, weights = paper.data, weights_of(paper, index)
    mesh.calc_loop_triangles()
    triangles = read(mesh.loop_triangles, "vertices", 3, np.int32)
    points = read(mesh.attributes["position"].data, "vector", 3).astype(float)[triangles]
    areas = 0.5 * np.linalg.norm(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1)
    parts = areas * weights[triangles].mean(axis=1)
    return parts.sum(), parts @ points.mean(axis=1) / parts.sum()


@pytest.fixture
def folded_paper(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    return paper


@pytest.fixture
def marked(folded_paper):
    """A folded paper with everything on it that can be carried over; all of it are functions of the flat sheet."""
    mesh = folded_paper.data
    corners, vertices, faces = flat_of(mesh)
    points = np.zeros((len(mesh.vertices), 2))
    points[vertices] = corners
    ramp = folded_paper.vertex_groups.new(name="Ramp")
    for k, (x, _) in enumerate(points):
        if x > -0.02:
            ramp.add([k], min(1.0, (x + 0.02) / 0.04), "REPLACE")
    ramp.lock_weight = True
    whole = folded_paper.vertex_groups.new(name="Whole")
    whole.add(list(range(len(points))), 1.0, "REPLACE")
    folded_paper.vertex_groups.active_index = 0

    seamed = mesh.uv_layers.new(name="Seamed")
    seamed.uv.foreach_set("vector", seamed_uv(corners, patches(mesh)[faces]).ravel())
    mesh.uv_layers.active = seamed
    seamed.active_render = True
    color = mesh.attributes.new("Paint", "FLOAT_COLOR", "POINT")
    color.data.foreach_set("color", paint(points).ravel())
    mesh.attributes.new("Number", "INT", "FACE").data.foreach_set("value", 7 - patches(mesh))
    mesh.materials.append(bpy.data.materials.new("Second"))
    mesh.polygons.foreach_set("material_index", patches(mesh))
    mesh["note"] = "mine"
    return folded_paper


def seamed_uv(corners, patch):
    """Torn along the crease: one part lies elsewhere, turned."""
    return np.where(patch[:, None] == 0, 3.0 * corners, 10.0 - corners[:, ::-1]).astype(np.float32)


def paint(points):
    return np.column_stack([5.0 * points + 0.5, np.full(len(points), 0.25), np.ones(len(points))]).astype(
        np.float32
    )


def check(paper):
    mesh = paper.data
    corners, vertices, faces = flat_of(mesh)
    patch = patches(mesh)
    assert read(mesh.uv_layers["Seamed"].uv, "vector", 2) == pytest.approx(
        seamed_uv(corners, patch[faces]), abs=1e-5
    )
    colors = read(mesh.attributes["Paint"].data, "color", 4)
    assert colors[vertices] == pytest.approx(paint(corners), abs=1e-5)
    assert np.array_equal(read(mesh.attributes["Number"].data, "value", 1, np.int32).ravel(), 7 - patch)
    assert np.array_equal(read(mesh.polygons, "material_index", 1, np.int32).ravel(), patch)
    assert [material.name for material in mesh.materials] == ["Curvefold Paper", "Second"]
    assert (mesh.uv_layers.active.name, mesh.uv_layers["Seamed"].active_render) == ("Seamed", True)
    assert mesh.attributes.active_color_name == "Paint"
    assert [(group.name, group.lock_weight) for group in paper.vertex_groups] == [("Ramp", True), ("Whole", False)]
    assert paper.vertex_groups.active_index == 0
    assert (weights_of(paper, 1) == 1.0).all()
    assert mesh["note"] == "mine"


def test_another_resolution_carries_everything_over(marked, live):
    area, middle = weighted(marked, 0)
    before = len(marked.data.vertices)
    marked.data.curvefold.resolution = 19
    live.settle(marked.data)
    assert len(marked.data.vertices) > 2 * before
    check(marked)
    after, there = weighted(marked, 0)
    assert after == pytest.approx(area, rel=0.01)
    assert there == pytest.approx(middle, abs=0.001)
    assert {vertex.groups[0].group for vertex in marked.data.vertices if len(vertex.groups) == 1} == {1}


def test_an_edited_drawing_carries_everything_over(marked, sheet, live):
    area, _ = weighted(marked, 0)
    for spline in sheet.children[0].data.splines:
        for point in spline.bezier_points:
            point.co.y += 0.004
            point.handle_left.y += 0.004
            point.handle_right.y += 0.004
    bpy.context.view_layer.update()
    before = flat_of(marked.data)[0]
    live.settle(marked.data)
    corners, _, faces = flat_of(marked.data)
    # Between the old crease and the new one is what belonged to the other side.
    settled = np.abs(corners[:, 1]) > 0.016
    uv = read(marked.data.uv_layers["Seamed"].uv, "vector", 2)
    assert uv[settled] == pytest.approx(seamed_uv(corners, patches(marked.data)[faces])[settled], abs=1e-5)
    assert weighted(marked, 0)[0] == pytest.approx(area, rel=0.01)
    assert not np.array_equal(corners, before), "it was made anew"


def test_undo_gives_back_what_was_there(marked, live):
    name = marked.name
    bpy.ops.ed.undo_push(message="marked")
    area = weighted(marked, 0)[0]
    marked.data.curvefold.resolution = 19
    live.settle(marked.data)
    bpy.ops.ed.undo_push(message="finer")
    bpy.ops.ed.undo()
    check(bpy.data.objects[name])
    assert weighted(bpy.data.objects[name], 0)[0] == area
    bpy.ops.ed.redo()
    check(bpy.data.objects[name])


def test_on_a_larger_sheet_maps_go_on_and_colours_stay_what_they_are(marked, sheet, live):
    for point in sheet.data.splines[0].points:
        point.co.y *= 1.2
    bpy.context.view_layer.update()
    live.settle(marked.data)
    mesh = marked.data
    corners, _, faces = flat_of(mesh)
    assert np.ptp(corners[:, 1]) == pytest.approx(0.12, abs=1e-6)
    assert read(mesh.uv_layers["Seamed"].uv, "vector", 2) == pytest.approx(
        seamed_uv(corners, patches(mesh)[faces]), abs=1e-5
    )
    colors = read(mesh.attributes["Paint"].data, "color", 4)
    assert (colors.min(), colors.max()) == pytest.approx((0.25, 1.0), abs=1e-5)


def test_what_has_nothing_of_the_user_gets_nothing(folded_paper, live):
    names = {attribute.name for attribute in folded_paper.data.attributes}
    folded_paper.data.curvefold.resolution = 19
    live.settle(folded_paper.data)
    assert {attribute.name for attribute in folded_paper.data.attributes} == names


def test_a_cut_mesh_comes_back_with_what_was_on_it(marked, live):
    bpy.context.view_layer.objects.active = marked
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.curvefold.restore_paper() == {"FINISHED"}
    check(marked)
