"""Wavefront OBJ -> a mesh with its flat sheet, which its texture coordinates are."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import IO, Any

import numpy as np

from ..errors import CurvefoldError, ReadError
from ..pattern.source import read_source
from ..sheet_mesh import SheetMesh

#: Vertices, texture coordinates or corners of faces of a file; each takes some 100 bytes while it is read.
MAX_ITEMS = 2_000_000


def read_obj_mesh(source: str | os.PathLike[str] | IO[Any]) -> SheetMesh:
    """The mesh in an OBJ file: a path, or an open file.

    All of its faces are one mesh. Raises ReadError, naming the line, when this is not an OBJ file of a mesh with
    texture coordinates.
    """
    data, name = read_source(source)
    try:
        return _Reader().read(data if isinstance(data, str) else _decoded(data))
    except CurvefoldError as error:
        raise (error if name is None else error.in_file(name)) from error


def _decoded(data: bytes) -> str:
    # Names and comments may be in any encoding; what is read here is ASCII.
    return data.decode("utf-8", errors="replace")


class _Reader:
    """What the lines of a file have given so far."""

    def __init__(self) -> None:
        self.vertices: list[tuple[float, ...]] = []
        self.places: list[tuple[float, ...]] = []
        self.corners: list[int] = []
        self.corner_places: list[int] = []
        self.start: list[int] = [0]

    def read(self, text: str) -> SheetMesh:
        for number, line in _lines(text):
            words = line.split()
            if not words:
                continue
            kind, rest = words[0], words[1:]
            if kind == "v":
                self.vertices.append(_numbers(rest, 3, number))
            elif kind == "vt":
                self.places.append(_numbers(rest, 2, number))
            elif kind == "f":
                self._face(rest, number)
            if max(len(self.vertices), len(self.places), len(self.corners)) > MAX_ITEMS:
                raise ReadError(f"it has more than {MAX_ITEMS:,} vertices or corners of faces, which are not read")
        if not self.corners:
            raise ReadError("it has no face")
        places = np.array(self.places)
        return SheetMesh(
            np.array(self.vertices),
            np.array(self.start),
            np.array(self.corners),
            places[np.array(self.corner_places)],
        )

    def _face(self, words: list[str], number: int) -> None:
        if len(words) < 3:
            raise ReadError("a face has fewer than three corners", element=f"line {number}")
        for word in words:
            parts = word.split("/")
            if len(parts) < 2 or not parts[1]:
                raise ReadError(
                    "a face has no texture coordinates, and they are what tells the flat sheet",
                    element=f"line {number}",
                )
            self.corners.append(_index(parts[0], len(self.vertices), number))
            self.corner_places.append(_index(parts[1], len(self.places), number))
        self.start.append(len(self.corners))


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """Lines with their numbers, from 1: comments taken off, those that end in a backslash joined to the next."""
    begun, first = "", 0
    for number, line in enumerate(text.split("\n"), 1):
        first = first if begun else number
        whole = begun + line.partition("#")[0].rstrip()
        if whole.endswith("\\"):
            begun = whole[:-1] + " "
            continue
        begun = ""
        yield first, whole
    if begun:
        yield first, begun


def _numbers(words: list[str], count: int, number: int) -> tuple[float, ...]:
    try:
        values = tuple(map(float, words[:count]))
    except ValueError:
        values = ()
    if len(values) < count:
        raise ReadError(f"{count} numbers are expected", element=f"line {number}")
    return values


def _index(word: str, count: int, number: int) -> int:
    """From 0. The file counts from 1, or backwards from the newest with -1."""
    try:
        value = int(word)
    except ValueError:
        value = 0
    index = value - 1 if value > 0 else count + value
    if not 0 <= index < count:
        raise ReadError(
            f"a face names {word[:20]!r}, and there are {count} of these so far", element=f"line {number}"
        )
    return index
