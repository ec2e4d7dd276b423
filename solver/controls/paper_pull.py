"""The paper itself: edges keep their length and copies of crease points stay together, harder where they did not.

Energies spread an excess over many edges in the mean and leave peaks beside handles, creases and crease vertices.
In a shape that has come to rest, edges that are stretched too far weigh more from then on, and so do all stitches
when they gape in the mean: what gave way is shared out among the neighbours (iteratively reweighted least squares).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..drive import MAX_MEAN_STRETCH, MEAN_BUDGET, edge_stretch
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.continuity import continuity, gaps, mean_gap
from ..objectives.isometry import isometry
from .pull import Pull, Term

#: While an edge is stretched by more than the first (the paper's 0.004, section 6.1), edges weigh more that are
#: stretched by more than the second: the square of how many times, up to the third.
_ALLOWED_STRETCH, _AIMED_STRETCH, _HEAVIEST = 0.0038, 0.0027, 4.0
#: While it settles, what is stretched by more than the first, or so many times the mean where all is taut, weighs
#: more by so many times its excess, up to the last, at most so often; not where the mean is nearly at its budget.
_STRETCHED, _TAUT, _HARDER, _HARDEST, _MOST_HELD, _FULL = 0.0035, 2.0, 2.0, 9.0, 6, 0.95
#: Stitches hold harder when they gape more than this in the mean, net units: the paper's 2e-4 with room to spare.
#: Not beyond the second bound: so coarse a net needs its gaps, and its angles suffered without them.
_ALLOWED_GAP, _COARSE_GAP = 1.8e-4, 4.5e-4
#: So many times harder, at most so often.
_TIGHTER, _TIGHTENINGS = 3.0, 2
#: A crease point that gapes more than this in an exact shape is stitched so many times harder, alone: at twice as
#: much paper counts as torn (verify).
_TORN_GAP, _MENDED = 0.01, 4.0
#: No weight becomes more than so many times the usual: beyond it the system loses its digits.
_HEAVIEST_EVER, _TIGHTEST = 1e6, 600.0


class PaperPull(Pull):
    """Isometry and continuity of one net."""

    def __init__(self, net: PiecewiseDog, isometry_weight: float, continuity_weight: float) -> None:
        self._net = net
        self._isometry = isometry(net, isometry_weight)
        self._continuity = continuity(net, continuity_weight)
        self._heavier = np.ones(len(net.edges))
        self._tighter = np.ones(len(net.stitches.vertices))
        self._tightened, self._held = 0, 0

    def terms(self) -> list[Term]:
        return [
            replace(self._isometry, weight=self._isometry.weight * self._heavier),
            replace(self._continuity, weight=self._continuity.weight * self._tighter),
        ]

    def settle(self, x: FloatArray) -> bool:
        """Of a fold that lacks something: hold harder, unless all of the paper is at its limit.

        Then others have to give way. Beyond what paper may show there is nothing to lose by it.
        """
        stretch = edge_stretch(self._net, x)
        mean = float(stretch.mean())
        beyond = mean > MAX_MEAN_STRETCH
        if self._held >= _MOST_HELD or (mean > _FULL * MEAN_BUDGET and not beyond):
            return False
        excess = stretch / (_STRETCHED if beyond else max(_STRETCHED, _TAUT * mean))
        stretched = excess > 1.0
        if not stretched.any():
            return False
        self._heavier = self._heavier * np.where(stretched, np.clip(_HARDER * excess, _HARDER, _HARDEST), 1.0)
        self._held += 1
        return True

    def share(self, x: FloatArray) -> bool:
        gap, stretch = gaps(self._net, x), edge_stretch(self._net, x)
        if self._tightened < _TIGHTENINGS and _ALLOWED_GAP < mean_gap(self._net, x) < _COARSE_GAP:
            tighter = np.full(len(gap), _TIGHTER)
            self._tightened += 1
        else:
            tighter = np.where(gap > _TORN_GAP, _MENDED, 1.0)
        self._tighter = np.minimum(self._tighter * tighter, _TIGHTEST)
        return self._hold(stretch) or bool((tighter > 1.0).any())

    def _hold(self, stretch: FloatArray) -> bool:
        if not (stretch > _ALLOWED_STRETCH).any():
            return False
        heavier = self._heavier * np.clip((stretch / _AIMED_STRETCH) ** 2, 1.0, _HEAVIEST)
        self._heavier = np.minimum(heavier, _HEAVIEST_EVER)
        return True

    def peak(self, x: FloatArray) -> float:
        """How far the worst edge, the mean gap and the worst gap are beyond what is allowed; 3: not at all.

        The mean gap counts by its root: what is shown is closed, and on coarse nets calm edges cost gaps.
        """
        stretch, gap = edge_stretch(self._net, x).max(), gaps(self._net, x).max(initial=0.0)
        mean = np.sqrt(mean_gap(self._net, x) / _ALLOWED_GAP)
        parts = stretch / _ALLOWED_STRETCH, mean, gap / _TORN_GAP
        return float(np.maximum(parts, 1.0).sum())

    def unshare(self) -> None:
        self._heavier, self._tighter = np.ones_like(self._heavier), np.ones_like(self._tighter)
        self._tightened = 0

    def wake(self) -> None:
        self.unshare()
        self._held = 0
