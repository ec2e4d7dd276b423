"""What is going on with a paper, in numbers and in one sentence."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ...solver.controls.pull import Lack
from ...solver.drive import MAX_MEAN_STRETCH, REACHED_PART
from ...solver.fold import fold_angle_quantiles
from ...solver.folding import REACHED
from ...solver.laid_flat import off_plane
from .controls import plain_name
from .hooks import handle_label
from .session import Session

#: A paper whose points all lie within this of a plane is flat, net units.
_FLAT = 1e-3


@dataclass(frozen=True)
class CreaseReport:
    """found: M, V or U; fold_angle: median, degrees, None where it has no meaning; folded: at every point.

    progress: the part of its way, 0 to 1, that it has gone to the curve it is given; None without one.
    """

    label: str
    found: str
    fold_angle: float | None
    folded: bool
    progress: float | None = None


@dataclass(frozen=True)
class Report:
    """state: settled, folding or trouble; stretch: relative; fold_angle: median, degrees; resolution: of the net,
    quads along the longer side; milliseconds: for one iteration; lacks: what is asked and cannot be had, sentences.
    """

    state: str
    sentence: str
    stretch_mean: float
    stretch_max: float
    fold_angle: float
    creases: tuple[CreaseReport, ...]
    vertices: int
    resolution: int
    iterations: int
    milliseconds: float
    lacks: tuple[str, ...] = ()


def describe_fault(fault: str) -> Report:
    """The report of a paper that cannot be worked on."""
    return Report("trouble", _sentence(fault), 0.0, 0.0, 0.0, (), 0, 0, 0, 0.0)


def describe(found: Session, settings: Any, fault: str, folding: bool, units: Any) -> Report:
    """fault: why the paper cannot be folded as it is now, or empty; units: the scene's unit settings."""
    m = found.measurement
    creases = describe_creases(found)
    median = fold_angle_quantiles(m)[1]
    state, sentence = _standing(found, settings, fault, folding, units, creases, median)
    return Report(
        state,
        _sentence(sentence),
        float(m.stretch.mean()),
        float(m.stretch.max()),
        median,
        creases,
        len(found.net.rest),
        found.source.resolution,
        found.iterations,
        found.milliseconds,
        tuple(_sentence(lack) for lack in _lacks(found)),
    )


def describe_creases(found: Session) -> tuple[CreaseReport, ...]:
    """What became of each crease, as last measured."""
    return tuple(_crease(found, label, k) for k, label in enumerate(found.net.crease_labels))


def stretch_words(mean: float, most: float) -> str:
    """How much a paper is stretched."""
    return f"stretch {mean:.2%} mean, {most:.1%} max"


def is_flat(found: Session) -> bool:
    """Whether all of a paper lies in one plane."""
    return bool(off_plane(found.positions) <= _FLAT * found.net.frame.unit)


def not_folded(creases: Iterable[CreaseReport]) -> str:
    """Which creases have points that are not folded; empty when none has."""
    names = [plain_name(crease.label) for crease in creases if not crease.folded]
    more = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return f"{names[0]}{more} not folded everywhere" if names else ""


def describe_crease(found: Session, index: int) -> CreaseReport | None:
    """What became of one crease, as last measured; None when there is no such crease."""
    labels = found.net.crease_labels
    return _crease(found, labels[index], index) if index < len(labels) else None


def _standing(
    found: Session,
    settings: Any,
    fault: str,
    folding: bool,
    units: Any,
    creases: tuple[CreaseReport, ...],
    median: float,
) -> tuple[str, str]:
    inputs = found.inputs
    if fault:
        return "trouble", fault
    if inputs is not None and inputs.faults:
        return "trouble", inputs.faults[0]
    if found.said.refused:
        return "trouble", found.said.refused[0]
    if found.failed:
        return "trouble", "the fold failed; the last good shape is kept"
    asked = None if inputs is None else inputs.angle
    if folding and found.rest is None:
        return "folding", f"folding: {median:.0f}° of {asked:.0f}°" if asked is not None and creases else "folding…"
    late = _late_handle(found, settings, units)
    if late:
        return "trouble", late
    if is_flat(found):
        return "settled", "flat"
    troubles = _troubles(found)
    if troubles:
        return "trouble", troubles[0]
    depth = [finding.sentence for finding in found.said.findings if finding.lack is Lack.DEPTH]
    unfolded = not_folded(creases)
    if unfolded:
        return "trouble", "; ".join([unfolded, *depth])
    mean = float(found.measurement.stretch.mean())
    if mean > MAX_MEAN_STRETCH:
        return "trouble", f"the paper is stretched by {mean:.1%} in the mean, more than paper can be"
    if depth:
        return "settled", depth[0]
    # What was found is not kept in a file: a paper that has not moved since it was opened shows how deep it is.
    shallow = found.judgement is None and asked is not None and median < REACHED_PART * asked
    return "settled", f"settled at {median:.0f}° of {asked:.0f}°" if shallow and creases else "settled"


def _troubles(found: Session) -> list[str]:
    """What was asked and cannot be had. How far the paper follows the slider is an answer, and no trouble."""
    return [finding.sentence for finding in found.said.findings if finding.lack is not Lack.DEPTH]


def _lacks(found: Session) -> tuple[str, ...]:
    faults = () if found.inputs is None else found.inputs.faults
    return (*faults, *found.said.refused, *_troubles(found))


def _late_handle(found: Session, settings: Any, units: Any) -> str:
    """Which handle is farthest from its target, when that is far."""
    inputs = found.inputs
    if inputs is None:
        return ""
    worst, label = REACHED * found.net.frame.unit, ""
    for handle, index in zip(inputs.handles, inputs.indices, strict=True):
        gap = np.subtract(found.place_of(handle.at), handle.target)[np.array(handle.axes)]
        distance = float(np.linalg.norm(gap))
        if distance > worst and index < len(settings.handles):
            worst, label = distance, handle_label(settings, index)
    if not label:
        return ""
    length = bpy.utils.units.to_string(units.system, "LENGTH", worst * units.scale_length, precision=2)
    return f"{label} is {length.strip()} from its target: out of reach"


def _crease(found: Session, label: str, index: int) -> CreaseReport:
    m = found.measurement
    mine = m.crease == index
    known = m.fold_angle[mine & np.isfinite(m.fold_angle)]
    angle = float(np.median(known)) if len(known) else None
    folded = bool(m.folded[mine & m.asked].all())
    return CreaseReport(label, m.side(index), angle, folded, found.said.flows.get(index))


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
