"""Work done in processes of its own, each with a limit of time: a crash or a hang is a result, not the end."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Generic, TypeVar

Job = TypeVar("Job")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Ended(Generic[Job, Result]):
    """How a job ended. result: None where the process died or was stopped, and ``sentence`` then says which."""

    job: Job
    result: Result | None
    seconds: float
    hung: bool = False
    sentence: str = ""


def _child(work: Callable[[Job], Result], job: Job, pipe: Connection) -> None:
    pipe.send(work(job))
    pipe.close()


def each_alone(
    jobs: Sequence[Job], work: Callable[[Job], Result], processes: int, time_limit: float
) -> Iterator[Ended[Job, Result]]:
    """``work`` for every job in a process of its own, ``processes`` at a time; in the order they end.

    work is a function of a module (or a partial one), which is loaded once. time_limit: seconds for one job
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read by the processes started below
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([(work.func if isinstance(work, partial) else work).__module__])
    waiting = list(reversed(jobs))
    running: dict[Connection, tuple[Job, BaseProcess, float]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < processes:
                job = waiting.pop()
                mine, theirs = context.Pipe(duplex=False)
                process = context.Process(target=_child, args=(work, job, theirs), daemon=True)
                process.start()
                theirs.close()
                running[mine] = job, process, time.monotonic()
            done = wait(list(running), timeout=1.0)
            for pipe, (job, process, began) in list(running.items()):
                seconds = time.monotonic() - began
                if pipe in done:
                    ended = _received(job, process, pipe, seconds)
                elif seconds > time_limit:
                    process.kill()
                    ended = Ended(job, None, seconds, True, f"no end after {time_limit:.0f} s")
                else:
                    continue
                process.join()
                pipe.close()
                del running[pipe]
                yield ended
    finally:
        for _, process, _ in running.values():
            process.kill()


def _received(job: Job, process: BaseProcess, pipe: Connection, seconds: float) -> Ended[Job, Result]:
    try:
        return Ended(job, pipe.recv(), seconds)
    except EOFError:
        process.join()
        return Ended(job, None, seconds, False, f"the process died ({process.exitcode})")
