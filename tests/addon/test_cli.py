"""The command line."""

import os
import subprocess
import sys
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).absolute().parents[2]
QUICK = ["--resolution", "12", "--size", "80x60", "--samples", "2"]


@pytest.fixture
def main(extension):
    return extension("curvefold_addon.cli").main


def complaint(capsys) -> str:
    """What was said on stderr: one line, no traceback."""
    said = capsys.readouterr().err
    assert "Traceback" not in said
    lines = [line for line in said.splitlines() if line.strip()]
    assert lines
    return lines[-1]


def test_fold_render_and_save(main, drawing, tmp_path):
    out = tmp_path / "out"
    picture, blend = tmp_path / "new" / "a.png", tmp_path / "new" / "a.blend"
    assert (
        main(["fold", str(drawing), "--out", str(out), "--render", str(picture), "--blend", str(blend), *QUICK])
        == 0
    )
    assert {path.name for path in out.iterdir()} == {"folded.obj", "folded.fold", "report.json"}
    assert {path.name for path in picture.parent.iterdir()} == {"a.png", "a.blend"}
    assert picture.read_bytes().startswith(b"\x89PNG")
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    assert bpy.context.scene.camera is not None
    assert any("curvefold_positions" in mesh for mesh in bpy.data.meshes)


def test_a_plan_is_written(main, drawing, tmp_path, capsys):
    out = tmp_path / "plan.svg"
    assert main(["plan", str(drawing), "--profile", "plotter", "--out", str(out)]) == 0
    assert complaint(capsys) == f"wrote {out}"
    assert 'width="100mm"' in out.read_text(encoding="utf-8")
    assert main(["plan", str(drawing), "--profile", "ploter", "--out", str(out)]) == 2
    assert "the nearest known one is 'plotter'" in complaint(capsys)


def test_relative_paths_are_relative_to_here(main, drawing, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["fold", "arc.svg", "--out", "out", "--render", "here.png", *QUICK]) == 0
    assert (tmp_path / "here.png").is_file()


