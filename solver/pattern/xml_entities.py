"""Entities that an XML file declares, with a bound on what they make of it."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass

from ..errors import ReadError

#: Entities of one file, and how deep they may stand in each other. Old Illustrator declares a dozen.
MAX_ENTITIES = 500
_MAX_NESTED = 20
#: Characters that one entity may stand for, and all that are referred to in a file together.
MAX_ENTITY = 100_000
MAX_EXPANSION = 2_000_000

_REFERENCE = re.compile(r"&([^\s&;#<>\"'][^\s&;<>\"']{0,200});")


@dataclass
class _Entity:
    length: int
    references: Counter[str]


class Entities:
    """What is declared so far."""

    def __init__(self) -> None:
        self._known: dict[str, _Entity] = {}
        self._total = 0

    def __bool__(self) -> bool:
        return bool(self._known)

    def declare(self, name: str, value: str) -> None:
        """Raises ReadError when it, or one that refers to it, stands for too much."""
        if name in self._known:
            return  # the first declaration counts
        self._total += len(value)
        if len(self._known) == MAX_ENTITIES or self._total > MAX_EXPANSION:
            raise ReadError(f"the file declares too many XML entities (more than {MAX_ENTITIES}, or too long ones)")
        self._known[name] = _Entity(len(value), Counter(_REFERENCE.findall(value)))
        sizes: dict[str, int] = {}
        for each in self._known:
            self._size(each, sizes, ())

    def check(self, text: str) -> None:
        """Whether all that ``text`` refers to may be put in its place. Raises ReadError."""
        sizes: dict[str, int] = {}
        total = 0
        for match in _REFERENCE.finditer(text):
            if match.group(1) in self._known:
                total += self._size(match.group(1), sizes, ())
                if total > MAX_EXPANSION:
                    raise ReadError(
                        f"the file's XML entities stand for more than {MAX_EXPANSION:,} characters together"
                    )

    def _size(self, name: str, sizes: dict[str, int], inside: tuple[str, ...]) -> int:
        """Characters that an entity stands for, in the end."""
        size = sizes.get(name)
        if size is not None:
            return size
        entity = self._known.get(name)
        if entity is None:
            return 0
        if name in inside:
            raise ReadError(f"the file's XML entity {name[:40]!r} refers to itself")
        if len(inside) == _MAX_NESTED:
            raise ReadError(f"the file's XML entities refer to each other more than {_MAX_NESTED} deep")
        size = entity.length
        for other, count in entity.references.items():
            size += count * self._size(other, sizes, (*inside, name))
            if size > MAX_ENTITY:
                break
        if size > MAX_ENTITY:
            raise ReadError(f"the file's XML entity {name[:40]!r} stands for more than {MAX_ENTITY:,} characters")
        sizes[name] = size
        return size
