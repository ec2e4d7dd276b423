"""Folded states known in closed form, evaluated on the vertices of a net: no solver takes part in them.

Every function returns positions (V,3) in the drawing's units. A net's patch extends past its creases; each of
its vertices gets the isometry of the patch, not the one of the place where the vertex lies.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

import solver

Function = Callable[[np.ndarray], np.ndarray]


def _patch_branches(net: solver.PiecewiseDog, branch_of: Callable[[float, float], int]) -> np.ndarray:
    """(V,) the branch of each vertex: that of a point inside its patch."""
    inside = [polygon.representative_point() for polygon in net.patch_polygons]
    return np.array([branch_of(p.x, p.y) for p in inside])[net.vertex_patch]


def _mirror(points: np.ndarray, slope: float, height: float) -> np.ndarray:
    """Points (N,3) mirrored in the plane z = slope x + height."""
    normal = np.array([-slope, 0.0, 1.0]) / np.hypot(slope, 1.0)
    return points - 2 * ((points[:, 2] - slope * points[:, 0] - height) / np.hypot(slope, 1.0))[:, None] * normal


# --- A: creases that are graphs -------------------------------------------------------------------------


@dataclass(frozen=True)
class Graphs:
    """State A: creases y = sign g(x) + height from the bottom up, folded with parameter b > max |g'|."""

    g: Function
    slope: Function  # g'
    b: float
    creases: tuple[tuple[int, float], ...] = ((1, 0.0),)

    def pattern(self, width: float = 1.0, low: float = -1.0, high: float = 1.0) -> solver.CreasePattern:
        """The drawing on [-width, width] x [low, high], each crease sampled finely."""
        x = np.linspace(-width, width, 801)
        return solver.CreasePattern(
            boundary=[(-width, low), (width, low), (width, high), (-width, high)],
            creases=[
                solver.Crease(points=np.column_stack([x, sign * self.g(x) + height]))
                for sign, height in self.creases
            ],
        )

    def fold(self, points: np.ndarray, branch: int) -> np.ndarray:
        """(N,3) of flat points (N,2) under the isometry above ``branch`` creases."""
        x, y = np.asarray(points, dtype=float).T
        result = np.column_stack([self.g(x) / self.b, self._run(x), y])
        for sign, height in reversed(self.creases[:branch]):
            result = _mirror(result, sign * self.b, height)
        return result

    def positions(self, net: solver.PiecewiseDog) -> np.ndarray:
        """All vertices, turned so that the lowest patch lies nearly flat with its front up."""
        branches = _patch_branches(net, lambda x, y: self._branch(x, y))
        result = np.empty((len(net.rest), 3))
        for branch in np.unique(branches):
            mine = branches == branch
            result[mine] = self.fold(net.rest[mine], int(branch))
        return upright(result)

    def bent(self, net: solver.PiecewiseDog) -> np.ndarray:
        """The unfolded state of the same cylinder: no crease is folded, the whole sheet is smooth."""
        return upright(self.fold(net.rest, 0))

    def at(self, place: tuple[float, float]) -> np.ndarray:
        """One point of the sheet, turned as ``positions`` turns it."""
        return upright(self.fold(np.array([place]), self._branch(*place)))[0]

    def fold_angle(self, x: np.ndarray) -> np.ndarray:
        """Degrees, unsigned."""
        half = np.sqrt(self.b**2 - self.slope(x) ** 2) / np.sqrt(1 + self.b**2)
        return np.degrees(2 * np.arccos(half))

    def _branch(self, x: float, y: float) -> int:
        at = np.array([x])
        return sum(y > sign * float(self.g(at)[0]) + height for sign, height in self.creases)

    def _run(self, x: np.ndarray) -> np.ndarray:
        """The integral of sqrt(1 - (g'/b)²) from 0, by Gauss's rule on short pieces."""
        node, weight = np.polynomial.legendre.leggauss(12)
        marks = np.unique(np.concatenate([[0.0], x]))
        total = np.zeros(len(marks))
        for k, (p, q) in enumerate(itertools.pairwise(marks)):
            cuts = np.linspace(p, q, 5)
            middle, half = 0.5 * (cuts[1:] + cuts[:-1]), 0.5 * np.diff(cuts)
            t = middle[:, None] + half[:, None] * node
            total[k + 1] = total[k] + float(
                (half[:, None] * weight * np.sqrt(1 - (self.slope(t) / self.b) ** 2)).sum()
            )
        total -= total[np.searchsorted(marks, 0.0)]
        return total[np.searchsorted(marks, x)]


