"""What is drawn in a DXF file: its entities, and those of the blocks that it refers to, placed and looked at."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..dxf_library import dxf_library
from ..errors import PatternError
from .drawn_lines import DrawnLine, too_many
from .dxf_looks import Look, Looks
from .dxf_shapes import KINDS, subpaths_of
from .sheets import MAX_STROKES

#: Entities of a drawing, those of blocks counted as often as they are drawn.
MAX_ENTITIES = 200_000
#: How deep blocks may refer to blocks; real drawings stay below 10.
MAX_NESTED = 30
#: Names of layers and kinds that one note repeats.
_MOST_NAMED = 5
#: Characters of such a name.
_NAME_LENGTH = 60
#: Attributes of a block's reference are texts, and belong to it.
_SILENT = frozenset({"ATTDEF", "ATTRIB", "SEQEND", "VIEWPORT"})


@dataclass(frozen=True, eq=False)
class Walked:
    """lines: as they are drawn; notes: what was left out."""

    lines: tuple[DrawnLine, ...]
    notes: tuple[str, ...]


def walk(document: Any, entities: Iterable[Any]) -> Walked:
    """Everything that is drawn by some entities. Raises PatternError: too many, nested too deep."""
    walker = _Walker(document)
    walker.draw(entities)
    return Walked(tuple(walker.lines), tuple(walker.notes()))


@dataclass(frozen=True, eq=False)
class _Place:
    """Where a block's entities go, how they look, and the blocks around them."""

    matrix: FloatArray
    look: Look
    inside: tuple[str, ...] = ()


class _Walker:
    """Not reusable."""

    def __init__(self, document: Any) -> None:
        self._looks = Looks(document)
        self._blocks = document.blocks
        self._count = 0
        self._left_out: Counter[str] = Counter()
        self._hidden: Counter[str] = Counter()
        self._wrong: Counter[str] = Counter()
        self.lines: list[DrawnLine] = []

    def draw(self, entities: Iterable[Any]) -> None:
        # A stack of what is still to come, so that nothing recurses however deep blocks refer to blocks.
        start = _Place(np.eye(4), Look())
        waiting: list[Iterator[tuple[Any, _Place]]] = [((entity, start) for entity in entities)]
        while waiting:
            following = next(waiting[-1], None)
            if following is None:
                waiting.pop()
                continue
            entity, place = following
            self._count += 1
            if self._count > MAX_ENTITIES:
                raise PatternError(
                    f"the drawing has more than {MAX_ENTITIES:,} entities, those of its blocks counted"
                )
            kind = entity.dxftype()
            if kind in _SILENT:
                continue
            if kind != "INSERT" and kind not in KINDS:
                self._left_out[kind[:_NAME_LENGTH]] += 1
                continue
            look = self._looks.of(entity, place.look)
            if entity.dxf.get("invisible", 0):
                self._hidden["invisible"] += 1
            elif kind == "INSERT":
                waiting.append(self._referred(entity, place, look))
            elif self._looks.frozen(look):
                self._hidden[_on_layer(look, "frozen")] += 1
            elif self._looks.off(look):
                self._hidden[_on_layer(look, "off")] += 1
            else:
                self._draw(entity, place, look)

    def _draw(self, entity: Any, place: _Place, look: Look) -> None:
        name = f"{entity.dxftype()} {entity.dxf.get('handle', '')}".strip()
        try:
            subpaths = subpaths_of(entity, place.matrix)
        except (PatternError, ArithmeticError, ValueError, TypeError, dxf_library().DXFError) as error:
            reason = error.message if isinstance(error, PatternError) else "its numbers are wrong"
            self._wrong[f"{entity.dxftype()} left out: {reason}"] += 1
            return
        evidence = self._looks.evidence(look)
        self.lines.extend(DrawnLine(subpath, evidence, name) for subpath in subpaths)
        if len(self.lines) > MAX_STROKES:
            raise too_many(tuple(self.notes()))

    def _referred(self, insert: Any, place: _Place, look: Look) -> Iterator[tuple[Any, _Place]]:
        """The entities of the block that an INSERT refers to, once for each place of its rows and columns."""
        name = str(insert.dxf.get("name", ""))
        block = self._blocks.get(name)
        if self._looks.frozen(look):
            self._hidden[_on_layer(look, "frozen")] += 1
            return
        if block is None:
            self._wrong[f"INSERT left out: the file has no block {name[:_NAME_LENGTH]!r}"] += 1
            return
        if name.casefold() in place.inside or len(place.inside) == MAX_NESTED:
            raise PatternError(
                f"its blocks refer to each other in a circle, or more than {MAX_NESTED} deep",
                element=name[:_NAME_LENGTH],
            )
        words = (("block name", name), ("layer of its block", look.layer), *look.words)
        within = replace(look, words=words)
        inside = (*place.inside, name.casefold())
        for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
            self._count += 1
            own = np.array(tuple(one.matrix44()), dtype=np.float64).reshape(4, 4)
            there = _Place(own @ place.matrix, within, inside)
            for entity in block:
                yield entity, there

    def notes(self) -> Iterator[str]:
        if self._left_out:
            kinds = _named(f"{count:,} {kind}" for kind, count in self._left_out.items())
            yield f"left out, since only lines and curves are read: {kinds}"
        for where, count in list(self._hidden.items())[:_MOST_NAMED]:
            yield f"{_entities(count)} {where}: left out"
        if len(self._hidden) > _MOST_NAMED:
            yield f"more was left out on {len(self._hidden) - _MOST_NAMED:,} layers that are off or frozen"
        for what, count in list(self._wrong.items())[:_MOST_NAMED]:
            yield f"{count:,} {what}"


def _on_layer(look: Look, state: str) -> str:
    """Names of layers are the same in large and small letters."""
    return f"on layer {look.layer[:_NAME_LENGTH].casefold()!r}, which is {state}"


def _named(parts: Iterable[str]) -> str:
    every = list(parts)
    more = len(every) - _MOST_NAMED
    return ", ".join(every[:_MOST_NAMED]) + (f" and {more} other kinds" if more > 0 else "")


def _entities(count: int) -> str:
    return "1 entity" if count == 1 else f"{count:,} entities"
