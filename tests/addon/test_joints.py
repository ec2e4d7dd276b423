"""Joints: points and borders that are drawn together, patches that keep their shape."""

from math import dist

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Vector
from papers import edit, paper_of, rests, select_vertices, shape

STRIP = """<svg xmlns="http://www.w3.org/2000/svg" width="120mm" height="20mm" viewBox="0 0 120 20">
<rect x="0" y="0" width="120" height="20" fill="none" stroke="black"/>
<path d="M 60 0 L 60 20" fill="none" stroke="#f0f"/>
</svg>
"""


def joints(paper):
    return paper.data.curvefold.joints


def gap(live, paper) -> np.ndarray:
    joint = joints(paper)[0]
    found = live.session(paper.data)
    return np.subtract(found.place_of(tuple(joint.first)), found.place_of(tuple(joint.second)))


@pytest.fixture
def joined(paper, live):
    """A folded paper whose upper corners are drawn together."""
    paper.data.curvefold.fold = 40.0
    live.settle(paper.data)
    select_vertices(paper, (-0.05, 0.05), (0.05, 0.05))
    assert bpy.ops.curvefold.join_points(relation="DISTANCE") == {"FINISHED"}
    return paper


# --- two points -----------------------------------------------------------------------------------------------


def test_points_at_a_distance_come_to_it(joined, live):
    assert joined.mode == "OBJECT"
    joint = joints(joined)[0]
    assert (joint.name, joint.family) == ("Points 1", "POINTS")
    start = dist(gap(live, joined), (0, 0, 0))
    assert joint.distance == pytest.approx(start, rel=1e-3), "to begin with, where they are"
    joint.distance = 0.085
    live.settle(joined.data)
    assert np.linalg.norm(gap(live, joined)) == pytest.approx(0.085, abs=0.002)
    assert rests(live, joined)
    live.forget()
    assert rests(live, joined)


def test_points_can_share_a_coordinate(joined, live):
    joint = joints(joined)[0]
    joint.first, joint.second = (0.0, 0.05), (0.0, -0.05)
    joint.relation, joint.axes = "SHARE", (False, False, True)
    live.settle(joined.data)
    assert abs(gap(live, joined)[2]) < 5e-4
    assert abs(gap(live, joined)[1]) > 0.05


def test_selected_handles_can_be_joined_too(extension, paper, live):
    paper.data.curvefold.fold = 30.0
    live.settle(paper.data)
    select_vertices(paper, (-0.05, 0.05), (0.05, 0.05))
    bpy.ops.curvefold.add_handles(together=False)
    empties = [handle.hook for handle in paper.data.curvefold.handles]
    for thing in bpy.context.scene.objects:
        thing.select_set(thing in empties)
    assert bpy.ops.curvefold.join_points(relation="SHARE") == {"FINISHED"}
    assert tuple(joints(paper)[0].first) == tuple(paper.data.curvefold.handles[0].at)
    bpy.context.view_layer.objects.active = paper
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="Select two vertices"):
        bpy.ops.curvefold.join_points()


def test_a_distance_that_no_sheet_has_is_refused_in_words(joined, live):
    joints(joined)[0].distance = 0.2
    live.settle(joined.data)
    report = live.report(joined.data)
    assert report.state == "trouble"
    assert report.sentence.startswith("Points 1: asks for a distance of 0.2, but the sheet")
    joints(joined)[0].enabled = False
    live.settle(joined.data)
    assert live.report(joined.data).state == "settled"
    assert live.session(joined.data).inputs.controls == ()


def test_a_joint_is_removed_and_undo_brings_it_back(joined, live):
    joints(joined)[0].distance = 0.085
    live.settle(joined.data)
    name, before = joined.name, shape(joined.data)
    bpy.ops.ed.undo_push(message="joined")
    bpy.ops.curvefold.remove_joint("EXEC_DEFAULT", True)
    assert not joints(joined)
    assert shape(joined.data) != before
    with pytest.raises(RuntimeError, match="no such joint"):
        bpy.ops.curvefold.remove_joint()
    bpy.ops.ed.undo()
    paper = bpy.data.objects[name]
    assert joints(paper)[0].distance == pytest.approx(0.085)
    assert shape(paper.data) == before
    assert rests(live, paper)


def test_a_removed_joint_is_not_the_next_one(joined, live):
    """Blender evaluates nothing when an entry goes and another comes."""
    joints(joined)[0].distance = 0.085
    live.settle(joined.data)
    bpy.ops.curvefold.remove_joint()
    select_vertices(joined, (-0.05, -0.05), (0.05, -0.05))
    bpy.ops.curvefold.join_points(relation="DISTANCE")
    asked = live.session(joined.data).inputs.controls[-1]
    assert asked.first == tuple(joints(joined)[0].first)
    assert asked.distance == pytest.approx(joints(joined)[0].distance)


