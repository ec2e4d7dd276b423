"""Models advanced until they rest."""

from __future__ import annotations

import solver

#: Iterations between two looks.
_STEP = 20


def settle(model: solver.FoldModel, most: int = 1500) -> solver.SqpReport:
    """Advances it until it rests, or has done the most iterations that are meant; the last report."""
    done = 0
    while True:
        report = model.advance(_STEP)
        done += report.iterations
        if model.status is not solver.Status.RUNNING or done >= most:
            return report


def settled(model: solver.FoldModel, most: int = 1500) -> solver.Measurement:
    """Advances it until it rests, which it must, and measures it."""
    settle(model, most)
    assert model.status is solver.Status.SETTLED
    return solver.measure(model.net, model.positions)
