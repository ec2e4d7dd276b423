"""Rulings of a folded net: the straight lines of the bent paper, and where it is plane.

Along a ruling the normal does not turn. So the direction of a ruling at a point of the flat sheet is the one
along which the quads' normals change least, and a whole ruling is the straight line through its patch along
which they change least on average: one line has many quads to say where it runs, one quad only its neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache

import numpy as np
import shapely
from numpy.typing import ArrayLike
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree
from shapely import Polygon

from .arrays import BoolArray, FloatArray, IntArray, frozen_array
from .gauss_image import quad_normals
from .net.paper_share import paper_areas, paper_shares
from .net.piecewise_dog import PiecewiseDog

#: Without a spacing, so many rulings lie beside each other along the sheet's longer side.
DEFAULT_COUNT = 28
#: Paper is plane where its normal turns less than this over the sheet's longer side, radians.
PLANE_TURN = np.radians(6.0)
#: Seeds for rulings lie this far apart, parts of the spacing: rulings are as even as seeds are dense.
_SEED_SPACING = 1 / 3
#: The spacing may be wider than asked where no seed fits better, and narrower by this part of itself.
_SLACK = 0.9
#: A line is a ruling when the normal turns along it at most this part as fast as across it (root mean square).
_STRAIGHT = 0.45
#: No more than this part of a ruling may be in plane paper (there only because quads are coarse).
_PLANE_PART = 0.25
#: A seed whose line is no ruling speaks for those around it too, parts of the spacing.
_GIVEN_UP = 0.75
#: Samples along a line, and how often its direction is found again from them.
_SAMPLES, _TURNS = 13, 3
#: This part of a ruling's length from its end is inside: the quad there holds the end, lines may not cross there.
_INWARD = 1e-3
#: Quads weigh by the part of them that is paper, but at least this much: the rest of them is an extension.
_LEAST_WEIGHT = 0.02
#: Seeds this equal are a tie, which the first in the lattice wins: equal shapes give equal rulings.
_TIE = 1e-6
#: A ruling's kind is judged with so many neighbours in its patch, itself included.
_WINDOW = 15
#: Rulings are parallel when their directions spread by less than this over the sheet's longer side, radians.
_PARALLEL = np.radians(12.0)
#: Rulings are concurrent when they pass their common point this near, parts of their distance from it.
_CONCURRENT = 0.035


class RulingKind(IntEnum):
    """What the rulings around a ruling do."""

    CYLINDRICAL = 0
    CONICAL = 1
    GENERAL = 2


@dataclass(frozen=True, eq=False)
class Rulings:
    """R rulings in drawing units, and the plane parts of the sheet.

    segments (R,2,3) in space; flat (R,2,2) on the flat sheet; vertices, weights (R,2,4) their ends on the net
    patch (R,); kind (R,) of RulingKind; plane (Q,) quads that do not bend
    """

    segments: FloatArray
    flat: FloatArray
    vertices: IntArray
    weights: FloatArray
    patch: IntArray
    kind: IntArray
    plane: BoolArray

    def carried(self, positions: FloatArray) -> FloatArray:
        """(R,2,3) the same lines on the sheet where the net's vertices are at positions (V,3)."""
        return _placed(self.vertices, self.weights, positions)

    def summary(self, net: PiecewiseDog) -> dict[str, int | float]:
        """How many there are of each kind, and the part of the sheet that is plane."""
        counts: dict[str, int | float] = {kind.name.lower(): int((self.kind == kind).sum()) for kind in RulingKind}
        areas = paper_areas(net)
        return counts | {"plane_part": round(float(areas[self.plane].sum() / areas.sum()), 6)}


