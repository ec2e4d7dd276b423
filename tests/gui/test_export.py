"""File > Export > Crease Pattern Plan, by a person: the menu, the dialog, a file."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from tests.gui.person import settled
from tests.gui.program import Installation, Program


def test_a_plan_is_exported_from_the_menu(
    blender: Program, installation: Installation, shot: Callable[[str], Path]
) -> None:
    blender.rest()
    blender.screen.key("a", "Delete")
    blender.ask("prepare", sample="crossing", resolution=16, points=[])
    settled(blender)
    blender.click_on("File")
    blender.click_on("Export")
    shot("export-menu")
    blender.click_on("Crease Pattern Plan (.svg, .dxf, .pdf)")
    blender.find("Profile")
    shot("export-dialog")
    blender.click_on("Export Plan")
    blender.rest()
    shot("export-done")
    (plan,) = installation.work.rglob("*plan.svg")
    text = plan.read_text(encoding="utf-8")
    assert re.search(r'width="170mm" height="170mm"', text)
    assert "Curvefold plan" in text
