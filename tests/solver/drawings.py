"""Small crease patterns: the plain ones that tests fold, and the awkward ones that break meshers."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

import solver


def rectangle(width: float = 1.0, height: float = 1.0) -> np.ndarray:
    return np.array([(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)])


def curve(ends: Sequence[Sequence[float]], sag: float, count: int = 41, **more: object) -> solver.Crease:
    """A parabolic arc between two points; ``sag`` to the left of the chord."""
    a, b = np.asarray(ends, dtype=float)
    t = np.linspace(0.0, 1.0, count)[:, None]
    left = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a))
    return solver.Crease(points=(1 - t) * a + t * b + 4 * sag * t * (1 - t) * left, **more)


def circle(centre: Sequence[float], radius: float, count: int = 64, **more: object) -> solver.Crease:
    t = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    points = np.asarray(centre) + radius * np.column_stack([np.cos(t), np.sin(t)])
    return solver.Crease(points=points, closed=True, **more)


def line(*points: Sequence[float], **more: object) -> solver.Crease:
    return solver.Crease(points=points, **more)


def square_with(*creases: solver.Crease, holes: Sequence[np.ndarray] = ()) -> solver.CreasePattern:
    return solver.CreasePattern(boundary=rectangle(), holes=holes, creases=creases)


def one_arc() -> solver.CreasePattern:
    return square_with(curve([(0, 0.45), (1, 0.45)], 0.15))


def two_arcs() -> solver.CreasePattern:
    return square_with(curve([(0, 0.25), (1, 0.25)], 0.1), curve([(0, 0.6), (1, 0.6)], 0.1))


def off_centre() -> solver.CreasePattern:
    """Two arcs without any symmetry, so that nothing hangs on a tie."""
    return solver.CreasePattern(
        boundary=rectangle(1.0, 0.7),
        creases=[curve([(0, 0.21), (1, 0.17)], 0.09), curve([(0, 0.43), (1, 0.52)], -0.05)],
    )


# --- awkward drawings, by name --------------------------------------------------------------------------


def crossing() -> solver.CreasePattern:
    return square_with(curve([(0, 0.3), (1, 0.62)], 0.1), curve([(0.35, 0), (0.57, 1)], -0.1))


def loop() -> solver.CreasePattern:
    """One crease that crosses itself: the teardrop inside it is a patch."""
    t = np.linspace(-1.0, 1.0, 161)
    x = 0.5 + 0.9 * (1.9 * t**3 - 1.0 * t)
    y = 0.2 + 0.7 * (1 - t**2)
    keep = (x > 0) & (x < 1) & (y > 0)
    points = np.column_stack([x, y])[keep]
    return square_with(solver.Crease(points=np.vstack([[0.0, points[0, 1]], points, [1.0, points[-1, 1]]])))


def cusp() -> solver.CreasePattern:
    t = np.linspace(-1.0, 1.0, 81)
    return square_with(solver.Crease(points=np.column_stack([0.5 + 0.5 * t, 0.3 + 0.4 * np.abs(t) ** 0.5])))


def hairpin() -> solver.CreasePattern:
    """A narrow U from the border, crossed by another crease: three pieces on each side of that one."""
    t = np.linspace(-1.0, 1.0, 121)
    pin = np.column_stack([0.52 + 0.09 * t, 0.8 * (1 - t**4)])
    return square_with(solver.Crease(points=pin), curve([(0, 0.4), (1, 0.45)], 0.05))


def closed_circle() -> solver.CreasePattern:
    return square_with(circle((0.47, 0.53), 0.3))


def swirl(arms: int) -> solver.CreasePattern:
    """Spirals around the middle, both ends of each on the paper."""
    t = np.linspace(0.15, 1.0, 30)
    turns = np.linspace(0.0, 2 * np.pi, arms, endpoint=False)[:, None] + 2 * t
    return square_with(
        *(solver.Crease(points=0.5 + 0.48 * np.column_stack([t * np.cos(a), t * np.sin(a)])) for a in turns)
    )


def free_end() -> solver.CreasePattern:
    return square_with(curve([(0, 0.45), (0.6, 0.52)], 0.08))


def tee() -> solver.CreasePattern:
    return square_with(curve([(0, 0.4), (1, 0.4)], 0.1), curve([(0.45, 0.4990), (0.6, 1)], 0.05))


def star(arms: int) -> solver.CreasePattern:
    """Curved arms from one point to the border of a disc-like sheet."""
    centre = np.array([0.503, 0.497])
    creases = []
    for k in range(arms):
        direction = 2 * np.pi * (k + 0.29) / arms
        step = np.array([np.cos(direction), np.sin(direction)])
        reach = min(((1.0 if s > 0 else 0.0) - c) / s for c, s in zip(centre, step, strict=True) if abs(s) > 1e-9)
        creases.append(curve([centre, centre + reach * step], 0.04))
    return square_with(*creases)


def duplicate() -> solver.CreasePattern:
    arc = curve([(0, 0.45), (1, 0.45)], 0.15)
    return square_with(arc, solver.Crease(points=arc.points[::-1]))


def near_duplicate() -> solver.CreasePattern:
    arc = curve([(0, 0.45), (1, 0.45)], 0.15)
    return square_with(arc, solver.Crease(points=arc.points + np.array([0.0, 4e-4])))


def sliver() -> solver.CreasePattern:
    """Two creases with the same ends that enclose far less than a cell's width."""
    return square_with(
        curve([(0, 0.45), (1, 0.45)], 0.1500),
        curve([(0, 0.45), (1, 0.45)], 0.1507),
    )


