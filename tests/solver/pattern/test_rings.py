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
