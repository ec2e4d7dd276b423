"""From a shape that has come to rest to the one a fold is finished in: exact, calm, and lacking nothing for it.

Its constraints are made exact first; what that undoes goes back to settling. Then peaks are shared out along the
constraints, round by round, and the best of all shapes is made exact and kept (method, section 3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from .arrays import FloatArray
from .controls.pull import Pull
from .drive import MAX_MEAN_STRETCH, SHAREABLE_STRETCH, mean_stretch
from .laid_flat import FLAT, off_plane
from .net.piecewise_dog import PiecewiseDog
from .optimize.assembly import Problem
from .optimize.sqp import projection_step, tangent_step
from .resting import RestingShape, RestMerit, best
from .verify import verify

#: While a shape is made exact its constraints are so many times as soft, 1/energy, as the largest residual is,
#: within bounds: quadratic convergence also where they lose rank, while the residual grows with the distance to
#: the exact shapes (Fan and Yuan 2005, On the Quadratic Convergence of the Levenberg-Marquardt Method without
#: Nonsingularity Assumption). Of 0.03 to 1, small ones take fewer steps, large ones round less: a step is rounded
#: by 1e-16 / softness. Stiffer than the second systems lose their digits.
_SOFTNESS, _STIFFEST, _SOFTEST = 0.05, 1e-8, 1e-4
#: Softness while peaks are shared out, 1/energy.
_EPS_SHARING = 1e-6
#: Exact: the DOG angles (radians, on edges of length 1) hold to the first, or to the second while an iteration
#: leaves more than the third of them, or so many iterations were taken.
_EXACT, _EXACT_ENOUGH, _CREEPS, _MAX_POLISH = 1e-9, 1e-8, 0.5, 40
#: What comes to rest no more exact than this, and not flat, is nudged by so much, net units: a thousand times what
#: rounding leaves there.
_NOT_EXACT, _NUDGE = 1e-6, 1e-7
#: Rounds in which peaks are shared out, at most, and after how many that brought no better shape they end.
_MOST_SHARINGS, _NO_BETTER = 16, 5
#: A shape lacks as much as the first one up to this part more, and this much: grid edges, parts of angles.
_AS_SHORT, _A_LITTLE = 1.03, 0.03
#: In the end nothing stretches the paper: what pulls lets go until the mean stretch is this part of what paper may
#: show, to no less than the second part of its strength at once, and at most so often.
_CALM, _LEAST_HELD, _LETTINGS = 0.97, 0.25, 16


class Next(Enum):
    """What comes after a step: another one, settling once more, or nothing."""

    FINISHING = "finishing"
    SETTLING = "settling"
    DONE = "done"


@dataclass(frozen=True, eq=False)
class FinishingStep:
    """x (V,3), net units, to be shown; the pulls whose values the problem has yet to be given; what comes next."""

    x: FloatArray
    changed: Sequence[Pull]
    next: Next


class Finishing:
    """The end of one fold of one net; a fold that is told anew needs another one."""

    def __init__(self, net: PiecewiseDog) -> None:
        self._net = net
        self._rests: list[RestingShape] = []
        self._lacking, self._trial = 0.0, np.zeros((0, 3))
        self._sharings, self._lettings = 0, 0
        self._residual: float | None = None  # the largest one while a shape is made exact
        self._polishings = 0

    @property
    def exact(self) -> FloatArray | None:
        """(V,3) the best exact shape so far, net units; None before there is one."""
        shapes = [shape for shape in self._rests if shape.exact]
        return best(shapes).x if shapes else None

    def step(self, problem: Problem, x: FloatArray, pulls: Sequence[Pull]) -> FinishingStep:
        """One iteration from x (V,3), where ``problem`` has come to rest; while peaks are shared out, from the last
        shape that was tried.

        Raises NotPositiveDefiniteError when the system breaks; ``exact`` is good then as well.
        """
        if self._rests and self._sharings < _MOST_SHARINGS:
            return self._share(problem, pulls)
        x, polished = self._polish(problem, x)
        if not polished:
            return FinishingStep(x, (), Next.FINISHING)
        self._residual, self._polishings = None, 0
        if self._rests:
            return self._choose(x, pulls)
        # It may have undone a faint fold: back to settling, with what gave way held harder.
        undone = [pull for pull in pulls if pull.undone(x)] or self._let_go(x, pulls, SHAREABLE_STRETCH)
        if undone:
            return FinishingStep(x, undone, Next.SETTLING)
        self._sharings, self._trial, self._lacking = 0, x, _shortfall(pulls, x)
        self._rests = [RestingShape(self._merit(x, pulls), x, exact=True)]
        return FinishingStep(x, (), Next.FINISHING)

    def _polish(self, problem: Problem, x: FloatArray) -> tuple[FloatArray, bool]:
        """Make the constraints more exact; whether they are, as far as they get.

        They are put right only here: tight constraints earlier only crawl.
        """
        before = self._residual
        if before is None:
            before = float(np.abs(problem.evaluate(x).constraint).max(initial=0.0))
            if before > _NOT_EXACT and not self._rests and off_plane(x) > FLAT:
                x = x + _NUDGE * _uneven(x.shape)
        eps = min(max(_SOFTNESS * before, _STIFFEST), _SOFTEST)
        after, exact = projection_step(problem, x, eps, _EXACT)
        self._residual, self._polishings = exact, self._polishings + 1
        stuck = np.array_equal(after, x)
        creeps = _CREEPS * before < exact < _EXACT_ENOUGH
        return after, exact < _EXACT or stuck or creeps or self._polishings >= _MAX_POLISH

    def _share(self, problem: Problem, pulls: Sequence[Pull]) -> FinishingStep:
        """Hold harder where something gave way, and let the neighbours take it over; the best shape is shown."""
        changed = [pull for pull in pulls if pull.share(self._trial)]
        for pull in changed:
            problem.replace({term.name: term for term in pull.terms()})
        if changed:
            self._trial = tangent_step(problem, self._trial, _EPS_SHARING)
            self._rests.append(RestingShape(self._merit(self._trial, pulls), self._trial))
            self._sharings += 1
        chosen = best(self._rests)
        if not changed or (len(self._rests) > _NO_BETTER and chosen is best(self._rests[:-_NO_BETTER])):
            self._sharings = _MOST_SHARINGS
        if self._sharings == _MOST_SHARINGS and chosen.exact:
            return self._end(chosen.x, pulls)
        return FinishingStep(chosen.x, (), Next.FINISHING)

    def _choose(self, x: FloatArray, pulls: Sequence[Pull]) -> FinishingStep:
        """x is the best shape made exact, which may have made another one the best."""
        chosen = self._rests.index(best(self._rests))
        self._rests[chosen] = RestingShape(self._merit(x, pulls), x, exact=True)
        after = best(self._rests)
        return self._end(after.x, pulls) if after.exact else FinishingStep(after.x, (), Next.FINISHING)

    def _end(self, x: FloatArray, pulls: Sequence[Pull]) -> FinishingStep:
        """x is the best shape, and exact: the fold ends in it, unless the paper is stretched too far even so."""
        if not self._let_go(x, pulls, MAX_MEAN_STRETCH):
            return FinishingStep(x, (), Next.DONE)
        for pull in pulls:
            pull.unshare()
        self._rests = []
        return FinishingStep(x, pulls, Next.SETTLING)

    def _merit(self, x: FloatArray, pulls: Sequence[Pull]) -> RestMerit:
        faults = len(verify(self._net, self._net.frame.to_drawing(x)).faults)
        short = max(_shortfall(pulls, x) - _AS_SHORT * self._lacking - _A_LITTLE, 0.0)
        return RestMerit(faults, sum(pull.missed(x) for pull in pulls), short, sum(pull.peak(x) for pull in pulls))

    def _let_go(self, x: FloatArray, pulls: Sequence[Pull], bearable: float) -> list[Pull]:
        """Let everything in space pull softer when the paper is stretched for it by more than ``bearable``.

        What cannot be reached without stretching is out of reach.
        """
        mean = mean_stretch(self._net, x)
        if mean <= bearable or self._lettings >= _LETTINGS:
            return []
        self._lettings += 1
        # Where the paper is held taut, it is stretched about as much as it is pulled.
        part = max(_CALM * MAX_MEAN_STRETCH / mean, _LEAST_HELD)
        return [pull for pull in pulls if pull.let_go(part)]


def _shortfall(pulls: Sequence[Pull], x: FloatArray) -> float:
    return sum(pull.shortfall(x) for pull in pulls)


def _uneven(shape: tuple[int, ...]) -> FloatArray:
    """Numbers from -0.5 to 0.5 without any symmetry, the same everywhere: multiples of the golden ratio.

    A symmetric paper often cannot be exact as it is, and gives way to some side. Left to rounding, the choice would
    depend on the version of numpy.
    """
    return np.asarray((np.arange(np.prod(shape)) * ((np.sqrt(5.0) - 1.0) / 2.0) % 1.0 - 0.5).reshape(shape))
