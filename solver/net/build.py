"""From a crease pattern to its piecewise DOG."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely
from shapely import Polygon

from ..arrays import FloatArray, IntArray
from ..description import AUTO, AUTO_VERTICES
from ..errors import NetError
from ..pattern.arrangement import Arrangement
from ..pattern.crease_pattern import CreasePattern
from .crease_points import find_crease_points
from .frame import NetFrame
from .grid import OrthogonalGrid
from .layout import Layout, lay_out
from .net_points import NodeCopies, node_copies
from .overlay import ON_LINE, Overlay
from .piecewise_dog import PiecewiseDog, Stitches
from .render_map import build_render_map
from .resolution import choose_layout


def build_net(
    pattern: CreasePattern, resolution: int | str = AUTO, max_vertices: int = AUTO_VERTICES
) -> PiecewiseDog:
    """The piecewise DOG of a crease pattern.

    resolution: quads along the sheet's longer side, or "auto" for as many as ``choose_resolution`` chooses.
    max_vertices: what "auto" may use. A pattern without a crease gives one patch of blank paper.

    Raises PatternError for a border that crosses itself and a drawing that is too much, and NetError when the
    resolution is out of range or the sheet is too thin for it.
    """
    if resolution != AUTO:
        return _assemble(pattern, lay_out(pattern, resolution), ())
    choice, layout = choose_layout(pattern, max_vertices)
    return _assemble(pattern, layout or lay_out(pattern, choice.quads), (choice.sentence,))


def _assemble(pattern: CreasePattern, layout: Layout, notes: tuple[str, ...]) -> PiecewiseDog:
    """notes: what is said before all else that was decided."""
    frame, arrangement, grid = layout.drawing.frame, layout.arrangement, layout.grid
    over, topology = layout.over, layout.topology
    copies = node_copies(over, topology, grid)
    chain_crease = np.array([chain.crease for chain in arrangement.chains], dtype=np.int64)
    flat = np.column_stack([grid.xs[topology.vertex_grid[:, 0]], grid.ys[topology.vertex_grid[:, 1]]])
    rest = frame.to_drawing(flat)
    surface = build_render_map(over, copies, chain_crease, frame.to_drawing(over.points), len(flat))
    points = find_crease_points(arrangement, over, topology, grid)
    polygons = _patch_polygons(arrangement, over, frame)
    said = [*notes, *layout.drawing.notes, *grid.notes]
    lost = sorted({int(chain_crease[chain]) for chain in over.lost_chains})
    if lost:
        labels = ", ".join(pattern.crease_label(k) for k in lost[:4])
        more = f" and {len(lost) - 4} more" if len(lost) > 4 else ""
        said.append(f"pieces smaller than a cell were left out: {labels}{more}; a finer resolution keeps them")
    if len(points.position) == 0 and arrangement.chains:
        raise NetError("no crease crosses the grid: use a finer resolution", element="creases")
    # Mean grid edge 1, whatever the asked cell was: the weights of the terms are meant for that scale.
    lengths = np.hypot(*(flat[topology.edges[:, 1]] - flat[topology.edges[:, 0]]).T)
    mean = float(lengths.mean())
    return _in_net_units(
        PiecewiseDog(
            rest, flat, frame, topology.quads, topology.quad_patch, topology.vertex_patch, topology.edges,
            lengths, topology.stars, topology.links, topology.neighbours,
            _stitches(over, copies, arrangement), points, surface, polygons, chain_crease,
            tuple(pattern.crease_label(k) for k in range(len(pattern.creases))),
            tuple(crease.assignment for crease in pattern.creases), tuple(said),
            grid, topology, arrangement.sheet, over, layout.resolution,
        ),
        mean,
    )  # fmt: skip


def _in_net_units(net: PiecewiseDog, mean: float) -> PiecewiseDog:
    """The same net with lengths divided by ``mean`` (cell lengths in, net units out)."""
    points = net.crease_points
    return replace(
        net,
        flat=_frozen(net.flat / mean),
        rest=_frozen(net.rest),
        frame=net.frame.scaled(mean),
        edge_length=_frozen(net.edge_length / mean),
        stitches=replace(net.stitches, position=net.stitches.position / mean),
        crease_points=replace(points, position=points.position / mean, along=points.along / mean),
        grid=OrthogonalGrid(net.grid.xs / mean, net.grid.ys / mean, net.grid.notes),
        sheet=shapely.transform(net.sheet, lambda p: p / mean),
        overlay=replace(net.overlay, points=net.overlay.points / mean),
    )


def _frozen(array: FloatArray) -> FloatArray:
    array.setflags(write=False)
    return array


def _stitches(over: Overlay, copies: NodeCopies, arrangement: Arrangement) -> Stitches:
    """Every node on a grid line, and every crease vertex, that has more than one copy."""
    count = np.diff(copies.start)
    wanted = (over.line_x >= 0) | (over.line_y >= 0)
    if len(arrangement.vertices):
        tree = shapely.STRtree(shapely.points(over.points))
        near = tree.query(shapely.points(arrangement.vertices), predicate="dwithin", distance=ON_LINE)
        wanted[near[1]] = True
    nodes = np.flatnonzero(wanted & (count > 1))
    first = np.repeat(copies.start[nodes], count[nodes] - 1)
    second: IntArray = np.concatenate(
        [np.arange(copies.start[n] + 1, copies.start[n + 1]) for n in nodes] or [np.zeros(0, dtype=np.int64)]
    )
    return Stitches(
        np.hstack([copies.vertices[first], copies.vertices[second]]),
        np.hstack([copies.weights[first], -copies.weights[second]]),
        over.points[copies.node[first]],
    )


def _patch_polygons(arrangement: Arrangement, over: Overlay, frame: NetFrame) -> tuple[Polygon, ...]:
    """One polygon a patch, drawing units: the union of its faces (a free crease end leaves no trace)."""
    face = np.repeat(np.arange(len(over.patch)), np.diff(over.loop_start))
    polygons = shapely.polygons(shapely.linearrings(over.points[over.loop_nodes], indices=face))
    order = np.argsort(over.patch, kind="stable")
    ends = np.cumsum(np.bincount(over.patch))
    result = []
    for faces in np.split(polygons[order], ends[:-1]):
        union = shapely.coverage_union_all(faces)
        if union.geom_type != "Polygon":
            union = shapely.union_all(faces, grid_size=1e-7)
        result.append(shapely.transform(union, frame.to_drawing))
    return tuple(result)
