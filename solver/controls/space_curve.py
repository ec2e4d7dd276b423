"""Polylines in space by their edge lengths, curvatures and torsions (method, section 5).

A turn between two edges that are chords of one circle of curvature k is asin(k l1 / 2) + asin(k l2 / 2), and
its circle through three points gives k back: measuring and building are each other's inverse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..arrays import FloatArray

#: Sines of half turns are kept below this: sharper curves cannot be built with such long edges.
_SHARPEST = 0.99


@dataclass(frozen=True, eq=False)
class CurveShape:
    """curvature (n-2,) at the inner points, signed: the binormal carries on along the curve, and where the curve
    turns against it the curvature is negative. torsion (n-3,) at the inner edges. Both in 1 / length.
    """

    curvature: FloatArray
    torsion: FloatArray


def measure_curve(points: FloatArray, first_sign: float = 1.0) -> CurveShape:
    """The shape of points (n,3), n at least 3. first_sign: sign of the first curvature that is not zero."""
    edges = np.diff(points, axis=0)
    length = np.linalg.norm(edges, axis=1)
    turn = np.cross(edges[:-1], edges[1:])
    size = np.linalg.norm(turn, axis=1)
    chord = np.linalg.norm(points[2:] - points[:-2], axis=1)
    curvature = 2 * size / (length[:-1] * length[1:] * chord)
    straight = size < 1e-9 * length[:-1] * length[1:]
    binormal = _carried(turn, size, straight, edges, first_sign)
    signed = np.where(np.einsum("nc,nc->n", turn, binormal) < 0, -curvature, curvature)
    middle = edges[1:-1] / length[1:-1, None]
    sine = np.einsum("nc,nc->n", np.cross(binormal[:-1], binormal[1:]), middle)
    cosine = np.einsum("nc,nc->n", binormal[:-1], binormal[1:])
    return CurveShape(signed, np.arctan2(sine, cosine) / length[1:-1])


def _carried(
    turn: FloatArray, size: FloatArray, straight: FloatArray, edges: FloatArray, first_sign: float
) -> FloatArray:
    """(n-2,3) unit binormals that never jump to the opposite one; over straight places the last one carries on."""
    result = np.zeros_like(turn)
    known = np.flatnonzero(~straight)
    if len(known) == 0:
        # A straight curve: any direction across it serves.
        across = np.eye(3)[int(np.argmin(np.abs(edges[0])))]
        normal = np.cross(edges[0], across)
        result[:] = normal / np.linalg.norm(normal)
        return result
    last = first_sign * turn[known[0]] / size[known[0]]
    for k in range(len(turn)):
        if not straight[k]:
            here = turn[k] / size[k]
            last = here if here @ last >= 0 else -here
        result[k] = last
    return result


def build_curve(arc: FloatArray, shape: CurveShape) -> FloatArray:
    """Points (n,3) with arcs (n-1,) between them: starts at the origin along +x, binormal +z."""
    n = len(arc) + 1
    k = np.abs(shape.curvature)
    on_edge = np.concatenate([k[:1], 0.5 * (k[:-1] + k[1:]), k[-1:]])
    half = 0.5 * on_edge * arc
    # Chords are shorter than their arcs.
    chord = arc * np.where(half > 1e-6, np.sin(half) / np.maximum(half, 1e-12), 1.0)
    sines = [np.clip(0.5 * shape.curvature * c, -_SHARPEST, _SHARPEST) for c in (chord[:-1], chord[1:])]
    turns = np.arcsin(sines[0]) + np.arcsin(sines[1])
    tangent, binormal = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    points = np.zeros((n, 3))
    for i in range(n - 1):
        if i > 0:
            side = np.cross(binormal, tangent)
            tangent = np.cos(turns[i - 1]) * tangent + np.sin(turns[i - 1]) * side
            if i < n - 2:
                angle = shape.torsion[i - 1] * chord[i]
                binormal = np.cos(angle) * binormal + np.sin(angle) * np.cross(tangent, binormal)
        points[i + 1] = points[i] + chord[i] * tangent
    return points


def laid_onto(points: FloatArray, places: FloatArray) -> FloatArray:
    """Points (n,3) moved rigidly, without a mirror, as near to places (n,3) as they can be (Kabsch 1976)."""
    a, b = points - points.mean(axis=0), places - places.mean(axis=0)
    u, _, vt = np.linalg.svd(a.T @ b)
    u[:, 2] *= np.sign(np.linalg.det(u @ vt))
    return np.asarray(a @ (u @ vt) + places.mean(axis=0))


def resampled(points: FloatArray, at: FloatArray) -> FloatArray:
    """Points (n,3) at arc lengths ``at`` (n,) along a polyline (m,3), by a cubic through it."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    new = np.concatenate([[True], np.diff(length) > 0])  # a point that is given twice counts once
    points, length = points[new], length[new]
    if len(points) < 3:
        return np.column_stack([np.interp(at, length, points[:, c]) for c in range(3)])
    return np.asarray(CubicSpline(length, points)(at))