def upright(points: np.ndarray) -> np.ndarray:
    """Turn (X, Y, Z) to (Y, Z, X): a rotation that lays the lowest patch of state A on the table."""
    return points[:, [1, 2, 0]]


def sine(b: float, creases: Sequence[tuple[int, float]] = ((1, 0.0),), height: float = 0.3) -> Graphs:
    """g = height sin(pi x)."""
    return Graphs(
        lambda x: height * np.sin(np.pi * x),
        lambda x: height * np.pi * np.cos(np.pi * x),
        b,
        tuple(creases),
    )


def arc(b: float, radius: float = 2.0) -> Graphs:
    """g = sqrt(radius² - x²) - radius."""
    return Graphs(lambda x: np.sqrt(radius**2 - x**2) - radius, lambda x: -x / np.sqrt(radius**2 - x**2), b)


# --- B: concentric pleats -------------------------------------------------------------------------------


@dataclass(frozen=True)
class Pleats:
    """State B: circular creases of the given radii on a sector, folded to a pleated cone."""

    half_angle: float  # radians
    radii: tuple[float, ...]
    inner: float
    outer: float
    sector: float  # half the sector's opening, radians, about the direction +y

    def pattern(self) -> solver.CreasePattern:
        psi = np.linspace(np.pi / 2 - self.sector, np.pi / 2 + self.sector, 241)
        circle = np.column_stack([np.cos(psi), np.sin(psi)])
        return solver.CreasePattern(
            boundary=np.vstack([self.outer * circle, self.inner * circle[::-1]]),
            creases=[solver.Crease(points=r * circle) for r in self.radii],
        )

    def fold(self, points: np.ndarray, branch: int) -> np.ndarray:
        """(N,3) of flat points (N,2) under the isometry outside ``branch`` creases."""
        r, psi = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
        slope = 1 - 2 * (np.arange(branch + 1) % 2)
        height = slope[branch] * r
        for k in range(branch):
            height = height + (slope[k] - slope[k + 1]) * self.radii[k]
        s = np.sin(self.half_angle)
        return np.column_stack([r * s * np.cos(psi / s), r * s * np.sin(psi / s), np.cos(self.half_angle) * height])

    def positions(self, net: solver.PiecewiseDog) -> np.ndarray:
        branches = _patch_branches(net, lambda x, y: int(np.searchsorted(self.radii, np.hypot(x, y))))
        result = np.empty((len(net.rest), 3))
        for branch in np.unique(branches):
            mine = branches == branch
            result[mine] = self.fold(net.rest[mine], int(branch))
        return result


# --- H: prism folds -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Prism:
    """State H on a grid of unit cells: the crease climbs by rises[i] (cells) over the i-th column of cells.

    Rises are dyadic, so that the crossings with the grid are exact numbers and the state holds to rounding.
    """

    b: float
    rises: tuple[float, ...]
    start: int  # height of the crease's first point
    height: int  # of the sheet

    @property
    def crease(self) -> np.ndarray:
        """(n+1,2) the polyline's points on the vertical grid lines."""
        n = len(self.rises)
        return np.column_stack([np.arange(n + 1.0), self.start + np.concatenate([[0.0], np.cumsum(self.rises)])])

    def pattern(self) -> solver.CreasePattern:
        n, points = len(self.rises), self.crease
        # Straight cubic segments: the crease is this polyline, not a smooth curve through its points.
        t = np.array([0.0, 1 / 3, 2 / 3, 1.0])[None, :, None]
        beziers = (1 - t) * points[:-1, None] + t * points[1:, None]
        return solver.CreasePattern(
            boundary=[(0, 0), (n, 0), (n, self.height), (0, self.height)],
            creases=[solver.Crease(points=points, beziers=beziers)],
        )

    def net(self) -> solver.PiecewiseDog:
        return solver.build_net(self.pattern(), max(len(self.rises), self.height))

    def positions(self, net: solver.PiecewiseDog) -> np.ndarray:
        sines = np.array(self.rises) / self.b
        x = np.concatenate([[0.0], np.cumsum(sines)])
        y = np.concatenate([[0.0], np.cumsum(np.sqrt(1 - sines**2))])
        column = np.rint(net.rest[:, 0]).astype(int)
        points = np.column_stack([x[column], y[column], net.rest[:, 1]])
        above = _patch_branches(net, lambda px, py: int(py > np.interp(px, *self.crease.T)))
        return upright(np.where(above[:, None] > 0, _mirror(points, self.b, float(self.start)), points))
