"""What a net in space is like: stretch, gaps, DOG angles, fold angles. Independent of how it was made."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from .arrays import BoolArray, FloatArray, IntArray, frozen_array
from .net.crease_frames import CreaseFrames, crease_frames
from .net.piecewise_dog import PiecewiseDog

#: A crease is a mountain or valley when its points on one side outnumber the others by this part of all.
_ONE_SIDED = 0.8
#: A crease point folded by less than this is flat, degrees, and so is a crease whose median is less: a sheet that
#: was laid down keeps traces of a side, which nobody sees and nobody wants locked.
FLAT_ANGLE = 0.5
#: FOLD's letters of sides in words.
_SIDES = {"V": "valley", "M": "mountain"}


@dataclass(frozen=True, eq=False)
class Measurement:
    """Lengths are relative to the mean grid edge, angles in degrees.

    stretch (E,)          relative change of each net edge's length, unsigned
    continuity (C,)       gap between two copies of a crease point
    dog_angle (S,)        largest difference between the four angles around an inner vertex
    fold_angle (K,)       unsigned angle between the tangent planes, 0 flat, 180 folded shut; NaN at ends
    fold_sign (K,)        +1 valley, -1 mountain (seen from the front), 0 where there is no angle
    folded (K,)           whether both sides lie on one side of the osculating plane, FLAT_ANGLE apart or more; True
                          where the fold condition is not asked
    asked (K,)            whether the point carries the fold condition
    crease (K,)           the crease of each point; crease_position (K,2) on the flat sheet, drawing units
    """

    stretch: FloatArray
    continuity: FloatArray
    dog_angle: FloatArray
    fold_angle: FloatArray
    fold_sign: IntArray
    folded: BoolArray
    asked: BoolArray
    crease: IntArray
    crease_position: FloatArray

    @property
    def folded_part(self) -> float:
        """Part of the points that carry the fold condition which satisfy it; 1 when none carries it."""
        return float(self.folded[self.asked].mean()) if self.asked.any() else 1.0

    @property
    def not_folded(self) -> tuple[int, ...]:
        """Creases with a point that is not folded."""
        return tuple(int(c) for c in np.unique(self.crease[~self.folded]))

    def side(self, crease: int) -> str:
        """FOLD letter of what a crease became: V, M, or U where it is flat, changes sides or has no angle."""
        known = (self.crease == crease) & np.isfinite(self.fold_angle)
        sides = self.fold_sign[known]
        if len(sides) == 0 or abs(sides.sum()) < _ONE_SIDED * len(sides):
            return "U"
        if np.median(self.fold_angle[known]) < FLAT_ANGLE:
            return "U"
        return "V" if sides.sum() > 0 else "M"

    def side_in_words(self, crease: int) -> str:
        """The same for a user: "valley", "mountain", or why it is neither."""
        if (letter := self.side(crease)) in _SIDES:
            return _SIDES[letter]
        angles = self.fold_angle[(self.crease == crease) & np.isfinite(self.fold_angle)]
        return "flat" if len(angles) == 0 or np.median(angles) < FLAT_ANGLE else "partly valley and partly mountain"


def measure(net: PiecewiseDog, positions: ArrayLike) -> Measurement:
    """Measure positions (V,3), drawing units. Raises ValueError for another shape."""
    array = frozen_array(positions, np.float64, (len(net.rest), 3), "positions")
    x = net.frame.to_net(array)
    a, b = x[net.edges[:, 0]], x[net.edges[:, 1]]
    length = np.linalg.norm(b - a, axis=1)
    stitches = net.stitches
    gaps = np.einsum("ck,ckd->cd", stitches.weights, x[stitches.vertices])
    points = net.crease_points
    count = len(points.position)
    angle, sign = np.full(count, np.nan), np.zeros(count, dtype=np.int64)
    frames = _frames(net)
    signed = frames.angles(x)
    angle[frames.points] = np.abs(signed)
    sign[frames.points] = np.sign(signed).astype(np.int64)
    folded, asked = np.ones(count, dtype=bool), np.zeros(count, dtype=bool)
    if len(points.carrier):
        first, second = _tilts(net, x)
        # NaN (no angle there) is not flat.
        folded[points.carrier] = (first * second < 0) & ~(angle[points.carrier] < FLAT_ANGLE)
        asked[points.carrier] = True
    return Measurement(
        np.abs(length / net.edge_length - 1),
        np.linalg.norm(gaps, axis=1),
        _dog_angles(x, net.stars),
        angle,
        sign,
        folded,
        asked,
        points.crease,
        net.frame.to_drawing(points.position),
    )


@lru_cache(maxsize=4)
def _frames(net: PiecewiseDog) -> CreaseFrames:
    """What measuring needs of a net, kept for the nets in use (nets compare by identity)."""
    return crease_frames(net)


def _tilts(net: PiecewiseDog, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Sines of the tilts of both grid edges out of the crease's osculating plane, at the asked points.

    The crease's points are the means of their copies: the sag of a grid edge's chord is opposite on the two
    sides of a fold, so the mean stays in the osculating plane where a single copy does not.
    """
    points = net.crease_points
    left = np.einsum("kw,kwc->kc", points.left_weights, x[points.left_vertices])
    right = np.einsum("kw,kwc->kc", points.right_weights, x[points.right_vertices])
    # A piece too small for a quad has no copy on its side: there the other one stands for both.
    middle = np.where(points.right_vertices[:, :1] >= 0, 0.5 * (left + right), left)
    here = middle[points.carrier]
    back, front = (middle[points.fold_neighbours[:, k]] - here for k in (0, 1))
    binormal = np.cross(front, back)
    size = np.linalg.norm(front, axis=1) * np.linalg.norm(back, axis=1)
    tilts = []
    for a, b in ((0, 1), (2, 3)):
        edge = x[points.fold_vertices[:, b]] - x[points.fold_vertices[:, a]]
        scale = np.linalg.norm(edge, axis=1) * np.maximum(np.linalg.norm(binormal, axis=1), 1e-9 * size)
        tilts.append(np.einsum("kc,kc->k", edge, binormal) / scale)
    return tilts[0], tilts[1]


def _dog_angles(x: FloatArray, stars: IntArray) -> FloatArray:
    edges = x[stars[:, 1:]] - x[stars[:, :1]]
    after = np.roll(edges, -1, axis=1)
    sine = np.linalg.norm(np.cross(edges, after), axis=2)
    angles = np.degrees(np.arctan2(sine, np.einsum("skc,skc->sk", edges, after)))
    return np.asarray(angles.max(axis=1, initial=0.0) - angles.min(axis=1, initial=180.0))
