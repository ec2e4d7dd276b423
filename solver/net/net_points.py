"""Points of the sheet as combinations of net vertices: every node of the overlay, in every patch it touches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from .grid import OrthogonalGrid
from .overlay import Overlay
from .topology import Topology


@dataclass(frozen=True, eq=False)
class NodeCopies:
    """The distinct ways in which a node is a combination of vertices, sorted by node.

    node (M,); vertices (M,4) a quad; weights (M,4) bilinear, zero where a vertex does not count
    face (M,) an overlay face through which it is seen; start (N+1,) first copy of each node
    """

    node: IntArray
    vertices: IntArray
    weights: FloatArray
    face: IntArray
    start: IntArray


def bilinear(points: FloatArray, cell: IntArray, grid: OrthogonalGrid) -> FloatArray:
    """Weights (N,4) of the corners SW, SE, NE, NW of given cells (N,2) at points (N,2)."""
    x0, y0 = grid.xs[cell[:, 0]], grid.ys[cell[:, 1]]
    u = (points[:, 0] - x0) / (grid.xs[cell[:, 0] + 1] - x0)
    v = (points[:, 1] - y0) / (grid.ys[cell[:, 1] + 1] - y0)
    return np.column_stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])


def weights_at(over: Overlay, grid: OrthogonalGrid, nodes: IntArray, cell: IntArray) -> FloatArray:
    """Bilinear weights (M,4) of nodes in cells, exactly zero for corners off a grid line through the node."""
    points = over.points[nodes].copy()
    on_x, on_y = over.line_x[nodes], over.line_y[nodes]
    points[:, 0] = np.where(on_x >= 0, grid.xs[on_x], points[:, 0])
    points[:, 1] = np.where(on_y >= 0, grid.ys[on_y], points[:, 1])
    return bilinear(points, cell, grid)


def node_copies(over: Overlay, topology: Topology, grid: OrthogonalGrid) -> NodeCopies:
    """All copies of all overlay nodes."""
    face = np.repeat(np.arange(len(over.loop_start) - 1), np.diff(over.loop_start))
    node = over.loop_nodes
    solid = topology.face_quad[face] >= 0
    face, node = face[solid], node[solid]
    quad = topology.face_quad[face]
    vertices = topology.quads[quad]
    weights = weights_at(over, grid, node, over.cell[face])
    # Two copies are the same when their counting vertices are: compare sorted lists with -1 elsewhere.
    key = np.sort(np.where(np.abs(weights) > 0, vertices, -1), axis=1)
    _, first = np.unique(np.column_stack([node, key]), axis=0, return_index=True)
    first = first[np.lexsort((first, node[first]))]
    start = np.searchsorted(node[first], np.arange(len(over.points) + 1))
    return NodeCopies(node[first], vertices[first], weights[first], face[first], start)
