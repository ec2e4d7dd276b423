"""A whole fold as a pure function: a drawing and a description in, a folded net with its certificate out."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import numpy as np
import shapely

from .arrays import FloatArray
from .controls.pair import Pair
from .controls.pull import Finding, Lack
from .description import FoldDescription, Handle
from .drive import MAX_MEAN_STRETCH
from .errors import CurvefoldError, DescriptionError, PatternError
from .folding import OPENING_ANGLES, REACHED, FoldModel, SqpReport, Status
from .gauss_image import gauss_area
from .laid_flat import off_plane
from .measurement import Measurement, measure
from .net.build import build_net
from .net.piecewise_dog import PiecewiseDog
from .pattern.crease_pattern import CreasePattern
from .verify import verify

#: Drawn sides that are held count as better when the median angle is so many times as large, at a mean stretch that
#: is at most so many times as large, or within what paper may show.
_DEEPER, _AS_WHOLE = 1.1, 1.2
#: What is said then.
_HELD = "folded with the sides of the drawing held, since left free the creases came less far"
#: SQP iterations between two calls of ``progress``.
_REPORT_EVERY = 10
#: A sheet thinner than this is flat, net units.
_FLAT = 1e-6
#: How many creases a terminal is told the sides of.
_MOST_SIDES = 12
#: The other side of one that a drawing gives.
_OPPOSITE = {"V": "M", "M": "V"}
#: Edges farther than this from every handle and joined point are away from them, net units.
_AWAY = 3.0

Progress = Callable[[int, SqpReport], None]


class Outcome(Enum):
    """How a fold ended. ``sentence`` is for the user, ``ok`` whether it did what it was asked."""

    FOLDED = "folded: every target is reached and every crease point is folded"
    BENT = "bent: every target is reached, and there is no crease to fold"
    FLAT = "the sheet lies flat: nothing asks it to fold"
    NOT_FOLDED = "a crease is not folded everywhere"
    AGAINST_ASSIGNMENT = "a crease folded against its assignment"
    SHALLOW = "folded, but not as deep as asked: the sheet allows no more"
    OUT_OF_REACH = "a target is out of reach"
    STRETCHED = "the paper is stretched more than paper can be"
    UNCERTIFIED = "the shape does not pass the independent check"
    UNSETTLED = "stopped before it settled"
    NOT_FINITE = "the numbers ran away; this is the last good shape"

    @property
    def sentence(self) -> str:
        return self.value

    @property
    def ok(self) -> bool:
        return self in (Outcome.FOLDED, Outcome.BENT)


#: What is said of a sheet without creases that lies flat.
_BLANK_AND_FLAT = f"{Outcome.FLAT.sentence}, and there is no crease on it"
#: How a fold that was stuck on its way may end: another way may lead to what was asked.
_WORTH_ANOTHER_WAY = (Outcome.OUT_OF_REACH, Outcome.NOT_FOLDED, Outcome.STRETCHED, Outcome.UNCERTIFIED)


@dataclass(frozen=True, eq=False)
class Rest:
    """How a model stands, mostly at rest. positions (V,3), drawing units; iterations: of all ways that it went."""

    positions: FloatArray
    measurement: Measurement
    status: Outcome
    detail: str
    iterations: int
    last: SqpReport
    findings: tuple[Finding, ...]


@dataclass(frozen=True, eq=False)
class FoldResult:
    """A folded net. positions (V,3), drawing units; ``detail`` says what ``status`` means here, and where.

    findings: what the controls ask for and the shape lacks
    """

    pattern: CreasePattern
    description: FoldDescription
    net: PiecewiseDog
    positions: FloatArray
    measurement: Measurement
    status: Outcome
    detail: str
    iterations: int
    seconds: float
    last: SqpReport
    findings: tuple[Finding, ...] = ()

    def summary(self) -> str:
        """A few lines for a terminal."""
        m = self.measurement
        lines = [
            self.detail,
            f"{len(self.net.rest)} vertices, {_count(len(self.net.patch_polygons), 'patch', 'patches')}, "
            f"{self.iterations} iterations, {self.seconds:.1f} s",
            *(_fold_lines(self.net, m) if len(m.crease) else []),
            *self._turned_over(),
            f"stretch mean {m.stretch.mean():.1e}, max {m.stretch.max():.1e}; "
            f"DOG residual max {self.last.constraint:.1e}",
        ]
        return "\n".join(lines)

    def report(self) -> dict[str, Any]:
        """The certificate as a JSON object: figures relative to mean grid edge 1, angles in degrees."""
        m = self.measurement
        return {
            "status": self.status.name.lower(),
            "ok": self.status.ok,
            "sentence": self.detail,
            "drawing": self.pattern.name,
            "description": self.description.to_json(),
            "resolution": self.net.resolution,
            "vertices": len(self.net.rest),
            "quads": len(self.net.quads),
            "patches": len(self.net.patch_polygons),
            "iterations": self.iterations,
            "seconds": round(self.seconds, 3),
            "stretch_mean": float(m.stretch.mean()),
            "stretch_max": float(m.stretch.max()),
            "stretch_away": self._stretch_away(),
            "gauss_area": gauss_area(self.net, self.positions),
            "continuity_mean": float(m.continuity.mean()) if len(m.continuity) else 0.0,
            "continuity_max": float(m.continuity.max(initial=0.0)),
            "dog_residual_max": self.last.constraint,
            "dog_angle_max": float(m.dog_angle.max(initial=0.0)),
            "handle_error": self.last.handle_error,
            "folded": m.folded_part,
            "fold_angle": [round(angle, 3) for angle in fold_angle_quantiles(m)],
            "verification": verify(self.net, self.positions).to_json(),
            "objective": self.last.objective,
            "creases": [_crease_report(self.pattern, m, k) for k in range(len(self.pattern.creases))],
            "findings": [finding.sentence for finding in self.findings],
            "notes": list(dict.fromkeys((*self.pattern.notes, *self.net.notes))),
        }

    def _turned_over(self) -> list[str]:
        """What is said of creases that folded to the other side than they are drawn, where the drawing is free."""
        if self.description.assignments == "bind":
            return []
        drawn = {k: crease.assignment for k, crease in enumerate(self.pattern.creases)}
        sided = [k for k, side in drawn.items() if side in _OPPOSITE and self.measurement.side(k) in _OPPOSITE]
        turned = [k for k in sided if self.measurement.side(k) == _OPPOSITE[drawn[k]]]
        if not turned:
            return []
        if len(turned) == len(sided) and len(sided) > 1:
            which = "all of them, as if the sheet were turned over"
        else:
            labels = [self.pattern.crease_label(k) for k in turned[:_MOST_SIDES]]
            more = len(turned) - len(labels)
            which = ", ".join([*labels, f"and {more} more"] if more else labels)
        return [f"not on the side that is drawn: {which} (--assignments bind holds every crease to its side)"]

    def _stretch_away(self) -> float:
        """The largest stretch of an edge that is not near a point that is held."""
        net = self.net
        held = [handle.at for handle in self.description.handles]
        held += [
            at for pair in self.description.controls if isinstance(pair, Pair) for at in (pair.first, pair.second)
        ]
        middle = net.flat[net.edges].mean(axis=1)
        near = np.full(len(middle), np.inf)
        for at in net.frame.to_net(np.array(held, dtype=float).reshape(-1, 2)):
            near = np.minimum(near, np.hypot(*(middle - at).T))
        return float(self.measurement.stretch[near > _AWAY].max(initial=0.0))


def _fold_lines(net: PiecewiseDog, m: Measurement) -> list[str]:
    """What a terminal is told of the creases."""
    low, median, high = fold_angle_quantiles(m)
    sides = [f"{label} {m.side_in_words(k)}" for k, label in enumerate(net.crease_labels[:_MOST_SIDES])]
    more = len(net.crease_labels) - len(sides)
    return [
        f"fold angle {low:.0f}° – {median:.0f}° – {high:.0f}° (10 %, median, 90 %), "
        f"{m.folded_part:.1%} of the crease points folded",
        ", ".join([*sides, f"and {more} more"] if more else sides),
    ]


def _count(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def fold_angle_quantiles(m: Measurement) -> tuple[float, float, float]:
    """10 %, median and 90 % of the unsigned fold angles, degrees; zeros when none has a meaning."""
    known = m.fold_angle[np.isfinite(m.fold_angle)]
    if len(known) == 0:
        return 0.0, 0.0, 0.0
    low, median, high = np.quantile(known, [0.1, 0.5, 0.9]).tolist()
    return low, median, high


def _crease_report(pattern: CreasePattern, m: Measurement, index: int) -> dict[str, Any]:
    mine = m.crease == index
    known = m.fold_angle[mine & np.isfinite(m.fold_angle)]
    asked = mine & m.asked
    return {
        "name": pattern.creases[index].name,
        "assignment": pattern.creases[index].assignment,
        "found": m.side(index),
        "fold_angle": float(np.median(known)) if len(known) else None,
        "folded": float(m.folded[asked].mean()) if asked.any() else None,
        "points": int(mine.sum()),
    }


def fold(
    pattern: CreasePattern, description: FoldDescription | None = None, progress: Progress | None = None
) -> FoldResult:
    """Fold a drawing as described, from flat.

    progress(iterations, report) is called every few iterations. Raises CurvefoldError (pattern, net, handle)
    before any folding, also where sides bind that the drawing contradicts itself about; what goes wrong later is
    the result's ``status``.
    """
    description = description or FoldDescription()
    if description.assignments == "bind" and pattern.conflicts:
        raise PatternError(f"the drawing's sides cannot bind: {pattern.conflicts[0]}", notes=pattern.notes)
    begin = time.perf_counter()
    net = build_net(pattern, description.resolution, description.max_vertices)
    model = FoldModel(net, weights=description.weights)
    if description.assignments == "bind":
        model.set_assignments([crease.assignment for crease in pattern.creases])
    model.set_controls(description.controls)
    model.set_handles(description.handles)
    model.set_fold_angle(description.angle)
    model.set_least_fold(description.least_fold)
    rest = come_to_rest(model, description, progress)
    return FoldResult(
        pattern,
        description,
        net,
        rest.positions,
        rest.measurement,
        rest.status,
        rest.detail,
        rest.iterations,
        time.perf_counter() - begin,
        rest.last,
        rest.findings,
    )


def come_to_rest(model: FoldModel, description: FoldDescription, progress: Progress | None = None) -> Rest:
    """Advance a model that was told a description until it rests, and in other ways if that failed.

    What another way comes to is kept only if it is all that was asked.
    """
    rest = _rest(model, description, progress, 0)
    if rest.status in (Outcome.SHALLOW, Outcome.NOT_FOLDED) and description.assignments == "free":
        rest = _with_drawn_sides(model.net, description, progress, rest)
    creased = len(model.net.chain_crease) > 0
    may_help = rest.status in _WORTH_ANOTHER_WAY and description.weights.fold_condition > 0 and creased
    if not (may_help and description.handles) or _too_far_apart(description.handles, model.net):
        return rest
    iterations = rest.iterations
    for opening in OPENING_ANGLES:
        model.fold_anew(opening)
        other = _rest(model, description, progress, iterations)
        if other.status.ok:
            return other
        iterations = other.iterations
    return replace(rest, iterations=iterations)


def _with_drawn_sides(
    net: PiecewiseDog, description: FoldDescription, progress: Progress | None, free: Rest
) -> Rest:
    """The fold with the drawing's sides held, where it carries both and the drive comes farther with them."""
    if description.angle is None or not {"M", "V"} <= set(net.crease_letters):
        return free
    model = FoldModel(net, weights=description.weights)
    model.set_assignments(net.crease_letters)
    try:
        model.set_controls(description.controls)
    except DescriptionError:
        return free  # a control asks for another side
    model.set_handles(description.handles)
    model.set_fold_angle(description.angle)
    held = _rest(model, description, progress, free.iterations)
    angles = [fold_angle_quantiles(one.measurement)[1] for one in (free, held)]
    stretch = [float(one.measurement.stretch.mean()) for one in (free, held)]
    deeper = angles[1] >= _DEEPER * angles[0] and stretch[1] <= max(_AS_WHOLE * stretch[0], MAX_MEAN_STRETCH)
    if held.status.ok or (deeper and held.status is Outcome.SHALLOW):
        return replace(held, detail=f"{held.detail}; {_HELD}")
    return replace(free, iterations=held.iterations)


