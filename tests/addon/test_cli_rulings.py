"""--rulings on the command line: files, objects in the scene, and many drawings at once."""

import csv
import json

import bpy
import pytest

MORE = {"rulings.obj", "rulings.svg", "gauss_image.obj"}
QUICK = ["--resolution", "12", "--size", "80x60", "--samples", "2"]


@pytest.fixture
def main(extension):
    return extension("curvefold_addon.cli").main


def test_files_and_objects(main, drawing, tmp_path):
    out, blend = tmp_path / "out", tmp_path / "a.blend"
    assert main(["fold", str(drawing), "--out", str(out), "--blend", str(blend), "--rulings", *QUICK]) == 0
    assert {path.name for path in out.iterdir()} > MORE
    counted = json.loads((out / "report.json").read_text())["rulings"]
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    (paper,) = [item for item in bpy.data.objects if item.type == "MESH" and item.data.curvefold.is_paper]
    lines, image = sorted(paper.children, key=lambda item: item.name, reverse=True)
    assert (lines.name, image.name) == (f"{paper.name} Rulings", f"{paper.name} Gauss Image")
    # They are found anew in metres; whether one more just fits between others is a matter of the last bit.
    assert abs(len(lines.data.splines) - sum(counted[kind] for kind in ("cylindrical", "conical", "general"))) <= 2
    assert (lines.hide_render, image.hide_render) == (False, True)
    # In metres, as the paper is.
    assert lines.dimensions.x == pytest.approx(paper.dimensions.x, rel=0.3)


def test_without_it_there_are_none(main, drawing, tmp_path):
    out, blend = tmp_path / "out", tmp_path / "a.blend"
    assert main(["fold", str(drawing), "--out", str(out), "--blend", str(blend), *QUICK]) == 0
    assert not MORE & {path.name for path in out.iterdir()}
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert not any("Rulings" in item.name for item in bpy.data.objects)


def test_many_drawings_and_again_without(main, drawing, tmp_path):
    folder, out = tmp_path / "drawings", tmp_path / "out"
    folder.mkdir()
    (folder / "a.svg").write_text(drawing.read_text())
    arguments = ["batch", str(folder), "--out", str(out), "--resolution", "12"]
    assert main([*arguments, "--rulings"]) == 0
    assert {path.name for path in (out / "a").iterdir()} > MORE
    with (out / "summary.csv").open(newline="") as stream:
        (row,) = csv.DictReader(stream)
    assert float(row["rulings.plane_part"]) < 0.5
    # What was deleted is made again.
    (out / "a" / "rulings.svg").unlink()
    assert main([*arguments, "--rulings"]) == 0
    assert {path.name for path in (out / "a").iterdir()} > MORE
    # Files that are not asked for any more do not stay beside another fold.
    assert main(arguments) == 0
    assert not MORE & {path.name for path in (out / "a").iterdir()}
