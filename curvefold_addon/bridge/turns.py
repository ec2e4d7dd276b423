"""The one thread in which nets are built and papers iterate, and whose turn it is.

Papers that move take turns, one iteration each, and the first of them has most of the turns. The thread goes on for
as long as somebody asks now and then, however slowly the view is drawn in between.
"""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Lock
from typing import Protocol

#: Seconds after which something else that waits for the thread has its turn.
_SPELL = 0.25
#: Of so many turns the others have one, while there is a first.
_OTHERS_EVERY = 4
#: Nothing iterates any more when nobody has asked for so many seconds.
_UNASKED = 5.0


class Turn(Protocol):
    """What takes turns."""

    @property
    def wants(self) -> bool:
        """Whether it was asked for something that it has not done."""

    def iterate(self) -> None:
        """A short piece of work."""


_pool: ThreadPoolExecutor | None = None
_job: Future[None] | None = None
#: Who wants to iterate, the next one first.
_asking: list[Turn] = []
_first: Turn | None = None
_asked_at = 0.0
_lock = Lock()


def pool() -> ThreadPoolExecutor:
    """The thread."""
    global _pool
    if _pool is None:
        _pool = ThreadPoolExecutor(1, "curvefold")
    return _pool


def stop() -> None:
    """Ends the thread; the next job starts another."""
    global _pool, _job, _first
    with _lock:
        _asking.clear()
        _first = None
    if _pool is not None:
        _pool.shutdown(wait=True, cancel_futures=True)
    _pool = _job = None


def ask(turn: Turn, first: bool) -> None:
    """Wants turns from now on, as long as it ``wants`` them."""
    global _first, _asked_at, _job
    with _lock:
        _asked_at = time.perf_counter()
        if turn not in _asking:
            _asking.append(turn)
        if first:
            _first = turn
        elif _first is turn:
            _first = None
        if _job is None:
            _job = pool().submit(_work)


def withdraw(turn: Turn) -> None:
    """Wants no more turns. One that has begun goes on to its end."""
    global _first
    with _lock:
        if turn in _asking:
            _asking.remove(turn)
        if _first is turn:
            _first = None


def _work() -> None:
    global _job
    end, taken = time.perf_counter() + _SPELL, 0
    while (turn := _next(taken)) is not None:
        taken += 1
        turn.iterate()
        _leave_if_done(turn)
        if time.perf_counter() > end:
            break
    with _lock:
        # Behind everything else that waits.
        _job = pool().submit(_work) if _asking and not _is_forgotten() else None


def _next(taken: int) -> Turn | None:
    with _lock:
        if not _asking or _is_forgotten():
            return None
        others = _first is None or _first not in _asking or taken % _OTHERS_EVERY == _OTHERS_EVERY - 1
        if not others or len(_asking) == 1:
            return _first if not others else _asking[0]
        turn = next(one for one in _asking if one is not _first)
        _asking.remove(turn)
        _asking.append(turn)
        return turn


def _leave_if_done(turn: Turn) -> None:
    with _lock:
        if turn in _asking and not turn.wants:
            _asking.remove(turn)


def _is_forgotten() -> bool:
    return time.perf_counter() - _asked_at > _UNASKED
