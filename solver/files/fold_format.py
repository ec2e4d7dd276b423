"""FOLD 1.2 (JSON): the folded sheet as the file's own frame, its flat crease pattern as a second one."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import IntArray, frozen_array
from .obj import check_faces

#: The units FOLD knows (FOLD 1.2, frame_unit).
UNITS = ("unit", "in", "pt", "m", "cm", "mm", "um", "nm")
#: A crease folded by less than this has no side, degrees. Far below what paper or a solver's tolerance holds.
FLAT_DEGREES = 1e-3


def fold_text(
    vertices: ArrayLike,
    uv: ArrayLike,
    faces: Sequence[ArrayLike],
    crease_edges: ArrayLike,
    crease_edge_crease: ArrayLike,
    crease_edge_angle: ArrayLike,
    unit: str = "unit",
    title: str = "",
    extra: Mapping[str, Any] | None = None,
) -> str:
    """A FOLD file as text.

    vertices            (R,3) folded, uv (R,2) flat, in the same ``unit`` (one of UNITS)
    faces               vertex indices from 0, counter-clockwise on the flat sheet
    crease_edges        (n,2) vertex indices of mesh edges that lie on a crease, in either direction
    crease_edge_crease  (n,) which crease; written as ``edges_curvefold:crease``, null on other edges
    crease_edge_angle   (n,) fold angles in degrees, valley positive, mountain negative, NaN where unknown
    extra               more top-level keys; each needs a colon in its name, as FOLD asks of custom keys

    The letters follow from the angles: V and M, U where it is unknown or below FLAT_DEGREES; B at the border,
    F on the other mesh edges. Raises ValueError on shapes that do not fit, numbers not finite (angles
    may be NaN), crease edges that no face has or that come twice, unknown units, and keys without a colon.
    """
    folded = frozen_array(vertices, np.float64, (None, 3), "vertices")
    flat = frozen_array(uv, np.float64, (len(folded), 2), "uv")
    if not (np.isfinite(folded).all() and np.isfinite(flat).all()):
        raise ValueError("vertices and uv must be finite")
    polygons: list[list[int]] = [np.asarray(face, dtype=np.int64).tolist() for face in faces]
    check_faces(polygons, len(folded))
    pairs = frozen_array(crease_edges, np.int64, (None, 2), "crease_edges")
    crease = frozen_array(crease_edge_crease, np.int64, (len(pairs),), "crease_edge_crease")
    angle = frozen_array(crease_edge_angle, np.float64, (len(pairs),), "crease_edge_angle")
    if np.isinf(angle).any():
        raise ValueError("crease_edge_angle must not be infinite")
    if unit not in UNITS:
        raise ValueError(f"unknown unit {unit!r}, expected one of {', '.join(UNITS)}")
    own = dict(extra or {})
    for key in own:
        if ":" not in key:
            raise ValueError(f"a key of one's own needs a colon: {key!r}")

    edges, uses = _edges(polygons)
    assignment = ["B" if count == 1 else "F" for count in uses.tolist()]
    # FOLD 1.2: 0 for flat and border edges. What curved facets bend by is in the coordinates.
    angles: list[float | None] = [0.0] * len(edges)
    on_crease: list[int | None] = [None] * len(edges)
    for edge, which, degrees in zip(_find(edges, pairs), crease.tolist(), angle.tolist(), strict=True):
        assignment[edge] = _letter(degrees)
        angles[edge] = None if np.isnan(degrees) else degrees
        on_crease[edge] = which
    content: dict[str, Any] = {
        "file_spec": 1.2,
        "file_creator": "Curvefold",
        "file_classes": ["singleModel"],
        **({"file_title": title} if title else {}),
        "frame_classes": ["foldedForm"],
        "frame_attributes": ["3D"],
        "frame_unit": unit,
        "vertices_coords": folded.tolist(),
        "edges_vertices": edges.tolist(),
        "edges_assignment": assignment,
        "edges_foldAngle": angles,
        "edges_curvefold:crease": on_crease,
        "faces_vertices": polygons,
        **own,
        "file_frames": [
            {
                "frame_classes": ["creasePattern"],
                "frame_attributes": ["2D"],
                "frame_unit": unit,
                "frame_parent": 0,
                "frame_inherit": True,
                "vertices_coords": flat.tolist(),
            }
        ],
    }
    # One key a line: a file that can be read and compared, without a line for each number.
    parts = [f"{json.dumps(key)}: {_json(value)}" for key, value in content.items()]
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _letter(degrees: float) -> str:
    if degrees >= FLAT_DEGREES:
        return "V"
    return "M" if degrees <= -FLAT_DEGREES else "U"


def _edges(polygons: list[list[int]]) -> tuple[IntArray, IntArray]:
    """(E,2) edges of the faces, the smaller vertex first, sorted, and (E,) how many faces have each."""
    if not polygons:
        return np.zeros((0, 2), np.int64), np.zeros(0, np.int64)
    start = np.concatenate([np.asarray(face, np.int64) for face in polygons])
    end = np.concatenate([np.roll(np.asarray(face, np.int64), -1) for face in polygons])
    both = np.sort(np.stack([start, end], axis=1), axis=1)
    edges, uses = np.unique(both, axis=0, return_counts=True)
    return edges.astype(np.int64), uses.astype(np.int64)


def _find(edges: IntArray, pairs: IntArray) -> list[int]:
    """The place of each of ``pairs`` in ``edges``."""
    place = {(a, b): k for k, (a, b) in enumerate(edges.tolist())}
    found: list[int] = []
    for a, b in np.sort(pairs, axis=1).tolist():
        if (a, b) not in place:
            raise ValueError(f"crease edge ({a}, {b}) is not an edge of any face")
        found.append(place[a, b])
    if len(set(found)) != len(found):
        raise ValueError("a crease edge is given twice")
    return found
