"""Which drawings a batch folds: folders with what systems hide in them, lists in all encodings, several sheets."""

import csv
import json
import os
import sys

import pytest

LISTED = "# drawings\r\nfächer.svg\r\n\r\nsub/wave.fold\r\n"


@pytest.fixture
def lists(extension):
    return extension("curvefold_addon.drawing_list")


@pytest.fixture
def main(extension):
    return extension("curvefold_addon.cli").main


@pytest.fixture
def said_by_workers(extension, monkeypatch):
    """Instead of folding, every process only says what it was told."""
    batch = extension("curvefold_addon.batch")
    repeat = [sys.executable, "-c", "import sys; print(' '.join(sys.argv[1:]).encode('ascii', 'replace'))"]
    monkeypatch.setattr(batch, "_worker_command", lambda: (repeat, dict(os.environ)))


def rows(out):
    with (out / "summary.csv").open(newline="", encoding="utf-8") as stream:
        return {row["folder"]: row for row in csv.DictReader(stream)}


def names(found):
    return [path.name for path in found.drawings]


def test_all_kinds_of_drawings_and_no_hidden_file_of_a_folder(extension, lists, tmp_path):
    suffixes = extension("solver").DRAWING_SUFFIXES
    for name in (*(f"a{suffix}" for suffix in suffixes), "B.SVG", "._a.svg", ".kept.fold", ".svg", "read me.txt"):
        (tmp_path / name).touch()
    (tmp_path / "__MACOSX").mkdir()
    (tmp_path / "__MACOSX" / "._a.svg").touch()
    found = lists.find_drawings(tmp_path)
    assert names(found) == ["B.SVG", *sorted(f"a{suffix}" for suffix in suffixes)]
    assert found.hidden == 2


def test_a_folder_that_only_hides_drawings_says_so(lists, tmp_path):
    (tmp_path / "._a.svg").touch()
    with pytest.raises(lists.BatchError, match="holds no drawings but 1 hidden"):
        lists.find_drawings(tmp_path)


def test_a_list_names_what_it_likes_but_for_what_macos_leaves(lists, tmp_path):
    (tmp_path / "list.txt").write_text("__MACOSX/a.svg\nsub/._a.svg\nsub/.a.svg\n")
    found = lists.find_drawings(tmp_path / "list.txt")
    assert found.drawings == (tmp_path / "sub" / ".a.svg",)
    assert found.hidden == 2


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("ends", ["\r\n", "\n", "\r"], ids=repr)
def test_a_list_in_any_encoding_of_unicode_and_with_any_ends_of_lines(lists, tmp_path, encoding, ends):
    (tmp_path / "list.txt").write_bytes(LISTED.replace("\r\n", ends).encode(encoding))
    found = lists.find_drawings(tmp_path / "list.txt")
    assert found.drawings == (tmp_path / "fächer.svg", tmp_path / "sub" / "wave.fold")