def rulings(net: PiecewiseDog, positions: ArrayLike, spacing: float | None = None) -> Rulings:
    """The rulings of positions (V,3), about ``spacing`` apart in the middle, drawing units.

    Raises ValueError for positions of another shape, and for a spacing that is not positive.
    """
    x = frozen_array(positions, np.float64, (len(net.rest), 3), "positions")
    size = float(np.ptp(net.flat, axis=0).max()) * net.frame.unit
    spacing = size / DEFAULT_COUNT if spacing is None else float(spacing)
    if not spacing > 0:
        raise ValueError("the spacing of rulings must be positive")
    field = _field(net, spacing)
    at_quads = field.at_quads(quad_normals(net.quads, x))
    turning = field.at_seeds(at_quads)
    flat, patches = [], []
    for patch in field.patches:
        found = patch.lines(turning[patch.seeds], spacing, PLANE_TURN / size)
        flat.extend(found)
        patches.extend([patch.index] * len(found))
    lines = np.array(flat).reshape(-1, 2, 2)
    patch_of = np.array(patches, dtype=np.int64)
    vertices, weights = _carriers(net, lines, patch_of)
    return Rulings(
        _placed(vertices, weights, x),
        lines,
        vertices,
        weights,
        patch_of,
        _kinds(lines, patch_of, size),
        _bend(at_quads) < PLANE_TURN / size,
    )


# --- how the normals turn --------------------------------------------------------------------------------


def _bend(turning: FloatArray) -> FloatArray:
    """(N,) curvature of turnings (N,2,2)."""
    return np.sqrt(np.trace(turning, axis1=-2, axis2=-1))


@dataclass(frozen=True, eq=False)
class _Field:
    """What is constant for a net and a spacing.

    slope_x, slope_y (Q,Q) sparse: the derivatives on the flat sheet of what is given at the quads
    mix (S,Q) sparse: values at the seeds; patches
    """

    slope_x: csr_matrix
    slope_y: csr_matrix
    mix: csr_matrix
    patches: tuple[_Patch, ...]

    def at_quads(self, normals: FloatArray) -> FloatArray:
        """(Q,2,2) how fast the normals (Q,3) turn: squared speeds as a quadratic form of the direction."""
        slopes = np.stack([self.slope_x @ normals, self.slope_y @ normals], axis=1)
        return np.einsum("qic,qjc->qij", slopes, slopes)

    def at_seeds(self, at_quads: FloatArray) -> FloatArray:
        """(S,2,2) what ``at_quads`` says, at the seeds."""
        return np.asarray(self.mix @ at_quads.reshape(-1, 4)).reshape(-1, 2, 2)


@lru_cache(maxsize=4)
def _field(net: PiecewiseDog, spacing: float) -> _Field:
    part = np.clip(paper_shares(net), _LEAST_WEIGHT, 1.0)
    centres = net.rest[net.quads].mean(axis=1)
    slope_x, slope_y = _slopes(net, centres, part)
    patches = []
    columns, values, first = [], [], 0
    for index, polygon in enumerate(net.patch_polygons):
        quads = np.flatnonzero(net.quad_patch == index)
        seeds = _seeds(polygon, _SEED_SPACING * spacing) if len(quads) else np.zeros((0, 2))
        if len(seeds) == 0:
            continue
        tree = cKDTree(centres[quads])
        near = min(4, len(quads))
        distance, nearest = (a.reshape(len(seeds), near) for a in tree.query(seeds, k=near))
        weight = part[quads[nearest]] / (distance**2 + (0.1 * net.frame.unit) ** 2)
        columns.append(quads[nearest].ravel())
        values.append((weight / weight.sum(axis=1)[:, None]).ravel())
        patches.append(_Patch(index, slice(first, first + len(seeds)), seeds, _rim(polygon), cKDTree(seeds), near))
        first += len(seeds)
    counts = np.concatenate([np.full(len(p.points), p.near) for p in patches] or [np.zeros(0, dtype=np.int64)])
    start = np.concatenate([[0], np.cumsum(counts)])
    mix = csr_matrix(
        (np.concatenate(values or [np.zeros(0)]), np.concatenate(columns or [np.zeros(0, dtype=np.int64)]), start),
        shape=(first, len(net.quads)),
    )
    return _Field(slope_x, slope_y, mix, tuple(patches))


