"""Strokes that continue each other are one line: converters write a curve as hundreds of strokes.

Two kinds: strokes whose ends meet, and the dashes of a dashed line that a program has written one by one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import BoolArray, FloatArray
from .chains import Path, joined_smoothly, walked, without_straight
from .curves import CORNER, is_zigzag
from .rings import JOIN, curve_lines, lines_at, meeting_places
from .segments import STRAIGHT, Curve
from .stroke import CREASE_ROLES, Decision, Role, Stroke

#: A polyline of fewer straight pieces is drawn as it is meant; one of more may be a sampled curve.
_POLYLINE_PIECES = 4
#: Strokes in a row that are taken for dashes of one line.
_LEAST_DASHES = 4
#: The way on from a dash to the next one turns by this at most at either end, radians.
_DASH_TURN = np.radians(25.0)
#: Gaps between dashes, relative to their median.
_GAP_RATIOS = (0.5, 1.6)
#: A gap is at most this many times as long as the longest dash of its line.
_GAP_TO_DASH = 1.5
#: Dashes of one length differ by this factor at most.
_SAME_LENGTH = 1.5
#: Ends that are looked at when the next dash is searched.
_NEAR_ENDS = 8


def join_strokes(strokes: Sequence[Stroke], size: float) -> tuple[list[Stroke], list[str]]:
    """The strokes with those that continue each other joined, in their order, and a note for each kind of joining.

    Ends of one role that meet are joined where just two of them do and turn by less than 30 degrees, or go straight
    on among others. size: longer side of the drawing, its units. Raises PatternError when too many ends meet.
    """
    if not strokes:
        return [], []
    joined = _joined_where_ends_meet(strokes, size)
    dashed = _joined_dashes(joined, size)
    notes = _said(strokes, joined, "continue each other, as") + _said(joined, dashed, "are the dashes of")
    return [_recognised(stroke, size) for stroke in dashed], notes


def _said(before: Sequence[Stroke], after: Sequence[Stroke], what: str) -> list[str]:
    old = {id(stroke) for stroke in before}
    groups: dict[str, list[Stroke]] = defaultdict(list)
    for stroke in after:
        if id(stroke) not in old:
            groups[stroke.decision.detail].append(stroke)
    return [
        f"{sum(stroke.count for stroke in some):,} strokes {detail} {what} {len(some):,} "
        f"{'line' if len(some) == 1 else 'lines'}"
        for detail, some in groups.items()
    ]


# ---- ends that meet


def _joined_where_ends_meet(strokes: Sequence[Stroke], size: float) -> list[Stroke]:
    open_ = [k for k, stroke in enumerate(strokes) if not stroke.curve.closed]
    if len(open_) < 2:
        return list(strokes)
    points = np.array([strokes[k].curve.points[[0, -1]] for k in open_])
    ways = np.array([_ways_out(strokes[k].curve.points) for k in open_])
    roles = list(Role)
    kind = np.array([roles.index(strokes[k].decision.role) for k in open_])
    ends = meeting_places(points.reshape(-1, 2), JOIN * size).reshape(-1, 2)
    # What starts where it ends has nothing to be joined with.
    loops = ends[:, 0] == ends[:, 1]
    kind = np.where(loops, len(roles) + np.arange(len(kind)), kind)
    paths = joined_smoothly(ways.reshape(-1, 2), ends, kind, CORNER)
    result = {k: stroke for k, stroke in enumerate(strokes) if stroke.curve.closed}
    for path in paths:
        some = [strokes[open_[edge]] for edge in path.edges.tolist()]
        if len(some) == 1:
            result[open_[path.edges[0]]] = some[0]
            continue
        forward = ends[path.edges, 0] == path.vertices[: len(path.edges)]
        curves = [s.curve if ahead else _reversed(s.curve) for s, ahead in zip(some, forward, strict=True)]
        first = min(open_[edge] for edge in path.edges.tolist())
        result[first] = replace(strokes[first], curve=_end_to_end(curves, path.closed, size), count=len(some))
    return [result[k] for k in sorted(result)]


def _ways_out(points: FloatArray) -> FloatArray:
    """(2,2) how a polyline leaves its first and its last point."""
    return np.array([points[1] - points[0], points[-2] - points[-1]])


def _reversed(curve: Curve) -> Curve:
    beziers = None if curve.beziers is None else curve.beziers[::-1, ::-1]
    return Curve(curve.points[::-1], curve.closed, beziers)


def _end_to_end(curves: Sequence[Curve], closed: bool, size: float) -> Curve:
    """One curve of several; where two ends meet, the first one's place counts."""
    points = np.vstack([curves[0].points, *(curve.points[1:] for curve in curves[1:])])
    if closed:
        points = points[:-1]
    known = [curve.beziers for curve in curves if curve.beziers is not None]
    if len(known) < len(curves):
        return Curve(points, closed and len(points) >= 3, None)
    beziers = np.vstack(known)
    # The inner control points go along, so that tangents stay what they are.
    moved = np.roll(beziers[:, 3], 1, axis=0) - beziers[:, 0]
    if not closed:
        moved[0] = 0.0
    beziers[:, 0] += moved
    beziers[:, 1] += moved
    return Curve(points, closed and len(points) >= 3, beziers)


