"""What is said where not all that was asked came true, and how controls are written."""

from __future__ import annotations

import io
import json
import re
from dataclasses import fields
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from settling import settled

import solver
from solver.command_line import main
from solver.controls.amount import Amount
from solver.controls.angle import Angle
from solver.controls.control import Control
from solver.controls.curve import Curve
from solver.controls.glue import Glue
from solver.controls.keep import Keep
from solver.controls.pair import Pair
from solver.controls.pull import Lack
from solver.controls.registry import BY_NAME, controls_from_json
from solver.controls.side import Side

ROOT = Path(__file__).resolve().parents[2]


def medians(m: solver.Measurement) -> list[float]:
    return [float(np.nanmedian(m.fold_angle[m.crease == k])) for k in range(int(m.crease.max()) + 1)]


def ring_and_arcs(drawings: ModuleType) -> solver.CreasePattern:
    """A circle beside two arcs, which can be folded as deep as one likes."""
    t = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    ring = solver.Crease(points=np.column_stack([0.3 + 0.14 * np.cos(t), 0.3 + 0.14 * np.sin(t)]), closed=True)
    y = np.linspace(0, 1, 33)
    arcs = [solver.Crease(points=np.column_stack([at + 0.3 * y * (1 - y), y])) for at in (0.6, 0.78)]
    return drawings.square_with(ring, *arcs)


# --- as deep as the sheet allows -----------------------------------------------------------------------------


def test_one_crease_that_stays_below_the_others_is_no_fault(drawings: ModuleType) -> None:
    """The angle is that of the median; a ring finds its own."""
    result = solver.fold(ring_and_arcs(drawings), solver.FoldDescription(resolution=16, angle=90.0))
    assert medians(result.measurement)[0] < 70
    assert np.nanmedian(result.measurement.fold_angle) == pytest.approx(90.0, abs=2.0)
    assert result.status.ok, result.detail


def test_a_median_that_stays_below_is_said_and_its_least_crease_named(drawings: ModuleType) -> None:
    t = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rings = [
        solver.Crease(points=np.column_stack([x + 0.14 * np.cos(t), 0.5 + 0.14 * np.sin(t)]), closed=True)
        for x in (0.25, 0.75)
    ]
    result = solver.fold(drawings.square_with(*rings), solver.FoldDescription(resolution=14, angle=120.0))
    assert result.status is solver.Outcome.SHALLOW
    angles = medians(result.measurement)
    least = int(np.argmin(angles))
    assert result.detail == (
        f"the creases came to {np.nanmedian(result.measurement.fold_angle):.0f}° of the 120° asked in the median, "
        f"the least of them, crease {least + 1}, to {angles[least]:.0f}°: "
        "the sheet allows no more without stretching"
    )
    assert [finding.lack for finding in result.findings] == [Lack.DEPTH]


def test_what_an_amount_asks_for_is_measured_by_the_amount(drawings: ModuleType) -> None:
    """A circle that is asked for all of 150 degrees misses them, whatever word they come by."""
    told = solver.FoldDescription(resolution=12, angle=150.0, controls=(Amount(1, 1.0),))
    assert solver.fold(drawings.closed_circle(), told).status is solver.Outcome.SHALLOW
    half = solver.FoldDescription(resolution=12, angle=80.0, controls=(Amount(1, 0.5),))
    result = solver.fold(drawings.one_arc(), half)
    assert result.status.ok, result.detail
    assert medians(result.measurement) == pytest.approx([40.0], rel=0.03)


@pytest.mark.parametrize(("sample", "resolution"), [("annulus", 32), ("hairpin", 24), ("loop", 32)])
def test_a_sample_that_comes_to_most_of_its_angle_is_folded(sample: str, resolution: int) -> None:
    pattern = solver.read_pattern(ROOT / "sample_patterns" / f"{sample}.svg")
    result = solver.fold(pattern, solver.FoldDescription(resolution=resolution, angle=60.0))
    assert result.status.ok, result.detail


# --- what else holds a crease --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("controls", "angle", "why"),
    [
        (
            [Keep((0.5, 0.05)), Angle(60.0, crease=1)],
            None,
            "the patch at (0.5, 0.05), which is kept flat, holds it",
        ),
        ([Keep((0.5, 0.05))], 60.0, "the patch at (0.5, 0.05), which is kept flat, holds it"),
    ],
)
def test_an_angle_that_another_control_holds_names_it(
    drawings: ModuleType, controls: list[Control], angle: float | None, why: str
) -> None:
    told = solver.FoldDescription(resolution=12, angle=angle, controls=tuple(controls))
    result = solver.fold(drawings.one_arc(), told)
    assert not result.status.ok
    about = [finding.sentence for finding in result.findings if finding.sentence.startswith("crease 1 came to")]
    assert about
    assert about[0].endswith(f": {why}")


