"""Controls as data, and what they cost: values, structure, errors in words, a way that turns back."""

from __future__ import annotations

import io
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import solver
from solver.command_line import main
from solver.controls.amount import Amount
from solver.controls.angle import Angle
from solver.controls.control import Control
from solver.controls.curve import Curve
from solver.controls.glue import Glue
from solver.controls.keep import Keep
from solver.controls.pair import Pair
from solver.controls.registry import BY_NAME
from solver.controls.side import Side

ROOT = Path(__file__).resolve().parents[2]
#: One of each kind and every optional setting.
CONTROLS: tuple[Control, ...] = (
    Amount("upper", 0.25),
    Side(2, "M"),
    Angle(-33.5, crease=1, signed=True, strength=2.0),
    Angle(20.0, at=(0.5, 0.35)),
    Pair((0.1, 0.2), (0.9, 0.2), axes=(False, True, False)),
    Pair((0.0, 0.0), (1.0, 0.0), distance=0.75, strength=3.0),
    Keep((0.5, 0.9), shape="rigid"),
    Curve(1, curvature_times=1.2, torsion_plus=-0.5, progress=0.5, speed=2.0, from_flat=True),
    Curve("upper", points=((0.0, 0.0, 0.0), (0.5, 0.2, 0.1), (1.5, 0.0, 0.0))),
    Glue(((0.0, 0.0), (0.0, 1.0)), ((1.0, 0.0), (1.0, 1.0)), bending=False),
)


def named(drawings: ModuleType) -> solver.CreasePattern:
    lower, upper = drawings.two_arcs().creases
    return drawings.square_with(lower, solver.Crease(points=upper.points, name="upper"))


def test_every_kind_comes_back_from_json_as_it_was() -> None:
    assert {control.kind for control in CONTROLS} == set(BY_NAME)
    told = solver.FoldDescription(controls=CONTROLS)
    text = json.dumps(told.to_json(), allow_nan=False)
    assert solver.FoldDescription.from_json(json.loads(text)) == told


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        (3, "control 1: needs a 'kind'"),
        ({}, "control 1: needs a 'kind'"),
        ({"kind": "magic"}, "control 1: needs a 'kind' out of"),
        ({"kind": ["side"]}, "control 1: needs a 'kind'"),
        ({"kind": "side", "crease": 1}, "control 1 (side): 'side' needs 'side'"),
        ({"kind": "side", "crease": 1, "side": "U"}, "must be 'M' or 'V'"),
        ({"kind": "side", "crease": 1.5, "side": "M"}, "number, from 1, or its name"),
        ({"kind": "side", "crease": 1, "side": "M", "hard": True}, "'hard' is no setting"),
        ({"kind": "amount", "crease": 1, "part": -1}, "'part' must be a number from 0 to 2"),
        ({"kind": "angle", "degrees": 20}, "'crease', 'at', or both"),
        ({"kind": "angle", "degrees": -20, "crease": 1}, "from 0 to 180"),
        ({"kind": "angle", "degrees": "deep", "crease": 1}, "'degrees' must be a number"),
        ({"kind": "angle", "degrees": 20, "at": [1]}, "'at' must be 2 numbers"),
        ({"kind": "angle", "degrees": 20, "crease": 1, "strength": 0}, "positive"),
        ({"kind": "pair", "first": [0, 0], "second": [1, float("nan")]}, "'second' must be a number"),
        ({"kind": "pair", "first": [0, 0], "second": [1, 0], "axes": [False, False, False]}, "not all false"),
        ({"kind": "pair", "first": [0, 0], "second": [1, 0], "axes": 3}, "three of true and false"),
        (
            {"kind": "pair", "first": [0, 0], "second": [1, 0], "axes": [True, False, True], "distance": 1},
            "not both",
        ),
        ({"kind": "keep", "at": [0, 0], "shape": "round"}, "'flat' or 'rigid'"),
        ({"kind": "curve", "crease": 1, "progress": 1.5}, "'progress' must be a number from 0 to 1"),
        ({"kind": "curve", "crease": 1, "points": [[0, 0, 0]]}, "at least two points"),
        ({"kind": "curve", "crease": 1, "points": [[0, 0], [1, 1]]}, "3 numbers"),
        ({"kind": "glue", "first": [[0, 0]], "second": [[1, 0], [1, 1]]}, "two points"),
    ],
)
def test_a_bad_control_is_refused_by_its_number_and_setting(entry: Any, words: str) -> None:
    with pytest.raises(solver.DescriptionError) as caught:
        solver.FoldDescription.from_json({"controls": [entry]})
    assert "control 1" in str(caught.value)
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("data", [{}, "side", 3])
def test_controls_that_are_no_list_are_refused(data: Any) -> None:
    with pytest.raises(solver.DescriptionError, match="controls"):
        solver.FoldDescription.from_json({"controls": data})


