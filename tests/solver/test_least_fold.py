"""The least fold: what handles leave flat is folded, what is deeper stays, and a short drag folds a little."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import solver
from solver.controls.least_fold import LeastFold


@pytest.fixture
def net(drawings: ModuleType) -> solver.PiecewiseDog:
    return solver.build_net(drawings.one_arc(), 12)


def bent(net: solver.PiecewiseDog, height: float) -> np.ndarray:
    """A sheet bent through its crease without a fold, in the middle ``height`` above its ends; net units."""
    across = net.flat[:, 1] / np.ptp(net.flat[:, 1])
    return np.column_stack([net.flat, height * np.sin(np.pi * across)])


def weights(pull: LeastFold) -> np.ndarray:
    (term,) = pull.terms()
    return np.asarray(term.weight)


def test_nothing_is_asked_until_handles_bend_the_paper_or_points_rest_flat(net: solver.PiecewiseDog) -> None:
    pull = LeastFold(net, 0.1)
    pull.set(40.0)
    pull.begin(bent(net, 2.0))
    assert not weights(pull).any()
    pull.bend(0.001 * np.ptp(net.flat, axis=0).max())
    few = weights(pull)
    assert few.any()
    pull.bend(0.0)
    assert pull.settle(bent(net, 2.0))
    assert weights(pull).any()


def test_points_that_rest_flat_are_pulled_harder_and_harder_but_not_for_ever(net: solver.PiecewiseDog) -> None:
    pull = LeastFold(net, 0.1)
    pull.begin(bent(net, 2.0))
    seen = []
    while pull.settle(bent(net, 2.0)):
        seen.append(weights(pull).max())
    assert 2 < len(seen) < 20
    assert (np.diff(seen) > 0).all()
    pull.start_anew()
    assert not weights(pull).any()


def test_a_paper_that_goes_back_to_flat_is_asked_for_nothing(net: solver.PiecewiseDog) -> None:
    pull = LeastFold(net, 0.1)
    pull.unfolding = True
    assert not pull.settle(bent(net, 2.0))
    assert pull.missed(bent(net, 2.0)) == 0
    pull.unfolding = False
    assert pull.missed(bent(net, 2.0)) > 0


def dragged(pattern: solver.CreasePattern, part: float, least: float) -> solver.Measurement:
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    width = high[0] - low[0]
    handles = tuple(
        solver.Handle((float(x), float(low[1])), (float(x + s * part * width), float(low[1]), part * width))
        for x, s in ((low[0], 1.0), (high[0], -1.0))
    )
    told = solver.FoldDescription(16, angle=None, handles=handles, least_fold=least)
    result = solver.fold(pattern, told)
    assert result.status.ok, result.detail
    return result.measurement


def test_creases_that_handles_leave_flat_fold_visibly(drawings: ModuleType) -> None:
    """Two corners lifted behind a crease: by themselves they hardly fold it."""
    pattern = drawings.off_centre()
    alone, helped = (dragged(pattern, 0.12, least) for least in (0.0, 40.0))
    low = [np.nanquantile(m.fold_angle, 0.1) for m in (alone, helped)]
    assert low[1] > 1.5 * low[0]


def test_a_shorter_drag_folds_less(drawings: ModuleType) -> None:
    medians = [np.nanmedian(dragged(drawings.one_arc(), part, 40.0).fold_angle) for part in (0.01, 0.03, 0.1)]
    assert medians == sorted(medians)
    assert medians[0] < 0.5 * medians[-1]


@pytest.mark.parametrize("bad", [-1.0, 181.0, float("nan")])
def test_a_least_fold_out_of_range_is_refused(net: solver.PiecewiseDog, bad: float) -> None:
    with pytest.raises(ValueError, match="least fold"):
        solver.FoldModel(net).set_least_fold(bad)
    with pytest.raises(solver.CurvefoldError, match="0 to 180"):
        solver.FoldDescription(least_fold=bad)