def sticking_out() -> solver.CreasePattern:
    return square_with(curve([(-0.3, 0.4), (1.4, 0.5)], 0.15))


def holed() -> solver.CreasePattern:
    """A crease from the border to a hole, and on from there: the hole joins the two halves' cut."""
    hole = np.array([(0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)])
    return square_with(curve([(0, 0.47), (0.4, 0.5)], 0.03), curve([(0.6, 0.5), (1, 0.53)], 0.03), holes=[hole])


def ring() -> solver.CreasePattern:
    """An annulus with one closed crease."""
    t = np.linspace(0.0, 2 * np.pi, 96, endpoint=False)
    unit = np.column_stack([np.cos(t), np.sin(t)])
    return solver.CreasePattern(
        boundary=unit, holes=[0.4 * unit[::-1]], creases=[circle((0.0, 0.0), 0.7, count=96)]
    )


def s_curve() -> solver.CreasePattern:
    x = np.linspace(0.0, 1.0, 81)
    return square_with(solver.Crease(points=np.column_stack([x, 0.5 + 0.12 * np.sin(2 * np.pi * x)])))


def lens() -> solver.CreasePattern:
    return square_with(curve([(0, 0.5), (1, 0.5)], 0.17), curve([(0, 0.5), (1, 0.5)], -0.17))


#: Name -> drawing and how many pieces its creases cut the sheet into.
AWKWARD: dict[str, tuple[Callable[[], solver.CreasePattern], int]] = {
    "one arc": (one_arc, 2),
    "crossing": (crossing, 4),
    "loop": (loop, 3),
    "cusp": (cusp, 2),
    "hairpin across a crease": (hairpin, 5),
    "closed circle": (closed_circle, 2),
    "free end": (free_end, 1),
    "tee": (tee, 3),
    "star of three": (lambda: star(3), 3),
    "star of four": (lambda: star(4), 4),
    "star of five": (lambda: star(5), 5),
    "star of six": (lambda: star(6), 6),
    "star of seven": (lambda: star(7), 7),
    "star of eight": (lambda: star(8), 8),
    "duplicate": (duplicate, 2),
    "near duplicate": (near_duplicate, 2),
    "sliver": (sliver, 2),
    "sticking out": (sticking_out, 2),
    "hole": (holed, 2),
    "ring": (ring, 2),
    "inflection": (s_curve, 2),
    "lens": (lens, 3),
}
