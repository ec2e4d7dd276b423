"""A person's way through the extension, in a real Blender on a virtual screen: ``make test-gui``.

The tests of a file are steps that follow one another in one running Blender. They press keys, move the mouse and
click on what they read; what they assert, they ask Blender itself. Screenshots of every step go to out/gui.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.gui.program import ROOT, Installation, Program
from tests.gui.screen import HEIGHT, WIDTH, Screen, crop, virtual_screen

OUT = ROOT / "out" / "gui"


@pytest.fixture(scope="session")
def screen() -> Iterator[Screen]:
    with virtual_screen() as screen:
        yield screen


@pytest.fixture(scope="session")
def installation(screen: Screen) -> Installation:
    installation = Installation(os.environ.get("BLENDER_GUI", "trixie"), screen, "gui")
    archives = sorted((ROOT / "dist").glob("curvefold-*-linux_x64.zip"))
    assert archives, "there is no zip in dist: make zip"
    installation.install(archives[-1])
    return installation


@pytest.fixture(scope="module")
def blender(request: pytest.FixtureRequest, installation: Installation) -> Iterator[Program]:
    """One Blender for all the steps of a file, in a window of its size ``WINDOW`` when it has one."""
    window = getattr(request.module, "WINDOW", (WIDTH, HEIGHT))
    with installation.start(request.module.__name__.rpartition(".")[2], *window) as program:
        yield program


@pytest.fixture
def shot(blender: Program) -> Callable[[str], Path]:
    """``shot("03-paper")``: what is on the screen, as a picture in out/gui."""

    def take(name: str) -> Path:
        path = OUT / f"{name}.png"
        blender.screen.shot(path)
        return path

    return take


@pytest.fixture
def picture(shot: Callable[[str], Path]) -> Callable[..., Path]:
    """``picture("paper", box)``: the same, and cut out for the user guide when its pictures are wanted."""

    def take(name: str, box: tuple[float, float, float, float]) -> Path:
        path = shot(name)
        folder = os.environ.get("GUIDE_PICTURES")
        if folder:
            crop(path, ROOT / folder / f"{name}.png", box)
        return path

    return take
