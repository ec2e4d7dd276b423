"""Dashes in millimetres: the same from both ends, with whole ends, vertices and borders."""

import itertools
import math

import pytest

from solver.plan.dashes import segments
from solver.plan.data import Kind, PlanStroke
from solver.plan.pieces import Arc, Line
from solver.plan.walk import Walk


def straight(length: float, *vertices: float) -> PlanStroke:
    return PlanStroke(Walk((Line(0, length),)), Kind.VALLEY, vertices=vertices)


def spans(stroke: PlanStroke, lengths: tuple[float, ...], margin: float) -> list[tuple[float, float]]:
    return [
        (walk.pieces[0].at(0.0).real, walk.pieces[-1].at(1.0).real) for walk in segments(stroke, lengths, margin)
    ]


@pytest.mark.parametrize("length", [7.3, 20.0, 99.9, 100.0, 313.7])
@pytest.mark.parametrize("lengths", [(3.0, 1.5), (6.0, 1.5, 0.8, 1.5)])
def test_dashes_are_the_same_from_both_ends(length: float, lengths: tuple[float, ...]) -> None:
    found = spans(straight(length), lengths, 1.0)
    mirrored = sorted((length - b, length - a) for a, b in found)
    assert [x for span in mirrored for x in span] == pytest.approx([x for span in sorted(found) for x in span])


@pytest.mark.parametrize("length", [20.0, 99.9, 100.0, 313.7])
def test_dashes_are_as_long_as_told_and_gaps_no_shorter(length: float) -> None:
    found = spans(straight(length), (3.0, 1.5), 1.0)
    assert found[0][0] == pytest.approx(1.0)
    assert found[-1][1] == pytest.approx(length - 1.0)
    assert [b - a for a, b in found] == pytest.approx([3.0] * len(found))
    gaps = [b[0] - a[1] for a, b in itertools.pairwise(found)]
    assert min(gaps) >= 1.5 - 1e-9
    assert max(gaps) < 1.5 + 4.5 / len(gaps)


def test_nothing_is_drawn_near_ends_and_vertices() -> None:
    found = spans(straight(100.0, 30.0, 70.0), (3.0, 1.5), 2.0)
    for place in (0.0, 30.0, 70.0, 100.0):
        assert min(max(a - place, place - b) for a, b in found) == pytest.approx(2.0)
    whole = spans(straight(100.0, 30.0), (), 2.0)
    assert [x for span in whole for x in span] == pytest.approx([2.0, 28.0, 32.0, 98.0])


def test_a_part_without_room_has_no_dash_and_a_short_one_has_one_in_its_middle() -> None:
    assert spans(straight(3.9), (3.0, 1.5), 2.0) == []
    ((a, b),) = spans(straight(9.0), (3.0, 1.5), 1.0)
    assert (a, b) == pytest.approx((3.0, 6.0))
    ((a, b),) = spans(straight(6.0), (3.0, 1.5), 2.0)
    assert (a, b) == pytest.approx((2.0, 4.0))


def test_a_whole_line_without_margin_is_itself() -> None:
    stroke = straight(100.0, 30.0)
    assert segments(stroke, (), 0.0) == [stroke.walk]


def test_dashes_go_evenly_around_a_closed_crease() -> None:
    circle = Walk((Arc(20, 20, 0, 20.0, 0.0, 2 * math.pi),), True)
    found = segments(PlanStroke(circle, Kind.VALLEY), (3.0, 1.5), 1.0)
    assert len(found) == int(40 * math.pi / 4.5)
    assert sum(walk.length for walk in found) == pytest.approx(3.0 * len(found))
    middles = sorted(math.atan2(*reversed([walk.at(1.5).real, walk.at(1.5).imag])) for walk in found)
    steps = [b - a for a, b in itertools.pairwise(middles)]
    assert steps == pytest.approx([2 * math.pi / len(found)] * len(steps))


def test_a_closed_crease_that_another_meets_is_free_there() -> None:
    circle = Walk((Arc(20, 20, 0, 20.0, 0.0, 2 * math.pi),), True)
    found = segments(PlanStroke(circle, Kind.VALLEY, vertices=(10.0,)), (), 2.0)
    assert sum(walk.length for walk in found) == pytest.approx(circle.length - 4.0)
    near = min(abs(end - circle.at(10.0)) for walk in found for end in (walk.at(0.0), walk.at(walk.length)))
    assert near == pytest.approx(2.0, abs=0.01)
