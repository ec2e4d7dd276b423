"""The tab stays still, the drawing keeps out of the way, and handles find the corners of the paper."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.gui.person import of_role, paper, settled
from tests.gui.program import Program
from tests.gui.screen import Place, along

Picture = Callable[..., Path]

#: A click misses a corner by so many pixels to the right and downwards.
BESIDE = (5.0, 3.0)
#: Half the side of the sample's sheet, metres.
HALF = 0.08


def sidebar(blender: Program) -> list[int]:
    return blender.ask("regions")["UI"]


def test_a_sample_is_one_click_away(blender: Program, shot: Picture) -> None:
    blender.rest()
    blender.screen.key("a", "Delete", "n")
    blender.click_on("Curvefold", upright=True)
    shot("samples_in_tab")
    blender.click_on("Corner arcs", sidebar(blender))
    facts = blender.until(lambda facts: of_role(facts, "SHEET"), "there is a sheet")
    assert len(of_role(facts, "CREASE")) == 4


def test_a_new_paper_hides_its_drawing_and_the_switch_shows_it(blender: Program, shot: Picture) -> None:
    blender.click_on("Make Paper", sidebar(blender))
    settled(blender)
    facts = blender.facts()
    assert not any(facts["objects"][name]["seen"] for name in of_role(facts, "SHEET") | of_role(facts, "CREASE"))
    blender.rest()
    shot("hidden_drawing")
    blender.click_on("Show Drawing", sidebar(blender))
    facts = blender.facts()
    assert all(facts["objects"][name]["seen"] for name in of_role(facts, "SHEET") | of_role(facts, "CREASE"))
    blender.rest()
    shot("shown_drawing")
    blender.click_on("Show Drawing", sidebar(blender))


def test_nothing_moves_while_the_paper_folds_and_settles(blender: Program) -> None:
    left, _, right, _ = sidebar(blender)
    before = blender.find("Creases", sidebar(blender))
    place: Place = blender.find("Fold", sidebar(blender))
    blender.screen.drag([place, *along(place, (place[0] + 0.5 * (right - left), place[1]), 40)])
    assert blender.find("Creases", sidebar(blender)) == before
    settled(blender)
    blender.rest()
    assert blender.find("Creases", sidebar(blender)) == before


def test_a_key_places_handles_and_a_click_beside_a_corner_means_it(blender: Program, shot: Picture) -> None:
    blender.rest()
    blender.screen.key("ctrl+alt+h")
    corner = blender.place(paper(blender.facts())["corners"][2])
    blender.screen.click((corner[0] + BESIDE[0], corner[1] + BESIDE[1]))
    blender.screen.key("Escape")
    facts = settled(blender)
    assert paper(facts)["points"] == [pytest.approx([HALF, HALF], abs=1e-6)]
    blender.rest()
    shot("handle_at_corner")


def test_another_key_draws_a_crease_and_shows_the_drawing(blender: Program) -> None:
    blender.rest()
    blender.screen.key("ctrl+alt+k")
    facts = blender.until(lambda facts: facts["mode"] == "EDIT_CURVE", "a crease can be drawn")
    assert len(of_role(facts, "CREASE")) == 5
    assert all(facts["objects"][name]["seen"] for name in of_role(facts, "CREASE"))
    blender.screen.key("Tab")
    blender.until(lambda facts: facts["mode"] == "OBJECT", "the crease is done")


def test_nothing_was_reported_as_an_error(blender: Program) -> None:
    words = blender.log.read_text()
    assert "Traceback" not in words, words
    assert "could not be drawn" not in words, words
