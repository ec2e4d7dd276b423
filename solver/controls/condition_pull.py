"""The fold condition on all creases."""

from __future__ import annotations

from ..net.piecewise_dog import PiecewiseDog
from ..objectives.fold_condition import fold_condition
from .pull import Pull, Term


class ConditionPull(Pull):
    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._term = fold_condition(net, weight)
        self._weight = weight

    def terms(self) -> list[Term]:
        return [self._term] if self._weight > 0 else []
