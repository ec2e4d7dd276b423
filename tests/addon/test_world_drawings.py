"""Drawings as other programs write them, brought into Blender and folded there: the files that the solver reads."""

from pathlib import Path

import bpy
import numpy as np
import pytest

CASES = Path(__file__).parents[1] / "solver" / "pattern" / "cases"


def sheets() -> list[bpy.types.Object]:
    return [item for item in bpy.data.objects if item.curvefold.role == "SHEET"]


def test_a_curve_in_forty_strokes_is_one_curve_object():
    assert bpy.ops.curvefold.import_drawing(filepath=str(CASES / "split40.svg")) == {"FINISHED"}
    [sheet] = sheets()
    [crease] = sheet.children
    [spline] = crease.data.splines
    assert len(spline.points) + len(spline.bezier_points) == 41


@pytest.mark.parametrize(("name", "count"), [("three_sheets.svg", 3), ("two_sheets.fold", 2)])
def test_all_sheets_of_a_file_come_in_as_they_lie_in_it(name, count):
    assert bpy.ops.curvefold.import_drawing(filepath=str(CASES / name)) == {"FINISHED"}
    found = sorted(sheets(), key=lambda sheet: sheet.location.x)
    assert len(found) == count
    assert all(len(sheet.children) == 1 for sheet in found)
    steps = np.diff([sheet.location.x for sheet in found])
    assert np.allclose(steps, steps[0])
    assert steps[0] > found[0].dimensions.x  # side by side, with the gap between them


def test_the_page_may_be_chosen():
    path = str(CASES / "cad_layers.svg")
    assert bpy.ops.curvefold.import_drawing(filepath=path) == {"FINISHED"}
    assert bpy.ops.curvefold.import_drawing(filepath=path, border="PAGE") == {"FINISHED"}
    drawn, page = sorted(sheet.dimensions.x for sheet in sheets())
    assert page / drawn == pytest.approx(1.2)


def test_a_drawing_without_border_is_folded_on_its_page():
    path = str(CASES / "viewbox_sheet.svg")
    assert bpy.ops.curvefold.fold_drawing(filepath=path, resolution=12, angle=0.5) == {"FINISHED"}
    assert bpy.context.active_object.data.curvefold.is_paper
