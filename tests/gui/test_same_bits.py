"""What is folded in the window has the same bits as what the same program folds in the background."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.gui.person import paper, settled
from tests.gui.program import ROOT, Installation, Program

DRAWING = ROOT / "sample_patterns" / "waves.svg"
#: Times that the animation is played through.
TURNS = 2


@pytest.fixture(scope="module")
def drawing(installation: Installation) -> str:
    """The drawing's path for the Blender under test."""
    (installation.work / DRAWING.name).write_bytes(DRAWING.read_bytes())
    return f"{installation.inside}/{DRAWING.name}"


@pytest.fixture(scope="module")
def background(installation: Installation, drawing: str) -> dict[str, Any]:
    """What the same program folds without a window."""
    arguments = ["--background", "--python-exit-code", 1, "--python", installation.inside / "bits.py"]
    arguments += ["--", drawing, installation.inside / "bits.json"]
    subprocess.run(
        installation.run(*arguments), env=installation.environment(), check=True, stdout=subprocess.DEVNULL
    )
    return json.loads((installation.work / "bits.json").read_text())


def test_a_fold_that_is_waited_for(blender: Program, background: dict[str, Any]) -> None:
    assert blender.ask("waited_for") == background["waited_for"]


def test_a_fold_that_is_watched(blender: Program, background: dict[str, Any], shot: Callable[[str], Path]) -> None:
    blender.ask("folding")
    facts = settled(blender)
    shot("bits-watched")
    assert paper(facts)["exact"] == background["waited_for"]


def test_a_drawing_that_is_imported_folded(blender: Program, background: dict[str, Any], drawing: str) -> None:
    assert blender.ask("at_once", drawing=drawing) == background["at_once"]


def test_every_frame_of_an_animation_that_is_played(
    blender: Program, background: dict[str, Any], shot: Callable[[str], Path]
) -> None:
    expected = dict(background["frames"])
    assert len(set(expected.values())) == len(expected) > 1, "it moves in every frame"
    name = blender.ask("animated")
    settled(blender)
    blender.ask("watch_frames", paper=name)
    blender.rest()
    blender.screen.key("space")

    def played() -> list[list[Any]]:
        return blender.ask("seen_frames")

    blender.until(lambda _: len(played()) > TURNS * len(expected), "it is played through")
    shot("bits-played")
    blender.screen.key("Escape")
    seen = played()
    assert {frame for frame, _ in seen} == set(expected)
    assert [entry for entry in seen if expected[entry[0]] != entry[1]] == []
