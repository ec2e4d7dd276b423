"""What pulls at a paper: makes terms of the solver and leads their targets along a path."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from ..arrays import BoolArray, FloatArray
from ..optimize.term import LinearTerm, ResidualTerm

Term = ResidualTerm | LinearTerm


class Lack(Enum):
    """What a finding is about."""

    REACH = "a target in space is not reached"
    SIDE = "a crease did not fold to its side"
    ANGLE = "an angle is not reached"
    DEPTH = "the drive comes less far than it is set to"


@dataclass(frozen=True)
class Finding:
    """What was asked and not reached, in one sentence.

    held: the crease (from 0) that came less far than asked, of which the sentence does not yet say what holds it;
    None where there is none
    """

    lack: Lack
    sentence: str
    held: int | None = None


class Pull:
    """One kind of pull on one net. Shapes are x (V,3), net units.

    The terms of a pull may change their values at any time; ``FoldModel`` notices by itself when they change
    their structure. What a subclass does not need it leaves as it is here.
    """

    def terms(self) -> list[Term]:
        """Its terms with their present values."""
        return []

    def asks(self, x: FloatArray) -> bool:
        """Whether x has to move for it: a flat sheet is given its first fold only when something asks."""
        return False

    def sides(self) -> Mapping[int, int]:
        """Sides (+1 valley, -1 mountain) by crease that a flat sheet should start to fold to."""
        return {}

    def released(self) -> BoolArray | None:
        """Which of ``driven_points`` (n,) the angle drive should let alone, None for none."""
        return None

    def turning(self, x: FloatArray) -> frozenset[int]:
        """Creases that it is taking through flat to their other side."""
        return frozenset()

    def make_way(self, creases: frozenset[int], x: FloatArray) -> bool:
        """Let creases alone that others take through flat, and only these; whether any value has changed."""
        return False

    def begin(self, x: FloatArray) -> None:
        """The shape was changed from outside (the first fold): paths start from it."""

    def on_way(self) -> bool:
        """Whether targets still have to move."""
        return False

    def move(self, x: FloatArray, pace: float) -> bool:
        """Lead the targets at most ``pace`` usual steps on; whether they have moved."""
        return False

    def aim(self, x: FloatArray) -> bool:
        """Still in x, however soft the constraints: ask for more or less, so that what is measured is what was
        asked.

        Whether any value has changed.
        """
        return False

    def settle(self, x: FloatArray) -> bool:
        """At rest in x: give way, or pull harder. Whether any value has changed."""
        return False

    def share(self, x: FloatArray) -> bool:
        """In x, all but exact and at rest: hold harder where something gave way. Whether any value has changed."""
        return False

    def unshare(self) -> None:
        """The paper settles once more: back to the strength before ``share``. Handles keep theirs."""

    def shortfall(self, x: FloatArray) -> float:
        """How much x lacks of what was asked: grid edges off targets in space, parts of the drive's
        angle, and of the degrees by which an angle of its own counts as missed."""
        return 0.0

    def missed(self, x: FloatArray) -> int:
        """How many targets x does not reach."""
        return len(self.findings(x))

    def undone(self, x: FloatArray) -> bool:
        """In x, just made exact: hold harder what that has undone. Whether any value has changed."""
        return False

    def peak(self, x: FloatArray) -> float:
        """How far the worst places of the paper are beyond what is allowed."""
        return 0.0

    def let_go(self, part: float) -> bool:
        """The paper is stretched for it: pull with this part of the present strength, and no harder any more.

        Whether any value has changed.
        """
        return False

    def wake(self) -> None:
        """Other targets: back to the usual strength."""

    def mark(self) -> object:
        """How far the targets have come, for ``go_back``."""
        return None

    def go_back(self, mark: object) -> None:
        """Bring the targets back to where ``mark`` says they were."""

    def findings(self, x: FloatArray) -> list[Finding]:
        """What x lacks of all that was asked."""
        return []