@pytest.mark.parametrize(
    ("controls", "words"),
    [
        ([Side(3, "M")], "control 1 (side): there is no crease 3: the drawing has 2"),
        ([Amount("lower", 1.0)], "no crease called 'lower'"),
        ([Side(1, "V"), Side("upper", "M"), Side(1, "M")], "control 3 (side): asks crease 1 for both sides"),
        ([Amount(1, 0.5), Amount(1, 0.6)], "another amount"),
        ([Angle(20, at=(0.5, 0.95))], "no crease near this point"),
        ([Angle(20, crease=1), Angle(30, crease=1)], "control 2 (angle): asks for another angle"),
        ([Angle(-20, crease=1, signed=True), Side(1, "V")], "crease 1 is to be a valley"),
        ([Pair((0, 0), (2, 0))], "control 1 (pair) at (2, 0): the point is off the sheet"),
        ([Pair((0, 0), (1, 0), distance=1.2)], "the sheet between the points is only 1 long"),
        ([Keep((0.5, 0.0)), Keep((0.4, 0.1))], "same patch"),
        ([Keep((3, 3))], "off the sheet"),
        ([Curve(1, curvature_plus=-1.0)], "flatter in space than it is drawn"),
        ([Curve(1, points=((0, 0, 0), (0.5, 0, 0)))], "shorter than crease 1"),
        ([Curve(1, curvature_times=1.1), Curve(1, curvature_times=1.2)], "same crease"),
        ([Glue(((0, 0), (0, 1)), ((1, 0), (1, 0.5)))], "borders to be glued are 1 and 0.5 long"),
        ([Glue(((0, 0), (0, 1)), ((0.5, 0.5), (1, 1)))], "not on the border"),
        ([Glue(((0, 0), (0, 0)), ((1, 0), (1, 1)))], "the same point"),
    ],
)
def test_controls_that_do_not_fit_the_drawing_are_refused_in_words(
    drawings: ModuleType, controls: list[Control], words: str
) -> None:
    model = solver.FoldModel(solver.build_net(named(drawings), 10))
    model.set_controls([Angle(30, crease=1)])
    with pytest.raises(solver.DescriptionError) as caught:
        model.set_controls(controls)
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
    # All is as it was: only the first crease is folded.
    assert set(model.advance(1).objective) & {"angles", "pairs", "curves", "seams", "patch shapes"} == {"angles"}


def test_a_closed_crease_takes_no_curve(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.closed_circle(), 12))
    with pytest.raises(solver.DescriptionError, match="closed"):
        model.set_controls([Curve(1, curvature_times=1.1)])


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (Angle(30, crease=1), Angle(45, crease=1, strength=2.0)),
        (Side(1, "V"), Side(1, "M")),
        (Pair((0, 0), (1, 0), distance=0.8), Pair((0, 0), (1, 0), distance=0.7, strength=2.0)),
        (Keep((0.5, 0.1)), Keep((0.5, 0.1), strength=2.0)),
        (Curve(1, curvature_times=1.1), Curve(1, curvature_times=1.2, progress=0.5)),
        (Amount(1, 0.5), Amount(1, 0.6)),
    ],
    ids=lambda control: control.kind,
)
def test_other_values_keep_the_problem_and_another_structure_does_not(
    drawings: ModuleType, before: Control, after: Control
) -> None:
    model = solver.FoldModel(solver.build_net(named(drawings), 8))
    model.set_controls([before])
    model.advance(3)
    problem = model.problem
    model.set_controls([after])
    model.advance(2)
    assert model.problem is problem
    model.set_controls([after, Pair((0.2, 0.05), (0.8, 0.05))])
    model.advance(1)
    assert model.problem is not problem


def test_a_target_out_of_all_reach_turns_back_and_leaves_the_paper_whole(drawings: ModuleType) -> None:
    pattern = drawings.one_arc()
    far = solver.FoldDescription(
        resolution=10,
        angle=None,
        handles=(
            solver.Handle(at=(0, 0), target=(0, 0, 0)),
            solver.Handle(at=(1, 0), target=(1, 0, 0)),
            solver.Handle(at=(1, 1), target=(40, 40, 0.3)),
        ),
    )
    result = solver.fold(pattern, far)
    assert result.status is solver.Outcome.OUT_OF_REACH
    assert "out of reach" in result.detail
    m = solver.measure(result.net, result.positions)
    # Forty times the sheet's width away: nothing but turning back keeps it from being torn.
    assert m.stretch.mean() < 0.01
    assert np.ptp(result.positions, axis=0).max() < 1.5


def test_an_empty_list_of_controls_lets_go(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(named(drawings), 8))
    model.set_controls(CONTROLS[:3])
    assert {"mountains and valleys", "signed angles"} <= set(model.advance(2).objective)
    model.set_controls([])
    assert not {"mountains and valleys", "signed angles"} & set(model.advance(2).objective)


def test_a_description_file_goes_through_the_command_line(drawings: ModuleType, tmp_path: Path) -> None:
    told = solver.FoldDescription(resolution=8, angle=None, controls=(Angle(-40.0, crease=1, signed=True),))
    (tmp_path / "told.json").write_text(json.dumps(told.to_json()), encoding="utf-8")
    drawing = ROOT / "sample_patterns" / "one_arc.svg"
    stream = io.StringIO()
    arguments = ["fold", str(drawing), "--out", str(tmp_path / "out"), "--description", str(tmp_path / "told.json")]
    assert main(arguments, stream) == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert solver.FoldDescription.from_json(report["description"]) == told
    assert report["creases"][0]["found"] == "M"
    assert report["findings"] == []
    # Options go before the file.
    assert main([*arguments, "--resolution", "9"], stream) == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["description"]["resolution"] == 9
    assert solver.FoldDescription.from_json(report["description"]).controls == told.controls


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ('{"controls": [{"kind": "side", "crease": 7, "side": "M"}]}', "there is no crease 7"),
        ('{"controls": [{"kind": "side"}]}', "control 1 (side)"),
        ("{", "not valid JSON"),
    ],
)
def test_a_bad_description_file_is_named_and_nothing_is_written(tmp_path: Path, content: str, words: str) -> None:
    (tmp_path / "told.json").write_text(content, encoding="utf-8")
    drawing = ROOT / "sample_patterns" / "one_arc.svg"
    stream = io.StringIO()
    out = tmp_path / "out"
    told = str(tmp_path / "told.json")
    assert main(["fold", str(drawing), "--out", str(out), "--description", told, "--resolution", "8"], stream) == 2
    assert told in stream.getvalue()
    assert words in stream.getvalue()
    assert not out.exists()
