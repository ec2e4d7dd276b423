"""How closely a paper follows a dragged empty, from the events that the probe has recorded."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

#: A point has caught up when it is as near to its empty as this part of the empty's farthest move.
CAUGHT = 0.05


@dataclass(frozen=True)
class Following:
    """Rates are per second while the empty moved, times in milliseconds, distances in scene units."""

    seconds: float
    frames: float  # per second
    ticks: float  # writes of the paper per second
    to_next_write: float  # median, from a move of the empty to the next write of the paper
    to_next_write_90: float  # the same, not exceeded by 90 %
    longest_frame: float  # between two frames
    catch_up: float  # from the empty's last move until its point is there for good; infinite when it never is
    gap: float  # median distance of the empty and its point, in a frame
    way: float  # how far the empty was moved, all told

    def __str__(self) -> str:
        return ", ".join(f"{name} {value:.4g}" for name, value in asdict(self).items())


def following(events: list[list[Any]]) -> Following:
    """From [seconds, "hook" | "paper" | "frame", place of the empty, place of its point]."""
    moves = np.array([event[0] for event in events if event[1] == "hook"])
    start, end = moves[0], moves[-1]
    within = [event for event in events if start <= event[0] <= end]
    writes = np.array([event[0] for event in events if event[1] == "paper"])
    frames = [event for event in within if event[1] == "frame"]
    next_write = np.append(writes, np.inf)[np.searchsorted(writes, moves)] - moves
    next_write = 1000.0 * next_write[np.isfinite(next_write)]
    times = np.array([event[0] for event in frames])
    empty, point = (np.array([event[k] for event in frames]) for k in (2, 3))
    return Following(
        seconds=end - start,
        frames=len(frames) / (end - start),
        ticks=np.count_nonzero((writes >= start) & (writes <= end)) / (end - start),
        to_next_write=float(np.median(next_write)),
        to_next_write_90=float(np.quantile(next_write, 0.9)),
        longest_frame=1000.0 * float(np.diff(times).max()),
        catch_up=1000.0 * _catch_up(events, end),
        gap=float(np.median(np.linalg.norm(empty - point, axis=1))),
        way=float(np.linalg.norm(np.diff(empty, axis=0), axis=1).sum()),
    )


@dataclass(frozen=True)
class Spending:
    """Where the time goes while the empty moves, milliseconds in a frame: the follower's ticks, drawing the 3D
    view, and all else that Blender's own thread does or waits for: events, other regions, showing the picture.
    """

    ticks: float  # in a frame, whether they had something to write or not
    tick: float
    draw: float
    rest: float
    tick_processor: float  # of Blender's own thread
    draw_processor: float
    rest_processor: float
    other_threads: float  # processor time of all the others: the solver, and who draws without a graphics card

    def __str__(self) -> str:
        return ", ".join(f"{name} {value:.4g}" for name, value in asdict(self).items())


def spending(events: list[list[Any]]) -> Spending:
    """From events with processor times: [seconds, what, two places, Blender's own thread's, all threads']."""
    moves = [k for k, event in enumerate(events) if event[1] == "hook"]
    within = events[moves[0] : moves[-1] + 1]
    clocks = 1000.0 * np.array([[event[0], event[4], event[5]] for event in within])
    kinds = [event[1] for event in within]
    tick, draw = (_between(kinds, clocks, *pair) for pair in (("tick", "ticked"), ("draw", "frame")))
    whole = clocks[-1] - clocks[0]
    rest = whole - tick - draw
    frames = kinds.count("frame")
    ticks = kinds.count("tick") / frames
    parts = [tick[0], draw[0], rest[0], tick[1], draw[1], rest[1], whole[2] - whole[1]]
    return Spending(ticks, *(float(part) / frames for part in parts))


def _between(kinds: list[str], clocks: np.ndarray, begin: str, end: str) -> np.ndarray:
    """(3,) what the clocks (n,3) have gone on between the beginnings and the ends."""
    total, begun = np.zeros(3), None
    for kind, clock in zip(kinds, clocks, strict=True):
        if kind == begin:
            begun = clock
        elif kind == end and begun is not None:
            total, begun = total + clock - begun, None
    return total


def _catch_up(events: list[list[Any]], end: float) -> float:
    """Seconds."""
    empty, point = (np.array([event[k] for event in events]) for k in (2, 3))
    farthest = np.linalg.norm(empty - empty[0], axis=1).max()
    away = np.flatnonzero(np.linalg.norm(empty - point, axis=1) > CAUGHT * farthest)
    if not len(away):
        return 0.0
    if away[-1] + 1 == len(events):
        return float("inf")
    return max(0.0, events[away[-1] + 1][0] - end)
