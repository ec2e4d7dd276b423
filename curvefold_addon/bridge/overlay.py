"""What is drawn over a paper, as arrays: nothing here knows a screen.

Everything is in the paper's local coordinates and depends on a net and the positions of its vertices alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...solver import (
    Angle,
    Glue,
    Handle,
    HandleError,
    Measurement,
    Pair,
    PiecewiseDog,
    RulingKind,
    Rulings,
    measure,
    rulings,
)
from ...solver.controls.control import Control
from .drawn import Color, Indices, Label, Lines, Pulls, Single, Surface, single
from .gauss_ball import GaussBall, ball

Array = NDArray[np.float64]
Point = tuple[float, float]

#: Display colours (sRGB). Red and blue are told apart by all eyes; dark: a line that is drawn but not folded.
MOUNTAIN: Color = (0.90, 0.16, 0.10, 1.0)
VALLEY: Color = (0.07, 0.38, 0.95, 1.0)
UNFOLDED: Color = (0.16, 0.16, 0.17, 1.0)
#: A crease folded by less than this counts as not folded, degrees.
FOLDED_FROM = 1.0
RULING_COLORS: dict[int, Color] = {
    RulingKind.CYLINDRICAL: (0.00, 0.34, 0.36, 0.80),
    RulingKind.CONICAL: (0.36, 0.36, 0.00, 0.80),
    RulingKind.GENERAL: (0.25, 0.25, 0.26, 0.80),
}
#: Stretch and its colour, straight between; what is beyond has the last one. Below 0.3 % paper looks like paper.
STRETCH_RAMP: tuple[tuple[float, Color], ...] = (
    (0.0, (0.12, 0.35, 0.85, 0.30)),
    (0.003, (0.15, 0.70, 0.45, 0.60)),
    (0.006, (0.98, 0.80, 0.10, 0.80)),
    (0.010, (0.90, 0.08, 0.05, 0.90)),
)
PULL: Color = (1.0, 0.62, 0.05, 1.0)
JOINT: Color = (0.95, 0.30, 0.75, 1.0)
ASKED_ANGLE: Color = (0.70, 0.88, 0.20, 1.0)
#: A target nearer than this is reached and has no line, net units.
REACHED = 0.05
#: An angle asked for at a point belongs to a crease point at most this far away, as in the solver, net units.
_NEAR = 1.5
#: A crease with more points than this has its angle written at three places instead of one.
_SHORT = 12


class PaperShape:
    """One shape of one paper: each overlay is computed when it is asked for, and once."""

    def __init__(self, net: PiecewiseDog, positions: Array) -> None:
        self.net, self.positions = net, positions
        self._shown: Array | None = None
        self._measurement: Measurement | None = None
        self._done: dict[str, Any] = {}

    def is_of(self, net: PiecewiseDog, positions: Array) -> bool:
        """Whether this is the shape of these very arrays."""
        return self.net is net and self.positions is positions

    @property
    def shown(self) -> Array:
        """(R,3) the shown vertices."""
        if self._shown is None:
            self._shown = self.net.render_map.apply(self.positions)
        return self._shown

    @property
    def measurement(self) -> Measurement:
        if self._measurement is None:
            self._measurement = measure(self.net, self.positions)
        return self._measurement

    def creases(self) -> Lines:
        """The creases, coloured by the side that they folded to."""
        if "creases" not in self._done:
            surface = self.net.render_map
            sides = np.append(sides_found(self.measurement), 0)[edge_points(self.net)]
            points = self.shown[surface.crease_edges].reshape(-1, 3)
            self._done["creases"] = Lines(single(points), line_colors(sides))
        lines: Lines = self._done["creases"]
        return lines

    def angles(self) -> tuple[Label, ...]:
        """Fold angles in figures, one or three on each crease between two crease vertices."""
        if "angles" not in self._done:
            self._done["angles"] = tuple(self._angle_labels())
        labels: tuple[Label, ...] = self._done["angles"]
        return labels

    def stretch(self, triangles: Indices) -> Surface:
        """How far the paper is stretched. triangles (T,3) of the mesh that shows it."""
        if "stretch" not in self._done:
            colors = stretch_colors(self.net.render_map.apply(vertex_stretch(self.net, self.measurement)))
            self._done["stretch"] = Surface(single(self.shown), colors, triangles)
        surface: Surface = self._done["stretch"]
        return surface

    def rulings(self, found: Rulings) -> Lines:
        """Rulings that were found in this shape, or in an earlier one of the net: they go with the paper."""
        if self._done.get("found") is not found:
            points = found.carried(self.positions).reshape(-1, 3)
            palette = np.array([RULING_COLORS[kind] for kind in sorted(RULING_COLORS)], dtype=np.float32)
            self._done["found"] = found
            self._done["rulings"] = Lines(single(points), palette[found.kind].repeat(2, axis=0))
        lines: Lines = self._done["rulings"]
        return lines

    def gauss_ball(self) -> GaussBall:
        """The Gauss image on a ball beside the paper."""
        if "ball" not in self._done:
            self._done["ball"] = ball(self.net, self.positions, self.shown)
        made: GaussBall = self._done["ball"]
        return made

    def pulls(self, handles: Iterable[Handle]) -> Pulls:
        """From each handle's point to its target, where that is not reached. Handles lie on the sheet."""
        handles = tuple(handles)
        if self._done.get("handles") != handles:
            self._done["handles"], self._done["pulls"] = handles, self._pulls(handles)
        pulls: Pulls = self._done["pulls"]
        return pulls

    def _pulls(self, handles: tuple[Handle, ...]) -> Pulls:
        points, targets = np.empty((len(handles), 3)), np.empty((len(handles), 3))
        for k, handle in enumerate(handles):
            vertices, weights = _located(self.net, handle.at)
            points[k] = weights @ self.positions[vertices]
            # Along an axis where the handle does not act, the target is where the point is.
            targets[k] = np.where(handle.axes, handle.target, points[k])
        away = np.linalg.norm(targets - points, axis=1) > REACHED * self.net.frame.unit
        ends = np.stack([points[away], targets[away]], axis=1).reshape(-1, 3)
        return _pulls(ends, points, PULL)

    def joints(self, controls: Iterable[Control]) -> Pulls:
        """Between the points that are joined, and the ends of glued borders, where they are apart."""
        pairs = tuple(pair for control in controls for pair in _joined(control))
        if self._done.get("pairs") != pairs:
            self._done["pairs"], self._done["joints"] = pairs, self._joints(pairs)
        joints: Pulls = self._done["joints"]
        return joints

    def _joints(self, pairs: tuple[tuple[Point, Point], ...]) -> Pulls:
        places = []
        for pair in pairs:
            try:
                places += [weights @ self.positions[v] for v, weights in (_located(self.net, at) for at in pair)]
            except HandleError:
                continue  # off the sheet: the report says so
        ends = np.array(places).reshape(-1, 2, 3)
        away = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > REACHED * self.net.frame.unit
        return _pulls(ends[away].reshape(-1, 3), ends.reshape(-1, 3), JOINT)

    def asked_angles(self, controls: Iterable[Control]) -> Pulls:
        """The points of creases that are asked for an angle of their own."""
        places = tuple(c.at for c in controls if isinstance(c, Angle) and c.at is not None)
        if self._done.get("places") != places:
            points = [nearest_angle(self.net, at) for at in places]
            marks = np.array([self._crease_point(k) for k in points if k is not None]).reshape(-1, 3)
            self._done["places"], self._done["asked"] = places, _pulls(np.empty((0, 3)), marks, ASKED_ANGLE)
        asked: Pulls = self._done["asked"]
        return asked

    def _angle_labels(self) -> Iterable[Label]:
        points, m = self.net.crease_points, self.measurement
        sides = sides_found(m)
        for chain in np.unique(points.chain):
            mine = np.flatnonzero((points.chain == chain) & np.isfinite(m.fold_angle))
            if len(mine) == 0:
                continue
            shares = (0.5,) if len(mine) < _SHORT else (0.15, 0.5, 0.85)
            for share in shares:
                k = int(mine[round(share * (len(mine) - 1))])
                x, y, z = self._crease_point(k)
                yield Label((x, y, z), f"{m.fold_angle[k]:.0f}°", side_color(int(sides[k])))

    def _crease_point(self, k: int) -> list[float]:
        points, x = self.net.crease_points, self.positions
        left = points.left_weights[k] @ x[points.left_vertices[k]]
        right = points.right_weights[k] @ x[points.right_vertices[k]]
        middle: list[float] = (0.5 * (left + right)).tolist()
        return middle


