"""Controls of different kinds that contradict each other: by their words alone, and at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import DescriptionError
from ..net.piecewise_dog import PiecewiseDog
from ..objectives.signed_fold import signed_points
from .angle import Angle, asked_points
from .control import Control, CreaseName, crease_index
from .curve import Curve
from .glue import Glue
from .keep import Keep
from .pair import Pair
from .pull import Finding, Lack
from .side import SIGNS, WORDS, Side

_SHEET = "the sheet allows no more without stretching"


def check_agreement(told: Sequence[tuple[str, Control]], net: PiecewiseDog) -> None:
    """Raises DescriptionError where a signed angle is on the other side than its crease is held to.

    told: (label, control) each
    """
    labels = net.crease_labels
    sides: dict[int, str] = {}
    for label, control in told:
        if isinstance(control, Side):
            sides[_crease(labels, control.crease, label)] = control.side
    for label, control in told:
        if not isinstance(control, Angle) or not control.signed:
            continue
        k = _crease_of(net, control, label)
        if k in sides and control.degrees * SIGNS[sides[k]] < 0:
            raise DescriptionError(
                f"{labels[k]} is to be a {WORDS[sides[k]]}, which has no angle of {control.degrees:g}°",
                element=label,
            )


def with_reasons(
    findings: Sequence[Finding], controls: Sequence[Control], handles: bool, net: PiecewiseDog
) -> tuple[Finding, ...]:
    """Findings that say why a crease came less far than asked: another control holds it, or the sheet does.

    handles: whether there are any
    """
    return tuple(_with_reason(finding, controls, handles, net) for finding in findings)


def held_creases(controls: Sequence[Control], net: PiecewiseDog) -> frozenset[int]:
    """Creases that kept patches and curves of their own may keep from folding as deep as the others."""
    held: set[int] = set()
    for control in controls:
        if isinstance(control, Curve):
            held.add(crease_index(net.crease_labels, control.crease))
        elif isinstance(control, Keep):
            held |= _creases_around(net, control)
    return frozenset(held)


def _with_reason(finding: Finding, controls: Sequence[Control], handles: bool, net: PiecewiseDog) -> Finding:
    if finding.held is None:
        return finding
    flows = finding.lack is Lack.REACH
    reason = _holder(finding.held, Angle if flows else Curve, controls, net)
    if not reason and not flows:
        reason = _limit(controls, handles)
    return replace(finding, sentence=f"{finding.sentence}: {reason}") if reason else finding


def _holder(crease: int, rival: type[Control], controls: Sequence[Control], net: PiecewiseDog) -> str:
    """Which control holds a crease against what another one asks of it; empty when there is none."""
    for control in controls:
        if isinstance(control, Curve) and isinstance(control, rival):
            if crease_index(net.crease_labels, control.crease) == crease:
                return "the curve that it was given holds it"
        elif isinstance(control, Angle) and isinstance(control, rival):
            if _crease_of(net, control) == crease:
                return f"the angle of {control.degrees:g}° that it was given holds it"
        elif isinstance(control, Keep) and crease in _creases_around(net, control):
            x, y = control.at
            return f"the patch at ({x:.4g}, {y:.4g}), which is kept {control.shape}, holds it"
    return ""


def _limit(controls: Sequence[Control], handles: bool) -> str:
    if handles:
        return f"with its handles where they are, {_SHEET}"
    if any(isinstance(control, Pair | Glue) for control in controls):
        return f"with its points and borders joined, {_SHEET}"
    return _SHEET


def _creases_around(net: PiecewiseDog, control: Keep) -> set[int]:
    """Creases on the border of a patch that is kept."""
    patch = net.vertex_patch[net.locate(control.at)[0][0]]
    points = net.crease_points
    beside = np.zeros(len(points.crease), dtype=bool)
    for vertices in (points.left_vertices[:, 0], points.right_vertices[:, 0]):
        beside |= (vertices >= 0) & (net.vertex_patch[vertices] == patch)
    return set(points.crease[beside].tolist())


def _crease_of(net: PiecewiseDog, control: Angle, label: str | None = None) -> int:
    """The crease that an angle is about; -1 where its place means none, which is refused elsewhere."""
    if control.crease is not None:
        return _crease(net.crease_labels, control.crease, label)
    points = signed_points(net)
    try:
        (nearest,) = asked_points(net, points, control)
    except DescriptionError:
        return -1
    return int(net.crease_points.crease[points[nearest]])


def _crease(labels: Sequence[str], name: CreaseName, label: str | None) -> int:
    try:
        return crease_index(labels, name)
    except DescriptionError as error:
        raise DescriptionError(error.message, element=label) from None
