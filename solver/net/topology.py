"""Quads, vertices and stencils of the piecewise DOG: one quad for each piece of a cell that a patch touches.

Two pieces share the two vertices of a grid edge when the sheet goes on across that edge, so a crease (also
one that ends inside the sheet, or passes a cell twice) separates exactly what it separates on paper.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..arrays import BoolArray, IntArray
from .grid import OrthogonalGrid
from .overlay import MIN_PIECE, Overlay

# A quad's corners are SW, SE, NE, NW; corner k looks into sector k, between directions k and k + 1 of
# +x, +y, -x, -y. The neighbours of corner k in these two directions:
_FIRST = (1, 2, 3, 0)
_SECOND = (3, 0, 1, 2)


@dataclass(frozen=True, eq=False)
class Topology:
    """face_quad (F,) quad of an overlay face or -1; quads (Q,4) vertices SW, SE, NE, NW; quad_cell (Q,2)

    quad_patch (Q,); vertex_grid (V,2) grid indices; vertex_patch (V,)
    edges (E,2) in the +x or +y direction; neighbours (V,4) in +x, +y, -x, -y or -1
    stars (S,5) inner vertices: centre, +x, +y, -x, -y
    links (L,4) elsewhere: centre, and three neighbours a quarter turn apart, counter-clockwise
    """

    face_quad: IntArray
    quads: IntArray
    quad_cell: IntArray
    quad_patch: IntArray
    vertex_grid: IntArray
    vertex_patch: IntArray
    edges: IntArray
    neighbours: IntArray
    stars: IntArray
    links: IntArray


def build_topology(over: Overlay, grid: OrthogonalGrid) -> Topology:
    """Glue the cell pieces of an overlay into patches."""
    cell_area = (np.diff(grid.xs)[over.cell[:, 0]]) * (np.diff(grid.ys)[over.cell[:, 1]])
    solid = over.area > MIN_PIECE * cell_area
    slot_of, count = _glue(over, solid)
    vertex_of = slot_of.reshape(-1, 4)
    faces = np.flatnonzero(solid)
    raw = vertex_of[faces]
    # vertices are numbered by patch, then by rows of the grid: neighbours in memory are neighbours on paper
    offsets = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    place = over.cell[faces][:, None, :] + offsets[None]
    vertex_grid = np.zeros((count, 2), dtype=np.int64)
    vertex_patch = np.full(count, -1, dtype=np.int64)
    vertex_grid[raw] = place
    vertex_patch[raw] = over.patch[faces][:, None]
    used = np.unique(raw)
    order = used[np.lexsort((vertex_grid[used, 0], vertex_grid[used, 1], vertex_patch[used]))]
    number = np.full(count, -1, dtype=np.int64)
    number[order] = np.arange(len(order))
    raw = number[raw]
    quads, first, inverse = np.unique(raw, axis=0, return_index=True, return_inverse=True)
    face_quad = np.full(len(over.area), -1, dtype=np.int64)
    face_quad[faces] = inverse.reshape(-1)
    edges = np.unique(np.vstack([quads[:, [0, 1]], quads[:, [3, 2]], quads[:, [0, 3]], quads[:, [1, 2]]]), axis=0)
    vertex_grid, vertex_patch = vertex_grid[order], vertex_patch[order]
    along_x = vertex_grid[edges[:, 0], 1] == vertex_grid[edges[:, 1], 1]
    neighbours = np.full((len(order), 4), -1, dtype=np.int64)
    for axis, some in ((0, edges[along_x]), (1, edges[~along_x])):
        neighbours[some[:, 0], axis] = some[:, 1]
        neighbours[some[:, 1], axis + 2] = some[:, 0]
    stars, links = _stencils(quads, neighbours)
    return Topology(
        face_quad, quads, over.cell[faces][first], over.patch[faces][first],
        vertex_grid, vertex_patch, edges, neighbours, stars, links,
    )  # fmt: skip


def _glue(over: Overlay, solid: BoolArray) -> tuple[IntArray, int]:
    """Vertex number of each corner slot (4F,), and how many there are."""
    a, b = over.segments.T
    inner = (over.chain < 0) & ~over.border & (over.left >= 0) & (over.right >= 0)
    inner &= solid[over.left] & solid[over.right]
    pairs = []
    vertical = inner & (over.line_x[a] >= 0) & (over.line_x[a] == over.line_x[b])
    horizontal = inner & ~vertical
    for some, axis, corners in ((vertical, 0, ((1, 0), (2, 3))), (horizontal, 1, ((3, 0), (2, 1)))):
        f, g = over.left[some], over.right[some]
        # A face thinner than rounding may have been told the wrong cell: it shares no edge.
        apart = over.cell[g] - over.cell[f]
        next_to = (np.abs(apart[:, axis]) == 1) & (apart[:, 1 - axis] == 0)
        f, g = f[next_to], g[next_to]
        swap = over.cell[f, axis] > over.cell[g, axis]
        low, high = np.where(swap, g, f), np.where(swap, f, g)
        for here, there in corners:
            pairs.append(np.column_stack([4 * low + here, 4 * high + there]))
    joined = np.vstack(pairs)
    size = 4 * len(over.area)
    graph = coo_matrix((np.ones(len(joined)), (joined[:, 0], joined[:, 1])), shape=(size, size))
    count, label = connected_components(graph, directed=False)
    return np.asarray(label, dtype=np.int64), int(count)


def _stencils(quads: IntArray, neighbours: IntArray) -> tuple[IntArray, IntArray]:
    count = len(neighbours)
    centre = quads.T.reshape(-1)  # all SW corners, then SE, NE, NW
    sector = np.repeat(np.arange(4), len(quads))
    first = np.concatenate([quads[:, k] for k in _FIRST])
    second = np.concatenate([quads[:, k] for k in _SECOND])
    # An ordinary inner vertex has one corner in each sector, and neighbouring corners share their edges.
    per_sector = np.zeros((count, 4), dtype=np.int64)
    np.add.at(per_sector, (centre, sector), 1)
    matches = (first == neighbours[centre, sector]) & (second == neighbours[centre, (sector + 1) % 4])
    agree = np.ones(count, dtype=bool)
    np.logical_and.at(agree, centre, matches)
    is_star = agree & (per_sector == 1).all(axis=1)
    where = np.flatnonzero(is_star)
    stars = [np.column_stack([where, neighbours[where]])]
    links: list[tuple[int, int, int, int]] = []
    corners: dict[int, list[tuple[int, int, int]]] = defaultdict(list)
    for k in np.flatnonzero(~is_star[centre]).tolist():
        corners[int(centre[k])].append((int(sector[k]), int(first[k]), int(second[k])))
    for vertex in sorted(corners):
        star, rows = _irregular(vertex, sorted(corners[vertex]))
        if star is not None:
            stars.append(np.array([star]))
        links.extend(rows)
    return np.vstack(stars), np.array(links, dtype=np.int64).reshape(-1, 4)


def _irregular(
    vertex: int, corners: list[tuple[int, int, int]]
) -> tuple[tuple[int, ...] | None, list[tuple[int, int, int, int]]]:
    """A full turn of corners when there is one, and one link for each further pair that shares an edge."""
    parent = list(range(len(corners)))

    def root(k: int) -> int:
        while parent[k] != k:
            k = parent[k]
        return k

    star = None
    by_sector: dict[int, list[int]] = defaultdict(list)
    for k, (sector, _, _) in enumerate(corners):
        by_sector[sector].append(k)
    for k0 in by_sector[0]:
        turn = [k0]
        for sector in (1, 2, 3):
            onward = [k for k in by_sector[sector] if corners[k][1] == corners[turn[-1]][2]]
            if not onward:
                break
            turn.append(onward[0])
        if len(turn) == 4 and corners[turn[3]][2] == corners[k0][1]:
            star = (vertex, *(corners[k][1] for k in turn))
            for k in turn[1:]:
                parent[root(k)] = root(k0)
            break
    links = []
    for k, (sector, a, b) in enumerate(corners):
        for m in by_sector[(sector + 1) % 4]:
            if corners[m][1] == b and root(k) != root(m):
                parent[root(m)] = root(k)
                links.append((vertex, a, b, corners[m][2]))
    return star, links
