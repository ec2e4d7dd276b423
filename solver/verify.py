"""An independent check of a folded net: plain geometry over the net's data, and nothing of what folded it.

    verification = solver.verify(net, positions)
    verification.ok, verification.faults

It uses no term of the solver and no figure of ``measure``: lengths, corner angles, gaps, sides and areas are
worked out here from the net's quads and points alone, so that a mistake there does not certify itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .arrays import FloatArray, IntArray, frozen_array
from .net.piecewise_dog import PiecewiseDog

#: Relative change of the net's edge lengths: mean (paper, section 6.1), all but a hundredth of the edges, and a
#: single edge. At a point handle or a crease vertex one edge takes what the sheet around it cannot
#: (docs/reliability.md).
MAX_MEAN_STRETCH, MAX_STRETCH_99, MAX_STRETCH = 0.003, 0.01, 0.05
#: Largest difference of two angles that a DOG holds equal, degrees.
MAX_ANGLE_GAP = 0.05
#: Gap between two copies of one point, mean grid edges: mean, and largest.
MAX_MEAN_GAP, MAX_GAP = 3e-3, 2e-2
#: A crease point folded by less than this is flat, degrees. What counts as folded is more
#: (solver/measurement.py), but the angle is seen more roughly here: at the tips of creases the two differ by some
#: tenths.
FLAT = 0.05
#: A quad keeps its area within these parts, and no corner of it turns over.
LEAST_AREA, MOST_AREA = 0.6, 1.5
#: Quads that share an edge inside a patch turn by less than this, degrees: more is paper doubled over.
MAX_TURN = 120.0
#: Crease points on neighbouring grid lines are no farther apart than the crease between them is long, up to
#: this part of it, and no nearer than this part of their flat distance; both give or take MAX_GAP.
FARTHEST, NEAREST = 0.1, 0.5
#: A point of the flat net may miss its place on the drawing by this, mean grid edges (rounding).
MAX_MISPLACED = 1e-6


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong. place: (x, y) on the flat sheet, drawing units; None when it is everywhere."""

    check: str
    sentence: str
    place: tuple[float, float] | None

    def __str__(self) -> str:
        return self.sentence


@dataclass(frozen=True)
class Verification:
    """What the check found: the largest figure of each check, and what is beyond its bound.

    figures by name: lengths relative to the mean grid edge, angles in degrees, areas relative to the flat quad.
    """

    figures: dict[str, float]
    faults: tuple[Fault, ...]

    @property
    def ok(self) -> bool:
        return not self.faults

    def to_json(self) -> dict[str, Any]:
        """A JSON object."""
        return {"ok": self.ok, "figures": self.figures, "faults": [fault.sentence for fault in self.faults]}


def verify(net: PiecewiseDog, positions: ArrayLike) -> Verification:
    """Check positions (V,3), drawing units, of a net. Raises ValueError for another shape."""
    array = frozen_array(positions, np.float64, (len(net.rest), 3), "positions")
    check = _Check(net, array)
    lost = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(lost):
        check.fault("finite", f"{len(lost)} vertices are not at a finite place", net.rest[lost[0]])
        return Verification(check.figures, tuple(check.faults))
    check.lengths()
    check.angles()
    check.gaps()
    check.quads()
    check.sides()
    check.crease_points()
    return Verification(check.figures, tuple(check.faults))