def _slopes(net: PiecewiseDog, centres: FloatArray, part: FloatArray) -> tuple[csr_matrix, csr_matrix]:
    """Least-squares derivatives at each quad from the quads that share a vertex with it.

    Around an inner quad the fit is symmetric and so of second order, at a rim of first. Where neighbours lie on
    one line only there is no derivative across it: the rows are zero and such paper counts as plane.
    """
    count = len(net.quads)
    rows = np.repeat(np.arange(count), 4)
    incidence = csr_matrix((np.ones(4 * count), (rows, net.quads.ravel())), shape=(count, len(net.rest)))
    around = (incidence @ incidence.T).tocoo()
    q, r = around.row.astype(np.int64), around.col.astype(np.int64)
    weight = part[r]
    total = np.bincount(q, weights=weight, minlength=count)
    middle = np.column_stack([np.bincount(q, weights=weight * centres[r, k], minlength=count) for k in (0, 1)])
    offset = centres[r] - (middle / total[:, None])[q]
    moment = np.empty((count, 2, 2))
    for i in (0, 1):
        for j in (0, 1):
            moment[:, i, j] = np.bincount(q, weights=weight * offset[:, i] * offset[:, j], minlength=count)
    trace = np.trace(moment, axis1=1, axis2=2)
    determinant = np.linalg.det(moment)
    good = determinant > 1e-3 * trace**2
    inverse = np.zeros_like(moment)
    inverse[good] = np.linalg.inv(moment[good])
    slope = np.einsum("nij,nj->ni", inverse[q], offset) * weight[:, None]
    x, y = (csr_matrix((slope[:, k], (q, r)), shape=(count, count)) for k in (0, 1))
    return x, y


def _seeds(polygon: Polygon, spacing: float) -> FloatArray:
    """(S,2) lattice points inside a polygon; its middle when it is too small for one."""
    x0, y0, x1, y1 = polygon.bounds
    x = np.arange(x0 + 0.5 * spacing, x1, spacing)
    y = np.arange(y0 + 0.5 * spacing, y1, spacing)
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    inside = points[shapely.contains_xy(polygon, points)]
    return inside if len(inside) else shapely.get_coordinates(polygon.representative_point())


def _rim(polygon: Polygon) -> FloatArray:
    """(n,2,2) the border's segments, holes included."""
    rings = [np.asarray(ring.coords) for ring in (polygon.exterior, *polygon.interiors)]
    return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])


