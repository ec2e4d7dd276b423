"""When the fold condition is made stiffer."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import solver
from solver.controls.condition_pull import ConditionPull


@pytest.fixture
def net(drawings: ModuleType) -> solver.PiecewiseDog:
    return solver.build_net(drawings.one_arc(), 12)


def bent(net: solver.PiecewiseDog, height: float) -> np.ndarray:
    """A sheet bent through its crease without a fold, in the middle ``height`` above its ends; net units."""
    across = net.flat[:, 1] / np.ptp(net.flat[:, 1])
    return np.column_stack([net.flat, height * np.sin(np.pi * across)])


def test_on_its_way_a_point_has_to_stay_unfolded(net: solver.PiecewiseDog) -> None:
    pull = ConditionPull(net, 1.0)
    assert (~solver.measure(net, net.frame.to_drawing(bent(net, 2.0))).folded).any()
    # Looked at every ten iterations, stiffer from the third time on, 256 times at most.
    changed = [pull.keep_up(bent(net, 2.0)) for _ in range(100)]
    assert np.flatnonzero(changed).tolist() == [29, 39, 49, 59]


def test_a_paper_that_was_flat_in_between_is_looked_at_anew(net: solver.PiecewiseDog) -> None:
    pull = ConditionPull(net, 1.0)
    for height, iterations in ((2.0, 20), (0.01, 100), (2.0, 20)):
        assert not any(pull.keep_up(bent(net, height)) for _ in range(iterations))
