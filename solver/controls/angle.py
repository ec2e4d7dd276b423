"""Fold angles at chosen points of creases or along whole creases (paper, Lemma 5.1 and Eq. 12)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..drive import HALF_ANGLE, MEAN_BUDGET, mean_stretch
from ..errors import DescriptionError
from ..first_fold import FIRST_ANGLE
from ..measurement import measure
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.fold_angle import fold_angle_at
from ..objectives.signed_fold import signed_fold, signed_points
from .control import Control, ControlPull, CreaseName, crease_index, crease_name, flag, number, positive, vector
from .pull import Finding, Lack, Term

#: An asked angle turns at most this much an iteration, degrees (method, section 4: 70° in 225).
ANGLE_RATE = 0.4
#: A place may miss the nearest crease point by this much, net units.
_NEAR = 1.5
#: At rest the asked value is corrected by the measured error, which is of second order in the grid where the
#: term's own is of first: at most so often, at most so far, and only errors larger than this, degrees.
_CORRECTIONS, _MOST_CORRECTED, _CLOSE = 12, 30.0, 0.3
#: While the paper holds harder an angle may drift by this much, degrees, before it is corrected again.
_DRIFTED = 1.5
#: Angles that are missed although the paper is far from stretched pull harder, at most so often.
_STIFFER, _STIFFENINGS = 3.0, 4
#: Over the stretch budget all angles pull softer, at most so often.
_SOFTER, _SOFTENINGS = 0.4, 6
#: An angle is reached within this, degrees, or this part of itself.
_REACHED, _REACHED_PART = 3.0, 0.06


@dataclass(frozen=True)
class Angle(Control):
    """A fold angle along a crease, or at one point of a crease.

    degrees: 0 to 180, or with ``signed`` -180 to 180, a valley positive
    crease: number from 1, or name; None where ``at`` says which
    at: (x, y) on the flat sheet, drawing units; None for the whole crease
    strength: how hard it pulls, in parts of the usual weight
    """

    degrees: float
    crease: CreaseName | None = None
    at: tuple[float, float] | None = None
    signed: bool = False
    strength: float = 1.0

    kind = "angle"

    def __post_init__(self) -> None:
        flag("signed", self.signed)
        number("degrees", self.degrees, -180.0 if self.signed else 0.0, 180.0)
        positive("strength", self.strength)
        if self.crease is None and self.at is None:
            raise DescriptionError("an angle needs 'crease', 'at', or both")
        if self.crease is not None:
            crease_name(self.crease)
        if self.at is not None:
            object.__setattr__(self, "at", vector("at", self.at, 2))


class AnglePull(ControlPull):
    """All angle controls: one row for each crease point that is asked for an angle."""

    def __init__(self, net: PiecewiseDog, weight: float) -> None:
        self._net, self._weight = net, weight * HALF_ANGLE
        self._points = signed_points(net)
        n = len(self._points)
        self._asked = np.full(n, np.nan)  # degrees at each driven point, NaN where none is asked
        self._signed = np.zeros(n, dtype=bool)
        self._now = np.zeros(n)
        self._strength = np.zeros(n)
        self._alone = np.zeros(n, dtype=bool)  # asked for by a place, not along a whole crease
        self._correction, self._corrected = np.zeros(n), 0
        self._harder, self._stiffened, self._softened = 1.0, 0, 0

    def set(self, controls: Sequence[tuple[str, Any]], x: FloatArray) -> None:
        old, old_signed = self._asked, self._signed
        n = len(self._points)
        self._asked, self._signed = np.full(n, np.nan), np.zeros(n, dtype=bool)
        self._strength, self._alone = np.zeros(n), np.zeros(n, dtype=bool)
        # Places last: a point's own angle counts more than that of its crease.
        for label, control in sorted(controls, key=lambda entry: entry[1].at is not None):
            try:
                mine = asked_points(self._net, self._points, control)
            except DescriptionError as error:
                raise DescriptionError(error.message, element=label, place=error.where.place) from None
            again = self._alone[mine] if control.at is not None else np.isfinite(self._asked[mine])
            if (again & (self._asked[mine] != control.degrees)).any():
                raise DescriptionError("asks for another angle where an earlier one holds", element=label)
            self._asked[mine], self._signed[mine] = control.degrees, control.signed
            self._strength[mine], self._alone[mine] = control.strength, control.at is not None
        new = np.isfinite(self._asked) & ~(np.isfinite(old) & (old_signed == self._signed))
        self._now[new] = self._present(x)[new]

    def released(self) -> BoolArray:
        """Driven points (n,) that have an angle of their own."""
        return np.isfinite(self._asked)

    def terms(self) -> list[Term]:
        terms: list[Term] = []
        weight = self._weight * self._harder * self._strength
        for signed in (False, True):
            mine = np.flatnonzero(np.isfinite(self._asked) & (self._signed == signed))
            if len(mine) == 0:
                continue
            degrees = self._now[mine] + self._correction[mine]
            if signed:
                points = self._points[mine]
                degrees = np.clip(degrees, -179.0, 179.0)
                terms.append(signed_fold(self._net, points, degrees, 0, weight[mine], "signed angles"))
            else:
                term = fold_angle_at(self._net, mine, np.clip(degrees, 0.0, 180.0), weight[mine])
                terms.append(replace(term, name="angles"))
        return terms

    def asks(self, x: FloatArray) -> bool:
        return self._weight > 0 and bool((np.nan_to_num(self._asked) != 0).any())

    def sides(self) -> Mapping[int, int]:
        crease = self._net.crease_points.crease[self._points]
        signed = np.flatnonzero(self._signed & (np.nan_to_num(self._asked) != 0))
        return {int(crease[k]): int(np.sign(self._asked[k])) for k in signed}

    def begin(self, x: FloatArray) -> None:
        first = np.minimum(np.abs(np.nan_to_num(self._asked)), FIRST_ANGLE)
        self._now = np.where(self._signed, np.sign(np.nan_to_num(self._asked)), 1.0) * first

    def on_way(self) -> bool:
        return bool((np.isfinite(self._asked) & (self._asked != self._now)).any())

    def move(self, x: FloatArray, pace: float) -> bool:
        gap = np.where(np.isfinite(self._asked), self._asked - self._now, 0.0)
        if not gap.any():
            return False
        rate = ANGLE_RATE * pace
        self._now = np.where(np.abs(gap) <= rate + 1e-9, self._now + gap, self._now + np.clip(gap, -rate, rate))
        return True

    def settle(self, x: FloatArray) -> bool:
        """Give way when the paper is stretched; else correct the asked values, or pull harder."""
        error = self._errors(x)
        if np.abs(error).max(initial=0.0) <= _CLOSE:
            return False
        mean = mean_stretch(self._net, x)
        if mean > MEAN_BUDGET:
            self._softened += 1
            self._harder *= _SOFTER
            return self._softened <= _SOFTENINGS
        if self._softened:
            return False
        changed = False
        if self._corrected < _CORRECTIONS:
            self._correct(error)
            self._corrected += 1
            changed = True
        if np.abs(error).max() > _REACHED and mean <= 0.5 * MEAN_BUDGET and self._stiffened < _STIFFENINGS:
            self._harder *= _STIFFER
            self._stiffened += 1
            changed = True
        return changed

    def share(self, x: FloatArray) -> bool:
        error = self._errors(x)
        if self._softened or np.abs(error).max(initial=0.0) <= _DRIFTED:
            return False
        self._correct(error)
        return True

    def shortfall(self, x: FloatArray) -> float:
        return max(float(np.abs(self._errors(x)).max(initial=0.0)) - _DRIFTED, 0.0) / _REACHED

    def wake(self) -> None:
        self._corrected = self._stiffened = self._softened = 0
        self._harder = 1.0

    def mark(self) -> object:
        return self._now

    def go_back(self, mark: object) -> None:
        if isinstance(mark, np.ndarray):
            self._now = mark

    def findings(self, x: FloatArray) -> list[Finding]:
        error = np.abs(self._errors(x))
        missed = np.flatnonzero(error > np.maximum(_REACHED, _REACHED_PART * np.abs(np.nan_to_num(self._asked))))
        crease = self._net.crease_points.crease[self._points]
        present = self._measured(x)
        result = []
        for k in np.unique(crease[missed]):
            mine = missed[crease[missed] == k]
            alone = self._alone[mine].any()
            # Along a whole crease a few points by its ends may differ; half of them may not.
            if not alone and 2 * len(mine) <= int((np.isfinite(self._asked) & (crease == k)).sum()):
                continue
            worst = int(mine[np.argmax(error[mine])])
            where = self._net.frame.to_drawing(self._net.crease_points.position[self._points[worst]][None])[0]
            result.append(
                Finding(
                    Lack.ANGLE,
                    f"{self._net.crease_labels[k]} came to {present[worst]:.0f}° at ({where[0]:.4g}, "
                    f"{where[1]:.4g}) where {self._asked[worst]:g}° were asked",
                    int(k),
                )
            )
        return result

    def _measured(self, x: FloatArray) -> FloatArray:
        """(n,) degrees at the driven points, signed where a signed angle is asked; NaN where none has a meaning."""
        m = measure(self._net, self._net.frame.to_drawing(x))
        angle = m.fold_angle[self._points]
        return np.where(self._signed, angle * m.fold_sign[self._points], angle)

    def _present(self, x: FloatArray) -> FloatArray:
        return np.nan_to_num(self._measured(x))

    def _correct(self, error: FloatArray) -> None:
        """Ask for as much more as the measured angles miss, degrees."""
        self._correction = np.clip(self._correction + error, -_MOST_CORRECTED, _MOST_CORRECTED)

    def _errors(self, x: FloatArray) -> FloatArray:
        """(n,) asked minus measured, 0 where nothing is asked or can be measured."""
        return np.nan_to_num(self._asked - self._measured(x))


def asked_points(net: PiecewiseDog, points: IntArray, control: Angle) -> IntArray:
    """Which of the crease points (n,) a control is about, as indices into them.

    Raises DescriptionError when there is no such crease, or none near the place.
    """
    labels = net.crease_labels
    crease = net.crease_points.crease[points]
    of_crease = np.arange(len(points))
    if control.crease is not None:
        k = crease_index(labels, control.crease)
        of_crease = np.flatnonzero(crease == k)
        if len(of_crease) == 0:
            raise DescriptionError(f"{labels[k]} has no point where the net is fine enough to hold an angle")
    if control.at is None:
        return of_crease
    place = net.frame.to_net(np.array([control.at]))[0]
    distance = np.hypot(*(net.crease_points.position[points[of_crease]] - place).T)
    nearest = int(np.argmin(distance)) if len(distance) else -1
    if nearest < 0 or distance[nearest] > _NEAR:
        raise DescriptionError("there is no crease near this point", place=tuple(control.at))
    return of_crease[nearest : nearest + 1]