def nearest_angle(net: PiecewiseDog, at: Sequence[float]) -> int | None:
    """The crease point nearest to a point of the flat sheet that can have an angle; None where none is near."""
    known = _angle_points(net)
    if len(known) == 0:
        return None
    place = net.frame.to_net(np.array([at], dtype=np.float64))[0]
    distance = np.hypot(*(net.crease_points.position[known] - place).T)
    nearest = int(np.argmin(distance))
    return int(known[nearest]) if distance[nearest] <= _NEAR else None


def angle_at(net: PiecewiseDog, positions: Array, at: Sequence[float]) -> float | None:
    """Degrees to which a crease is folded near a point of the flat sheet; None where there is none to measure."""
    k = nearest_angle(net, at)
    return None if k is None else float(measure(net, positions).fold_angle[k])


def sides_found(m: Measurement) -> NDArray[np.int64]:
    """(K,) +1 where a crease point is a valley, -1 a mountain, 0 where it is not folded."""
    with np.errstate(invalid="ignore"):
        folded = m.folded & (m.fold_angle >= FOLDED_FROM)
    return np.where(folded, m.fold_sign, 0)


def vertex_stretch(net: PiecewiseDog, m: Measurement) -> Array:
    """(V,) mean unsigned relative stretch of the edges at each vertex of a net."""
    edges, count = net.edges.ravel(), len(net.rest)
    total = np.bincount(edges, weights=m.stretch.repeat(2), minlength=count)
    mean: Array = total / np.maximum(np.bincount(edges, minlength=count), 1)
    return mean


