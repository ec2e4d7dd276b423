"""Grooves: as wide as the fold needs, on the face that it closes, and none where the board cannot bend."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

import solver
from solver.errors import DescriptionError, PatternError
from solver.plan.board import groove_width, with_grooves
from solver.plan.data import Kind, PlanStroke
from solver.plan.planning import PlanDescription, plan
from solver.plan.sheet import make_plan
from solver.plan.source import FoldAngles, PlanSource
from solver.plan.walk import Walk

SQUARE = [(0, 0), (200, 0), (200, 100), (0, 100)]


def polygon_of(walk: Walk) -> shapely.Polygon:
    return shapely.Polygon(walk.samples(1e-4)[0])


def source(points: object, degrees: object, places: object = None, closed: bool = False) -> PlanSource:
    """One crease folded by degrees (n,) at places (n,2), else at its points."""
    pattern = solver.CreasePattern(SQUARE, (), [solver.Crease(points, closed)], "board", 1.0)
    where = np.asarray(points if places is None else places, dtype=float)
    return PlanSource(pattern, FoldAngles(where, np.broadcast_to(np.asarray(degrees, float), (len(where),))))


def grooves(told: PlanSource, thickness: float, passes: int = 2, radius: float = 0.0) -> list[PlanStroke]:
    return with_grooves(make_plan(told), thickness, passes, radius, 0.02).having(Kind.GROOVE)


LINE = [(100, 0), (100, 100)]
ALONG = [(100, y) for y in range(5, 100, 5)]


@pytest.mark.parametrize("degrees", [20.0, 60.0, 90.0, 120.0])
def test_a_groove_is_as_wide_as_the_fold_needs(degrees: float) -> None:
    (groove,) = grooves(source(LINE, degrees, ALONG), 2.0)
    area = polygon_of(groove.walk)
    width = 4.0 * math.tan(math.radians(degrees) / 2.0)
    assert groove_width(2.0, degrees) == pytest.approx(width)
    assert area.area == pytest.approx(width * 100.0, rel=1e-6)
    assert area.bounds == pytest.approx((100 - width / 2, 0.0, 100 + width / 2, 100.0))


def test_a_groove_widens_with_the_fold() -> None:
    angles = np.linspace(20.0, 80.0, len(ALONG))
    (groove,) = grooves(source(LINE, angles, ALONG), 2.0)
    area = polygon_of(groove.walk)
    widths = [
        area.intersection(shapely.LineString([(0, y), (200, y)])).length for y in (10.0, 30.0, 50.0, 70.0, 90.0)
    ]
    expected = groove_width(2.0, 20.0 + 60.0 * (np.array([10.0, 30.0, 50.0, 70.0, 90.0]) - 5.0) / 90.0)
    assert widths[1:4] == pytest.approx(expected[1:4], rel=0.02)
    assert widths == sorted(widths)


def test_valleys_are_grooved_on_the_front_and_mountains_on_the_back() -> None:
    assert [groove.back for groove in grooves(source(LINE, 60.0, ALONG), 2.0)] == [False]
    assert [groove.back for groove in grooves(source(LINE, -60.0, ALONG), 2.0)] == [True]


def test_more_passes_lie_evenly_between_the_edges() -> None:
    lines = grooves(source(LINE, 90.0, ALONG), 2.0, passes=5)
    assert len(lines) == 4
    places = sorted(line.walk.at(50.0).real for line in lines[1:])
    assert places == pytest.approx([99.0, 100.0, 101.0])


def test_a_groove_that_meets_the_border_at_a_slant_goes_on_beyond_it() -> None:
    (groove,) = grooves(source([(50, 0), (150, 100)], 90.0, [(60, 10), (100, 50), (140, 90)]), 2.0)
    board = shapely.box(0, 0, 200, 100)
    area = polygon_of(groove.walk).intersection(board)
    # A slanted band of 4 mm across a board of 100 mm.
    assert area.area == pytest.approx(4.0 * 100.0 * math.sqrt(2.0), rel=1e-3)


def test_a_closed_crease_has_two_closed_edges() -> None:
    t = np.linspace(0.0, 2 * math.pi, 200)[:-1]
    ring = np.column_stack([100 + 40 * np.cos(t), 50 + 40 * np.sin(t)])
    inner, outer = sorted(grooves(source(ring, 60.0, closed=True), 2.0), key=lambda groove: groove.walk.length)
    half = groove_width(2.0, 60.0) / 2
    assert inner.walk.closed
    assert outer.walk.closed
    assert inner.walk.length == pytest.approx(2 * math.pi * (40 - half), rel=1e-4)
    assert outer.walk.length == pytest.approx(2 * math.pi * (40 + half), rel=1e-4)


def bow(radius: float) -> np.ndarray:
    t = np.linspace(0.1, math.pi - 0.1, 200)
    return np.column_stack([100 + radius * np.cos(t), 20 + radius * np.sin(t)])


def test_board_that_cannot_bend_so_far_is_refused_with_the_place() -> None:
    # Beside the crease the board bends to 50 mm / tan(30 degrees).
    assert grooves(source(bow(50.0), 60.0), 4.0, radius=20.0)
    with pytest.raises(
        PatternError, match=r"crease 1 at \(.*\): board of 4 mm would bend to a radius of 86"
    ) as caught:
        grooves(source(bow(50.0), 60.0), 4.0, radius=22.0)
    x, y = caught.value.where.place
    assert math.hypot(x - 100, y - 20) == pytest.approx(50.0, abs=0.1)


def test_grooves_wider_than_the_curve_and_folds_too_deep_are_refused() -> None:
    with pytest.raises(PatternError, match="mm wide where the crease has a radius of 5"):
        grooves(source(bow(5.0), 90.0), 6.0)
    with pytest.raises(PatternError, match="it folds by 170°"):
        grooves(source(LINE, 170.0, ALONG), 2.0)


def test_a_drawing_alone_says_no_widths() -> None:
    with pytest.raises(PatternError, match="which a drawing does not say"):
        plan(solver.read_pattern("sample_patterns/lens.svg"), PlanDescription("board", 2.0))


def test_thickness_and_grooves_belong_together() -> None:
    pattern = solver.read_pattern("sample_patterns/lens.svg")
    with pytest.raises(DescriptionError, match="draws no grooves"):
        plan(pattern, PlanDescription("origami", 2.0))
    with pytest.raises(DescriptionError, match="need the board's thickness"):
        plan(pattern, PlanDescription("board"))
    with pytest.raises(DescriptionError, match="more than 0"):
        PlanDescription("board", 0.0)


def test_the_board_profile_has_a_front_and_a_back() -> None:
    result = plan(source(LINE, -60.0, ALONG), PlanDescription("board", 2.0))
    front, back = ({part.layer.name for part in page.layers} for page in result.pages)
    assert front == {"registration", "cut"}
    assert back == {"registration", "groove"}
