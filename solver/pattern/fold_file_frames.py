"""The JSON of a FOLD file, read safely, and which of its frames is the flat drawing."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from ..arrays import FloatArray, IntArray
from ..errors import PatternError, ReadError
from .fold_file_values import check_vertices, coordinates, index_rows

#: Values of a file, counted by their commas and brackets before it is parsed; each takes 80 bytes at most then.
#: A mesh of 100,000 vertices, folded and flat, has about three million.
MAX_VALUES = 5_000_000
#: An object is as large as so many other values.
_OBJECT = 4
#: Frames of a file; an animation has hundreds.
MAX_FRAMES = 10_000
#: Frames that inherit from each other in a row; real files have two.
MAX_PARENTS = 100
#: Vertices farther than this from their plane, relative to the drawing's longer side, are not flat.
_FLAT = 1e-4
#: Faces of less than this part of the mean area have no width.
_NO_WIDTH = 1e-6
#: Faces are made smaller by this part of their root of area before they are said to lie on each other: rounding.
_ROUNDING = 1e-6
#: Shapes that are compared with all others at once: bounds the memory, not the result.
_AT_ONCE = 64
#: What says how a frame lies.
_SHAPE = ("vertices_coords", "faces_vertices", "edges_vertices")
#: How much of a file's words messages and notes repeat.
_WORDS = 60


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame of a file. coordinates: (N,2), NaN where the file has null; notes: why it was chosen."""

    file: FoldFile
    index: int
    coordinates: FloatArray
    notes: tuple[str, ...]

    def get(self, key: str) -> Any:
        return self.file.get(self.index, key)


class FoldFile:
    """The frames of a file: 0 is the file's own, the others are those of ``file_frames``."""

    def __init__(self, top: dict[str, Any]) -> None:
        listed = top.get("file_frames")
        if listed is None:
            listed = []
        if not isinstance(listed, list):
            raise ReadError("it is not a list", element="file_frames")
        if len(listed) >= MAX_FRAMES:
            raise ReadError(f"it has {len(listed):,} frames, and more than {MAX_FRAMES:,} are not read")
        self._frames = [top, *(frame if isinstance(frame, dict) else {} for frame in listed)]
        self._flat: dict[int, FloatArray | PatternError] = {}

    def __len__(self) -> int:
        return len(self._frames)

    def get(self, index: int, key: str) -> Any:
        """A value of a frame, or of the frame that it inherits from; None when there is none."""
        for frame in self._lineage(index):
            if frame.get(key) is not None:
                return frame[key]
        return None

    def words(self, index: int, key: str) -> list[str]:
        """A list of words, such as frame_classes."""
        value = self.get(index, key)
        values = value if isinstance(value, list) else [value]
        return [word for word in values if isinstance(word, str)]

    def flat(self, index: int) -> FloatArray:
        """(N,2) the coordinates of a frame. Raises PatternError when they are not flat, ReadError when none."""
        rows = self.get(index, "vertices_coords")
        # Many frames may inherit the same list, which is looked at once.
        if id(rows) not in self._flat:
            try:
                self._flat[id(rows)] = _in_plane(coordinates(rows))
            except PatternError as error:
                self._flat[id(rows)] = error
        found = self._flat[id(rows)]
        if isinstance(found, PatternError):
            raise found
        return found

    def _lineage(self, index: int) -> Iterator[dict[str, Any]]:
        seen: list[int] = []
        while True:
            if index in seen:
                raise ReadError("it inherits from itself", element=_place(seen[0]))
            if len(seen) == MAX_PARENTS:
                raise ReadError(f"more than {MAX_PARENTS} frames inherit from each other", element=_place(seen[0]))
            seen.append(index)
            frame = self._frames[index]
            yield frame
            if frame.get("frame_inherit") is not True:
                return
            parent = frame.get("frame_parent", 0)
            if type(parent) is not int or not 0 <= parent < len(self._frames):
                raise ReadError("its frame_parent is not one of the file's frames", element=_place(index))
            index = parent


def parse_fold(data: bytes | str) -> FoldFile:
    """The frames of a file's text. Raises ReadError."""
    if not data.strip():
        raise ReadError("the file is empty")
    if isinstance(data, str):
        values = data.count(",") + data.count("[") + _OBJECT * data.count("{")
    else:
        values = data.count(b",") + data.count(b"[") + _OBJECT * data.count(b"{")
    if values > MAX_VALUES:
        raise ReadError(f"it has about {values:,} values, and more than {MAX_VALUES:,} are not read")
    try:
        top = json.loads(data.removeprefix("\ufeff") if isinstance(data, str) else data)
    except json.JSONDecodeError as error:
        raise ReadError(f"this is not JSON ({error.msg} in line {error.lineno})") from error
    except RecursionError:
        raise ReadError("this is not a FOLD file: its lists are nested too deep") from None
    except ValueError as error:  # not UTF-8, or a number of thousands of digits
        raise ReadError(f"this is not JSON ({error})") from error
    if not isinstance(top, dict):
        raise ReadError("this is JSON but not a FOLD file, which is an object with named lists")
    return FoldFile(top)


