"""The fold condition at work: stiffer where points are not folded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..laid_flat import off_plane
from ..measurement import measure
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.fold_condition import fold_condition
from ..optimize.term import gather
from .pull import Pull, Term

#: On the way of a drag points are looked at every so many iterations. From so many times in a row on, what is not
#: folded is made this much stiffer at every look, up to the last. A paper that is nearer than this to flat, net
#: units, is left alone: nothing is folded there yet, or any more.
_LOOK_EVERY, _LOOKS, _DRAGGED_STIFFER, _DRAGGED_STIFFEST, _HARDLY_LIFTED = 10, 3, 4.0, 256.0, 0.1
#: Where points come to rest unfolded the condition is made this much stiffer, at most so often.
_STIFFER, _STIFFENINGS = 4.0, 3
#: What is not folded even then is made stiffer alone, this much, and so often: faint folds at grid edges that
#: nearly follow the crease, where the whole condition would have to be stiffer than the paper.
_ALONE_STIFFER, _ALONE_STIFFENINGS = 16.0, 3
#: A fold is safe while the tilts of its two sides, which should cancel, do so to this part.
_MARGIN = 0.5
#: A net whose vertices all lie within this of a plane is flat, net units.
FLAT = 1e-9


class ConditionPull(Pull):
    """``unfolding`` is set while the paper goes back to flat: then no point is asked to be folded."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight
        self._term = fold_condition(net, weight)
        self._stiffness, self._times = np.ones(len(self._term.stencil)), 0
        self._shared = np.ones(len(self._term.stencil))  # on top of it, once the shape is exact
        self._iterations, self._looks = 0, np.zeros(len(self._term.stencil), dtype=np.int64)
        self.unfolding = False

    def terms(self) -> list[Term]:
        if self._weight == 0:
            return []
        return [replace(self._term, weight=self._weight * self._stiffness * self._shared)]

    def keep_up(self, x: FloatArray) -> bool:
        """Before every step on the way of a drag: stiffer at points that stay unfolded.

        Whether any value has changed.
        """
        self._iterations += 1
        if self._iterations % _LOOK_EVERY:
            return False
        if not self._may_stiffen(x) or off_plane(x) < _HARDLY_LIFTED:
            self.look_away()
            return False
        self._looks = np.where(self._folded(x), 0, self._looks + 1)
        wanting = (self._looks >= _LOOKS) & (self._stiffness < _DRAGGED_STIFFEST)
        self._stiffness = np.where(wanting, _DRAGGED_STIFFER * self._stiffness, self._stiffness)
        return bool(wanting.any())

    def look_away(self) -> None:
        """What was seen on the way of a drag so far holds no longer."""
        self._looks = np.zeros_like(self._looks)

    def settle(self, x: FloatArray) -> bool:
        """Stiffer when some point is not folded, or so little that polishing could undo it."""
        if not self._may_stiffen(x):
            return False
        first, second = self._term.tilts(gather(np.ascontiguousarray(x.T), self._term.stencil))
        safe = np.abs(first + second) <= _MARGIN * np.abs(first - second)
        return self._stiffen(~(safe & self._folded(x)))

    def undone(self, x: FloatArray) -> bool:
        """Whether polishing to x has undone a faint fold and the condition has been made stiffer for it."""
        return self._may_stiffen(x) and self._stiffen(~self._folded(x))

    def share(self, x: FloatArray) -> bool:
        if not self._may_stiffen(x) or (folded := self._folded(x)).all():
            return False
        stiffer = np.minimum(
            np.where(folded, 1.0, _ALONE_STIFFER) * self._shared, _ALONE_STIFFER**_ALONE_STIFFENINGS
        )
        changed = not np.array_equal(stiffer, self._shared)
        self._shared = stiffer
        return changed

    def unshare(self) -> None:
        self._shared = np.ones_like(self._shared)

    def wake(self) -> None:
        self.unshare()

    def _folded(self, x: FloatArray) -> BoolArray:
        """(n,) whether each point that carries the condition is folded."""
        folded = measure(self._net, self._net.frame.to_drawing(x)).folded
        return np.asarray(folded[self._net.crease_points.carrier])

    def _may_stiffen(self, x: FloatArray) -> bool:
        asked = self._weight > 0 and len(self._net.crease_points.carrier) > 0
        return asked and not self.unfolding and off_plane(x) > FLAT

    def _stiffen(self, wanting: BoolArray) -> bool:
        """All points while some are wanting (n,), later only these; whether anything was done."""
        if not wanting.any() or self._times >= _STIFFENINGS + _ALONE_STIFFENINGS:
            return False
        stiffer = _STIFFER if self._times < _STIFFENINGS else np.where(wanting, _ALONE_STIFFER, 1.0)
        self._stiffness = self._stiffness * stiffer
        self._times += 1
        return True
