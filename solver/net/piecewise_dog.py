"""The piecewise DOG: overlapping quad nets, one a patch, stitched at crease points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Polygon

from ..arrays import FloatArray, IntArray
from ..errors import HandleError
from .crease_points import CreasePoints
from .frame import NetFrame
from .grid import OrthogonalGrid
from .net_points import bilinear
from .overlay import Overlay
from .render_map import RenderMap
from .topology import Topology

#: A handle this far off the sheet is put on its border, part of the mean grid edge (rounding in drawings).
HANDLE_TOLERANCE = 0.05


@dataclass(frozen=True, eq=False)
class Stitches:
    """Pairs of copies of one point that must coincide.

    vertices (C,8) four of each copy; weights (C,8) bilinear, the second four negative: their sum is the gap
    position (C,2) net units
    """

    vertices: IntArray
    weights: FloatArray
    position: FloatArray


@dataclass(frozen=True, eq=False)
class PiecewiseDog:
    """A net with all that is constant about it. V vertices (copies counted), Q quads, E edges, P patches.

    rest (V,2) flat positions, drawing units; flat (V,2) the same in net units (mean grid edge 1)
    frame between the two; quads (Q,4) counter-clockwise; quad_patch (Q,); vertex_patch (V,)
    edges (E,2); edge_length (E,) rest lengths, net units
    stars (S,5) inner vertices: centre, +x, +y, -x, -y; links (L,4) centre and three neighbours in turn
    neighbours (V,4) in +x, +y, -x, -y or -1
    stitches, crease_points, render_map; patch_polygons: flat patches, drawing units, index = patch
    chain_crease: crease index of each chain; crease_letters: FOLD letter that each crease is drawn with; notes:
    what was repaired or merged, one sentence each resolution: quads along the sheet's longer side that were used
    """

    rest: FloatArray
    flat: FloatArray
    frame: NetFrame
    quads: IntArray
    quad_patch: IntArray
    vertex_patch: IntArray
    edges: IntArray
    edge_length: FloatArray
    stars: IntArray
    links: IntArray
    neighbours: IntArray
    stitches: Stitches
    crease_points: CreasePoints
    render_map: RenderMap
    patch_polygons: tuple[Polygon, ...]
    chain_crease: IntArray
    crease_labels: tuple[str, ...]
    crease_letters: tuple[str, ...]
    notes: tuple[str, ...]
    grid: OrthogonalGrid
    topology: Topology
    sheet: Polygon
    overlay: Overlay
    resolution: int

    def locate(self, at: tuple[float, float]) -> tuple[IntArray, FloatArray]:
        """Vertices (4,) and bilinear weights (4,) of a point of the flat sheet (drawing units).

        Raises HandleError when the point is off the sheet, saying by how much.
        """
        place = self.frame.to_net(np.array([at], dtype=np.float64))
        point = shapely.Point(place[0])
        distance = float(self.sheet.distance(point))
        if not distance <= HANDLE_TOLERANCE:
            raise HandleError(f"the point is off the sheet by {distance * self.frame.unit:.3g}", place=tuple(at))
        if distance > 0:
            nearest = shapely.shortest_line(self.sheet, point)
            place = shapely.get_coordinates(nearest)[:1]
        return self._copy_at(place)

    def _copy_at(self, place: FloatArray) -> tuple[IntArray, FloatArray]:
        grid, over = self.grid, self.overlay
        # Every cell that touches the point: four at a grid vertex; then the piece that holds it.
        cells = set()
        for dx in (-1e-6, 1e-6):
            for dy in (-1e-6, 1e-6):
                i = int(np.clip(np.searchsorted(grid.xs, place[0, 0] + dx) - 1, 0, len(grid.xs) - 2))
                j = int(np.clip(np.searchsorted(grid.ys, place[0, 1] + dy) - 1, 0, len(grid.ys) - 2))
                cells.add((i, j))
        best, best_face = np.inf, -1
        point = shapely.Point(place[0])
        for i, j in sorted(cells):
            for f in np.flatnonzero((over.cell == (i, j)).all(axis=1) & (self.topology.face_quad >= 0)):
                loop = over.loop_nodes[over.loop_start[f] : over.loop_start[f + 1]]
                distance = float(Polygon(over.points[loop]).distance(point))
                if distance < best - 1e-9:
                    best, best_face = distance, int(f)
        cell = over.cell[best_face][None]
        weights = bilinear(place, cell, grid)[0]
        weights[np.abs(weights) < 1e-6] = 0.0
        return self.topology.quads[self.topology.face_quad[best_face]], weights / weights.sum()
