"""Drawings cut at their crossings: what the net's own tests do not see."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from solver.pattern import arrangement

WITHIN = 1e-11


def test_many_ends_are_snapped_as_few_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines are given points where ends lie on them up to rounding, however many lines and ends there are."""
    rng = np.random.default_rng(0)
    lines = [shapely.LineString(rng.random((9, 2))) for _ in range(30)]
    own = np.concatenate([shapely.get_coordinates(line)[[0, -1]] for line in lines])
    on_lines = np.concatenate(
        [shapely.get_coordinates(line.interpolate(at, normalized=True)) for line in lines for at in (0.3, 0.7)]
    )
    near = on_lines + rng.uniform(-0.3, 0.3, on_lines.shape) * WITHIN
    ends = rng.permutation(np.concatenate([own, near, near[::3]]))
    few, many = [], []
    for found, limit in ((few, 10**12), (many, 0)):
        monkeypatch.setattr(arrangement, "_MANY_SNAPS", limit)
        found.extend(arrangement._snapped(lines, ends, WITHIN))
    assert sum(len(line.coords) for line in few) == 30 * 9 + len(near)
    assert [line.wkb for line in many] == [line.wkb for line in few]
