"""Shapes in which a fold could rest, and which of them is best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .arrays import FloatArray


@dataclass(frozen=True, order=True)
class RestMerit:
    """What speaks against a shape, the worst first; less is better.

    faults: what the certificate finds; missed: handles, pairs, sides and angles that it does not reach;
    short: how much more it lacks of them than the first shape did, ``Pull.shortfall``;
    peak: how far its worst edge and its gaps are beyond what is allowed
    """

    faults: int
    missed: int
    short: float
    peak: float


@dataclass(frozen=True, eq=False)
class RestingShape:
    """x (V,3), net units; exact: whether its DOG angles are."""

    merit: RestMerit
    x: FloatArray
    exact: bool = False


def best(shapes: Sequence[RestingShape]) -> RestingShape:
    """The best of some, the first of equals."""
    return min(shapes, key=lambda shape: shape.merit)
