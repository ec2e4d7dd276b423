"""What shaders and Geometry Nodes read of a paper: fold angles, sides, stretch, rulings."""

import bpy
import numpy as np
import pytest
from mathutils import Vector


def values(mesh, name, width=1):
    attribute = mesh.attributes[name]
    result = np.empty(width * len(attribute.data))
    attribute.data.foreach_get("vector" if width == 3 else "value", result)
    return result.reshape(-1, width) if width > 1 else result


@pytest.fixture
def folded_paper(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    return paper


def test_fold_angles_are_those_of_the_faces_beside(folded_paper):
    mesh = folded_paper.data
    angles, crease = values(mesh, "fold_angle"), values(mesh, "crease")
    assert (angles[crease < 0] == 0.0).all()
    beside = {}
    for polygon in mesh.polygons:
        for loop in polygon.loop_indices:
            beside.setdefault(mesh.loops[loop].edge_index, []).append(polygon)
    seen = 0
    for edge in mesh.edges:
        if crease[edge.index] >= 0:
            left, right = beside[edge.index]
            between = left.normal.angle(right.normal)
            assert abs(angles[edge.index]) == pytest.approx(between, abs=np.radians(6.0))
            # A valley's faces rise towards each other on the front.
            opens = (Vector(right.center) - Vector(left.center)).dot(left.normal)
            assert np.sign(angles[edge.index]) == np.sign(opens)
            seen += 1
    assert seen > 10


def test_assignment_is_the_side_that_the_crease_was_folded_to(folded_paper, live):
    mesh = folded_paper.data
    crease, side = values(mesh, "crease"), values(mesh, "assignment")
    found = live.crease_report(mesh, 0).found
    assert set(side[crease == 0]) == {{"V": 1.0, "M": -1.0}[found]}
    assert set(side[crease < 0]) == {0.0}


@pytest.mark.parametrize(("letter", "sign"), [("V", 1.0), ("M", -1.0)])
def test_a_valley_is_positive_and_a_mountain_negative(sheet, live, letter, sign):
    sheet.children[0].curvefold.assignment = letter
    bpy.ops.curvefold.make_paper(resolution=12)
    mesh = bpy.context.active_object.data
    mesh.curvefold.fold = 50.0
    live.settle(mesh)
    on_crease = values(mesh, "crease") == 0
    assert set(values(mesh, "assignment")[on_crease]) == {sign}
    assert set(np.sign(values(mesh, "fold_angle")[on_crease])) == {sign}


def test_stretch_is_that_of_the_report(folded_paper, live):
    stretch = values(folded_paper.data, "stretch")
    report = live.report(folded_paper.data)
    assert 0.0 < stretch.mean() == pytest.approx(report.stretch_mean, rel=0.5)
    assert stretch.max() <= report.stretch_max + 1e-9


def test_a_flat_paper_is_not_folded(paper):
    mesh = paper.data
    for name in ("fold_angle", "assignment", "stretch"):
        assert np.abs(values(mesh, name)).max() < 1e-6


def test_they_are_those_of_the_shape_after_every_change(folded_paper, live):
    mesh = folded_paper.data
    before = np.median(np.abs(values(mesh, "fold_angle"))[values(mesh, "crease") == 0])
    mesh.curvefold.fold = 100.0
    live.settle(mesh)
    after = np.median(np.abs(values(mesh, "fold_angle"))[values(mesh, "crease") == 0])
    assert after > 1.7 * before
    assert np.degrees(after) == pytest.approx(live.crease_report(mesh, 0).fold_angle, abs=1.0)


def test_rulings_lie_in_the_paper_and_the_paper_is_straight_along_them(folded_paper, live):
    mesh = folded_paper.data
    assert "ruling" not in mesh.attributes, "only where they are asked for"
    assert bpy.ops.curvefold.rulings_as_attribute() == {"FINISHED"}
    ruling = values(mesh, "ruling", 3)
    length = np.linalg.norm(ruling, axis=1)
    bent = length > 0.5
    assert length[bent] == pytest.approx(1.0, abs=1e-5)
    assert (length[~bent] == 0.0).all()
    assert bent.mean() > 0.7
    normals = np.array([polygon.normal[:] for polygon in mesh.polygons])
    off = np.abs(np.einsum("nc,nc->n", normals, ruling))[bent]
    assert np.degrees(np.arcsin(np.quantile(off, 0.9))) < 5.0


def test_rulings_are_found_again_when_the_paper_rests_and_at_another_resolution(folded_paper, live):
    mesh = folded_paper.data
    bpy.ops.curvefold.rulings_as_attribute()
    before = values(mesh, "ruling", 3)
    mesh.curvefold.fold = 100.0
    live.settle(mesh)
    turned = values(mesh, "ruling", 3)
    assert np.abs(turned - before).max() > 0.05
    mesh.curvefold.resolution = 16
    live.settle(mesh)
    assert len(mesh.polygons) > len(turned)
    assert (np.linalg.norm(values(mesh, "ruling", 3), axis=1) > 0.5).mean() > 0.7


def test_rulings_come_with_the_ticks_of_a_window(folded_paper, live):
    mesh = folded_paper.data
    bpy.ops.curvefold.rulings_as_attribute()
    mesh.curvefold.fold = 100.0
    live.wake(mesh)
    while live.tick(0.05):
        pass
    ticked = values(mesh, "ruling", 3)
    bpy.ops.curvefold.rulings_as_attribute()
    assert np.array_equal(values(mesh, "ruling", 3), ticked)


def test_what_an_earlier_version_marked_is_marked_anew(folded_paper, live):
    """``crease_edge`` was our flag, and there was one map."""
    mesh = folded_paper.data
    on_crease = values(mesh, "on_crease").astype(bool)
    crease_edge = values(mesh, "crease_edge")
    for name in ("crease_edge", "crease_vert", "on_crease", "fold_angle", "assignment", "stretch", "print"):
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new("crease_edge", "BOOLEAN", "EDGE").data.foreach_set("value", on_crease)
    mesh.uv_layers["flat"].active_render = True
    positions = values(mesh, "position", 3)
    live.settle(mesh)
    assert mesh.attributes["crease_edge"].data_type == "FLOAT"
    assert np.array_equal(values(mesh, "crease_edge"), crease_edge)
    assert np.array_equal(values(mesh, "on_crease"), on_crease)
    assert "crease_edge.user" not in mesh.attributes
    assert {"print", "fold_angle", "assignment", "stretch"} <= {attribute.name for attribute in mesh.attributes}
    assert [layer.name for layer in mesh.uv_layers if layer.active_render] == ["flat"], "textures stay as they were"
    assert np.array_equal(values(mesh, "position", 3), positions)


def test_creases_that_the_user_sets_for_subdivision_stay(folded_paper, live):
    mesh = folded_paper.data
    mesh.attributes["crease_edge"].data[0].value = 0.25
    mesh.curvefold.fold = 60.0
    live.settle(mesh)
    assert mesh.attributes["crease_edge"].data[0].value == 0.25
