"""Many drawings in processes of their own."""

import csv
import json
import os
import sys

import bpy
import pytest

QUICK = ["--resolution", "12"]
FAST_RENDER = ["--size", "80x60", "--samples", "2"]


@pytest.fixture
def main(extension):
    return extension("curvefold_addon.cli").main


@pytest.fixture
def drawings(tmp_path, drawing, broken_drawing):
    folder = tmp_path / "drawings"
    folder.mkdir()
    (folder / "a.svg").write_text(drawing.read_text())
    (folder / "b.svg").write_text(broken_drawing.read_text())
    (folder / "c.svg").write_text(drawing.read_text().replace("75", "70"))
    (folder / "notes.md").write_text("not a drawing")
    return folder


def rows(out):
    with (out / "summary.csv").open(newline="") as stream:
        return {row["folder"]: row for row in csv.DictReader(stream)}


def stamps(out):
    return {path.parent.name: path.stat().st_mtime_ns for path in out.glob("*/batch.json")}


def test_whole_life(main, drawings, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["batch", str(drawings), "--out", str(out), "--jobs", "2", *QUICK]) == 1
    table = rows(out)
    assert list(table) == ["a", "b", "c"]
    assert [table[name]["result"] for name in "abc"] == ["folded", "failed", "folded"]
    assert table["b"]["exit_code"] == "2"
    assert "b.svg" in table["b"]["sentence"]
    assert {path.name for path in (out / "a").iterdir()} == {
        "folded.obj", "folded.fold", "report.json", "thumbnail.png", "batch.json", "log.txt"
    }  # fmt: skip
    assert {path.name for path in (out / "b").iterdir()} == {"log.txt"}
    sheet = bpy.data.images.load(str(out / "contact_sheet.png"))
    assert sheet.size[0] > 600
    first = stamps(out)
    assert set(first) == {"a", "c"}

    # Again: what is finished is not done again, and the table is still whole.
    capsys.readouterr()
    assert main(["batch", str(drawings), "--out", str(out), *QUICK]) == 1
    assert stamps(out) == first
    assert capsys.readouterr().out.count("finished before") == 2
    assert list(rows(out)) == ["a", "b", "c"]

    # A drawing that changed, a report that is not whole, and a drawing that was repaired are done again.
    (drawings / "a.svg").write_text((drawings / "a.svg").read_text().replace("75", "72"))
    report = out / "c" / "report.json"
    report.write_text(report.read_text()[:-20])
    (drawings / "b.svg").write_text((drawings / "a.svg").read_text())
    assert main(["batch", str(drawings), "--out", str(out), *QUICK]) == 0
    second = stamps(out)
    assert second["a"] != first["a"]
    assert second["c"] != first["c"]
    assert json.loads(report.read_text())
    assert rows(out)["b"]["result"] == "folded"

    # Other settings are other results.
    assert main(["batch", str(drawings / "a.svg"), "--out", str(out), "--resolution", "14"]) == 0
    assert stamps(out)["a"] != second["a"]


def test_results_are_drawings_again(main, drawings, tmp_path, capsys):
    """FOLD files in a folder are drawings like any other, and none is written over."""
    folder = tmp_path / "flat"
    assert main(["fold", str(drawings / "a.svg"), "--out", str(folder), *QUICK]) == 0
    out = tmp_path / "out"
    assert main(["batch", str(folder), "--out", str(out), *QUICK]) == 0
    assert {name: row["result"] for name, row in rows(out).items()} == {"folded": "folded"}
    assert (out / "folded" / "folded.fold").is_file()

    # The folder of its results is the one where it lies.
    before = (out / "folded" / "folded.fold").read_bytes()
    capsys.readouterr()
    assert main(["batch", str(out / "folded" / "folded.fold"), "--out", str(out), *QUICK]) == 1
    assert "it lies where its results would be written" in capsys.readouterr().out
    assert (out / "folded" / "folded.fold").read_bytes() == before


def test_list_with_rendering_and_equal_names(main, drawings, tmp_path):
    (drawings / "other").mkdir()
    (drawings / "other" / "a.svg").write_text((drawings / "c.svg").read_text())
    listed = drawings / "list.txt"
    listed.write_text("# two of one name\na.svg\n\nother/a.svg\n")
    out = tmp_path / "out"
    assert main(["batch", str(listed), "--out", str(out), "--render", *QUICK, *FAST_RENDER]) == 0
    assert list(rows(out)) == ["a", "a-2"]
    for name in ("a", "a-2"):
        image = bpy.data.images.load(str(out / name / "picture.png"))
        assert tuple(image.size) == (80, 60)


@pytest.mark.parametrize("content", [None, "", b"\xff\xfe\x00"], ids=["missing", "empty", "not text"])
def test_bad_list(main, tmp_path, content, capsys):
    listed = tmp_path / "list.txt"
    if content is not None:
        listed.write_bytes(content if isinstance(content, bytes) else content.encode())
    assert main(["batch", str(listed), "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "list.txt" in said
    assert len(said.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_a_crash_is_a_failure(extension, main, drawings, tmp_path, monkeypatch):
    batch = extension("curvefold_addon.batch")
    crash = [sys.executable, "-c", "raise ValueError('out of luck')"]
    monkeypatch.setattr(batch, "_worker_command", lambda: (crash, dict(os.environ)))
    out = tmp_path / "out"
    assert main(["batch", str(drawings / "a.svg"), "--out", str(out)]) == 1
    row = rows(out)["a"]
    assert (row["result"], row["exit_code"], row["sentence"]) == ("failed", "3", "ValueError: out of luck")
    assert not stamps(out)


def test_a_program_is_started_again_by_its_own_path(extension, monkeypatch):
    batch = extension("curvefold_addon.batch")

    class App:
        binary_path = "/opt/blender/blender"

    class FakeBlender:
        app = App

    monkeypatch.setattr(batch, "bpy", FakeBlender)
    assert batch._worker_command()[0] == ["/opt/blender/blender", "--command", "curvefold"]


def test_many_drawings_have_several_sheets_and_names_of_their_own(extension, tmp_path):
    batch, sheets = extension("curvefold_addon.batch"), extension("curvefold_addon.bridge.contact_sheet")
    tiles = [sheets.Tile(str(k), "", None) for k in range(205)]
    three = ["contact_sheet-2.png", "contact_sheet-3.png", "contact_sheet.png"]
    said = batch._save_contact_sheets(tmp_path, tiles)
    assert sorted(path.name for path in tmp_path.iterdir()) == three
    assert said == f"{tmp_path / three[2]} to {tmp_path / three[1]}"
    assert batch._save_contact_sheets(tmp_path, tiles[:100]) == str(tmp_path / three[2])
    assert [path.name for path in tmp_path.iterdir()] == three[2:]

    # A folder of results must not stand where the table or a sheet will be written.
    names = ["summary.csv.svg", "Contact_Sheet.png.svg", "contact_sheet-2.png.svg"]
    tasks = batch._tasks([(tmp_path / name, None) for name in names], tmp_path, False, [])
    assert [task.folder.name for task in tasks] == [
        "summary.csv-2", "Contact_Sheet.png-2", "contact_sheet-2.png-2"
    ]  # fmt: skip
