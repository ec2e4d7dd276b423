"""Sampling of drawn segments: how many points, and when there are too many."""

from __future__ import annotations

import numpy as np
import pytest

from solver.errors import PatternError
from solver.pattern.segments import MAX_POINTS, SAGITTA, Segment, Subpath, arc, cubic, line, sample

FAR = 1e6  # times the drawing


@pytest.mark.parametrize(
    "segment",
    [
        cubic([(0, 0), (FAR, FAR), (-FAR, FAR), (1, 0)]),
        cubic([(0, 0), (np.nan, 1), (1, 1), (1, 0)]),
        arc((FAR, 0), (-FAR, 0), (0, 0), (FAR, 0), (0, FAR), 0.0, 3.1),
    ],
    ids=["cubic", "not a number", "arc"],
)
def test_a_segment_that_needs_more_points_than_a_drawing_may_have_is_refused(segment: Segment) -> None:
    with pytest.raises(PatternError, match="more than 200,000 points"):
        sample(Subpath((segment,), False), 1.0, MAX_POINTS)


def test_segments_of_all_kinds_follow_each_other() -> None:
    """Each as fine as its own shape asks for, and nothing of what has no length."""
    flat = cubic([(0, 0), (0.2, 0), (0.8, 0), (1, 0)])
    round_corner = cubic([(2, 0), (2.5, 0), (3, 0.5), (3, 1)])
    half = arc((3, 1), (3, 3), (3, 2), (0, -1), (1, 0), 0.0, np.pi)
    nothing = line((2, 0), (2, 0))
    curve = sample(Subpath((flat, line((1, 0), (2, 0)), nothing, round_corner, half), False), 3.0, MAX_POINTS)
    assert curve is not None
    assert curve.beziers is not None
    assert curve.points[:3].tolist() == [[0, 0], [1, 0], [2, 0]]
    on_half = curve.points[curve.points[:, 1] >= 1]
    assert np.hypot(*(on_half - (3, 2)).T) == pytest.approx(1.0, abs=1e-12)
    middles = 0.5 * (on_half[1:] + on_half[:-1])
    assert (1 - np.hypot(*(middles - (3, 2)).T)).max() <= SAGITTA * 3.0
    joints = [curve.beziers[0, 0], *curve.beziers[:, 3]]
    assert [tuple(np.round(joint, 12)) for joint in joints[:4]] == [(0, 0), (1, 0), (2, 0), (3, 1)]


def test_no_segment_is_no_curve() -> None:
    assert sample(Subpath((), False), 1.0, MAX_POINTS) is None
    assert sample(Subpath((line((1, 1), (1, 1)),), True), 1.0, MAX_POINTS) is None
