"""Made exact: what the projection and the nudge before it do to shapes, and what they leave alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import solver
from solver import finishing
from solver.laid_flat import off_plane
from solver.optimize.sqp import projection_step
from tests.solver.crease_medians import crease_medians

SAMPLES = Path(__file__).resolve().parents[2] / "sample_patterns"


def net_of(name: str) -> solver.PiecewiseDog:
    return solver.build_net(solver.read_pattern(SAMPLES / f"{name}.svg"), 12)


def settled(model: solver.FoldModel) -> solver.FoldModel:
    while model.status is solver.Status.RUNNING:
        model.advance(50)
    return model


def residual(model: solver.FoldModel, x: np.ndarray) -> float:
    return float(np.abs(model.problem.evaluate(x).constraint).max())


def test_a_projection_makes_a_bent_sheet_exact_and_leaves_an_exact_one_alone() -> None:
    model = solver.FoldModel(net_of("one_arc"))
    model.set_fold_angle(40.0)
    settled(model)
    exact = model._state.x
    bent = exact + 1e-3 * np.random.default_rng(0).standard_normal(exact.shape)
    before, x = residual(model, bent), bent
    for _ in range(4):
        x, after = projection_step(model.problem, x, 1e-6, 1e-9)
        assert after == residual(model, x)
        assert after < 0.5 * before
        before = after
    assert np.abs(x - bent).max() < 0.1
    flat = np.column_stack([model.net.flat, np.zeros(len(model.net.flat))])
    there, none = projection_step(model.problem, flat, 1e-6, 1e-9)
    assert none < 1e-12
    assert np.abs(there - flat).max() < 1e-9


def test_several_steps_use_one_factorisation() -> None:
    model = solver.FoldModel(net_of("one_arc"))
    model.set_fold_angle(40.0)
    settled(model)
    x = model._state.x + 1e-4 * np.random.default_rng(0).standard_normal(model._state.x.shape)
    system = model.problem.system
    factorisations, solves = system.factorizations, system.solves
    projection_step(model.problem, x, 1e-8, 1e-9)
    assert system.factorizations == factorisations + 1
    assert system.solves > solves + 1


def test_a_sheet_that_is_asked_for_nothing_stays_flat_to_the_last_bit() -> None:
    model = solver.FoldModel(net_of("mirrored_arcs"))
    model.set_fold_angle(0.0)
    settled(model)
    assert off_plane(model._state.x) == 0.0


@pytest.mark.parametrize("name", ["mirrored_arcs", "corner_arcs"])
def test_a_paper_that_is_settled_again_keeps_its_shape(name: str) -> None:
    """As when its file is opened: distances stay; what nothing holds in space may turn."""
    first = solver.FoldModel(net_of(name))
    first.set_fold_angle(50.0)
    settled(first)
    again = solver.FoldModel(first.net, first.positions)
    again.set_fold_angle(50.0)
    settled(again)
    some = slice(None, None, 7)
    shapes = [model._state.x[some] for model in (first, again)]
    apart = [np.linalg.norm(x[:, None] - x[None], axis=2) for x in shapes]
    assert np.abs(apart[0] - apart[1]).max() < 1e-3, "grid edges"
    assert crease_medians(first.net, again._state.x) == pytest.approx(
        crease_medians(first.net, first._state.x), abs=0.05
    )


def test_only_what_is_not_exact_is_nudged(monkeypatch: pytest.MonkeyPatch) -> None:
    model = solver.FoldModel(net_of("mirrored_arcs"))
    model.set_fold_angle(50.0)
    settled(model)
    exact = model._state.x
    bent = exact + 1e-4 * np.random.default_rng(0).standard_normal(exact.shape)
    monkeypatch.setattr(finishing, "_NUDGE", 0.1)
    moved = [np.abs(finishing.Finishing(model.net).step(model.problem, x, []).x - x).max() for x in (exact, bent)]
    assert moved[0] < 1e-6
    assert moved[1] > 0.01
