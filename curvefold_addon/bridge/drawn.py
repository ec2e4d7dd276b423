"""What overlays are made of, as arrays in a paper's local coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Single = NDArray[np.float32]
Indices = NDArray[np.int32]
Color = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class Lines:
    """points (2n,3) and colors (2n,4): n segments."""

    points: Single
    colors: Single


@dataclass(frozen=True, eq=False)
class Outline:
    """points (2n,3): n segments of one colour."""

    points: Single


@dataclass(frozen=True, eq=False)
class Surface:
    """points (R,3), colors (R,4), triangles (T,3)."""

    points: Single
    colors: Single
    triangles: Indices


@dataclass(frozen=True)
class Label:
    """A text at a place of the paper."""

    place: tuple[float, float, float]
    text: str
    color: Color


@dataclass(frozen=True, eq=False)
class Pulls:
    """lines to where points of the paper are drawn; points (H,3): all that are drawn; color of these marks."""

    lines: Lines
    points: Single
    color: Color


def single(values: NDArray[Any]) -> Single:
    """The same in single precision, as graphics cards want it."""
    return np.ascontiguousarray(values, dtype=np.float32)