def choose_frame(file: FoldFile, folded_too: bool = True) -> Frame:
    """The frame to read: the first crease pattern, or else the first flat frame that is no folded form.

    folded_too: or else a folded form that is not folded yet, as simulators write it before they start: it is flat
    and no part of it lies on another. Raises ReadError and PatternError.
    """
    marked: list[int] = []
    others: list[int] = []
    folded: list[int] = []
    refused: list[PatternError | ReadError] = []
    for index in range(len(file)):
        try:
            classes = file.words(index, "frame_classes")
            if file.get(index, "vertices_coords") is None:
                continue
        except ReadError as error:
            refused.append(error)
            continue
        if "creasePattern" in classes:
            marked.append(index)
        elif "foldedForm" in classes:
            folded.append(index)
        else:
            others.append(index)
    for index in (*marked, *others):
        try:
            if not (file.get(index, "edges_vertices") or file.get(index, "faces_vertices")):
                refused.append(
                    PatternError("it has neither edges_vertices nor faces_vertices", element=_place(index))
                )
                continue
            return Frame(file, index, file.flat(index), _said(file, index))
        except (PatternError, ReadError) as error:
            refused.append(error)
    tried: set[tuple[int, ...]] = set()
    for index in folded if folded_too else ():
        with contextlib.suppress(PatternError, ReadError):
            # Many frames may inherit the same lists.
            same = tuple(id(file.get(index, key)) for key in _SHAPE)
            if same in tried:
                continue
            tried.add(same)
            flat = file.flat(index)
            if _lies_open(file, index, flat):
                note = "the folded form lies flat with no part on another, and was read as the crease pattern"
                return Frame(file, index, flat, (*_said(file, index), note))
    if refused:
        raise refused[0]
    if folded:
        raise PatternError("it holds only a folded form, and a drawing is flat: save the crease pattern as well")
    raise PatternError("the drawing has no line: no frame has vertices_coords")


def _lies_open(file: FoldFile, index: int, points: FloatArray) -> bool:
    """Whether no face of a flat frame lies on another; without faces, whether no edge crosses another."""
    faces = index_rows(file.get(index, "faces_vertices") or [], "faces_vertices", 3, None)
    edges = index_rows(file.get(index, "edges_vertices") or [], "edges_vertices", 2, 2)
    check_vertices(faces, "faces_vertices", len(points))
    check_vertices(edges, "edges_vertices", len(points))
    if len(faces.lengths):
        rings = np.repeat(np.arange(len(faces.lengths)), faces.lengths)
        polygons = shapely.polygons(shapely.linearrings(points[faces.vertices], indices=rings))
        # A face of no width, as triangulations have them, lies on nothing; one that crosses itself does.
        areas = shapely.area(polygons)
        polygons = polygons[areas > _NO_WIDTH * float(areas.mean())]
        return bool(shapely.is_valid(polygons).all()) and not _overlap(polygons)
    lines = shapely.linestrings(points[edges.vertices].reshape(-1, 2, 2))
    return bool(len(lines)) and all(not len(pairs[0]) for pairs in _pairs(lines, lines, "crosses"))


def _overlap(polygons: Any) -> bool:
    """Whether any of the faces (F,) lie on each other. A face with another one amid it is one with a hole."""
    smaller = shapely.buffer(polygons, -_ROUNDING * np.sqrt(shapely.area(polygons)))
    for one, other in _pairs(polygons, smaller, "intersects"):
        one, other = one[one != other], other[one != other]
        apart = shapely.contains_properly(polygons[other], polygons[one]) | shapely.contains_properly(
            polygons[one], polygons[other]
        )
        if not apart.all():
            return True
    return False


def _pairs(shapes: Any, others: Any, predicate: str) -> Iterator[tuple[IntArray, IntArray]]:
    """Index pairs of ``others`` and what they meet of ``shapes``, a few at a time: the first may be enough."""
    tree = shapely.STRtree(shapes)
    for start in range(0, len(others), _AT_ONCE):
        one, other = tree.query(others[start : start + _AT_ONCE], predicate=predicate)
        yield one + start, other


def _said(file: FoldFile, index: int) -> tuple[str, ...]:
    if len(file) == 1:
        return ()
    title = file.get(index, "frame_title")
    named = f" ({' '.join(title[:_WORDS].split())})" if index and isinstance(title, str) else ""
    why = "a crease pattern" if "creasePattern" in file.words(index, "frame_classes") else "flat"
    return (f"frame {index + 1} of {len(file)}{named} was read: it is {why}",)


def _place(index: int) -> str:
    return f"file_frames[{index - 1}]" if index else "the file's own frame"


def _in_plane(points: FloatArray) -> FloatArray:
    """(N,2) of (N,3): seen from the positive side of the axis along which they do not differ."""
    known = points[~np.isnan(points).any(axis=1)]
    if not len(known):
        raise PatternError("it has no point", element="vertices_coords")
    low, high = known.min(axis=0), known.max(axis=0)
    limit = _FLAT * float((high - low).max())
    if high[2] - low[2] <= limit:
        return points[:, :2]
    # Programs with y up put their flat paper on the floor.
    if high[1] - low[1] <= limit:
        return np.column_stack([points[:, 0], -points[:, 2]])
    if high[0] - low[0] <= limit:
        return points[:, 1:]
    middle = 0.5 * (low[2] + high[2])
    worst = int(np.nanargmax(np.abs(points[:, 2] - middle)))
    raise PatternError(
        "the drawing is not flat: this vertex is out of the plane of others",
        element=f"vertices_coords[{worst}]",
        place=tuple(points[worst]),
    )
