"""A film that is rendered from the window has the frames of the background, with motion blur, and locks it."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.gui.person import settled
from tests.gui.program import ROOT, Installation, Program

DRAWING = ROOT / "sample_patterns" / "waves.svg"


@pytest.fixture(scope="module")
def frames(installation: Installation) -> dict[int, str]:
    """Digests of the frames that the same program folds without a window, by their numbers."""
    (installation.work / DRAWING.name).write_bytes(DRAWING.read_bytes())
    arguments = ["--background", "--python-exit-code", 1, "--python", installation.inside / "bits.py"]
    arguments += ["--", f"{installation.inside}/{DRAWING.name}", installation.inside / "bits.json"]
    subprocess.run(
        installation.run(*arguments), env=installation.environment(), check=True, stdout=subprocess.DEVNULL
    )
    return dict(json.loads((installation.work / "bits.json").read_text())["frames"])


def test_a_film_with_motion_blur_has_the_frames_of_the_background(
    blender: Program, frames: dict[int, str], shot: Callable[[str], Path]
) -> None:
    blender.ask("film")
    settled(blender)
    assert blender.ask("filmed")["locks"]
    blender.rest()
    blender.screen.key("ctrl+F12")

    def film() -> dict[str, Any]:
        return blender.ask("filmed")

    blender.until(lambda _: {frame for frame, *_ in film()["frames"]} == set(frames), "all frames are rendered")
    shot("film-rendering")
    blender.until(lambda _: not film()["rendering"], "the film is finished")
    shot("film-finished")
    seen = film()["frames"]
    assert [entry for entry in seen if frames[entry[0]] != entry[1]] == []
    assert all(locked for *_, locked in seen)
    pictures = sorted(path.name for path in (blender.work / "film").iterdir())
    assert len(pictures) == len(frames)


def test_the_window_works_again_and_the_lock_is_given_back(blender: Program, shot: Callable[[str], Path]) -> None:
    blender.screen.key("Escape")
    settled(blender)
    blender.ask("still")
    blender.until(lambda _: not blender.ask("filmed")["locks"], "the lock is given back")
    shot("film-still")
