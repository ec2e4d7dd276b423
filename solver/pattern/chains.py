"""Edges, and strokes -> the lines that they are pieces of: joined where two meet, straight on where more do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray

#: A crease goes on through a vertex where others meet it if it turns by no more than this, radians: a circle of 24
#: pieces turns by 15 degrees, the lines of straight designs by 22.5.
STRAIGHT_ON = np.radians(16.0)
#: The same where the writer says that it is one crease, radians.
_SAME_CREASE = np.radians(90.0)
#: Less is the rounding of a straight line, radians.
_NO_TURN = 1e-7


@dataclass(frozen=True, eq=False)
class Path:
    """Edges in a row: vertices (P,), those of a closed path without the first again; edges (P-1,), closed (P,)."""

    vertices: IntArray
    edges: IntArray
    closed: bool


def joined_by_pairs(ends: IntArray, count: int) -> list[Path]:
    """Paths through every vertex in which exactly two of the edges meet. count: vertices in all."""
    return _walk(ends, _partners_of_two(ends, np.zeros(len(ends), dtype=np.int64), count))


def joined_as_creases(
    points: FloatArray, ends: IntArray, kind: IntArray, known: BoolArray, corners: BoolArray
) -> list[Path]:
    """Paths of edges (E,2) that are one crease each, in the order of their first edges.

    points   (N,2) vertices
    kind     (E,) only edges of one kind are joined
    known    (E,) whether the kind is a crease by the writer's word, and not just a letter
    corners  (N,) vertices that no line without such a word turns at, like those on the border
    """
    count = len(points)
    degree = np.bincount(ends.ravel(), minlength=count)
    partner = _partners_of_two(ends, kind, count)
    at = ends.ravel()
    # Two edges of a kind, among others: whether they are one crease is for the angle to say, unless it is known.
    loose = ~np.repeat(known, 2) & ((degree[at] > 2) | corners[at])
    partner[loose] = -1
    limit = np.where(np.repeat(known, 2), _SAME_CREASE, STRAIGHT_ON)
    return _walk(ends, _partners_straight_on(_chords(points, ends), ends, kind, limit, partner))


def joined_smoothly(ways: FloatArray, ends: IntArray, kind: IntArray, corner: float) -> list[Path]:
    """Paths of strokes that continue each other, in the order of their first strokes.

    ways    (2S,2) the direction in which each stroke leaves each of its ends
    ends    (S,2) the place of each end, equal numbers where ends meet
    kind    (S,) only strokes of one kind are joined: where two of it meet if they turn by ``corner`` radians at
            most, where more do if they go straight on
    """
    partner = _partners_of_two(ends, kind, int(ends.max(initial=-1)) + 1)
    two = np.flatnonzero(partner >= 0)
    partner[two[_turns(ways[two], ways[partner[two]]) > corner]] = -1
    # A corner of two is a corner, and not looked at again.
    at, kinds = ends.ravel(), np.repeat(kind, 2)
    _, group, size = np.unique(np.column_stack([at, kinds]), axis=0, return_inverse=True, return_counts=True)
    limit = np.where(size[group.reshape(-1)] > 2, STRAIGHT_ON, 0.0)
    return _walk(ends, _partners_straight_on(ways, ends, kind, limit, partner))


def walked(ends: IntArray, partner: IntArray) -> list[Path]:
    """Every edge (E,2) in one path; ``partner`` (2E,) says with which end each end is joined, -1 with none."""
    return _walk(ends, partner)


def _turns(one: FloatArray, other: FloatArray) -> FloatArray:
    """(N,) how much a line turns between one way out, taken backwards, and the other; radians."""
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return np.asarray(np.abs(np.arctan2(cross, -np.sum(one * other, axis=1))))


def _chords(points: FloatArray, ends: IntArray) -> FloatArray:
    return np.asarray(points[ends[:, ::-1].ravel()] - points[ends.ravel()])


def without_straight(points: FloatArray, closed: bool) -> FloatArray:
    """A polyline without the points on its straight parts."""
    ring = np.vstack([points[-1:], points, points[:1]]) if closed else points
    steps = np.diff(ring, axis=0)
    cross = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    turn = np.abs(np.arctan2(cross, np.sum(steps[:-1] * steps[1:], axis=1))) > _NO_TURN
    if closed:
        return points[turn] if turn.sum() >= 3 else points
    return points[np.concatenate([[True], turn, [True]])]


def _partners_of_two(ends: IntArray, kind: IntArray, count: int) -> IntArray:
    """(2E,) for each end of an edge the only other one of its kind at that vertex, -1 where there is none.

    Ends are numbered 2 * edge and 2 * edge + 1.
    """
    at, kinds = ends.ravel(), np.repeat(kind, 2)
    partner = np.full(len(at), -1, dtype=np.int64)
    order = np.lexsort((kinds, at))
    new = np.ones(len(order), dtype=bool)
    new[1:] = (np.diff(at[order]) != 0) | (np.diff(kinds[order]) != 0)
    starts = np.flatnonzero(new)
    two = starts[np.diff(np.append(starts, len(order))) == 2]
    one, other = order[two], order[two + 1]
    partner[one], partner[other] = other, one
    return partner


def _partners_straight_on(
    ways: FloatArray, ends: IntArray, kind: IntArray, limit: FloatArray, partner: IntArray
) -> IntArray:
    """``partner`` with the ends that have none joined to those of their kind that go on most straight.

    ways (2E,2) as each end is left; limit (2E,) how much a line may turn there, radians
    """
    free = np.flatnonzero(partner < 0)
    at, kinds, way = ends.ravel()[free], np.repeat(kind, 2)[free], ways[free]
    angle = np.mod(np.arctan2(way[:, 1], way[:, 0]), 2 * np.pi)
    # Ends of one kind at one vertex, each group on a stretch of its own of one line, with room to go around.
    _, group = np.unique(np.column_stack([at, kinds]), axis=0, return_inverse=True)
    base = 8 * np.pi * group.reshape(-1)
    around = np.concatenate([base + angle + turn for turn in (-2 * np.pi, 0.0, 2 * np.pi)])
    owner = np.tile(np.arange(len(free)), 3)
    order = np.argsort(around, kind="stable")
    around, owner = around[order], owner[order]
    target = base + np.mod(angle + np.pi, 2 * np.pi)
    place = np.searchsorted(around, target)
    before, after = np.maximum(place - 1, 0), np.minimum(place, max(len(around) - 1, 0))
    nearer = np.where(np.abs(around[before] - target) <= np.abs(around[after] - target), before, after)
    best = owner[nearer]
    turn = np.abs(around[nearer] - target)
    mutual = (best[best] == np.arange(len(free))) & (best != np.arange(len(free))) & (turn <= limit[free])
    result = partner.copy()
    result[free[mutual]] = free[best[mutual]]
    return result


def _walk(ends: IntArray, partner: IntArray) -> list[Path]:
    """Every edge in one path; ``partner`` (2E,) says how they go on."""
    at, onward = ends.ravel().tolist(), partner.tolist()
    used = [False] * len(ends)
    paths = []
    starts = [end for end in range(len(at)) if onward[end] < 0]
    for start in (*starts, *range(0, len(at), 2)):
        if used[start >> 1]:
            continue
        end = start
        vertices, edges, closed = [], [], False
        while True:
            used[end >> 1] = True
            vertices.append(at[end])
            edges.append(end >> 1)
            other = end ^ 1
            end = onward[other]
            if end < 0:
                vertices.append(at[other])
                break
            if used[end >> 1]:
                closed = True
                break
        paths.append(Path(np.array(vertices), np.array(edges), closed))
    return sorted(paths, key=lambda path: int(path.edges.min()))