@pytest.mark.parametrize(
    "angle", [Angle(20.0, crease=1), Angle(5.0, at=(0.5, 0.6))], ids=["along it", "at a point"]
)
def test_an_angle_and_a_curve_that_one_crease_cannot_have_name_each_other(
    drawings: ModuleType, angle: Angle
) -> None:
    told = solver.FoldDescription(resolution=12, angle=None, controls=(Curve(1, curvature_times=1.5), angle))
    result = solver.fold(drawings.one_arc(), told)
    assert not result.status.ok
    said = "\n".join(finding.sentence for finding in result.findings)
    asked = f"{angle.degrees:g}°"
    assert re.search(f"crease 1 came to .* where {asked} were asked: the curve that it was given holds it", said)
    # Where the angle is stronger, it is named instead.
    model = solver.FoldModel(result.net)
    model.set_controls(told.controls)
    (flow,) = [finding.sentence for finding in model.findings if "of the way" in finding.sentence]
    assert flow.endswith(f"the curve that it was given: the angle of {asked} that it was given holds it")


def test_a_crease_on_another_patch_is_not_held_by_it(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
    model.set_controls([Keep((0.5, 0.02)), Angle(175.0, crease=2), Angle(150.0, crease=1)])
    settled(model)
    first = [f.sentence for f in model.findings if f.sentence.startswith("crease 1 came")]
    second = [f.sentence for f in model.findings if f.sentence.startswith("crease 2 came")]
    assert all(sentence.endswith("holds it") for sentence in first)
    assert first
    assert all("allows no more" in sentence for sentence in second)


def test_pinned_handles_are_no_fault_of_the_sheet(drawings: ModuleType) -> None:
    places = [(x, y) for x in np.linspace(0, 1, 5).tolist() for y in np.linspace(0, 1, 5).tolist()]
    pins = tuple(solver.Handle(at=at, target=(*at, 0.0), strength=50.0) for at in places)
    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=10, angle=60.0, handles=pins))
    (finding,) = [f for f in result.findings if f.lack is Lack.DEPTH]
    assert "with its handles where they are, the sheet allows no more" in finding.sentence


def test_a_point_with_a_signed_angle_against_the_side_of_its_crease_names_the_side(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
    with pytest.raises(solver.DescriptionError) as caught:
        model.set_controls([Side(1, "V"), Angle(-40.0, at=(0.5, 0.35), signed=True)])
    assert str(caught.value) == "control 2 (angle): crease 1 is to be a valley, which has no angle of -40°"
    model.set_controls([Side(2, "V"), Angle(-40.0, at=(0.5, 0.35), signed=True)])
    with pytest.raises(solver.DescriptionError, match="no crease near this point"):
        model.set_controls([Side(1, "V"), Angle(-40.0, at=(0.5, 0.95), signed=True)])


# --- flows ---------------------------------------------------------------------------------------------------


def test_a_flow_that_tears_the_paper_is_given_up_in_time_and_says_how_far_it_came(drawings: ModuleType) -> None:
    told = solver.FoldDescription(resolution=12, angle=None, controls=(Curve(1, torsion_plus=10.0),))
    result = solver.fold(drawings.one_arc(), told)
    assert result.last.status is solver.Status.SETTLED
    assert result.iterations < told.max_iterations
    assert result.status is solver.Outcome.OUT_OF_REACH
    (part,) = re.findall(r"crease 1 came (\d+)% of the way to the curve that it was given", result.detail)
    assert 10 < int(part) < 90
    # It rests at the last good place, whole.
    assert result.measurement.stretch.mean() < 0.003
    assert result.last.constraint < 1e-6


def test_a_curve_that_stops_on_its_way_tells_no_distance_to_it(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 10))
    model.set_controls([Curve(1, curvature_times=1.5)])
    model.advance(10)
    gone = model.flow_progress[0]
    assert 0 < gone < 1
    assert [f.sentence for f in model.findings] == [
        f"crease 1 came {gone:.0%} of the way to the curve that it was given"
    ]


@pytest.mark.parametrize(
    "curve",
    [
        Curve(1, curvature_times=1.3, from_flat=True),
        Curve(1, curvature_times=2.0),
        Curve(1, points=tuple((0.5 + 0.6 * np.sin(t), 0.0, -0.6 * np.cos(t)) for t in np.linspace(-1, 1, 40))),
    ],
    ids=["from flat", "from where it is", "in space"],
)
def test_a_crease_with_a_flow_flips_and_flows_on(drawings: ModuleType, curve: Curve) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 12))
    model.set_controls([curve])
    before = medians(settled(model))
    (side,) = model.found_assignments
    model.set_controls([curve, Side(1, "M" if side == "V" else "V")])
    m = settled(model)
    assert model.found_assignments == ("M" if side == "V" else "V",)
    assert model.findings == ()
    assert model.flow_progress == {0: 1.0}
    assert medians(m) == pytest.approx(before, abs=1.0)
    assert m.folded.all()


