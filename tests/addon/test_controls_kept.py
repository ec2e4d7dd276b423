"""Every control goes through undo, redo and a file with its settings and its shape; contradictions are answered."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from papers import paper_of, rests, shape

#: A strip whose ends are as long as each other, with two arcs.
STRIP = """<svg xmlns="http://www.w3.org/2000/svg" width="120mm" height="40mm" viewBox="0 0 120 40">
<rect x="0" y="0" width="120" height="40" fill="none" stroke="black"/>
<path id="Low" d="M 0 28 Q 60 40 120 28" fill="none" stroke="#f0f"/>
<path id="High" d="M 0 8 Q 60 20 120 8" fill="none" stroke="#f0f"/>
</svg>
"""


@pytest.fixture
def strip(extension, live, tmp_path):
    """A paper with two creases, folded."""
    made = paper_of(extension, tmp_path, STRIP, resolution=18, fold=40.0)
    live.settle(made.data)
    return made


def joint(settings, family: str, **values: object) -> None:
    entry = settings.joints.add()
    entry.name, entry.family = family.capitalize(), family
    for name, value in values.items():
        setattr(entry, name, value)


def _side(settings) -> None:
    settings.creases[0].side = "M" if _found(settings)[0] == "V" else "V"


def _found(settings) -> list[str]:
    return list(bpy.context.scene["found"])


def _amount(settings) -> None:
    settings.creases[1].amount = 40.0


def _own_angle(settings) -> None:
    crease = settings.creases[0]
    crease.use_angle, crease.signed = True, True
    crease.angle = np.radians(20.0 if _found(settings)[0] == "V" else -20.0)


def _point_angle(settings) -> None:
    entry = settings.angles.add()
    entry.name, entry.at, entry.angle, entry.strength = "Angle 1", (0.0, -0.014), np.radians(20.0), 2.0


def _flow(settings) -> None:
    crease = settings.creases[0]
    crease.flow, crease.curvature_times, crease.flow_speed, crease.progress = "SHAPE", 1.25, 2.0, 80.0


def _distance(settings) -> None:
    joint(settings, "POINTS", first=(-0.06, 0.02), second=(0.06, 0.02), relation="DISTANCE", distance=0.112)


def _shared(settings) -> None:
    axes = (False, False, True)
    joint(settings, "POINTS", first=(0.0, 0.02), second=(0.0, -0.02), relation="SHARE", axes=axes, strength=3.0)


def _patch(settings) -> None:
    joint(settings, "PATCH", first=(0.0, 0.015), shape="FLAT")


def _seam(settings) -> None:
    ends = {"first": (-0.06, -0.02), "second": (-0.06, 0.02), "third": (0.06, -0.02), "fourth": (0.06, 0.02)}
    joint(settings, "BORDERS", bending=False, **ends)
    settings.fold = 0.0


def _weights(settings) -> None:
    settings.weights.fold_angle *= 0.01


def _slider(settings) -> None:
    settings.fold = 70.0


CONTROLS = {
    function.__name__[1:]: function
    for function in (
        _side,
        _amount,
        _own_angle,
        _point_angle,
        _flow,
        _distance,
        _shared,
        _patch,
        _seam,
        _weights,
        _slider,
    )
}


def told(item: bpy.types.bpy_struct) -> dict[str, object]:
    """All that settings say, entries and all."""
    result: dict[str, object] = {}
    for entry in item.bl_rna.properties:
        value = getattr(item, entry.identifier)
        if entry.type == "COLLECTION":
            result[entry.identifier] = [told(part) for part in value]
        elif entry.type == "POINTER" and entry.identifier == "weights":
            result[entry.identifier] = told(value)
        elif entry.type != "POINTER":
            result[entry.identifier] = tuple(value) if getattr(entry, "is_array", False) else value
    return result


@pytest.mark.parametrize("change", CONTROLS.values(), ids=CONTROLS.keys())
def test_undo_redo_and_files_keep_a_control_and_its_shape(
    strip, live, tmp_path, change: Callable[[bpy.types.bpy_struct], None]
):
    name, before, said_before = strip.name, shape(strip.data), told(strip.data.curvefold)
    bpy.context.scene["found"] = [crease.found for crease in live.report(strip.data).creases]
    bpy.ops.ed.undo_push(message="before")
    change(strip.data.curvefold)
    live.settle(strip.data)
    bpy.ops.ed.undo_push(message="after")
    after, said = shape(strip.data), told(strip.data.curvefold)
    assert after != before
    assert said != said_before

    bpy.ops.ed.undo()
    paper = bpy.data.objects[name]
    assert told(paper.data.curvefold) == said_before
    assert shape(paper.data) == before
    assert rests(live, paper)
    bpy.ops.ed.redo()
    paper = bpy.data.objects[name]
    assert told(paper.data.curvefold) == said
    assert shape(paper.data) == after
    assert rests(live, paper)

    path = str(tmp_path / "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    paper = bpy.data.objects[name]
    assert told(paper.data.curvefold) == said
    assert shape(paper.data) == after
    assert rests(live, paper)


# --- what cannot be had together --------------------------------------------------------------------------------


def answered(live, paper) -> str:
    """What is said about a paper that cannot have all it is asked for; its shape is none the worse for it."""
    live.settle(paper.data)
    report = live.report(paper.data)
    assert report.state == "trouble"
    assert np.isfinite(live.session(paper.data).positions).all()
    assert report.stretch_mean < 0.02
    return " / ".join(report.lacks)


def test_angles_that_no_surface_has(strip, live):
    """A crease is folded flat on itself, but for one point, where it is not folded at all."""
    strip.data.curvefold.fold = 0.0
    crease = strip.data.curvefold.creases["Low"]
    crease.use_angle, crease.angle = True, np.pi
    point = strip.data.curvefold.angles.add()
    point.name, point.at, point.angle = "Angle 1", (0.0, -0.014), 0.0
    said = answered(live, strip)
    assert "were asked: the sheet allows no more without stretching" in said


def test_a_crease_kept_flat_by_its_patch_against_its_own_angle(strip, live):
    _patch(strip.data.curvefold)
    crease = strip.data.curvefold.creases["High"]
    crease.use_angle, crease.angle = True, np.radians(80.0)
    assert "High came to " in answered(live, strip)


def test_a_point_drawn_to_two_distances(strip, live):
    settings = strip.data.curvefold
    for distance in (0.115, 0.09):
        joint(settings, "POINTS", first=(-0.06, 0.0), second=(0.06, 0.0), relation="DISTANCE", distance=distance)
    said = answered(live, strip)
    assert "stay" in said
    assert "apart where" in said


def test_a_flow_against_the_own_angle_of_its_crease(strip, live):
    crease = strip.data.curvefold.creases["Low"]
    crease.flow, crease.curvature_times = "SHAPE", 1.5
    crease.use_angle, crease.angle = True, np.radians(5.0)
    assert "Low" in answered(live, strip)


def test_sides_that_handles_contradict_are_named(strip, live):
    """Pins hold the paper where it is folded, the creases are told the other sides."""
    settings = strip.data.curvefold
    found = live.session(strip.data)
    for at in np.mgrid[-0.055:0.056:0.022, -0.018:0.0181:0.009].reshape(2, -1).T.tolist():
        handle = settings.handles.add()
        handle.at, handle.offset, handle.pinned = at, found.place_of(tuple(handle.at)), True
        handle.strength = 4.0
    for crease, report in zip(settings.creases, live.report(strip.data).creases, strict=True):
        crease.side = {"V": "M", "M": "V"}[report.found]
    settings.fold = 0.0
    said = answered(live, strip)
    assert "Low" in said
    assert "High" in said
    report = live.report(strip.data)
    assert report.sentence.startswith("Handle ")
    assert report.sentence.endswith("from its target: out of reach")
