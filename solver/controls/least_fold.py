"""A soft torque beside handles: it folds the creases that handles leave flat, and never flattens a deeper fold.

Flat is a resting place of a crease even where the paper around it bends. So while handles bend the paper, every
crease point that is shallower than the least fold is pulled towards it, so softly that handles stay where they are.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import BoolArray
from ..drive import HALF_ANGLE
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.fold_angle import driven_points, fold_angle
from .pull import Pull, Term

#: Handles that the flat sheet misses by this part of its longer side ask for the whole of the least fold, those
#: that it misses by less for as much less: a short drag folds a little.
_WHOLE = 0.05


class LeastFold(Pull):
    """The one-sided fold-angle term on all creases."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight * HALF_ANGLE
        self._count = len(driven_points(net))
        self._size = float(np.ptp(net.flat, axis=0).max())
        self._released = np.zeros(self._count, dtype=bool)
        self._degrees, self._part = 0.0, 0.0

    def set(self, degrees: float) -> None:
        """degrees: the least fold of a crease point while the paper is bent; 0 asks for none."""
        self._degrees = degrees

    def bend(self, off: float) -> None:
        """off: by how much the flat sheet misses the handles, net units; 0 where nothing has to bend."""
        self._part = min(off / (_WHOLE * self._size), 1.0)

    def release(self, points: BoolArray) -> bool:
        """Driven points (n,) that something else turns. Whether that is new."""
        changed = not np.array_equal(points, self._released)
        self._released = points
        return changed and bool(self.terms())

    def terms(self) -> list[Term]:
        degrees = self._degrees * self._part
        if degrees == 0 or self._weight == 0:
            return []
        weight = np.where(self._released, 0.0, self._weight)
        term = fold_angle(self._net, np.full(self._count, degrees), weight)
        return [replace(term, least=True, name="least fold")]
