"""What a .blend must keep for a paper to be folded on: the net's exact coordinates and what it is made from.

The shown mesh cannot restore the net (single precision, and the hidden parts of the net are not in it), so
the net's own coordinates lie beside it as an ID property, bit for bit. Settings and handles are ``Mesh.curvefold``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...solver import Crease, CreasePattern
from ...solver.description import RESOLUTIONS

#: What settings say instead of a resolution, for one that follows the drawing.
AUTOMATIC = 0

#: Counts up when what is stored changes its meaning.
FORMAT = 2

#: How the names of all properties begin that a fold keeps on a mesh.
_PREFIX = "curvefold_"
_FORMAT = "curvefold_format"
_POSITIONS = "curvefold_positions"
_PATTERN = "curvefold_pattern"
_RESOLUTION = "curvefold_resolution"
_SCALE = "curvefold_scale"
_CHOSEN = "curvefold_resolution_chosen"
_RUN = "curvefold_run"
_REST = "curvefold_rest"


class StateError(ValueError):
    """A mesh does not carry a fold, or one that this version cannot read."""


@dataclass(frozen=True)
class Source:
    """What a net is made from, and all of it: equal sources make equal nets.

    pattern: the drawing as JSON; resolution: quads along the longer side, AUTOMATIC when they are still to be
    chosen; scale: the paper's units in one of the drawing's; automatic: whether the resolution was chosen for the
    drawing. It is kept with it, so that no later version has to choose the same.
    """

    pattern: str
    resolution: int
    scale: float = 1.0
    automatic: bool = field(default=False, compare=False)

    def told(self, resolution: int) -> Source:
        """The same drawing with the resolution that settings ask for; AUTOMATIC leaves it to be chosen."""
        asked = resolution if resolution == AUTOMATIC else max(RESOLUTIONS[0], resolution)
        return replace(self, resolution=asked, automatic=False)

    def meets(self, wanted: Source) -> bool:
        """Whether this is what another one comes to, whose resolution may be left to be chosen."""
        if wanted.resolution != AUTOMATIC:
            return self == wanted
        return self.automatic and (self.pattern, self.scale) == (wanted.pattern, wanted.scale)


@dataclass(frozen=True, eq=False)
class StoredShape:
    """positions (V,3) of the net in the paper's units; run: the name of the last motion, or empty.

    rest: what the paper was told when it came to rest, as numbers (``hooks.Inputs.numbers``); None in mid-motion.
    """

    source: Source
    positions: NDArray[np.float64]
    run: str
    rest: NDArray[np.float64] | None


def source_of(pattern: CreasePattern, resolution: int, scale: float = 1.0) -> Source:
    """The source of ``build_net(pattern, resolution)``; AUTOMATIC leaves the resolution to be chosen."""
    return Source(json.dumps(_pattern_data(pattern), default=_plain), AUTOMATIC, float(scale)).told(int(resolution))


@lru_cache(maxsize=1)  # a net and its creases as drawn are asked for one after the other
def pattern_of(source: Source) -> CreasePattern:
    """The drawing again, to the last bit."""
    data = json.loads(source.pattern)
    creases = [
        Crease(entry["points"], entry["closed"], entry["assignment"], entry["name"], entry["beziers"])
        for entry in data["creases"]
    ]
    return CreasePattern(data["boundary"], data["holes"], creases, data["name"], data["unit_mm"], data["notes"])


def store(mesh: Any, source: Source, positions: NDArray[np.float64]) -> None:
    """Keeps a new net and its positions (V,3), the paper's units, on the mesh that shows it."""
    mesh[_FORMAT] = FORMAT
    mesh[_PATTERN] = source.pattern
    mesh[_RESOLUTION] = source.resolution
    mesh[_SCALE] = source.scale
    mesh[_CHOSEN] = source.automatic
    store_positions(mesh, positions)


def store_positions(mesh: Any, positions: NDArray[np.float64]) -> None:
    """Keeps the shape, and that it is one in mid-motion."""
    _keep_array(mesh, _POSITIONS, positions)
    if _REST in mesh:
        del mesh[_REST]


def store_run(mesh: Any, run: str) -> None:
    """Names the motion that begins."""
    mesh[_RUN] = run


def store_rest(mesh: Any, numbers: NDArray[np.float64]) -> None:
    """Keeps what the paper was told when it came to rest."""
    _keep_array(mesh, _REST, numbers)


def is_stored(mesh: Any) -> bool:
    """Whether the mesh carries a fold."""
    return _FORMAT in mesh


def clear(mesh: Any) -> None:
    """Takes all that is kept of a fold off a mesh; what the user has put on it stays."""
    for key in [key for key in mesh.keys() if key.startswith(_PREFIX)]:  # noqa: SIM118  (an ID is no dictionary)
        del mesh[key]


def load_source(mesh: Any) -> Source:
    """What the stored net is made from. Raises StateError."""
    if not is_stored(mesh):
        raise StateError(f"{mesh.name} carries no fold")
    if mesh[_FORMAT] != FORMAT:
        age = "a newer" if mesh[_FORMAT] > FORMAT else "an older"
        raise StateError(f"{mesh.name} was folded by {age} version of Curvefold")
    # Without the last: folded by a version that chose no resolution.
    return Source(mesh[_PATTERN], mesh[_RESOLUTION], mesh[_SCALE], bool(mesh.get(_CHOSEN, False)))


def load(mesh: Any) -> StoredShape:
    """What is stored. Raises StateError."""
    source = load_source(mesh)
    positions = np.frombuffer(mesh[_POSITIONS], dtype=np.float64).reshape(-1, 3).copy()
    rest = np.frombuffer(mesh[_REST], dtype=np.float64).copy() if _REST in mesh else None
    return StoredShape(source, positions, mesh.get(_RUN, ""), rest)


def _keep_array(mesh: Any, key: str, values: NDArray[np.float64]) -> None:
    flat = np.ascontiguousarray(values, dtype=np.float64).ravel()
    # Blender (4.2 to 5.2) writes an array of another length into the memory of the old one.
    if key in mesh and len(mesh[key]) != len(flat):
        del mesh[key]
    mesh[key] = flat


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
        "notes": list(pattern.notes),
    }


def _plain(value: Any) -> Any:
    """Arrays and numpy numbers as JSON has them; repr keeps every bit of a float."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return str(value)
