"""What is said of a paper that is told much, and what a .blend keeps of folds made without Blender."""

import bpy
import numpy as np
import pytest
from papers import paper_of, rests

BEGIN = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
BEGIN += '<rect x="0" y="0" width="100" height="100" fill="none" stroke="black"/>'
ARC = '<path id="Low" d="M 0 55 Q 50 25 100 55" fill="none" stroke="#f0f"/>'
TWO = '<path id="A" d="M 0 35 Q 50 15 100 35" fill="none" stroke="#f0f"/>'
TWO += '<path id="B" d="M 0 75 Q 50 55 100 75" fill="none" stroke="#f0f"/>'
RING = '<circle id="Ring" cx="30" cy="30" r="14" fill="none" stroke="#f0f"/>'
RING += '<path id="C" d="M 60 0 Q 75 50 60 100" fill="none" stroke="#f0f"/>'


@pytest.fixture
def made(extension, tmp_path):
    def make(creases: str):
        return paper_of(extension, tmp_path, f"{BEGIN}{creases}</svg>", resolution=12)

    return make


@pytest.fixture
def kept(extension, tmp_path):
    """A fold made without Blender, as a live paper."""

    def keep(*controls, angle):
        solver = extension("solver")
        path = tmp_path / "kept.svg"
        path.write_text(f"{BEGIN}{ARC}</svg>")
        description = solver.FoldDescription(resolution=12, angle=angle, controls=controls)
        result = solver.fold(solver.read_pattern(path), description)
        paper = extension("curvefold_addon.bridge.mesh").add_paper(result, bpy.context.collection, None)
        extension("curvefold_addon.bridge.papers").keep(paper, result)
        return paper, result

    return keep


def said(live, paper) -> tuple[str, str]:
    live.settle(paper.data)
    report = live.report(paper.data)
    return report.state, report.sentence


def test_a_sheet_that_is_led_back_to_flat_lies_tilted_and_is_flat(made, live):
    paper = made(TWO)
    paper.data.curvefold.fold = 70.0
    live.settle(paper.data)
    paper.data.curvefold.fold = 0.0
    assert said(live, paper) == ("settled", "Flat")
    found = live.session(paper.data)
    assert np.ptp(found.positions[:, 2]) > 0.05 * found.net.frame.unit, "it does not lie level"


def test_how_deep_the_slider_leads_is_an_answer_and_no_trouble(made, live):
    paper = made(RING)
    settings = paper.data.curvefold
    settings.angle, settings.fold = np.radians(120.0), 100.0
    state, sentence = said(live, paper)
    assert state == "settled"
    report = live.report(paper.data)
    angle = report.creases[[c.name for c in settings.creases].index("Ring")].fold_angle
    assert angle < 90
    assert sentence == (
        f"The creases came to {report.fold_angle:.0f}° of the 120° asked in the median, the least of them, Ring, "
        f"to {angle:.0f}°: the sheet allows no more without stretching"
    )
    assert live.report(paper.data).lacks == ()


def test_a_paper_that_was_opened_says_how_deep_it_is(made, live, tmp_path):
    paper = made('<circle id="Ring" cx="50" cy="50" r="30" fill="none" stroke="#f0f"/>')
    paper.data.curvefold.angle, paper.data.curvefold.fold = np.radians(120.0), 100.0
    live.settle(paper.data)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "deep.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "deep.blend"))
    paper = next(o for o in bpy.data.objects if o.type == "MESH")
    live.settle(paper.data)
    report = live.report(paper.data)
    assert report.state == "settled"
    assert report.sentence == f"Settled at {report.fold_angle:.0f}° of 120°"


def test_a_crease_that_is_to_stay_flat_is_as_deep_as_asked(made, live):
    paper = made(TWO)
    paper.data.curvefold.fold = 60.0
    paper.data.curvefold.creases[0].amount = 0.0
    assert said(live, paper) == ("settled", "Settled")


def test_an_own_angle_that_is_not_reached_stays_trouble_and_names_what_holds_it(made, live):
    paper = made(ARC)
    settings = paper.data.curvefold
    joint = settings.joints.add()
    joint.name, joint.family, joint.first = "Patch 1", "PATCH", (0.0, 0.04)
    crease = settings.creases[0]
    crease.use_angle, crease.angle = True, np.radians(60.0)
    state, sentence = said(live, paper)
    assert state == "trouble"
    assert sentence.startswith("Low came to ")
    assert sentence.endswith("60° were asked: the patch at (0, 0.04), which is kept flat, holds it")


def test_the_angle_of_a_point_against_a_side_is_refused_in_words(made, live):
    paper = made(ARC)
    settings = paper.data.curvefold
    angle = settings.angles.add()
    angle.name, angle.at, angle.angle, angle.signed = "Angle 1", (0.0, 0.01), -np.radians(40.0), True
    settings.creases[0].side = "V"
    assert said(live, paper) == ("trouble", "Angle 1: Low is to be a valley, which has no angle of -40°")


def test_a_crease_with_a_flow_is_flipped(made, live):
    paper = made(ARC)
    crease = paper.data.curvefold.creases[0]
    crease.flow, crease.curvature_times = "SHAPE", 1.3
    live.settle(paper.data)
    (before,) = live.report(paper.data).creases
    assert bpy.ops.curvefold.flip_crease(index=0) == {"FINISHED"}
    assert said(live, paper) == ("settled", "Settled")
    (after,) = live.report(paper.data).creases
    assert {before.found, after.found} == {"M", "V"}
    assert (after.progress, after.fold_angle) == (1.0, pytest.approx(before.fold_angle, abs=1.0))


# --- from without Blender --------------------------------------------------------------------------------------


def angle_after_a_touch(live, paper) -> float:
    """Folded on from nothing but what the .blend says."""
    live.forget()
    paper.data.curvefold.weights.bending = 1.01
    assert said(live, paper) == ("settled", "Settled")
    return live.report(paper.data).creases[0].fold_angle


def test_an_amount_over_the_whole_is_kept(kept, extension, live):
    paper, _ = kept(extension("solver").Amount(1, 1.5), angle=40.0)
    assert rests(live, paper)
    assert paper.data.curvefold.creases[0].amount == 150.0
    assert angle_after_a_touch(live, paper) == pytest.approx(60.0, abs=1.0)


def test_a_curve_by_points_becomes_a_curve_object_that_rides_on_the_paper(kept, extension, live):
    points = tuple((50 + 60 * np.sin(t), 0.0, 50 - 60 * np.cos(t)) for t in np.linspace(-1, 1, 9))
    curve = extension("solver").Curve(1, points=points, strength=2.0, speed=0.5)
    paper, result = kept(curve, angle=None)
    entry = paper.data.curvefold.creases[0]
    assert (entry.flow, entry.flow_strength, entry.flow_speed) == ("OBJECT", 2.0, 0.5)
    assert (entry.curve.name, entry.curve.parent) == ("Low Target", paper)
    assert rests(live, paper)
    paper.location.x += 0.3
    bpy.context.view_layer.update()
    assert rests(live, paper), "it goes along"
    before = np.nanmedian(result.measurement.fold_angle)
    assert angle_after_a_touch(live, paper) == pytest.approx(before, abs=1.5)
