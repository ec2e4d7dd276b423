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


def half_chord(pull: LeastFold) -> float:
    """What is asked of all points: sine of half the fold angle."""
    (term,) = pull.terms()
    return float(np.max(term.half))


def test_nothing_is_asked_until_handles_have_bent_the_paper(net: solver.PiecewiseDog) -> None:
    pull, x = LeastFold(net, 0.1), bent(net, 2.0)
    pull.set(40.0)
    assert not pull.aim(x), "no handle bends the paper"
    pull.bend(float(np.ptp(net.flat, axis=0).max()))
    assert not weights(pull).any(), "they have not come to rest"
    assert pull.aim(x)
    assert weights(pull).any()
    assert not pull.aim(x)
    pull.give_way()
    assert not weights(pull).any()


def test_the_least_fold_falls_with_what_the_flat_sheet_misses(net: solver.PiecewiseDog) -> None:
    pull, size = LeastFold(net, 0.1), float(np.ptp(net.flat, axis=0).max())
    pull.set(40.0)
    pull.bend(size)
    pull.aim(bent(net, 2.0))
    whole = half_chord(pull)
    pull.bend(0.01 * size)
    assert 0.0 < half_chord(pull) < 0.5 * whole
    assert whole == pytest.approx(np.sin(np.radians(20.0)))


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
    """Two corners lifted beside a crossing: by themselves they hardly fold one of its creases."""
    pattern = drawings.crossing()
    alone, helped = (dragged(pattern, 0.04, least) for least in (0.0, 40.0))
    low, helped_low = (np.nanmedian(m.fold_angle) for m in (alone, helped))
    assert low < 6.0
    assert helped_low > 20.0


@pytest.mark.parametrize("part", [0.02, 0.06, 0.12])
def test_deeper_folds_are_never_flattened(drawings: ModuleType, part: float) -> None:
    """The way of the handles is the same with and without it."""
    pattern = drawings.one_arc()
    alone, helped = (np.nanmedian(dragged(pattern, part, least).fold_angle) for least in (0.0, 20.0))
    assert alone > 25.0
    assert helped == pytest.approx(alone, abs=1.0)


def test_a_shorter_drag_folds_less(drawings: ModuleType) -> None:
    medians = [np.nanmedian(dragged(drawings.crossing(), part, 40.0).fold_angle) for part in (0.002, 0.01, 0.04)]
    assert medians == sorted(medians)
    assert medians[0] < 0.5 * medians[-1]


@pytest.mark.parametrize("bad", [-1.0, 181.0, float("nan")])
def test_a_least_fold_out_of_range_is_refused(net: solver.PiecewiseDog, bad: float) -> None:
    with pytest.raises(ValueError, match="least fold"):
        solver.FoldModel(net).set_least_fold(bad)
    with pytest.raises(solver.CurvefoldError, match="0 to 180"):
        solver.FoldDescription(least_fold=bad)
