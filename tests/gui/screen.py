"""A screen that nobody sees, with a mouse and a keyboard: Xvfb, xdotool and ImageMagick."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).absolute().parents[2]
Place = tuple[float, float]

WIDTH, HEIGHT = 1280, 800  # pixels; what fits a small laptop
#: Seconds between two events of the mouse: a hand's mouse reports about as often.
MOUSE_STEP = 1 / 60


class Screen:
    """Places are pixels from the top left corner, as X counts them."""

    def __init__(self, display: str) -> None:
        self.display = display
        #: Waits until what the mouse and the keyboard have done so far has been understood.
        self.understood: Callable[[], None] = lambda: None
        #: What a hand has done, in order: "point", "press", "draw" (the mouse, a button held or not) and "key".
        self.actions: list[str] = []
        self._environment = os.environ | {"DISPLAY": display}

    def _xdotool(self, *arguments: object) -> None:
        subprocess.run(["xdotool", *map(str, arguments)], env=self._environment, check=True)

    def move(self, place: Place) -> None:
        self.actions.append("point")
        self._xdotool("mousemove", round(place[0]), round(place[1]))

    def glide(self, start: Place, end: Place, seconds: float) -> None:
        """Moves the mouse from a place to another as a hand does: in many small steps, evenly in time."""
        self.follow([start, *along(start, end, max(2, round(seconds / MOUSE_STEP)))])

    def follow(self, path: Sequence[Place]) -> None:
        """From the first place on by steps, as a mouse reports them: Blender may put the pointer back meanwhile."""
        self.actions.append("draw")
        due = time.monotonic()
        steps = np.diff(np.round(path), axis=0).astype(int).tolist()
        for right, down in steps:
            self._xdotool("mousemove_relative", "--", right, down)
            due += MOUSE_STEP
            time.sleep(max(0.0, due - time.monotonic()))

    def press(self, button: int = 1) -> None:
        self.actions.append("press")
        self._xdotool("mousedown", button)

    def release(self, button: int = 1) -> None:
        self._xdotool("mouseup", button)

    def click(self, place: Place, button: int = 1) -> None:
        self.move(place)
        self.understood()  # Blender looks where the mouse is before it believes a click
        self.press(button)
        time.sleep(0.05)
        self.release(button)
        self.understood()

    def drag(self, path: Sequence[Place], button: int = 1) -> None:
        self.move(path[0])
        self.understood()
        self.press(button)
        self.understood()
        self.follow(path)
        self.release(button)
        self.understood()

    def key(self, *names: str) -> None:
        """Presses keys one after the other, by X's names: ``key("g")``, ``key("ctrl+z")``."""
        for name in names:
            self.actions.append("key")
            self._xdotool("key", "--clearmodifiers", name)
            self.understood()

    def type(self, text: str) -> None:
        self._xdotool("type", "--delay", 40, text)
        self.understood()

    def drop(self, place: Place, file: str) -> None:
        """A file manager's drag that ends at a place. file: a path as the program under test sees it."""
        self.move(place)
        self.understood()
        x, y = (str(round(c)) for c in place)
        subprocess.run(
            [sys.executable, "-m", "tests.gui.drag_source", self.display, x, y, file], cwd=ROOT, check=True
        )
        self.understood()

    def shot(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["import", "-window", "root", "-silent", str(path)], env=self._environment, check=True)

    def grey(self) -> np.ndarray:
        """What is on the screen: (HEIGHT, WIDTH), 0 to 1."""
        raw = subprocess.run(
            ["import", "-window", "root", "-silent", "-depth", "8", "ppm:-"],
            env=self._environment,
            check=True,
            capture_output=True,
        ).stdout
        with Image.open(io.BytesIO(raw)) as picture:
            return np.asarray(picture.convert("L")) / 255.0


def along(start: Place, end: Place, steps: int) -> list[Place]:
    return [tuple(p) for p in np.linspace(start, end, steps + 1)[1:].tolist()]


def crop(source: Path, target: Path, box: tuple[float, float, float, float]) -> None:
    """Cuts (left, top, right, bottom) out of a picture."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with Image.open(source) as picture:
        picture.convert("RGB").crop(tuple(round(edge) for edge in box)).save(target, optimize=True)


@contextmanager
def virtual_screen() -> Iterator[Screen]:
    """Xvfb on the first free display, for as long as the block runs."""
    reading, writing = os.pipe()
    server = subprocess.Popen(
        [
            "Xvfb",
            "-displayfd",
            str(writing),
            "-screen",
            "0",
            f"{WIDTH}x{HEIGHT}x24",
            "-noreset",
            "-nolisten",
            "tcp",
        ],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    try:
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        if not number:
            raise RuntimeError("Xvfb has not started")
        yield Screen(f":{number}")
    finally:
        server.terminate()
        server.wait(timeout=10)
