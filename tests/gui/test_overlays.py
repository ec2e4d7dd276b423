"""Rulings and the Gauss image, switched on in the sidebar, are drawn in the view."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

from tests.gui.person import settled
from tests.gui.program import Program
from tests.gui.screen import Place, along

Picture = Callable[..., Path]
#: The colours of the five patches of the sample on the screen, 0 to 255, and how far a pixel may be from one.
PATCHES = ((230, 143, 0), (64, 168, 242), (0, 168, 120), (219, 92, 26), (204, 120, 166))
NEAR = 24


def sidebar(blender: Program) -> list[int]:
    return blender.ask("regions")["UI"]


def pixels_of_patches(path: Path, box: list[int]) -> list[int]:
    """How many pixels of a part of the screen have the colour of each patch."""
    with Image.open(path) as picture:
        part = np.asarray(picture.convert("RGB").crop(box)).astype(int)
    return [int((np.abs(part - color).max(axis=2) < NEAR).sum()) for color in PATCHES]


def free_view(blender: Program) -> list[int]:
    """Of the 3D view, what the sidebar leaves free."""
    left, top, _, bottom = blender.ask("regions")["WINDOW"]
    return [left, top, sidebar(blender)[0], bottom]


def test_a_folded_sample(blender: Program) -> None:
    blender.ask("prepare", sample="corner_arcs", resolution=24, points=[])
    blender.rest()
    blender.screen.key("n")
    blender.click_on("Curvefold", upright=True)
    left, _, right, _ = sidebar(blender)
    place: Place = blender.find("Fold", sidebar(blender))
    blender.screen.drag([place, *along(place, (place[0] + 0.7 * (right - left), place[1]), 40)])
    assert settled(blender)["papers"]


def test_the_gauss_image_is_drawn_in_the_colours_of_the_patches(
    blender: Program, picture: Picture, shot: Picture
) -> None:
    blender.click_on("Overlays", sidebar(blender))
    blender.click_on("Rulings", sidebar(blender))
    blender.rest()
    before = shot("rulings")
    blender.click_on("Gauss Image", sidebar(blender))
    blender.rest()
    settled(blender)
    box = free_view(blender)
    after = picture("gauss_image", (*box[:3], box[1] + 500))
    drawn = np.subtract(pixels_of_patches(after, box), pixels_of_patches(before, box))
    # More than the mark on the patch, of 55 pixels at most.
    assert (drawn > 100).all(), drawn


def test_objects_are_made_by_the_buttons(blender: Program, shot: Picture) -> None:
    blender.click_on("Rulings as Object", sidebar(blender))
    facts = blender.until(lambda facts: "Paper Rulings" in facts["objects"], "there are rulings")
    assert facts["objects"]["Paper Rulings"]["parent"] == "Paper"
    blender.click_on("Gauss Image as Object", sidebar(blender))
    facts = blender.until(lambda facts: "Paper Gauss Image" in facts["objects"], "there is a Gauss image")
    shot("kept_lines")
    blender.rest()
    blender.screen.key("ctrl+z")
    facts = blender.until(lambda facts: "Paper Gauss Image" not in facts["objects"], "it is undone")
    assert "Paper Rulings" in facts["objects"]
    assert facts["papers"]


def test_nothing_was_reported_as_an_error(blender: Program) -> None:
    words = blender.log.read_text()
    assert "Traceback" not in words, words
    assert "could not be drawn" not in words, words
