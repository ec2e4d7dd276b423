"""Random drags of a drawing's sheet, feasible or not by construction.

What is known to be feasible comes in two kinds. *Short*: two handles whose targets are nearer to each other than
the handles are on the flat sheet. *Witnessed*: two to eight handles that go where a folded state has them, found
another way (by the angle drive, alone or helping the handles) and passed by the independent check
(``solver.verify``): three and more points that are only pairwise near enough can still ask for a shape that no
paper with these creases has. A drag that goes too far breaks the first: two targets are farther apart than the
paper between their handles is long.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

import solver
from benchmarks.corpus_drawings import Drawing
from solver.arrays import FloatArray

Rng = np.random.Generator
KINDS = ("lift", "plane", "twist", "pose", "far", "back")
_PARTS = (0.3, 0.1, 0.08, 0.26, 0.1, 0.16)
#: A witness is driven to an angle between these, degrees; where the paper does not bear that, to parts of it.
_WITNESS_ANGLES, _WITNESS_PARTS = (20.0, 70.0), (1.0, 0.5, 0.25)
_WITNESS_ITERATIONS = 600
#: Some two handles come nearer by at least this part, or nothing would have to fold.
_NEARER = 0.95
#: Frames of a slow drag, and SQP iterations in each (the protocol's).
SLOW_FRAMES, FRAME_ITERATIONS = 18, 5


@dataclass(frozen=True, eq=False)
class Drag:
    """What is done to a sheet: at (H,2), targets (H,3), drawing units.

    frames: in how many steps; feasible: whether paper can get there; back: whether it then returns to flat
    """

    kind: str
    at: FloatArray
    targets: FloatArray
    frames: int
    feasible: bool
    back: bool

    def handles(self, part: float) -> list[solver.Handle]:
        """The handles with their targets ``part`` of the way from the flat sheet."""
        start = np.column_stack([self.at, np.zeros(len(self.at))])
        now = start + part * (self.targets - start)
        return [solver.Handle(tuple(a), tuple(t)) for a, t in zip(self.at.tolist(), now.tolist(), strict=True)]


def make_drag(seed: int, drawing: Drawing, net: solver.PiecewiseDog) -> Drag:
    """The drag of a seed, on a drawing and its net."""
    rng = np.random.default_rng([seed, 2])
    kind = str(rng.choice(KINDS, p=_PARTS))
    frames = 1 if rng.random() < 0.5 else SLOW_FRAMES
    count = {"pose": int(rng.integers(2, 9)), "far": 2, "twist": 3}.get(kind, int(rng.integers(2, 5)))
    at = _ends(drawing) if kind == "twist" else _places(rng, drawing, count)
    flat = np.column_stack([at, np.zeros(len(at))])
    targets = flat
    if kind == "far":
        targets = _far(rng, drawing, at)
    elif kind != "pose":
        moved = {"lift": _lifted, "plane": _pushed, "twist": _twisted, "back": _lifted}[kind](rng, drawing, at)
        targets = flat + _short_part(at, moved) * (moved - flat)
        if _nearest(at, targets) > _NEARER:
            # Nothing had to fold: push everything together a little.
            targets[:, :2] = drawing.box.middle + 0.85 * (targets[:, :2] - drawing.box.middle)
    at, targets = drawing.to_drawing(at), drawing.to_drawing(targets)
    if kind == "pose" or (kind != "far" and len(at) > 2):
        witnessed = _witnessed(rng, net, at, None if kind == "pose" else targets)
        if witnessed is None:
            # No witness: two handles need none.
            at, targets = _closer(at)
        else:
            targets = witnessed
    return Drag(kind, at, targets, frames, kind != "far", kind == "back")


def protocol_drag(pattern: solver.CreasePattern) -> Drag:
    """The reference's drag: the two lower corners of the sheet, a quarter of the way to the centre in the plane
    and a fifth of the diagonal out of it, in 18 frames."""
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    corners = np.array([low, (high[0], low[1])])
    at = np.array([pattern.boundary[np.argmin(np.hypot(*(pattern.boundary - c).T))] for c in corners])
    centre, diagonal = 0.5 * (low + high), float(np.hypot(*(high - low)))
    targets = np.column_stack([at + 0.25 * (centre - at), np.full(2, 0.2 * diagonal)])
    return Drag("protocol", at, targets, SLOW_FRAMES, True, False)


# --- in box coordinates ---------------------------------------------------------------------------------


def _places(rng: Rng, drawing: Drawing, count: int) -> FloatArray:
    """Handles (H,2): points of the border and, rarely, inside; never two close together."""
    sheet = drawing.outline
    apart = 0.3 * drawing.box.size
    places: list[FloatArray] = []
    for _ in range(400):
        x0, y0, x1, y1 = sheet.bounds
        place = np.array([rng.uniform(x0, x1), rng.uniform(y0, y1)])
        if rng.random() < 0.85:
            ring = sheet.exterior
            place = shapely.get_coordinates(ring.interpolate(rng.random(), normalized=True))[0]
        inside = sheet.buffer(1e-9).covers(shapely.Point(place))
        if inside and all(np.hypot(*(place - other)) > apart for other in places):
            places.append(place)
        if len(places) == count:
            break
    return np.array(places)


def _ends(drawing: Drawing) -> FloatArray:
    """Two corners of one end of the sheet and the middle of the other."""
    x0, y0, x1, y1 = drawing.outline.bounds
    return np.array([_on(drawing.outline, np.array(p)) for p in ((x0, y0), (x0, y1), (x1, 0.5 * (y0 + y1)))])


def _on(sheet: shapely.Polygon, place: FloatArray) -> FloatArray:
    return shapely.get_coordinates(shapely.shortest_line(sheet, shapely.Point(place)))[0]


def _lifted(rng: Rng, drawing: Drawing, at: FloatArray) -> FloatArray:
    """Some handles go towards the middle and out of the plane; the others are held."""
    diagonal = float(np.hypot(1.0, drawing.box.height))
    moved = np.column_stack([at, np.zeros(len(at))])
    some = rng.choice(len(at), int(rng.integers(1, len(at) + 1)), replace=False)
    moved[some, :2] += rng.uniform(0.1, 0.3) * (drawing.box.middle - at[some])
    moved[some, 2] += rng.uniform(0.05, 0.2) * diagonal * rng.choice([-1.0, 1.0])
    return moved


def _pushed(rng: Rng, drawing: Drawing, at: FloatArray) -> FloatArray:
    part = rng.uniform(0.1, 0.3)
    return np.column_stack([at + part * (drawing.box.middle - at), np.zeros(len(at))])


def _twisted(rng: Rng, drawing: Drawing, at: FloatArray) -> FloatArray:
    """The two ends turn against each other about the long axis, and come nearer."""
    angle = np.radians(rng.uniform(10.0, 40.0)) * np.where(at[:, 0] < 0.5, 1.0, -1.0)
    across = (at[:, 1] - drawing.box.middle[1]) * 0.93
    x = 0.5 + rng.uniform(0.8, 0.92) * (at[:, 0] - 0.5)
    return np.column_stack([x, drawing.box.middle[1] + across * np.cos(angle), across * np.sin(angle)])


def _witnessed(rng: Rng, net: solver.PiecewiseDog, at: FloatArray, targets: FloatArray | None) -> FloatArray | None:
    """Where a folded state of the net has the handles (H,2): driven to an angle, with their targets (H,3) or
    without. Drawing units. None where no such state passes the check."""
    angle = rng.uniform(*_WITNESS_ANGLES)
    for part in _WITNESS_PARTS:
        model = solver.FoldModel(net)
        if targets is not None:
            pairs = zip(at.tolist(), targets.tolist(), strict=True)
            model.set_handles([solver.Handle(tuple(a), tuple(t)) for a, t in pairs])
        model.set_fold_angle(part * angle)
        model.advance(_WITNESS_ITERATIONS)
        if model.status is solver.Status.SETTLED and solver.verify(net, model.positions).ok:
            located = [net.locate((float(x), float(y))) for x, y in at]
            return np.array([weights @ model.positions[vertices] for vertices, weights in located])
    return None


def _closer(at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The first two handles of some, pushed together by a sixth in the plane. Drawing units."""
    two = at[:2]
    middle = two.mean(axis=0)
    return two, np.column_stack([middle + (two - middle) * 5 / 6, np.zeros(2)])


