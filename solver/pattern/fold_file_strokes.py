"""The edges of a FOLD file's frame -> lines with a meaning: edges that are pieces of one line are joined."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..errors import PatternError
from .chains import Path, joined_as_creases, joined_by_pairs, without_straight
from .fold_file_graph import EdgeGraph
from .segments import Curve
from .sheets import MAX_STROKES
from .stroke import Decision, Lines, Role, Stroke

_CREASES = ("M", "U", "V")
#: What the letters of edges mean (FOLD 1.2, edges_assignment).
_ROLES = {
    "B": Role.BORDER,
    "C": Role.CUT,
    "M": Role.MOUNTAIN,
    "V": Role.VALLEY,
    "U": Role.CREASE,
    "F": Role.FACET,
    "J": Role.FACET,
}
_WHY = "edges_assignment"
_NAMES = {"M": "mountain", "V": "valley"}


def lines_of(graph: EdgeGraph, unit_mm: float | None, notes: tuple[str, ...]) -> Lines:
    """The lines of a frame. Raises PatternError when there are too many."""
    strokes = [*_edges(graph, "B"), *_edges(graph, "C"), *_creases(graph)]
    mesh = int(np.isin(graph.letter, ("F", "J")).sum())
    # Lines of a mesh fold nothing, and may be many. They matter where no line is the border.
    if mesh and ((graph.letter == "B").any() or len(strokes) + mesh > MAX_STROKES):
        edges = "1 edge" if mesh == 1 else f"{mesh:,} edges"
        notes = (*notes, f"{edges} left out: flat or joined, lines of a mesh and no creases")
    else:
        strokes += [*_edges(graph, "F"), *_edges(graph, "J")]
    if len(strokes) > MAX_STROKES:
        raise PatternError(f"the drawing has more than {MAX_STROKES:,} lines", notes=notes)
    return Lines(tuple(strokes), (), None, unit_mm, notes, graph.conflicts)


def _edges(graph: EdgeGraph, letter: str) -> Iterator[Stroke]:
    """Edges with a letter, through every vertex in which just two of them meet."""
    edges = np.flatnonzero(graph.letter == letter)
    for path in joined_by_pairs(graph.ends[edges], len(graph.points)):
        yield _stroke(graph, path, letter, "")


def _creases(graph: EdgeGraph) -> list[Stroke]:
    edges = np.flatnonzero(np.isin(graph.letter, _CREASES))
    number = graph.number[edges]
    # Kinds: what the writer calls one crease, or one of the letters.
    kind = np.where(number >= 0, number + len(_CREASES), np.searchsorted(_CREASES, graph.letter[edges]))
    corners = np.zeros(len(graph.points), dtype=bool)
    corners[graph.ends[np.isin(graph.letter, ("B", "C"))].ravel()] = True
    parts: Counter[int] = Counter()
    found: list[tuple[int, int, Path, str]] = []
    for path in joined_as_creases(graph.points, graph.ends[edges], kind, number >= 0, corners):
        path = Path(path.vertices, edges[path.edges], path.closed)
        whose = int(graph.number[path.edges[0]])
        for piece, letter in _pieces(path, graph.letter[path.edges]):
            parts[whose] += 1
            found.append((whose, parts[whose], piece, letter))
    # As the writer counts them, then as they come.
    found.sort(key=lambda entry: (entry[0] < 0, entry[0]))
    count: Counter[str] = Counter()
    strokes = []
    for index, (whose, part, piece, letter) in enumerate(found):
        count[letter] += 1
        name = ""
        if whose >= 0 and parts[whose] > 1:
            name = f"crease {whose + 1} part {part}"
        elif whose >= 0 and whose != index:
            # Messages count creases themselves: a name says more only where the numbers differ.
            name = f"crease {whose + 1}"
        elif whose < 0 and letter in _NAMES:
            name = f"{_NAMES[letter]} {count[letter]}"
        strokes.append(_stroke(graph, piece, letter, name))
    return strokes


def _stroke(graph: EdgeGraph, path: Path, letter: str, name: str) -> Stroke:
    points = without_straight(graph.points[path.vertices], path.closed)
    decision = Decision(_ROLES[letter], _WHY, f"of edges marked {letter}")
    return Stroke(Curve(points, path.closed, None), decision, name, count=len(path.edges))


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
