"""The Gauss image of a paper on a ball beside it, as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...solver import PiecewiseDog, gauss_image
from ...solver.arrays import FloatArray, IntArray
from .drawn import Color, Lines, Single, single

#: Display colours (sRGB) of patches, in turn: told apart by all eyes, on dark grey and on white paper.
PATCH_COLORS: tuple[Color, ...] = (
    (0.90, 0.56, 0.00, 1.0),
    (0.25, 0.66, 0.95, 1.0),
    (0.00, 0.66, 0.47, 1.0),
    (0.86, 0.36, 0.10, 1.0),
    (0.80, 0.47, 0.65, 1.0),
    (0.94, 0.86, 0.25, 1.0),
    (0.10, 0.45, 0.80, 1.0),
)
BALL: Color = (0.70, 0.70, 0.72, 0.35)
#: Of the sheet's longer side: the ball's radius, and the least distance between it and the paper.
RADIUS, GAP = 0.25, 0.15
#: Points of a circle.
_CIRCLE = 64


@dataclass(frozen=True)
class Place:
    """A ball in the paper's local coordinates."""

    centre: tuple[float, float, float]
    radius: float


@dataclass(frozen=True, eq=False)
class GaussBall:
    """circles: of the unit ball; image: on it.

    marks: of each colour in the image, a point in each patch of the paper that has it
    low, high (3,) the paper's box; longer_side of the flat sheet
    """

    circles: Lines
    image: Lines
    marks: tuple[tuple[Color, Single], ...]
    low: FloatArray
    high: FloatArray
    longer_side: float

    def beside(self, way: Sequence[float]) -> Place:
        """Where the ball lies when it is beside the paper in a direction (3,)."""
        return beside(self.low, self.high, self.longer_side, way)


def box(shown: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest coordinates (3,) of (R,3)."""
    columns = np.ascontiguousarray(shown.T)
    return columns.min(axis=1), columns.max(axis=1)


def beside(low: FloatArray, high: FloatArray, longer_side: float, way: Sequence[float]) -> Place:
    """A ball beside a box in a direction (3,): every point of it is farther that way than all of the box."""
    unit = np.asarray(way, dtype=np.float64) / np.linalg.norm(way)
    radius = RADIUS * longer_side
    reach = 0.5 * float(np.abs(unit) @ (high - low))
    x, y, z = (0.5 * (low + high) + (reach + GAP * longer_side + radius) * unit).tolist()
    return Place((x, y, z), radius)


def ball(net: PiecewiseDog, positions: FloatArray, shown: FloatArray) -> GaussBall:
    """The ball of a paper with this net, vertices at positions (V,3) and at (R,3) as it is shown."""
    strokes, patch = gauss_image(net, positions).strokes()
    palette = np.array(PATCH_COLORS, dtype=np.float32)
    return GaussBall(
        _circles(),
        Lines(single(strokes.reshape(-1, 3)), palette[patch % len(palette)].repeat(2, axis=0)),
        _marks(net, positions),
        *box(shown),
        longer_side(net),
    )


@lru_cache(maxsize=4)
def longer_side(net: PiecewiseDog) -> float:
    """Of the flat sheet, the paper's units."""
    return float(np.ptp(net.flat, axis=0).max()) * net.frame.unit


def great_circles() -> FloatArray:
    """(3,n,3) closed circles round the unit ball, across x, y and z."""
    turn = 2 * np.pi * np.arange(_CIRCLE) / _CIRCLE
    flat = np.stack([np.cos(turn), np.sin(turn), np.zeros(_CIRCLE)])
    return np.stack([np.roll(flat, k, axis=0).T for k in (1, 2, 0)])


@lru_cache(maxsize=1)
def _circles() -> Lines:
    circles = great_circles()
    segments = np.stack([circles, np.roll(circles, -1, axis=1)], axis=2).reshape(-1, 3)
    return Lines(single(segments), np.tile(np.array(BALL, dtype=np.float32), (len(segments), 1)))


def _marks(net: PiecewiseDog, positions: FloatArray) -> tuple[tuple[Color, Single], ...]:
    vertices, weights, patch = _middles(net)
    points = np.einsum("pk,pkc->pc", weights, positions[vertices])
    turn = patch % len(PATCH_COLORS)
    return tuple((PATCH_COLORS[k], single(points[turn == k])) for k in np.unique(turn).tolist())


@lru_cache(maxsize=4)
def _middles(net: PiecewiseDog) -> tuple[IntArray, FloatArray, IntArray]:
    """A point inside each patch that has a quad: vertices (P,4) and weights (P,4) that carry it, patch (P,)."""
    patches = np.unique(net.quad_patch)
    places = [net.patch_polygons[patch].representative_point() for patch in patches]
    carriers = [net.locate((place.x, place.y)) for place in places]
    return np.array([v for v, _ in carriers]), np.array([w for _, w in carriers]), patches
