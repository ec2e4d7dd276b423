"""The same line drawn more than once."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import pytest

from solver.pattern import same_line
from solver.pattern.same_line import settle_same_lines
from solver.pattern.segments import Curve
from solver.pattern.stroke import Decision, Role, Stroke

TOLERANCE = 0.01


def stroke(points: Sequence[Sequence[float]], role: Role = Role.MOUNTAIN, closed: bool = False) -> Stroke:
    return Stroke(Curve(np.array(points, dtype=float), closed, None), Decision(role, "hue", role.value), "")


def test_a_line_beside_another_by_less_than_the_tolerance_counts_once() -> None:
    strokes = [stroke([(0, 0), (50, 0)]), stroke([(50, 0.005), (0, 0.005)]), stroke([(0, 1), (50, 1)])]
    kept, notes = settle_same_lines(strokes, TOLERANCE)
    assert kept == [strokes[0], strokes[2]]
    assert notes == ["1 line was drawn twice and counts once"]
    assert not any(one.conflict for one in kept)


def test_a_ring_that_starts_elsewhere_is_the_same_ring() -> None:
    ring = [(0, 0), (10, 0), (10, 10), (0, 10)]
    kept, _ = settle_same_lines(
        [stroke(ring, closed=True), stroke(ring[2:] + ring[:2], Role.VALLEY, closed=True)], TOLERANCE
    )
    assert [one.decision.role for one in kept] == [Role.CREASE]
    assert "as a mountain and as a valley" in kept[0].conflict


def test_lines_through_one_point_are_not_compared_with_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """Their middles all lie on each other, and their ends do not."""
    turns = np.linspace(0.0, np.pi, 200, endpoint=False)
    lines = [stroke([(-np.cos(t), -np.sin(t)), (np.cos(t), np.sin(t))]) for t in turns]
    compared = itertools.count()
    monkeypatch.setattr(same_line, "_same", lambda *_: bool(next(compared)))
    assert len(settle_same_lines(lines, 1e-4)[0]) == 200
    assert next(compared) == 0
