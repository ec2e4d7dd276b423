"""How long a person needs for what the guide asks, without waiting for anybody to try: the keystroke-level model.

S. K. Card, T. P. Moran, A. Newell, The keystroke-level model for user performance time with interactive systems,
Communications of the ACM 23 (1980). Its figures are seconds, for people who do a thing without error.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

POINT = 1.1  # moving the mouse to a place; a drag or a stroke is taken as one more
PRESS = 0.2  # a button or a key
HOME = 0.4  # a hand from the mouse to the keyboard or back
THINK = 1.35  # before each of these but the press of a button where the mouse is already
#: Words of English prose that people read silently in a minute: M. Brysbaert, Journal of Memory and Language 109
#: (2019).
READ = 238.0

_PICTURE = re.compile(r"!\[[^]]*\]\([^)]*\)")


@dataclass(frozen=True)
class Estimate:
    """clicks, keys, drags; seconds to do them, and to read words."""

    clicks: int
    keys: int
    drags: int
    doing: float
    words: int
    reading: float

    @property
    def seconds(self) -> float:
        return self.doing + self.reading

    def __str__(self) -> str:
        return (
            f"{self.clicks} clicks, {self.keys} keys, {self.drags} drags: {self.doing:.0f} s; "
            f"{self.words} words: {self.reading:.0f} s; together {self.seconds:.0f} s"
        )


def estimate(actions: Iterable[str], text: str) -> Estimate:
    """For the actions of a ``Screen`` and the text, in Markdown, that asks for them."""
    done = _as_done(actions)
    count = Counter(done)
    homes = sum((first == "key") != (second == "key") for first, second in pairwise(done))
    moves = count["point"] + count["draw"]
    presses = count["press"] + count["key"]
    doing = POINT * moves + PRESS * presses + HOME * homes + THINK * (moves + count["key"])
    words = len(_PICTURE.sub("", text).split())
    return Estimate(count["press"], count["key"], count["draw"], doing, words, 60.0 * words / READ)


def _as_done(actions: Iterable[str]) -> Sequence[str]:
    """Without the moves of the mouse after which another one follows: the tests put it out of the way."""
    listed = list(actions)
    following = [*listed[1:], ""]
    return [a for a, b in zip(listed, following, strict=True) if not (a == "point" and b in ("point", ""))]