def _rest(model: FoldModel, description: FoldDescription, progress: Progress | None, before: int) -> Rest:
    """Advance a model until it rests. before: iterations that were done already, beside the most there may be."""
    iterations = before
    while True:
        report = model.advance(_REPORT_EVERY)
        iterations += report.iterations
        if progress is not None:
            progress(iterations, report)
        if model.status is not Status.RUNNING or iterations - before >= description.max_iterations:
            break
    return judge(model, description, report, iterations)


def judge(model: FoldModel, description: FoldDescription, last: SqpReport, iterations: int) -> Rest:
    """How a model stands that was told a description and has last reported this."""
    measurement = measure(model.net, model.positions)
    status, detail = _in_words(description, model, last, measurement)
    return Rest(model.positions, measurement, status, detail, iterations, last, model.findings)


def _in_words(
    description: FoldDescription, model: FoldModel, report: SqpReport, m: Measurement
) -> tuple[Outcome, str]:
    """How a model's fold ended, and the sentence for it: what went wrong first, or that nothing did."""
    net, findings = model.net, model.findings
    if model.status is Status.NOT_FINITE or not np.isfinite(model.positions).all():
        return Outcome.NOT_FINITE, Outcome.NOT_FINITE.sentence
    if report.handle_error > REACHED * net.frame.unit:
        return Outcome.OUT_OF_REACH, _out_of_reach(description.handles, net, model, report)
    stopped = f"stopped after {description.max_iterations} iterations before it settled"
    away = [finding.sentence for finding in findings if finding.lack is Lack.REACH]
    if away:
        return Outcome.OUT_OF_REACH, "; ".join([*away, stopped] if model.status is Status.RUNNING else away)
    if model.status is Status.RUNNING:
        return Outcome.UNSETTLED, stopped
    creased = len(net.chain_crease) > 0
    if off_plane(model.positions) < _FLAT * net.frame.unit:
        return Outcome.FLAT, Outcome.FLAT.sentence if creased else _BLANK_AND_FLAT
    if not m.folded.all():
        labels = ", ".join(net.crease_labels[c] for c in m.not_folded)
        x, y = m.crease_position[np.flatnonzero(~m.folded)[0]]
        return Outcome.NOT_FOLDED, (
            f"not folded everywhere: {labels} ({m.folded_part:.1%} of all points are), first at ({x:.4g}, {y:.4g})"
        )
    against = [finding.sentence for finding in findings if finding.lack is Lack.SIDE]
    if against:
        return Outcome.AGAINST_ASSIGNMENT, "; ".join(against)
    mean = float(m.stretch.mean())
    if mean > MAX_MEAN_STRETCH:
        return Outcome.STRETCHED, f"the paper is stretched by {mean:.2%} in the mean, more than paper can be"
    shallow = [finding.sentence for finding in findings if finding.lack in (Lack.ANGLE, Lack.DEPTH)]
    if shallow:
        return Outcome.SHALLOW, "; ".join(shallow)
    verification = verify(net, model.positions)
    if not verification.ok:
        return Outcome.UNCERTIFIED, f"{Outcome.UNCERTIFIED.sentence}: {verification.faults[0]}"
    outcome = Outcome.FOLDED if creased else Outcome.BENT
    return outcome, outcome.sentence