# --- lines through a patch -------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Patch:
    """index; seeds: its part of all seeds; points (S,2) these; rim (n,2,2); tree of the points; near: see mix."""

    index: int
    seeds: slice
    points: FloatArray
    rim: FloatArray
    tree: cKDTree
    near: int

    def lines(self, turning: FloatArray, spacing: float, least: float) -> list[FloatArray]:
        """Rulings (2,2): the first where the paper bends most, the next beside those found,

        as near to the spacing as a seed can be.
        """
        bend = _bend(turning)
        # What bends hardly has no say in a line's direction.
        form = turning / (bend**2 + least**2)[:, None, None]
        open_seed = bend >= least
        distance = np.full(len(self.points), np.inf)
        found: list[FloatArray] = []
        while open_seed.any():
            fresh = open_seed & np.isinf(distance)
            beside = open_seed & np.isfinite(distance) & (distance >= _SLACK * spacing)
            if beside.any():
                seed = _first_least(np.where(beside, distance, np.inf))
            elif fresh.any():
                seed = _first_least(np.where(fresh, -bend, 0.0))
            else:
                break
            open_seed[seed] = False
            line, along = self._line(self.points[seed], form)
            if self._is_ruling(line, turning[along], least) and not _crosses(line, found):
                found.append(line)
                distance = np.minimum(distance, _distances(self.points, line))
            else:
                open_seed[self.tree.query_ball_point(self.points[seed], _GIVEN_UP * spacing)] = False
        return found

    def _is_ruling(self, line: FloatArray, turning: FloatArray, least: float) -> bool:
        """Whether the paper bends across most of a line (2,2) and not along it, by samples (n,2,2) on it."""
        step = line[1] - line[0]
        length = float(np.hypot(*step))
        bend = _bend(turning)
        if length <= 0 or np.quantile(bend, _PLANE_PART) < least:
            return False
        along = np.einsum("i,nij,j->n", step, turning, step).mean() / length**2
        return bool(along <= _STRAIGHT**2 * (bend**2).mean())

    def _line(self, seed: FloatArray, form: FloatArray) -> tuple[FloatArray, IntArray]:
        """The line (2,2) through a seed along which normals turn least, and the seeds that it passes."""
        along = np.array([self.tree.query(seed)[1]])
        for _ in range(_TURNS):
            direction = _least(form[along].mean(axis=0))
            line = self._clip(seed, direction)
            t = (np.arange(_SAMPLES) + 0.5)[:, None] / _SAMPLES
            along = self.tree.query((1 - t) * line[0] + t * line[1])[1]
        return line, along

    def _clip(self, seed: FloatArray, direction: FloatArray) -> FloatArray:
        """(2,2) the part of the line through a seed inside the patch."""
        a, b = self.rim[:, 0] - seed, self.rim[:, 1] - seed
        normal = np.array([-direction[1], direction[0]])
        side_a, side_b = a @ normal, b @ normal
        cut = (side_a < 0) != (side_b < 0)
        share = side_a[cut] / (side_a[cut] - side_b[cut])
        reach = (a[cut] + share[:, None] * (b[cut] - a[cut])) @ direction
        ends = (reach[reach < 0].max(initial=-np.inf), reach[reach >= 0].min(initial=np.inf))
        low, high = (end if np.isfinite(end) else 0.0 for end in ends)
        return np.stack([seed + low * direction, seed + high * direction])


def _first_least(values: FloatArray) -> int:
    """Index of the least value, the first of those that rounding alone tells apart."""
    least = values.min()
    return int(np.flatnonzero(values <= least + _TIE * abs(least))[0])


def _least(form: FloatArray) -> FloatArray:
    """The unit vector (2,) where a quadratic form (2,2) is least."""
    angle = 0.5 * np.arctan2(2 * form[0, 1], form[0, 0] - form[1, 1])
    return np.array([-np.sin(angle), np.cos(angle)])


def _crosses(line: FloatArray, others: Sequence[FloatArray]) -> bool:
    """Whether a line meets another between the ends of both; shared ends do not count."""
    if not others:
        return False
    other = np.array(others)
    step = line[1] - line[0]
    steps = other[:, 1] - other[:, 0]
    base = other[:, 0] - line[0]
    cross = step[0] * steps[:, 1] - step[1] * steps[:, 0]
    cross = np.where(np.abs(cross) < np.finfo(float).tiny, np.inf, cross)
    s = (base[:, 0] * steps[:, 1] - base[:, 1] * steps[:, 0]) / cross
    t = (base[:, 0] * step[1] - base[:, 1] * step[0]) / cross
    inner = (s > _INWARD) & (s < 1 - _INWARD) & (t > _INWARD) & (t < 1 - _INWARD)
    return bool(inner.any())


def _distances(points: FloatArray, line: FloatArray) -> FloatArray:
    """(N,) distances of points (N,2) from a segment (2,2)."""
    step = line[1] - line[0]
    t = np.clip((points - line[0]) @ step / (step @ step), 0.0, 1.0)
    return np.hypot(*(points - line[0] - t[:, None] * step).T)


# --- what became of them ---------------------------------------------------------------------------------


def _placed(vertices: IntArray, weights: FloatArray, x: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("rek,rekc->rec", weights, x[vertices]))