@pytest.mark.parametrize(
    "arguments",
    [
        ["fold"],
        ["fold", "x.svg", "--out", "o", "--unknown"],
        ["fold", "x.svg", "--out", "o", "--render", "picture.jpg"],
        ["fold", "x.svg", "--out", "o", "--size", "960"],
        ["fold", "x.svg", "--out", "o", "--samples", "0"],
        ["batch", "x", "--out", "o", "--unknown"],
        ["batch", "x", "--out", "o", "--jobs", "none"],
        [],
    ],
    ids=" ".join,
)
def test_arguments_that_make_no_sense(main, arguments, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    assert "error:" in complaint(capsys)
    assert not list(tmp_path.iterdir())


def test_bad_drawing(main, broken_drawing, tmp_path, capsys):
    before = set(tmp_path.rglob("*"))
    picture, blend = tmp_path / "a.png", tmp_path / "a.blend"
    code = main(
        [
            "fold",
            str(broken_drawing),
            "--out",
            str(tmp_path / "o"),
            "--render",
            str(picture),
            "--blend",
            str(blend),
        ]
    )
    assert code == 2
    assert "broken.svg" in complaint(capsys)
    assert set(tmp_path.rglob("*")) <= before | {tmp_path / "o"}


def test_missing_drawing(main, tmp_path, capsys):
    assert main(["fold", str(tmp_path / "none.svg"), "--out", str(tmp_path / "o")]) == 2
    assert "none.svg" in complaint(capsys)


@pytest.mark.parametrize("option", ["--render", "--blend"])
def test_picture_that_cannot_be_written(main, drawing, tmp_path, capsys, option):
    (tmp_path / "file").write_text("in the way")
    suffix = ".png" if option == "--render" else ".blend"
    path = tmp_path / "file" / f"a{suffix}"
    assert main(["fold", str(drawing), "--out", str(tmp_path / "o"), option, str(path), *QUICK]) == 2
    assert "file is not a folder" in complaint(capsys)
    assert (tmp_path / "file").read_text() == "in the way"
    assert not (tmp_path / "o").exists(), "that was clear before folding"


@pytest.fixture
def nothing_folds(extension, monkeypatch):
    """Fails when anything is folded, here or in a process of a batch."""

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("that was clear before folding")

    monkeypatch.setattr(extension("solver.command_line"), "fold", refuse)
    monkeypatch.setattr(extension("curvefold_addon.batch"), "_worker_command", refuse)


@pytest.mark.parametrize("verb", ["fold", "batch"])
@pytest.mark.parametrize("inside", [".", "folder/folder"])
def test_out_that_is_no_folder(main, nothing_folds, drawing, tmp_path, capsys, verb, inside):
    (tmp_path / "file").write_text("in the way")
    assert main([verb, str(drawing), "--out", str(tmp_path / "file" / inside), *QUICK]) == 2
    said = complaint(capsys)
    assert "nothing can be written there" in said
    assert f"{tmp_path / 'file'} is not a folder" in said


@pytest.mark.parametrize(("verb", "name"), [("fold", "report.json"), ("batch", "summary.csv")])
def test_a_folder_where_a_result_would_be(main, nothing_folds, drawing, tmp_path, capsys, verb, name):
    (tmp_path / "out" / name).mkdir(parents=True)
    assert main([verb, str(drawing), "--out", str(tmp_path / "out"), *QUICK]) == 2
    assert f"{name}: it cannot be written: it is a folder" in complaint(capsys)


@pytest.mark.parametrize("verb", ["fold", "batch"])
@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--angle", "nan", "angle: the fold angle must lie between 0 and 180 degrees"),
        ("--angle", "inf", "angle: the fold angle must lie between 0 and 180 degrees"),
        ("--angle", "-1", "angle: the fold angle must lie between 0 and 180 degrees"),
        ("--angle", "180.5", "angle: the fold angle must lie between 0 and 180 degrees"),
        ("--angle", "wide", "argument --angle: invalid float value: 'wide'"),
        ("--resolution", "2", "resolution: must be a whole number"),
        ("--vertices", "1", "max_vertices: must be a whole number"),
        ("--scale", "nan", "scale: must be a number"),
        ("--handles", "none.json", "none.json: cannot be read"),
        ("--description", "none.json", "none.json: cannot be read"),
    ],
)
def test_a_value_that_makes_no_sense_is_told_once(
    main, nothing_folds, drawing, tmp_path, capsys, verb, option, value, words
):
    folder = tmp_path / "drawings"
    folder.mkdir()
    for name in "ab":
        (folder / f"{name}.svg").write_text(drawing.read_text())
    source = folder / "a.svg" if verb == "fold" else folder
    assert main([verb, str(source), "--out", str(tmp_path / "o"), option, value]) == 2
    said = capsys.readouterr()
    assert (said.out + said.err).count(words) == 1
    assert not (tmp_path / "o").exists()


def test_an_older_picture_stays_when_rendering_fails(extension, main, drawing, tmp_path, capsys, monkeypatch):
    picture = tmp_path / "a.png"
    picture.write_bytes(b"older")

    def fail(path: str) -> None:
        Path(path).write_bytes(b"half")
        raise RuntimeError("Error: out of memory")

    monkeypatch.setattr(extension("curvefold_addon.scene"), "render", fail)
    assert main(["fold", str(drawing), "--out", str(tmp_path / "o"), "--render", str(picture), *QUICK]) == 2
    assert "out of memory" in complaint(capsys)
    assert picture.read_bytes() == b"older"
    assert not list(tmp_path.glob(".*"))


def test_the_module_from_a_checkout(drawing, tmp_path):
    environment = {key: value for key, value in os.environ.items() if key != "BLENDER_USER_RESOURCES"}

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "curvefold_addon", *arguments]
        return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300)

    good = run("fold", str(drawing), "--out", str(tmp_path / "o"), "--resolution", "12")
    assert good.returncode == 0, good.stdout + good.stderr
    assert (tmp_path / "o" / "report.json").is_file()
    bad = run("fold", str(tmp_path / "none.svg"), "--out", str(tmp_path / "p"))
    assert bad.returncode == 2
    assert "Traceback" not in bad.stdout + bad.stderr
