"""From the settings of a paper's creases, angles, joints and patches to the controls that the solver is told."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any
from zlib import crc32

from ...solver import Amount, Angle, Curve, CurvefoldError, Glue, Keep, Pair, Side, Weights
from ...solver.controls.control import Control
from ...solver.description import LEAST_FOLD, MOST_WEIGHT

Point = tuple[float, float]
Place = tuple[float, float, float]

#: What counts how much if nobody says otherwise.
USUAL = Weights()
#: Letters that hold a crease to a side.
SIDES = ("V", "M")


@dataclass(frozen=True)
class DrawnCrease:
    """A crease as it is drawn. label: the solver's; letter: FOLD's; ends: on the flat sheet, the paper's units."""

    label: str
    letter: str
    ends: tuple[Point, Point]

    @property
    def name(self) -> str:
        """What the user calls it."""
        return plain_name(self.label)


@dataclass(frozen=True)
class Told:
    """angle: degrees all creases are driven to, None without a drive; controls, and for each what the user calls
    it; weights; least_fold, degrees; faults: why others do not act, one sentence each.
    """

    angle: float | None
    controls: tuple[Control, ...] = ()
    names: tuple[str, ...] = ()
    weights: Weights = USUAL
    least_fold: float = LEAST_FOLD
    faults: tuple[str, ...] = ()


class _Gathering:
    """Controls as they are made; those whose numbers do not fit become faults."""

    def __init__(self) -> None:
        self.controls: list[Control] = []
        self.names: list[str] = []
        self.faults: list[str] = []

    def add(self, name: str, kind: type[Control], *values: Any, **named: Any) -> None:
        try:
            self.controls.append(kind(*values, **named))
        except CurvefoldError as error:
            self.faults.append(f"{name}: {error.message}")
        else:
            self.names.append(name)

    @property
    def lead(self) -> bool:
        """Whether they fold the paper by themselves."""
        return any(isinstance(control, Angle | Curve | Glue | Pair) for control in self.controls)


class CurveTargetError(ValueError):
    """An object is no curve that a crease can be given; says why."""


#: Points along an object in the paper's local coordinates. Raises CurveTargetError.
TargetReader = Callable[[Any], tuple[Place, ...]]


def told(settings: Any, values: Any, held: bool, drawn: Sequence[DrawnCrease], target: TargetReader) -> Told:
    """What a paper is told beside its handles.

    settings, values: of the paper as they are kept and as they are evaluated; held: whether it has handles;
    target: reads curve objects.
    """
    angle: float | None = math.degrees(values.angle) * values.fold / 100.0
    if _names(values) != _names(settings):
        values = settings  # Blender evaluates nothing when an entry comes or goes
    gathering = _Gathering()
    creases = [(crease, entry, k) for k, (crease, entry) in enumerate(zip(drawn, values.creases, strict=False), 1)]
    for crease, entry, number in creases:
        _tell_crease(gathering, entry, crease.name, number)
        if entry.flow != "NONE":
            _tell_flow(gathering, settings.creases[number - 1].curve, entry, crease, number, target)
    for entry in values.angles:
        if entry.enabled:
            _tell_angle(gathering, entry)
    for entry in values.joints:
        if entry.enabled:
            _tell_joint(gathering, entry)
    if values.fold == 0.0 and (held or gathering.lead):
        angle = None
    # A sheet that is asked for nothing lies flat, whatever the sides of its creases.
    if angle != 0.0:
        for crease, entry, number in creases:
            side = _side(entry, crease.letter if values.use_assignments else "U", angle)
            if side in SIDES:
                gathering.add(crease.name, Side, number, side)
    return Told(
        angle,
        tuple(gathering.controls),
        tuple(gathering.names),
        weights_of(settings.weights),
        math.degrees(values.least_fold),
        tuple(gathering.faults),
    )


def _tell_crease(gathering: _Gathering, entry: Any, name: str, number: int) -> None:
    if entry.amount != 100.0:
        gathering.add(name, Amount, number, entry.amount / 100.0)
    if entry.use_angle:
        gathering.add(name, Angle, _degrees(entry), number, signed=bool(entry.signed))


def _tell_angle(gathering: _Gathering, entry: Any) -> None:
    at = (float(entry.at[0]), float(entry.at[1]))
    signed, strength = bool(entry.signed), float(entry.strength)
    gathering.add(entry.name, Angle, _degrees(entry), at=at, signed=signed, strength=strength)


def _degrees(entry: Any) -> float:
    """What an entry with an angle asks for; where the sign does not count, its size."""
    degrees = math.degrees(entry.angle)
    return max(-180.0, min(180.0, degrees if entry.signed else abs(degrees)))


