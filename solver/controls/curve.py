"""Curve-constrained flow: a crease led to another curvature and torsion, or to a curve in space (paper, Fig. 6).

All at once fails; the curve is rebuilt at every step between what it was and what it is to be, laid onto the
crease where it lies, and its points draw the crease's own. A crease of flat curvature k that is folded by 2 h has
k / cos h in space, so the way is even in h, not in the curvature, which starts from flat like h².
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..drive import MEAN_BUDGET, mean_stretch
from ..errors import DescriptionError
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.continuity import mean_gap
from ..optimize.term import LinearTerm
from .control import Control, ControlPull, CreaseName, crease_index, crease_name, flag, number, positive, vector
from .firmness import Firmness
from .pull import Finding, Lack, Term
from .space_curve import CurveShape, build_curve, laid_onto, measure_curve, resampled

#: Crease points of a flow are at least this far apart, net units: nearer ones tell no curvature.
_SPACING = 0.8
#: A flow of speed 1 turns a fold, or the whole twist of a curve, at most this much an iteration, degrees.
_TURN_RATE = 0.8
#: A target may be flatter than the flat crease by this part, or this much (1 / net unit), for its sampling.
_FLATTER, _FLATTER_BY = 0.03, 2e-3
#: Where the target is this much sharper than the flat crease, the way is even in the curvature itself.
_NEARLY_STRAIGHT = 0.1
#: A space curve may be shorter than the crease by this part.
_SHORTER = 0.02
#: A curve that is missed although the paper is far from stretched, and from torn, pulls harder, at most so often.
_STIFFER, _STIFFENINGS = 4.0, 4
#: Not with a mean gap beyond this, net units, half of what paper may show at rest: a curve that it cannot follow
#: would tear the paper open.
_TAUT_GAP = 0.7e-4
#: Where on its way from flat a crease is, is found in steps of one of so many parts.
_PARTS = 200
#: At rest a free curve is laid onto the crease anew at most so often.
_LAYINGS = 6
#: Curvatures and torsions beyond this are no curve on any net, per net unit.
_NO_CURVE = 1e6
#: Points farther than this from the curve at rest pull harder, and farther than that have missed it, net units: the
#: gallery's flows come within 0.064, and a crease that another control holds at 5 degrees stays 0.104 away.
_CLOSE, _REACHED = 0.01, 0.08


@dataclass(frozen=True)
class Curve(Control):
    """A crease's shape in space.

    crease: number from 1, or name; an open one
    curvature_times, curvature_plus: the size of its curvature becomes times · what it is + plus (1 / drawing unit)
    torsion_times, torsion_plus: the same for the torsion, whose sign counts
    points: or a curve in space, (x, y, z) each, drawing units, from the crease's start on; the four numbers
        above then count for nothing
    progress: the part of the way that is gone, 0 to 1; speed: how fast, in parts of the usual
    from_flat: the way, and what "it is" above means, begin at the flat crease and not at the present one; then
        the same words ask for the same shape whatever the paper was told before
    strength: how hard the curve pulls, in parts of the usual weight
    """

    crease: CreaseName
    curvature_times: float = 1.0
    curvature_plus: float = 0.0
    torsion_times: float = 1.0
    torsion_plus: float = 0.0
    points: tuple[tuple[float, float, float], ...] | None = None
    progress: float = 1.0
    speed: float = 1.0
    strength: float = 1.0
    from_flat: bool = False

    kind = "curve"

    def __post_init__(self) -> None:
        crease_name(self.crease)
        for name in ("curvature_times", "curvature_plus", "torsion_times", "torsion_plus"):
            number(name, getattr(self, name))
        number("progress", self.progress, 0.0, 1.0)
        positive("speed", self.speed)
        positive("strength", self.strength)
        flag("from_flat", self.from_flat)
        if self.points is not None:
            if isinstance(self.points, str) or not isinstance(self.points, Sequence) or len(self.points) < 2:
                raise DescriptionError("'points' must be a list of at least two points")
            object.__setattr__(self, "points", tuple(vector("points", p, 3) for p in self.points))

    def shape_key(self) -> Curve:
        """The same control as far as its target shape goes: progress and speed are values, not another target."""
        return Curve(
            self.crease,
            self.curvature_times,
            self.curvature_plus,
            self.torsion_times,
            self.torsion_plus,
            self.points,
            from_flat=self.from_flat,
        )


@dataclass(eq=False)
class _Flow:
    """One crease on its way. Lengths in net units."""

    control: Curve
    label: str
    points: IntArray  # crease points that are drawn
    arc: FloatArray
    flat: FloatArray  # (n-2,) curvature of the flat crease, unsigned
    start: CurveShape
    end: CurveShape
    start_places: FloatArray
    end_places: FloatArray | None  # (n,3) where the curve lies in the end, None: anywhere
    crease: int
    turn: float  # sign of the flat crease's first turn
    part: float = 0.0

    def shape(self, part: float) -> CurveShape:
        """The curve's shape after a part of the way."""
        a, b = np.abs(self.start.curvature), np.abs(self.end.curvature)
        flat = self.flat
        with np.errstate(divide="ignore", invalid="ignore"):
            before = np.arccos(np.clip(np.where(a > 0, flat / a, 1.0), 0, 1))
            after = np.arccos(np.clip(np.where(b > 0, flat / b, 1.0), 0, 1))
        even = flat / np.maximum(np.cos((1 - part) * before + part * after), 1e-6)
        straight = flat < _NEARLY_STRAIGHT * np.maximum(b, 1e-12)
        sign = np.where(self.end.curvature < 0, -1.0, 1.0)
        curvature = sign * np.where(straight, (1 - part) * a + part * b, even)
        # Where the curve ends flatter than it can, by its sampling, it still ends where it was told.
        curvature = np.where(part >= 1.0, self.end.curvature, curvature)
        return CurveShape(curvature, (1 - part) * self.start.torsion + part * self.end.torsion)

    def nearest_part(self, present: CurveShape) -> float:
        """The part of the way whose curve is most like this shape."""
        parts = np.linspace(0.0, 1.0, _PARTS + 1)
        misses = []
        for part in parts:
            shape = self.shape(float(part))
            bend = np.abs(shape.curvature) - np.abs(present.curvature)
            misses.append(float(bend @ bend + ((shape.torsion - present.torsion) ** 2).sum()))
        return float(parts[int(np.argmin(misses))])

    def go_on_from(self, places: FloatArray) -> None:
        """Take the way up again where its curve is most like the present one, whose points lie at places (n,3)."""
        self.part = min(self.nearest_part(measure_curve(places, self.turn)), self.control.progress)
        if self.end_places is not None and self.part < 1.0:
            self.start_places = (places - self.part * self.end_places) / (1.0 - self.part)

    def leads_away(self) -> bool:
        """Whether the end is another shape or place than the start."""
        return (
            self.end_places is not None
            or not np.allclose(np.abs(self.end.curvature), np.abs(self.start.curvature), atol=1e-9)
            or not np.allclose(self.end.torsion, self.start.torsion, atol=1e-9)
        )

    def most_turn(self) -> float:
        """Degrees that the curve's folds, or its whole twist, turn on the whole way."""
        folds = [
            np.arccos(np.clip(self.flat / np.maximum(np.abs(s.curvature), 1e-12), 0, 1))
            for s in (self.start, self.end)
        ]
        fold = 2 * np.abs(folds[1] - folds[0]).max(initial=0.0)
        twist = np.abs((self.end.torsion - self.start.torsion) * self.arc[1:-1]).sum()
        turn = np.abs((self.end.curvature - self.start.curvature) * self.arc[1:]).sum()
        return float(np.degrees(max(fold, twist, turn)))


