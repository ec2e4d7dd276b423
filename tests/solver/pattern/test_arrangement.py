"""Drawings cut at their crossings: what the net's own tests do not see."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from solver.pattern import arrangement
from solver.pattern.arrangement import END_REACH, arrange

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


# --- ends that stop short, on a sheet of twenty cells ---------------------------------------------------

SHEET = shapely.box(0, 0, 20, 20)


def arranged(*lines: list[tuple[float, float]]) -> arrangement.Arrangement:
    return arrange(
        SHEET, [np.array(line, dtype=float) for line in lines], [f"crease {k + 1}" for k in range(len(lines))]
    )


def ends(found: arrangement.Arrangement) -> int:
    return found.kinds.count(arrangement.END)


def test_an_end_goes_straight_on_to_what_it_points_at() -> None:
    """At a slant the nearest place of the border would be a kink away."""
    found = arranged([(5, 0), (19.8, 14.8)])
    assert ends(found) == 0
    assert found.notes == ("ends that missed by a little were joined: crease 1",)
    (chain,) = found.chains
    assert chain.points[-1] == pytest.approx((20, 15))


def test_an_end_beside_the_border_stays_where_it_is() -> None:
    for line in ([(0, 10), (10, 19.8), (15, 19.8)], [(0, 10), (19.8, 10), (19.8, 15)]):
        found = arranged(line)
        assert ends(found) == 1
        assert found.notes == ()


def test_an_end_reaches_the_first_line_in_its_way_and_no_other() -> None:
    found = arranged([(0, 10), (9.9, 10)], [(10, 0), (10, 20)], [(10.15, 0), (10.3, 20)])
    assert (10.0, 10.0) in {tuple(vertex) for vertex in np.round(found.vertices, 9).tolist()}
    assert not any(chain.crease == 0 and chain.points[:, 0].max() > 10 + 1e-9 for chain in found.chains)


def test_two_ends_on_both_sides_of_a_line_meet_it_and_not_each_other() -> None:
    found = arranged([(0, 9.95), (9.9, 9.95)], [(20, 10.05), (10.1, 10.05)], [(10, 0), (10, 20)])
    assert ends(found) == 0
    junctions = {tuple(vertex) for vertex in np.round(found.vertices, 6).tolist()}
    assert {(10.0, 9.95), (10.0, 10.05)} <= junctions


def test_a_short_crease_is_not_stretched_to_what_is_far_for_it() -> None:
    """Fine patterns with features smaller than a quarter of a cell stay as they are drawn."""
    gap = 0.8 * END_REACH
    for length, joined in ((3 * gap, False), (6 * gap, True)):
        found = arranged([(0, 10), (20, 10)], [(5, 10 + gap), (5, 10 + gap + length)])
        assert ends(found) == (1 if joined else 2)
    rows = [[(x, y), (x + 0.3, y)] for y in (9.0, 9.2, 9.4) for x in np.arange(5, 10, 0.5)]
    found = arranged(*rows)
    assert ends(found) == 2 * len(rows)


def test_a_crease_closes_only_where_it_is_nearly_closed() -> None:
    def ring(radius: float, gap: float) -> list[tuple[float, float]]:
        turns = np.linspace(gap / radius / 2, 2 * np.pi - gap / radius / 2, 60)
        return [(10 + radius * np.cos(t), 10 + radius * np.sin(t)) for t in turns]

    assert ends(arranged(ring(3.0, 0.2))) == 0
    assert ends(arranged(ring(0.25, 0.2))) == 2


def test_four_ends_around_a_point_meet() -> None:
    found = arranged([(0, 10), (9.92, 10)], [(20, 10), (10.08, 10)], [(10, 0), (10, 9.92)], [(10, 20), (10, 10.08)])
    assert ends(found) == 0
    inner = [
        vertex for vertex, kind in zip(found.vertices, found.kinds, strict=True) if kind == arrangement.CROSSING
    ]
    assert len(inner) == 1
    assert inner[0] == pytest.approx((10, 10))


def test_what_misses_by_more_than_a_quarter_stays_apart() -> None:
    for gap, free in ((0.24, 0), (0.26, 1)):
        assert ends(arranged([(0, 10), (20 - gap, 10)])) == free
