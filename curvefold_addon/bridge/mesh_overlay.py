"""What is drawn over a paper that nobody works on, baked ones among them: from what its mesh shows, without a net.

The angle across a crease is that between the faces beside it, which differs from the measured one by about a
degree.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .drawn import Indices, Label, Lines, Surface
from .mesh import CREASE, FLAT_UV, NO_CREASE
from .overlay import FOLDED_FROM, Array, line_colors, side_color, stretch_colors

Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MeshParts:
    """What a paper's mesh is made of, whatever its shape.

    corners (L,) vertices of the faces, one face after the other, and after (L,) the next one of the same face;
    starts (F,) of the faces in them
    creases (n,2) vertices of the crease edges, with the face that runs along them at the left; crease (n,) which
    one; left, right (n,) the faces; flat (V,2) vertices on the flat sheet; edges (E,2); triangles (T,3)
    """

    corners: Integers
    after: Integers
    starts: Integers
    creases: Integers
    crease: Integers
    left: Integers
    right: Integers
    flat: Array
    edges: Integers
    triangles: Indices


def counts(mesh: Any) -> tuple[int, int, int, int]:
    """Vertices, edges, corners and faces: a mesh with others is made of other parts."""
    return len(mesh.vertices), len(mesh.edges), len(mesh.loops), len(mesh.polygons)


def parts_of(mesh: Any, triangles: Indices) -> MeshParts | None:
    """The parts of a paper's mesh; None when somebody has taken away its marks."""
    marks, flat = mesh.attributes.get(CREASE), mesh.uv_layers.get(FLAT_UV)
    vertices, edges, corners, faces = counts(mesh)
    if marks is None or marks.domain != "EDGE" or flat is None or faces == 0:
        return None
    ends = _read(mesh.edges, "vertices", 2 * edges).reshape(-1, 2)
    crease_of = _read(marks.data, "value", edges)
    corner, edge_of = _read(mesh.loops, "vertex_index", corners), _read(mesh.loops, "edge_index", corners)
    starts = _read(mesh.polygons, "loop_start", faces)
    following = np.arange(corners) + 1
    following[np.append(starts[1:], corners) - 1] = starts
    uv = np.empty(2 * corners, dtype=np.float32)
    flat.uv.foreach_get("vector", uv)
    place = np.zeros((vertices, 2))
    place[corner] = uv.reshape(-1, 2)
    # A crease has a corner on each side, and these run along it in opposite directions.
    face_of = np.repeat(np.arange(faces), np.diff(np.append(starts, corners)))
    on_crease = np.flatnonzero(crease_of[edge_of] != NO_CREASE)
    order = on_crease[np.argsort(edge_of[on_crease], kind="stable")]
    same = np.flatnonzero(edge_of[order[:-1]] == edge_of[order[1:]])
    first, second = order[same], order[same + 1]
    return MeshParts(
        corner,
        corner[following],
        starts,
        np.column_stack([corner[first], corner[following[first]]]),
        crease_of[edge_of[first]],
        face_of[first],
        face_of[second],
        place,
        ends,
        triangles,
    )


def shown_positions(mesh: Any) -> Array:
    """(V,3) the mesh as it is kept; as it is played, where it is baked."""
    if mesh.shape_keys is None:
        values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.attributes["position"].data.foreach_get("vector", values)
        return values.reshape(-1, 3).astype(np.float64)
    keys = mesh.shape_keys
    frames = np.array([block.frame for block in keys.key_blocks])
    after = int(np.clip(np.searchsorted(frames, keys.eval_time), 1, max(1, len(frames) - 1)))
    chosen = [min(k, len(frames) - 1) for k in (after - 1, after)]
    blocks = [np.empty(3 * len(mesh.vertices), dtype=np.float32) for _ in chosen]
    for k, block in zip(chosen, blocks, strict=True):
        keys.key_blocks[k].data.foreach_get("co", block)
    gap = frames[chosen[1]] - frames[chosen[0]]
    part = np.clip((keys.eval_time - frames[chosen[0]]) / gap, 0.0, 1.0) if gap > 0 else 0.0
    mixed: Array = ((1.0 - part) * blocks[0] + part * blocks[1]).reshape(-1, 3)
    return mixed


