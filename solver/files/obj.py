"""Wavefront OBJ: the folded surface with the flat sheet as texture coordinates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import frozen_array


def obj_text(
    vertices: ArrayLike,
    uv: ArrayLike,
    faces: Sequence[Sequence[int]],
    groups: ArrayLike | None = None,
    name: str = "curvefold",
    comment: str = "",
) -> str:
    """An OBJ file as text.

    vertices  (R,3) positions; uv (R,2) texture coordinates, one a vertex; every number is written so that it
              is read back as the same float64
    faces     vertex indices from 0, each at least a triangle
    groups    (F,) patch of each face; written as ``g patch_<number>`` whenever it changes
    Raises ValueError on shapes that do not fit, numbers that are not finite, and faces that are not faces.
    """
    positions = frozen_array(vertices, np.float64, (None, 3), "vertices")
    texture = frozen_array(uv, np.float64, (len(positions), 2), "uv")
    if not (np.isfinite(positions).all() and np.isfinite(texture).all()):
        raise ValueError("vertices and uv must be finite")
    check_faces(faces, len(positions))
    patches = None if groups is None else frozen_array(groups, np.int64, (len(faces),), "groups").tolist()

    lines = [f"# {line}" for line in comment.splitlines()]
    lines.append(f"o {word(name)}")
    # repr is the shortest text that gives the same number back.
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()]
    lines += [f"vt {u!r} {v!r}" for u, v in texture.tolist()]
    corner = [f" {k}/{k}" for k in range(1, len(positions) + 1)]
    patch: int | None = None
    for index, face in enumerate(faces):
        if patches is not None and patches[index] != patch:
            patch = patches[index]
            lines.append(f"g patch_{patch}")
        lines.append("f" + "".join([corner[k] for k in face]))
    return "\n".join(lines) + "\n"


def check_faces(faces: Sequence[Sequence[int]], count: int) -> None:
    """Raises ValueError unless every face is at least a triangle of vertices below ``count``, none twice."""
    for index, face in enumerate(faces):
        if len(face) < 3 or len(set(face)) != len(face) or min(face) < 0 or max(face) >= count:
            raise ValueError(f"face {index} is not a face of {count} vertices: {list(face)}")


def word(name: str) -> str:
    """OBJ names end at the first blank."""
    return "_".join(name.split()) or "curvefold"
