"""Curve objects that creases follow: as Blender shows them, with shape keys and modifiers."""

import bpy
import numpy as np
import pytest

#: Where the ends of the sheet's crease are.
LEFT, RIGHT = (-0.05, -0.005, 0.0), (0.05, -0.005, 0.0)
LIFT = 0.02


def new_curve(kind: str) -> bpy.types.Object:
    """A line from end to end with a point in between."""
    data = bpy.data.curves.new("Target", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    middle = (0.0, 0.012, 0.0)
    if kind == "BEZIER":
        spline.bezier_points.add(2)
        for point, place in zip(spline.bezier_points, (LEFT, middle, RIGHT), strict=True):
            point.co = place
            point.handle_left_type = point.handle_right_type = "AUTO"
    else:
        spline.points.add(2)
        for point, place in zip(spline.points, (LEFT, middle, RIGHT), strict=True):
            point.co = (*place, 1.0)
        spline.order_u, spline.use_endpoint_u = 3, True
    item = bpy.data.objects.new("Target", data)
    bpy.context.collection.objects.link(item)
    bpy.context.view_layer.update()
    return item


@pytest.fixture(params=["BEZIER", "NURBS", "POLY"])
def target(request, paper, live):
    """The curve that the paper's crease follows, in the paper's own place."""
    made = new_curve(request.param)
    follow(paper, made)
    return made


@pytest.fixture
def bezier(paper, live):
    made = new_curve("BEZIER")
    follow(paper, made)
    return made


def follow(paper, curve) -> None:
    paper.matrix_world.identity()
    entry = paper.data.curvefold.creases[0]
    entry.flow, entry.curve = "OBJECT", curve
    bpy.context.view_layer.update()


def told(live, extension, paper):
    """Points that the crease is told to go through, (n,3), and faults."""
    found = live.make_session(paper)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    inputs = live.read_inputs(paper, found, bpy.context.scene, depsgraph)
    points = [np.array(control.points) for control in inputs.controls if getattr(control, "points", None)]
    return (points[0] if points else None), inputs.faults


def lift(curve) -> bpy.types.ShapeKey:
    """A shape key that raises the middle point."""
    curve.shape_key_add(name="Basis", from_mix=False)
    key = curve.shape_key_add(name="Up", from_mix=False)
    key.data[1].co.z += LIFT
    if curve.data.splines[0].type == "BEZIER":
        key.data[1].handle_left.z += LIFT
        key.data[1].handle_right.z += LIFT
    return key


def test_a_shape_key_of_the_target_counts(target, paper, live, extension):
    flat, _ = told(live, extension, paper)
    key = lift(target)
    key.value = 1.0
    raised, faults = told(live, extension, paper)
    assert faults == ()
    assert np.abs(flat[:, 2]).max() < 1e-7
    height = LIFT if target.data.splines[0].type != "NURBS" else 0.5 * LIFT
    assert raised[:, 2].max() == pytest.approx(height, rel=0.01)
    assert raised[:, :2] == pytest.approx(flat[:, :2], abs=1e-3), "automatic handles lean a little"


def test_a_keyed_shape_key_moves_the_paper_over_frames(paper, live, extension):
    """The crease as it is drawn, raised more and more."""
    hooks = extension("curvefold_addon.bridge.hooks")
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    paper.data.curvefold.iterations_per_frame = 20
    curve = new_curve("BEZIER")
    spline = curve.data.splines[0]
    crease = paper.data.curvefold.sheet.children[0]
    points = crease.data.splines[0].bezier_points
    curve.data.splines.remove(spline)
    spline = curve.data.splines.new("BEZIER")
    spline.bezier_points.add(len(points) - 1)
    for point, drawn in zip(spline.bezier_points, points, strict=True):
        point.handle_left_type = point.handle_right_type = "FREE"
        point.co, point.handle_left, point.handle_right = drawn.co, drawn.handle_left, drawn.handle_right
    curve.shape_key_add(name="Basis", from_mix=False)
    key = curve.shape_key_add(name="Up", from_mix=False)
    key.data[0].handle_right.z += LIFT
    key.data[-1].handle_left.z += LIFT
    follow(paper, curve)
    assert not hooks.is_animated(paper)
    for frame, value in ((1, 0.4), (4, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    assert hooks.is_animated(paper)
    heights, shapes = [], []
    for frame in range(1, 5):
        scene.frame_set(frame)
        points, faults = told(live, extension, paper)
        assert faults == ()
        heights.append(points[:, 2].max())
        shapes.append(bytes(paper.data["curvefold_positions"]))
    assert live.session(paper.data).said.refused == ()
    assert heights[0] == pytest.approx(0.4 * heights[3], rel=0.01)
    assert heights[3] == pytest.approx(0.75 * LIFT, rel=0.01)
    assert len(set(shapes)) == 4


@pytest.mark.parametrize("on_points", [True, False])
def test_a_modifier_of_the_target_counts(target, paper, live, extension, on_points):
    before, _ = told(live, extension, paper)
    bend = target.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.deform_axis, bend.angle = "TWIST", "X", 1.0
    bend.use_apply_on_spline = on_points
    after, faults = told(live, extension, paper)
    assert faults == ()
    assert np.ptp(after[:, 2]) > 0.1 * np.ptp(before[:, 1])
    # What the user sees: the curve as Blender draws it.
    depsgraph = bpy.context.evaluated_depsgraph_get()
    seen = target.evaluated_get(depsgraph)
    places = np.array([vertex.co[:] for vertex in seen.to_mesh().vertices])
    seen.to_mesh_clear()
    gaps = np.linalg.norm(places[:, None] - after[None], axis=2).min(axis=1)
    assert gaps.max() < 0.02 * np.ptp(places[:, 0]), "every point that is seen is asked for"
    bend.show_viewport = False
    assert told(live, extension, paper)[0] == pytest.approx(before, abs=1e-7)


def test_a_thick_target_says_which_modifier_does_not_count(bezier, paper, live, extension):
    bezier.data.bevel_depth = 0.001
    assert told(live, extension, paper)[1] == (), "thickness alone is no harm"
    bend = bezier.modifiers.new("Bend", "SIMPLE_DEFORM")
    _, faults = told(live, extension, paper)
    assert [fault.partition(": ")[2] for fault in faults] == [
        "Target has thickness, which its modifier Bend changes: set Bevel and Extrude to zero"
    ]
    bend.use_apply_on_spline = True
    assert told(live, extension, paper)[1] == ()


def test_what_a_modifier_of_the_target_looks_at_moves_the_paper(bezier, paper, live, extension):
    hooks = extension("curvefold_addon.bridge.hooks")
    empty = bpy.data.objects.new("Lifter", None)
    bpy.context.collection.objects.link(empty)
    hook = bezier.modifiers.new("Hook", "HOOK")
    hook.object = empty
    hook.vertex_indices_set([3, 4, 5])
    bpy.context.view_layer.update()
    while live.tick(0.05):
        pass
    flat, _ = told(live, extension, paper)
    empty.location.z += LIFT
    bpy.context.view_layer.update()
    assert live.is_at_work(), "it is noticed"
    assert told(live, extension, paper)[0][:, 2].max() == pytest.approx(LIFT, rel=0.01)
    assert np.abs(flat[:, 2]).max() < 1e-6
    assert not hooks.is_animated(paper)
    empty.keyframe_insert("location", frame=1)
    assert hooks.is_animated(paper)
