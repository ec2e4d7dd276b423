"""Drawings of other formats than SVG come in by the same doors: import, fold, batch."""

import csv
import json

import bpy
import pytest
from dxf_files import border, entity, r12
from typed_files import SQUARE, cp, opx

CREASE = entity("ARC", (10, 50), (20, -20), (40, 80), (50, 45), (51, 135), (62, 1))


@pytest.fixture
def from_cad(tmp_path):
    path = tmp_path / "from CAD.DXF"
    path.write_bytes(r12(border(), CREASE, header=[(9, "$INSUNITS"), (70, 5)]))
    return path


def test_import(from_cad):
    bpy.ops.curvefold.import_drawing(filepath=str(from_cad))
    sheet = next(item for item in bpy.data.objects if item.curvefold.role == "SHEET")
    assert sheet.name.startswith("from CAD")
    assert max(sheet.dimensions) == pytest.approx(1.0)  # 100 cm


def test_the_unit_may_be_chosen(from_cad):
    bpy.ops.curvefold.import_drawing(filepath=str(from_cad), unit="mm")
    sheet = next(item for item in bpy.data.objects if item.curvefold.role == "SHEET")
    assert max(sheet.dimensions) == pytest.approx(0.1)


def test_batch(extension, from_cad, tmp_path):
    out = tmp_path / "out"
    main = extension("curvefold_addon.cli").main
    assert main(["batch", str(tmp_path), "--out", str(out), "--resolution", "8", "--angle", "30"]) == 0
    with (out / "summary.csv").open(newline="", encoding="utf-8") as stream:
        [row] = csv.DictReader(stream)
    report = json.loads((out / row["folder"] / "report.json").read_text())
    assert report


@pytest.mark.parametrize(("suffix", "write"), [(".cp", cp), (".opx", opx)])
def test_formats_of_origami(suffix, write, tmp_path):
    path = tmp_path / f"crane{suffix}"
    path.write_bytes(write([*SQUARE, (2, -200, -100, 200, -100), (3, -200, 0, 200, 50)]))
    bpy.ops.curvefold.import_drawing(filepath=str(path))
    sheet = next(item for item in bpy.data.objects if item.curvefold.role == "SHEET")
    assert sheet.name.startswith("crane")
    assert [child.curvefold.role for child in sheet.children] == ["CREASE", "CREASE"]
    bpy.ops.curvefold.fold_drawing(filepath=str(path), resolution=8, angle=0.3)
    assert bpy.context.active_object.type == "MESH"
