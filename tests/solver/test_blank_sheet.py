"""A sheet without creases is paper: handles bend it, nothing stretches it, and it is certified like any other."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest

import solver
from solver.command_line import main
from solver.first_fold import first_bend

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
BLANK = "the drawing has no crease: the sheet is blank paper and bends by handles"
_TURN = np.linspace(0, 2 * np.pi, 96, endpoint=False)
_RING = np.column_stack([np.cos(_TURN), np.sin(_TURN)])

Handle = solver.Handle


def bent(pattern: solver.CreasePattern, *handles: Handle) -> solver.FoldResult:
    """Folded by its handles, and sound."""
    result = solver.fold(pattern, solver.FoldDescription(angle=None, handles=handles))
    assert result.status is solver.Outcome.BENT, result.detail
    assert result.status.ok
    assert result.last.constraint < 1e-8
    assert result.measurement.stretch.mean() < 1e-3
    assert solver.verify(result.net, result.positions).ok
    return result


def test_a_square_lifted_at_one_edge_bends_without_stretching() -> None:
    held = [Handle((0, y), (0, y, 0)) for y in (0.0, 0.5, 1.0)]
    lifted = [Handle((1, y), (0.8, y, 0.4)) for y in (0.0, 0.5, 1.0)]
    result = bent(solver.CreasePattern(SQUARE), *held, *lifted)
    assert result.net.notes[-1] == BLANK
    assert len(result.net.patch_polygons) == 1
    assert len(result.net.chain_crease) == 0
    z = result.positions[:, 2]
    assert np.ptp(z) > 0.35
    # A cylinder: what lies on a line along y keeps one height.
    for x in np.unique(result.net.rest[:, 0]):
        assert np.ptp(z[result.net.rest[:, 0] == x]) < 0.01


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8)])
def test_a_square_pushed_together_in_its_plane_bows_that_way(way: tuple[float, float]) -> None:
    """Nothing tells the sheet to which side: that it leaves the plane at all is the point."""
    middle, step = np.array([0.5, 0.5]), 0.45 * np.array(way)
    ends = [middle - step, middle + step]
    result = bent(
        solver.CreasePattern(SQUARE), *(Handle(tuple(p), (*(middle + 0.8 * (p - middle)), 0.0)) for p in ends)
    )
    assert np.ptp(result.positions[:, 2]) > 0.15


def test_the_first_bend_is_a_cylinder_across_the_way_in_which_the_handles_come_together() -> None:
    net = solver.build_net(solver.CreasePattern([(0, 0), (2, 0), (2, 1), (0, 1)]))
    x, y = net.flat.T
    middle = net.flat.mean(axis=0)
    at = middle + np.array([(0, -5.0), (0, 5.0)])
    for gaps, along, across in (([[0, 8.0], [8.0, 0]], y, x), ([[0, 10.0], [10.0, 0]], x, y)):
        offset = first_bend(net, at, np.zeros(2), np.array(gaps))
        for value in np.unique(along):
            assert np.ptp(offset[along == value]) < 1e-12
        assert np.ptp(offset[across == across[0]]) > 0.1
        assert offset[np.argmax(along)] < offset[np.argmin(np.abs(along - along.mean()))]
    ends, inside = np.argmax(y), np.argmin(np.abs(y - y.mean()))
    near = np.array([[0, 8.0], [8.0, 0]])
    assert first_bend(net, at, np.array([2.0, 2.0]), near)[ends] > 0
    assert first_bend(net, at, np.array([-2.0, -2.0]), near)[ends] < 0
    assert first_bend(net, at, np.array([2.0, 2.0]), near)[inside] == pytest.approx(0.0, abs=0.01)


def test_an_annulus_bends() -> None:
    pattern = solver.CreasePattern(_RING, [0.4 * _RING[::-1]])
    result = bent(pattern, Handle((1, 0), (0.9, 0, 0.3)), Handle((-1, 0), (-0.9, 0, 0.3)))
    assert np.ptp(result.positions[:, 2]) > 0.25
    assert len(result.net.patch_polygons) == 1


def test_the_ends_of_a_strip_come_together() -> None:
    pattern = solver.CreasePattern([(0, 0), (3, 0), (3, 1), (0, 1)])
    told = solver.FoldDescription(angle=None, controls=(solver.Pair((0, 0.5), (3, 0.5), distance=1.0),))
    result = solver.fold(pattern, told)
    assert result.status is solver.Outcome.BENT
    assert solver.verify(result.net, result.positions).ok


def test_a_sheet_that_is_let_go_lies_down_flat() -> None:
    net = solver.build_net(solver.CreasePattern(SQUARE), 24)
    model = solver.FoldModel(net)
    model.set_handles([Handle((0, 0.5), (0.1, 0.5, 0)), Handle((1, 0.5), (0.9, 0.5, 0))])
    model.advance(300)
    assert np.ptp(model.positions[:, 2]) > 0.2
    model.set_handles([])
    model.advance(300)
    assert model.status is solver.Status.SETTLED
    assert np.ptp(model.positions[:, 2]) < 1e-6


def test_an_angle_asks_nothing_of_a_blank_sheet() -> None:
    result = solver.fold(solver.CreasePattern(SQUARE), solver.FoldDescription(angle=60.0))
    assert result.status is solver.Outcome.FLAT
    assert result.detail.startswith(solver.Outcome.FLAT.sentence)
    assert "no crease" in result.detail
    assert "fold angle" not in result.summary()
    assert np.ptp(result.positions[:, 2]) == 0.0


def test_two_targets_too_far_apart_are_out_of_reach() -> None:
    handles = (Handle((0, 0.5), (-1, 0.5, 0)), Handle((1, 0.5), (2, 0.5, 0)))
    result = solver.fold(solver.CreasePattern(SQUARE), solver.FoldDescription(angle=None, handles=handles))
    assert result.status is solver.Outcome.OUT_OF_REACH
    assert result.measurement.stretch.mean() < 0.003


@pytest.mark.parametrize(
    ("crease", "words"),
    [
        (solver.Crease([(0, 0.5), (1, 0.5)], assignment="F"), "marked flat (F) and not folded: crease 1"),
        (solver.Crease([(2, 2), (3, 3)]), "crease 1 lies off the sheet and was left out"),
        (solver.Crease([(0.5, 0.5), (0.501, 0.5)]), "crease 1 is shorter than the snap tolerance and was left out"),
        (solver.Crease([(0, 0), (1, 0)]), ""),  # along the border, which it does not change
    ],
)
def test_creases_of_which_nothing_is_left_leave_a_note_and_blank_paper(crease: solver.Crease, words: str) -> None:
    pattern = solver.CreasePattern(SQUARE, creases=[crease])
    net = solver.build_net(pattern)
    plain = solver.build_net(solver.CreasePattern(SQUARE))
    assert np.array_equal(net.rest, plain.rest)
    assert net.notes[-1] == "no crease is left to fold: the sheet is blank paper and bends by handles"
    assert any(words in note for note in net.notes)
    assert solver.fold(pattern).status is solver.Outcome.FLAT
    bent(pattern, Handle((0, 0.5), (0.1, 0.5, 0)), Handle((1, 0.5), (0.9, 0.5, 0)))


def test_a_control_of_a_crease_is_refused() -> None:
    for control in (solver.Side(1, "M"), solver.Angle(30.0, at=(0.5, 0.5)), solver.Amount(1, 0.5)):
        with pytest.raises(solver.DescriptionError, match="no crease"):
            solver.fold(solver.CreasePattern(SQUARE), solver.FoldDescription(controls=(control,)))


def test_all_files_are_written_and_the_mesh_is_paper(tmp_path: Path) -> None:
    handles = (Handle((0, 0.5), (0.1, 0.5, 0)), Handle((1, 0.5), (0.9, 0.5, 0)))
    told = solver.FoldDescription(angle=None, handles=handles)
    solver.write_results(solver.fold(solver.CreasePattern(SQUARE), told), tmp_path, with_rulings=True)
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "bent"
    assert report["ok"]
    assert report["verification"]["ok"]
    assert report["patches"] == 1
    assert report["creases"] == []
    assert report["fold_angle"] == [0.0, 0.0, 0.0]
    for name in ("folded.obj", "folded.fold"):
        assert solver.verify_mesh(solver.read_mesh(tmp_path / name)).ok
    assert report["rulings"]["cylindrical"] > 5


def test_the_command_line_ends_with_one_without_handles_and_with_nought_with_them(tmp_path: Path) -> None:
    drawing = tmp_path / "flat.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><rect width="100" height="100" '
        'fill="none" stroke="#000"/><path d="M50 20L50.1 20" fill="none" stroke="#f00"/></svg>',
        encoding="utf-8",
    )
    handles = tmp_path / "handles.json"
    handles.write_text('[{"at": [0, 50], "target": [10, 50, 0]}, {"at": [100, 50], "target": [90, 50, 0]}]')
    said = io.StringIO()
    assert main(["fold", str(drawing), "--out", str(tmp_path / "a")], said) == 1
    assert "note: no crease is left to fold" in said.getvalue()
    assert "lies flat" in said.getvalue()
    assert main(["fold", str(drawing), "--out", str(tmp_path / "b"), "--handles", str(handles)], said) == 0
