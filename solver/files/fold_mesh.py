"""FOLD files -> a mesh with its flat sheet: the folded form, and the crease pattern of the same vertices."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import IO, Any

import numpy as np

from ..arrays import FloatArray
from ..errors import CurvefoldError, ReadError
from ..pattern.fold_file_frames import FoldFile, choose_frame, parse_fold
from ..pattern.fold_file_values import check_vertices, coordinates, counted_from, index_rows
from ..pattern.source import read_source
from ..sheet_mesh import SheetMesh


def read_fold_mesh(source: str | os.PathLike[str] | IO[Any]) -> SheetMesh:
    """The folded sheet in a FOLD file: a path, or an open file.

    The flat sheet is the frame that ``read_fold`` would read, the folded one is the first called ``foldedForm``
    that has other coordinates; both have the same vertices, and are in the same unit. Raises ReadError and
    PatternError when there is no such pair.
    """
    data, name = read_source(source)
    try:
        return _mesh(parse_fold(data))
    except CurvefoldError as error:
        raise (error if name is None else error.in_file(name)) from error


def _mesh(file: FoldFile) -> SheetMesh:
    sheet = choose_frame(file, folded_too=False)
    flat = sheet.coordinates
    folded, vertices = _folded(file, sheet.index)
    if len(vertices) != len(flat):
        raise ReadError(
            f"its folded form has {len(vertices)} vertices and its crease pattern {len(flat)}, "
            "which have to be the same ones"
        )
    faces = index_rows(file.get(folded, "faces_vertices") or [], "faces_vertices", 3, None)
    if not len(faces.lengths):
        raise ReadError("its folded form has no faces", element="faces_vertices")
    faces = replace(faces, vertices=faces.vertices - counted_from(len(vertices), faces.vertices))
    check_vertices(faces, "faces_vertices", len(vertices))
    start = np.concatenate([[0], np.cumsum(faces.lengths)])
    same = file.get(folded, "frame_unit") == file.get(sheet.index, "frame_unit")
    return SheetMesh(vertices, start, faces.vertices, flat[faces.vertices], 1.0 if same else None)


def _folded(file: FoldFile, sheet: int) -> tuple[int, FloatArray]:
    """The folded form's frame and its coordinates (N,3), NaN where the file has null."""
    flat = file.get(sheet, "vertices_coords")
    for index in range(len(file)):
        rows = file.get(index, "vertices_coords")
        if rows is not None and rows is not flat and "foldedForm" in file.words(index, "frame_classes"):
            return index, coordinates(rows)
    raise ReadError("it has no frame called foldedForm beside its crease pattern")