class CurvePull(ControlPull):
    """All creases that flow."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight
        self._flows: list[_Flow] = []
        self._targets: list[FloatArray] = []
        self._firmness, self._laid = Firmness(_STIFFENINGS), 0
        self._waiting: frozenset[int] = frozenset()  # creases that another control takes through flat

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        before = {flow.control.shape_key(): flow for flow in self._flows}
        flows: list[_Flow] = []
        for label, control in controls:
            old = before.get(control.shape_key())
            if old is not None:
                old.control, old.label = control, label
                flows.append(old)
            else:
                flows.append(self._flow(label, control, x))
        creases = [flow.crease for flow in flows]
        for k, flow in enumerate(flows):
            if creases[k] in creases[:k]:
                raise DescriptionError("is about the same crease as an earlier one", element=flow.label)
        self._flows = flows
        self._targets = [self._places(flow, x) for flow in flows]

    def terms(self) -> list[Term]:
        if not self._flows:
            return []
        crease = self._net.crease_points
        rows = np.concatenate([flow.points for flow in self._flows])
        stencil = np.hstack([crease.left_vertices[rows], crease.right_vertices[rows]])
        coefficients = 0.5 * np.hstack([crease.left_weights[rows], crease.right_weights[rows]])
        strength = np.concatenate(
            [np.full(len(f.points), f.control.strength if self._pulls(f) else 0.0) for f in self._flows]
        )
        weight = self._weight * self._firmness.factor * strength
        return [LinearTerm("curves", stencil, coefficients, np.vstack(self._targets), weight)]

    def asks(self, x: FloatArray) -> bool:
        return self._weight > 0 and any(flow.control.progress > 0 and flow.leads_away() for flow in self._flows)

    def on_way(self) -> bool:
        return any(flow.part != flow.control.progress for flow in self._flows if self._pulls(flow))

    def move(self, x: FloatArray, pace: float) -> bool:
        moved = False
        for k, flow in enumerate(self._flows):
            away = flow.control.progress - flow.part
            if away and self._pulls(flow):
                rate = pace * flow.control.speed * _TURN_RATE / max(flow.most_turn(), _TURN_RATE)
                flow.part = (
                    flow.control.progress if abs(away) <= rate else flow.part + float(np.clip(away, -rate, rate))
                )
                moved = True
                self._targets[k] = self._places(flow, x)
        return moved

    def make_way(self, creases: frozenset[int], x: FloatArray) -> bool:
        """A crease has the flat one's curvature on its way through flat. It flows on from where it comes out."""
        waiting = creases & {flow.crease for flow in self._flows}
        if waiting == self._waiting:
            return False
        for k, flow in enumerate(self._flows):
            if flow.crease in self._waiting - waiting:
                present = self._present(flow.points, x)
                flow.go_on_from(present)
                self._targets[k] = self._places(flow, x)
        self._waiting = waiting
        return True

    def _pulls(self, flow: _Flow) -> bool:
        return flow.crease not in self._waiting

    def settle(self, x: FloatArray) -> bool:
        if not any(map(self._pulls, self._flows)):
            return False
        # A curve that may lie anywhere goes along with the paper.
        targets = [self._places(flow, x) for flow in self._flows]
        turned = max(float(np.abs(a - b).max()) for a, b in zip(targets, self._targets, strict=True))
        self._targets = targets
        if turned > _CLOSE and self._laid < _LAYINGS:
            self._laid += 1
            return True
        if self._firmness.spent or mean_stretch(self._net, x) > 0.5 * MEAN_BUDGET:
            return False
        if mean_gap(self._net, x) > _TAUT_GAP:
            return False
        if max(self._misses(x)) <= _CLOSE:
            return False
        self._firmness.change(_STIFFER)
        return True

    def let_go(self, part: float) -> bool:
        self._firmness.let_go(part)
        return bool(self._flows)

    def wake(self) -> None:
        self._laid = 0
        self._firmness.wake()

    def shortfall(self, x: FloatArray) -> float:
        misses = self._misses(x) if self._flows else []
        return float(sum(max(miss - _REACHED, 0.0) for miss in misses))

    def mark(self) -> object:
        return [(flow.part, target) for flow, target in zip(self._flows, self._targets, strict=True)]

    def go_back(self, mark: object) -> None:
        if isinstance(mark, list) and len(mark) == len(self._flows):
            for flow, (part, _) in zip(self._flows, mark, strict=True):
                flow.part = part
            self._targets = [target for _, target in mark]

    def findings(self, x: FloatArray) -> list[Finding]:
        result = []
        for flow, miss in zip(self._flows, self._misses(x), strict=True):
            name = self._net.crease_labels[flow.crease]
            if abs(flow.control.progress - flow.part) > 1e-9:
                gone = flow.part / flow.control.progress if flow.control.progress else 0.0
                sentence = f"{name} came {gone:.0%} of the way to the curve that it was given"
                result.append(Finding(Lack.REACH, sentence, flow.crease))
            elif miss > _REACHED:
                away = miss * self._net.frame.unit
                sentence = f"{name} stays {away:.3g} from the curve that it was given"
                result.append(Finding(Lack.REACH, sentence, flow.crease))
        return result

    def progress(self) -> dict[int, float]:
        """The part of its way, 0 to 1, that each crease with a curve has gone by now."""
        return {flow.crease: flow.part for flow in self._flows}

    def _misses(self, x: FloatArray) -> list[float]:
        result = []
        for flow in self._flows:
            gap = self._present(flow.points, x) - self._places(flow, x)
            result.append(float(np.linalg.norm(gap, axis=1).max()))
        return result

    def _places(self, flow: _Flow, x: FloatArray) -> FloatArray:
        """(n,3) where the crease's points are drawn to after the part of the way that is gone."""
        curve = build_curve(flow.arc, flow.shape(flow.part))
        if flow.end_places is None:
            return laid_onto(curve, self._present(flow.points, x))
        return laid_onto(curve, (1 - flow.part) * flow.start_places + flow.part * flow.end_places)

    def _present(self, points: IntArray, x: FloatArray) -> FloatArray:
        crease = self._net.crease_points
        copies = [
            np.einsum("nk,nkc->nc", weights[points], x[vertices[points]])
            for vertices, weights in (
                (crease.left_vertices, crease.left_weights),
                (crease.right_vertices, crease.right_weights),
            )
        ]
        return np.asarray(0.5 * (copies[0] + copies[1]))

    def _flow(self, label: str, control: Curve, x: FloatArray) -> _Flow:
        net = self._net
        try:
            index = crease_index(net.crease_labels, control.crease)
        except DescriptionError as error:
            raise DescriptionError(error.message, element=label) from None
        points, arc, turn = _along(net, index, label)
        flat = np.column_stack([net.crease_points.position[points], np.zeros(len(points))])
        flat_shape = measure_curve(flat, turn)
        present = self._present(points, x)
        now = measure_curve(present, turn)
        start = flat_shape if control.from_flat else now
        if control.points is None:
            end_places = None
            sign = np.where(start.curvature < 0, -1.0, 1.0)
            unit = net.frame.unit
            size = control.curvature_times * np.abs(start.curvature) + control.curvature_plus * unit
            end = CurveShape(sign * size, control.torsion_times * start.torsion + control.torsion_plus * unit)
        else:
            end_places = self._on_curve(control, label, arc, index)
            end = measure_curve(end_places, turn)
            size = np.abs(end.curvature)
        if not all((np.abs(turns) <= _NO_CURVE).all() for turns in (end.curvature, end.torsion)):
            raise DescriptionError(
                f"{net.crease_labels[index]} is asked for a curvature or torsion beyond all bounds", element=label
            )
        bare = np.abs(flat_shape.curvature)
        lack = bare * (1 - _FLATTER) - _FLATTER_BY - size
        worst = int(np.argmax(lack))
        if lack[worst] > 0:
            place = net.frame.to_drawing(flat[worst + 1 : worst + 2, :2])[0]
            raise DescriptionError(
                f"{net.crease_labels[index]} would be flatter in space than it is drawn: a radius of "
                f"{net.frame.unit / max(float(size[worst]), 1e-9):.4g} where the drawing has "
                f"{net.frame.unit / float(bare[worst]):.4g}; folding only makes a crease sharper",
                element=label,
                place=tuple(place.tolist()),
            )
        flow = _Flow(control, label, points, arc, bare, start, end, present, end_places, index, turn)
        if control.from_flat:
            flow.start_places = flat
            flow.part = flow.nearest_part(now)
        return flow

    def _on_curve(self, control: Curve, label: str, arc: FloatArray, index: int) -> FloatArray:
        """(n,3) the points of a space curve as far apart along it as the crease's are, net units."""
        net = self._net
        given = net.frame.to_net(np.array(control.points))
        length = float(np.linalg.norm(np.diff(given, axis=0), axis=1).sum())
        needed = float(arc.sum())
        if length < needed * (1 - _SHORTER):
            unit = net.frame.unit
            raise DescriptionError(
                f"the curve is {length * unit:.4g} long, shorter than {net.crease_labels[index]}, "
                f"which is {needed * unit:.4g} long",
                element=label,
            )
        at = np.concatenate([[0.0], np.cumsum(arc)])
        return resampled(given, at * min(1.0, length / needed))


