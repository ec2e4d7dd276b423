"""A soft torque that folds what nothing else folds, and never flattens a deeper fold.

Flat is a resting place of a crease even where the paper around it bends. So when handles alone have bent the paper
and it has come to rest, every crease point that is shallower than the least fold is pulled towards it, to the side
to which most of its crease is folded, so softly that handles stay where they are. And whatever pulls: points that
come to rest flat are pulled to a faint fold, harder and harder.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..drive import HALF_ANGLE
from ..laid_flat import FLAT, off_plane
from ..measurement import measure
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.signed_fold import signed_fold, signed_points
from ..optimize.term import gather
from .pull import Pull, Term

#: Handles that the flat sheet misses by this part of its longer side ask for the whole of the least fold, those
#: that it misses by less for as much less: a short drag folds a little.
_WHOLE = 0.05
#: The sides are looked at every so many iterations. A point that is flat at so many looks in a row does not only
#: pass through flat, as all do while a drag begins: pulled sooner, an arc took the other side, 39° instead of 76°.
_LOOK_EVERY, _LOOKS = 5, 4
#: Points that rest flat are asked for so much more fold each time, degrees, and so many times harder, at most so
#: often.
_FAINT, _HARDER, _MOST_HARDER = 2.0, 8.0, 8


class LeastFold(Pull):
    """The one-sided signed-angle term on all creases. Its sides follow the paper: +1 valley, -1 mountain.

    ``unfolding`` is set while the paper goes back to flat: then no point is asked to be folded.
    """

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight * HALF_ANGLE
        self._points = signed_points(net)
        self._chain = net.crease_points.chain[self._points]
        self.creases = net.crease_points.crease[self._points]  # (n,) of the points, from 0
        self._term = signed_fold(net, self._points, np.zeros(len(self._points)), 0, 0.0, "least fold")
        self._size = float(np.ptp(net.flat, axis=0).max())
        self._released = np.zeros(len(self._points), dtype=bool)
        self._side: IntArray = np.ones(len(self._points), dtype=np.int64)
        self._degrees, self._part, self._iterations = 0.0, 0.0, 0
        self.unfolding = False
        self.start_anew()

    def set(self, degrees: float) -> None:
        """degrees: the least fold of a crease point while the paper is bent; 0 asks for none."""
        self._degrees = degrees

    def bend(self, off: float) -> None:
        """off: by how much the flat sheet misses the handles, net units; 0 where nothing has to bend."""
        self._part = min(off / (_WHOLE * self._size), 1.0)

    def start_anew(self) -> None:
        """The sheet is flat once more."""
        self._awake = False
        self._times = np.zeros(len(self._points), dtype=np.int64)
        self._looks = np.zeros(len(self._points), dtype=np.int64)  # how often in a row they were flat

    def give_way(self) -> bool:
        """Ask only for faint folds until handles are told anew: they are missed. Whether that is new."""
        given, self._part = self._part, 0.0
        return given > 0.0

    def release(self, points: BoolArray) -> bool:
        """Driven points (n,) that something else turns. Whether that is new."""
        changed = not np.array_equal(points, self._released)
        self._released = points
        return changed

    def begin(self, x: FloatArray) -> None:
        self._look(x)

    def aim(self, x: FloatArray) -> bool:
        """Handles have folded the sheet as far as they do by themselves: from here on it is folded further."""
        if self._awake or not self._shallow(x):
            return False
        self._awake = True
        self._look(x)
        return True

    def keep_up(self, x: FloatArray) -> bool:
        """Before every step: follow the side that each crease takes, and fold what a drag leaves flat on its way.

        Whether any value has changed.
        """
        self._iterations += 1
        if self._iterations % _LOOK_EVERY != 1:
            return False
        sided = self._look(x)
        if self._degrees * self._part < _FAINT:
            self._looks = np.zeros_like(self._looks)
            return sided
        self._looks = np.where(self._flat(x), self._looks + 1, 0)
        staying = (self._looks >= _LOOKS) & (self._times < _MOST_HARDER)
        self._times = self._times + staying
        return sided or bool(staying.any())

    def terms(self) -> list[Term]:
        if self._weight == 0 or len(self._points) == 0:
            return []
        least = self._degrees * self._part if self._awake else 0.0
        degrees = np.maximum(least, _FAINT * self._times)
        idle = self._released | (degrees == 0) | self.unfolding
        half = self._side * np.sin(np.radians(0.5 * degrees))
        weight = np.where(idle, 0.0, self._weight * _HARDER**self._times)
        return [replace(self._term, half=half, side=self._side, weight=weight)]

    def settle(self, x: FloatArray) -> bool:
        """Harder at points that rest flat, or on the other side than their crease."""
        flat = self._flat(x) & (self._times < _MOST_HARDER)
        if not flat.any():
            return False
        self._look(x)
        self._times = self._times + flat
        return True

    def missed(self, x: FloatArray) -> int:
        return int(self._flat(x).sum())

    def undone(self, x: FloatArray) -> bool:
        return self.settle(x)

    def share(self, x: FloatArray) -> bool:
        return self.settle(x)

    def _shallow(self, x: FloatArray) -> bool:
        """Whether some point is folded less than the least fold."""
        least = np.sin(np.radians(0.5 * self._degrees * self._part))
        return bool((np.abs(self._half_angles(x)) < least).any())

    def _half_angles(self, x: FloatArray) -> FloatArray:
        """(n,) sines of half the signed fold angles."""
        return self._term.half_angles(gather(np.ascontiguousarray(x.T), self._term.stencil))

    def _flat(self, x: FloatArray) -> BoolArray:
        """(n,) which points are not folded though the paper is bent; none while it unfolds."""
        if self.unfolding or self._weight == 0 or off_plane(x) <= FLAT:
            return np.zeros(len(self._points), dtype=bool)
        folded = measure(self._net, self._net.frame.to_drawing(x)).folded[self._points]
        return np.asarray(~folded & ~self._released)

    def _look(self, x: FloatArray) -> bool:
        """Take the side of each chain of points; whether any is new."""
        total = np.bincount(self._chain, self._half_angles(x), minlength=len(self._net.chain_crease))
        side = np.where(total < 0.0, -1, 1)[self._chain]
        changed = not np.array_equal(side, self._side)
        self._side = side
        return changed
