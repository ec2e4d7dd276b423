"""What holds the paper together: at rest no edge stays stretched beyond the bound, and a drag begins anew."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import solver
from benchmarks.gallery_figures import figures
from solver.controls import paper_pull
from solver.controls.paper_pull import ALLOWED_STRETCH, PaperPull


def peaks(name: str) -> tuple[float, float]:
    """The largest stretch and the mean gap of a figure of the gallery, as it is shown."""
    figure = next(figure for figure in figures() if figure.name == name)
    m = solver.fold(figure.pattern, figure.description).measurement
    return float(np.abs(m.stretch).max()), float(m.continuity.mean())


@pytest.mark.parametrize(("name", "bound"), [("lens_with", 0.004), ("vertex_valley", 0.006)])
def test_peaks_of_stretch_and_gaps_are_shared_out(monkeypatch: pytest.MonkeyPatch, name: str, bound: float) -> None:
    stretch, gap = peaks(name)
    assert stretch < bound
    assert gap < 2e-4
    monkeypatch.setattr(paper_pull, "_MOST_TIMES", 0)
    monkeypatch.setattr(paper_pull, "_MOST_RETURNS", 0)
    stretch, _ = peaks(name)
    assert stretch > 0.015, "or this test says nothing"


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
    assert pull.settle(x)
    ends = x[net.edges]
    stretch = np.abs(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / net.edge_length - 1)
    heavier = weights(pull)[0] > usual[0]
    assert np.array_equal(heavier, stretch > ALLOWED_STRETCH)
    assert 0 < heavier.sum() < 40
    assert pull.wake()
    assert not pull.wake()
    assert all(np.array_equal(a, b) for a, b in zip(weights(pull), usual, strict=True))


def test_a_paper_at_its_limit_or_at_ease_is_left_alone(drawings: ModuleType) -> None:
    net, x = pulled(drawings, 0.003)
    pull = PaperPull(net, 20000.0, 1e4)
    assert not pull.settle(x), "no edge is stretched too far"
    assert not pull.settle(1.0025 * x), "all of it is at its limit: others have to give way"
    assert not pull.undone(1.02 * x)
    assert pull.settle(1.02 * x), "nothing to lose"


def test_a_paper_that_held_too_hard_gives_way_for_good_until_it_is_told_something_new(drawings: ModuleType) -> None:
    net, x = pulled(drawings, 0.02)
    pull = PaperPull(net, 20000.0, 1e4)
    assert not pull.give_way(), "it has not held harder yet"
    pull.wake()
    assert pull.settle(x)
    assert pull.give_way()
    assert not pull.settle(x)
    assert not pull.undone(x)
    pull.wake()
    assert pull.settle(x)
