"""Curve objects as shapes in space that a crease is given."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .controls import CurveTargetError, Place
from .evaluated_curves import NoLineError
from .splines import Strand

#: About so many points stand for a curve, and at least so many for one of its segments.
_POINTS, _LEAST = 96, 4


def target_points(
    item: Any, scene: Any, matrix_of: Callable[[Any], Any], strands_of: Callable[[Any], list[Strand]]
) -> tuple[Place, ...]:
    """Points along a curve object under its matrix. strands_of: reads its splines. Raises CurveTargetError."""
    if item is None:
        raise CurveTargetError("choose a curve object that it shall follow")
    if item.name not in scene.objects:
        raise CurveTargetError("has lost its curve")
    if item.type != "CURVE":
        raise CurveTargetError(f"{item.name} is no curve")
    try:
        strands = [strand for strand in strands_of(item) if len(strand.cubics)]
    except NoLineError as error:
        raise CurveTargetError(
            f"{item.name} has thickness, which its modifier {error.modifier} changes: set Bevel and Extrude to zero"
        ) from None
    if len(strands) != 1:
        raise CurveTargetError(f"{item.name} must be one curve and has {len(strands)}")
    if strands[0].closed:
        raise CurveTargetError(f"{item.name} is closed: a crease can be given open curves only")
    cubics = strands[0].transformed(np.array(matrix_of(item))).cubics
    count = max(_LEAST, -(-_POINTS // len(cubics)))
    t = np.arange(count)[:, None] / count
    bernstein = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    points = np.einsum("tk,skc->stc", bernstein, cubics).reshape(-1, 3)
    return tuple((float(x), float(y), float(z)) for x, y, z in np.vstack([points, cubics[-1:, 3]]))
