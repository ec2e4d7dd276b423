"""The angle drive: pulls all creases towards an angle, as hard as the paper bears.

Not every drawing can hold one angle everywhere (at a smooth crossing, or somewhere along a closed crease,
the angle must vanish). There the fold-angle term pulls with a bounded force (objectives/fold_angle.py), and
when the fold has come to rest with more stretch than the budget, the whole drive eases. It acts only at rest:
adapting while the fold was on its way wound up and let it collapse (docs/method.md gives figures).
"""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray
from .net.piecewise_dog import PiecewiseDog
from .objectives.fold_angle import FoldAngle, driven_points, fold_angle

#: Mean stretch of the net that the drive may cause; the paper's bound is 0.003 (section 6.1).
MEAN_BUDGET = 0.0025
#: Gives the half-angle form the stiffness of the paper's cosine form at 60 degrees: (2 sin 60° / cos 30°)².
_HALF_ANGLE = 4.0
#: Easing multiplies the pull by a power of budget / stretch, but by no less and no more than this.
_EASE_POWER, _EASE_LEAST, _EASE_MOST = 1.5, 0.25, 0.7
#: The pull is eased at most so often.
_EASINGS = 6


class AngleDrive:
    """The fold-angle term with a common strength."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight * _HALF_ANGLE
        self._count = len(driven_points(net))
        self._strength, self._eased = 1.0, 0

    def term(self, degrees: float) -> FoldAngle:
        """The fold-angle term asking for ``degrees`` everywhere with the present strength."""
        return fold_angle(self._net, np.full(self._count, degrees), self._weight * self._strength)

    def reset(self) -> None:
        """Back to full strength."""
        self._strength, self._eased = 1.0, 0

    def ease(self, x: FloatArray) -> bool:
        """Give way at rest in positions x (V,3), net units, when they are over the budget. Whether it did."""
        mean = mean_stretch(self._net, x)
        if mean <= MEAN_BUDGET or self._eased >= _EASINGS:
            return False
        self._strength *= float(np.clip((MEAN_BUDGET / mean) ** _EASE_POWER, _EASE_LEAST, _EASE_MOST))
        self._eased += 1
        return True


def mean_stretch(net: PiecewiseDog, x: FloatArray) -> float:
    """Mean relative change of length of the net's edges at x (V,3), net units."""
    length = np.linalg.norm(x[net.edges[:, 1]] - x[net.edges[:, 0]], axis=1)
    return float(np.abs(length / net.edge_length - 1).mean())
