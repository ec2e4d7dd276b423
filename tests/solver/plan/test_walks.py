"""Lengths along lines, arcs and cubics, parts of them, and what of them lies in a box."""

import cmath
import math

import numpy as np
import pytest

from solver.plan.clip import clipped
from solver.plan.pieces import Arc, Cubic, Line, Motion
from solver.plan.walk import Walk

CUBIC = Cubic(0, 30 + 40j, 80 - 20j, 100 + 10j)
#: A quarter of a circle of radius 10 about the origin.
QUARTER = Arc.through(10, 10j, 0, math.pi / 2)
CIRCLE = Arc(10, 10, 0, 10.0, 0.0, 2 * math.pi)


def chords(piece: Line | Arc | Cubic) -> float:
    points = np.array([piece.at(t) for t in np.linspace(0.0, 1.0, 4001).tolist()])
    return float(np.abs(np.diff(points)).sum())


@pytest.mark.parametrize("piece", [Line(1, 4 + 4j), QUARTER, CIRCLE, CUBIC], ids=["line", "arc", "circle", "cubic"])
def test_lengths_are_those_of_many_chords(piece: Line | Arc | Cubic) -> None:
    assert piece.length == pytest.approx(chords(piece), rel=1e-6)


@pytest.mark.parametrize("piece", [Line(1, 4 + 4j), QUARTER, CUBIC], ids=["line", "arc", "cubic"])
def test_a_part_is_the_same_curve_and_as_long_as_asked(piece: Line | Arc | Cubic) -> None:
    walk = Walk((piece,))
    (part,) = walk.part(0.2 * walk.length, 0.7 * walk.length)
    assert part.length == pytest.approx(0.5 * walk.length, rel=1e-9)
    assert part.at(0.0) == pytest.approx(walk.at(0.2 * walk.length), rel=1e-9)
    assert part.at(1.0) == pytest.approx(walk.at(0.7 * walk.length), rel=1e-9)
    assert Walk((part,)).at(0.1 * walk.length) == pytest.approx(walk.at(0.3 * walk.length), rel=1e-9)


def test_a_part_of_a_closed_walk_may_pass_its_start() -> None:
    walk = Walk((CIRCLE,), True)
    pieces = walk.part(0.9 * walk.length, 1.2 * walk.length)
    assert sum(piece.length for piece in pieces) == pytest.approx(0.3 * walk.length)
    assert pieces[0].at(0.0) == pytest.approx(cmath.rect(10.0, 0.9 * 2 * math.pi))
    assert pieces[-1].at(1.0) == pytest.approx(cmath.rect(10.0, 0.2 * 2 * math.pi))


def test_motions_keep_shapes_and_mirror_arcs() -> None:
    motion = Motion(-1.0, 100.0, True)
    for piece in (Line(1, 4 + 4j), QUARTER, CUBIC):
        moved = piece.moved(motion)
        for t in (0.0, 0.3, 1.0):
            assert moved.at(t) == pytest.approx(100.0 - piece.at(t).conjugate())


def test_an_arc_as_cubics_is_as_near_as_said() -> None:
    cubics = CIRCLE.cubics()
    off = max(abs(abs(cubic.at(t)) - 10.0) for cubic in cubics for t in np.linspace(0.0, 1.0, 50).tolist())
    assert off < 1e-6
    assert sum(cubic.length for cubic in cubics) == pytest.approx(CIRCLE.length, rel=1e-6)


def test_what_lies_in_a_box_is_cut_exactly() -> None:
    box = (-5.0, -20.0, 20.0, 20.0)
    parts = clipped(Walk((CIRCLE,), True), box)
    # The circle leaves the box at x = -5, 120 degrees on either side.
    assert len(parts) == 1
    assert parts[0].length == pytest.approx(10.0 * math.radians(240.0))
    assert parts[0].pieces[0].start.real == pytest.approx(-5.0)
    assert all(isinstance(piece, Arc) for piece in parts[0].pieces)
    (line,) = clipped(Walk((Line(-10, 30),)), box)
    assert (line.pieces[0].start, line.pieces[0].end) == (-5, 20)
    inside = Walk((Line(0, 1),))
    assert clipped(inside, box) == [inside]
    assert clipped(Walk((Line(-30, -10),)), box) == []


def test_a_curve_in_two_boxes_has_its_whole_length() -> None:
    walk = Walk((CUBIC,))
    left, right = clipped(walk, (-50.0, -50.0, 40.0, 50.0)), clipped(walk, (40.0, -50.0, 200.0, 50.0))
    assert sum(part.length for part in (*left, *right)) == pytest.approx(walk.length, rel=1e-9)
