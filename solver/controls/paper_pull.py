"""The paper itself: edges keep their length and copies of crease points stay together, harder where they did not.

Energies spread an excess over many edges in the mean and leave peaks beside handles, creases and crease vertices.
At rest, edges that are stretched too far weigh more from then on, and so do all stitches when they gape in the
mean: what gave way is shared out among the neighbours (iteratively reweighted least squares).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..drive import MAX_MEAN_STRETCH, MEAN_BUDGET, edge_stretch
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.continuity import continuity, mean_gap
from ..objectives.isometry import isometry
from .pull import Pull, Term

#: An edge stretched by more than this at rest weighs more: the paper's 0.004 (section 6.1) with room to spare.
#: Where all of the paper is taut no edge can be that calm, and so many times the mean is allowed.
ALLOWED_STRETCH, _TAUT = 0.0035, 2.0
#: Its weight is multiplied by this and by how many times too long it is, up to the second, at most so often: after
#: that the drawing itself is in the way (a crossing, a cusp).
_HEAVIER, _HEAVIEST, _MOST_TIMES = 2.0, 9.0, 6
#: Stitches hold harder when they gape more than this in the mean at rest, net units: the paper's 2e-4 with room to
#: spare. Not beyond the second bound: so coarse a net needs its gaps, and its angles suffered without them.
ALLOWED_GAP, _COARSE_GAP = 1.4e-4, 4e-4
#: So many times harder, at most so often.
_TIGHTER, _TIGHTENINGS = 2.5, 2
#: With more than this part of the stretch budget in the mean nothing can be shared out any more.
_FULL = 0.95
#: Polishing may stretch an edge to this, or to so many times the mean, without being taken back for it, and is
#: taken back at most so often.
_POLISHED_STRETCH, _POLISHED_TAUT, _MOST_RETURNS = 0.005, 5.0, 2
#: Then it weighs so many times more: another way back costs twenty iterations.
_HEAVIER_POLISHED = 9.0


class PaperPull(Pull):
    """Isometry and continuity of one net."""

    def __init__(self, net: PiecewiseDog, isometry_weight: float, continuity_weight: float) -> None:
        self._net = net
        self._isometry = isometry(net, isometry_weight)
        self._continuity = continuity(net, continuity_weight)
        self._heavier = np.ones(len(net.edges))
        self._tightened = 0
        self._times, self._returns = 0, 0

    def terms(self) -> list[Term]:
        return [
            replace(self._isometry, weight=self._isometry.weight * self._heavier),
            replace(self._continuity, weight=self._continuity.weight * _TIGHTER**self._tightened),
        ]

    def settle(self, x: FloatArray) -> bool:
        """Hold harder what has given way, unless all of the paper is at its limit: then others have to give way.

        Beyond what paper may show there is nothing to lose by it, and some folds that were stuck get free.
        """
        stretch = edge_stretch(self._net, x)
        at_limit = _FULL * MEAN_BUDGET < stretch.mean() <= MAX_MEAN_STRETCH
        if self._times >= _MOST_TIMES or at_limit:
            return False
        taut = _TAUT * float(stretch.mean()) if stretch.mean() <= MAX_MEAN_STRETCH else 0.0
        excess = stretch / max(ALLOWED_STRETCH, taut)
        stretched = excess > 1.0
        gaping = self._tightened < _TIGHTENINGS and ALLOWED_GAP < mean_gap(self._net, x) < _COARSE_GAP
        if not (stretched.any() or gaping):
            return False
        self._heavier = np.where(stretched, np.minimum(_HEAVIER * excess, _HEAVIEST), 1.0) * self._heavier
        self._tightened += gaping
        self._times += 1
        return True

    def undone(self, x: FloatArray) -> bool:
        """Whether polishing to x has stretched edges too far, which then weigh more."""
        stretch = edge_stretch(self._net, x)
        stretched = stretch > max(_POLISHED_STRETCH, _POLISHED_TAUT * float(stretch.mean()))
        if not stretched.any() or self._returns >= _MOST_RETURNS or stretch.mean() > _FULL * MEAN_BUDGET:
            return False
        self._heavier = np.where(stretched, _HEAVIER_POLISHED, 1.0) * self._heavier
        self._returns += 1
        return True

    def give_way(self) -> bool:
        """Back to the usual weights, for good, because holding harder cost more than it brought; whether it did."""
        held = self.wake()
        self._times, self._returns = _MOST_TIMES, _MOST_RETURNS
        return held

    def wake(self) -> bool:
        changed = bool((self._heavier != 1.0).any() or self._tightened)
        self._heavier, self._tightened = np.ones(len(self._net.edges)), 0
        self._times, self._returns = 0, 0
        return changed