# ---- dashes


def _joined_dashes(strokes: Sequence[Stroke], size: float) -> list[Stroke]:
    open_ = [k for k, stroke in enumerate(strokes) if not stroke.curve.closed]
    if len(open_) < _LEAST_DASHES:
        return list(strokes)
    ends = np.vstack([strokes[k].curve.points[[0, -1]] for k in open_])
    lines = curve_lines([stroke.curve for stroke in strokes])
    alone = (lines_at(lines, ends, JOIN * size) == 1).reshape(-1, 2)
    free = dict(zip(open_, alone, strict=True))
    groups: dict[tuple[Role, str], list[int]] = defaultdict(list)
    for k in open_:
        stroke = strokes[k]
        if stroke.decision.role in (*CREASE_ROLES, Role.DARK, Role.PALE):
            groups[stroke.decision.role, stroke.decision.detail].append(k)
    result = dict(enumerate(strokes))
    for members in groups.values():
        if len(members) < _LEAST_DASHES:
            continue
        free_ends = np.array([free[k] for k in members])
        for row, closed in _rows_of_dashes([strokes[k].curve for k in members], free_ends, size):
            which = [members[k] for k, _ in row]
            curves = [
                strokes[k].curve if ahead else _reversed(strokes[k].curve)
                for k, (_, ahead) in zip(which, row, strict=True)
            ]
            first = min(which)
            for k in which:
                del result[k]
            result[first] = replace(
                strokes[first],
                curve=_through_dashes(curves, closed),
                decision=_dashed(strokes[first].decision, [length_of(curve) for curve in curves]),
                count=sum(strokes[k].count for k in which),
            )
    return [result[k] for k in sorted(result)]


