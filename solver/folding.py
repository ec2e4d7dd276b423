"""Folding a net: told handles and angles, advanced iteration by iteration, always in a state to be shown."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from .arrays import FloatArray, IntArray, frozen_array
from .constraints.orthogonal_geodesic import LinkAngles, StarAngles
from .description import Handle, Weights
from .drive import MEAN_BUDGET, AngleDrive, mean_stretch
from .errors import HandleError, NotPositiveDefiniteError
from .first_fold import choose_sides, first_fold
from .measurement import measure
from .net.piecewise_dog import PiecewiseDog
from .objectives.bending import bending
from .objectives.continuity import continuity
from .objectives.fold_condition import FoldCondition, fold_condition
from .objectives.handles import AxisHandles, handles
from .objectives.isometry import isometry
from .optimize.assembly import Problem
from .optimize.sqp import StepReport, at_rest, projection_step, sqp_step
from .optimize.term import LinearTerm, ResidualTerm, gather

#: The drive turns the asked angle at most this much an iteration, degrees (method, section 4: 70° in 225).
ANGLE_RATE = 0.4
#: A handle's target moves at most this far an iteration, net units.
HANDLE_RATE = 0.25
#: Softness of the constraints, 1/energy: while targets move, then in stages at rest, and while polishing.
EPS_STAGES, EPS_POLISHING = (1e-2, 1e-3, 1e-5), 1e-7
#: Still: over this many iterations the merit falls by less than this part of itself (or by _NOTHING).
_STILL_OVER, _STILL_PART, _NOTHING = 10, 2e-3, 1e-7
#: A stage ends after so many iterations even if it is not still: the rest is creep (method, section 3).
_STAGE_MOST = 60
#: Points that come to rest unfolded, and handles off their targets: their terms are made this much stiffer, at
#: most so often.
_STIFFER, _STIFFENINGS = 4.0, 3
#: A fold is safe while the tilts of its two sides, which should cancel, do so to this part.
_MARGIN = 0.5
#: Handles farther than this from their targets at rest pull harder, net units.
_CLOSE = 0.05
#: Polished: the DOG angles hold to this, or no better after so many iterations.
_EXACT, _MAX_POLISH = 1e-9, 40
#: Handles nearer than this to each other hold one point, net units.
_SAME_POINT = 1e-6
#: A handle is reached within this distance, net units (method, section 4).
REACHED = 0.3
#: Fold of the offset that lets a flat sheet choose sides, radians.
_FIRST_ANGLE = np.radians(2.0)
#: The offset lifts no vertex by more than this, net units.
_FIRST_LIFT = 0.5
#: A net whose vertices all lie within this of a plane is flat, net units.
_FLAT = 1e-9


class Status(Enum):
    """How a fold stands. ``sentence`` is for the user; reports add what and where."""

    RUNNING = "still moving towards its targets"
    SETTLED = "settled"
    NOT_FINITE = "the numbers ran away; the last good shape was kept"

    @property
    def sentence(self) -> str:
        return self.value


@dataclass(frozen=True, eq=False)
class SqpReport:
    """What ``advance`` did. Energies and lengths are in net units (mean grid edge 1).

    status; iterations done; objective by term; constraint: largest DOG residual
    handle_error: largest distance of a handle from its target, drawing units (0 without handles)
    asked_angle: the angle the drive asks for now, degrees, None without a drive
    step_lengths, backtracks (one an iteration); seconds by part, and in all
    """

    status: Status
    iterations: int
    objective: dict[str, float]
    constraint: float
    handle_error: float
    asked_angle: float | None
    step_lengths: tuple[float, ...]
    backtracks: tuple[int, ...]
    seconds: dict[str, float]


class FoldModel:
    """A piecewise DOG on its way to a folded shape.

    net        from ``build_net``
    positions  (V,3) drawing units to start from; None: the flat sheet
    weights    of the terms; a weight of 0 leaves its term out
    Targets that are far away are approached along a path, a bounded step an iteration.
    """

    def __init__(
        self, net: PiecewiseDog, positions: ArrayLike | None = None, weights: Weights | None = None
    ) -> None:
        self.net = net
        self.weights = weights or Weights()
        if positions is None:
            x = np.column_stack([net.flat, np.zeros(len(net.flat))])
        else:
            array = frozen_array(positions, np.float64, (len(net.flat), 3), "positions")
            if not np.isfinite(array).all():
                raise ValueError("positions are not finite")
            x = net.frame.to_net(array)
        self._state = at_rest(x)
        self._handles: tuple[Handle, ...] = ()
        self._points: tuple[IntArray, FloatArray] = (np.zeros((0, 4), dtype=np.int64), np.zeros((0, 4)))
        self._axes = np.ones((0, 3), dtype=bool)  # of the drawing, along which each handle pulls
        self._strengths = np.zeros(0)
        self._targets = np.zeros((0, 3))  # where the handles are drawn to in the end, net units
        self._paths = np.zeros((0, 3))  # where they are drawn to now
        self._angle: float | None = None
        self._angle_now = 0.0
        self._problem: Problem | None = None
        self._merits: list[float] = []
        self._stage, self._polished, self._still = 0, 0, False
        self._condition, self._stiffened = 1.0, 0  # stiffness of the fold condition, in parts of its weight
        self._pull, self._pulled = 1.0, 0  # of the handles, in parts of their weight
        self._drive = AngleDrive(net, self.weights.fold_angle)
        self._sides: dict[int, int] = {}
        self.status = Status.RUNNING

    @property
    def positions(self) -> FloatArray:
        """(V,3), drawing units."""
        return self.net.frame.to_drawing(self._state.x)

    @property
    def problem(self) -> Problem:
        """The terms, their sparsity and the linear system at work: for measuring."""
        return self._prepared()

    @property
    def worst_handle(self) -> int:
        """Index of the handle that is farthest from its target. Raises ValueError when there is none."""
        return int(np.argmax(self._handle_gaps()))

    def set_assignments(self, letters: Sequence[str]) -> None:
        """FOLD letters, one a crease: M and V decide the side a flat sheet starts to fold to, others are free.

        A start, not a force: where the paper cannot have these sides together, the fold takes others.
        """
        sides = {"V": 1, "M": -1}
        self._sides = {k: sides[letter] for k, letter in enumerate(letters) if letter in sides}

    def set_handles(self, handles: Sequence[Handle]) -> None:
        """Replace all handles. Handles that stay at the same point keep their way.

        Raises HandleError: a handle off the sheet, or two at one point with different targets.
        """
        located = []
        for k, handle in enumerate(handles):
            try:
                located.append(self.net.locate(handle.at))
            except HandleError as error:
                raise HandleError(error.message, element=f"handle {k + 1}", place=handle.at) from None
        kept = _without_doubles(handles, self.net.frame.unit)
        handles = tuple(handles[k] for k in kept)
        vertices = np.array([located[k][0] for k in kept], dtype=np.int64).reshape(-1, 4)
        weights = np.array([located[k][1] for k in kept]).reshape(-1, 4)
        targets = self.net.frame.to_net(np.array([h.target for h in handles]).reshape(-1, 3))
        now = np.einsum("hk,hkc->hc", weights, self._state.x[vertices])
        same = [next((j for j, old in enumerate(self._handles) if old.at == new.at), None) for new in handles]
        paths = np.array([now[k] if j is None else self._paths[j] for k, j in enumerate(same)])
        axes = np.array([h.axes for h in handles], dtype=bool).reshape(-1, 3)
        if not (
            np.array_equal(vertices, self._points[0])
            and np.array_equal(weights, self._points[1])
            and np.array_equal(axes.all(axis=1), self._axes.all(axis=1))
        ):
            self._problem = None
        self._axes, self._strengths = axes, np.array([h.strength for h in handles])
        self._handles, self._points = handles, (vertices, weights)
        self._targets, self._paths = targets, paths.reshape(-1, 3)
        self._wake()

    def set_fold_angle(self, degrees: float | None) -> None:
        """Drive all creases towards an unsigned fold angle, 0 to 180 degrees; None switches the drive off."""
        if degrees is not None and not 0 <= degrees <= 180:
            raise ValueError("the fold angle must lie between 0 and 180 degrees")
        if (degrees is None) != (self._angle is None):
            self._problem = None
            self._angle_now = self._present_angle() if degrees is not None else 0.0
        self._angle = None if degrees is None else float(degrees)
        self._drive.reset()
        self._wake()

    def advance(self, iterations: int = 5) -> SqpReport:
        """Take up to ``iterations`` SQP steps; fewer when the model has settled."""
        begin = time.perf_counter()
        steps: list[StepReport] = []
        problem = self._prepared()
        done = 0
        for _ in range(iterations):
            if self.status is not Status.RUNNING:
                break
            try:
                if self._still:
                    self._polish(problem)
                else:
                    moving = self._move_targets(problem)
                    self._state, step = sqp_step(problem, self._state, EPS_STAGES[self._stage])
                    steps.append(step)
                    self._watch(problem, step, moving)
            except NotPositiveDefiniteError:
                self.status = Status.NOT_FINITE
                break
            done += 1
        spent: dict[str, float] = {}
        for step in steps:
            for name, seconds in step.seconds.items():
                spent[name] = spent.get(name, 0.0) + seconds
        spent["total"] = time.perf_counter() - begin
        # The last step has evaluated the shape already, unless polishing has moved it since.
        evaluation = steps[-1].evaluation if steps and not self._polished else problem.evaluate(self._state.x)
        return SqpReport(
            self.status,
            done,
            problem.objective_by_term(evaluation),
            float(np.abs(evaluation.constraint).max(initial=0.0)),
            self._handle_error(),
            None if self._angle is None else self._angle_now,
            tuple(step.step_length for step in steps),
            tuple(step.backtracks for step in steps),
            spent,
        )

    # --- inside ----------------------------------------------------------------------------------------

    def _wake(self) -> None:
        self.status = Status.RUNNING
        self._merits, self._stage, self._polished, self._still = [], 0, 0, False
        if self._pulled:
            self._pull, self._pulled = 1.0, 0
            if self._problem is not None:
                self._problem.replace(self._handle_terms())

    def _prepared(self) -> Problem:
        if self._problem is None:
            net, weights = self.net, self.weights
            objectives: list[ResidualTerm | LinearTerm]
            objectives = [*bending(net, weights.bending), isometry(net, weights.isometry),
                          continuity(net, weights.continuity)]  # fmt: skip
            objectives.extend(self._handle_terms().values())
            if weights.fold_condition > 0:
                objectives.append(self._fold_condition())
            if self._angle is not None:
                objectives.append(self._drive.term(self._angle_now))
            constraints: list[ResidualTerm] = [StarAngles(net.stars), LinkAngles(net.links)]
            self._problem = Problem(objectives, constraints, net.flat, bending(net, 1.0))
        if self._asks_for_a_move() and np.ptp(self._state.x[:, 2]) < _FLAT:
            x = self._state.x.copy()
            offset = first_fold(self.net, choose_sides(self.net, self._sides))
            # Many folds in a row would lift the far end of the sheet out of the range of the linear offset.
            x[:, 2] += offset * min(_FIRST_ANGLE, _FIRST_LIFT / max(float(np.abs(offset).max()), 1e-300))
            self._state = at_rest(x)
            if self._angle is not None:
                # The ramp starts from the fold that is there: a smaller angle would flatten the sheet again.
                self._angle_now = min(float(np.degrees(_FIRST_ANGLE)), self._angle)
        return self._problem

    def _asks_for_a_move(self) -> bool:
        return bool(self._angle) or bool(self._handle_gaps().max(initial=0.0) > 1e-9)

    def _present_angle(self) -> float:
        angles = measure(self.net, self.positions).fold_angle
        return float(np.nanmedian(angles)) if np.isfinite(angles).any() else 0.0

    def _handle_places(self) -> FloatArray:
        vertices, weights = self._points
        return np.einsum("hk,hkc->hc", weights, self._state.x[vertices])

    def _handle_error(self) -> float:
        return float(self._handle_gaps().max(initial=0.0)) * self.net.frame.unit

    def _move_targets(self, problem: Problem) -> bool:
        """Bring the targets of this iteration a step nearer; whether they are still on their way."""
        changed: dict[str, ResidualTerm | LinearTerm] = {}
        moving = False
        gap = self._targets - self._paths
        distance = np.linalg.norm(gap, axis=1)
        if (distance > 0).any():
            share = np.minimum(1.0, HANDLE_RATE / np.maximum(distance, 1e-300))
            self._paths = np.where((share >= 1.0)[:, None], self._targets, self._paths + share[:, None] * gap)
            changed.update(self._handle_terms())
            moving = True
        if self._angle is not None and self._angle_now != self._angle:
            turn = np.clip(self._angle - self._angle_now, -ANGLE_RATE, ANGLE_RATE)
            self._angle_now = float(self._angle_now + turn)
            if abs(self._angle - self._angle_now) < 1e-9:
                self._angle_now = self._angle
            changed["fold angle"] = self._drive.term(self._angle_now)
            moving = True
        if changed:
            problem.replace(changed)
        return moving

    def _watch(self, problem: Problem, step: StepReport, moving: bool) -> None:
        """Notice when a stage is over: targets at rest and the merit no longer falling."""
        if moving:
            self._merits = []
            return
        self._merits.append(step.merit)
        recent = self._merits[-_STILL_OVER:]
        fall = recent[0] - recent[-1]
        still = len(recent) == _STILL_OVER and fall < max(_STILL_PART * recent[-1], _NOTHING)
        if not still and len(self._merits) < _STAGE_MOST:
            return
        self._merits = []
        if self._stage + 1 < len(EPS_STAGES):
            self._stage += 1
        else:
            self._still = not self._amended(problem)

    def _amended(self, problem: Problem) -> bool:
        """At rest: ease a drive that stretches the paper, stiffen the condition if points are not folded."""
        changed: dict[str, ResidualTerm | LinearTerm] = {}
        if self._angle is not None and self._drive.ease(self._state.x):
            changed["fold angle"] = self._drive.term(self._angle_now)
        if self._barely_folded():
            changed["fold condition"] = self._stiffer_condition()
        if self._handles_lag():
            self._pull, self._pulled = self._pull * _STIFFER, self._pulled + 1
            changed.update(self._handle_terms())
        problem.replace(changed)
        return bool(changed)

    def _barely_folded(self) -> bool:
        """Whether some point is not folded, or so little that polishing could undo it, and more can be done."""
        if not self._can_stiffen():
            return False
        term = self._fold_condition()
        first, second = term.tilts(gather(np.ascontiguousarray(self._state.x.T), term.stencil))
        safe = np.abs(first + second) <= _MARGIN * np.abs(first - second)
        return not (safe.all() and measure(self.net, self.positions).folded.all())

    def _can_stiffen(self) -> bool:
        """Whether there is a fold condition that may still be made stiffer; not when a fold goes back to flat."""
        asked = self.weights.fold_condition > 0 and len(self.net.crease_points.carrier) > 0
        bent = float(np.ptp(self._state.x[:, 2])) > _FLAT and self._angle != 0.0
        return asked and bent and self._stiffened < _STIFFENINGS

    def _stiffer_condition(self) -> FoldCondition:
        self._condition, self._stiffened = self._condition * _STIFFER, self._stiffened + 1
        return self._fold_condition()

    def _handles_lag(self) -> bool:
        """Whether handles stay off their targets though the paper is far from stretched: bending holds them."""
        if not len(self._handles) or self._pulled >= _STIFFENINGS:
            return False
        return (
            bool(self._handle_gaps().max() > _CLOSE) and mean_stretch(self.net, self._state.x) <= 0.5 * MEAN_BUDGET
        )

    def _handle_terms(self) -> dict[str, ResidualTerm | LinearTerm]:
        vertices, weights = self._points
        stiffness = self.weights.handles * self._pull * self._strengths
        whole = self._axes.all(axis=1)
        part = ~whole
        terms: list[ResidualTerm | LinearTerm] = []
        if whole.any():
            terms.append(handles(vertices[whole], weights[whole], self._paths[whole], stiffness[whole]))
        if part.any():
            axes = self.net.frame.axes()[:, None, :] * self._axes[part].T[:, :, None]
            terms.append(AxisHandles(vertices[part], weights[part], self._paths[part], axes, stiffness[part]))
        return {term.name: term for term in terms}

    def _handle_gaps(self) -> FloatArray:
        """(H,) distances of the handles from their targets along the axes they pull along, net units."""
        gaps = (self._handle_places() - self._targets) @ self.net.frame.axes().T
        return np.asarray(np.linalg.norm(gaps * self._axes, axis=1))

    def _fold_condition(self) -> FoldCondition:
        return fold_condition(self.net, self.weights.fold_condition * self._condition)

    def _polish(self, problem: Problem) -> None:
        """Put the DOG angles right in a shape that has come to rest: tight constraints earlier only crawl."""
        x, exact = projection_step(problem, self._state.x, EPS_POLISHING)
        stuck = np.array_equal(x, self._state.x)
        self._state = at_rest(x)
        self._polished += 1
        if not (exact < _EXACT or stuck or self._polished >= _MAX_POLISH):
            return
        if self._can_stiffen() and not measure(self.net, self.positions).folded.all():
            # Polishing undid a faint fold: back to settling with a stiffer condition.
            problem.replace({"fold condition": self._stiffer_condition()})
            self._still, self._polished = False, 0
        else:
            self.status = Status.SETTLED


def _without_doubles(handles: Sequence[Handle], unit: float) -> list[int]:
    """Indices of handles without repeats. Raises HandleError where one point has two targets.

    unit: drawing units in one net unit; points nearer than _SAME_POINT of it are one.
    """
    kept: list[int] = []
    for k, handle in enumerate(handles):
        here = [j for j in kept if math.dist(handles[j].at, handle.at) <= _SAME_POINT * unit]
        for j in here:
            other = handles[j]
            shared = [a for a in range(3) if handle.axes[a] and other.axes[a]]
            if any(handle.target[a] != other.target[a] for a in shared):
                raise HandleError(
                    f"it lies on the same point as handle {j + 1} but has another target",
                    element=f"handle {k + 1}",
                    place=handle.at,
                )
        if not any(handles[j].axes == handle.axes for j in here):
            kept.append(k)
    return kept