def _carriers(net: PiecewiseDog, lines: FloatArray, patch: IntArray) -> tuple[IntArray, FloatArray]:
    """(R,2,4) vertices and weights of the lines' ends, each through its own patch's quads."""
    vertices = np.zeros((len(lines), 2, 4), dtype=np.int64)
    weights = np.zeros((len(lines), 2, 4))
    centres = net.flat[net.quads].mean(axis=1)
    for one in np.unique(patch):
        mine = patch == one
        quads = np.flatnonzero(net.quad_patch == one)
        places = net.frame.to_net(lines[mine].reshape(-1, 2))
        # A point a little inside its line lies in the quad that carries the end.
        inward = net.frame.to_net((lines[mine] + _INWARD * (lines[mine][:, ::-1] - lines[mine])).reshape(-1, 2))
        corners = net.quads[quads[_holding(net, quads, centres, inward)]]
        low, high = net.flat[corners[:, 0]], net.flat[corners[:, 2]]
        u, v = ((places - low) / (high - low)).T
        vertices[mine] = corners.reshape(-1, 2, 4)
        shares = np.column_stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
        weights[mine] = shares.reshape(-1, 2, 4)
    return vertices, weights


def _holding(net: PiecewiseDog, quads: IntArray, centres: FloatArray, places: FloatArray) -> IntArray:
    """(N,) which of the quads holds each place (N,2), net units; of several the one that it is deepest in."""
    near = min(6, len(quads))
    _, nearest = cKDTree(centres[quads]).query(places, k=near)
    nearest = nearest.reshape(len(places), near)
    low, high = net.flat[net.quads[quads[nearest], 0]], net.flat[net.quads[quads[nearest], 2]]
    outside = np.maximum(low - places[:, None], places[:, None] - high).max(axis=2)
    return np.asarray(nearest[np.arange(len(places)), outside.argmin(axis=1)])


def _kinds(lines: FloatArray, patch: IntArray, size: float) -> IntArray:
    """(R,) RulingKind of each ruling, judged with its nearest neighbours in its patch."""
    kind = np.full(len(lines), RulingKind.GENERAL, dtype=np.int64)
    middle = lines.mean(axis=1)
    step = lines[:, 1] - lines[:, 0]
    direction = step / np.hypot(*step.T)[:, None]
    for one in np.unique(patch):
        mine = np.flatnonzero(patch == one)
        near = min(_WINDOW, len(mine))
        _, window = cKDTree(middle[mine]).query(middle[mine], k=near)
        for k, others in zip(mine, mine[window.reshape(len(mine), near)], strict=True):
            kind[k] = _kind(middle[others], direction[others], size)
    return kind


def _kind(middle: FloatArray, direction: FloatArray, size: float) -> RulingKind:
    """What lines through points (n,2) with unit directions (n,2) do together."""
    # Directions are lines: doubling the angle makes both ways one.
    doubled = np.column_stack([
        direction[:, 0] ** 2 - direction[:, 1] ** 2, 2 * direction[:, 0] * direction[:, 1]
    ])  # fmt: skip
    mean = doubled.mean(axis=0)
    axis = 0.5 * np.arctan2(mean[1], mean[0])
    turn = 0.5 * np.arctan2(
        doubled[:, 1] * mean[0] - doubled[:, 0] * mean[1], doubled @ mean
    )  # of each line from the mean one
    offset = (middle - middle.mean(axis=0)) @ np.array([-np.sin(axis), np.cos(axis)])
    width = float(np.ptp(offset))
    if len(middle) < 3 or width * _PARALLEL >= np.ptp(turn) * size:
        return RulingKind.CYLINDRICAL
    normal = np.column_stack([-direction[:, 1], direction[:, 0]])
    level = np.einsum("ni,ni->n", normal, middle)
    point, *_ = np.linalg.lstsq(normal, level, rcond=None)
    miss = normal @ point - level
    reach = float(np.hypot(*(point - middle.mean(axis=0))))
    return RulingKind.CONICAL if np.sqrt(np.mean(miss**2)) < _CONCURRENT * reach else RulingKind.GENERAL
