"""What a person does with a paper, and what is looked at afterwards."""

from __future__ import annotations

import time
from typing import Any

from tests.gui.program import Program
from tests.gui.screen import HEIGHT, Place

#: Seconds that Blender gets to answer a key or a click.
SOON = 10.0
#: Where Blender's file browser has its fields, pixels from the top.
FIELDS = HEIGHT - 70
#: Seconds for which a paper has to stay as it is to be believed.
ASLEEP = 1.0


def paper(facts: dict[str, Any]) -> dict[str, Any]:
    """The one paper there is."""
    (found,) = facts["papers"].values()
    return found


def of_role(facts: dict[str, Any], role: str) -> dict[str, Any]:
    """Sheets or creases by name."""
    return {name: thing for name, thing in facts["objects"].items() if thing["role"] == role}


def rests(facts: dict[str, Any]) -> bool:
    """The paper has settled, and nothing runs."""
    if not facts["papers"] or facts["modal"]:
        return False
    report = paper(facts)["report"]
    return report is not None and report["state"] != "folding"


def settled(blender: Program) -> dict[str, Any]:
    """Waits for the paper to rest; returns the facts."""
    while True:
        first = blender.until(rests, "the paper rests")
        time.sleep(ASLEEP)
        again = blender.facts()
        if rests(again) and paper(again)["hash"] == paper(first)["hash"]:
            return again


def beside(place: Place, right: float, up: float) -> Place:
    return place[0] + right, place[1] - up


def grab(blender: Program, empty: str) -> Place:
    """Selects an empty with a click and presses G; returns where it is."""
    facts = blender.facts()
    place = blender.place(facts["objects"][empty]["place"])
    if facts["active"] == empty and facts["objects"][empty]["selected"]:
        blender.screen.move(place)  # another click would select what is behind it
        blender.understood()
    else:
        blender.screen.click(place)
    blender.until(lambda facts: facts["active"] == empty, f"{empty} is selected", SOON)
    blender.screen.key("g")
    blender.until(lambda facts: "TRANSFORM_OT_translate" in facts["modal"], f"{empty} moves", SOON)
    return place


def let_go(blender: Program) -> None:
    blender.screen.press()
    blender.screen.release()
    blender.understood()


def save_as(blender: Program, name: str) -> None:
    """Ctrl+S in a file that has no name yet."""
    screen = blender.screen
    blender.rest()
    screen.key("ctrl+s")
    place = blender.find("untitled.blend")
    screen.click(place)
    screen.click(place)
    screen.key("ctrl+a")
    screen.type(name)
    screen.key("Return")
    blender.click_on("Save Blender File")
    blender.until(lambda facts: facts["file"].endswith(f"/{name}.blend"), "the file is saved")
    blender.rest()


def open_file(blender: Program, name: str) -> None:
    """Ctrl+O, and a click on the name."""
    before = blender.facts()["opened"]
    blender.rest()
    blender.screen.key("ctrl+o")
    if (place := blender.look_for("Don't Save")) is not None:
        blender.screen.click(place)
    if (place := blender.look_for(name)) is None or place[1] < FIELDS:
        blender.click_on(name)  # otherwise it is proposed, in the field at the bottom
    blender.click_on("Open")
    blender.until(lambda facts: facts["opened"] > before and facts["file"].endswith(f"/{name}"), f"{name} is open")
    blender.rest()
