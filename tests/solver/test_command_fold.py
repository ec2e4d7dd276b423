"""``python -m solver fold``: how a drawing is read, and what is said of one that is refused."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from solver import Crease, CreasePattern, PatternError, ReadOptions, command_line
from solver.command_line import main
from solver.files.results import result_names
from solver.files.ruling_files import RULING_FILES
from solver.pattern import reading

ROOT = Path(__file__).resolve().parents[2]
SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float)
ARC = np.array([(k / 16, 0.4 + k / 16 * (1 - k / 16)) for k in range(17)])
QUICK = ("--resolution", "8", "--angle", "20")


def sheet(right: float) -> CreasePattern:
    """A square sheet with one arc, so far right in its file."""
    step = np.array([right, 0.0])
    return CreasePattern(SQUARE + step, creases=[Crease(ARC + step)])


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[ReadOptions]:
    """What the reader of drawings is told; every drawing has two sheets."""
    found = []

    def read(source: object, options: ReadOptions) -> tuple[CreasePattern, ...]:
        found.append(options)
        return sheet(0.0), sheet(3.0)

    monkeypatch.setitem(reading.READERS, ".svg", read)
    return found


def run(*arguments: object) -> tuple[int, str]:
    stream = io.StringIO()
    return main(["fold", *map(str, arguments)], stream), stream.getvalue()


def report(folder: Path) -> dict[str, object]:
    found: dict[str, object] = json.loads((folder / "report.json").read_text())
    return found


def test_the_reader_is_told_what_the_user_chose(told: list[ReadOptions], tmp_path: Path) -> None:
    code, _ = run(
        "a.svg", "--out", tmp_path, *QUICK,
        "--border", "page", "--sheet", "2", "--unit", "in", "--scale", "0.5",
    )  # fmt: skip
    assert code == 0
    assert told == [ReadOptions("page", 2, "in", 0.5)]
    assert report(tmp_path)["drawing"] == "a 2"
    run("a.svg", "--out", tmp_path, *QUICK)
    assert told[1:] == [ReadOptions()]


def test_the_unit_is_that_of_the_results(told: list[ReadOptions], tmp_path: Path) -> None:
    run("a.svg", "--out", tmp_path, *QUICK, "--unit", "in")
    assert json.loads((tmp_path / "folded.fold").read_text())["frame_unit"] == "in"
    run("a.svg", "--out", tmp_path, *QUICK, "--unit", "cm", "--scale", "0.1")
    assert json.loads((tmp_path / "folded.fold").read_text())["frame_unit"] == "mm"


def test_of_several_sheets_the_first_is_folded_and_a_note_says_so(told: list[ReadOptions], tmp_path: Path) -> None:
    code, said = run("a.svg", "--out", tmp_path, *QUICK)
    assert code == 0
    assert report(tmp_path)["drawing"] == "a 1"
    assert "note: the file has 2 sheets: this is the first one" in said
    assert "sheet 1 of 2" not in said


def test_a_sheet_that_is_chosen_is_named(told: list[ReadOptions], tmp_path: Path) -> None:
    _, said = run("a.svg", "--out", tmp_path, *QUICK, "--sheet", "2")
    assert "note: sheet 2 of 2 in the file" in said
    assert "the file has 2 sheets" not in said


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("--unit", "furlong", "unit: must be one of mm, cm, m, in, pt, px, or dots to the inch such as 90dpi"),
        ("--scale", "0", "scale: must be a number from"),
        ("--scale", "nan", "scale: must be a number from"),
        ("--sheet", "0", "sheet: must be a whole number from 1"),
        ("--sheet", "3", "it has 2 sheets, and sheet 3 is asked for"),
    ],
)
def test_a_value_that_makes_no_sense_is_one_sentence(
    told: list[ReadOptions], tmp_path: Path, option: str, value: str, words: str
) -> None:
    code, said = run("a.svg", "--out", tmp_path / "out", option, value)
    assert code == 2
    assert words in said
    assert len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("arguments", [("--border", "frame"), ("--sheet", "two"), ("--scale", "big")])
def test_what_is_no_value_at_all_is_refused_with_the_arguments(
    arguments: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as stop:
        run("a.svg", "--out", tmp_path, *arguments)
    assert stop.value.code == 2
    assert f"argument {arguments[0]}: invalid" in capsys.readouterr().err


def test_a_drawing_that_is_refused_tells_first_what_was_decided(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def read(source: object, options: ReadOptions) -> tuple[CreasePattern, ...]:
        raise PatternError("nothing in it is a border", notes=("5 green strokes were taken for cuts", "no unit"))

    monkeypatch.setitem(reading.READERS, ".svg", read)
    code, said = run("a.svg", "--out", tmp_path / "out")
    assert code == 2
    assert said.splitlines() == [
        "note: 5 green strokes were taken for cuts",
        "note: no unit",
        "a.svg: nothing in it is a border",
    ]


def test_a_drawing_that_is_read_and_cannot_carry_a_net_tells_its_notes_too(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def read(source: object, options: ReadOptions) -> tuple[CreasePattern, ...]:
        thin = SQUARE * (100, 1)
        return (CreasePattern(thin, creases=[Crease([(50, 0), (50, 1)])], notes=["a line was left out"]),)

    monkeypatch.setitem(reading.READERS, ".svg", read)
    code, said = run("a.svg", "--out", tmp_path / "out", "--resolution", "8")
    assert code == 2
    assert said.splitlines()[0] == "note: a line was left out"
    assert "quads are needed" in said.splitlines()[1]


def test_what_was_read_is_said_before_the_fold_and_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    stream = io.StringIO()

    def fold(*_: object) -> None:
        assert stream.getvalue() == "note: a line was left out\n"
        raise PatternError("it cannot be folded", notes=("a line was left out", "a side contradicts itself"))

    def read(source: object, options: ReadOptions) -> tuple[CreasePattern, ...]:
        return (CreasePattern(SQUARE, creases=[Crease(ARC)], notes=["a line was left out"]),)

    monkeypatch.setitem(reading.READERS, ".svg", read)
    monkeypatch.setattr(command_line, "fold", fold)
    assert main(["fold", "a.svg", "--out", str(tmp_path / "out")], stream) == 2
    assert stream.getvalue().splitlines() == [
        "note: a line was left out",
        "note: a side contradicts itself",
        "a.svg: it cannot be folded",
    ]


# --- before the fold -------------------------------------------------------------------------------------


@pytest.fixture
def nothing_folds(told: list[ReadOptions], monkeypatch: pytest.MonkeyPatch) -> None:
    def fold(*_: object) -> None:
        raise AssertionError("that was clear before folding")

    monkeypatch.setattr(command_line, "fold", fold)


@pytest.mark.parametrize("name", [*result_names(), *RULING_FILES])
def test_an_output_that_cannot_be_written_is_found_before_the_fold(
    nothing_folds: None, tmp_path: Path, name: str
) -> None:
    (tmp_path / "out" / name).mkdir(parents=True)
    code, said = run("a.svg", "--out", tmp_path / "out", "--rulings")
    assert code == 2
    assert said == f"{tmp_path / 'out' / name}: it cannot be written: it is a folder\n"
    (tmp_path / "file").touch()
    code, said = run("a.svg", "--out", tmp_path / "file" / "out")
    assert code == 2
    assert f"{tmp_path / 'file'} is not a folder" in said


@pytest.mark.parametrize("angle", ["nan", "inf", "-inf", "-1", "181"])
def test_an_angle_out_of_range_is_one_sentence(nothing_folds: None, tmp_path: Path, angle: str) -> None:
    code, said = run("a.svg", "--out", tmp_path / "out", f"--angle={angle}")
    assert (code, said) == (2, "angle: the fold angle must lie between 0 and 180 degrees\n")
    assert not (tmp_path / "out").exists()


# --- consoles, and Ctrl-C --------------------------------------------------------------------------------


def test_ctrl_c_is_a_word_and_an_exit_code(
    told: list[ReadOptions], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fold(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(command_line, "fold", fold)
    code, said = run("a.svg", "--out", tmp_path / "out")
    assert (code, said.splitlines()[-1]) == (130, "interrupted")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("encoding", ["cp1252", "ascii", "utf-8"])
def test_a_console_that_lacks_words_shows_them_escaped(tmp_path: Path, encoding: str) -> None:
    name = "鶴 ≤.svg"
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    for arguments in (["fold", "--help"], ["fold", str(tmp_path / name), "--out", str(tmp_path)]):
        command = [sys.executable, "-m", "solver", *arguments]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, timeout=300)
        said = done.stdout + done.stderr
        assert b"Traceback" not in said
        assert (done.returncode, b"usage: " in said) in {(0, True), (2, False)}
    assert name.encode(encoding, "backslashreplace") in said
