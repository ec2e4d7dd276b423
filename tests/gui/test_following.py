"""The measure of following finds the rates and delays that it is given."""

from __future__ import annotations

import numpy as np
import pytest

from tests.gui.following import following, spending


@pytest.mark.parametrize("delay", [0.0, 0.05, 0.2])
def test_known_delays_are_found(delay: float) -> None:
    def way(t: float) -> list[float]:
        """Ten units in two seconds, evenly; then it rests."""
        return [5.0 * min(max(t, 0.0), 2.0), 0.0, 0.0]

    events = []
    for t in np.arange(0.0, 4.0, 1 / 60).tolist():
        if t <= 2.0:
            events.append([t, "hook", way(t), way(t - delay)])
        events.append([t + 0.004, "paper", way(t), way(t - delay)])
        events.append([t + 0.008, "frame", way(t), way(t - delay)])
    found = following(events)
    assert found.frames == pytest.approx(60.0, rel=0.05)
    assert found.ticks == pytest.approx(60.0, rel=0.05)
    assert found.to_next_write == pytest.approx(4.0, abs=0.1)
    assert found.longest_frame == pytest.approx(1000 / 60, abs=0.1)
    assert found.gap == pytest.approx(5.0 * delay, abs=0.01)
    # Within half a unit of the end when a tenth of a second is left to go.
    assert found.catch_up == pytest.approx(max(0.0, 1000.0 * (delay - 0.1)), abs=20.0)


def test_what_never_arrives_never_catches_up() -> None:
    events = [
        [0.1 * k, kind, [float(k), 0.0, 0.0], [0.0, 0.0, 0.0]] for k in range(9) for kind in ("hook", "frame")
    ]
    assert following([*events, [1.0, "paper", [8.0, 0.0, 0.0], [0.0, 0.0, 0.0]]]).catch_up == float("inf")


def test_known_spendings_are_found() -> None:
    events = []
    for k in range(11):
        start, own, all_threads = 0.1 * k, 0.05 * k, 0.15 * k
        steps = [("hook", 0.0, 0.0), ("tick", 0.01, 0.01), ("ticked", 0.03, 0.015), ("draw", 0.04, 0.02)]
        for kind, wall, mine in [*steps, ("frame", 0.08, 0.05)]:
            events.append([start + wall, kind, [0.0] * 3, [0.0] * 3, own + mine, all_threads + mine])
    found = spending(events)
    assert (found.tick, found.draw, found.rest) == pytest.approx((20.0, 40.0, 40.0))
    assert (found.tick_processor, found.draw_processor, found.rest_processor) == pytest.approx((5.0, 30.0, 15.0))
    assert found.ticks == 1.0
    assert found.other_threads == pytest.approx(100.0)
