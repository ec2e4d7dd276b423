"""The Gauss image of a folded net: the normals of its quads as points of the unit sphere.

Of bent paper it is a curve, because the normal turns across the rulings and not along them; of plane paper it is
a point, and only of paper that is stretched an area.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_matrix

from .arrays import BoolArray, FloatArray, IntArray, frozen_array
from .net.paper_share import paper_shares
from .net.piecewise_dog import PiecewiseDog

#: A quad is shown with this part of the paper that the fullest quad of its patch has: what is less is mostly an
#: extension past a crease or the border, held by few neighbours, and its normal is noise.
_SHOWN = 0.5
#: Patches whose normals stay so near to their mean are plane: their image is shown as a star with arms of that
#: length. Radians, and of the ball's radius.
_POINT, ARM = np.radians(1.5), np.radians(4.0)


@dataclass(frozen=True, eq=False)
class GaussImage:
    """The normals of the quads as points of the unit sphere.

    normals (Q,3) towards the sheet's front; pairs (A,2) quads that share an edge; patch (Q,) of each quad
    shown (Q,) quads with enough paper for their normals to mean something, at least one a patch
    lines (n,2) the pairs of which both quads are shown
    """

    normals: FloatArray
    pairs: IntArray
    patch: IntArray
    shown: BoolArray
    lines: IntArray

    def strokes(self) -> tuple[FloatArray, IntArray]:
        """(n,2,3) segments that draw the image, and (n,) their patches.

        These are the lines, and a star of three arms, seen from all sides, instead of those of a patch whose image
        is but a point.
        """
        place, patch = self._points()
        across = _across(place)
        up = np.cross(place, across)
        arms = [np.stack([place - ARM * arm, place + ARM * arm], axis=1) for arm in (across, up, place)]
        is_point = np.zeros(int(self.patch.max(initial=-1)) + 1, dtype=bool)
        is_point[patch] = True
        lines = self.lines[~is_point[self.patch[self.lines[:, 0]]]]
        segments = np.concatenate([self.normals[lines], *arms])
        return segments, np.concatenate([self.patch[lines[:, 0]], patch, patch, patch])

    def _points(self) -> tuple[FloatArray, IntArray]:
        """(n,3) mean normals of the patches that are plane, and which patches these are."""
        normals, patch = self.normals[self.shown], self.patch[self.shown]
        count = int(patch.max(initial=-1)) + 1
        mean: FloatArray = np.zeros((count, 3))
        np.add.at(mean, patch, normals)
        mean /= np.maximum(_lengths(mean), np.finfo(float).tiny)[:, None]
        spread = np.full(count, -1.0)
        np.maximum.at(spread, patch, _lengths(normals - mean[patch]))
        plane = np.flatnonzero((spread >= 0.0) & (spread < _POINT))
        return mean[plane], plane


def gauss_image(net: PiecewiseDog, positions: ArrayLike) -> GaussImage:
    """Unit normals of all quads of positions (V,3), with their adjacency. Raises ValueError for another shape."""
    x = frozen_array(positions, np.float64, (len(net.rest), 3), "positions")
    return GaussImage(quad_normals(net.quads, x), _quad_pairs(net), net.quad_patch, _shown(net), _lines(net))


def quad_normals(quads: IntArray, x: FloatArray) -> FloatArray:
    """(Q,3) unit normals: the cross product of the diagonals is second order at a quad's centre on any grid."""
    normal = np.cross(x[quads[:, 2]] - x[quads[:, 0]], x[quads[:, 3]] - x[quads[:, 1]])
    return normal / np.maximum(_lengths(normal), np.finfo(float).tiny)[:, None]


def gauss_area(net: PiecewiseDog, positions: ArrayLike) -> float:
    """How much area the Gauss image of positions (V,3) covers, steradians: none of smooth paper, more of ripples.

    The unsigned areas that the normals of the four quads around each inner vertex span on the sphere, summed: the
    total absolute curvature, which bent paper has none of. Raises ValueError for another shape.
    """
    x = frozen_array(positions, np.float64, (len(net.rest), 3), "positions")
    normals = quad_normals(net.quads, x)[_quads_around(net)]
    return 0.5 * float(_lengths(np.cross(normals[:, 0] - normals[:, 2], normals[:, 1] - normals[:, 3])).sum())


def _lengths(vectors: FloatArray) -> FloatArray:
    """(n,) of vectors (n,3); norm is three times as slow for so short rows."""
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def _across(normals: FloatArray) -> FloatArray:
    """(n,3) unit vectors at right angles to unit vectors (n,3)."""
    # The axis along which a vector is shortest is never parallel to it.
    axis = np.eye(3)[np.abs(normals).argmin(axis=1)]
    across = np.cross(normals, axis)
    return across / _lengths(across)[:, None]


@lru_cache(maxsize=4)
def _quad_pairs(net: PiecewiseDog) -> IntArray:
    """(A,2) quads that share two vertices."""
    count = len(net.quads)
    rows = np.repeat(np.arange(count), 4)
    incidence = csr_matrix((np.ones(4 * count), (rows, net.quads.ravel())), shape=(count, len(net.rest)))
    shared = (incidence @ incidence.T).tocoo()
    some = (shared.row < shared.col) & (shared.data >= 2)
    pairs = np.column_stack([shared.row[some], shared.col[some]]).astype(np.int64)
    pairs.setflags(write=False)
    return pairs


@lru_cache(maxsize=4)
def _quads_around(net: PiecewiseDog) -> IntArray:
    """(n,4) the shown quads around inner vertices of patches, in turn."""
    around = np.full((len(net.rest), 4), -1, dtype=np.int64)
    for corner in range(4):
        around[net.quads[:, corner], corner] = np.arange(len(net.quads))
    whole = around[(around >= 0).all(axis=1)]
    whole = whole[_shown(net)[whole].all(axis=1)]
    whole.setflags(write=False)
    return whole


@lru_cache(maxsize=4)
def _shown(net: PiecewiseDog) -> BoolArray:
    share = paper_shares(net)
    fullest = np.zeros(int(net.quad_patch.max(initial=-1)) + 1)
    np.maximum.at(fullest, net.quad_patch, share)
    shown = share >= _SHOWN * fullest[net.quad_patch]
    shown.setflags(write=False)
    return shown


@lru_cache(maxsize=4)
def _lines(net: PiecewiseDog) -> IntArray:
    pairs = _quad_pairs(net)
    lines = pairs[_shown(net)[pairs].all(axis=1)]
    lines.setflags(write=False)
    return lines