def test_utf_16_from_the_other_end(lists, tmp_path):
    (tmp_path / "list.txt").write_bytes(b"\xfe\xff" + LISTED.encode("utf-16-be"))
    assert names(lists.find_drawings(tmp_path / "list.txt")) == ["fächer.svg", "wave.fold"]


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have only names that are text")
def test_names_that_are_no_text(extension, main, said_by_workers, tmp_path, capsys):
    name = os.fsdecode(b"f\xe4cher.svg")
    (tmp_path / name).touch()
    (tmp_path / "list.txt").write_bytes(b"f\xe4cher.svg\n")
    assert extension("curvefold_addon.drawing_list").find_drawings(tmp_path / "list.txt").drawings[0].is_file()
    out = tmp_path / "out"
    for source in (tmp_path / "list.txt", tmp_path, tmp_path / name):
        assert main(["batch", str(source), "--out", str(out)]) == 1
        assert "f\\udce4cher: failed" in capsys.readouterr().out
        (row,) = rows(out).values()
        assert row["drawing"].endswith("f\\udce4cher.svg")
    assert main(["batch", str(out / name), "--out", str(tmp_path / os.fsdecode(b"\xe4"))]) == 1
    assert "0 of 1 drawings folded" in capsys.readouterr().out


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have only names that are text")
def test_a_drawing_whose_name_is_no_text_is_folded_like_any_other(main, drawing, tmp_path):
    folder = tmp_path / os.fsdecode(b"f\xe4cher")
    folder.mkdir()
    drawing.rename(folder / os.fsdecode(b"\xe4.svg"))
    out = tmp_path / "out"
    assert main(["batch", str(folder), "--out", str(out), "--resolution", "8", "--angle", "20"]) == 0
    (row,) = rows(out).values()
    assert (row["folder"], row["result"]) == ("\\udce4", "folded")
    results = out / os.fsdecode(b"\xe4")
    assert (results / "thumbnail.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((results / "report.json").read_text(encoding="utf-8"))["drawing"] == "\ufffd"
    assert "o \ufffd" in (results / "folded.obj").read_text(encoding="utf-8").splitlines()
    assert json.loads((results / "folded.fold").read_text(encoding="utf-8"))
    picture, blend = folder / os.fsdecode(b"\xe5.png"), folder / os.fsdecode(b"\xe5.blend")
    shown = ["--render", str(picture), "--blend", str(blend), "--size", "40x30", "--samples", "1"]
    again = ["fold", str(results / "folded.fold"), "--out", str(folder), "--resolution", "8", "--angle", "20"]
    assert main([*again, *shown]) == 0
    assert picture.is_file()
    assert blend.is_file()


def test_hidden_files_are_counted_aloud(main, said_by_workers, tmp_path, capsys):
    for name in ("a.svg", "._a.svg"):
        (tmp_path / name).touch()
    main(["batch", str(tmp_path), "--out", str(tmp_path / "out")])
    assert "1 hidden file is passed over" in capsys.readouterr().out.splitlines()
    (tmp_path / ".b.svg").touch()
    main(["batch", str(tmp_path), "--out", str(tmp_path / "out")])
    assert "2 hidden files are passed over" in capsys.readouterr().out.splitlines()


@pytest.fixture
def three_sheets(extension, monkeypatch, drawing):
    """Every drawing but those that are called bad has three sheets; what it is read with is kept."""
    solver, reading = extension("solver"), extension("solver.pattern.reading")
    pattern, told = solver.read_pattern(drawing), []
    drawing.unlink()  # it lies where the others will

    def read(source, options):
        told.append(options)
        if "bad" in source.name:
            raise solver.PatternError("it is bad")
        return (pattern,) * 3

    monkeypatch.setitem(reading.READERS, ".svg", read)
    return told


def test_each_sheet_of_a_drawing_has_a_folder_and_a_process(
    extension, main, three_sheets, said_by_workers, tmp_path, capsys
):
    for name in ("a.svg", "bad.svg"):
        (tmp_path / name).touch()
    out = tmp_path / "out"
    assert main(["batch", str(tmp_path), "--out", str(out), "--border", "page", "--unit", "in"]) == 1
    table = rows(out)
    assert list(table) == ["a-sheet1", "a-sheet2", "a-sheet3", "bad"]
    assert {row["drawing"] for row in table.values()} == {str(tmp_path / "a.svg"), str(tmp_path / "bad.svg")}
    for name, row in table.items():
        own = f"--sheet {name[-1]} " if name != "bad" else ""
        assert f"--border page --unit in {own}--size" in row["sentence"]
    assert three_sheets == [extension("solver").ReadOptions("page", unit="in")] * 2
    assert "0 of 4 sheets folded" in capsys.readouterr().out


def test_a_sheet_that_is_asked_for_is_the_only_one(main, three_sheets, said_by_workers, tmp_path):
    (tmp_path / "a.svg").touch()
    out = tmp_path / "out"
    main(["batch", str(tmp_path), "--out", str(out), "--sheet=2"])
    (row,) = rows(out).values()
    assert row["folder"] == "a"
    assert "--sheet=2" in row["sentence"]
    assert three_sheets == [], "nothing has to be known of it"


@pytest.mark.parametrize(
    ("option", "value"), [("--unit", "furlong"), ("--scale", "0"), ("--sheet", "0"), ("--border", "frame")]
)
def test_a_value_that_makes_no_sense_is_said_once(main, said_by_workers, tmp_path, capsys, option, value):
    (tmp_path / "a.svg").touch()
    assert main(["batch", str(tmp_path), "--out", str(tmp_path / "out"), option, value]) == 2
    said = capsys.readouterr()
    assert option.strip("-") in said.err.splitlines()[-1]
    assert said.out == ""
    assert not (tmp_path / "out").exists()


def test_the_log_of_a_refused_drawing_has_its_notes_and_then_its_sentence(main, tmp_path):
    """Through a process of its own, from the drawing to the table."""
    (tmp_path / "thin.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 10"><rect width="100" height="0.1" stroke="black"'
        ' fill="none"/><path d="M 0 0.05 H 100" stroke="lime"/><path d="M 50 0 V 0.1" stroke="red"/></svg>'
    )
    out = tmp_path / "out"
    assert main(["batch", str(tmp_path), "--out", str(out), "--resolution", "12"]) == 1
    log = (out / "thin" / "log.txt").read_text().splitlines()
    assert any(line.startswith("note: ") for line in log)
    assert log[-1] == rows(out)["thin"]["sentence"]
    assert "thin.svg" in log[-1]
