"""A real Blender on a virtual screen, with the built extension installed in it, and the probe inside it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import fftconvolve

from tests.gui.screen import HEIGHT, WIDTH, Place, Screen

ROOT = Path(__file__).absolute().parents[2]
SCRIPT = ROOT / "scripts" / "blender_gui.sh"
HERE = Path(__file__).parent

#: Seconds that Blender may take to start, and to answer: generous, for a machine with other work to do.
START = 90.0
ANSWER = 60.0
LOOK = 10.0  # for a text to appear
WAIT = 240.0  # for a paper to settle, drawn by a busy machine's software renderer
#: Correlation above which a text counts as found on the screen. Equal pixels have 1, other texts below 0.6.
SAME_TEXT = 0.75
#: Places of a screen that are looked at for a text, best first.
MOST_PLACES = 200
#: Where the next word would begin, pixels right of a text, and the contrast that makes it visible.
GAP = (2, 8)
VISIBLE = 0.2


class GoneError(AssertionError):
    """Blender has ended or answers no longer."""


class Program:
    def __init__(self, screen: Screen, process: subprocess.Popen[bytes], work: Path, log: Path) -> None:
        self.screen = screen
        self.process = process
        self.work = work
        self.log = log
        self._letterings: dict[str, np.ndarray] = {}

    def ask(self, name: str, **arguments: object) -> Any:
        """Has the probe run one of its functions."""
        part, order, answer = (self.work / n for n in ("command.part", "command.json", "answer.json"))
        answer.unlink(missing_ok=True)
        part.write_text(json.dumps({"name": name, "arguments": arguments}))
        os.replace(part, order)
        end = time.monotonic() + ANSWER
        while not answer.exists():
            if self.process.poll() is not None:
                raise GoneError(f"Blender ended with {self.process.returncode}; its last words are in {self.log}")
            if time.monotonic() > end:
                raise GoneError(f"Blender does not answer {name}; its last words are in {self.log}")
            time.sleep(0.01)
        found = json.loads(answer.read_text())
        if "error" in found:
            raise AssertionError(found["error"])
        return found["answer"]

    def understood(self) -> None:
        """Waits until Blender has dealt with the mouse and the keyboard so far, and has drawn the result."""
        for _ in range(3):  # what is answered first may have been asked before the events were read
            self.ask("awake")

    def facts(self) -> dict[str, Any]:
        return self.ask("facts")

    def place(self, point: list[float] | tuple[float, ...]) -> Place:
        """Where a point of the scene is on the screen."""
        found = self.ask("on_screen", points=[list(point)])[0]
        assert found is not None, f"{point} is not in view"
        return found[0], found[1]

    def until(self, true: Callable[[dict[str, Any]], Any], what: str, seconds: float = WAIT) -> dict[str, Any]:
        """Waits for a fact; returns the facts with which it came true."""
        end = time.monotonic() + seconds
        while True:
            facts = self.facts()
            if true(facts):
                return facts
            if time.monotonic() > end:
                raise AssertionError(f"after {seconds:g} s still not: {what}\n{json.dumps(facts, indent=1)}")
            time.sleep(0.2)

    def look_for(self, text: str, within: list[int] | None = None, upright: bool = False) -> Place | None:
        """The middle of a text on the screen, as a reader finds it; None when it is nowhere.

        ``upright`` texts run from above to below, as the names on the sidebar's tabs do.
        """
        if text not in self._letterings:
            rows = np.array(self.ask("lettering", text=text)["rows"], dtype=float) / 255.0
            self._letterings[text] = _trimmed(rows)
        letters = np.rot90(self._letterings[text], -1) if upright else self._letterings[text]
        left, top, right, bottom = within or (0, 0, WIDTH, HEIGHT)
        grey = self.screen.grey()[top:bottom, left:right]
        found = _correlation(grey, letters)
        height, width = letters.shape
        for k in np.argsort(found, axis=None)[::-1][:MOST_PLACES]:
            row, column = np.unravel_index(k, found.shape)
            if found[row, column] < SAME_TEXT:
                break
            if upright or _ends_there(grey[row : row + height, column + width :]):
                return float(left + column + width / 2), float(top + row + height / 2)
        return None

    def find(self, text: str, within: list[int] | None = None, upright: bool = False) -> Place:
        end = time.monotonic() + LOOK
        while (place := self.look_for(text, within, upright)) is None:
            if time.monotonic() > end:
                raise AssertionError(f"nothing on the screen reads {text!r}")
            time.sleep(0.3)
        return place

    def click_on(self, text: str, within: list[int] | None = None, upright: bool = False) -> None:
        self.screen.click(self.find(text, within, upright))

    def rest(self) -> None:
        """Puts the mouse where it touches nothing: in the middle of the 3D view."""
        left, top, right, bottom = self.ask("regions")["WINDOW"]
        self.screen.move(((left + right) / 2, (top + bottom) / 2))
        self.understood()

    def processor_seconds(self) -> dict[str, float]:
        """What Blender has computed so far, by the names of its threads."""
        spent: dict[str, float] = {}
        for task in Path(f"/proc/{self.process.pid}/task").iterdir():
            name, _, fields = (task / "stat").read_text().partition("(")[2].rpartition(")")
            seconds = sum(map(int, fields.split()[11:13])) / os.sysconf("SC_CLK_TCK")
            spent[name] = spent.get(name, 0.0) + seconds
        return spent


def _trimmed(rows: np.ndarray) -> np.ndarray:
    """Without the empty rows and columns around."""
    filled = rows > 0.2
    down, across = np.flatnonzero(filled.any(axis=1)), np.flatnonzero(filled.any(axis=0))
    return rows[down[0] : down[-1] + 1, across[0] : across[-1] + 1]


def _ends_there(right_of_it: np.ndarray) -> bool:
    """Whether nothing follows a text: "Fold" is not the beginning of "Folding"."""
    strip = right_of_it[:, GAP[0] : GAP[1]]
    return strip.size == 0 or float(np.ptp(strip)) < VISIBLE


def _correlation(picture: np.ndarray, pattern: np.ndarray) -> np.ndarray:
    """Normalised correlation of a pattern with every place of a picture; dark letters count as light ones do."""
    if picture.shape[0] < pattern.shape[0] or picture.shape[1] < pattern.shape[1]:
        return np.zeros((0, 0))
    centred = pattern - pattern.mean()
    box = np.ones_like(pattern)
    sums = fftconvolve(picture, box, mode="valid")
    squares = fftconvolve(picture**2, box, mode="valid")
    variance = np.maximum(squares - sums**2 / pattern.size, 1e-3)
    products = fftconvolve(picture, centred[::-1, ::-1], mode="valid")
    return np.abs(products) / np.sqrt(variance * (centred**2).sum())


class Installation:
    """The extension in a clean user folder of one of the two Blenders."""

    def __init__(self, suite: str, screen: Screen, folder: str) -> None:
        self.suite = suite
        self.screen = screen
        output = subprocess.run([SCRIPT, "tree", suite], check=True, stdout=subprocess.PIPE, text=True).stdout
        self.tree = Path(output.strip())
        self.work = self.tree / "work" / folder
        self.inside = Path("/work") / folder
        shutil.rmtree(self.work, ignore_errors=True)
        (self.work / "tmp").mkdir(parents=True)
        for script in ("probe.py", "bits.py"):
            shutil.copy(HERE / script, self.work)

    def run(self, *arguments: object) -> list[str]:
        return [str(SCRIPT), "run", self.suite, str(self.inside), *map(str, arguments)]

    def environment(self) -> dict[str, str]:
        return os.environ | {"DISPLAY": self.screen.display}

    def install(self, archive: Path) -> None:
        target = self.work / "curvefold.zip"
        if self.suite == "sid":
            without_binary_wheels(archive, target)
        else:
            shutil.copy(archive, target)
        (self.work / "install.py").write_text(
            "import bpy\n"
            "bpy.ops.extensions.package_install_files(\n"
            f"    filepath='{self.inside}/curvefold.zip', repo='user_default', enable_on_install=True)\n"
            "assert 'bl_ext.user_default.curvefold' in bpy.context.preferences.addons\n"
            "view = bpy.context.preferences.view\n"
            "view.show_splash = False\n"
            # A window of its own would need a window manager.
            "view.filebrowser_display_type = 'SCREEN'\n"
            "bpy.ops.wm.save_userpref()\n"
        )
        subprocess.run(
            self.run("--background", "--python-exit-code", 1, "--python", self.inside / "install.py"),
            env=self.environment(),
            check=True,
            stdout=subprocess.DEVNULL,
        )

    @contextmanager
    def start(self, name: str, width: int = WIDTH, height: int = HEIGHT) -> Iterator[Program]:
        """Blender with its window at the upper left of the screen, for as long as the block runs."""
        log = self.work / f"{name}.log"
        arguments = ["--window-geometry", 0, HEIGHT - height, width, height]
        arguments += ["--python", self.inside / "probe.py", "--", self.inside]
        with log.open("wb") as words:
            process = subprocess.Popen(
                self.run(*arguments), env=self.environment(), stdout=words, stderr=subprocess.STDOUT
            )
            program = Program(self.screen, process, self.work, log)
            try:
                _wait_for_start(program)
                self.screen.understood = program.understood
                yield program
            finally:
                self.screen.understood = lambda: None
                process.kill()  # a clean end would ask what to do with the unsaved file
                process.wait(timeout=10)


def _wait_for_start(program: Program) -> None:
    end = time.monotonic() + START
    while True:
        try:
            program.ask("awake")
            break
        except AssertionError:
            if program.process.poll() is not None or time.monotonic() > end:
                raise
    time.sleep(1.0)  # the first frames


def without_binary_wheels(archive: Path, target: Path) -> None:
    """The zip for a Python that the bundled wheels are not made for, and whose libraries are installed."""
    with zipfile.ZipFile(archive) as source, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as copy:
        for entry in source.infolist():
            if "-cp3" in entry.filename:
                continue
            data = source.read(entry)
            if entry.filename.endswith("blender_manifest.toml"):
                lines = data.decode().splitlines(keepends=True)
                data = "".join(line for line in lines if "-cp3" not in line).encode()
            copy.writestr(entry, data)
