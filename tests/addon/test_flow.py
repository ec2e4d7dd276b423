"""Creases that are given a shape in space."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix
from papers import rests, shape


def fold_angle(live, paper) -> float:
    return live.report(paper.data).creases[0].fold_angle


def crease(paper):
    return paper.data.curvefold.creases[0]


def crease_points(paper) -> np.ndarray:
    """(n,3) the shown points of the crease, by x."""
    mesh = paper.data
    on_crease = [
        edge for edge, item in zip(mesh.edges, mesh.attributes["crease"].data, strict=True) if item.value == 0
    ]
    used = sorted({v for edge in on_crease for v in edge.vertices})
    points = np.array([mesh.vertices[v].co[:] for v in used])
    return points[np.argsort(points[:, 0])]


def add_curve(points, name="Target") -> bpy.types.Object:
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, place in zip(spline.points, points, strict=True):
        point.co = (*place, 1.0)
    item = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(item)
    bpy.context.view_layer.update()
    return item


def sharper(paper, factor: float) -> np.ndarray:
    """(81,3) the drawn crease, y = a x² + c in the plane, with ``factor`` times its height."""
    flat = crease_points(paper)
    a, _, c = np.polyfit(flat[:, 0], flat[:, 1], 2)
    x = np.linspace(-0.06, 0.06, 81)
    curve = np.column_stack([x, factor * a * x**2 + c, 0 * x])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    needed = np.linalg.norm(np.diff(flat, axis=0), axis=1).sum()
    # Cut so that both ends stick out evenly.
    middle = length[-1] / 2
    keep = np.abs(length - middle) <= needed / 2 + length[-1] / 80
    return curve[keep]


def test_a_crease_gets_more_curvature_and_folds(paper, live):
    flow = crease(paper)
    flow.flow, flow.curvature_times = "SHAPE", 1.3
    live.settle(paper.data)
    assert fold_angle(live, paper) == pytest.approx(2 * np.degrees(np.arccos(1 / 1.3)), abs=3.0)
    assert live.report(paper.data).state == "settled"
    assert rests(live, paper)
    live.forget()
    assert rests(live, paper)
    flow.progress = 50.0
    live.settle(paper.data)
    half = fold_angle(live, paper)
    assert 20.0 < half < 55.0
    live.forget()
    flow.progress = 100.0
    live.settle(paper.data)
    assert fold_angle(live, paper) == pytest.approx(2 * np.degrees(np.arccos(1 / 1.3)), abs=3.0), "not 1.3 twice"
    flow.flow = "NONE"
    live.settle(paper.data)
    assert fold_angle(live, paper) < 3.0


def test_a_crease_follows_a_curve_object(paper, live):
    points = sharper(paper, 1.3)
    target = add_curve(points[::-1] - (0, 0, 0.01))
    target.location.z = 0.01
    flow = crease(paper)
    flow.flow, flow.curve = "OBJECT", target
    live.settle(paper.data)
    assert live.report(paper.data).lacks == ()
    assert fold_angle(live, paper) > 40.0
    found = crease_points(paper)
    gap = np.abs(np.interp(found[2:-2, 0], points[:, 0], points[:, 1]) - found[2:-2, 1]).max()
    assert gap < 0.001
    assert np.abs(found[:, 2]).max() < 0.001
    assert rests(live, paper)
    paper.matrix_world = Matrix.Translation((0.0, 0.0, -0.004))
    bpy.context.view_layer.update()
    live.settle(paper.data)
    assert crease_points(paper)[:, 2].mean() == pytest.approx(0.004, abs=0.001), "the curve stays in the world"


def test_a_moved_or_changed_curve_wakes_its_paper(paper, live):
    target = add_curve(sharper(paper, 1.3))
    flow = crease(paper)
    flow.flow, flow.curve = "OBJECT", target
    live.settle(paper.data)
    assert not live.is_at_work()
    target.location.z = 0.003
    bpy.context.view_layer.update()
    assert live.is_at_work()
    live.settle(paper.data)
    assert crease_points(paper)[:, 2].mean() == pytest.approx(0.003, abs=0.001)
    for point in target.data.splines[0].points:
        point.co.z += 0.002
    target.data.update_tag()
    bpy.context.view_layer.update()
    assert live.is_at_work()
    live.settle(paper.data)
    assert crease_points(paper)[:, 2].mean() == pytest.approx(0.005, abs=0.001)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda paper: None, "choose a curve object"),
        (
            lambda paper: add_curve([(0, 0, 0), (0.01, 0, 0)], "Short"),
            "the curve is 0.01 long, shorter than Crease 1",
        ),
        (lambda paper: add_curve(sharper(paper, 0.5), "Flatter"), "would be flatter in space than it is drawn"),
    ],
)
def test_a_curve_that_cannot_be_followed_is_refused_in_words(paper, live, make, words):
    flow = crease(paper)
    flow.flow, flow.curve = "OBJECT", make(paper)
    live.settle(paper.data)
    report = live.report(paper.data)
    assert report.state == "trouble"
    assert words in report.sentence


def test_closed_and_many_curves_are_refused_and_lost_ones_named(paper, live):
    target = add_curve(sharper(paper, 1.3))
    flow = crease(paper)
    flow.flow, flow.curve = "OBJECT", target

    def said():
        target.data.update_tag()
        live.settle(paper.data)
        return live.report(paper.data).sentence

    target.data.splines[0].use_cyclic_u = True
    assert said() == "Crease 1: Target is closed: a crease can be given open curves only"
    target.data.splines[0].use_cyclic_u = False
    target.data.splines.new("POLY").points.add(2)
    assert said() == "Crease 1: Target must be one curve and has 2"
    bpy.data.objects.remove(target)
    live.wake(paper.data)
    live.settle(paper.data)
    assert "choose a curve" in live.report(paper.data).sentence


def test_speed_says_how_fast_it_goes_and_progress_how_far_it_is(paper, live):
    assert live.crease_report(paper.data, 0).progress is None
    flow = crease(paper)
    flow.flow, flow.curvature_times, flow.flow_speed, flow.progress = "SHAPE", 1.3, 0.25, 80.0
    gone = {}
    for speed in (0.25, 1.0):
        bpy.ops.curvefold.flatten()
        flow.flow_speed = speed
        live.settle(paper.data, max_iterations=15)
        gone[speed] = live.crease_report(paper.data, 0).progress
    assert 0.0 < gone[0.25] < 0.5 * gone[1.0] < 0.4
    live.settle(paper.data)
    assert live.crease_report(paper.data, 0).progress == pytest.approx(0.8)
    reached = fold_angle(live, paper)
    flow.flow_speed = 4.0
    live.settle(paper.data)
    assert fold_angle(live, paper) == pytest.approx(reached, abs=1.0), "speed is no place to go to"
    assert live.crease_report(paper.data, 0).progress == pytest.approx(0.8)
    live.session(paper.data).lay_flat()
    assert live.crease_report(paper.data, 0).progress is None, "of another shape nothing is known yet"


def test_a_stronger_curve_outdoes_a_handle(extension, paper, live):
    """The crease is given a curve where it lies, and a pin lifts one of its points."""
    target = add_curve(sharper(paper, 1.3))
    flow = crease(paper)
    flow.flow, flow.curve = "OBJECT", target
    live.settle(paper.data)
    handle = paper.data.curvefold.handles.add()
    x, y, z = crease_points(paper)[len(crease_points(paper)) // 2].tolist()
    handle.at, handle.offset, handle.pinned = (0.0, y), (x, y, z + 0.01), True
    height = {}
    for strength in (0.02, 20.0):
        flow.flow_strength = strength
        live.settle(paper.data)
        height[strength] = np.abs(crease_points(paper)[:, 2]).max()
    assert height[20.0] < 0.5 * height[0.02]


def test_a_keyframed_progress_plays_the_same_each_time(paper, live):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    flow = crease(paper)
    flow.flow, flow.curvature_times = "SHAPE", 1.3
    for frame, progress in ((1, 30.0), (4, 60.0)):
        flow.progress = progress
        flow.keyframe_insert("progress", frame=frame)

    def play():
        shapes = []
        for frame in range(1, 5):
            scene.frame_set(frame)
            shapes.append(shape(paper.data))
        return shapes

    first = play()
    assert len(set(first)) == 4
    assert play() == first
    live.forget()
    assert play() == first


def test_undo_and_files_keep_the_flow(paper, live, tmp_path):
    flow = crease(paper)
    flow.flow, flow.curvature_times, flow.flow_speed, flow.flow_strength = "SHAPE", 1.3, 2.0, 3.0
    live.settle(paper.data)
    name, before = paper.name, shape(paper.data)
    bpy.ops.ed.undo_push(message="flows")
    flow.progress = 30.0
    live.settle(paper.data)
    bpy.ops.ed.undo_push(message="less")
    assert shape(paper.data) != before
    bpy.ops.ed.undo()
    paper = bpy.data.objects[name]
    assert crease(paper).progress == 100.0
    assert shape(paper.data) == before
    assert rests(live, paper)
    path = str(tmp_path / "flow.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    paper = bpy.data.objects[name]
    assert (crease(paper).flow, crease(paper).flow_speed, crease(paper).flow_strength) == ("SHAPE", 2.0, 3.0)
    assert rests(live, paper)
    assert shape(paper.data) == before


def test_a_flatter_shape_than_the_drawn_one_is_refused_in_words(paper, live):
    flow = crease(paper)
    flow.flow, flow.curvature_times = "SHAPE", 0.5
    live.settle(paper.data)
    report = live.report(paper.data)
    assert report.state == "trouble"
    assert "Crease 1 would be flatter in space than it is drawn" in report.sentence
    assert np.ptp(live.session(paper.data).positions[:, 2]) == 0.0


def test_an_animated_curve_counts_as_motion(extension, paper, live):
    hooks = extension("curvefold_addon.bridge.hooks")
    target = add_curve(sharper(paper, 1.3))
    flow = crease(paper)
    flow.flow, flow.curve = "OBJECT", target
    assert not hooks.is_animated(paper)
    target.data.splines[0].points[0].keyframe_insert("co", frame=1)
    assert hooks.is_animated(paper)
    target.data.animation_data_clear()
    target.keyframe_insert("location", frame=1)
    assert hooks.is_animated(paper)
    flow.flow = "NONE"
    assert not hooks.is_animated(paper)
