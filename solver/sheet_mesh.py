"""A folded polygon mesh that knows its flat sheet: what a file or another program can tell of a paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .arrays import FloatArray, IntArray, frozen_array


@dataclass(frozen=True, eq=False)
class SheetMesh:
    """A mesh and its flat sheet. Raises ValueError on shapes and indices that do not fit; numbers may be anything.

    vertices     (R,3) in space, any unit
    face_start   (F+1,) and face_vertices (L,): faces are runs of corners, in order around each face
    corner_flat  (L,2) each corner on the flat sheet, any unit (texture coordinates)
    scale        length in space of one unit of the flat sheet; None when that is not known
    """

    vertices: FloatArray
    face_start: IntArray
    face_vertices: IntArray
    corner_flat: FloatArray
    scale: float | None = None

    def __post_init__(self) -> None:
        def keep(name: str, dtype: type, shape: tuple[int | None, ...]) -> None:
            object.__setattr__(self, name, frozen_array(getattr(self, name), dtype, shape, name))

        keep("vertices", np.float64, (None, 3))
        keep("face_start", np.int64, (None,))
        keep("face_vertices", np.int64, (None,))
        keep("corner_flat", np.float64, (len(self.face_vertices), 2))
        _check_indices("face_vertices", self.face_vertices, len(self.vertices))
        sizes = np.diff(self.face_start)
        if len(sizes) == 0 or self.face_start[0] != 0 or self.face_start[-1] != len(self.face_vertices):
            raise ValueError("face_start does not divide the corners into faces")
        if sizes.min() < 3:
            raise ValueError("a face has fewer than three corners")
        if self.scale is not None and not 0.0 < self.scale < np.inf:
            raise ValueError(f"scale is {self.scale}, expected a positive number")

    @staticmethod
    def from_faces(
        vertices: ArrayLike,
        faces: Sequence[ArrayLike],
        flat: ArrayLike,
        scale: float | None = None,
    ) -> SheetMesh:
        """A sheet in one piece. faces: a list of vertices each; flat: (R,2) of each vertex."""
        loops = [np.asarray(face, dtype=np.int64).ravel() for face in faces]
        corners = np.concatenate(loops) if loops else np.zeros(0, np.int64)
        start = np.concatenate([[0], np.cumsum([len(loop) for loop in loops], dtype=np.int64)])
        points = frozen_array(vertices, np.float64, (None, 3), "vertices")
        places = frozen_array(flat, np.float64, (len(points), 2), "flat")
        _check_indices("faces", corners, len(points))
        return SheetMesh(points, start, corners, places[corners], scale)

    @cached_property
    def face(self) -> IntArray:
        """(L,) the face of each corner."""
        return np.repeat(np.arange(len(self.face_start) - 1), np.diff(self.face_start))

    @cached_property
    def next(self) -> IntArray:
        """(L,) the next corner around the face."""
        after = np.arange(1, len(self.face_vertices) + 1)
        after[self.face_start[1:] - 1] = self.face_start[:-1]
        return after

    @cached_property
    def previous(self) -> IntArray:
        """(L,) the corner before."""
        before = np.empty_like(self.next)
        before[self.next] = np.arange(len(before))
        return before

    @cached_property
    def edge(self) -> IntArray:
        """(L,) a number for the edge from each corner to the next, the same from both of its sides."""
        ends = np.sort(np.column_stack([self.face_vertices, self.face_vertices[self.next]]), axis=1)
        return ends[:, 0] * len(self.vertices) + ends[:, 1]


def _check_indices(name: str, indices: IntArray, count: int) -> None:
    if len(indices) and (indices.min() < 0 or indices.max() >= count):
        raise ValueError(f"{name} has a vertex that does not exist: there are {count}, counted from 0")
