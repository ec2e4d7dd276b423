"""Where objects are, by their own settings: newer than what Blender evaluated last, and in double precision."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import solver

Array = NDArray[np.float64]


def world_matrix(item: Any) -> Array:
    """(4,4) of an object in the world."""
    matrix, rest = _settings_up_to(item, None)
    return matrix if rest is None else np.array(rest.matrix_world, dtype=np.float64) @ matrix


def mean_scale(item: Any) -> float:
    """How many times as large as in its own coordinates an object's XY plane is in the world."""
    matrix = world_matrix(item)
    return float(np.sqrt(np.linalg.norm(np.cross(matrix[:3, 0], matrix[:3, 1]))))


def matrix_on(sheet: Any, item: Any) -> Array:
    """(4,4) from an object's coordinates to a sheet's. Exact where the object hangs below the
    sheet; otherwise a sheet whose scale is zero raises PatternError."""
    matrix, rest = _settings_up_to(item, sheet)
    if rest == sheet:
        return matrix
    try:
        return np.asarray(np.linalg.inv(world_matrix(sheet)) @ world_matrix(item))
    except np.linalg.LinAlgError as error:
        raise solver.PatternError("its scale is zero", element=sheet.name) from error


def _settings_up_to(item: Any, top: Any) -> tuple[Array, Any]:
    """The matrix from ``item`` up to an object, and this object: ``top``, one whose settings do not tell its
    place (constraints, parents that are not plain objects), or None for the world."""
    matrix = np.eye(4)
    node = item
    while node is not None and node != top:
        if len(node.constraints) or (node.parent is not None and node.parent_type != "OBJECT"):
            return matrix, node
        own = np.array(node.matrix_basis, dtype=np.float64)
        if node.parent is not None:
            own = np.array(node.matrix_parent_inverse, dtype=np.float64) @ own
        matrix = own @ matrix
        node = node.parent
    return matrix, node
