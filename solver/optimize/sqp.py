"""One step of Gauss-Newton SQP on the penalty function f + |φ|²/(2 eps) (method, section 3).

(H + JᵀJ/eps + mu B + shift I) d = -∇f - Jᵀφ/eps, searched along d with Armijo decrease. Three things
differ from the textbook (docs/method.md has figures):
- no multipliers: near flat J loses rank and steps with them were short; eps is lowered in stages instead, and
  ``projection_step`` ends it;
- damping by the bending metric B, more when a step had to be shortened and less when it was full (Levenberg
  and Marquardt): what limits a step is the change of curvature, whereas rigid turns of patches are harmless;
- momentum (Nesterov), because folding creeps along curved valleys: each step starts from the extrapolation of
  the last two shapes unless that is much worse.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, dot
from ..errors import NotPositiveDefiniteError
from .assembly import Evaluation, Linearization, Problem

#: Armijo's constant (Nocedal and Wright, Numerical Optimization, Eq. 3.4).
_ARMIJO = 1e-4
#: Halvings before a step is given up.
_MAX_BACKTRACKS = 20
#: Added to the diagonal, energy per length²: rigid motions and unused corners have no stiffness of their own.
_SHIFT = 1e-3
#: Damping, in parts of the bending metric: bounds, and factors after a shortened and after a full step.
_LEAST_DAMPING, _MOST_DAMPING, _RAISE, _LOWER = 1e-3, 1e3, 4.0, 0.5
#: Damping of a step along exact constraints, parts of the bending metric.
_TANGENT_DAMPING = 2.0
#: After it constraints hold to this, if they do after so many projections more with factorisations of their own.
_NEARLY_EXACT, _MOST_PROJECTIONS = 5e-5, 3
#: A projection takes up to so many steps with one factorisation, while each leaves no more than this part of |φ|²:
#: shapes hardly move, and solving costs a tenth of factorising (chord steps).
_CHORDS, _CHORD_FALL = 6, 0.5
#: Momentum: n / (n + 3) in the n-th step (Nesterov's rule), at most this.
_MOST_MOMENTUM = 0.95
#: An extrapolation is taken when its merit is at most so many times the last; else momentum drops to a third.
_WORSE = 1.5


@dataclass(frozen=True, eq=False)
class SqpState:
    """x (V,3) net units, the shape before it; damping, parts of the bending metric; steps with momentum.

    evaluation: of the terms at x as they were when it was reached; None for a start.
    """

    x: FloatArray
    previous: FloatArray
    damping: float = _LEAST_DAMPING
    momentum: int = 0
    evaluation: Evaluation | None = None


@dataclass(frozen=True, eq=False)
class StepReport:
    """What one step did. ``merit`` is f + |φ|²/(2 eps) at its end."""

    evaluation: Evaluation
    merit: float
    step_length: float
    backtracks: int
    largest_move: float
    seconds: dict[str, float]


def at_rest(x: FloatArray) -> SqpState:
    """A start without momentum at x (V,3)."""
    return SqpState(np.array(x), np.array(x))


def sqp_step(problem: Problem, state: SqpState, eps: float) -> tuple[SqpState, StepReport]:
    """One iteration.

    eps: softness of the constraints, 1/energy. Raises NotPositiveDefiniteError when the system breaks.
    """

    def merit(evaluation: Evaluation) -> float:
        return evaluation.objective + dot(evaluation.constraint, evaluation.constraint) / (2 * eps)

    clock = [time.perf_counter()]
    x, momentum = state.x, state.momentum
    velocity = x - state.previous
    moving = bool(velocity.any())
    if moving:
        momentum += 1
        x = x + min(_MOST_MOMENTUM, momentum / (momentum + 3)) * velocity
    model = problem.linearize(x, 1.0 / eps, _SHIFT, state.damping)
    if moving and not _near_enough(problem, state, merit, merit(model.evaluation)):
        # Too far ahead: back to the shape itself.
        x, momentum = state.x, momentum // 3
        model = problem.linearize(x, 1.0 / eps, _SHIFT, state.damping)
    gradient = model.gradient + problem.transposed(model.jacobians, model.evaluation.constraint / eps)
    clock.append(time.perf_counter())
    problem.factorize(model, -gradient)
    clock.append(time.perf_counter())
    step = problem.system.solution()
    if not np.isfinite(step).all():
        raise NotPositiveDefiniteError("the linear system gave a step that is not finite")
    clock.append(time.perf_counter())
    move = step.reshape(-1, 3)
    slope = dot(gradient, step)
    start = merit(model.evaluation)
    length, backtracks, accepted = 1.0, 0, model.evaluation
    while True:
        trial = problem.evaluate(x + length * move)
        if merit(trial) <= start + _ARMIJO * length * slope + 1e-12 * abs(start):
            accepted = trial
            break
        if backtracks == _MAX_BACKTRACKS:
            length = 0.0
            break
        length, backtracks = 0.5 * length, backtracks + 1
    if dot(gradient, velocity.ravel()) > 0.0:
        # The last move went uphill: momentum starts anew (O'Donoghue and Candès 2015, gradient scheme).
        momentum = 0
    damping = state.damping * (_RAISE if length < 1.0 else _LOWER)
    damping = min(max(damping, _LEAST_DAMPING), _MOST_DAMPING)
    after = x + length * move
    clock.append(time.perf_counter())
    spent = np.diff(clock)
    return SqpState(after, state.x, damping, momentum, accepted), StepReport(
        accepted,
        merit(accepted),
        length,
        backtracks,
        float(np.abs(after - state.x).max(initial=0.0)),
        dict(zip(("assembly", "factor", "solve", "line search"), spent.tolist(), strict=True)),
    )


def _near_enough(problem: Problem, state: SqpState, merit: Callable[[Evaluation], float], ahead: float) -> bool:
    """Whether an extrapolation of merit ``ahead`` is not much worse than the shape it starts from."""
    if state.evaluation is not None and ahead <= _WORSE * merit(state.evaluation):
        return True
    # The targets may have moved since: only now is a new evaluation worth its time.
    return ahead <= _WORSE * merit(problem.evaluate(state.x))


def tangent_step(problem: Problem, x: FloatArray, eps: float) -> FloatArray:
    """Move x (V,3), where the constraints hold, along them towards less objective energy, and back onto them.

    One Gauss-Newton step with the constraints of softness ``eps``, damped so much that soft bends, along which
    folds creep, hardly take part: it redistributes what stiff terms hold. Not searched along: the caller judges
    what comes of it. Raises NotPositiveDefiniteError when the system breaks.
    """
    model = problem.linearize(x, 1.0 / eps, _SHIFT, _TANGENT_DAMPING)
    gradient = model.gradient + problem.transposed(model.jacobians, model.evaluation.constraint / eps)
    problem.factorize(model, -gradient)
    step = problem.system.solution().reshape(-1, 3)
    if not np.isfinite(step).all():
        raise NotPositiveDefiniteError("the linear system gave a step that is not finite")
    x = x + step
    x, exact = _project(problem, model, x, problem.evaluate(x).constraint, eps, _NEARLY_EXACT)
    for _ in range(_MOST_PROJECTIONS):
        if exact < _NEARLY_EXACT:
            break
        x, exact = projection_step(problem, x, eps, _NEARLY_EXACT)
    return x


def projection_step(problem: Problem, x: FloatArray, eps: float, enough: float) -> tuple[FloatArray, float]:
    """Move x (V,3) towards exact constraints by the least objective energy; returns x and max |φ| there.

    Gauss-Newton steps on |φ|² in the metric of the objective's Hessian: they change the shape as little as the
    stiff terms allow. All use one factorisation, as long as each helps much and |φ| is more than ``enough``. The
    same x comes back when nothing helps.
    """
    model = problem.linearize(x, 1.0 / eps, _SHIFT)
    problem.factorize(model)
    return _project(problem, model, x, model.evaluation.constraint, eps, enough)


def _project(
    problem: Problem, model: Linearization, x: FloatArray, constraint: FloatArray, eps: float, enough: float
) -> tuple[FloatArray, float]:
    """Steps of a projection from x (V,3), where φ is ``constraint``, with a model factorised there or near by."""

    def step(missing: FloatArray) -> FloatArray:
        return problem.system.solve(-problem.transposed(model.jacobians, missing / eps)).reshape(-1, 3)

    for _ in range(_CHORDS):
        start = dot(constraint, constraint)
        if start == 0.0:
            break
        move, length = step(constraint), 1.0
        for _ in range(_MAX_BACKTRACKS):
            trial = x + length * move
            c = problem.evaluate(trial).constraint
            if dot(c, c) >= start:
                # Second-order correction: what φ has more than its linear model would leave is solved for as well.
                trial = trial + step(c - (1.0 - length) * constraint)
                c = problem.evaluate(trial).constraint
            if dot(c, c) < start:
                break
            length *= 0.5
        else:
            break
        x, constraint = trial, c
        if dot(c, c) > _CHORD_FALL * start or np.abs(c).max(initial=0.0) < enough:
            break
    return x, float(np.abs(constraint).max(initial=0.0))
