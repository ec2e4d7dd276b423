"""Curve-constrained flow: curves measured and built, creases led to them."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from settling import settled

import solver
from solver.controls.curve import Curve
from solver.controls.space_curve import CurveShape, build_curve, laid_onto, measure_curve


def helix(radius: float, rise: float, turns: np.ndarray) -> np.ndarray:
    return np.column_stack([radius * np.cos(turns), radius * np.sin(turns), rise * turns])


# --- curves ---------------------------------------------------------------------------------------------


def test_a_circle_with_uneven_points_has_its_curvature_everywhere() -> None:
    turns = np.cumsum(np.random.default_rng(1).uniform(0.02, 0.2, 30))
    shape = measure_curve(helix(2.0, 0.0, turns))
    assert shape.curvature == pytest.approx(0.5, abs=1e-9)
    assert shape.torsion == pytest.approx(0.0, abs=1e-9)


def test_a_helix_has_its_curvature_and_torsion() -> None:
    radius, rise = 2.0, 0.7
    shape = measure_curve(helix(radius, rise, np.linspace(0, 3, 200)))
    assert shape.curvature == pytest.approx(radius / (radius**2 + rise**2), rel=1e-4)
    assert shape.torsion == pytest.approx(rise / (radius**2 + rise**2), rel=1e-3)


def test_curvature_changes_its_sign_at_an_inflection_and_not_its_binormal() -> None:
    x = np.linspace(-1, 1, 81)
    shape = measure_curve(np.column_stack([x, x**3, 0 * x]), -1.0)
    assert (shape.curvature[:39] < 0).all()
    assert (shape.curvature[-39:] > 0).all()
    assert np.abs(shape.torsion).max() < 1e-9


def test_building_is_the_inverse_of_measuring() -> None:
    rng = np.random.default_rng(3)
    curvature, torsion = rng.uniform(-0.8, 0.8, 18), rng.uniform(-0.5, 0.5, 17)
    curvature[np.abs(curvature) < 0.1] = 0.2
    built = build_curve(np.full(19, 0.3), CurveShape(curvature, torsion))
    again = measure_curve(built, float(np.sign(curvature[0])))
    assert again.curvature == pytest.approx(curvature, abs=1e-6)
    assert again.torsion == pytest.approx(torsion, rel=0.02, abs=1e-6)


def test_a_curve_is_laid_onto_its_own_moved_points() -> None:
    curve = helix(1.0, 0.3, np.linspace(0, 6, 30))
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    moved = curve @ turn.T + (3, -1, 2)
    assert laid_onto(curve, moved) == pytest.approx(moved, abs=1e-9)
    mirrored = curve * (1, 1, -1)
    assert np.abs(laid_onto(curve, mirrored) - mirrored).max() > 0.05


# --- creases --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("b", [1.5, 3.0])
def test_the_arc_flows_to_the_curve_of_state_a_and_folds_like_it(exact: ModuleType, b: float) -> None:
    state = exact.arc(b)
    net = solver.build_net(state.pattern(low=-1.3, high=0.7), 20)
    crease = [state.at((x, float(state.g(np.array([x]))[0]))) for x in np.linspace(-1, 1, 201)]
    model = solver.FoldModel(net)
    model.set_controls([Curve(1, points=tuple(tuple(p.tolist()) for p in crease))])
    m = settled(model)
    assert not model.findings
    inner = np.isfinite(m.fold_angle) & (np.abs(m.crease_position[:, 0]) < 0.75)
    error = m.fold_angle[inner] - state.fold_angle(m.crease_position[inner, 0])
    assert np.abs(error).mean() < 2.5
    assert m.folded.all()
    assert m.stretch.mean() < 0.001


@pytest.mark.parametrize("times", [1.1, 1.5])
def test_curvature_times_folds_an_arc_by_its_cosine(exact: ModuleType, times: float) -> None:
    """The flat curvature is that in space times the cosine of half the fold angle."""
    net = solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 20)
    model = solver.FoldModel(net)
    model.set_controls([Curve(1, curvature_times=times)])
    m = settled(model)
    assert np.nanmedian(m.fold_angle) == pytest.approx(2 * np.degrees(np.arccos(1 / times)), abs=2.0)
    assert not model.findings


def test_from_flat_the_same_words_ask_for_the_same_shape_whatever_was_before(exact: ModuleType) -> None:
    net = solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 16)
    half, whole = (Curve(1, curvature_times=1.4, progress=p, from_flat=True) for p in (0.5, 1.0))
    model = solver.FoldModel(net)
    model.set_controls([half])
    angle = float(np.nanmedian(settled(model).fold_angle))
    assert 0.3 < angle / (2 * np.degrees(np.arccos(1 / 1.4))) < 0.7
    again = solver.FoldModel(net, model.positions)
    again.set_controls([half])
    assert np.nanmedian(settled(again).fold_angle) == pytest.approx(angle, abs=0.5)
    for start in (model.positions, None):
        model = solver.FoldModel(net, start)
        model.set_controls([whole])
        assert np.nanmedian(settled(model).fold_angle) == pytest.approx(2 * np.degrees(np.arccos(1 / 1.4)), abs=2)
        relative = solver.FoldModel(net, model.positions)
        relative.set_controls([whole])
        assert not relative.findings, "it is there already"


def test_curvature_plus_is_in_the_drawings_units(exact: ModuleType) -> None:
    """The arc's radius is 2: plus 0.25 makes its curvature 1.5 times what it was."""
    net = solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 20)
    model = solver.FoldModel(net)
    model.set_controls([Curve(1, curvature_plus=0.25)])
    m = settled(model)
    assert np.nanmedian(m.fold_angle) == pytest.approx(2 * np.degrees(np.arccos(1 / 1.5)), abs=2.0)


