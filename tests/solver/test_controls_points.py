"""Pairs of points, patches that are kept, borders that are glued."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from settling import settled

import solver
from solver.controls.angle import Angle
from solver.controls.glue import Glue
from solver.controls.keep import Keep
from solver.controls.pair import Pair


def place(model: solver.FoldModel, at: tuple[float, float]) -> np.ndarray:
    vertices, weights = model.net.locate(at)
    return np.asarray(weights @ model.positions[vertices])


# --- pairs ----------------------------------------------------------------------------------------------


def test_two_points_of_a_flat_sheet_meet(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 12))
    model.set_controls([Pair((0, 0), (1, 0))])
    m = settled(model)
    assert np.linalg.norm(place(model, (0, 0)) - place(model, (1, 0))) < 0.02
    assert m.folded.all()
    assert m.stretch.mean() < 0.003
    assert not model.findings


@pytest.mark.parametrize("distance", [0.6, 0.9])
def test_a_pair_comes_to_its_distance(drawings: ModuleType, distance: float) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 12))
    model.set_controls([Pair((0, 0), (1, 0), distance=distance)])
    m = settled(model)
    assert np.linalg.norm(place(model, (0, 0)) - place(model, (1, 0))) == pytest.approx(distance, abs=0.01)
    assert m.folded.all()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_pair_shares_one_coordinate_and_no_other(drawings: ModuleType, axis: int) -> None:
    """Three held corners leave no rigid motion; the fourth is free but for one coordinate."""
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 12))
    held = {(0.0, 0.0): (0.0, 0.0, 0.0), (1.0, 0.0): (0.9, 0.0, 0.05), (0.0, 1.0): (0.02, 0.95, 0.2)}
    model.set_handles([solver.Handle(at=at, target=target, strength=20.0) for at, target in held.items()])
    settled(model)
    free = place(model, (1, 1)) - place(model, (0.5, 1))
    axes = tuple(k == axis for k in range(3))
    model.set_controls([Pair((1, 1), (0.5, 1), axes=axes, strength=5.0)])
    settled(model)
    gap = place(model, (1, 1)) - place(model, (0.5, 1))
    if axis > 0:  # along x they cannot come together without leaving the handles
        assert abs(free[axis]) > 0.008
        assert abs(gap[axis]) < 0.2 * abs(free[axis])
    assert np.linalg.norm(gap) > 0.3


def test_one_pair_alone_folds_an_annulus(drawings: ModuleType) -> None:
    """Fig. 1: opposite points of the rim drawn together."""
    t = np.linspace(0.0, 2 * np.pi, 96, endpoint=False)
    unit = np.column_stack([np.cos(t), np.sin(t)])
    pattern = solver.CreasePattern(
        boundary=unit, holes=[0.4 * unit[::-1]], creases=[drawings.circle((0, 0), r, 96) for r in (0.6, 0.8)]
    )
    model = solver.FoldModel(solver.build_net(pattern, 20))
    model.set_controls([Pair((-1, 0), (1, 0), distance=1.55)])
    m = settled(model)
    assert np.linalg.norm(place(model, (-1, 0)) - place(model, (1, 0))) == pytest.approx(1.55, abs=0.03)
    assert m.folded.all()
    assert len(set(model.found_assignments)) == 2
    assert not model.findings


def test_points_that_cannot_meet_are_said_with_the_gap_that_stays(drawings: ModuleType) -> None:
    """A kept patch is rigid: its corners cannot meet."""
    told = solver.FoldDescription(
        resolution=10, angle=None, controls=(Pair((0, 0), (1, 0)), Keep((0.5, 0.05), strength=20.0))
    )
    result = solver.fold(drawings.two_arcs(), told)
    assert result.status is solver.Outcome.OUT_OF_REACH
    assert "(0, 0) and (1, 0) stay" in result.detail


# --- patches --------------------------------------------------------------------------------------------


def corners_of_lowest(drawings: ModuleType) -> np.ndarray:
    return np.array([(0.02, 0.02), (0.98, 0.02), (0.5, 0.3), (0.05, 0.2), (0.95, 0.2), (0.5, 0.02)])


def test_a_kept_patch_is_flat_while_the_others_fold(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
    model.set_fold_angle(50)
    settled(model)
    places = corners_of_lowest(drawings)

    def unevenness() -> float:
        points = np.array([place(model, tuple(p)) for p in places])
        return float(np.linalg.svd(points - points.mean(axis=0))[1][2])

    bent = unevenness()
    model.set_controls([Keep((0.5, 0.05))])
    m = settled(model)
    assert bent > 0.03
    assert unevenness() < 0.01
    # A flat patch lets a curved crease bend no more: that one opens, the other stays.
    assert np.nanmedian(m.fold_angle[m.crease == 0]) < 15
    assert np.nanmedian(m.fold_angle[m.crease == 1]) == pytest.approx(50, abs=2)


def test_a_rigid_patch_keeps_its_shape_when_the_drive_opens(drawings: ModuleType, on_the_sheet: ModuleType) -> None:
    places = corners_of_lowest(drawings)
    change = {}
    for kept in (False, True):
        model = solver.FoldModel(solver.build_net(drawings.two_arcs(), 12))
        model.set_fold_angle(50)
        settled(model)

        def distances(model: solver.FoldModel = model) -> np.ndarray:
            points = np.array([place(model, tuple(p)) for p in places])
            return np.linalg.norm(points[:, None] - points[None], axis=2)

        before = distances()
        model.set_controls([Keep((0.5, 0.05), shape="rigid")] if kept else [])
        model.set_fold_angle(20)
        settled(model)
        change[kept] = np.abs(distances() - before).max()
    assert change[True] < 0.4 * change[False]


# --- seams ----------------------------------------------------------------------------------------------


def strip(drawings: ModuleType) -> solver.CreasePattern:
    creases = [drawings.curve([(x, 0), (x, 0.25)], 0.03) for x in np.linspace(0.1, 0.9, 5)]
    return solver.CreasePattern(boundary=drawings.rectangle(1.0, 0.25), creases=creases)


LEFT, RIGHT = ((0.0, 0.0), (0.0, 0.25)), ((1.0, 0.0), (1.0, 0.25))


def seam_gap(model: solver.FoldModel) -> float:
    gaps = [place(model, (0.0, y)) - place(model, (1.0, y)) for y in np.linspace(0, 0.25, 6)]
    return float(np.linalg.norm(gaps, axis=1).max())


def test_a_strip_is_glued_to_a_ring_from_flat_and_folds_at_every_crease(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(strip(drawings), 32))
    model.set_controls([Glue(LEFT, RIGHT)])
    m = settled(model)
    assert seam_gap(model) < 0.003
    assert m.folded.all()
    assert m.stretch.mean() < 0.002
    assert not model.findings


def test_bending_across_the_seam_takes_its_kink_away(drawings: ModuleType) -> None:
    turns = {}
    for bending in (True, False):
        model = solver.FoldModel(solver.build_net(strip(drawings), 32))
        model.set_controls([Glue(LEFT, RIGHT, bending=bending)])
        settled(model)
        assert seam_gap(model) < 0.003
        before, after = (
            place(model, (1, 0.12)) - place(model, (0.97, 0.12)),
            place(model, (0.03, 0.12)) - place(model, (0, 0.12)),
        )
        turns[bending] = np.degrees(np.arccos(before @ after / np.linalg.norm(before) / np.linalg.norm(after)))
    assert turns[True] < 0.5 * turns[False]


def test_a_seam_may_be_glued_the_other_way_round(drawings: ModuleType) -> None:
    """The ends exchanged: a band with half a twist."""
    pattern = solver.CreasePattern(
        boundary=drawings.rectangle(1.0, 0.08), creases=[drawings.curve([(0, 0.04), (1, 0.04)], 0.01)]
    )
    model = solver.FoldModel(solver.build_net(pattern, 50))
    model.set_handles([solver.Handle(at=(0.5, 0.04), target=(0.5, 0.04, 0.0))])
    model.set_controls([Glue(((0, 0), (0, 0.08)), ((1, 0.08), (1, 0)))])
    settled(model)
    gap = [np.linalg.norm(place(model, (0, y)) - place(model, (1, 0.08 - y))) for y in (0, 0.04, 0.08)]
    assert max(gap) < 0.02


def test_angles_and_a_seam_work_together(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(strip(drawings), 32))
    model.set_controls([Glue(LEFT, RIGHT), Angle(80.0, crease=3)])
    m = settled(model)
    assert seam_gap(model) < 0.01
    assert np.nanmedian(m.fold_angle[m.crease == 2]) == pytest.approx(80, abs=3)
