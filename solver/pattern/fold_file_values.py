"""Lists of a FOLD file -> checked arrays. Elements in errors are named as the file counts them, from 0."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import PatternError, ReadError
from .segments import MAX_COORDINATE

#: FOLD's letters (FOLD 1.2, edges_assignment), the one that counts first where an edge is given twice.
LETTERS = "BCMVUJF"
#: An edge folded by less than this is flat, degrees (as the writer has it).
_FLAT_DEGREES = 1e-3
#: Numbers of creases above this are no numbers of creases.
_MAX_CREASE = 1_000_000


@dataclass(frozen=True, eq=False)
class Rows:
    """Lists of vertices: all their indices in one array, how many each has, and its place in the file."""

    vertices: IntArray
    lengths: IntArray
    places: IntArray


def coordinates(rows: Any) -> FloatArray:
    """(N,3) of ``vertices_coords``: z = 0 where there is none, NaN for null. Raises ReadError, PatternError."""
    if not isinstance(rows, list):
        raise ReadError("it is not a list", element="vertices_coords")
    if not rows:
        raise PatternError("it has no point", element="vertices_coords")
    lengths = {len(row) if type(row) is list else -1 for row in rows}
    if lengths <= {2} or lengths <= {3}:
        flat = list(chain.from_iterable(rows))
        if set(map(type, flat)) <= {float, int} and all(-MAX_COORDINATE <= v <= MAX_COORDINATE for v in flat):
            array = np.array(flat, dtype=np.float64).reshape(len(rows), -1)
            return array if array.shape[1] == 3 else np.column_stack([array, np.zeros(len(array))])
    return np.array([_point(row, k) for k, row in enumerate(rows)], dtype=np.float64).reshape(-1, 3)


def _point(row: Any, index: int) -> tuple[float, float, float]:
    if row is None:
        return np.nan, np.nan, np.nan
    place = f"vertices_coords[{index}]"
    if type(row) is not list or len(row) not in (2, 3) or not all(type(v) in (int, float) for v in row):
        raise ReadError("it is not two or three numbers", element=place)
    if not all(-MAX_COORDINATE <= v <= MAX_COORDINATE for v in row):
        raise PatternError("a coordinate is not finite, or beyond all bounds", element=place)
    return float(row[0]), float(row[1]), float(row[2]) if len(row) == 3 else 0.0


def index_rows(rows: Any, key: str, least: int, most: int | None) -> Rows:
    """Lists of ``least`` to ``most`` vertices; null is left out. Raises ReadError."""
    if not isinstance(rows, list):
        raise ReadError("it is not a list", element=key)
    places = [k for k, row in enumerate(rows) if row is not None]
    kept = rows if len(places) == len(rows) else [rows[k] for k in places]
    for k, row in zip(places, kept, strict=True):
        if type(row) is not list or len(row) < least or (most is not None and len(row) > most):
            wanted = f"{least}" if most == least else f"{least} or more"
            raise ReadError(f"it is not a list of {wanted} vertices", element=f"{key}[{k}]")
    lengths = np.array([len(row) for row in kept], dtype=np.int64)
    flat = list(chain.from_iterable(kept))
    limit = 2**53  # above, floats are no whole numbers any more; and far above what a file may hold
    whole = set(map(type, flat)) <= {int} and all(-limit < v < limit for v in flat)
    if not whole:
        flat = [_whole(v, limit) for v in flat]
        if None in flat:
            bad = int(np.searchsorted(np.cumsum(lengths), flat.index(None), side="right"))
            raise ReadError("a vertex of it is not a whole number", element=f"{key}[{places[bad]}]")
    return Rows(np.array(flat, dtype=np.int64), lengths, np.array(places, dtype=np.int64))


def _whole(value: Any, limit: int) -> int | None:
    if type(value) not in (int, float) or not -limit < value < limit or value != int(value):
        return None
    return int(value)


def counted_from(count: int, *lists: IntArray) -> int:
    """0, or 1 when the vertices of all lists fit only so: some programs count from one."""
    used = [vertices for vertices in lists if len(vertices)]
    if not used:
        return 0
    return int(max(v.max() for v in used) == count and min(v.min() for v in used) >= 1)


def check_vertices(rows: Rows, key: str, count: int) -> None:
    """Raises PatternError naming the first row with a vertex that is none."""
    bad = np.flatnonzero((rows.vertices < 0) | (rows.vertices >= count))
    if len(bad):
        row = int(np.searchsorted(np.cumsum(rows.lengths), bad[0], side="right"))
        raise PatternError(
            f"vertex {rows.vertices[bad[0]]} does not exist: there are {count:,}, counted from 0",
            element=f"{key}[{rows.places[row]}]",
        )


def letters(values: Any, places: IntArray) -> tuple[Any, list[str]]:
    """(E,) one of LETTERS for each edge, "" where the file has none, and notes. Raises ReadError."""
    if values is None:
        values = []
    if not isinstance(values, list):
        raise ReadError("it is not a list", element="edges_assignment")
    notes = []
    strange: Counter[str] = Counter()
    given = [values[k] if k < len(values) else None for k in places.tolist()]
    found = []
    for value in given:
        letter = "" if value is None else value.strip().upper() if isinstance(value, str) else "?"
        if len(letter) != 1 or letter not in LETTERS:
            if value is not None:
                strange[" ".join(repr(value)[:20].split())] += 1
            letter = ""
        found.append(letter)
    if any(isinstance(value, str) and value.islower() for value in given):
        notes.append("assignments in small letters are read as capitals")
    if strange:
        words = ", ".join(word for word, _ in strange.most_common(4))
        notes.append(f"{_edges(strange.total())} with an unknown assignment ({words}) count as unassigned")
    missing = sum(value is None for value in given)
    if values and missing:
        notes.append(f"{_edges(missing)} without an assignment count as unassigned")
    return np.array(found, dtype="<U1").reshape(-1), notes


def angles(values: Any, places: IntArray) -> FloatArray:
    """(E,) fold angles in degrees, NaN where the file has none."""
    found = np.full(len(places), np.nan)
    if isinstance(values, list):
        for k, place in enumerate(places.tolist()):
            value: Any = values[place] if place < len(values) else None
            if type(value) in (int, float) and -MAX_COORDINATE < value < MAX_COORDINATE:
                found[k] = value
    return found


def letters_of_angles(letter: Any, degrees: FloatArray) -> Any:
    """``letter`` with M and V where it is missing or U and the angle says so: valley positive (FOLD 1.2)."""
    known = np.abs(np.nan_to_num(degrees)) >= _FLAT_DEGREES
    open_ = (letter == "") | (letter == "U")
    result = letter.copy()
    result[open_ & known & (degrees > 0)] = "V"
    result[open_ & known & (degrees < 0)] = "M"
    # Where angles alone say what is folded, what is not folded is a line of the mesh.
    if known.any():
        result[(letter == "") & ~known & ~np.isnan(degrees)] = "F"
    return result


def crease_numbers(values: Any, places: IntArray) -> IntArray:
    """(E,) which crease each edge belongs to (this project's own key), -1 where it says nothing."""
    found = np.full(len(places), -1, dtype=np.int64)
    if isinstance(values, list):
        for k, place in enumerate(places.tolist()):
            value = values[place] if place < len(values) else None
            if type(value) is int and 0 <= value < _MAX_CREASE:
                found[k] = value
    return found


def _edges(count: int) -> str:
    return "1 edge" if count == 1 else f"{count:,} edges"
