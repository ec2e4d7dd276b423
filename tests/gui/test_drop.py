"""A drawing that is dragged from a file manager into the 3D view."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from dxf_files import border, entity, r12

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


def test_a_dropped_drawing_of_another_format(
    blender: Program, installation: Installation, shot: Callable[[str], Path]
) -> None:
    crease = entity("ARC", (10, 50), (20, -20), (40, 80), (50, 45), (51, 135), layer="valley")
    (installation.work / "arc.dxf").write_bytes(r12(border(), crease, header=[(9, "$INSUNITS"), (70, 4)]))
    blender.rest()
    blender.screen.key("a", "Delete")
    left, top, right, bottom = blender.ask("regions")["WINDOW"]
    blender.screen.drop(((left + right) / 2, (top + bottom) / 2), f"{installation.inside}/arc.dxf")
    facts = blender.until(lambda facts: "arc" in of_role(facts, "SHEET"), "there is a sheet", 20.0)
    shot("drop-dxf")
    (crease_found,) = of_role(facts, "CREASE").values()
    assert crease_found["parent"] == "arc"