class _Check:
    """Gathers figures and faults. Lengths are divided by the mean flat edge, so bounds hold at any scale."""

    def __init__(self, net: PiecewiseDog, positions: FloatArray) -> None:
        self.net = net
        self.figures: dict[str, float] = {}
        self.faults: list[Fault] = []
        a, b = net.edges.T
        self.unit = float(np.hypot(*(net.rest[b] - net.rest[a]).T).mean())
        # Relative to a vertex: a sheet far from the origin loses no digits.
        self.flat = (net.rest - net.rest[0]) / self.unit
        self.x = (positions - np.append(net.rest[0], 0.0)) / self.unit

    def fault(self, check: str, sentence: str, place: FloatArray | None) -> None:
        if place is None:
            self.faults.append(Fault(check, sentence, None))
            return
        x, y = (float(v) for v in place)
        self.faults.append(Fault(check, f"{sentence}, at ({x:.6g}, {y:.6g})", (x, y)))

    def _bound(
        self, check: str, name: str, values: FloatArray, bound: float, places: FloatArray, text: str
    ) -> None:
        """Note the largest of values (n,), and a fault where it is not below its bound; places (n,2)."""
        if len(values) == 0:
            self.figures[name] = 0.0
            return
        # NaN (a vanished edge) must not pass: argmax finds it first.
        worst = int(np.argmax(values))
        value = float(values[worst])
        self.figures[name] = value
        if not value <= bound:
            self.fault(check, text.format(value=value, bound=bound), places[worst])

    # --- the checks ------------------------------------------------------------------------------------

    def lengths(self) -> None:
        """Isometric: no edge much longer or shorter than on the flat sheet."""
        a, b = self.net.edges.T
        flat = np.hypot(*(self.flat[b] - self.flat[a]).T)
        change = np.abs(np.linalg.norm(self.x[b] - self.x[a], axis=1) / flat - 1.0)
        places = 0.5 * (self.net.rest[a] + self.net.rest[b])
        mean = float(change.mean())
        self.figures["stretch_mean"] = mean
        if not mean <= MAX_MEAN_STRETCH:
            self.fault(
                "isometry", f"edges are stretched by {mean:.2%} in the mean, over {MAX_MEAN_STRETCH:.1%}", None
            )
        most = float(np.quantile(change, 0.99))
        self.figures["stretch_99"] = most
        if not most <= MAX_STRETCH_99:
            worst = int(np.argmax(change))
            sentence = f"a hundredth of the edges is stretched by more than {most:.1%}, over {MAX_STRETCH_99:.0%}"
            self.fault("isometry", f"{sentence}, most", places[worst])
        self._bound("isometry", "stretch_max", change, MAX_STRETCH, places,
                    "an edge is stretched by {value:.1%}, over {bound:.0%}")  # fmt: skip

    def angles(self) -> None:
        """DOG: at a vertex, two quads that share an edge have the same angle."""
        quads = self.net.quads
        here, after, before = quads, np.roll(quads, -1, axis=1), np.roll(quads, 1, axis=1)
        arm, other = self.x[after] - self.x[here], self.x[before] - self.x[here]
        sine = np.linalg.norm(np.cross(arm, other), axis=2)
        corner = np.degrees(np.arctan2(sine, (arm * other).sum(axis=2))).ravel()
        # A corner leaves its vertex along one edge (counter-clockwise) and comes back along another.
        size = len(self.flat)
        leaves, comes = (here * size + after).ravel(), (here * size + before).ravel()
        one, two = _matches(leaves, comes)
        gap = np.abs(corner[one] - corner[two])
        self._bound("angles", "angle_gap_max", gap, MAX_ANGLE_GAP, self.net.rest[here.ravel()[one]],
                    "two angles that should be equal differ by {value:.3g}°, over {bound:g}°")  # fmt: skip

    def gaps(self) -> None:
        """Continuity: the copies of a crease point lie at one place."""
        stitches, points = self.net.stitches, self.net.crease_points
        both = (points.left_vertices[:, 0] >= 0) & (points.right_vertices[:, 0] >= 0)
        left, right = self._copies(np.flatnonzero(both))
        own = np.linalg.norm(left - right, axis=1)
        stitched = np.linalg.norm(np.einsum("ck,ckd->cd", stitches.weights, self.x[stitches.vertices]), axis=1)
        gap = np.concatenate([own, stitched])
        places = np.vstack([points.position[both], stitches.position])
        mean = float(gap.mean()) if len(gap) else 0.0
        self.figures["gap_mean"] = mean
        if not mean <= MAX_MEAN_GAP:
            self.fault(
                "continuity", f"copies of crease points are {mean:.2g} of a grid edge apart in the mean", None
            )
        self._bound("continuity", "gap_max", gap, MAX_GAP, self.net.frame.to_drawing(places),
                    "copies of a crease point are {value:.2g} of a grid edge apart, over {bound:g}")  # fmt: skip

    def quads(self) -> None:
        """No quad is flipped, doubled over or gone: areas, corners, and the turn from quad to quad."""
        net = self.net
        centre = net.rest[net.quads].mean(axis=1)
        normal, area = _quad_normals(self.x[net.quads])
        flat = np.column_stack([self.flat, np.zeros(len(self.flat))])
        _, rest = _quad_normals(flat[net.quads])
        part = area / rest
        for name, values, bound, word in (
            ("area_max", part, MOST_AREA, "{value:.2f} times its flat area, over {bound:g}"),
            ("area_shrunk", 1.0 - part, 1.0 - LEAST_AREA, "smaller than flat by {value:.0%}, over {bound:.0%}"),
        ):
            self._bound("quads", name, values, bound, centre, "a quad is " + word)
        # Each corner seen from the quad's normal: negative where the corner has turned over.
        here = self.x[net.quads]
        arm, other = np.roll(here, -1, axis=1) - here, np.roll(here, 1, axis=1) - here
        up = np.einsum("qkc,qc->qk", np.cross(arm, other), normal) / rest[:, None]
        self._bound("quads", "corner_turned", -up.min(axis=1), 0.0, centre, "a quad is turned over at a corner")
        first, second, ends = _neighbours(net.quads, len(net.rest))
        turn = np.degrees(np.arccos(np.clip(np.einsum("nc,nc->n", normal[first], normal[second]), -1.0, 1.0)))
        self._bound("quads", "turn_max", turn, MAX_TURN, net.rest[ends].mean(axis=1),
                    "the paper is doubled over: two quads turn by {value:.0f}°, over {bound:g}°")  # fmt: skip

    def sides(self) -> None:
        """Folded: at a crease point both sides of the paper lie on one side of the osculating plane."""
        points = self.net.crease_points
        if len(points.carrier) == 0:
            self.figures["not_folded"] = 0.0
            return
        here, back, front = (
            self._middle(index)
            for index in (points.carrier, points.fold_neighbours[:, 0], points.fold_neighbours[:, 1])
        )
        # The plane of the crease near this point, as a circle through three of its points has it.
        binormal = np.cross(front - here, back - here)
        size = np.linalg.norm(front - here, axis=1) * np.linalg.norm(back - here, axis=1)
        scale = np.maximum(np.linalg.norm(binormal, axis=1), 1e-9 * size)
        ahead = points.position[points.fold_neighbours[:, 1]] - points.position[points.fold_neighbours[:, 0]]
        tilts, normals = [], []
        for a, b, side in ((0, 1, 1.0), (2, 3, -1.0)):
            start, end = points.fold_vertices[:, a], points.fold_vertices[:, b]
            edge, flat = self.x[end] - self.x[start], self.net.flat[end] - self.net.flat[start]
            # Point the edge from the crease into its own side: left of the drawn direction, or right of it.
            inward = side * np.sign(ahead[:, 0] * flat[:, 1] - ahead[:, 1] * flat[:, 0])
            tilts.append(inward * np.einsum("kc,kc->k", edge, binormal) / (scale * np.linalg.norm(edge, axis=1)))
            normals.append(np.cross(front - back, edge))
        one, other = normals
        turn = np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), (one * other).sum(axis=1)))
        bad = np.flatnonzero(~((tilts[0] * tilts[1] > 0.0) & (turn > FLAT)))
        self.figures["not_folded"] = len(bad) / len(points.carrier)
        if len(bad):
            place = self.net.frame.to_drawing(points.position[points.carrier[bad[:1]]])[0]
            label = self.net.crease_labels[points.crease[points.carrier[bad[0]]]]
            self.fault(
                "sides", f"{len(bad)} of {len(points.carrier)} crease points are not folded, first {label}", place
            )

    def crease_points(self) -> None:
        """Crease points are where the drawing has them, and apart as the drawing has them."""
        points = self.net.crease_points
        places = self.net.frame.to_drawing(points.position)
        wanted = (places - self.net.rest[0]) / self.unit
        some = points.left_vertices[:, 0] >= 0
        off = np.linalg.norm(np.einsum("kw,kwc->kc", points.left_weights[some],
                                       self.flat[points.left_vertices[some]]) - wanted[some], axis=1)  # fmt: skip
        self._bound("crease points", "misplaced_max", off, MAX_MISPLACED, places[some],
                    "a crease point misses the drawing by {value:.2g} of a grid edge")  # fmt: skip
        k = np.flatnonzero((points.chain[1:] == points.chain[:-1]) & some[1:] & some[:-1])
        apart = np.linalg.norm(self._middle(k + 1) - self._middle(k), axis=1)
        chord = np.hypot(*(wanted[k + 1] - wanted[k]).T)
        length = np.maximum((points.along[k + 1] - points.along[k]) * self.net.frame.unit / self.unit, chord)
        middle = 0.5 * (places[k] + places[k + 1])
        self._bound("crease points", "crease_stretched", apart - (1 + FARTHEST) * length, MAX_GAP, middle,
                    "a crease is pulled apart between two of its points")  # fmt: skip
        self._bound("crease points", "crease_shrunk", NEAREST * chord - apart, MAX_GAP, middle,
                    "a crease is pushed together between two of its points")  # fmt: skip

    # --- small geometry --------------------------------------------------------------------------------

    def _copies(self, index: IntArray) -> tuple[FloatArray, FloatArray]:
        """(n,3) twice: crease points as the left and as the right patch has them."""
        points = self.net.crease_points
        left = np.einsum("kw,kwc->kc", points.left_weights[index], self.x[points.left_vertices[index]])
        right = np.einsum("kw,kwc->kc", points.right_weights[index], self.x[points.right_vertices[index]])
        return left, right

    def _middle(self, index: IntArray) -> FloatArray:
        """(n,3) crease points as shown: between their two copies, or the one copy where there is one."""
        left, right = self._copies(index)
        both = (self.net.crease_points.right_vertices[index, 0] >= 0)[:, None]
        return np.where(both, 0.5 * (left + right), left)


def _matches(one: IntArray, other: IntArray) -> tuple[IntArray, IntArray]:
    """All pairs (i, j) with one[i] == other[j]."""
    order = np.argsort(other, kind="stable")
    low = np.searchsorted(other[order], one, side="left")
    count = np.searchsorted(other[order], one, side="right") - low
    first = np.repeat(np.arange(len(one)), count)
    within = np.arange(len(first)) - np.repeat(np.cumsum(count) - count, count)
    return first, order[np.repeat(low, count) + within]


def _neighbours(quads: IntArray, size: int) -> tuple[IntArray, IntArray, IntArray]:
    """Pairs of quads that share an edge (opposite ways around it), and the edge's two vertices (n,2)."""
    start, end = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    one, other = _matches(start * size + end, end * size + start)
    once = one < other
    one, other = one[once], other[once]
    return one // 4, other // 4, np.column_stack([start[one], end[one]])


def _quad_normals(corners: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit normals (Q,3) and areas (Q,) of quads (Q,4,3), from their diagonals; a vanished quad has no normal."""
    twice = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    size = np.linalg.norm(twice, axis=1)
    return twice / np.maximum(size, 1e-300)[:, None], 0.5 * size