def crease_points(model: solver.FoldModel) -> np.ndarray:
    points = model.net.crease_points
    mine = np.flatnonzero(points.left_vertices[:, 0] >= 0)
    kept = mine[np.concatenate([[True], np.diff(points.along[mine]) > 0.5])]
    return np.einsum("kw,kwc->kc", points.left_weights[kept], model.positions[points.left_vertices[kept]])


@pytest.mark.parametrize("torsion", [-0.6, 0.6])
def test_torsion_twists_the_crease_to_its_side(exact: ModuleType, torsion: float) -> None:
    net = solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 20)
    model = solver.FoldModel(net)
    model.set_controls([Curve(1, curvature_times=1.3, torsion_plus=torsion)])
    m = settled(model)
    assert m.folded.all()
    found = measure_curve(crease_points(model)[::2])
    assert np.median(found.torsion) == pytest.approx(torsion, rel=0.25)


def test_progress_stops_on_the_way_and_speed_gets_there_sooner(exact: ModuleType) -> None:
    net = solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 12)
    angles, iterations = [], []
    for progress, speed in ((0.5, 1.0), (1.0, 1.0), (1.0, 3.0)):
        model = solver.FoldModel(net)
        model.set_controls([Curve(1, curvature_times=1.5, progress=progress, speed=speed)])
        done = 0
        while model.status is solver.Status.RUNNING:
            done += model.advance(10).iterations
        angles.append(float(np.nanmedian(solver.measure(net, model.positions).fold_angle)))
        iterations.append(done)
    # The way is even in the angle.
    assert angles[0] == pytest.approx(0.5 * angles[1], abs=4)
    assert angles[2] == pytest.approx(angles[1], abs=1)
    assert iterations[2] < iterations[1]


@pytest.mark.parametrize(("part", "speed"), [(1.0, 1.0), (1.0, 4.0), (0.4, 1.0)])
def test_how_far_a_crease_has_gone_is_told(exact: ModuleType, part: float, speed: float) -> None:
    model = solver.FoldModel(solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 12))
    assert model.flow_progress == {}
    model.set_controls([Curve(1, curvature_times=1.5, progress=part, speed=speed)])
    assert model.flow_progress == {0: 0.0}
    seen = [0.0]
    while model.status is solver.Status.RUNNING:
        model.advance(2)
        seen.append(model.flow_progress[0])
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(part, abs=1e-9)
    # At the usual speed the first steps are small ones; faster they are longer.
    assert 0.0 < seen[1] <= 0.1 * speed
    again = model.flow_progress[0]
    model.set_controls([])
    assert model.flow_progress == {}
    assert again == seen[-1]


def test_progress_goes_back_the_way_it_came(exact: ModuleType) -> None:
    net = solver.build_net(exact.arc(1.5).pattern(low=-1.3, high=0.7), 12)
    model = solver.FoldModel(net)
    model.set_controls([Curve(1, curvature_times=1.5)])
    settled(model)
    model.set_controls([Curve(1, curvature_times=1.5, progress=0.4)])
    m = settled(model)
    assert np.nanmedian(m.fold_angle) == pytest.approx(0.4 * 2 * np.degrees(np.arccos(1 / 1.5)), abs=5)
    assert m.folded.all()
