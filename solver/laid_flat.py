"""The flat sheet laid where a bent one is."""

from __future__ import annotations

import numpy as np

from .arrays import FloatArray

#: A net whose vertices all lie within this of a plane is flat, net units.
FLAT = 1e-9
#: How much more an anchor counts than all vertices together, and in how many passes the rest of it goes away.
_ANCHOR, _PASSES = 1e8, 3


def laid_flat(flat: FloatArray, x: FloatArray, anchors: FloatArray, targets: FloatArray) -> FloatArray:
    """The flat sheet (V,2) moved rigidly to lie on x (V,3) as well as it goes, its anchors (H,2) on targets (H,3).

    Least squares, in which the anchors outweigh the vertices: where they leave a freedom, the vertices decide.
    """
    weight = np.concatenate([np.full(len(flat), 1.0 / len(flat)), np.full(len(anchors), _ANCHOR)])
    weight /= weight.sum()
    start = np.vstack([flat, anchors])
    start = np.column_stack([start, np.zeros(len(start))])
    a = weight @ start
    for _ in range(_PASSES):
        goal = np.vstack([x, targets])
        b = weight @ goal
        u, _, vt = np.linalg.svd((start - a).T @ ((goal - b) * weight[:, None]))
        u[:, 2] *= np.sign(np.linalg.det(u @ vt))
        x = (start[: len(flat)] - a) @ u @ vt + b
    return np.asarray(x)


def off_plane(x: FloatArray) -> float:
    """How thick x (V,3) is: its extent along the normal of the plane nearest to it."""
    centred = x - x.mean(axis=0)
    normal = np.linalg.svd(centred.T @ centred)[0][:, 2]
    return float(np.ptp(np.einsum("nc,c->n", centred, normal)))