def _rows_of_dashes(
    curves: Sequence[Curve], free: BoolArray, size: float
) -> list[tuple[list[tuple[int, bool]], bool]]:
    """Which curves stand in a row with regular gaps, in its order, and whether each runs along with it; and whether
    the row closes.

    free (C,2): which ends no other line meets, for there is nothing in a gap
    """
    lengths = np.array([length_of(curve) for curve in curves])
    ends = np.array([curve.points[[0, -1]] for curve in curves]).reshape(-1, 2)
    ahead = -np.array([_ways_out(curve.points) for curve in curves]).reshape(-1, 2)
    ahead /= np.maximum(np.hypot(*ahead.T), np.finfo(float).tiny)[:, None]
    reach = _GAP_TO_DASH * float(np.quantile(lengths, 0.9))
    near = min(_NEAR_ENDS, len(ends))
    distance, other = cKDTree(ends).query(ends, k=near, distance_upper_bound=reach)
    one = np.repeat(np.arange(len(ends)), near)
    distance, other = distance.ravel(), other.ravel()
    there = np.isfinite(distance) & (one // 2 != np.minimum(other, len(ends) - 1) // 2)
    there &= (distance > JOIN * size) & free.ravel()[one] & free.ravel()[np.minimum(other, len(ends) - 1)]
    one, other, distance = one[there], other[there], distance[there]
    way = (ends[other] - ends[one]) / distance[:, None]
    straight = np.cos(_DASH_TURN)
    on = (np.sum(way * ahead[one], axis=1) >= straight) & (np.sum(-way * ahead[other], axis=1) >= straight)
    one, other, distance = one[on], other[on], distance[on]
    best = np.full(len(ends), -1, dtype=np.int64)
    order = np.argsort(-distance, kind="stable")  # the nearest is written last and stays
    best[one[order]] = other[order]
    partner = np.where((best >= 0) & (best[best] == np.arange(len(ends))), best, -1)
    paths = walked(np.arange(len(ends)).reshape(-1, 2), partner)
    return [(row, path.closed) for path in paths if (row := _row(path, ends, lengths))]


def _row(path: Path, ends: FloatArray, lengths: FloatArray) -> list[tuple[int, bool]]:
    count = len(path.edges)
    if count < _LEAST_DASHES:
        return []
    forward = path.vertices[:count] % 2 == 0
    first = 2 * path.edges + np.where(forward, 0, 1)
    last = 2 * path.edges + np.where(forward, 1, 0)
    after = np.roll(first, -1) if path.closed else first[1:]
    gaps = np.hypot(*(ends[after] - ends[last[: len(after)]]).T)
    low, high = (ratio * float(np.median(gaps)) for ratio in _GAP_RATIOS)
    longest = float(lengths[path.edges].max())
    regular = gaps.min() >= low and gaps.max() <= high and gaps.max() <= _GAP_TO_DASH * longest
    if not regular or _kinds_of_lengths(lengths[path.edges][1:-1]) > 2:
        return []
    # Lines of a pattern that stand in a row by chance point to all sides; dashes turn as their line does.
    if is_zigzag(ends[np.column_stack([first, last]).ravel()]):
        return []
    return list(zip(path.edges.tolist(), forward.tolist(), strict=True))


def _kinds_of_lengths(lengths: FloatArray) -> int:
    """How many lengths there are, those that differ a little counted as one."""
    steps = np.sort(lengths)
    return 1 + int((steps[1:] > _SAME_LENGTH * steps[:-1]).sum()) if len(steps) else 0


def _dashed(decision: Decision, lengths: list[float]) -> Decision:
    """What dashes say where nothing else does: two lengths are mountain, one is valley (Yoshizawa, Randlett)."""
    detail = f"{decision.detail} drawn dash by dash"
    if decision.role not in (Role.DARK, Role.PALE):
        return replace(decision, detail=detail)
    role = Role.MOUNTAIN if _kinds_of_lengths(np.array(lengths[1:-1])) == 2 else Role.VALLEY
    return Decision(role, "dash pattern", detail)


def _through_dashes(curves: Sequence[Curve], closed: bool) -> Curve:
    """A curve through the middles of dashes, and the ends of an open row."""
    rows = []
    for curve in curves:
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(curve.points, axis=0).T))])
        middle = 0.5 * along[-1]
        rows.append([np.interp(middle, along, curve.points[:, 0]), np.interp(middle, along, curve.points[:, 1])])
    points = np.array(rows) if closed else np.vstack([curves[0].points[:1], rows, curves[-1].points[-1:]])
    return Curve(without_straight(points, closed), closed, None)


def length_of(curve: Curve) -> float:
    """The length of a curve's samples, a closed one's without its last piece."""
    return float(np.hypot(*np.diff(curve.points, axis=0).T).sum())


# ---- sampled curves


def _recognised(stroke: Stroke, size: float) -> Stroke:
    """A polyline of many pieces may be the samples of a curve, which are rounded where the net is made."""
    curve = stroke.curve
    if curve.beziers is None or len(curve.beziers) < _POLYLINE_PIECES:
        return stroke
    bends = curve.beziers[:, :-2] - 2 * curve.beziers[:, 1:-1] + curve.beziers[:, 2:]
    if np.abs(bends).max() > STRAIGHT * size:
        return stroke
    return replace(stroke, curve=Curve(without_straight(curve.points, curve.closed), curve.closed, None))
