"""What a person does who has never seen this: an empty scene, a sheet, a crease, a fold, handles, a drag, undo."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.gui import person
from tests.gui.following import following
from tests.gui.keystrokes import estimate
from tests.gui.person import beside, grab, let_go, of_role, paper, settled
from tests.gui.program import ROOT, Program
from tests.gui.screen import along

Picture = Callable[..., Path]

#: How far a hand drags a handle, pixels, and for how long, seconds.
REACH = 90.0
HAND = 3.0


def paper_and_sidebar(blender: Program) -> tuple[int, int, int, int]:
    """What a picture in the guide needs of the 3D view: all of it but the lowest part."""
    left, top, right, _ = blender.ask("regions")["AREA"]
    return left, top, right, top + 500


def two_minutes() -> str:
    """The steps of the guide that the story follows."""
    guide = (ROOT / "docs" / "user_guide.md").read_text(encoding="utf-8")
    begin = guide.index("**1. ", guide.index("## Two minutes to a folded sheet"))
    return guide[begin : guide.index("That is all", begin)]


def sidebar(blender: Program) -> list[int]:
    return blender.ask("regions")["UI"]


def test_a_sheet_comes_from_the_add_menu(blender: Program, picture: Picture) -> None:
    screen = blender.screen
    blender.rest()
    screen.actions.clear()
    screen.key("a", "Delete")  # the cube, the light and the camera of a new scene
    assert blender.facts()["objects"] == {}
    blender.click_on("Add")
    blender.click_on("Paper Sheet")
    screen.move(blender.find("A4"))
    time.sleep(0.5)
    picture("sheet_menu", (220, 27, 760, 640))
    blender.click_on("A4")
    facts = blender.until(lambda facts: of_role(facts, "SHEET"), "there is a sheet")
    (sheet,) = of_role(facts, "SHEET").values()
    assert np.ptp(sheet["box"], axis=0) == pytest.approx([0.210, 0.297, 0.0], abs=1e-6)
    corners = [blender.place(corner) for corner in sheet["box"]]
    assert np.ptp(corners, axis=0).max() > 200.0, "the sheet is too small to draw on"


def test_the_sidebar_has_a_tab(blender: Program, picture: Picture) -> None:
    blender.rest()
    blender.screen.key("n")
    blender.click_on("Curvefold", upright=True)
    blender.find("Draw Crease", sidebar(blender))
    picture("sheet", paper_and_sidebar(blender))


def test_a_crease_is_drawn_with_the_mouse(blender: Program, picture: Picture) -> None:
    blender.click_on("Draw Crease", sidebar(blender))
    blender.until(lambda facts: facts["mode"] == "EDIT_CURVE", "the curve can be drawn")
    # A little beyond the border on both sides: the paper is trimmed there.
    way = [(-0.115 + 0.23 * t, -0.05 + 0.08 * math.sin(math.pi * t), 0.0) for t in np.linspace(0.0, 1.0, 60)]
    blender.screen.drag([blender.place(point) for point in way])
    picture("crease", paper_and_sidebar(blender))
    facts = blender.facts()
    (crease,) = of_role(facts, "CREASE").values()
    assert crease["parent"] in of_role(facts, "SHEET")


def test_one_button_makes_the_paper(blender: Program, picture: Picture) -> None:
    blender.click_on("Make Paper", sidebar(blender))
    facts = blender.until(lambda facts: facts["papers"], "there is a paper")
    assert facts["mode"] == "OBJECT"
    assert paper(facts)["height"] == 0.0
    assert paper(settled(blender))["report"]["sentence"] == "Flat"
    blender.rest()
    picture("paper", paper_and_sidebar(blender))


def test_the_slider_folds(blender: Program, picture: Picture) -> None:
    left, _, right, _ = sidebar(blender)
    place = blender.find("Fold", sidebar(blender))
    blender.screen.drag([place, *along(place, (place[0] + 0.5 * (right - left), place[1]), 40)])
    facts = settled(blender)
    assert 20.0 < paper(facts)["fold"] < 90.0
    assert paper(facts)["height"] > 0.01
    assert paper(facts)["report"]["fold_angle"] == pytest.approx(0.9 * paper(facts)["fold"], abs=2.0)
    assert paper(facts)["report"]["state"] == "settled"
    blender.rest()
    picture("fold", paper_and_sidebar(blender))


def test_two_clicks_place_two_handles(blender: Program, picture: Picture) -> None:
    blender.click_on("Place Handles", sidebar(blender))
    # The two corners of the far side, a tenth of the way inwards.
    corners = np.array(paper(blender.facts())["corners"])
    for k, towards in ((1, 3), (2, 0)):
        blender.screen.click(blender.place((0.9 * corners[k] + 0.1 * corners[towards]).tolist()))
    blender.screen.key("Escape")
    facts = settled(blender)
    assert len(set(paper(facts)["hooks"])) == 2
    assert all(facts["objects"][hook]["type"] == "EMPTY" for hook in paper(facts)["hooks"])
    blender.rest()
    picture("handles", paper_and_sidebar(blender))


def test_the_paper_follows_a_drag(blender: Program, picture: Picture) -> None:
    name = next(iter(blender.facts()["papers"]))
    hook = paper(blender.facts())["hooks"][0]
    before = settled(blender)
    blender.ask("record", paper=name, hook=hook)
    start = grab(blender, hook)
    blender.screen.glide(start, beside(start, -0.3 * REACH, REACH), HAND)
    during = blender.facts()
    assert "TRANSFORM_OT_translate" in during["modal"]
    assert paper(during)["hash"] != paper(before)["hash"], "the paper waits for the end of the drag"
    picture("drag", paper_and_sidebar(blender))
    let_go(blender)
    newcomer = estimate(blender.screen.actions, two_minutes())
    print(f"\n  {newcomer}")
    assert newcomer.seconds < 120.0, "the guide promises two minutes"
    found = following(blender.ask("recorded")["events"])
    print(f"\n  {paper(before)['vertices']} vertices: {found.frames:.1f} frames, {found.ticks:.1f} ticks a second")
    after = settled(blender)
    assert paper(after)["finite"]
    assert after["objects"][hook]["place"] != before["objects"][hook]["place"]
    assert paper(after)["report"]["state"] == "settled", paper(after)["report"]["sentence"]
    blender.rest()
    picture("dragged", paper_and_sidebar(blender))


def test_escape_returns_empty_and_paper(blender: Program) -> None:
    before = settled(blender)
    hook = paper(before)["hooks"][1]
    start = grab(blender, hook)
    blender.screen.glide(start, beside(start, REACH, 0.0), 1.0)
    assert paper(blender.facts())["hash"] != paper(before)["hash"]
    blender.screen.key("Escape")
    after = settled(blender)
    assert after["objects"][hook]["place"] == before["objects"][hook]["place"]
    assert paper(after)["hash"] == paper(before)["hash"]


def test_undo_in_the_middle_of_a_drag_does_no_harm(blender: Program) -> None:
    before = settled(blender)
    hook = paper(before)["hooks"][1]
    start = grab(blender, hook)
    blender.screen.glide(start, beside(start, 0.5 * REACH, 0.5 * REACH), 1.0)
    blender.screen.key("ctrl+z")
    blender.screen.glide(beside(start, 0.5 * REACH, 0.5 * REACH), beside(start, 0.5 * REACH, 0.0), 1.0)
    if "TRANSFORM_OT_translate" in blender.facts()["modal"]:
        blender.screen.key("Escape")
    after = settled(blender)
    assert paper(after)["finite"]
    assert after["objects"][hook]["place"] == before["objects"][hook]["place"]
    assert paper(after)["hash"] == paper(before)["hash"]


def test_undo_and_redo_step_over_a_drag(blender: Program) -> None:
    before = settled(blender)
    hook = paper(before)["hooks"][1]
    start = grab(blender, hook)
    blender.screen.glide(start, beside(start, 0.2 * REACH, 0.6 * REACH), 1.0)
    let_go(blender)
    after = settled(blender)
    assert paper(after)["hash"] != paper(before)["hash"]
    blender.rest()
    blender.screen.key("ctrl+z")
    undone = settled(blender)
    assert undone["objects"][hook]["place"] == before["objects"][hook]["place"]
    assert paper(undone)["hash"] == paper(before)["hash"]
    blender.screen.key("ctrl+shift+z")
    redone = settled(blender)
    assert redone["objects"][hook]["place"] == after["objects"][hook]["place"]
    assert paper(redone)["hash"] == paper(after)["hash"]


def test_a_saved_paper_opens_as_it_was(blender: Program) -> None:
    before = settled(blender)
    person.save_as(blender, "letter")
    # Something else in between, so that opening has to bring everything back.
    blender.screen.key("a", "Delete")
    assert blender.facts()["papers"] == {}
    person.open_file(blender, "letter.blend")
    after = settled(blender)
    assert after["objects"] == before["objects"]
    assert paper(after) == paper(before) | {"report": paper(after)["report"]}


def test_a_drag_goes_on_after_opening(blender: Program, picture: Picture) -> None:
    before = settled(blender)
    hook = paper(before)["hooks"][0]
    start = grab(blender, hook)
    blender.screen.glide(start, beside(start, 0.4 * REACH, 0.2 * REACH), 1.0)
    let_go(blender)
    after = settled(blender)
    assert paper(after)["finite"]
    assert paper(after)["hash"] != paper(before)["hash"]
    assert paper(after)["report"]["state"] == "settled", paper(after)["report"]["sentence"]


def test_nothing_was_reported_as_an_error(blender: Program) -> None:
    words = blender.log.read_text()
    assert "Traceback" not in words, words
    assert "Error" not in words, words
