"""Borders that hardly are any."""

from __future__ import annotations

import numpy as np

from solver.pattern.rings import outer_rings
from solver.pattern.segments import Curve


def test_a_line_that_goes_back_and_forth_on_itself_is_no_border() -> None:
    """Rounded to single precision its points miss the line by so little that cutting it converges to nothing."""
    points = np.array(
        [
            (-2.646080359896269, -0.5828051420443402),
            (-2.549589964666727, -0.554778368827887),
            (-2.2987188369491443, -0.4819098912310213),
            (-2.2317317621893333, -0.4624527053809625),
            (-2.5882821952402026, -0.5660169834997596),
            (-1.202406757763776, -0.1634731189005513),
        ]
    )
    assert outer_rings([Curve(points, False, None)], [0], 1.0) == []


def test_sides_that_stop_short_of_a_corner_meet_in_it() -> None:
    """Nothing is turned: each side only goes on in its own direction."""
    sides = [[(0.8, 0), (99.2, 0)], [(100, 0.8), (100, 99.2)], [(99.2, 100), (0.8, 100)], [(0, 99.2), (0, 0.8)]]
    curves = [Curve(np.array(side, dtype=float), False, None) for side in sides]
    assert outer_rings(curves, range(4), 100.0) == []
    [ring] = outer_rings(curves, range(4), 100.0, 2e-2)
    assert sorted(map(tuple, ring.points.round(9).tolist())) == [(0, 0), (0, 100), (100, 0), (100, 100)]
    assert len(ring.gaps) == 4