# --- points and borders --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("axes", "words"), [((True, False, False), "apart along X where"), ((True, True, False), "along X and Y where")]
)
def test_points_that_do_not_share_a_coordinate_are_told_along_it(
    drawings: ModuleType, axes: tuple[bool, bool, bool], words: str
) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 8))
    model.set_controls([Pair((0.0, 0.0), (1.0, 1.0), axes=axes)])
    (finding,) = model.findings
    assert words in finding.sentence
    assert "meet" not in finding.sentence


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (((0, 0), (0, 1)), ((0, 0), (0, 1))),
        (((0, 0), (0.6, 0)), ((0.4, 0), (1, 0))),
    ],
)
def test_a_border_is_not_glued_to_itself(
    drawings: ModuleType, first: tuple[tuple[float, float], ...], second: tuple[tuple[float, float], ...]
) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 8))
    with pytest.raises(solver.DescriptionError, match="the borders to be glued overlap"):
        model.set_controls([Glue(first, second)])
    # Those that touch in a corner can be.
    model.set_controls([Glue(((0, 0), (1, 0)), ((0, 0), (0, 1)))])


# --- weights -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("weights", "controls", "angle"),
    [
        (solver.Weights(drive=0.0), (), 50.0),
        (solver.Weights(fold_angle=0.0), (Angle(50.0, crease=1),), None),
        (solver.Weights(curves=0.0), (Curve(1, curvature_times=1.3),), None),
        (solver.Weights(pairs=0.0), (Pair((0.0, 0.0), (1.0, 0.0), distance=0.8),), None),
        (solver.Weights(pairs=0.0), (Glue(((0, 0), (0, 1)), ((1, 0), (1, 1))),), None),
        (solver.Weights(sides=0.0), (Side(1, "V"),), None),
    ],
)
def test_what_has_no_weight_leaves_a_flat_sheet_at_rest(
    drawings: ModuleType, weights: solver.Weights, controls: tuple[Control, ...], angle: float | None
) -> None:
    told = solver.FoldDescription(resolution=8, angle=angle, controls=controls, weights=weights)
    result = solver.fold(drawings.one_arc(), told)
    assert result.last.status is solver.Status.SETTLED
    assert np.ptp(result.positions[:, 2]) == 0.0


def test_a_weight_beyond_all_bounds_is_refused_by_its_name() -> None:
    with pytest.raises(solver.DescriptionError, match="isometry: a weight must be a number from 0 to 1e"):
        solver.Weights(isometry=1e30)


def test_a_terminal_is_told_the_sides_that_were_found(drawings: ModuleType) -> None:
    told = solver.FoldDescription(resolution=8, angle=30.0, controls=(Side(1, "V"), Side(2, "M")))
    assert "crease 1 valley, crease 2 mountain" in solver.fold(drawings.two_arcs(), told).summary().splitlines()


# --- how they are written ------------------------------------------------------------------------------------


def documented() -> list[str]:
    """The examples of controls in docs/method.md."""
    text = (ROOT / "docs" / "method.md").read_text(encoding="utf-8")
    section = text.partition("\n## Controls\n")[2].partition("\n## ")[0]
    return re.findall(r"^\| `\w+` \|.*\| `(\{.*\})` \|$", section, re.MULTILINE)


def test_every_kind_of_control_is_documented_with_its_keys_and_an_example() -> None:
    text = (ROOT / "docs" / "method.md").read_text(encoding="utf-8")
    examples = [json.loads(example) for example in documented()]
    assert sorted(example["kind"] for example in examples) == sorted(BY_NAME)
    for example in examples:
        (row,) = [line for line in text.splitlines() if line.startswith(f"| `{example['kind']}` |") and "{" in line]
        keys = set(re.findall(r"`(\w+)`", row.rpartition("| `{")[0])) - {example["kind"], "points"}
        known = {field.name for field in fields(BY_NAME[example["kind"]])}
        assert known - {"points"} - keys <= {example["kind"]}, "a setting without a word"
        assert keys <= known, "a word for no setting"


@pytest.mark.parametrize("example", documented(), ids=lambda text: json.loads(text)["kind"])
def test_documented_controls_fold(drawings: ModuleType, example: str) -> None:
    lower, upper = drawings.two_arcs().creases
    pattern = drawings.square_with(lower, solver.Crease(points=upper.points, name="upper"))
    controls = controls_from_json([json.loads(example)])
    alone = controls[0].kind in ("angle", "curve", "pair", "glue")
    told = solver.FoldDescription(resolution=10, angle=None if alone else 8.0, controls=controls)
    result = solver.fold(pattern, told)
    assert result.last.status is solver.Status.SETTLED
    assert not [f.sentence for f in result.findings if f.lack is not Lack.DEPTH]


def test_handles_in_a_description_need_no_drive(tmp_path: Path) -> None:
    handles = [{"at": [0, 0], "target": [0, 0, 0]}]
    assert solver.FoldDescription.from_json({"handles": handles}).angle is None
    assert solver.FoldDescription.from_json({"handles": handles, "angle": 30.0}).angle == 30.0
    assert solver.FoldDescription.from_json({}).angle == 60.0
    (tmp_path / "told.json").write_text(json.dumps({"resolution": 6, "handles": handles}), encoding="utf-8")
    drawing, out = ROOT / "sample_patterns" / "one_arc.svg", tmp_path / "out"
    main(["fold", str(drawing), "--out", str(out), "--description", str(tmp_path / "told.json")], io.StringIO())
    assert json.loads((out / "report.json").read_text(encoding="utf-8"))["description"]["angle"] is None
