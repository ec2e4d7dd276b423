"""Sampling of curves: straight stays straight, round stays round, corners stay sharp."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import solver
from solver.pattern.curves import CORNER, drop_repeats, sample_crease, turns

#: A quarter circle as one cubic segment deviates from round by 2.7e-4 of its radius.
KAPPA = 4 / 3 * (np.sqrt(2) - 1)


def circle(count: int, radius: float = 1.0) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return radius * np.column_stack([np.cos(t), np.sin(t)])


@pytest.mark.parametrize("count", [2, 3, 7, 50])
def test_a_straight_line_stays_straight(count: int) -> None:
    t = np.sort(np.random.default_rng(count).uniform(0, 1, count))[:, None]
    start, step = np.array([3.0, -2.0]), np.array([1.7, 0.9])
    line = start + t * step
    sampled = sample_crease(solver.Crease(points=line), 0.01)
    off = (sampled - start) @ np.array([-step[1], step[0]]) / np.hypot(*step)
    assert np.abs(off).max() < 1e-12
    assert np.array_equal(sampled[[0, -1]], line[[0, -1]])
    assert (np.diff(sampled @ step) > 0).all()


def test_a_straight_cubic_segment_is_two_points() -> None:
    control = np.array([[[0, 0], [1, 0.5], [2, 1], [3, 1.5]]], dtype=float)
    sampled = sample_crease(solver.Crease(points=control[0, [0, 3]], beziers=control), 0.01)
    assert np.array_equal(sampled, control[0, [0, 3]])


@pytest.mark.parametrize("scale", [1e7, 1e150, 1e300])
@pytest.mark.parametrize("cubic", [False, True])
def test_a_crease_that_reaches_far_beyond_all_sheets_is_refused(scale: float, cubic: bool) -> None:
    """Before memory is gone: it would be sampled as finely out there."""
    points = scale * np.array([[0, 0], [1, 0.5], [2, 2], [3, 1.5], [4, 1.0]])
    crease = solver.Crease(points=points, beziers=points[None, :4] if cubic else None, name="Far")
    with pytest.raises(solver.PatternError, match="Far: it reaches too far"):
        sample_crease(crease, 0.01)


def test_one_cubic_segment_that_ends_where_it_starts_is_a_loop() -> None:
    control = np.array([[[0.5, 0.2], [1.1, 0.9], [-0.1, 0.9], [0.5, 0.2]]])
    loop = solver.Crease(points=[[0.5, 0.2], [0.7, 0.6], [0.3, 0.6]], closed=True, beziers=control)
    sampled = sample_crease(loop, 0.01)
    assert len(sampled) > 100
    assert shapely.Polygon(sampled).area == pytest.approx(0.126, rel=0.01)


@pytest.mark.parametrize("count", [16, 24, 64])
def test_a_circle_from_samples_is_round(count: int) -> None:
    sampled = sample_crease(solver.Crease(points=circle(count), closed=True), 0.02)
    radius = np.hypot(*sampled.T)
    assert np.abs(radius - 1).max() < 4 * (2 * np.pi / count) ** 4 / 384
    assert np.array_equal(sampled[0], sampled[-1])
    assert np.hypot(*np.diff(sampled, axis=0).T).max() < 0.03
    # Evenly round: no turn is much larger than the others, not even where the curve closes.
    around = np.vstack([sampled, sampled[1]])
    assert turns(around).max() < 1.5 * np.median(turns(around))


def test_an_arc_from_samples_is_round() -> None:
    points = circle(40)[:18]
    sampled = sample_crease(solver.Crease(points=points), 0.02)
    assert np.abs(np.hypot(*sampled.T) - 1).max() < 1e-4
    assert np.array_equal(sampled[[0, -1]], points[[0, -1]])


@pytest.mark.parametrize("spacing", [0.3, 0.05])
def test_a_circle_from_cubic_segments_is_as_round_as_they_are(spacing: float) -> None:
    quarter = np.array([[1, 0], [1, KAPPA], [KAPPA, 1], [0, 1]])
    turn = np.array([[0, -1], [1, 0]])
    segments = [quarter @ np.linalg.matrix_power(turn, k).T for k in range(4)]
    crease = solver.Crease(
        points=np.vstack([s[:1] for s in segments]), closed=True, beziers=np.array(segments, dtype=float)
    )
    sampled = sample_crease(crease, spacing)
    radius = np.hypot(*sampled.T)
    assert radius.min() > 1 - 1e-12
    assert radius.max() < 1 + 2.8e-4
    assert np.array_equal(sampled[0], sampled[-1])
    assert np.hypot(*np.diff(sampled, axis=0).T).max() < 1.5 * spacing


def test_corners_stay_and_their_sides_stay_straight() -> None:
    zigzag = np.array([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0], [5, 1], [6, 0]], dtype=float)
    sampled = sample_crease(solver.Crease(points=zigzag), 0.05)
    line = shapely.LineString(zigzag)
    assert shapely.distance(shapely.points(sampled), line).max() < 1e-12
    for corner in zigzag:
        assert (sampled == corner).all(axis=1).any()


def test_a_corner_between_smooth_arcs_stays_sharp_and_the_arcs_round() -> None:
    # Two half circles side by side: a cusp-like corner of 180 degrees at the origin.
    t = np.linspace(np.pi, 0, 21)
    left = np.column_stack([-1 + np.cos(t), np.sin(t)])
    right = np.column_stack([1 + np.cos(t), np.sin(t)])
    sampled = sample_crease(solver.Crease(points=np.vstack([left, right[1:]])), 0.03)
    corner = np.flatnonzero((np.abs(sampled) < 1e-12).all(axis=1))
    assert len(corner) == 1
    assert turns(sampled)[corner[0] - 1] > np.radians(150)
    assert np.abs(np.hypot(*(sampled[: corner[0]] - [-1, 0]).T) - 1).max() < 1e-4
    assert np.abs(np.hypot(*(sampled[corner[0] :] - [1, 0]).T) - 1).max() < 1e-4


def test_a_straight_part_between_curves_stays_straight() -> None:
    t = np.linspace(np.pi / 2, 0, 15)
    arc = np.column_stack([np.cos(t) - 1, np.sin(t) - 1])
    back = np.array([1.0, -6.0]) - np.column_stack([np.cos(t[::-1]), np.sin(t[::-1])])
    bend = np.vstack([arc, [[0.0, -6.0]], back])
    sampled = sample_crease(solver.Crease(points=drop_repeats(bend)), 0.05)
    middle = sampled[(sampled[:, 1] < -1.05) & (sampled[:, 1] > -5.95)]
    assert np.abs(middle[:, 0]).max(initial=0.0) < 1e-12
    assert shapely.LineString(sampled).length == pytest.approx(np.pi + 5, rel=2e-3)


number = st.floats(-10, 10)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(st.tuples(number, number), min_size=2, max_size=14), st.booleans(), st.floats(0.05, 5))
def test_sampling_any_points_keeps_all_of_them_in_order(
    points: list[tuple[float, float]], closed: bool, spacing: float
) -> None:
    array = drop_repeats(np.array(points))
    if len(array) < (4 if closed else 2):
        return
    crease = solver.Crease(points=array, closed=closed)
    sampled = sample_crease(crease, spacing)
    assert np.isfinite(sampled).all()
    assert (np.hypot(*np.diff(sampled, axis=0).T) > 0).all()
    assert np.array_equal(sampled[0], crease.points[0])
    assert np.array_equal(sampled[-1], crease.points[0] if closed else crease.points[-1])
    at = 0
    for point in crease.points:
        gap = np.hypot(*(sampled[at:] - point).T)
        assert gap.min() < 1e-9
        at += int(np.argmax(gap < 1e-9))


def test_what_counts_as_a_corner() -> None:
    for degrees, is_corner in ((25.0, False), (35.0, True)):
        turn = np.radians(degrees)
        assert (turn > CORNER) == is_corner


def test_a_zigzag_of_gentle_turns_stays_a_zigzag() -> None:
    """The rows of a shallow Miura fold turn left and right by 17 degrees: they are straight lines."""
    zigzag = np.array([(float(k), 0.15 * (k % 2)) for k in range(12)])
    assert np.array_equal(sample_crease(solver.Crease(points=zigzag), 0.05), zigzag)


def test_samples_of_a_wave_are_rounded() -> None:
    x = np.linspace(0.0, 2 * np.pi, 17)
    crease = solver.Crease(points=np.column_stack([x, np.sin(x)]))
    sampled = sample_crease(crease, 0.05)
    # Chords miss it by 0.019.
    assert np.abs(np.sin(sampled[:, 0]) - sampled[:, 1]).max() < 4e-3
