"""The shown surface as a linear map of the net: the outside culled, crease edges exact, no cracks."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import csr_matrix
from shapely import LineString, Polygon

from ..arrays import BoolArray, FloatArray, IntArray
from .net_points import NodeCopies
from .overlay import Overlay

#: Nodes of a curve inside a cell are kept where dropping them would move it by more than this, cell lengths.
_FLATNESS = 2e-3


@dataclass(frozen=True, eq=False)
class RenderMap:
    """A polygon mesh whose vertices are linear in the net's.

    weights (R,V) sparse; uv (R,2) the flat sheet, drawing units
    face_start (F+1,), face_vertices (L,) loops, counter-clockwise on the flat sheet; face_patch (F,)
    crease_edges (n,2) mesh edges on creases; crease_edge_crease (n,), crease_edge_chain (n,)
    A crease point is the mean of its copies, so both sides of a crease share their vertices exactly.
    """

    weights: csr_matrix
    uv: FloatArray
    face_start: IntArray
    face_vertices: IntArray
    face_patch: IntArray
    crease_edges: IntArray
    crease_edge_crease: IntArray
    crease_edge_chain: IntArray

    def apply(self, positions: FloatArray) -> FloatArray:
        """Surface vertices (R,3) of net vertices (V,3)."""
        return np.asarray(self.weights @ positions)

    def faces(self) -> list[IntArray]:
        """The loops one by one."""
        return np.split(self.face_vertices, self.face_start[1:-1])


def build_render_map(
    over: Overlay, copies: NodeCopies, chain_crease: IntArray, uv: FloatArray, vertex_count: int
) -> RenderMap:
    """uv (N,2): the overlay's nodes in drawing units."""
    keep = _kept_nodes(over) & (np.diff(copies.start) > 0)
    number = np.where(keep, np.cumsum(keep) - 1, -1)
    share = 1.0 / np.maximum(np.diff(copies.start), 1)
    some = keep[copies.node]
    rows = np.repeat(number[copies.node[some]], 4)
    values = (copies.weights[some] * share[copies.node[some]][:, None]).ravel()
    weights = csr_matrix((values, (rows, copies.vertices[some].ravel())), shape=(int(keep.sum()), vertex_count))
    weights.eliminate_zeros()
    starts, loops, patches = [0], [], []
    for f, loop in enumerate(np.split(over.loop_nodes, over.loop_start[1:-1])):
        for part in _simple_loops(over.points, loop[number[loop] >= 0]):
            loops.append(number[part])
            starts.append(starts[-1] + len(part))
            patches.append(over.patch[f])
    face_start, corners = np.array(starts, dtype=np.int64), np.concatenate(loops)
    edges, chains = _crease_edges(over, number)
    # Between two creases that all but touch, a face may vanish with its edges.
    shown = _are_sides(edges, face_start, corners)
    edges, chains = edges[shown], chains[shown]
    return RenderMap(
        weights,
        uv[keep],
        face_start,
        corners,
        np.array(patches, dtype=np.int64),
        edges,
        chain_crease[chains],
        chains,
    )


def _are_sides(edges: IntArray, face_start: IntArray, corners: IntArray) -> BoolArray:
    """Whether each of the edges (n,2) is one of the loops (F+1,), (L,)."""
    following = np.arange(1, len(corners) + 1)
    following[face_start[1:] - 1] = face_start[:-1]
    sides = np.sort(np.column_stack([corners, corners[following]]), axis=1)
    size = int(corners.max()) + 1
    asked = np.sort(edges, axis=1)
    return np.isin(asked[:, 0] * size + asked[:, 1], sides[:, 0] * size + sides[:, 1])


def _simple_loops(points: FloatArray, loop: IntArray) -> list[IntArray]:
    """The outline itself, or triangles where it touches itself (around a smaller face that hangs on a node)."""
    if len(loop) < 3:
        return []
    if len(np.unique(loop)) == len(loop):
        return [loop]
    nodes = np.unique(loop)
    place = {tuple(points[n]): n for n in nodes.tolist()}
    region = shapely.make_valid(Polygon(points[loop]))
    triangles = []
    for polygon in shapely.get_parts(region):
        if polygon.geom_type == "Polygon":
            for triangle in shapely.get_parts(shapely.constrained_delaunay_triangles(polygon)):
                corners = shapely.get_coordinates(shapely.orient_polygons(triangle))[:3]
                triangles.append(np.array([place[tuple(corner)] for corner in corners]))
    return triangles


def _plain(over: Overlay) -> BoolArray:
    """Nodes inside a cell that only give a curve its shape: two segments, same curve, off the grid."""
    count = len(over.points)
    degree = np.bincount(over.segments.ravel(), minlength=count)
    low = np.full(count, np.iinfo(np.int64).max)
    high = np.full(count, -2)
    for end in (0, 1):
        np.minimum.at(low, over.segments[:, end], over.chain)
        np.maximum.at(high, over.segments[:, end], over.chain)
    return (degree == 2) & (low == high) & (over.line_x < 0) & (over.line_y < 0)


def _runs(over: Overlay) -> list[list[int]]:
    """Node paths along curves between nodes that are not plain; closed runs inside a cell do not exist."""
    plain = _plain(over)
    curve = (over.chain >= 0) | over.border
    around: dict[int, list[int]] = {}
    for a, b in over.segments[curve].tolist():
        around.setdefault(a, []).append(b)
        around.setdefault(b, []).append(a)
    runs = []
    done: set[tuple[int, int]] = set()
    for start in around:
        if plain[start]:
            continue
        for step in around[start]:
            if (start, step) in done:
                continue
            path = [start, step]
            while plain[path[-1]]:
                onward = [n for n in around[path[-1]] if n != path[-2]]
                if not onward:
                    break
                path.append(onward[0])
            done.add((path[0], path[1]))
            done.add((path[-1], path[-2]))
            runs.append(path)
    return runs


def _kept_nodes(over: Overlay) -> BoolArray:
    keep = np.zeros(len(over.points), dtype=bool)
    keep[over.segments.ravel()] = True
    plain = _plain(over)
    keep[plain] = False
    for run in _runs(over):
        if len(run) < 3:
            continue
        points = over.points[run]
        simple = shapely.get_coordinates(LineString(points).simplify(_FLATNESS))
        kept = (points[:, None, :] == simple[None, :, :]).all(axis=2).any(axis=1)
        keep[np.array(run)[kept]] = True
    return keep


def _crease_edges(over: Overlay, number: IntArray) -> tuple[IntArray, IntArray]:
    chain_of = {(a, b): c for (a, b), c in zip(over.segments.tolist(), over.chain.tolist(), strict=True)}
    edges, chains = [], []
    for run in _runs(over):
        chain = chain_of[min(run[0], run[1]), max(run[0], run[1])]
        if chain < 0:
            continue
        kept = [number[n] for n in run if number[n] >= 0]
        for a, b in itertools.pairwise(kept):
            edges.append((a, b))
            chains.append(chain)
    return np.array(edges, dtype=np.int64).reshape(-1, 2), np.array(chains, dtype=np.int64)