def _far(rng: Rng, drawing: Drawing, at: FloatArray) -> FloatArray:
    """The first two handles are pulled apart beyond the length of the paper between them."""
    targets = np.column_stack([at, np.zeros(len(at))])
    length = _geodesic(drawing.outline, at[0], at[1])
    chord = at[1] - at[0]
    too_far = length * rng.uniform(1.15, 1.6) + 1.5 / drawing.resolution
    targets[1, :2] = at[0] + chord / np.hypot(*chord) * too_far
    return targets


def _geodesic(sheet: shapely.Polygon, a: FloatArray, b: FloatArray) -> float:
    """An upper bound for the way from a to b on the sheet: straight, or along the border."""
    line = shapely.LineString([a, b])
    if sheet.buffer(1e-9).covers(line):
        return float(line.length)
    return float(line.length + sum(ring.length for ring in (sheet.exterior, *sheet.interiors)) / 2)


def _distances(points: FloatArray) -> FloatArray:
    one, other = np.triu_indices(len(points), 1)
    return np.asarray(np.linalg.norm(points[one] - points[other], axis=1))


def _short_part(at: FloatArray, moved: FloatArray) -> float:
    """The largest part of the move (of 1, 0.9, ...) after which no two handles are farther apart than flat."""
    flat = np.column_stack([at, np.zeros(len(at))])
    for part in np.linspace(1.0, 0.0, 11).tolist():
        if (_distances(flat + part * (moved - flat)) <= _distances(flat) * (1 + 1e-12)).all():
            return part
    return 0.0


def _nearest(at: FloatArray, targets: FloatArray) -> float:
    """How much nearer the two handles came that came nearest to each other, as a part of their distance."""
    return float((_distances(targets) / _distances(at)).min())
