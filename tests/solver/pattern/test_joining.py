"""Strokes that continue each other are one line."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import pytest

from solver.arrays import FloatArray
from solver.pattern.joining import join_strokes
from solver.pattern.segments import Curve
from solver.pattern.stroke import Decision, Role, Stroke

SIZE = 100.0


def stroke(points: Sequence[Sequence[float]] | FloatArray, role: Role = Role.MOUNTAIN) -> Stroke:
    row = np.array(points, dtype=float)
    thirds = np.linspace(0.0, 1.0, 4)[:, None]
    beziers = np.array([a + thirds * (b - a) for a, b in itertools.pairwise(row)])
    return Stroke(Curve(row, False, beziers), Decision(role, "hue", role.value), "")


def joined(*strokes: Stroke) -> list[Stroke]:
    return join_strokes(strokes, SIZE)[0]


def arc(count: int, radius: float = 40.0, whole: float = np.pi) -> FloatArray:
    t = np.linspace(0.0, whole, count + 1)
    return np.column_stack([50 + radius * np.cos(t), 10 + radius * np.sin(t)])


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_curve_in_pieces_in_any_order_and_direction_is_one_curve(seed: int) -> None:
    points = arc(40)
    pieces = [points[k : k + 2] for k in range(40)]
    rng = np.random.default_rng(seed)
    rng.shuffle(pieces)
    [one] = joined(*(stroke(piece if rng.random() < 0.5 else piece[::-1]) for piece in pieces))
    assert one.count == 40
    assert not one.curve.closed
    assert one.curve.beziers is None  # samples of a curve, to be rounded where the net is made
    given = one.curve.points if one.curve.points[0, 0] == points[0, 0] else one.curve.points[::-1]
    np.testing.assert_array_equal(given, points)


def test_a_circle_in_pieces_is_a_closed_curve() -> None:
    points = arc(48, whole=2 * np.pi)
    [one] = joined(*(stroke(points[k : k + 2]) for k in range(48)))
    assert one.curve.closed
    assert len(one.curve.points) == 48


def test_pieces_of_cubics_keep_their_control_points() -> None:
    left = np.array([[[0.0, 0.0], [10.0, 20.0], [20.0, 20.0], [30.0, 0.0]]])
    right = np.array([[[30.001, 0.0], [40.0, -20.0], [50.0, -20.0], [60.0, 0.0]]])

    def curve(beziers: FloatArray) -> Stroke:
        t = np.linspace(0.0, 1.0, 20)[:, None]
        p = beziers[0]
        points = (1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t * t * p[2] + t**3 * p[3]
        return Stroke(Curve(points, False, beziers), Decision(Role.VALLEY, "hue", "blue"), "")

    [one] = joined(curve(left), curve(right))
    assert one.curve.beziers is not None
    assert one.curve.beziers.shape == (2, 4, 2)
    np.testing.assert_array_equal(one.curve.beziers[0], left[0])
    np.testing.assert_array_equal(one.curve.beziers[1, 0], left[0, 3])
    np.testing.assert_array_equal(one.curve.beziers[1, 2:], right[0, 2:])


def test_corners_stay_corners() -> None:
    assert len(joined(stroke([(0, 0), (50, 0)]), stroke([(50, 0), (50, 50)]))) == 2
    turned = (50 + 50 * np.cos(np.radians(29)), 50 * np.sin(np.radians(29)))
    assert len(joined(stroke([(0, 0), (50, 0)]), stroke([(50, 0), turned]))) == 1


def test_a_mountain_does_not_go_on_as_a_valley() -> None:
    strokes = joined(stroke([(0, 0), (50, 0)]), stroke([(50, 0), (99, 0)], Role.VALLEY))
    assert [one.decision.role for one in strokes] == [Role.MOUNTAIN, Role.VALLEY]


def test_where_four_meet_lines_go_straight_on() -> None:
    centre = (50, 50)
    strokes = joined(*(stroke([centre, end]) for end in [(0, 50), (100, 52), (50, 0), (52, 100)]))
    assert [one.count for one in strokes] == [2, 2]


def test_a_zigzag_of_corners_is_not_a_curve() -> None:
    """A Miura fold's rows turn by 34 degrees, as many strokes as one polyline."""
    zigzag = np.array([(12.5 * k, 3.75 * (k % 2)) for k in range(9)])
    assert len(joined(*(stroke(zigzag[k : k + 2]) for k in range(8)))) == 8