def side_color(side: int) -> Color:
    """Of a valley (+1), a mountain (-1), and what is not folded (0)."""
    return (MOUNTAIN, UNFOLDED, VALLEY)[side + 1]


def line_colors(sides: NDArray[np.int64]) -> Single:
    """(2n,4) colours of the ends of n segments on these sides (n,)."""
    return np.array([MOUNTAIN, UNFOLDED, VALLEY], dtype=np.float32)[sides + 1].repeat(2, axis=0)


def stretch_colors(stretch: Array) -> Single:
    """(N,4) colours of unsigned relative stretches (N,)."""
    marks = np.array([mark for mark, _ in STRETCH_RAMP])
    stops = np.array([color for _, color in STRETCH_RAMP])
    return single(np.column_stack([np.interp(stretch, marks, stops[:, k]) for k in range(4)]))


def shown_triangles(mesh: Any) -> Indices:
    """(T,3) triangles of a mesh's faces; they serve every shape of a paper."""
    mesh.calc_loop_triangles()
    triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    return triangles.reshape(-1, 3)


class RulingFinder:
    """Finds rulings beside Blender, in a thread: they take longer than a frame."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "curvefold-rulings")
        self._shape: PaperShape | None = None
        self._job: Future[Rulings] | None = None

    @property
    def busy(self) -> bool:
        return self._job is not None and not self._job.done()

    def ask(self, shape: PaperShape) -> bool:
        """Begins with a shape; False while another one is being worked on or has not been taken."""
        if self._job is not None:
            return False
        self._shape, self._job = shape, self._pool.submit(rulings, shape.net, shape.positions)
        return True

    def take(self) -> tuple[PaperShape, Rulings] | None:
        """What was asked and found, once; None while there is nothing."""
        if self._job is None or not self._job.done():
            return None
        assert self._shape is not None
        job, shape = self._job, self._shape
        self._job = self._shape = None
        return shape, job.result()

    def stop(self) -> None:
        self._pool.shutdown(wait=True, cancel_futures=True)


@lru_cache(maxsize=4)
def edge_points(net: PiecewiseDog) -> NDArray[np.int64]:
    """(n,) the crease point that speaks for each shown crease edge; -1 on a chain without one."""
    surface, points = net.render_map, net.crease_points
    middle = surface.uv[surface.crease_edges].mean(axis=1)
    place = net.frame.to_drawing(points.position)
    known = _angle_points(net)
    result = np.full(len(middle), -1, dtype=np.int64)
    for chain in np.unique(surface.crease_edge_chain):
        edges = np.flatnonzero(surface.crease_edge_chain == chain)
        mine = known[points.chain[known] == chain]
        if len(mine):
            result[edges] = mine[cKDTree(place[mine]).query(middle[edges])[1]]
    return result


@lru_cache(maxsize=4)
def _angle_points(net: PiecewiseDog) -> NDArray[np.int64]:
    """(n,) the crease points whose angle can be measured: that does not depend on the shape."""
    flat = np.column_stack([net.rest, np.zeros(len(net.rest))])
    return np.flatnonzero(np.isfinite(measure(net, flat).fold_angle))


def _joined(control: Control) -> tuple[tuple[Point, Point], ...]:
    """Pairs of points of the flat sheet that a control draws together."""
    if isinstance(control, Pair):
        return ((control.first, control.second),)
    if isinstance(control, Glue):
        return ((control.first[0], control.second[0]), (control.first[1], control.second[1]))
    return ()


def _pulls(ends: Array, points: Array, color: Color) -> Pulls:
    colors = np.tile(np.array(color, dtype=np.float32), (len(ends), 1))
    return Pulls(Lines(single(ends), colors), single(points), color)


@lru_cache(maxsize=256)
def _located(net: PiecewiseDog, at: tuple[float, float]) -> tuple[NDArray[np.int64], Array]:
    return net.locate(at)
