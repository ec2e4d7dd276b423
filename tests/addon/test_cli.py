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
    assert "cannot be written" in complaint(capsys)
    assert (tmp_path / "file").read_text() == "in the way"
    assert not (tmp_path / "o").exists(), "that was clear before folding"


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
