"""Creases with sides, amounts and angles of their own."""

import bpy
import numpy as np
import pytest
from mathutils import Vector
from papers import paper_of, rests, shape

#: Two arcs that curve the same way, far enough apart to fold by themselves.
ARCS = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<rect x="0" y="0" width="100" height="100" fill="none" stroke="black"/>
<path id="Bottom" d="M 0 25 Q 50 45 100 25" fill="none" stroke="#f0f"/>
<path id="Top" d="M 0 65 Q 50 85 100 65" fill="none" stroke="#f0f"/>
</svg>
"""


@pytest.fixture
def paper(extension, tmp_path):
    """A paper with two creases, flat."""
    return paper_of(extension, tmp_path, ARCS, resolution=12)


@pytest.fixture
def folded(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    return paper


def creases(paper):
    return paper.data.curvefold.creases


def sides(live, paper) -> list[str]:
    return [crease.found for crease in live.report(paper.data).creases]


def angles(live, paper) -> list[float]:
    return [crease.fold_angle for crease in live.report(paper.data).creases]


def other(side: str) -> str:
    return {"V": "M", "M": "V"}[side]


# --- one entry a crease ---------------------------------------------------------------------------------------


def test_a_paper_has_an_entry_for_each_crease(paper):
    names = [child.name for child in paper.data.curvefold.sheet.children]
    assert sorted(entry.name for entry in creases(paper)) == sorted(names)
    assert {(entry.side, entry.amount, entry.use_angle) for entry in creases(paper)} == {("U", 100.0, False)}


def test_what_is_said_of_a_crease_stays_with_it(folded, live):
    sheet = folded.data.curvefold.sheet
    creases(folded)["Top"].amount = 40.0
    creases(folded)["Bottom"].side = "M"
    folded.data.curvefold.resolution = 10
    live.settle(folded.data)
    assert [(e.name, e.side, e.amount) for e in creases(folded)] == [("Bottom", "M", 100.0), ("Top", "U", 40.0)]
    low, high = (bpy.data.objects[name] for name in ("Bottom", "Top"))
    high.name = "Upper"
    live.rebuild(folded.data)
    live.settle(folded.data)
    assert [(e.name, e.side, e.amount) for e in creases(folded)] == [("Bottom", "M", 100.0), ("Upper", "U", 40.0)]
    bpy.data.objects.remove(low)
    live.rebuild(folded.data)
    live.settle(folded.data)
    assert [(e.name, e.side, e.amount) for e in creases(folded)] == [("Upper", "U", 40.0)]
    assert len(sheet.children) == 1


# --- sides ----------------------------------------------------------------------------------------------------


def test_a_side_that_is_chosen_turns_the_crease_over(folded, live):
    before = sides(live, folded)
    creases(folded)["Top"].side = other(before[1])
    live.settle(folded.data)
    assert sides(live, folded) == [before[0], other(before[1])]
    assert live.report(folded.data).lacks == ()
    assert rests(live, folded)


def test_flipping_turns_over_the_active_crease_and_holds_it(folded, live):
    before = sides(live, folded)
    folded.data.curvefold.active_crease = 0
    assert bpy.ops.curvefold.flip_crease() == {"FINISHED"}
    assert sides(live, folded) == [other(before[0]), before[1]]
    assert [entry.side for entry in creases(folded)] == [other(before[0]), "U"]
    assert bpy.ops.curvefold.flip_crease() == {"FINISHED"}
    assert sides(live, folded)[0] == before[0]
    with pytest.raises(RuntimeError, match="no such crease"):
        bpy.ops.curvefold.flip_crease(index=7)


def test_a_flat_crease_has_no_side_to_flip_or_lock(paper):
    with pytest.raises(RuntimeError, match="Bottom is on no side yet"):
        bpy.ops.curvefold.flip_crease()
    with pytest.raises(RuntimeError, match="No crease is folded"):
        bpy.ops.curvefold.lock_sides()


def test_flipping_a_signed_angle_turns_its_sign(paper, live):
    low = creases(paper)["Bottom"]
    low.use_angle, low.signed, low.angle = True, True, np.radians(30)
    live.settle(paper.data)
    assert bpy.ops.curvefold.flip_crease(index=0) == {"FINISHED"}
    assert (low.side, round(np.degrees(low.angle))) == ("U", -30)
    assert sides(live, paper)[0] == "M"


def test_locked_sides_are_those_that_were_found_and_freed_ones_are_free(folded, live):
    found = sides(live, folded)
    assert bpy.ops.curvefold.lock_sides() == {"FINISHED"}
    assert [entry.side for entry in creases(folded)] == found
    assert sides(live, folded) == found
    bpy.ops.curvefold.flatten()
    assert np.ptp(live.session(folded.data).positions[:, 2]) == 0.0, "sides bend no sheet by themselves"
    assert rests(live, folded)
    for entry in creases(folded):
        entry.side = other(entry.side)
    folded.data.curvefold.fold = 50.0
    live.settle(folded.data)
    assert sides(live, folded) == [other(side) for side in found]
    assert bpy.ops.curvefold.free_sides() == {"FINISHED"}
    assert {entry.side for entry in creases(folded)} == {"U"}
    assert live.session(folded.data).inputs.controls == ()


def test_the_drawing_binds_when_it_is_asked_to(folded, live):
    found = sides(live, folded)
    bpy.data.objects["Bottom"].curvefold.assignment = other(found[0])
    folded.data.curvefold.use_assignments = False
    live.rebuild(folded.data)
    live.settle(folded.data)
    assert sides(live, folded) == found
    folded.data.curvefold.use_assignments = True
    live.settle(folded.data)
    assert sides(live, folded) == [other(found[0]), found[1]]
    creases(folded)["Bottom"].side = found[0]
    live.settle(folded.data)
    assert sides(live, folded) == found, "the paper's own word counts more"


# --- amounts and angles ---------------------------------------------------------------------------------------


def test_an_amount_is_a_part_of_the_slider(folded, live):
    creases(folded)["Top"].amount = 50.0
    live.settle(folded.data)
    low, high = angles(live, folded)
    assert low == pytest.approx(45.0, abs=2.0)
    assert high == pytest.approx(22.5, abs=2.0)
    creases(folded)["Top"].amount = 0.0
    creases(folded)["Top"].side = "V"
    live.settle(folded.data)
    assert angles(live, folded)[1] < 3.0, "what stays flat has no side"


def test_a_crease_can_have_an_angle_of_its_own(folded, live):
    high = creases(folded)["Top"]
    high.use_angle, high.angle = True, np.radians(-30.0)
    live.settle(folded.data)
    assert angles(live, folded) == pytest.approx([45.0, 30.0], abs=2.0)
    found = sides(live, folded)[1]
    high.signed = True
    high.angle = np.radians(30.0 if found == "M" else -30.0)
    live.settle(folded.data)
    assert sides(live, folded)[1] == other(found)
    assert angles(live, folded)[1] == pytest.approx(30.0, abs=2.0)
    assert rests(live, folded)


def test_an_angle_alone_folds_a_flat_sheet(paper, live):
    low = creases(paper)["Bottom"]
    low.use_angle, low.signed, low.angle = True, True, np.radians(-40.0)
    live.settle(paper.data)
    assert angles(live, paper)[0] == pytest.approx(40.0, abs=2.0)
    assert sides(live, paper)[0] == "M"


# --- what cannot be had ---------------------------------------------------------------------------------------


def test_a_side_against_its_signed_angle_is_refused_in_words(folded, live):
    low, high = creases(folded)
    low.use_angle, low.signed, low.angle = True, True, np.radians(30.0)
    low.side = "M"
    high.use_angle, high.angle = True, np.radians(20.0)
    live.settle(folded.data)
    report = live.report(folded.data)
    assert report.state == "trouble"
    assert report.sentence == "Bottom is to be a mountain, which has no angle of 30°"
    assert report.lacks[0] == report.sentence
    assert report.creases[1].fold_angle == pytest.approx(20.0, abs=2.0), "the others act"
    low.side = "V"
    live.settle(folded.data)
    assert live.report(folded.data).state == "settled"


def test_what_the_paper_cannot_have_is_said_with_the_name_of_the_crease(paper, live):
    low = creases(paper)["Bottom"]
    low.use_angle, low.angle = True, np.pi
    live.settle(paper.data)
    report = live.report(paper.data)
    assert report.state == "trouble"
    assert report.sentence.startswith("Bottom came to ")
    assert "crease 1" not in report.sentence


# --- undo, copies, files, animation ---------------------------------------------------------------------------


def test_undo_brings_back_sides_and_shape(folded, live):
    before = shape(folded.data)
    name = folded.name
    bpy.ops.ed.undo_push(message="folded")
    bpy.ops.curvefold.flip_crease("EXEC_DEFAULT", True, index=1)
    after = shape(folded.data)
    assert after != before
    bpy.ops.ed.undo()
    paper = bpy.data.objects[name]
    assert creases(paper)[1].side == "U"
    assert shape(paper.data) == before
    assert rests(live, paper)
    bpy.ops.ed.redo()
    paper = bpy.data.objects[name]
    assert creases(paper)[1].side in ("V", "M")
    assert shape(paper.data) == after
    assert rests(live, paper)


def test_copies_and_files_keep_what_is_said(folded, live, tmp_path):
    low, high = creases(folded)
    low.amount, high.use_angle, high.angle = 60.0, True, np.radians(25.0)
    live.settle(folded.data)
    twin = folded.copy()
    twin.data = folded.data.copy()
    bpy.context.collection.objects.link(twin)
    assert rests(live, twin)
    creases(twin)[0].amount = 100.0
    live.settle(twin.data)
    assert shape(twin.data) != shape(folded.data)
    path = str(tmp_path / "kept.blend")
    before, name = shape(folded.data), folded.name
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    paper = bpy.data.objects[name]
    assert creases(paper)[0].amount == pytest.approx(60.0)
    assert shape(paper.data) == before
    assert rests(live, paper)
    creases(paper)[1].angle = np.radians(35.0)
    live.settle(paper.data)
    assert angles(live, paper)[1] == pytest.approx(35.0, abs=2.0)


def test_keyframed_amounts_and_angles_play_the_same_each_time(folded, live):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    low, high = creases(folded)
    high.use_angle = True
    for frame, amount, angle in ((1, 100.0, 20.0), (4, 60.0, 30.0)):
        low.amount, high.angle = amount, np.radians(angle)
        low.keyframe_insert("amount", frame=frame)
        high.keyframe_insert("angle", frame=frame)

    def play():
        shapes = []
        for frame in range(1, 5):
            scene.frame_set(frame)
            shapes.append(shape(folded.data))
        return shapes

    first = play()
    assert len(set(first)) == 4
    scene.frame_set(3)
    assert play() == first
    live.forget()
    assert play() == first
    scene.frame_set(1)
    assert angles(live, folded) == pytest.approx([45.0, 20.0], abs=2.0)


# --- weights --------------------------------------------------------------------------------------------------


def test_weights_are_the_solvers_until_they_are_changed(folded, extension, live):
    solver = extension("solver")
    assert live.session(folded.data).inputs.weights == solver.Weights()
    before = shape(folded.data)
    folded.data.curvefold.weights.fold_angle = 0.0
    live.settle(folded.data)
    assert shape(folded.data) != before
    assert rests(live, folded)
    live.forget()
    assert rests(live, folded)
    assert bpy.ops.curvefold.usual_weights() == {"FINISHED"}
    assert live.session(folded.data).inputs.weights == solver.Weights()


# --- picking --------------------------------------------------------------------------------------------------


def test_a_ray_picks_the_crease_nearest_to_where_it_meets_the_paper(extension, folded, live):
    clicks = extension("curvefold_addon.operators.click_on_crease")
    picking = extension("curvefold_addon.operators.pick_crease")
    picked = []
    for y in (0.045, -0.045):
        origin = Vector(live.session(folded.data).place_of((0.0, y))) + Vector((0, 0, 1))
        point = clicks.crease_along(folded, clicks.MouseRay(origin, Vector((0, 0, -1))))
        picking.PickCrease.clicked(None, folded, point)
        picked.append(creases(folded)[folded.data.curvefold.active_crease].name)
    assert picked == ["Bottom", "Top"]


# --- from the command line ------------------------------------------------------------------------------------


def test_the_controls_of_a_finished_fold_are_settings_of_its_paper(extension, live, tmp_path):
    solver = extension("solver")
    path = tmp_path / "arcs.svg"
    path.write_text(ARCS)
    told = (
        solver.Amount(1, 0.5),
        solver.Side("Bottom", "M"),
        solver.Angle(-20.0, crease="Top", signed=True),
        solver.Angle(-25.0, at=(50.0, 25.0), signed=True, strength=2.0),
        solver.Pair((0.0, 0.0), (100.0, 0.0), distance=99.0),
        solver.Pair((0.0, 100.0), (100.0, 100.0), axes=(False, False, True)),
    )
    weights = solver.Weights(sides=50.0)
    description = solver.FoldDescription(resolution=12, angle=30.0, controls=told, weights=weights)
    result = solver.fold(solver.read_pattern(path), description)
    paper = extension("curvefold_addon.bridge.mesh").add_paper(result, bpy.context.collection, None)
    extension("curvefold_addon.bridge.papers").keep(paper, result)
    assert rests(live, paper)
    again = live.session(paper.data).inputs
    bottom, top = creases(paper)
    assert (bottom.side, bottom.amount, top.signed) == ("M", 50.0, True)
    assert np.degrees(top.angle) == pytest.approx(-20.0)
    (angle,) = paper.data.curvefold.angles
    assert (angle.name, angle.signed, angle.strength) == ("Angle 1", True, 2.0)
    assert (*angle.at, np.degrees(angle.angle)) == pytest.approx((0.05, 0.025, -25.0))
    assert [joint.relation for joint in paper.data.curvefold.joints] == ["DISTANCE", "SHARE"]
    assert again.weights == weights
    pair = next(control for control in again.controls if control.kind == "pair")
    assert (pair.second[0], pair.distance) == pytest.approx((0.1, 0.099))
    assert {control.kind for control in again.controls} == {"amount", "side", "angle", "pair"}