def test_a_straight_line_in_pieces_has_two_points() -> None:
    x = np.linspace(0.0, 100.0, 11)
    points = np.column_stack([x, 0.5 * x])
    [one] = joined(*(stroke(points[k : k + 2]) for k in range(10)))
    assert one.curve.points.tolist() == [[0.0, 0.0], [100.0, 50.0]]


# ---- dashes that a program has written one by one


def dashes(points: FloatArray, pattern: Sequence[float], role: Role = Role.DARK) -> list[Stroke]:
    """A fine polyline cut into dashes and gaps of these lengths, in turn."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    found, at, k = [], 0.0, 0
    while at < along[-1]:
        end = min(at + pattern[k % len(pattern)], along[-1])
        if k % 2 == 0:
            inner = along[(along > at) & (along < end)]
            places = np.array([at, *inner, end])
            row = np.column_stack([np.interp(places, along, points[:, 0]), np.interp(places, along, points[:, 1])])
            found.append(stroke(row, role))
        at, k = end, k + 1
    return found


def test_dashes_of_a_straight_line_are_one_valley() -> None:
    [one] = joined(*dashes(np.array([[0.0, 50.0], [100.0, 50.0]]), [4.0, 2.0]))
    assert one.curve.points.tolist() == [[0.0, 50.0], [100.0, 50.0]]
    assert one.decision.role is Role.VALLEY
    assert one.decision.why == "dash pattern"


def test_dash_dot_is_a_mountain() -> None:
    [one] = joined(*dashes(np.array([[0.0, 50.0], [99.0, 50.0]]), [8.0, 2.0, 1.0, 2.0]))
    assert one.decision.role is Role.MOUNTAIN


def test_dashes_of_an_arc_lie_on_it() -> None:
    pieces = dashes(arc(400), [4.0, 2.0], Role.MOUNTAIN)
    [one] = joined(*pieces)
    assert one.count == len(pieces)
    np.testing.assert_allclose(np.hypot(*(one.curve.points - [50, 10]).T), 40.0, atol=0.01)
    assert one.decision.role is Role.MOUNTAIN


def test_a_row_of_creases_that_others_fill_is_no_dashed_line() -> None:
    """The columns of a Miura fold: mountain, valley, mountain in turn."""
    column = [stroke([(50, 10 * k), (50, 10 * k + 10)], (Role.MOUNTAIN, Role.VALLEY)[k % 2]) for k in range(10)]
    assert len(joined(*column)) == 10


def test_irregular_gaps_and_few_dashes_stay_as_they_are() -> None:
    starts = [0, 6, 15, 40, 47, 80]
    assert len(joined(*(stroke([(x, 0), (x + 4, 0)]) for x in starts))) == 6
    assert len(joined(*(stroke([(6 * k, 0), (6 * k + 4, 0)]) for k in range(3)))) == 3


def test_dashes_around_a_circle_are_a_closed_crease() -> None:
    radius = 40.0
    pieces = dashes(arc(720, radius, 2 * np.pi), [np.pi * radius / 30, np.pi * radius / 60 - 1e-9], Role.MOUNTAIN)
    [one] = joined(*pieces)
    assert one.curve.closed
    assert len(one.curve.points) == len(pieces) == 40
    np.testing.assert_allclose(np.hypot(*(one.curve.points - [50, 10]).T), radius, atol=0.01)


def test_short_creases_between_long_ones_are_no_dashes() -> None:
    """Bricks: every other joint of a row ends at the courses, and nothing is drawn between."""
    courses = [stroke([(0, y), (100, y)]) for y in np.linspace(0.0, 100.0, 11)]
    joints = [stroke([(50, y), (50, y + 10)], Role.VALLEY) for y in np.linspace(0.0, 80.0, 5)]
    assert len(joined(*courses, *joints)) == len(courses) + len(joints)


def test_lines_in_a_row_that_point_to_all_sides_are_no_dashes() -> None:
    slopes = [0.2 * (k * 0.618 % 1.0) for k in range(12)]
    lines = [stroke([(8 * k, 50 + 0.8 * k), (8 * k + 5, 50 + 0.8 * k + 5 * m)]) for k, m in enumerate(slopes)]
    assert len(joined(*lines)) == 12
