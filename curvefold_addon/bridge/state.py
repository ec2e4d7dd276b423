"""What a .blend must keep to be folded on: the net's exact coordinates, the drawing, and what was asked.

The shown mesh cannot restore the net (single precision, and the hidden parts of the net are not in it), so
the net's own coordinates lie beside it as an ID property, bit for bit.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ...solver import CreasePattern, FoldResult

#: Counts up when what is stored changes its meaning.
FORMAT = 1

_FORMAT = "curvefold_format"
_POSITIONS = "curvefold_positions"
_DESCRIPTION = "curvefold_description"
_PATTERN = "curvefold_pattern"


class StateError(ValueError):
    """A mesh does not carry a fold, or one that this version cannot read."""


@dataclass(frozen=True, eq=False)
class StoredFold:
    """positions (V,3) of the net in drawing units; description and pattern as plain data.

    ``solver.FoldDescription.from_json`` reads the description.
    """

    positions: NDArray[np.float64]
    description: dict[str, Any]
    pattern: dict[str, Any]


def store(mesh: Any, result: FoldResult) -> None:
    """Keeps a fold on the mesh datablock that shows it."""
    mesh[_FORMAT] = FORMAT
    mesh[_POSITIONS] = np.ascontiguousarray(result.positions, dtype=np.float64).ravel()
    mesh[_DESCRIPTION] = json.dumps(result.description.to_json())
    mesh[_PATTERN] = json.dumps(_pattern_data(result.pattern), default=_plain)


def is_stored(mesh: Any) -> bool:
    """Whether the mesh carries a fold."""
    return _FORMAT in mesh


def load(mesh: Any) -> StoredFold:
    """What ``store`` kept."""
    if not is_stored(mesh):
        raise StateError(f"{mesh.name} carries no fold")
    if mesh[_FORMAT] > FORMAT:
        raise StateError(f"{mesh.name} was folded by a newer version of Curvefold")
    positions = np.frombuffer(mesh[_POSITIONS], dtype=np.float64).reshape(-1, 3).copy()
    return StoredFold(positions, json.loads(mesh[_DESCRIPTION]), json.loads(mesh[_PATTERN]))


def _pattern_data(pattern: CreasePattern) -> dict[str, Any]:
    return {
        "name": pattern.name,
        "unit_mm": pattern.unit_mm,
        "boundary": pattern.boundary,
        "holes": list(pattern.holes),
        "creases": [
            {
                "points": crease.points,
                "closed": crease.closed,
                "assignment": crease.assignment,
                "name": crease.name,
                "beziers": crease.beziers,
            }
            for crease in pattern.creases
        ],
    }


def _plain(value: Any) -> Any:
    """Arrays and numpy numbers as JSON has them; repr keeps every bit of a float."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return str(value)
