"""What the shape of a paper is like, as attributes of its mesh, for shaders and Geometry Nodes.

fold_angle   edges, radians: a valley positive, a mountain negative, 0 off the creases
assignment   edges: 1 on a valley, -1 on a mountain, 0 where nothing is folded
stretch      points: how much longer or shorter the paper is there, 0.01 for one per cent
ruling       faces: the direction in which the paper does not bend there, of length 1 in the paper's own
             coordinates; 0 where it is plane. It takes long to find, so only papers have it that were asked for it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...solver import Measurement, PiecewiseDog, Rulings
from .mesh import ASSIGNMENT, FOLD_ANGLE, RULING, STRETCH, attribute, edges_of
from .overlay import edge_points, sides_found, vertex_stretch

Array = NDArray[np.float64]

#: A face with no ruling of its patch nearer than this is plane, relative to the sheet's longer side.
_NEAR = 0.06
#: Points of each line that stand for it, and how many of all of them are looked at.
_SAMPLES, _CANDIDATES = 33, 8


def is_measured(mesh: Any) -> bool:
    """Whether a mesh has the attributes that ``write_measured`` gives it."""
    return all(name in mesh.attributes for name in (FOLD_ANGLE, ASSIGNMENT, STRETCH))


def write_measured(mesh: Any, net: PiecewiseDog, measured: Measurement) -> None:
    """Fold angles, sides and stretch of a net, as they were measured, on the mesh that shows it."""
    edges = edges_of(mesh, net.render_map.crease_edges)
    points = edge_points(net)
    # The last entry speaks for edges without a point.
    angles = np.append(np.radians(np.nan_to_num(measured.fold_angle)) * measured.fold_sign, 0.0)
    angle, side = np.zeros(len(mesh.edges), dtype=np.float32), np.zeros(len(mesh.edges), dtype=np.int32)
    angle[edges] = angles[points]
    side[edges] = np.append(sides_found(measured), 0)[points]
    stretch = net.render_map.apply(vertex_stretch(net, measured)).astype(np.float32)
    attribute(mesh, FOLD_ANGLE, "FLOAT", "EDGE").data.foreach_set("value", angle)
    attribute(mesh, ASSIGNMENT, "INT", "EDGE").data.foreach_set("value", side)
    attribute(mesh, STRETCH, "FLOAT", "POINT").data.foreach_set("value", stretch)


def asks_for_rulings(mesh: Any) -> bool:
    """Whether a paper's mesh is to have its rulings."""
    return RULING in mesh.attributes


def write_rulings(mesh: Any, net: PiecewiseDog, found: Rulings) -> None:
    """The direction of the nearest ruling of its patch on each face; the paper's mesh has them from now on."""
    surface = net.render_map
    count = len(surface.face_patch)
    face = np.repeat(np.arange(count), np.diff(surface.face_start))
    corners = surface.uv[np.asarray(surface.face_vertices)]
    sums = np.stack([np.bincount(face, corners[:, k], count) for k in range(2)], axis=-1)
    middle: Array = sums / np.bincount(face, minlength=count)[:, None]
    near = _NEAR * float(np.ptp(surface.uv, axis=0).max())
    direction = np.zeros((count, 3))
    for patch in np.unique(found.patch):
        faces, lines = np.flatnonzero(surface.face_patch == patch), np.flatnonzero(found.patch == patch)
        distance, nearest = _nearest(middle[faces], found.flat[lines])
        line = lines[nearest]
        step = found.segments[line, 1] - found.segments[line, 0]
        # A line has no sense: on the flat sheet it points to the right, or up.
        flat = found.flat[line, 1] - found.flat[line, 0]
        sense = np.where(np.where(np.abs(flat[:, 0]) > 1e-9 * near, flat[:, 0], flat[:, 1]) < 0.0, -1.0, 1.0)
        length = np.maximum(np.linalg.norm(step, axis=1), 1e-300)
        direction[faces] = np.where(distance <= near, sense / length, 0.0)[:, None] * step
    values = np.ascontiguousarray(direction, dtype=np.float32).ravel()
    attribute(mesh, RULING, "FLOAT_VECTOR", "FACE").data.foreach_set("vector", values)
    mesh.update()


def _nearest(points: Array, lines: Array) -> tuple[Array, NDArray[np.int64]]:
    """Distance (N,) of points (N,2) from the nearest of lines (R,2,2), and which one that is."""
    start, step = lines[:, 0], lines[:, 1] - lines[:, 0]
    # All lines would be many for each point; a few whose samples are near are enough.
    share = np.linspace(0.0, 1.0, _SAMPLES)[None, :, None]
    samples = (start[:, None] + share * step[:, None]).reshape(-1, 2)
    _, found = cKDTree(samples).query(points, k=min(_CANDIDATES, len(samples)))
    line = found.reshape(len(points), -1) // _SAMPLES
    gap = points[:, None] - start[line]
    along = np.einsum("nkc,nkc->nk", gap, step[line]) / np.maximum((step[line] ** 2).sum(axis=2), 1e-300)
    miss = np.linalg.norm(gap - np.clip(along, 0.0, 1.0)[:, :, None] * step[line], axis=2)
    best = miss.argmin(axis=1)
    row = np.arange(len(points))
    return miss[row, best], line[row, best]
