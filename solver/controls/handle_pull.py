"""Handles at work: targets on their way through space, and a harder pull where bending holds the paper back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray, IntArray
from ..drive import MAX_MEAN_STRETCH, MEAN_BUDGET, SHAREABLE_STRETCH, mean_stretch
from ..errors import HandleError
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.handles import AxisHandles, handles
from .firmness import Firmness
from .pull import Pull, Term

if TYPE_CHECKING:
    from ..description import Handle

#: A handle's target moves at most this far an iteration, net units: nine samples end in the same folds at 0.25,
#: 0.5 and 1.0, and a quick hand is followed four times as fast.
HANDLE_RATE = 1.0
#: Handles off their targets at rest pull this much harder, at most so often.
_STIFFER, _STIFFENINGS = 4.0, 3
#: Handles farther than this from their targets at rest pull harder, net units.
_CLOSE = 0.05
#: Handles that would count as missed pull a little harder even where the paper is stretched, up to this mean, and
#: oftener: a paper whose handles are missed holds harder meanwhile. No harder than would bring them to the second
#: distance.
_MISSED, _NEARER, _STIFFER_IF_MISSED, _NEARLY_STRETCHED, _STIFFENINGS_IF_MISSED = 0.25, 0.22, 1.6, 0.0028, 6
#: Handles that are near enough let go a little of a paper that they stretch too far: so much, while nearer than
#: this, net units, and from a mean stretch that no other remedy would lower.
_SOFTER, _ROOM, _FAR_STRETCHED = 1.25, 0.28, 0.005
#: A handle is reached within this distance, net units (method, section 4).
REACHED = 0.3
#: What is not reached may be pulled to this mean stretch: a little too far, and it lets go again.
_LAST_STRETCH = 0.00297
#: Handles nearer than this to each other hold one point, net units.
_SAME_POINT = 1e-6


class HandlePull(Pull):
    """All handles of a paper."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight
        self.handles: tuple[Handle, ...] = ()
        self._vertices = np.zeros((0, 4), dtype=np.int64)
        self._weights = np.zeros((0, 4))
        self._axes = np.ones((0, 3), dtype=bool)  # of the drawing, along which each handle pulls
        self._strengths = np.zeros(0)
        self._targets = np.zeros((0, 3))  # where the handles are drawn to in the end, net units
        self._paths = np.zeros((0, 3))  # where they are drawn to now
        self._firmness = Firmness(_STIFFENINGS_IF_MISSED)

    def __len__(self) -> int:
        return len(self.handles)

    def set(self, handles: Sequence[Handle], x: FloatArray) -> None:
        """Replace all handles. Handles that stay at the same point keep their way.

        Raises HandleError: a handle off the sheet, or two at one point with different targets.
        """
        located: list[tuple[IntArray, FloatArray]] = []
        for k, handle in enumerate(handles):
            try:
                located.append(self._net.locate(handle.at))
            except HandleError as error:
                raise HandleError(error.message, element=f"handle {k + 1}", place=handle.at) from None
        kept = _without_doubles(handles, self._net.frame.unit)
        handles = tuple(handles[k] for k in kept)
        vertices = np.array([located[k][0] for k in kept], dtype=np.int64).reshape(-1, 4)
        weights = np.array([located[k][1] for k in kept]).reshape(-1, 4)
        now = np.einsum("hk,hkc->hc", weights, x[vertices])
        same = [next((j for j, old in enumerate(self.handles) if old.at == new.at), None) for new in handles]
        paths = np.array([now[k] if j is None else self._paths[j] for k, j in enumerate(same)])
        self._axes = np.array([h.axes for h in handles], dtype=bool).reshape(-1, 3)
        self._strengths = np.array([h.strength for h in handles])
        self.handles, self._vertices, self._weights = handles, vertices, weights
        self._targets = self._net.frame.to_net(np.array([h.target for h in handles]).reshape(-1, 3))
        self._paths = paths.reshape(-1, 3)

    def gaps(self, x: FloatArray) -> FloatArray:
        """(H,) distances of the handles from their targets along the axes they pull along, net units."""
        places = np.einsum("hk,hkc->hc", self._weights, x[self._vertices])
        gaps = (places - self._targets) @ self._net.frame.axes().T
        return np.asarray(np.linalg.norm(gaps * self._axes, axis=1))

    def anchors(self) -> tuple[FloatArray, FloatArray]:
        """Points of the flat sheet (H,2) and targets (H,3), net units, of the handles that pull along all axes."""
        whole = self._axes.all(axis=1)
        at = np.einsum("hk,hkc->hc", self._weights, self._net.flat[self._vertices])
        return at[whole], self._targets[whole]

    def terms(self) -> list[Term]:
        stiffness = self._weight * self._firmness.factor * self._strengths
        whole = self._axes.all(axis=1)
        part = ~whole
        terms: list[Term] = []
        if whole.any():
            terms.append(handles(self._vertices[whole], self._weights[whole], self._paths[whole], stiffness[whole]))
        if part.any():
            axes = self._net.frame.axes()[:, None, :] * self._axes[part].T[:, :, None]
            terms.append(
                AxisHandles(self._vertices[part], self._weights[part], self._paths[part], axes, stiffness[part])
            )
        return terms

    def asks(self, x: FloatArray) -> bool:
        return bool(self.gaps(x).max(initial=0.0) > 1e-9)

    def on_way(self) -> bool:
        return not np.array_equal(self._targets, self._paths)

    def move(self, x: FloatArray, pace: float) -> bool:
        gap = self._targets - self._paths
        distance = np.linalg.norm(gap, axis=1)
        if not (distance > 0).any():
            return False
        share = np.minimum(1.0, HANDLE_RATE * pace / np.maximum(distance, 1e-300))
        self._paths = np.where((share >= 1.0)[:, None], self._targets, self._paths + share[:, None] * gap)
        return True

    def settle(self, x: FloatArray) -> bool:
        """Pull harder when handles stay off their targets though the paper is far from stretched, softer when they
        are near and it is stretched too far."""
        if not len(self.handles) or self._firmness.spent:
            return False
        gap, mean = float(self.gaps(x).max()), mean_stretch(self._net, x)
        bearable = _NEARLY_STRETCHED if gap <= REACHED else _LAST_STRETCH
        if gap > _CLOSE and mean <= 0.5 * MEAN_BUDGET and self._firmness.times < _STIFFENINGS:
            self._firmness.change(_STIFFER)
        elif gap > _MISSED and mean <= bearable:
            self._firmness.change(min(gap / _NEARER, _STIFFER_IF_MISSED))
        elif gap < _ROOM and MAX_MEAN_STRETCH < mean <= _FAR_STRETCHED:
            self._firmness.change(1.0 / _SOFTER)
        else:
            return False
        return True

    def share(self, x: FloatArray) -> bool:
        gap = float(self.gaps(x).max(initial=0.0))
        if gap <= _MISSED or mean_stretch(self._net, x) > SHAREABLE_STRETCH or self._firmness.spent:
            return False
        self._firmness.change(min(gap / _NEARER, _STIFFER_IF_MISSED))
        return True

    def let_go(self, part: float) -> bool:
        self._firmness.let_go(part)
        return bool(self.handles)

    def wake(self) -> None:
        self._firmness.wake()

    def shortfall(self, x: FloatArray) -> float:
        return float(np.maximum(self.gaps(x) - REACHED, 0.0).sum())

    def missed(self, x: FloatArray) -> int:
        return int((self.gaps(x) > REACHED).sum())

    def mark(self) -> object:
        return self._paths

    def go_back(self, mark: object) -> None:
        if isinstance(mark, np.ndarray) and mark.shape == self._paths.shape:
            self._paths = mark


def _without_doubles(handles: Sequence[Handle], unit: float) -> list[int]:
    """Indices of handles without repeats. Raises HandleError where one point has two targets.

    unit: drawing units in one net unit; points nearer than _SAME_POINT of it are one.
    """
    kept: list[int] = []
    for k, handle in enumerate(handles):
        here = [j for j in kept if math.dist(handles[j].at, handle.at) <= _SAME_POINT * unit]
        for j in here:
            other = handles[j]
            shared = [a for a in range(3) if handle.axes[a] and other.axes[a]]
            if any(handle.target[a] != other.target[a] for a in shared):
                raise HandleError(
                    f"it lies on the same point as handle {j + 1} but has another target",
                    element=f"handle {k + 1}",
                    place=handle.at,
                )
        if not any(handles[j].axes == handle.axes for j in here):
            kept.append(k)
    return kept
