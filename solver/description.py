"""All that a fold is told, as data: it can be written to a file and read back."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from .controls.control import Control, is_number
from .controls.registry import control_to_json, controls_from_json
from .errors import DescriptionError, HandleError

#: Version of the JSON written by ``FoldDescription.to_json``.
FORMAT_VERSION = 1
#: Quads along the longer side that a net may have, least and most.
RESOLUTIONS = (4, 1000)
#: The resolution that follows the drawing, and the vertices that it may use: a net of 5,800 folded in 40 s on one
#: core of a busy machine.
AUTO, AUTO_VERTICES = "auto", 6000
#: Vertices that the resolution may be told to use, least and most.
VERTEX_BUDGETS = (100, 100_000)
#: How deep every crease point is pulled where handles alone bend the paper, degrees: of the corpus's first 100
#: drags the lowest tenth of the crease points rose from 4 to 14 in the median (docs/method.md).
LEAST_FOLD = 40.0
#: More iterations than any fold needs.
MAX_ITERATIONS = 1_000_000
#: No weight may be larger: with this one for any of them an arc at 50 degrees comes to rest, with 1e30 for isometry
#: the linear system breaks.
MOST_WEIGHT = 1e10
#: JSON files larger than this are refused before they are parsed, bytes.
_MAX_BYTES = 16 * 1024 * 1024


@dataclass(frozen=True)
class Handle:
    """A point of the sheet and its target. at (x, y) on the flat sheet, target (X, Y, Z); drawing units.

    axes: along which of X, Y and Z it pulls; it is free along the others. strength: how hard it pulls, in parts
    of a usual handle's weight.
    Raises HandleError when a number is not finite, no axis is left, or the strength is not positive.
    """

    at: tuple[float, float]
    target: tuple[float, float, float]
    axes: tuple[bool, bool, bool] = (True, True, True)
    strength: float = 1.0

    def __post_init__(self) -> None:
        for name, values, count in (("at", self.at, 2), ("target", self.target, 3)):
            try:
                numbers = tuple(float(v) for v in values)
            except (TypeError, ValueError, OverflowError):
                raise HandleError(f"{name!r} must be {count} numbers", element="handle") from None
            if len(numbers) != count or not all(math.isfinite(v) for v in numbers):
                raise HandleError(f"{name!r} must be {count} finite numbers", element="handle")
            object.__setattr__(self, name, numbers)
        if len(self.axes) != 3 or not all(isinstance(axis, bool) for axis in self.axes):
            raise HandleError("'axes' must be three of true and false", element="handle")
        object.__setattr__(self, "axes", tuple(self.axes))
        if not any(self.axes):
            raise HandleError("'axes' leaves no axis to pull along", element="handle")
        if not is_number(self.strength) or self.strength <= 0:
            raise HandleError("'strength' must be a positive number", element="handle")
        object.__setattr__(self, "strength", float(self.strength))


@dataclass(frozen=True)
class Weights:
    """Weights of the terms in net units (paper, section 6.2; the fold condition: method, section 4).

    A weight of 0 leaves a term out.
    """

    bending: float = 1.0
    isometry: float = 20000.0
    continuity: float = 1e4
    handles: float = 5.0
    drive: float = 3.0
    least_fold: float = 0.5
    fold_angle: float = 100.0
    fold_condition: float = 1.0
    sides: float = 100.0
    pairs: float = 5.0
    patches: float = 1000.0
    curves: float = 50.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if not (is_number(value) and 0 <= value <= MOST_WEIGHT):
                raise DescriptionError(f"a weight must be a number from 0 to {MOST_WEIGHT:g}", element=entry.name)
            object.__setattr__(self, entry.name, float(value))


@dataclass(frozen=True)
class FoldDescription:
    """resolution: quads along the longer side, "auto" for as many as the drawing needs.

    angle: degrees every crease is driven to, None for no drive; handles; assignments: "free" (the fold finds its
    own) or "bind" (those of the drawing hold); weights; max_iterations: where a fold that does not settle ends;
    controls: all else that is asked (``controls/``); max_vertices: how many "auto" may use; least_fold: degrees by
    which every crease point folds at least where handles alone bend the paper, 0 for none.
    """

    resolution: int | str = AUTO
    angle: float | None = 60.0
    handles: tuple[Handle, ...] = ()
    assignments: str = "free"
    weights: Weights = field(default_factory=Weights)
    max_iterations: int = 1500
    controls: tuple[Control, ...] = ()
    max_vertices: int = AUTO_VERTICES
    least_fold: float = LEAST_FOLD

    def __post_init__(self) -> None:
        if self.angle is not None and not (is_number(self.angle) and 0 <= self.angle <= 180):
            raise DescriptionError("the fold angle must lie between 0 and 180 degrees", element="angle")
        if not (is_number(self.least_fold) and 0 <= self.least_fold <= 180):
            raise DescriptionError("must be a number of degrees from 0 to 180", element="least_fold")
        for name, least, most, word in (
            ("resolution", *RESOLUTIONS, AUTO),
            ("max_iterations", 1, MAX_ITERATIONS, None),
            ("max_vertices", *VERTEX_BUDGETS, None),
        ):
            value = getattr(self, name)
            if value != word and (type(value) is not int or not least <= value <= most):
                other = "" if word is None else f", or {word!r}"
                raise DescriptionError(f"must be a whole number from {least} to {most}{other}", element=name)
        if self.assignments not in ("free", "bind"):
            raise DescriptionError("assignments must be 'free' or 'bind'", element="assignments")
        object.__setattr__(self, "handles", tuple(self.handles))
        object.__setattr__(self, "controls", tuple(self.controls))

    def to_json(self) -> dict[str, Any]:
        """A JSON object; ``from_json`` reads it back."""
        data = asdict(replace(self, controls=()))
        return {"format": FORMAT_VERSION, **data, "controls": [control_to_json(c) for c in self.controls]}

    @staticmethod
    def from_json(data: Any) -> FoldDescription:
        """Raises DescriptionError or HandleError on anything that is not a description.

        Handles fold by themselves: where they are given and no angle is, there is no drive.
        """
        if not isinstance(data, dict):
            raise DescriptionError("a fold description must be a JSON object")
        known = {entry.name for entry in fields(FoldDescription)}
        unknown = sorted(set(data) - known - {"format"})
        if unknown:
            raise DescriptionError("unknown setting", element=str(unknown[0]))
        if data.get("format", FORMAT_VERSION) != FORMAT_VERSION:
            raise DescriptionError(f"format {data.get('format')!r} is not known", element="format")
        values = {name: data[name] for name in known if name in data}
        values["handles"] = parse_handles(data.get("handles", []))
        if values["handles"]:
            values.setdefault("angle", None)
        values["controls"] = controls_from_json(data.get("controls", []))
        if "weights" in data:
            try:
                values["weights"] = Weights(**data["weights"])
            except TypeError:
                raise DescriptionError("unknown or missing weight", element="weights") from None
        return FoldDescription(**values)


def parse_handles(data: Any) -> tuple[Handle, ...]:
    """Handles from JSON: [{"at": [x, y], "target": [X, Y, Z]}, …], each with "axes" and "strength" if they differ
    from a usual handle's. Raises HandleError naming the entry.
    """
    if not isinstance(data, list):
        raise HandleError("handles must be a list of objects with 'at' and 'target'")
    result = []
    for k, entry in enumerate(data):
        element = f"handle {k + 1}"
        if not isinstance(entry, dict) or not {"at", "target"} <= set(entry):
            raise HandleError("a handle needs 'at' and 'target'", element=element)
        unknown = sorted(set(entry) - {"at", "target", "axes", "strength"})
        if unknown:
            raise HandleError(f"unknown setting {unknown[0]!r}", element=element)
        try:
            extra = {"axes": tuple(entry["axes"])} if "axes" in entry else {}
            result.append(
                Handle(tuple(entry["at"]), tuple(entry["target"]), strength=entry.get("strength", 1.0), **extra)
            )
        except HandleError as error:
            raise HandleError(error.message, element=element) from None
        except TypeError:
            raise HandleError("'at', 'target' and 'axes' must be lists", element=element) from None
    return tuple(result)


def read_handles(path: str | Path) -> tuple[Handle, ...]:
    """Handles from a JSON file. Raises HandleError naming the file and the entry."""
    try:
        return parse_handles(_read_json(path, HandleError))
    except HandleError as error:
        raise error if error.where.file else error.in_file(str(path)) from None


def read_description(path: str | Path) -> FoldDescription:
    """A whole description from a JSON file. Raises DescriptionError or HandleError naming the file."""
    try:
        return FoldDescription.from_json(_read_json(path, DescriptionError))
    except (DescriptionError, HandleError) as error:
        raise error if error.where.file else error.in_file(str(path)) from None


def _read_json(path: str | Path, error: type[HandleError] | type[DescriptionError]) -> Any:
    """The contents of a JSON file; raises ``error`` naming the file."""
    path = Path(path)
    try:
        if path.stat().st_size > _MAX_BYTES:
            raise error("the file is too large", file=str(path))
        # Bytes: JSON shows by itself whether it is UTF-8, UTF-16 or UTF-32, with a byte order mark or without.
        return json.loads(path.read_bytes())
    except OSError as trouble:
        raise error(f"cannot be read: {trouble.strerror or trouble}", file=str(path)) from None
    except (ValueError, RecursionError):
        raise error("is not valid JSON", file=str(path)) from None
