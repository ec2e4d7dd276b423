"""Ctrl-C at the command line: the work ends, and leaves neither a traceback nor half a file."""

import contextlib
import os
import shutil
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

from ..solver.command_line import INTERRUPTED

__all__ = ["INTERRUPTED", "end_at_once", "remove_at_end", "said_once", "say"]

#: What goes wherever the end comes, beside what is named with ``end_at_once``.
_temporary: list[Path] = []


def say() -> None:
    print("curvefold: interrupted", file=sys.stderr, flush=True)


def remove_at_end(folder: Path) -> None:
    """Have ``end_at_once`` remove a temporary folder of this process too."""
    _temporary.append(folder)


@contextlib.contextmanager
def said_once() -> Iterator[None]:
    """While this lasts, Ctrl-C raises KeyboardInterrupt, once: a second one would break off what tidies up.

    Blender's own handler, which this replaces, only stops renders.
    """

    def interrupt(number: int, frame: FrameType | None) -> None:
        signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt

    with _handled_by(interrupt):
        yield


@contextlib.contextmanager
def end_at_once(*to_remove: Path) -> Iterator[None]:
    """While this lasts, Ctrl-C removes these files and ends the process.

    It is for what Blender does by itself, such as rendering: until that is done no Python handler runs in the main
    thread, and Blender would print the KeyboardInterrupt and go on. So a thread waits for the signal.
    """
    leaving = threading.RLock()

    def end(number: int = signal.SIGINT, frame: FrameType | None = None) -> None:
        with leaving:
            for path in (*to_remove, *_temporary):
                shutil.rmtree(path, ignore_errors=True)
                with contextlib.suppress(OSError):
                    path.unlink()
            say()
            os._exit(INTERRUPTED)

    with _handled_by(end) as hears:
        if hears:
            with _told_of_signals(end):
                yield
        else:
            yield


@contextlib.contextmanager
def _handled_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[bool]:
    """Whether Ctrl-C is heard: only in the main thread, and not where a shell has told the process to ignore it."""
    if (
        threading.current_thread() is not threading.main_thread()
        or signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    ):
        yield False
        return
    before = signal.signal(signal.SIGINT, handler)
    try:
        yield True
    finally:
        # None stands for a handler that is not Python's, and cannot be set.
        signal.signal(signal.SIGINT, signal.default_int_handler if before is None else before)


@contextlib.contextmanager
def _told_of_signals(end: Callable[[], None]) -> Iterator[None]:
    """Calls ``end`` from a thread when Ctrl-C comes, whatever the main thread is doing."""
    ear, mouth = socket.socketpair()

    def listen() -> None:
        # A byte a signal, its number; nothing more when the other side is closed.
        while number := ear.recv(1):
            if number[0] == signal.SIGINT:
                end()

    mouth.setblocking(False)
    thread = threading.Thread(target=listen, daemon=True)
    before = signal.set_wakeup_fd(mouth.fileno())
    thread.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        mouth.close()
        thread.join()
        ear.close()