def _tell_flow(
    gathering: _Gathering, item: Any, entry: Any, crease: DrawnCrease, number: int, target: TargetReader
) -> None:
    """All begins at the flat crease, so that the same words ask for the same shape whatever was before."""
    way = {
        "progress": entry.progress / 100.0,
        "speed": float(entry.flow_speed),
        "strength": float(entry.flow_strength),
        "from_flat": True,
    }
    if entry.flow == "SHAPE":
        times, plus, torsion = (float(v) for v in (entry.curvature_times, entry.curvature_plus, entry.torsion_plus))
        gathering.add(
            crease.name, Curve, number, curvature_times=times, curvature_plus=plus, torsion_plus=torsion, **way
        )
        return
    try:
        points = target(item)
    except CurveTargetError as error:
        gathering.faults.append(f"{crease.name}: {error}")
        return
    straight, crossed = (
        sum(math.dist((*end, 0.0), point) for end, point in zip(crease.ends, ends, strict=True))
        for ends in ((points[0], points[-1]), (points[-1], points[0]))
    )
    # Whichever way it is drawn, its ends are those that lie nearer.
    gathering.add(crease.name, Curve, number, points=points if straight <= crossed else points[::-1], **way)


def _tell_joint(gathering: _Gathering, entry: Any) -> None:
    points: list[Point] = [
        (float(p[0]), float(p[1])) for p in (entry.first, entry.second, entry.third, entry.fourth)
    ]
    strength = float(entry.strength)
    if entry.family == "PATCH":
        gathering.add(entry.name, Keep, points[0], entry.shape.lower(), strength)
    elif entry.family == "BORDERS":
        other = (points[3], points[2]) if entry.reverse else (points[2], points[3])
        gathering.add(entry.name, Glue, (points[0], points[1]), other, bool(entry.bending), strength)
    elif entry.relation == "DISTANCE":
        gathering.add(entry.name, Pair, points[0], points[1], distance=float(entry.distance), strength=strength)
    else:
        axes = tuple(map(bool, entry.axes)) if entry.relation == "SHARE" else (True, True, True)
        gathering.add(entry.name, Pair, points[0], points[1], axes, strength=strength)


def _names(settings: Any) -> list[str]:
    return [entry.name for entries in (settings.creases, settings.angles, settings.joints) for entry in entries]


def _side(entry: Any, drawn: str, driven: float | None) -> str:
    """The letter that holds a crease. One that is to stay flat has none; a signed angle outdoes the drawing."""
    flat = entry.angle == 0.0 if entry.use_angle else driven is not None and entry.amount == 0.0
    if flat:
        return "U"
    if entry.side in SIDES:
        return str(entry.side)
    return "U" if entry.use_angle and entry.signed else drawn


def weights_of(settings: Any) -> Weights:
    """The weights of the solver's terms."""
    # A file of an earlier version may hold larger ones.
    return Weights(
        **{entry.name: min(float(getattr(settings, entry.name)), MOST_WEIGHT) for entry in fields(Weights)}
    )


def match_creases(settings: Any, drawn: Sequence[DrawnCrease]) -> None:
    """One entry for each crease of the drawing, in its order; entries of known names keep what they say."""
    entries = settings.creases
    wanted = [crease.name for crease in drawn]
    present = [entry.name for entry in entries]
    if present == wanted:
        return
    lost = [entry for entry in entries if entry.name not in wanted]
    new = [name for name in wanted if name not in present]
    if len(lost) == len(new):
        for entry, name in zip(lost, new, strict=True):
            entry.name = name  # it was renamed
    for k, name in enumerate(wanted):
        place = next((j for j in range(k, len(entries)) if entries[j].name == name), None)
        if place is None:
            entries.add().name = name
            place = len(entries) - 1
        entries.move(place, k)
    while len(entries) > len(wanted):
        entries.remove(len(entries) - 1)
    settings.active_crease = max(0, min(settings.active_crease, len(wanted) - 1))
    settings.id_data.update_tag()


def plain_name(label: str) -> str:
    """A crease's name out of the solver's label for it, ``crease 3 (Lens)``."""
    head, parted, name = label.partition(" (")
    return name.removesuffix(")") if parted else head.capitalize()


def in_users_words(sentence: str, labels: Sequence[str]) -> str:
    """A sentence of the solver with creases called by their names."""
    for label in labels:
        if label.endswith(")"):
            sentence = sentence.replace(label, plain_name(label))
    return sentence


def numbers_of(controls: Sequence[Control], weights: Weights, least_fold: float) -> list[float]:
    """Controls, weights and the least fold, degrees, as numbers that are equal for equal ones."""
    result: list[float] = [least_fold]
    for control in controls:
        result.append(_of_word(control.kind))
        for entry in fields(control):
            result += _numbers(getattr(control, entry.name))
    if weights != USUAL:
        result += [float(getattr(weights, entry.name)) for entry in fields(weights)]
    return result


def _numbers(value: Any) -> list[float]:
    if value is None:
        return [math.nan]
    if isinstance(value, str):
        return [_of_word(value)]
    if isinstance(value, tuple):
        return [float(len(value)), *(number for part in value for number in _numbers(part))]
    return [float(value)]


def _of_word(word: str) -> float:
    return float(crc32(word.encode()))
