"""Curves again from samples: lines stay lines, arcs become arcs, the rest few cubics within the tolerance."""

import math

import numpy as np
import pytest
import shapely

from solver.pattern.segments import Subpath, arc, cubic, line, sample
from solver.plan.fitting import of_cubics, of_points
from solver.plan.pieces import Arc, Cubic, Line
from solver.plan.walk import Walk

TOLERANCE = 0.02


def kinds(walk: Walk) -> str:
    return "".join(type(piece).__name__[0] for piece in walk.pieces)


def xy(z: np.ndarray) -> np.ndarray:
    return np.column_stack([z.real, z.imag])


def circle(radius: float, count: int, sweep: float = 2 * math.pi) -> np.ndarray:
    return radius * np.exp(1j * np.linspace(0.0, sweep, count))


def farthest(walk: Walk, points: np.ndarray) -> float:
    """The largest distance of points from a walk."""
    where = walk.samples(1e-4)[0]
    return float(shapely.distance(shapely.LineString(where), shapely.points(points)).max())


def test_a_sampled_circle_is_one_arc() -> None:
    walk = of_points(xy(circle(50.0, 200)[:-1]), True, TOLERANCE)
    (piece,) = walk.pieces
    assert isinstance(piece, Arc)
    assert piece.is_circle
    assert piece.radius == pytest.approx(50.0)
    assert walk.closed


def test_a_polygon_that_is_drawn_stays_one() -> None:
    walk = of_points(xy(circle(50.0, 17)[:-1]), True, TOLERANCE)
    assert kinds(walk) == "L" * 16
    square = of_points(np.array([[0, 0], [10, 0], [10, 10], [0, 10]]), True, TOLERANCE)
    assert kinds(square) == "LLLL"
    assert square.length == 40.0


def test_a_rounded_rectangle_is_lines_and_arcs() -> None:
    corner = circle(8.0, 24, math.pi / 2)
    places = [complex(92, 52), complex(8, 52), complex(8, 8), complex(92, 8)]
    z = np.concatenate([place + corner * 1j**k for k, place in enumerate(places)])
    walk = of_points(xy(z), True, TOLERANCE)
    assert sorted(kinds(walk)) == list("AAAALLLL")
    assert {round(piece.radius, 6) for piece in walk.pieces if isinstance(piece, Arc)} == {8.0}
    assert walk.length == pytest.approx(2 * 84 + 2 * 44 + 16 * math.pi)


def test_two_arcs_that_go_on_smoothly_are_two_arcs() -> None:
    first = circle(30.0, 80, math.pi / 2)
    second = 30j + 60j - 1j * 60.0 * np.exp(1j * np.linspace(0, -math.pi / 3, 80))
    walk = of_points(xy(np.concatenate([first, second[1:]])), False, TOLERANCE)
    assert kinds(walk) == "AA"
    assert [round(piece.radius, 3) for piece in walk.pieces] == [30.0, 60.0]


def test_an_ellipse_is_few_cubics_within_the_tolerance() -> None:
    t = np.linspace(0.0, 2 * math.pi, 400)[:-1]
    points = np.column_stack([80 * np.cos(t), 35 * np.sin(t)])
    walk = of_points(points, True, TOLERANCE)
    assert set(kinds(walk)) <= {"C", "A"}
    assert len(walk.pieces) <= 12
    assert farthest(walk, points) <= TOLERANCE
    ends = [abs(a.end - b.start) for a, b in zip(walk.pieces, [*walk.pieces[1:], walk.pieces[0]], strict=True)]
    assert max(ends) < 1e-9


@pytest.mark.parametrize("tolerance", [0.1, 0.02, 0.002])
def test_a_finer_tolerance_is_kept(tolerance: float) -> None:
    x = np.linspace(0.0, 200.0, 800)
    points = np.column_stack([x, 20 * np.sin(x / 20.0)])
    walk = of_points(points, False, tolerance)
    assert set(kinds(walk)) == {"C"}
    assert farthest(walk, points) <= tolerance
    assert len(walk.pieces) < 60
    turns = [np.angle(b.way(0.0) / a.way(1.0)) for a, b in zip(walk.pieces, walk.pieces[1:], strict=False)]
    assert np.abs(turns).max() < 1e-6


def test_corners_stay_corners() -> None:
    z = np.concatenate([circle(40.0, 60, math.pi / 2), [40j - 30, 40j - 30 + 10j]])
    walk = of_points(xy(z), False, TOLERANCE)
    assert kinds(walk) == "ALL"
    assert walk.pieces[1].end == -30 + 40j


def test_samples_of_a_drawings_path_become_its_path() -> None:
    path = Subpath(
        (
            line((0, 0), (60, 0)),
            arc((60, 0), (80, 20), (60, 20), (20, 0), (0, 20), -math.pi / 2, math.pi / 2),
            line((80, 20), (80, 50)),
            cubic([(80, 50), (80, 90), (20, 40), (0, 50)]),
        ),
        True,
    )
    curve = sample(path, 100.0, 100_000)
    assert curve is not None
    walk = of_points(curve.points, True, TOLERANCE)
    assert kinds(walk).replace("CC", "C").replace("CC", "C") == "LALCL"
    assert farthest(walk, curve.points) <= TOLERANCE


def test_cubics_of_a_drawing_stay_as_they_are_and_arcs_become_arcs() -> None:
    half = Subpath((arc((50, 0), (-50, 0), (0, 0), (50, 0), (0, 50), 0.0, math.pi),), False)
    curve = sample(half, 100.0, 100_000)
    assert curve is not None
    assert curve.beziers is not None
    walk = of_cubics(curve.beziers, False, TOLERANCE, 100.0)
    assert kinds(walk) == "A"
    assert walk.pieces[0].radius == pytest.approx(50.0, abs=1e-3)
    drawn = np.array(
        [[(0, 0), (30, 40), (80, -20), (100, 10)], [(100, 10), (101, 11), (102, 12), (103, 13)]], float
    )
    kept = of_cubics(drawn, False, TOLERANCE, 100.0)
    assert kept.pieces == (Cubic(0, 30 + 40j, 80 - 20j, 100 + 10j), Line(100 + 10j, 103 + 13j))
