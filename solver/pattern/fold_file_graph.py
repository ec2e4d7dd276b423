"""Vertices and edges of a frame, mended: what was drawn twice is one, what all but meets is joined."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import PatternError
from .fold_file_frames import Frame
from .fold_file_values import (
    LETTERS,
    Rows,
    angles,
    check_vertices,
    counted_from,
    crease_numbers,
    index_rows,
    letters,
    letters_of_angles,
)
from .rings import JOIN, meeting_places
from .segments import MAX_POINTS, STRAIGHT

#: Letters of edges that are lines of the drawing; the others are lines of a mesh.
DRAWN = ("B", "C", "M", "V", "U")
#: Contradictions that are told one by one.
_MOST_SAID = 20
#: Smaller drawings cannot be squared.
_LEAST_SIZE = 1e-100


@dataclass(frozen=True, eq=False)
class EdgeGraph:
    """The edges of a drawing.

    points  (N,2) vertices, drawing units
    ends    (E,2) indices of vertices
    letter  (E,) one of LETTERS for each edge
    number  (E,) which crease the writer says that it belongs to, -1 unknown
    size    longer side of the drawing
    notes   what was mended
    conflicts  edges that are given as M and as V, in words; they are unassigned
    """

    points: FloatArray
    ends: IntArray
    letter: Any
    number: IntArray
    size: float
    notes: tuple[str, ...]
    conflicts: tuple[str, ...]


def edge_graph(frame: Frame) -> EdgeGraph:
    """The edges of a frame. Raises ReadError and PatternError."""
    points, notes = frame.coordinates, []
    count = len(points)
    edges = index_rows(frame.get("edges_vertices") or [], "edges_vertices", 2, 2)
    faces = index_rows(frame.get("faces_vertices") or [], "faces_vertices", 3, None)
    if first := counted_from(count, edges.vertices, faces.vertices):
        edges, faces = (replace(rows, vertices=rows.vertices - first) for rows in (edges, faces))
        notes.append("vertices are counted from 1 in this file")
    check_vertices(edges, "edges_vertices", count)
    check_vertices(faces, "faces_vertices", count)
    _check_known(points, edges, "edges_vertices")
    _check_known(points, faces, "faces_vertices")
    same = _same_places(points)
    edges, faces = (replace(rows, vertices=same[rows.vertices]) for rows in (edges, faces))
    sides, uses = _sides(faces, count)
    if len(edges.lengths):
        ends = edges.vertices.reshape(-1, 2)
        letter, said = letters(frame.get("edges_assignment"), edges.places)
        notes += said
        degrees = frame.get("edges_foldAngle") or frame.get("edges_foldAngles")  # FOLD 1.2, and 1.0
        letter = letters_of_angles(letter, angles(degrees, edges.places))
        number = crease_numbers(frame.get("edges_curvefold:crease"), edges.places)
    else:
        ends, number = sides, np.full(len(sides), -1, dtype=np.int64)
        letter = np.full(len(sides), "", dtype="<U1")
        notes.append("the edges are those of the faces, since the file lists none")
    if not (letter == "B").any() and len(sides):
        lonely = np.isin(_keys(ends, count), _keys(sides[uses == 1], count))
        letter = np.where(lonely, "B", letter)
        notes.append("the border is where a single face ends, since no edge says that it is one")
    letter = np.where(letter == "", "U", letter)
    return _mended(points, ends, letter, number, notes)


def _keys(ends: IntArray, count: int) -> IntArray:
    """(E,) one number for each pair of vertices, in either direction."""
    return np.asarray(ends.min(axis=1) * count + ends.max(axis=1), dtype=np.int64)


def _sides(faces: Rows, count: int) -> tuple[IntArray, IntArray]:
    """(S,2) sides of the faces, and how many faces have each."""
    if not len(faces.vertices):
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=np.int64)
    after = np.roll(faces.vertices, -1)
    last = np.cumsum(faces.lengths) - 1
    after[last] = faces.vertices[last - faces.lengths + 1]
    keys, uses = np.unique(_keys(np.column_stack([faces.vertices, after]), count), return_counts=True)
    return np.column_stack([keys // count, keys % count]), uses


def _check_known(points: FloatArray, rows: Rows, key: str) -> None:
    unknown = np.flatnonzero(np.isnan(points[rows.vertices]).any(axis=1))
    if len(unknown):
        row = int(np.searchsorted(np.cumsum(rows.lengths), unknown[0], side="right"))
        raise PatternError("it has a vertex without coordinates", element=f"{key}[{rows.places[row]}]")


def _same_places(points: FloatArray) -> IntArray:
    """(N,) one vertex where several have the same place, up to rounding: faces may have vertices of their own."""
    known = np.flatnonzero(~np.isnan(points).any(axis=1))
    low = points[known].min(axis=0)
    step = STRAIGHT * float((points[known].max(axis=0) - low).max())
    same = np.arange(len(points))
    if step > 0.0:
        cells = np.round((points[known] - low) / step).astype(np.int64)
        _, first, group = np.unique(cells, axis=0, return_index=True, return_inverse=True)
        same[known] = known[first[group.reshape(-1)]]
    return same


def _mended(points: FloatArray, ends: IntArray, letter: Any, number: IntArray, notes: list[str]) -> EdgeGraph:
    used = points[np.unique(ends)]
    low = used.min(axis=0)
    size = float((used.max(axis=0) - low).max())
    if not size > _LEAST_SIZE:
        raise PatternError("the drawing has no size: all its lines are one point")
    drawn = np.isin(letter, DRAWN)
    if int(drawn.sum()) > MAX_POINTS:
        raise PatternError(f"the drawing needs more than {MAX_POINTS:,} points: it has {drawn.sum():,} edges")
    points = np.where(np.isnan(points), low, points)
    letter, conflicts = _contradicted(points, ends, letter)
    notes += [f"{conflict}; it is left unassigned" for conflict in conflicts]
    graph = _tidy(points, ends, letter, number)
    joined = _joined_ends(graph[0], graph[1], graph[2], JOIN * size)
    if joined is not None:
        graph = _tidy(graph[0], joined[graph[1]], graph[2], graph[3])
        notes.append("edges that ended next to each other were joined")
    lost = int(drawn.sum() - np.isin(graph[2], DRAWN).sum())
    if lost:
        notes.append(
            f"{lost:,} {'edge was' if lost == 1 else 'edges were'} left out: given twice, or without length"
        )
    return EdgeGraph(graph[0], graph[1], graph[2], graph[3], size, tuple(notes), conflicts)


def _contradicted(points: FloatArray, ends: IntArray, letter: Any) -> tuple[Any, tuple[str, ...]]:
    """The letters with U for edges that are given both as M and as V, and a sentence for each of these."""
    keys = _keys(ends, len(points))
    both = np.intersect1d(keys[letter == "M"], keys[letter == "V"])
    if not len(both):
        return letter, ()
    sentences = []
    for key in both[:_MOST_SAID].tolist():
        x, y = points[[key // len(points), key % len(points)]].mean(axis=0)
        sentences.append(f"the edge near ({x:.4g}, {y:.4g}) is given as a mountain and as a valley")
    if len(both) > _MOST_SAID:
        sentences.append(f"{len(both) - _MOST_SAID:,} more edges are given as mountains and as valleys")
    return np.where(np.isin(keys, both) & np.isin(letter, ("M", "V")), "U", letter), tuple(sentences)


def _tidy(
    points: FloatArray, ends: IntArray, letter: Any, number: IntArray
) -> tuple[FloatArray, IntArray, Any, IntArray]:
    """Without edges of no length or given twice, in their order; where letters differ, the first of LETTERS."""
    rank = _codes(letter)
    keys = _keys(ends, len(points))
    order = np.lexsort((np.arange(len(keys)), rank, keys))
    order = order[ends[order, 0] != ends[order, 1]]
    first = np.ones(len(order), dtype=bool)
    first[1:] = np.diff(keys[order]) != 0
    kept = np.sort(order[first])
    return points, ends[kept], letter[kept], number[kept]


def _codes(letter: Any) -> IntArray:
    """(E,) places in LETTERS."""
    table = np.array(list(LETTERS))
    order = np.argsort(table)
    return np.asarray(order[np.searchsorted(table[order], letter)], dtype=np.int64)


def _joined_ends(points: FloatArray, ends: IntArray, letter: Any, tolerance: float) -> IntArray | None:
    """(N,) the vertex that each becomes when lines that end next to each other are joined; None when none do."""
    lines = ends[np.isin(letter, DRAWN)]
    loose = np.flatnonzero(np.bincount(lines.ravel(), minlength=len(points)) == 1)
    if len(loose) < 2:
        return None
    label = meeting_places(points[loose], tolerance)
    _, first = np.unique(label, return_index=True)
    if len(first) == len(loose):
        return None
    target = np.arange(len(points))
    target[loose] = loose[first[label]]
    return target
