"""What a plan is made of: a drawing, and what is known of the fold."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..controls.control import Control
from ..controls.glue import Glue
from ..controls.pair import Pair
from ..description import FoldDescription, Handle
from ..errors import CurvefoldError, ReadError
from ..files.results import FOLD_NAME, REPORT_NAME
from ..files.ruling_files import RULINGS_SVG
from ..fold import FoldResult
from ..measurement import Measurement
from ..pattern.crease_pattern import CreasePattern
from ..pattern.fold_file_frames import choose_frame, parse_fold
from ..pattern.fold_file_values import angles, counted_from, index_rows
from ..pattern.read_options import ReadOptions
from ..pattern.reading import read_pattern
from ..pattern.source import read_source
from ..rulings import rulings

Place = tuple[float, float]

#: What is said of a drawing without a unit.
_NO_UNIT = "the drawing gives no unit, so that one is taken for 1 mm"


@dataclass(frozen=True, eq=False)
class FoldAngles:
    """Signed fold angles (n,), degrees, valley positive, at places (n,2) on creases of the flat sheet."""

    places: FloatArray
    degrees: FloatArray


@dataclass(frozen=True, eq=False)
class Joint:
    """Points or stretches of the border that belong together: the places of either, drawing units."""

    first: tuple[Place, ...]
    second: tuple[Place, ...]


@dataclass(frozen=True, eq=False)
class PlanSource:
    """Lengths in the drawing's units.

    found    fold angles, None where only the drawing is known
    handles  (H,2) where handles are; joints
    rulings  (R,2,2) on the flat sheet
    """

    pattern: CreasePattern
    found: FoldAngles | None = None
    handles: tuple[Place, ...] = ()
    joints: tuple[Joint, ...] = ()
    rulings: FloatArray | None = None
    notes: tuple[str, ...] = ()

    @property
    def unit_mm(self) -> float:
        return self.pattern.unit_mm or 1.0


def of_pattern(pattern: CreasePattern) -> PlanSource:
    """A drawing: mountains and valleys as they are drawn."""
    notes = (*pattern.notes, *(() if pattern.unit_mm else (_NO_UNIT,)))
    return PlanSource(pattern, notes=notes)


def of_result(result: FoldResult, with_rulings: bool = False) -> PlanSource:
    """A fold: mountains and valleys as they are folded."""
    handles, joints = told_places(result.description.handles, result.description.controls)
    flat = rulings(result.net, result.positions).flat if with_rulings else None
    drawn = of_pattern(result.pattern)
    return PlanSource(result.pattern, angles_of(result.measurement), handles, joints, flat, drawn.notes)


def angles_of(measurement: Measurement) -> FoldAngles:
    """The fold angles that were measured."""
    signed = measurement.fold_angle * measurement.fold_sign
    known = np.isfinite(signed)
    return FoldAngles(measurement.crease_position[known], signed[known])


def read_plan_source(path: str | os.PathLike[str], options: ReadOptions | None = None) -> PlanSource:
    """A drawing, a folded FOLD file, or a folder of results with its report.

    Raises ReadError, PatternError and DescriptionError, each with the file.
    """
    path = Path(path)
    if not path.is_dir():
        return _read_file(path, options)
    for name in (FOLD_NAME, REPORT_NAME):
        if not (path / name).is_file():
            raise ReadError(f"this folder of results has no {name}", file=str(path))
    source = _read_file(path / FOLD_NAME, options)
    description, name = _read_report(path / REPORT_NAME)
    handles, joints = told_places(description.handles, description.controls)
    pattern = source.pattern.named(name or source.pattern.name, source.pattern.unit_mm)
    flat = _read_rulings(path / RULINGS_SVG, pattern) if (path / RULINGS_SVG).is_file() else None
    return PlanSource(pattern, source.found, handles, joints, flat, source.notes)


def plan_sources(path: str | os.PathLike[str]) -> tuple[Path, ...]:
    """The files that ``read_plan_source`` reads: no plan may be written over them."""
    path = Path(path)
    return tuple(path / name for name in (FOLD_NAME, REPORT_NAME, RULINGS_SVG)) if path.is_dir() else (path,)


def _read_file(path: Path, options: ReadOptions | None) -> PlanSource:
    source = of_pattern(read_pattern(path, options))
    if path.suffix.lower() != ".fold":
        return source
    # What a file says of angles is in its own unit, and the scale of reading changes no coordinate.
    return PlanSource(source.pattern, _fold_file_angles(path), notes=source.notes)


def _fold_file_angles(path: Path) -> FoldAngles | None:
    """The fold angles of the edges of the flat frame that is read as the drawing; None where there are none."""
    try:
        data, _ = read_source(path)
        frame = choose_frame(parse_fold(data))
        if frame.get("edges_foldAngle") is None or frame.get("edges_vertices") is None:
            return None
        rows = index_rows(frame.get("edges_vertices"), "edges_vertices", 2, 2)
        degrees = angles(frame.get("edges_foldAngle"), rows.places)
    except CurvefoldError as error:
        raise (error if error.where.file else error.in_file(str(path))) from error
    points = frame.coordinates
    ends = rows.vertices.reshape(-1, 2) - counted_from(len(points), rows.vertices)
    letters: Any = frame.get("edges_assignment")
    folds = np.isfinite(degrees)
    if isinstance(letters, list):
        drawn = [letters[k] if k < len(letters) else None for k in rows.places.tolist()]
        folds &= np.array([letter in ("M", "V", "U") for letter in drawn], dtype=bool)
    folds &= np.isfinite(points[ends]).all(axis=(1, 2))
    if not folds.any():
        return None
    return FoldAngles(points[ends[folds]].mean(axis=1), degrees[folds])


def _read_report(path: Path) -> tuple[FoldDescription, str]:
    """What the fold was told, and the name of its drawing."""
    data, _ = read_source(path)
    try:
        report = json.loads(data)
        told, name = report["description"], report["drawing"]
    except (ValueError, RecursionError, TypeError, KeyError):
        raise ReadError("this is no report of a fold", file=str(path)) from None
    try:
        return FoldDescription.from_json(told), str(name)
    except CurvefoldError as error:
        raise error.in_file(str(path)) from None


def _read_rulings(path: Path, pattern: CreasePattern) -> FloatArray:
    """(R,2,2) the rulings in the file that a fold writes of them, on the sheet."""
    data, _ = read_source(path)
    text = data.decode("utf-8", "replace") if isinstance(data, bytes) else data
    box = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', text)
    groups = re.findall(r'<g id="rulings-[^>]*>(.*?)</g>', text, re.DOTALL)
    lines = [row for group in groups for row in re.findall(r'points="([-\d.,e ]+)"', group)]
    try:
        ends = np.array([[float(v) for v in row.replace(",", " ").split()] for row in lines]).reshape(-1, 2, 2)
        margin = 0.5 * (float(box[1]) - float(np.ptp(pattern.boundary[:, 0]))) if box else math.nan
    except ValueError:
        raise ReadError("its rulings cannot be read", file=str(path)) from None
    if not math.isfinite(margin):
        raise ReadError("its rulings cannot be read", file=str(path))
    left, top = float(pattern.boundary[:, 0].min()), float(pattern.boundary[:, 1].max())
    return np.stack([ends[..., 0] - margin + left, top + margin - ends[..., 1]], axis=-1)


def told_places(
    handles: Iterable[Handle], controls: Iterable[Control], scale: float = 1.0
) -> tuple[tuple[Place, ...], tuple[Joint, ...]]:
    """Where handles are, and what is joined, on the sheet; scale: of their places."""

    def placed(at: Sequence[float]) -> Place:
        return at[0] * scale, at[1] * scale

    joints = []
    for control in controls:
        if isinstance(control, Glue):
            first, second = (tuple(map(placed, ends)) for ends in (control.first, control.second))
            joints.append(Joint(first, second))
        elif isinstance(control, Pair):
            joints.append(Joint((placed(control.first),), (placed(control.second),)))
    return tuple(placed(handle.at) for handle in handles), tuple(joints)
