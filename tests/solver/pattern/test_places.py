"""Places along polylines: shapely's own numbers, by a way that does not look at every segment."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from solver.arrays import FloatArray
from solver.pattern import places
from solver.pattern.places import line_strings, places_along


def polylines(rng: np.random.Generator) -> list[FloatArray]:
    """Crossing themselves, with many places equally near, and with points given twice."""
    walk = np.cumsum(rng.normal(0.0, 0.1, (400, 2)), axis=0)
    return [walk, rng.integers(0, 6, (300, 2)).astype(float), np.vstack([walk[:50], walk[:50][::-1]])]


@pytest.mark.parametrize("many", [0, 10**9])
@pytest.mark.parametrize("seed", range(5))
def test_the_same_bits_as_shapely(monkeypatch: pytest.MonkeyPatch, seed: int, many: int) -> None:
    monkeypatch.setattr(places, "_MANY_LOOKS", many)
    rng = np.random.default_rng(seed)
    lines = polylines(rng)
    which = rng.integers(0, len(lines), 2000)
    points = np.concatenate([line[rng.integers(0, len(line), 400)] for line in lines])
    points = np.vstack([points, 0.5 * (points[:-1] + points[1:])])[: len(which)]
    points[::7] += rng.normal(0.0, 3.0, points[::7].shape)
    points[::5] = np.round(2 * points[::5]) / 2
    expected = [
        shapely.line_locate_point(shapely.LineString(lines[k]), shapely.Point(point))
        for k, point in zip(which, points, strict=True)
    ]
    assert np.array_equal(places_along(lines, which, points), expected)


def test_no_points_and_no_lines() -> None:
    assert places_along([np.eye(2)], np.zeros(0, dtype=np.int64), np.zeros((0, 2))).shape == (0,)
    assert len(line_strings([])) == 0


def test_lines_are_what_their_points_are() -> None:
    lines = polylines(np.random.default_rng(9))
    assert all(shapely.LineString(line).equals(made) for line, made in zip(lines, line_strings(lines), strict=True))
