"""How hard something pulls: more or less than usual, changed a few times at rest, back when it is told anew."""

from __future__ import annotations


class Firmness:
    """How hard, in parts of the usual strength."""

    def __init__(self, most: int) -> None:
        """most: how often it may change until it is told anew."""
        self.times = 0
        self._most = most
        self._held, self._left = 1.0, 1.0

    @property
    def factor(self) -> float:
        return self._held * self._left

    @property
    def spent(self) -> bool:
        """Whether it has changed as often as it may, or was let go."""
        return self.times >= self._most or self._left < 1.0

    def change(self, by: float) -> None:
        """Pull so many times harder."""
        self._held, self.times = self._held * by, self.times + 1

    def let_go(self, part: float) -> None:
        """Pull with this part of the present strength, and no harder any more."""
        self._left *= part

    def take_hold(self) -> None:
        """Back to the strength before it was let go."""
        self._left = 1.0

    def wake(self) -> None:
        """Back to the usual strength."""
        self._held, self._left, self.times = 1.0, 1.0, 0