def _along(net: PiecewiseDog, index: int, label: str) -> tuple[IntArray, FloatArray, float]:
    """Crease points (n,) of one crease in order, arcs (n-1,) between them, and the sign of its first turn."""
    crease = net.crease_points
    both = (crease.left_vertices[:, 0] >= 0) & (crease.right_vertices[:, 0] >= 0)
    mine = np.flatnonzero((crease.crease == index) & both)
    name = net.crease_labels[index]
    kept: list[int] = []
    arc: list[float] = []
    for k in mine.tolist():
        if not kept:
            kept.append(k)
            continue
        last = kept[-1]
        if crease.chain[k] == crease.chain[last]:
            step = float(crease.along[k] - crease.along[last])
        else:
            # The next piece begins where the last one ended, or the crease is not one curve.
            ends = mine[crease.chain[mine] == crease.chain[last]]
            end = int(ends[-1])
            first = int(mine[crease.chain[mine] == crease.chain[k]][0])
            if np.hypot(*(crease.position[end] - crease.position[first])) > 1e-3:
                raise DescriptionError(f"{name} is cut into pieces that do not follow each other", element=label)
            step = float(crease.along[end] - crease.along[last] + crease.along[k] - crease.along[first])
        if step >= _SPACING:
            kept.append(k)
            arc.append(step)
    if len(kept) < 4:
        raise DescriptionError(f"{name} is too short on this net for a curve", element=label)
    points = np.array(kept, dtype=np.int64)
    ends = crease.position[mine[[0, -1]]]
    if not crease.end[mine].any() and np.hypot(*(ends[1] - ends[0])) < 2.0:
        raise DescriptionError(f"{name} is closed: only open creases can be given a curve", element=label)
    step_before, step_after = np.diff(crease.position[points], axis=0)[[0, 1]]
    turn = step_before[0] * step_after[1] - step_before[1] * step_after[0]
    return points, np.array(arc), 1.0 if turn >= 0 else -1.0