def _out_of_reach(handles: tuple[Handle, ...], net: PiecewiseDog, model: FoldModel, report: SqpReport) -> str:
    error = report.handle_error
    if apart := _too_far_apart(handles, net):
        return apart
    worst = model.worst_handle
    x, y = handles[worst].at
    return f"handle {worst + 1} at ({x:.4g}, {y:.4g}) is out of reach: it stays {error:.3g} from its target"


def _too_far_apart(handles: tuple[Handle, ...], net: PiecewiseDog) -> str:
    """What is said of two handles whose targets no paper between them can reach; empty when there are none."""
    whole = [k for k, handle in enumerate(handles) if all(handle.axes)]
    if len(whole) < 2:
        return ""
    at = np.array([handles[k].at for k in whole])
    targets = np.array([handles[k].target for k in whole])
    later, earlier = np.tril_indices(len(whole), -1)
    lengths = np.linalg.norm(at[later] - at[earlier], axis=1)
    wanted = np.linalg.norm(targets[later] - targets[earlier], axis=1)
    outline = shapely.transform(net.sheet, net.frame.to_drawing).buffer(1e-9 * net.frame.unit)
    for k in np.flatnonzero(wanted > lengths * (1 + 1e-9)):
        if outline.covers(shapely.LineString(at[[later[k], earlier[k]]])):
            return (
                f"out of reach: the targets of handles {whole[earlier[k]] + 1} and {whole[later[k]] + 1} are "
                f"{wanted[k]:.4g} apart, but the sheet between them is only {lengths[k]:.4g} long"
            )
    return ""


def in_words(error: CurvefoldError) -> str:
    """One line for a user."""
    return " ".join(str(error).split())