def test_a_keyframed_distance_plays_the_same_each_time(joined, live):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 3
    joint = joints(joined)[0]
    for frame, distance in ((1, 0.09), (3, 0.086)):
        joint.distance = distance
        joint.keyframe_insert("distance", frame=frame)

    def play():
        shapes = []
        for frame in (1, 2, 3):
            scene.frame_set(frame)
            shapes.append(shape(joined.data))
        return shapes

    first = play()
    assert len(set(first)) == 3
    assert play() == first


# --- patches --------------------------------------------------------------------------------------------------


def select_face(paper, place):
    _edited, flat = edit(paper)
    vertex = min(flat, key=lambda v: (flat[v] - Vector(place)).length)
    bpy.ops.mesh.select_mode(type="FACE")
    vertex.link_faces[0].select = True
    bmesh.update_edit_mesh(paper.data)


def flatness(paper, patch) -> float:
    """How far the vertices of a patch are from their best plane."""
    faces = [k for k, item in enumerate(paper.data.attributes["patch"].data) if item.value == patch]
    used = sorted({v for k in faces for v in paper.data.polygons[k].vertices})
    points = np.array([paper.data.vertices[v].co[:] for v in used])
    return float(np.linalg.svd(points - points.mean(axis=0))[1][2])


def test_a_patch_is_kept_flat_and_then_its_curved_crease_folds_little(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    bent = min(flatness(paper, p) for p in (0, 1))
    select_face(paper, (0.0, -0.045))
    assert bpy.ops.curvefold.keep_patch(shape="FLAT") == {"FINISHED"}
    entry = joints(paper)[0]
    assert (entry.name, entry.family, entry.shape) == ("Patch 1", "PATCH", "FLAT")
    assert min(flatness(paper, p) for p in (0, 1)) < 0.1 * bent
    assert live.report(paper.data).sentence.endswith("which is kept flat, holds it")
    assert rests(live, paper)


def test_a_rigid_patch_stays_bent_as_it_is(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    bent = [flatness(paper, p) for p in (0, 1)]
    select_face(paper, (0.0, -0.045))
    assert bpy.ops.curvefold.keep_patch(shape="RIGID") == {"FINISHED"}
    paper.data.curvefold.fold = 20.0
    live.settle(paper.data)
    after = [flatness(paper, p) for p in (0, 1)]
    kept = [k for k in (0, 1) if abs(after[k] - bent[k]) < 0.05 * bent[k]]
    assert kept
    bpy.ops.curvefold.remove_joint()
    assert all(flatness(paper, k) < 0.8 * bent[k] for k in kept), "without it the slider moves them"


def test_a_patch_is_chosen_by_a_face(paper):
    bpy.context.view_layer.objects.active = paper
    with pytest.raises(RuntimeError, match="Select a face"):
        bpy.ops.curvefold.keep_patch()


# --- borders --------------------------------------------------------------------------------------------------


@pytest.fixture
def strip(extension, tmp_path):
    return paper_of(extension, tmp_path, STRIP, resolution=18)


def select_ends(paper, *edges):
    """Selects the vertices whose flat x is at one of these."""
    _edited, flat = edit(paper)
    for vertex, place in flat.items():
        if any(abs(place.x - x) < 1e-6 for x in edges):
            vertex.select = True
    bmesh.update_edit_mesh(paper.data)


def test_two_borders_are_glued_to_a_ring(strip, live):
    select_ends(strip, -0.06, 0.06)
    assert bpy.ops.curvefold.glue_borders() == {"FINISHED"}
    joint = joints(strip)[0]
    assert joint.name == "Seam 1"
    assert joint.first[1] == joint.third[1], "ends that face each other meet"
    found = live.session(strip.data)
    for a, b in ((joint.first, joint.third), (joint.second, joint.fourth)):
        assert dist(found.place_of(tuple(a)), found.place_of(tuple(b))) < 0.002
    assert rests(live, strip)
    live.forget()
    assert rests(live, strip)


def test_borders_of_unequal_length_are_refused_in_words(strip, live):
    select_ends(strip, -0.06, 0.06)
    bpy.ops.curvefold.glue_borders()
    joints(strip)[0].second = (joints(strip)[0].first[0], 0.0)
    live.settle(strip.data)
    report = live.report(strip.data)
    assert report.state == "trouble"
    assert report.sentence.startswith("Seam 1: the borders to be glued are")


def test_one_border_alone_cannot_be_glued(strip):
    select_ends(strip, 0.06)
    with pytest.raises(RuntimeError, match="two stretches of the border"):
        bpy.ops.curvefold.glue_borders()
    assert not joints(strip)
