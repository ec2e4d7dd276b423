"""The way to far targets: as fast as the paper bears, with a way back when a shape degrades.

While targets move, the paper is watched. Strained, it goes on more slowly: many handles can only be reached
through shapes that stretch. Torn, it stops to relax. When neither ends, shape and targets go back to the last good
place and go on from there at half the pace, and after some such steps back the rest of the way is given up: the
paper then settles where it is, and what is missing is said in words.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..optimize.sqp import SqpState
from .control import ControlPull
from .pull import Pull

#: Mean stretch below which a shape is a good place to come back to, over which it is strained, and torn. On the
#: way no sample goes over 0.0062; a handle on every vertex of an exact state goes through 0.05.
_GOOD, _STRAINED, _TORN = 0.004, 0.008, 0.1
#: A strained shape goes on at this part of the pace; a torn one stays. After so many iterations that are strained,
#: or torn, one after the other, the way leads nowhere. What controls lead does not either when it has found no good
#: place in so many since its last step back: a flow that cannot arrive may be taut and not quite strained for long.
#: Handles are not bound by that: they arrive through such shapes.
_SLOWLY, _PATIENCE, _PATIENCE_TORN = 0.4, 120, 15
#: A place is kept at most every so many iterations.
_EVERY = 10
#: The pace is halved at each step back; good places let it grow again. The way is given up at the last step back.
_SLOWER, _FASTER, _MOST_BACK = 0.5, 1.3, 3


@dataclass(frozen=True, eq=False)
class _Place:
    state: SqpState
    marks: tuple[object, ...]


class Homotopy:
    """Watches one paper on its way."""

    def __init__(self) -> None:
        self.start_anew()

    def start_anew(self) -> None:
        """Other targets: forget the way so far."""
        self._pace, self._slowly = 1.0, False
        self.given_up, self.stepped_back = False, 0
        self._place: _Place | None = None
        self._strained, self._torn, self._since, self._astray = 0, 0, 0, 0

    def may_move(self, stretch: float, state: SqpState, pulls: Sequence[Pull]) -> bool:
        """Whether the targets may move on from a shape with this mean stretch; keeps good places."""
        if self.given_up:
            return False
        self._slowly = stretch > _STRAINED
        self._strained = self._strained + 1 if stretch > _STRAINED else 0
        self._torn = self._torn + 1 if stretch > _TORN else 0
        led = self.stepped_back > 0 and any(isinstance(pull, ControlPull) and pull.on_way() for pull in pulls)
        self._astray = self._astray + 1 if led and stretch >= _GOOD else 0
        if self.lost or stretch > _TORN:
            return False
        self._since += 1
        if stretch < _GOOD and (self._place is None or self._since >= _EVERY):
            self._place = _Place(state, tuple(pull.mark() for pull in pulls))
            self._since = 0
            self._pace = min(1.0, self._pace * _FASTER)
        return True

    @property
    def pace(self) -> float:
        """The part of the usual step that targets may move now."""
        return self._pace * (_SLOWLY if self._slowly else 1.0)

    @property
    def lost(self) -> bool:
        """Whether the paper has been strained or torn, or taut after a step back, for too long."""
        too_long = max(self._strained, self._astray) > _PATIENCE or self._torn > _PATIENCE_TORN
        return not self.given_up and too_long

    def step_back(self, pulls: Sequence[Pull]) -> SqpState | None:
        """Bring the pulls back to the last good place and return the shape there; None when there is none.

        The pace falls; after some steps back the rest of the way is given up.
        """
        self._strained, self._torn, self._since, self._astray = 0, 0, 0, 0
        self._pace *= _SLOWER
        self.stepped_back += 1
        self.given_up = self.stepped_back >= _MOST_BACK or self._place is None
        if self._place is None:
            return None
        for pull, mark in zip(pulls, self._place.marks, strict=True):
            pull.go_back(mark)
        return self._place.state
