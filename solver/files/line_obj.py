"""Wavefront OBJ: line segments in groups."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import frozen_array
from .obj import word


def line_obj_text(
    vertices: ArrayLike,
    lines: ArrayLike,
    groups: Sequence[str],
    name: str = "curvefold",
    comment: str = "",
) -> str:
    """An OBJ file as text: a line element for each line, a point element for each vertex that no line has.

    vertices  (N,3) positions; every number is written so that it is read back as the same float64
    lines     (n,2) vertex indices from 0
    groups    (n,) one a line, written as ``g <group>`` whenever it changes; points come last, as ``g points``
    Raises ValueError on shapes that do not fit, numbers that are not finite, and lines of no two vertices.
    """
    positions = frozen_array(vertices, np.float64, (None, 3), "vertices")
    pairs = frozen_array(lines, np.int64, (len(groups), 2), "lines")
    if not np.isfinite(positions).all():
        raise ValueError("vertices must be finite")
    if len(pairs) and (pairs.min() < 0 or pairs.max() >= len(positions) or (pairs[:, 0] == pairs[:, 1]).any()):
        raise ValueError(f"every line must join two of {len(positions)} vertices")
    text = [f"# {line}" for line in comment.splitlines()]
    text.append(f"o {word(name)}")
    # repr is the shortest text that gives the same number back.
    text += [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()]
    group = None
    for (a, b), its in zip(pairs.tolist(), groups, strict=True):
        if its != group:
            group = its
            text.append(f"g {word(its)}")
        text.append(f"l {a + 1} {b + 1}")
    alone = np.setdiff1d(np.arange(len(positions)), pairs).tolist()
    if alone:
        text.append("g points")
        text += [f"p {k + 1}" for k in alone]
    return "\n".join(text) + "\n"
