"""What holds the paper together: peaks are shared out as far as nothing asked is lost, and a drag begins anew."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import solver
from benchmarks.gallery_figures import figures
from solver import finishing
from solver.controls.firmness import Firmness
from solver.controls.paper_pull import PaperPull
from solver.drive import edge_stretch
from solver.errors import NotPositiveDefiniteError
from solver.objectives.continuity import gaps
from solver.resting import RestingShape, RestMerit, best
from tests.solver.crease_medians import crease_medians

SAMPLES = Path(__file__).parents[2] / "sample_patterns"


def peaks(name: str) -> tuple[float, float]:
    """The largest stretch and the mean gap of a figure of the gallery, as it is shown."""
    figure = next(figure for figure in figures() if figure.name == name)
    m = solver.fold(figure.pattern, figure.description).measurement
    return float(np.abs(m.stretch).max()), float(m.continuity.mean())


@pytest.mark.parametrize("name", ["lens_with", "vertex_valley"])
def test_peaks_of_stretch_and_gaps_are_shared_out(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    stretch, gap = peaks(name)
    assert stretch < 0.004
    assert gap < 2e-4
    monkeypatch.setattr(finishing, "_MOST_SHARINGS", 0)
    stretch, gap = peaks(name)
    assert stretch > 0.015, "or this test says nothing"
    assert gap > 2e-4, "or this test says nothing"


def pulled(drawings: ModuleType, longer: float) -> tuple[solver.PiecewiseDog, np.ndarray]:
    """A net and a flat shape (V,3), net units, whose edges at the sheet's left border are longer by a part."""
    net = solver.build_net(drawings.one_arc(), 12)
    x = np.column_stack([net.flat, np.zeros(len(net.flat))])
    left = net.flat[:, 0].min()
    x[net.flat[:, 0] < left + 1e-9, 0] -= longer * net.edge_length[0]
    return net, x


def weights(pull: PaperPull) -> list[np.ndarray]:
    return [term.weight for term in pull.terms()]


def test_only_edges_that_gave_way_weigh_more_and_a_new_task_begins_with_the_usual(drawings: ModuleType) -> None:
    net, x = pulled(drawings, 0.02)
    pull = PaperPull(net, 20000.0, 1e4)
    usual = weights(pull)
    assert pull.share(x)
    heavier = weights(pull)[0] > usual[0]
    assert np.array_equal(heavier, edge_stretch(net, x) > 0.0027)
    assert 0 < heavier.sum() < 40
    pull.wake()
    assert all(np.array_equal(a, b) for a, b in zip(weights(pull), usual, strict=True))


def test_a_paper_at_ease_is_left_alone(drawings: ModuleType) -> None:
    net, x = pulled(drawings, 0.003)
    pull = PaperPull(net, 20000.0, 1e4)
    assert not pull.share(x), "no edge is stretched too far"
    assert pull.peak(x) == 3.0
    _, x = pulled(drawings, 0.02)
    assert pull.peak(x) > 3.0


def test_while_it_settles_a_paper_at_its_limit_leaves_it_to_others(drawings: ModuleType) -> None:
    net, x = pulled(drawings, 0.02)
    pull = PaperPull(net, 20000.0, 1e4)
    _, calmer = pulled(drawings, 0.006)
    assert 0.0025 < edge_stretch(net, 1.0024 * calmer).mean() < 0.003 < edge_stretch(net, 1.0024 * calmer).max()
    assert not pull.settle(1.0024 * calmer)
    tries = [pull.settle(1.02 * x) for _ in range(8)]
    assert tries == [True] * 6 + [False] * 2, "beyond it there is nothing to lose, up to six times"
    pull.wake()
    assert pull.settle(x)


def test_a_crease_point_that_gapes_is_stitched_harder_alone(drawings: ModuleType) -> None:
    net = solver.build_net(drawings.one_arc(), 12)
    x = np.column_stack([net.flat, np.zeros(len(net.flat))])
    pull = PaperPull(net, 20000.0, 1e4)
    usual = weights(pull)[1]
    assert not pull.share(x)
    torn = x.copy()
    row, column = np.unravel_index(np.argmax(np.abs(net.stitches.weights)), net.stitches.weights.shape)
    torn[net.stitches.vertices[row, column], 2] += 0.05
    assert pull.share(torn)
    harder = weights(pull)[1] / usual
    assert np.array_equal(harder > 1.0, gaps(net, torn) > 0.01)
    assert 0 < (harder > 1.0).sum() < len(harder)


# --- which shape it rests in ----------------------------------------------------------------------------


def test_what_a_shape_lacks_counts_before_its_peaks() -> None:
    x = np.zeros((1, 3))
    calm_but_short = RestingShape(RestMerit(0, 1, 0.0, 3.0), x)
    calm_but_less = RestingShape(RestMerit(0, 0, 0.2, 3.0), x)
    first = RestingShape(RestMerit(0, 0, 0.0, 9.0), x)
    calmer = RestingShape(RestMerit(0, 0, 0.0, 5.0), x)
    torn = RestingShape(RestMerit(1, 0, 0.0, 3.0), x)
    assert best([first, calm_but_short, calm_but_less, calmer, torn]) is calmer
    assert best([first, calm_but_short, calm_but_less, torn]) is first


