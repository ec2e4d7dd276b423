"""Frames of a film that a paper follows: which shape it had in the last ones, and in the next.

A film consists of its whole frames, each folded on from the one before. What lies between two of them, as motion
blur asks for it, lies between their shapes, and a frame that is rendered again is as it was.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .hooks import Inputs, same

if TYPE_CHECKING:
    from .session import Ahead, Session

Array = NDArray[np.float64]

#: Frames that are remembered. A shutter that is open for two frames goes from the frame before to the next one.
_REMEMBERED = 4


@dataclass(frozen=True, eq=False)
class _Frame:
    """number; numbers: what the paper was told in it (``Inputs.numbers``); positions: its shape (V,3)."""

    number: int
    numbers: Array
    positions: Array


class Film:
    """frame: the last whole frame that the paper has followed, None before the first."""

    def __init__(self, session: Session) -> None:
        self.frame: int | None = None
        self._session = session
        self._known: deque[_Frame] = deque(maxlen=_REMEMBERED)
        self._next: tuple[_Frame, Ahead] | None = None

    # --- whole frames ----------------------------------------------------------------------------------------

    def begin(self, frame: int, inputs: Inputs, settling: int) -> None:
        """The first frame: what a flat sheet becomes. Blocking."""
        self.forget()
        self._session.start_anew(inputs, settling)
        self._note(frame, inputs)

    def follow(self, frame: int, inputs: Inputs, iterations: int) -> None:
        """The next frame: so many iterations on, which may have been made when it was looked ahead. Blocking."""
        known = self.is_known
        ahead = self._seen_ahead if known else None
        if ahead is not None and self._is(ahead[0], frame, inputs):
            self._session.arrive(ahead[1])
        else:
            self._session.advance(inputs, iterations)
        if not known:
            self.forget()
        self._note(frame, inputs)

    def leave(self, frame: int | None) -> None:
        """A frame is shown that the paper cannot follow at once."""
        self.forget()
        self.frame = frame

    def look_ahead(self, frame: int, inputs: Inputs, iterations: int) -> None:
        """Finds the shape of the next frame, and stays as it is. Blocking."""
        seen = self._seen_ahead
        if seen is None or not self._is(seen[0], frame, inputs):
            ahead = self._session.look_ahead(inputs, iterations)
            self._next = _Frame(frame, inputs.numbers(), ahead.positions), ahead

    def forget(self) -> None:
        """What comes is another film."""
        self._known.clear()
        self._next = None

    # --- asking ----------------------------------------------------------------------------------------------

    @property
    def is_known(self) -> bool:
        """Whether the paper is where its last frame left it: nothing else has moved it since."""
        return bool(self._known) and self._session.positions is self._known[-1].positions

    def is_at(self, frame: int, inputs: Inputs) -> bool:
        """Whether the paper has this frame's shape."""
        return self.is_known and self._is(self._known[-1], frame, inputs)

    def shape_of(self, frame: int, inputs: Inputs) -> Array | None:
        """The shape of a frame that was followed lately, told the same; None when it is not known."""
        if not self.is_known:
            return None
        return next((one.positions for one in self._known if self._is(one, frame, inputs)), None)

    def shape_at(self, time: float) -> Array | None:
        """The shape between two frames, in frames; None when one of them is not known."""
        frames = [*self._known] if self.is_known else []
        if frames and (ahead := self._seen_ahead) is not None:
            frames.append(ahead[0])
        for before, after in pairwise(frames):
            if before.number <= time <= after.number:
                part = (time - before.number) / (after.number - before.number)
                return before.positions + part * (after.positions - before.positions)
        return None

    def first_shape(self, time: float) -> Array | None:
        """The earliest known shape, where ``time`` is a frame before it at most; else None."""
        if self.is_known and 0.0 <= self._known[0].number - time <= 1.0:
            return self._known[0].positions
        return None

    def last_shape(self, time: float, within: float) -> Array | None:
        """The latest known shape, where ``time`` is so many frames after it at most; else None."""
        if self.is_known and 0.0 <= time - self._known[-1].number < within:
            return self._known[-1].positions
        return None

    @property
    def _seen_ahead(self) -> tuple[_Frame, Ahead] | None:
        return self._next if self._next is not None and self._session.ahead is self._next[1] else None

    def _is(self, one: _Frame, frame: int, inputs: Inputs) -> bool:
        return one.number == frame and same(one.numbers, inputs.numbers(), self._session.net.frame.unit)

    def _note(self, frame: int, inputs: Inputs) -> None:
        self._next = None
        while self._known and self._known[-1].number >= frame:
            self._known.pop()
        self._known.append(_Frame(frame, inputs.numbers(), self._session.positions))
        self.frame = frame
