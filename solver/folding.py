"""Folding a net: told what pulls at it, advanced iteration by iteration, always in a state to be shown."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from .arrays import FloatArray, IntArray, frozen_array
from .constraints.orthogonal_geodesic import LinkAngles, StarAngles
from .controls.agreement import check_agreement, held_creases, with_reasons
from .controls.condition_pull import ConditionPull
from .controls.control import Control, ControlPull
from .controls.curve import Curve, CurvePull
from .controls.handle_pull import REACHED as REACHED
from .controls.handle_pull import HandlePull
from .controls.homotopy import Homotopy
from .controls.least_fold import LeastFold
from .controls.paper_pull import PaperPull
from .controls.pull import Finding, Pull
from .controls.registry import KINDS, control_label
from .controls.side import Side, found_letters
from .description import LEAST_FOLD, Handle, Weights
from .drive import MAX_MEAN_STRETCH, AngleDrive, mean_stretch
from .errors import DescriptionError, NotPositiveDefiniteError
from .finishing import Finishing, Next
from .first_fold import FIRST_ANGLE, choose_sides, first_bend, first_fold
from .laid_flat import FLAT, laid_flat, off_plane
from .net.piecewise_dog import PiecewiseDog
from .objectives.bending import bending
from .optimize.assembly import Problem
from .optimize.sqp import StepReport, at_rest, sqp_step
from .optimize.term import ResidualTerm

#: Softness of the constraints, 1/energy: until the shape is still, and in the end; between them it falls by this
#: factor an iteration.
EPS_FIRST, EPS_LAST, _EPS_FALL = 1e-2, 1e-5, 0.5
#: Still: over this many iterations the merit falls by less than this part of itself (or by _NOTHING); over more of
#: them where a handle is off its target: in the corpus, what looked still after five had often yet to arrive.
_STILL_OVER, _STILL_IF_MISSED, _STILL_PART, _NOTHING = 5, 10, 1e-3, 1e-7
#: A stage ends after so many iterations even if it is not still: the rest is creep (method, section 3).
_STAGE_MOST = 60
#: The offset lifts no vertex by more than this, net units.
_FIRST_LIFT = 0.5
#: A sheet that nothing asks to be bent lies down from here, and from there half of the way at a time, at most so
#: often; parts of its longer side.
_NEARLY_FLAT, _FAR_FROM_FLAT, _MOST_STEPS_DOWN = 0.05, 0.6, 8
#: Folded anew, all creases are first folded to the first of these angles, degrees: of 45, 60 and 75 the best for
#: what was stuck. What is stuck even then may get free from much deeper folds.
OPENING_ANGLES = (60.0, 120.0)


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
    step_lengths, backtracks (one an iteration); seconds by part, and in all
    """

    status: Status
    iterations: int
    objective: dict[str, float]
    constraint: float
    handle_error: float
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
        self._paper = PaperPull(net, self.weights.isometry, self.weights.continuity)
        self._handles = HandlePull(net, self.weights.handles)
        self._condition = ConditionPull(net, self.weights.fold_condition)
        self._drive = AngleDrive(net, self.weights.drive)
        self._least = LeastFold(net, self.weights.least_fold)
        self._least.set(LEAST_FOLD)
        self._problem: Problem | None = None
        self._told_anew = True  # whether the problem may not hold the pulls' present terms
        self._shape: dict[str, IntArray] = {}  # stencils of the pulls' terms in the problem
        self._merits: list[float] = []
        self._eps, self._still, self._steps_down = EPS_FIRST, False, 0
        self._finishing = Finishing(net)
        self._opening: AngleDrive | None = None  # at work while a sheet that is folded anew opens
        self._way = Homotopy()
        self._controls: tuple[Control, ...] = ()
        self._bound: tuple[Side, ...] = ()
        self._at_work: dict[str, tuple[tuple[tuple[str, Control], ...], ControlPull]] = {}  # by kind
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
        return int(np.argmax(self._handles.gaps(self._state.x)))

    def set_assignments(self, letters: Sequence[str]) -> None:
        """FOLD letters, one a crease: M and V hold a crease to that side, others leave it free.

        A crease that is folded to the other side is flipped. Where the paper cannot have all the sides, it
        gives way and ``findings`` says where.
        """
        self._bound = tuple(Side(k + 1, letter) for k, letter in enumerate(letters) if letter in "MV")
        self.set_controls(self._controls)

    @property
    def found_assignments(self) -> tuple[str, ...]:
        """FOLD letter of what each crease is now; given to ``set_assignments`` it locks what was found."""
        return found_letters(self.net, self._state.x)

    def set_controls(self, controls: Sequence[Control]) -> None:
        """Replace all controls; those that stay keep their way. A crease's own Side goes before its assignment.

        Raises DescriptionError naming the control that does not fit the net, and leaves all as it was.
        """
        told = [(control_label(k, control.kind), control) for k, control in enumerate(controls)]
        sides = {control.crease for control in controls if isinstance(control, Side)}
        told += [(self.net.crease_labels[int(side.crease) - 1], side) for side in self._bound
                 if side.crease not in sides]  # fmt: skip
        changed: list[str] = []
        try:
            check_agreement(told, self.net)
            for kind in KINDS:
                name = kind.control.kind
                mine = tuple(entry for entry in told if entry[1].kind == name)
                before, pull = self._at_work.get(name, ((), None))
                if mine == before:
                    continue
                if pull is None:
                    pull = kind.pull(self.net, self.weights, self._drive)
                    self._at_work[name] = (), pull
                changed.append(name)
                pull.set(mine, self._state.x)
        except DescriptionError:
            for name in changed:
                before, pull = self._at_work[name]
                pull.set(before, self._state.x)
            raise
        for name in changed:
            mine = tuple(entry for entry in told if entry[1].kind == name)
            self._at_work[name] = mine, self._at_work[name][1]
        self._controls = tuple(controls)
        self._drive.leave_out(held_creases(self._controls, self.net))
        self._wake()

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What the controls ask for and the present shape lacks."""
        found = [finding for pull in self._pulls() for finding in pull.findings(self._state.x)]
        return with_reasons(found, self._controls, len(self._handles) > 0, self.net)

    @property
    def flow_progress(self) -> dict[int, float]:
        """The part of its way, 0 to 1, that each crease (from 0) with a curve has gone by now."""
        pull = self._at_work.get(Curve.kind, ((), None))[1]
        return pull.progress() if isinstance(pull, CurvePull) else {}

    def set_handles(self, handles: Sequence[Handle]) -> None:
        """Replace all handles. Handles that stay at the same point keep their way.

        Raises HandleError: a handle off the sheet, or two at one point with different targets.
        """
        self._handles.set(handles, self._state.x)
        self._wake()

    def set_fold_angle(self, degrees: float | None) -> None:
        """Drive all creases towards an unsigned fold angle, 0 to 180 degrees; None switches the drive off."""
        if degrees is not None and not 0 <= degrees <= 180:
            raise ValueError("the fold angle must lie between 0 and 180 degrees")
        self._drive.set(None if degrees is None else float(degrees))
        self._least.unfolding = degrees == 0
        self._wake()

    def set_least_fold(self, degrees: float) -> None:
        """Fold every crease point at least so far, 0 to 180 degrees, where handles alone bend the paper; 0: off."""
        if not 0 <= degrees <= 180:
            raise ValueError("the least fold must lie between 0 and 180 degrees")
        self._least.set(float(degrees))
        self._wake()

    def fold_anew(self, opening: float = OPENING_ANGLES[0]) -> None:
        """Start from the flat sheet once more and go another way: all creases fold before anything pulls. Until the
        handles are told anew no more than faint folds are asked for.

        opening: to which angle, degrees. Which of several folds a paper takes is decided by its way, and the way of
        the handles may end stuck.
        """
        flat = np.column_stack([self.net.flat, np.zeros(len(self.net.flat))])
        self._state = at_rest(flat)
        self._least.start_anew()
        self._opening = AngleDrive(self.net, self.weights.drive)
        self._opening.set(opening)
        self._wake()

    def again(self, positions: ArrayLike) -> FoldModel:
        """A new model at positions (V,3), drawing units, told nothing yet but the sides.

        It takes this one's prepared problem with it, which saves most of the time of a first iteration.
        """
        model = FoldModel(self.net, positions, self.weights)
        model._bound = self._bound
        model.set_controls(())
        model._problem, model._shape, self._problem = self._problem, self._shape, None
        return model

    def advance(self, iterations: int = 5) -> SqpReport:
        """Take up to ``iterations`` SQP steps; fewer when the model has settled."""
        begin = time.perf_counter()
        steps: list[StepReport] = []
        problem = self._prepared()
        done = 0
        for _ in range(iterations):
            if self.status is not Status.RUNNING:
                break
            if self._told_anew:
                problem = self._prepared()
            try:
                if self._still:
                    self._finish(problem)
                else:
                    self._keep_up(problem)
                    moving = self._move_targets(problem)
                    self._state, step = sqp_step(problem, self._state, self._eps)
                    steps.append(step)
                    self._watch(problem, step, moving)
            except NotPositiveDefiniteError:
                exact = self._finishing.exact
                if exact is not None:
                    self._state, self.status = at_rest(exact), Status.SETTLED
                elif self._way.given_up or not self._step_back(problem):
                    self.status = Status.NOT_FINITE
                    break
            done += 1
        spent: dict[str, float] = {}
        for step in steps:
            for name, seconds in step.seconds.items():
                spent[name] = spent.get(name, 0.0) + seconds
        spent["total"] = time.perf_counter() - begin
        # The last step has evaluated the shape already, unless something has moved it since.
        known = bool(steps) and self._state.evaluation is steps[-1].evaluation
        evaluation = steps[-1].evaluation if known else problem.evaluate(self._state.x)
        return SqpReport(
            self.status,
            done,
            problem.objective_by_term(evaluation),
            float(np.abs(evaluation.constraint).max(initial=0.0)),
            float(self._handles.gaps(self._state.x).max(initial=0.0)) * self.net.frame.unit,
            tuple(step.step_length for step in steps),
            tuple(step.backtracks for step in steps),
            spent,
        )

    # --- inside ----------------------------------------------------------------------------------------

    def _pulls(self) -> list[Pull]:
        """Everything that pulls, in a fixed order."""
        if self._opening is not None:
            sides = [pull for kind, (_, pull) in self._at_work.items() if kind == Side.kind]
            return [self._paper, self._condition, self._opening, self._least, *sides]
        at_work = (pull for _, pull in self._at_work.values())
        return [self._paper, self._handles, self._condition, self._drive, self._least, *at_work]

    def _wake(self) -> None:
        self.status = Status.RUNNING
        self._settle_anew()
        self._steps_down = 0
        self._way.start_anew()
        self._least.bend(self._off_flat())
        for pull in self._pulls():
            pull.wake()
        self._told_anew = True

    def _settle_anew(self) -> None:
        """Whatever was known of the shape's coming to rest holds no longer."""
        self._merits, self._eps, self._still = [], EPS_FIRST, False
        self._finishing = Finishing(self.net)

    def _prepared(self) -> Problem:
        if self._problem is None or self._told_anew:
            self._problem, self._told_anew = self._updated(self._problem), False
        if off_plane(self._state.x) < FLAT and any(pull.asks(self._state.x) for pull in self._pulls()):
            self._state = at_rest(self._first_folded(self._state.x))
            for pull in self._pulls():
                pull.begin(self._state.x)
                self._replace(self._problem, pull)
        return self._problem

    def _updated(self, old: Problem | None) -> Problem:
        """The old problem with the present values where its structure still holds, or a new one."""
        net, weights = self.net, self.weights
        pulls = [term for pull in self._pulls() for term in pull.terms() if len(term.stencil)]
        shape = {term.name: term.stencil for term in pulls}
        if old is not None and _same_structure(shape, self._shape):
            old.replace({term.name: term for term in pulls})
            return old
        self._shape = shape
        constraints: list[ResidualTerm] = [StarAngles(net.stars), LinkAngles(net.links)]
        return Problem([*bending(net, weights.bending), *pulls], constraints, net.flat, bending(net, 1.0))

    def _first_folded(self, flat: FloatArray) -> FloatArray:
        """A flat sheet lifted a little, so that it has a side to fold to everywhere."""
        quad = flat[self.net.quads[0]]
        normal = np.cross(quad[2] - quad[0], quad[3] - quad[1])
        normal /= np.linalg.norm(normal)
        if len(self.net.chain_crease):
            sides = {crease: side for pull in self._pulls() for crease, side in pull.sides().items()}
            offset = first_fold(self.net, choose_sides(self.net, sides))
        else:
            at, targets = self._handles.anchors()
            gaps = np.linalg.norm(targets[:, None] - targets[None], axis=2)
            offset = first_bend(self.net, at, (targets - flat.mean(axis=0)) @ normal, gaps)
        # Many folds in a row would lift the far end of the sheet out of the range of the linear offset.
        largest = max(float(np.abs(offset).max()), 1e-300)
        lift = offset * min(float(np.radians(FIRST_ANGLE)), _FIRST_LIFT / largest)
        return np.asarray(flat + lift[:, None] * normal)

    @staticmethod
    def _replace(problem: Problem, pull: Pull) -> None:
        problem.replace({term.name: term for term in pull.terms()})

    def _keep_up(self, problem: Problem) -> None:
        """Tell what follows the shape where it is."""
        if self._least.keep_up(self._state.x):
            self._replace(problem, self._least)

    def _controlled(self) -> bool:
        """Whether the paper is told more than handles and an angle for all creases; a side is more."""
        return any(controls for controls, _ in self._at_work.values())

    def _off_flat(self) -> float:
        """By how much the flat sheet misses the handles, net units, where nothing but handles bends the paper."""
        if not len(self._handles) or self._opening or self._drive.angle is not None or self._controlled():
            return 0.0
        flat = np.column_stack([self.net.flat, np.zeros(len(self.net.flat))])
        lying = laid_flat(self.net.flat, flat, *self._handles.anchors())
        return float(self._handles.gaps(lying).max())

    def _move_targets(self, problem: Problem) -> bool:
        """Bring the targets of this iteration a step nearer; whether they are still on their way."""
        pulls = self._pulls()
        turning = frozenset().union(*(pull.turning(self._state.x) for pull in pulls))
        for pull in pulls:
            if pull.make_way(turning, self._state.x):
                self._replace(problem, pull)
        if not any(pull.on_way() for pull in pulls):
            self._release(problem)
            return False
        if not self._way.may_move(mean_stretch(self.net, self._state.x), self._state, pulls):
            if self._way.lost:
                self._step_back(problem)
            return not self._way.given_up
        moving = False
        for pull in pulls:
            if pull.move(self._state.x, self._way.pace):
                self._replace(problem, pull)
                moving = True
        self._release(problem)
        return moving

    def _step_back(self, problem: Problem) -> bool:
        """Back to the last good place on the way; whether there is one."""
        state = self._way.step_back(self._pulls())
        if state is None:
            return False
        self._state = at_rest(state.x)
        self._settle_anew()
        for pull in self._pulls():
            self._replace(problem, pull)
        return True

    def _release(self, problem: Problem) -> None:
        """Let the drive and the least fold know which points something else turns."""
        pulls = self._pulls()
        masks = [mask for pull in pulls if (mask := pull.released()) is not None]
        if not masks:
            return
        turned = np.logical_or.reduce(masks)
        # A crease that is told its side is pulled off flat by that.
        told = np.isin(self._least.creases, [crease for pull in pulls for crease in pull.sides()])
        for changed, pull in (
            (self._drive.release(turned), self._drive), (self._least.release(turned | told), self._least)
        ):  # fmt: skip
            if changed:
                self._replace(problem, pull)

    def _watch(self, problem: Problem, step: StepReport, moving: bool) -> None:
        """Notice when a stage is over: targets at rest and the merit no longer falling."""
        if moving:
            self._merits = []
            return
        if EPS_LAST < self._eps < EPS_FIRST:
            self._eps = max(EPS_LAST, _EPS_FALL * self._eps)
            return
        self._merits.append(step.merit)
        missed = self._handles.gaps(self._state.x).max(initial=0.0) > 0.5 * REACHED
        window = _STILL_IF_MISSED if missed else _STILL_OVER
        recent = self._merits[-window:]
        fall = recent[0] - recent[-1]
        still = len(recent) == window and fall < max(_STILL_PART * recent[-1], _NOTHING)
        if not still and len(self._merits) < _STAGE_MOST:
            return
        self._merits = []
        if self._aimed(problem):
            return
        if self._eps == EPS_FIRST:
            self._eps *= _EPS_FALL
        elif self._opening is not None:
            self._opened()
        elif not self._lies_down():
            self._still = not self._amended(problem)

    def _aimed(self, problem: Problem) -> bool:
        """At rest: whether something that aims at a measured value asks otherwise now."""
        changed = [pull for pull in self._pulls() if pull.aim(self._state.x)]
        for pull in changed:
            self._replace(problem, pull)
        return bool(changed)

    def _opened(self) -> None:
        """All creases are folded: from here on everything pulls, from where the paper is now."""
        self._opening = None
        x, handles, angle = self._state.x, self._handles.handles, self._drive.angle
        self._least.unfolding = angle == 0
        self._handles.set((), x)
        self._handles.set(handles, x)
        self._drive.set(None)
        self._drive.set(angle)
        for controls, pull in self._at_work.values():
            pull.set((), x)
            pull.set(controls, x)
        self._wake()
        self._least.give_way()

    def _lies_down(self) -> bool:
        """Bring a sheet back to flat that its handles ask to be nothing else; whether that was done.

        Flat is its least energy then, but the energy is of fourth order there and steps only creep towards it;
        a flap behind a crease near the border costs next to nothing.
        """
        if not len(self._handles) or self._at_work or self._steps_down >= _MOST_STEPS_DOWN:
            return False
        x = self._state.x
        lying = laid_flat(self.net.flat, x, *self._handles.anchors())
        off = np.abs(lying - x).max() / np.ptp(self.net.flat, axis=0).max()
        if off > _FAR_FROM_FLAT or any(pull.asks(lying) for pull in self._pulls()):
            return False
        if off < _NEARLY_FLAT:
            self._state, self.status = at_rest(lying), Status.SETTLED
        else:
            self._state, self._eps = at_rest(0.5 * (x + lying)), EPS_FIRST
            self._steps_down += 1
        return True

    def _amended(self, problem: Problem) -> bool:
        """At rest: whether some pull gives way or pulls harder now, the paper only when all others do not."""
        x = self._state.x
        changed: list[Pull] = [pull for pull in self._pulls() if pull is not self._paper and pull.settle(x)]
        if not changed and self._wanting(x):
            if self._least.give_way():
                changed.append(self._least)
            elif self._paper.settle(x):
                changed.append(self._paper)
        for pull in changed:
            self._replace(problem, pull)
        return bool(changed)

    def _wanting(self, x: FloatArray) -> bool:
        """Whether a handle is off its target, or the paper stretched more than it may show, with handles alone.

        What else is asked (a side, a kept patch) a paper that holds harder gives up for the handles.
        """
        if self._controlled():
            return False
        missed = bool(self._handles.gaps(x).max(initial=0.0) > REACHED)
        return missed or mean_stretch(self.net, x) > MAX_MEAN_STRETCH

    def _finish(self, problem: Problem) -> None:
        """One iteration in a shape that has come to rest."""
        step = self._finishing.step(problem, self._state.x, self._pulls())
        self._state = at_rest(step.x)
        for pull in step.changed:
            self._replace(problem, pull)
        if step.next is Next.SETTLING:
            self._still = False
        elif step.next is Next.DONE:
            self.status = Status.SETTLED


def _same_structure(new: dict[str, IntArray], old: dict[str, IntArray]) -> bool:
    return new.keys() == old.keys() and all(np.array_equal(new[name], old[name]) for name in new)
