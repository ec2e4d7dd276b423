"""Which lines pass near which points: shapely's own answer, by a way that does not look at every line."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from solver.arrays import FloatArray
from solver.pattern import near_lines
from solver.pattern.near_lines import lines_near
from solver.pattern.places import line_strings


def lines(rng: np.random.Generator) -> list[FloatArray]:
    """Long ones that cross, upright and level ones, walks of short steps, and the same one twice."""
    long_ = [rng.uniform(-100.0, 100.0, (2, 2)) for _ in range(200)]
    straight = [np.array([[-100.0, y], [100.0, y]]) for y in range(0, 60, 3)]
    walks = [np.cumsum(rng.normal(0.0, 0.5, (300, 2)), axis=0) for _ in range(20)]
    return [*long_, *straight, *(line[:, ::-1] for line in straight), *walks, long_[0]]


def pairs(some: list[FloatArray], points: FloatArray, distance: float) -> set[tuple[int, int]]:
    found: list[tuple[int, int]] = []
    for point, line in lines_near(line_strings(some), points, distance):
        found += zip(point.tolist(), line.tolist(), strict=True)
    assert len(set(found)) == len(found)
    return set(found)


@pytest.mark.parametrize("many", [1, 10**9])
@pytest.mark.parametrize("distance", [1e-9, 0.02, 5.0])
def test_the_same_as_shapely(monkeypatch: pytest.MonkeyPatch, many: int, distance: float) -> None:
    monkeypatch.setattr(near_lines, "_MANY_LINES", many)
    rng = np.random.default_rng(3)
    some = lines(rng)
    ends = np.vstack([line[[0, -1]] for line in some])
    points = np.vstack([ends, ends + rng.normal(0.0, distance, ends.shape), rng.uniform(-120.0, 120.0, (200, 2))])
    near = shapely.dwithin(line_strings(some)[None, :], shapely.points(points)[:, None], distance)
    assert pairs(some, points, distance) == set(map(tuple, np.argwhere(near).tolist()))


def test_no_points_and_no_lines() -> None:
    assert pairs([], np.zeros((3, 2)), 1.0) == set()
    assert pairs([np.eye(2)], np.zeros((0, 2)), 1.0) == set()


def test_lines_without_a_length(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near_lines, "_MANY_LINES", 1)
    point = np.ones((2, 2))
    assert pairs([point, point], point[:1], 0.1) == {(0, 0), (0, 1)}