def driven(pattern: solver.CreasePattern, resolution: int, degrees: float) -> solver.FoldModel:
    """A model that rests, driven to an angle."""
    model = solver.FoldModel(solver.build_net(pattern, resolution))
    model.set_fold_angle(degrees)
    while model.status is solver.Status.RUNNING:
        model.advance(50)
    return model


def test_a_fold_does_not_give_up_depth_for_calm(monkeypatch: pytest.MonkeyPatch, drawings: ModuleType) -> None:
    """As calm as other papers a loop driven to 60 degrees would come to 39, a tee driven to 120 to 38."""
    for pattern, resolution, degrees in (
        (solver.read_pattern(SAMPLES / "loop.svg"), 24, 60.0),
        (drawings.tee(), 12, 120.0),
    ):
        model = driven(pattern, resolution, degrees)
        with monkeypatch.context() as patch:
            patch.setattr(finishing, "_MOST_SHARINGS", 0)
            before = driven(pattern, resolution, degrees)
        assert model._paper.peak(model._state.x) > 3.5, "or this test says nothing"
        angles = [crease_medians(m.net, m._state.x) for m in (model, before)]
        assert (angles[0] > 0.9 * angles[1]).all()
        assert solver.verify(model.net, model.positions).ok


def test_a_system_that_breaks_while_peaks_are_shared_out_ends_in_an_exact_shape(
    monkeypatch: pytest.MonkeyPatch, drawings: ModuleType
) -> None:
    tries: list[np.ndarray] = []

    def breaks(problem: object, x: np.ndarray, eps: float) -> np.ndarray:
        if tries:
            raise NotPositiveDefiniteError("no")
        tries.append(x + 1e-6 * np.random.default_rng(0).standard_normal(x.shape))
        return tries[0]

    monkeypatch.setattr(finishing, "tangent_step", breaks)
    monkeypatch.setattr(PaperPull, "share", lambda self, x: True)
    monkeypatch.setattr(PaperPull, "peak", lambda self, x: 3.0 if tries and x is tries[0] else 4.0)
    model = driven(drawings.one_arc(), 12, 90.0)
    assert tries, "or this test says nothing"
    assert model.status is solver.Status.SETTLED
    assert solver.verify(model.net, model.positions).ok
    assert model.advance(0).constraint < 1e-8


def test_a_shape_that_loses_by_being_made_exact_is_not_the_one_it_rests_in(
    monkeypatch: pytest.MonkeyPatch, drawings: ModuleType
) -> None:
    """The step goes to a shape that counts as the calmest, until it is made exact."""
    monkeypatch.setattr(PaperPull, "share", lambda self, x: True)
    first: list[np.ndarray] = []

    def away(problem: object, x: np.ndarray, eps: float) -> np.ndarray:
        if not first:
            first.append(x)
        # Not so far that the certificate fails, or it would not be chosen.
        return x + 1e-6 * np.random.default_rng(len(first)).standard_normal(x.shape)

    def peak(self: PaperPull, x: np.ndarray) -> float:
        if not first or x is first[0]:
            return 4.0
        inexact = np.abs(problem[0].evaluate(x).constraint).max() > 1e-7
        return 3.0 if inexact else 5.0

    problem: list[object] = []
    monkeypatch.setattr(finishing, "tangent_step", away)
    monkeypatch.setattr(PaperPull, "peak", peak)
    net = solver.build_net(drawings.one_arc(), 12)
    model = solver.FoldModel(net)
    model.set_fold_angle(90.0)
    problem.append(model.problem)
    chosen: set[float] = set()
    while model.status is solver.Status.RUNNING:
        model.advance(1)
        chosen |= {best(model._finishing._rests).merit.peak} if model._finishing._rests else set()
    assert model.status is solver.Status.SETTLED
    assert 3.0 in chosen, "or this test says nothing"
    assert np.array_equal(model._state.x, first[0])


def test_a_drag_that_comes_while_peaks_are_shared_out_starts_from_the_best_shape() -> None:
    model = solver.FoldModel(solver.build_net(solver.read_pattern(SAMPLES / "loop.svg"), 24))
    model.set_fold_angle(60.0)
    while len(model._finishing._rests) < 4:
        assert model.status is solver.Status.RUNNING
        model.advance(1)
    assert not np.array_equal(model._finishing._trial, model._state.x), "or this test says nothing"
    assert np.array_equal(model._state.x, best(model._finishing._rests).x)
    model.set_fold_angle(50.0)
    assert not model._finishing._rests
    assert model._finishing._sharings == 0
    assert all((term.weight == term.weight.flat[0]).all() for term in model._paper.terms())


# --- the others hold harder too -------------------------------------------------------------------------


def test_what_was_let_go_is_held_again_and_what_was_held_harder_goes_back_when_told_anew() -> None:
    firmness = Firmness(3)
    firmness.change(4.0)
    firmness.let_go(0.1)
    assert firmness.factor == pytest.approx(0.4)
    assert firmness.spent
    firmness.take_hold()
    assert firmness.factor == 4.0
    assert not firmness.spent
    firmness.change(4.0)
    firmness.change(4.0)
    assert firmness.spent
    firmness.wake()
    assert (firmness.factor, firmness.spent) == (1.0, False)