def same(first: Array, second: Array) -> bool:
    """Whether two shapes are the same."""
    return np.array_equal(first, second)


class MeshShape:
    """One shape of a paper's mesh, positions (V,3): each overlay is computed when it is asked for, and once."""

    def __init__(self, parts: MeshParts, positions: Array) -> None:
        self.parts, self.positions = parts, positions
        self._angles: Array | None = None
        self._done: dict[str, Any] = {}

    @property
    def fold_angles(self) -> Array:
        """(n,) signed angle across each crease edge, degrees, a valley positive."""
        if self._angles is None:
            x, parts = self.positions, self.parts
            normals = np.add.reduceat(np.cross(x[parts.corners], x[parts.after]), parts.starts)
            left, right = _unit(normals[parts.left]), _unit(normals[parts.right])
            along = _unit(x[parts.creases[:, 1]] - x[parts.creases[:, 0]])
            sine, cosine = (along * np.cross(right, left)).sum(1), (left * right).sum(1)
            self._angles = np.degrees(np.arctan2(sine, cosine))
        return self._angles

    def creases(self) -> Lines:
        """The creases, coloured by the side that they are folded to."""
        if "creases" not in self._done:
            points = self.positions[self.parts.creases].reshape(-1, 3)
            colors = line_colors(_sides(self.fold_angles))
            self._done["creases"] = Lines(np.ascontiguousarray(points, dtype=np.float32), colors)
        lines: Lines = self._done["creases"]
        return lines

    def angles(self) -> tuple[Label, ...]:
        """The fold angle of each crease in figures, in its middle."""
        if "angles" not in self._done:
            self._done["angles"] = tuple(self._label(k) for k in np.unique(self.parts.crease))
        labels: tuple[Label, ...] = self._done["angles"]
        return labels

    def stretch(self) -> Surface:
        """How far the paper is stretched."""
        if "stretch" not in self._done:
            parts = self.parts
            flat, now = (
                np.linalg.norm(x[parts.edges[:, 1]] - x[parts.edges[:, 0]], axis=1)
                for x in (parts.flat, self.positions)
            )
            stretch = np.abs(now / np.maximum(flat, 1e-12) - 1).repeat(2)
            count = np.bincount(parts.edges.ravel(), minlength=len(parts.flat))
            total = np.bincount(parts.edges.ravel(), weights=stretch, minlength=len(parts.flat))
            points = np.ascontiguousarray(self.positions, dtype=np.float32)
            self._done["stretch"] = Surface(points, stretch_colors(total / np.maximum(count, 1)), parts.triangles)
        surface: Surface = self._done["stretch"]
        return surface

    def _label(self, crease: int) -> Label:
        parts = self.parts
        mine = np.flatnonzero(parts.crease == crease)
        middles = parts.flat[parts.creases[mine]].mean(axis=1)
        k = mine[np.argmin(np.linalg.norm(middles - middles.mean(axis=0), axis=1))]
        x, y, z = self.positions[parts.creases[k]].mean(axis=0).tolist()
        angle = np.median(self.fold_angles[mine])
        return Label((x, y, z), f"{abs(angle):.0f}°", side_color(int(_sides(angle))))


def _sides(angles: Any) -> Integers:
    """+1 for a valley, -1 for a mountain, 0 for what is not folded."""
    return np.asarray(np.where(np.abs(angles) >= FOLDED_FROM, np.sign(angles), 0), dtype=np.int64)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-300)[:, None])


def _read(collection: Any, name: str, count: int) -> Integers:
    values = np.empty(count, dtype=np.int32)
    collection.foreach_get(name, values)
    return values.astype(np.int64)
