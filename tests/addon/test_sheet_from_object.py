"""Closed curves and flat meshes as sheets."""

import bpy
import numpy as np
import pytest
import shapely
from mathutils import Matrix


def read(extension, sheet):
    return extension("curvefold_addon.bridge.drawing").read_drawing(sheet)


def area(pattern):
    return shapely.Polygon(pattern.boundary, pattern.holes).area * (pattern.unit_mm / 1000) ** 2


def world_outline(extension, sheet):
    bpy.context.view_layer.update()
    boundary = read(extension, sheet).boundary
    return (
        np.column_stack([boundary, np.zeros(len(boundary)), np.ones(len(boundary))])
        @ np.array(sheet.matrix_world).T
    )


def make(name, points, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    item = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(item)
    bpy.context.view_layer.objects.active = item
    item.select_set(True)
    return item


def test_a_closed_curve_becomes_the_sheet(extension):
    bpy.ops.curve.primitive_bezier_circle_add(radius=2.0, location=(1, 2, 3), rotation=(0.5, 0.2, 0.1))
    circle = bpy.context.active_object
    circle.scale = (0.5, 0.5, 0.5)
    assert bpy.ops.curvefold.sheet_from_object() == {"FINISHED"}
    assert bpy.context.active_object == circle
    assert list(bpy.data.objects) == [circle]
    assert circle.curvefold.role == "SHEET"
    assert area(read(extension, circle)) == pytest.approx(np.pi, rel=1e-3)


def test_a_curve_scaled_unevenly_is_kept_and_copied_true(extension):
    bpy.ops.curve.primitive_bezier_circle_add(radius=1.0, location=(1, 2, 3))
    circle = bpy.context.active_object
    circle.scale = (2, 1, 1)
    bpy.ops.curvefold.sheet_from_object()
    sheet = bpy.context.active_object
    assert sheet != circle
    assert circle.curvefold.role == "NONE"
    assert tuple(sheet.scale) == pytest.approx((1, 1, 1))
    assert area(read(extension, sheet)) == pytest.approx(2 * np.pi, rel=1e-3)
    assert sheet.data.splines[0].type == "BEZIER"
    places = world_outline(extension, sheet)
    assert places[:, :3].min(axis=0) == pytest.approx([-1, 1, 3], abs=1e-3)
    assert places[:, :3].max(axis=0) == pytest.approx([3, 3, 3], abs=1e-3)


def test_a_curve_upright_in_its_own_coordinates(extension):
    bpy.ops.curve.primitive_bezier_circle_add(radius=1.0)
    circle = bpy.context.active_object
    circle.data.dimensions = "3D"
    circle.data.transform(Matrix.Rotation(np.pi / 2, 4, "X"))
    bpy.ops.curvefold.sheet_from_object()
    places = world_outline(extension, bpy.context.active_object)
    assert places[:, 1] == pytest.approx(0, abs=1e-6)
    assert np.hypot(places[:, 0], places[:, 2]) == pytest.approx(1, rel=1e-3)


@pytest.mark.parametrize("turn", [0.3, 1.4, 2.0, 3.3, 4.4, 5.1])
def test_a_scaled_plane(extension, turn):
    bpy.ops.mesh.primitive_plane_add(size=2.0, location=(5, 0, 1), rotation=(turn, 0.2, 0.1))
    plane = bpy.context.active_object
    plane.scale = (0.2, 0.1, 1)
    bpy.context.view_layer.update()
    corners = {tuple(np.round(np.array(plane.matrix_world @ v.co, dtype=float), 4)) for v in plane.data.vertices}
    bpy.ops.curvefold.sheet_from_object()
    sheet = bpy.context.active_object
    found = {tuple(np.round(place[:3], 4)) for place in world_outline(extension, sheet)}
    assert found == corners
    # Its front is the plane's.
    assert sheet.matrix_world.col[2].dot(plane.matrix_world.col[2]) == pytest.approx(1)
    assert plane.name in {item.name for item in bpy.context.scene.objects}


def test_holes_and_modifiers_of_a_mesh(extension):
    ring = make(
        "Ring",
        [(x, y, 2) for half in (2, 1) for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))],
        [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
    )
    ring.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
    bpy.context.view_layer.update()
    bpy.ops.curvefold.sheet_from_object()
    pattern = read(extension, bpy.context.active_object)
    assert len(pattern.holes) == 1
    assert area(pattern) == pytest.approx(12)
    assert len(pattern.boundary) == 8


BAD = {
    "it is not flat: it leaves its plane by 25 cm": ([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)], [(0, 1, 2, 3)]),
    "its outline touches itself": (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)],
        [(0, 1, 2), (0, 3, 4)],
    ),
    "its faces have no outer edge": (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
        [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
    ),
    "its outline encloses no area": ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)]),
}


@pytest.mark.parametrize("sentence", BAD)
def test_a_mesh_that_is_no_sheet(sentence):
    make("Bad", *BAD[sentence])
    before = len(bpy.data.objects), len(bpy.data.curves)
    with pytest.raises(RuntimeError, match=f"Bad: {sentence}"):
        bpy.ops.curvefold.sheet_from_object()
    assert before == (len(bpy.data.objects), len(bpy.data.curves))


def test_a_mesh_of_open_edges():
    mesh = bpy.data.meshes.new("Open")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1), (1, 2)], [])
    item = bpy.data.objects.new("Open", mesh)
    bpy.context.collection.objects.link(item)
    bpy.context.view_layer.objects.active = item
    with pytest.raises(RuntimeError, match="Open: its outline is not closed"):
        bpy.ops.curvefold.sheet_from_object()


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 1, 1)])
def test_an_open_curve(scale):
    bpy.ops.curve.primitive_bezier_curve_add()
    item = bpy.context.active_object
    item.scale = scale
    with pytest.raises(RuntimeError, match="its border is not closed"):
        bpy.ops.curvefold.sheet_from_object()
    assert item.curvefold.role == "NONE"
    assert not item.hide_render
    assert list(bpy.data.objects) == [item]
    assert list(bpy.data.curves) == [item.data]


def test_what_it_does_not_take():
    with pytest.raises(RuntimeError, match="Select a closed curve or a flat mesh"):
        bpy.ops.curvefold.sheet_from_object()
    bpy.ops.curvefold.add_sheet()
    with pytest.raises(RuntimeError, match="a part of a drawing already"):
        bpy.ops.curvefold.sheet_from_object()
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Works in Object Mode"):
        bpy.ops.curvefold.sheet_from_object()
    bpy.ops.object.mode_set(mode="OBJECT")
