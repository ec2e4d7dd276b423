"""A drawing that is dragged from a file manager into the 3D view."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.gui.person import of_role
from tests.gui.program import ROOT, Installation, Program

DRAWING = ROOT / "sample_patterns" / "waves.svg"


def test_a_dropped_drawing_is_a_sheet_with_creases(
    blender: Program, installation: Installation, shot: Callable[[str], Path]
) -> None:
    (installation.work / "dropped waves.svg").write_bytes(DRAWING.read_bytes())
    blender.rest()
    blender.screen.key("a", "Delete")
    left, top, right, bottom = blender.ask("regions")["WINDOW"]
    blender.screen.drop(((left + right) / 2, (top + bottom) / 2), f"{installation.inside}/dropped waves.svg")
    shot("drop")
    blender.click_on("Import Crease Pattern")  # Blender itself can read such files as grease pencil
    facts = blender.until(lambda facts: of_role(facts, "SHEET"), "there is a sheet", 20.0)
    (sheet,) = of_role(facts, "SHEET")
    creases = of_role(facts, "CREASE")
    assert creases
    assert all(crease["parent"] == sheet for crease in creases.values())
