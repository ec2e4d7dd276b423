"""From a frame's edges to a sheet: border, holes, creases, and a sentence for every decision."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from ..arrays import BoolArray, IntArray
from ..errors import PatternError
from .crease_pattern import Crease, CreasePattern
from .fold_file_chains import Path, joined_as_creases, joined_by_pairs, without_straight
from .fold_file_graph import DRAWN, EdgeGraph
from .fold_file_values import count_edges
from .rings import JOIN, Ring, curve_line, outer_rings, share_inside, touching_groups
from .segments import MAX_POINTS, Curve
from .sheets import MAX_HOLES, MAX_STROKES

#: How much of the creases (by length) the border must hold.
_SHARE = 0.5
_CREASES = ("M", "U", "V")
#: What border and holes are marked with once they are found.
_BORDER, _HOLE = "b", "h"
_WORDS = {"M": "mountain", "V": "valley", "U": "unassigned"}


def make_pattern(graph: EdgeGraph, unit_mm: float | None, notes: Sequence[str]) -> CreasePattern:
    """The crease pattern that edges mean. Raises PatternError: no border, no crease, too many of them."""
    return _Sheet(graph, list(notes)).pattern(unit_mm)


class _Sheet:
    """The decisions about one frame, step by step. Not reusable."""

    def __init__(self, graph: EdgeGraph, notes: list[str]) -> None:
        self._graph = graph
        self._letter = graph.letter.copy()
        self._notes = notes
        self._tolerance = JOIN * graph.size

    def pattern(self, unit_mm: float | None) -> CreasePattern:
        sheet = self._border()
        holes = self._holes(sheet)
        creases = self._creases(sheet, holes)
        if len(self._with("F", "J")):
            self._notes.append(
                f"{count_edges(self._letter, 'FJ')} left out: flat or joined, lines of a mesh and no creases"
            )
        border = without_straight(sheet.points, True)
        return CreasePattern(
            border,
            [without_straight(hole.points, True) for hole in holes],
            creases,
            unit_mm=unit_mm,
            notes=self._notes,
        )

    # ---- small helpers

    def _with(self, *letters: str) -> IntArray:
        return np.flatnonzero(np.isin(self._letter, letters))

    def _curves(self, edges: IntArray) -> tuple[list[Curve], list[IntArray]]:
        """The edges as curves that go through where two of them meet, and the edges of each."""
        paths = joined_by_pairs(self._graph.ends[edges], len(self._graph.points))
        return [self._curve(path) for path in paths], [edges[path.edges] for path in paths]

    def _curve(self, path: Path) -> Curve:
        return Curve(self._graph.points[path.vertices], path.closed, None)

    # ---- the border

    def _border(self) -> Ring:
        attempts = [
            (("B",), ""),
            (("B", "C"), "cuts are a part of the border"),
            ((*DRAWN, "F", "J"), "the border is the outline of all edges, since no closed line is marked as it"),
            (DRAWN, "the border is the outline of all creases, since no closed line is marked as it"),
        ]
        tried: set[int] = set()
        crowded = False
        for letters, explained in attempts:
            edges = self._with(*letters)
            # Each holds the one before it or the one after, so that as many are the same.
            if not 0 < len(edges) <= MAX_POINTS or len(edges) in tried:
                continue
            tried.add(len(edges))
            curves, members = self._curves(edges)
            if len(curves) > MAX_STROKES:
                crowded = True
                continue
            best: tuple[float, Ring] | None = None
            for ring in outer_rings(curves, range(len(curves)), self._graph.size)[:8]:
                on_ring = [members[k] for k in ring.members]
                rest = np.setdiff1d(self._with(*_CREASES), np.concatenate([*on_ring, []]))
                share = share_inside(ring.polygon, self._curves(rest)[0], self._tolerance)
                if share >= _SHARE and (best is None or share > best[0] + 1e-6):
                    best = share, ring
            if best is not None:
                for k in best[1].members:
                    self._letter[members[k]] = _BORDER
                if explained:
                    self._notes.append(explained)
                return best[1]
        if crowded:
            raise PatternError(f"no border found: the drawing has more than {MAX_STROKES:,} lines")
        raise PatternError("no border found: no closed outline holds the creases")

    # ---- holes

    def _holes(self, sheet: Ring) -> list[Ring]:
        edges = self._with("B", "C")
        if not len(edges):
            return []
        curves, members = self._curves(edges)
        _check_count(curves)
        inside = sheet.polygon.buffer(self._tolerance)
        shapely.prepare(inside)
        lines = np.array([curve_line(curve) for curve in curves])
        candidates = np.flatnonzero(shapely.covers(inside, lines)).tolist()
        rings = [
            ring
            for group in touching_groups(curves, candidates, self._tolerance)
            for ring in outer_rings(curves, group, self._graph.size)
        ]
        holes: list[Ring] = []
        for ring in sorted(rings, key=lambda ring: -ring.polygon.area):
            # What lies in a hole falls out with it.
            if _overlap([hole.polygon for hole in holes], ring.polygon):
                continue
            if len(holes) == MAX_HOLES:
                raise PatternError(f"the drawing has more than {MAX_HOLES:,} holes")
            holes.append(ring)
            for k in ring.members:
                self._letter[members[k]] = _HOLE
        for letter, what in (("C", "a cut that does not close is not supported"), ("B", "not part of an outline")):
            if len(self._with(letter)):
                self._notes.append(f"{count_edges(self._letter, letter)} {letter} left out: {what}")
        return holes

    # ---- creases

    def _creases(self, sheet: Ring, holes: Sequence[Ring]) -> list[Crease]:
        graph, edges = self._graph, self._with(*_CREASES)
        number = graph.number[edges]
        # Kinds: what the writer calls one crease, or one of the letters.
        kind = np.where(number >= 0, number + len(_CREASES), np.searchsorted(_CREASES, self._letter[edges]))
        corners = np.zeros(len(graph.points), dtype=bool)
        corners[graph.ends[self._with(_BORDER, _HOLE)].ravel()] = True
        joined = joined_as_creases(graph.points, graph.ends[edges], kind, number >= 0, corners)
        paths: list[tuple[Path, str, str]] = []
        parts: Counter[int] = Counter()
        for path in joined:
            path = Path(path.vertices, edges[path.edges], path.closed)
            whose = int(graph.number[path.edges[0]])
            for piece, letter in _pieces(path, self._letter[path.edges]):
                parts[whose] += 1
                paths.append((piece, letter, f"crease {whose + 1} part {parts[whose]}" if whose >= 0 else ""))
        _check_count(paths)
        # As the writer counts them, then as they come.
        paths.sort(key=lambda entry: (graph.number[entry[0].edges[0]] < 0, graph.number[entry[0].edges[0]]))
        kept = self._on_paper([self._curve(path) for path, _, _ in paths], sheet, holes)
        if not kept.any():
            raise PatternError("no crease found: no edge inside the border is marked M, V or U")
        creases: list[Crease] = []
        count: Counter[str] = Counter()
        for k in np.flatnonzero(kept).tolist():
            path, letter, name = paths[k]
            count[letter] += 1
            whose = int(graph.number[path.edges[0]])
            if whose >= 0 and parts[whose] == 1:
                # Messages count creases themselves: a name says more only where the numbers differ.
                name = f"crease {whose + 1}" if whose != len(creases) else ""
            elif whose < 0 and letter != "U":
                name = f"{_WORDS[letter]} {count[letter]}"
            curve = self._curve(path)
            creases.append(Crease(without_straight(curve.points, path.closed), path.closed, letter, name))
        words = ", ".join(f"{count[letter]:,} {_WORDS[letter]}" for letter in _CREASES if count[letter])
        total = int(sum(len(paths[k][0].edges) for k in np.flatnonzero(kept)))
        self._notes.append(f"{_creases(len(creases))} of {total:,} edges: {words}")
        return creases

    def _on_paper(self, curves: Sequence[Curve], sheet: Ring, holes: Sequence[Ring]) -> BoolArray:
        """Which curves have a part on the paper; a note says how many have none."""
        lines = np.array([curve_line(curve) for curve in curves])
        grown = sheet.polygon.buffer(self._tolerance)
        shapely.prepare(grown)
        beside = ~shapely.intersects(grown, lines)
        gaps = shapely.union_all([hole.polygon.buffer(self._tolerance) for hole in holes])
        shapely.prepare(gaps)
        fallen = shapely.covers(gaps, lines) & ~beside
        for out, where in ((beside, "beside the sheet"), (fallen, "inside a hole")):
            if out.any():
                self._notes.append(f"{_creases(int(out.sum()))} left out: {where}")
        return np.asarray(~beside & ~fallen, dtype=bool)


def _check_count(lines: Sequence[object]) -> None:
    if len(lines) > MAX_STROKES:
        raise PatternError(f"the drawing has more than {MAX_STROKES:,} lines")


def _creases(count: int) -> str:
    return "1 crease" if count == 1 else f"{count:,} creases"


def _overlap(polygons: list[shapely.Polygon], polygon: shapely.Polygon) -> bool:
    others = np.array(polygons)
    others = others[shapely.intersects(others, polygon)]
    return bool(shapely.area(shapely.intersection(others, polygon)).sum() > 1e-9 * polygon.area)


def _pieces(path: Path, letter: Any) -> list[tuple[Path, str]]:
    """A path cut where its letter changes. An unassigned part between assigned ones goes with what is before it."""
    letters: list[str] = letter.tolist()
    known = [word for word in letters if word != "U"]
    if len(set(known)) < 2:
        return [(path, known[0] if known else "U")]
    last = known[-1] if path.closed else known[0]
    for k, word in enumerate(letters):
        last = letters[k] = word if word != "U" else last
    cuts = [k for k in range(len(letters)) if letters[k] != letters[k - 1] and (k or path.closed)]
    vertices = path.vertices.tolist()
    edges = path.edges.tolist()
    if path.closed:
        turn = cuts[0]
        vertices = [*vertices[turn:], *vertices[: turn + 1]]
        edges, letters = [*edges[turn:], *edges[:turn]], [*letters[turn:], *letters[:turn]]
        cuts = [k - turn for k in cuts[1:]]
    bounds = [0, *cuts, len(edges)]
    return [
        (Path(np.array(vertices[a : b + 1]), np.array(edges[a:b]), False), letters[a])
        for a, b in itertools.pairwise(bounds)
    ]
