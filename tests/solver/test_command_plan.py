"""``python -m solver plan``: exit codes, words, and files that are nobody's own."""

from __future__ import annotations

import io
import shutil
from pathlib import Path

import pytest

from solver.command_line import BAD_INPUT, REACHED, main

LENS = "sample_patterns/lens.svg"


def run(*arguments: object) -> tuple[int, str]:
    stream = io.StringIO()
    code = main(["plan", *map(str, arguments)], stream)
    return code, stream.getvalue()


@pytest.mark.parametrize("suffix", [".svg", ".dxf", ".pdf"])
def test_a_drawing_becomes_a_plan(tmp_path: Path, suffix: str) -> None:
    out = tmp_path / "new" / f"plan{suffix}"
    code, words = run(LENS, "--profile", "laser-lightburn", "--out", out)
    assert code == REACHED
    assert words.splitlines()[-1] == f"wrote {out}"
    assert out.stat().st_size > 1000


def test_several_pages_are_several_files_or_one_pdf(tmp_path: Path) -> None:
    assert run(LENS, "--profile", "two-sided", "--out", tmp_path / "a.svg")[0] == REACHED
    assert run(LENS, "--profile", "two-sided", "--out", tmp_path / "b.pdf")[0] == REACHED
    assert run(LENS, "--tile", "A5", "--out", tmp_path / "c.dxf")[0] == REACHED
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a-back.svg", "a-front.svg", "b.pdf", "c-1-1.dxf", "c-1-2.dxf", "c-map.dxf",
    ]  # fmt: skip


def test_dashes_are_chosen(tmp_path: Path) -> None:
    whole, dashed = tmp_path / "whole.svg", tmp_path / "dashed.svg"
    assert run(LENS, "--profile", "plotter", "--dash", "none", "--out", whole)[0] == REACHED
    assert run(LENS, "--profile", "plotter", "--dash", "20,5", "--out", dashed)[0] == REACHED
    assert whole.read_text().count('label="crease 1"') == 1
    assert dashed.read_text().count('label="crease 1"') == 9


def test_reading_is_as_for_folding(tmp_path: Path) -> None:
    out = tmp_path / "plan.svg"
    assert run(LENS, "--scale", 2, "--profile", "plotter", "--out", out)[0] == REACHED
    assert 'width="420mm" height="296mm"' in out.read_text()


def test_a_plan_is_written_over_a_plan_and_over_nothing_else(tmp_path: Path) -> None:
    out = tmp_path / "plan.svg"
    assert run(LENS, "--out", out)[0] == REACHED
    assert run(LENS, "--profile", "plotter", "--out", out)[0] == REACHED
    own = tmp_path / "own.svg"
    shutil.copy("sample_patterns/loop.svg", own)
    code, words = run(LENS, "--out", own)
    assert code == BAD_INPUT
    assert "a file that is no plan has this name already" in words
    assert own.read_bytes() == Path("sample_patterns/loop.svg").read_bytes()


def test_nothing_is_written_when_one_of_two_files_is_somebodys_own(tmp_path: Path) -> None:
    (tmp_path / "x-back.svg").write_text("<svg/>")
    assert run(LENS, "--profile", "two-sided", "--out", tmp_path / "x.svg")[0] == BAD_INPUT
    assert [path.name for path in tmp_path.iterdir()] == ["x-back.svg"]


def test_a_drawing_that_is_a_plan_itself_is_not_written_over(tmp_path: Path) -> None:
    drawing = tmp_path / "drawing.svg"
    assert run(LENS, "--out", drawing)[0] == REACHED
    before = drawing.read_bytes()
    for out in (drawing, tmp_path / "link.svg"):
        if out != drawing:
            out.symlink_to(drawing)
        code, words = run(drawing, "--profile", "plotter", "--out", out)
        assert code == BAD_INPUT
        assert "over what it is made from" in words
    assert drawing.read_bytes() == before


def test_a_plan_is_a_drawing_that_reads_as_itself(tmp_path: Path) -> None:
    first, second = tmp_path / "first.svg", tmp_path / "second.svg"
    assert run("sample_patterns/miura.svg", "--out", first)[0] == REACHED
    code, words = run(first, "--out", second)
    assert code == REACHED
    assert "4 strokes of colour #0000ff" in words
    assert "4 strokes of colour #ff0000" in words


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--profile", "plottre"], "there is no profile 'plottre', the nearest known one is 'plotter'"),
        (["--thickness", "2"], "draws no grooves"),
        (["--rulings"], "no rulings are known"),
        (["--unit", "furlong"], "unit"),
        (["--dash", "3,1,2"], "a dash and a gap"),
        (["--tabs", "8"], "no glued borders are known"),
        (["--tabs", "-8"], "more than 0"),
    ],
)
def test_what_cannot_be_is_one_sentence(tmp_path: Path, arguments: list[str], sentence: str) -> None:
    code, words = run(LENS, *arguments, "--out", tmp_path / "x.svg")
    assert code == BAD_INPUT
    assert sentence in words.splitlines()[-1]
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    code, words = run(LENS, "--out", tmp_path / "file" / "x.svg")
    assert code == BAD_INPUT
    assert "nothing can be written there" in words
    code, words = run(LENS, "--out", tmp_path / "x.ai")
    assert code == BAD_INPUT
    assert "only .svg, .dxf, .pdf" in words
    (tmp_path / "folder.svg").mkdir()
    assert run(LENS, "--out", tmp_path / "folder.svg")[0] == BAD_INPUT


def fold(*arguments: object) -> tuple[int, str]:
    stream = io.StringIO()
    code = main(["fold", *map(str, arguments), "--resolution", "10", "--angle", "40"], stream)
    return code, stream.getvalue()


def test_a_fold_writes_its_plan_beside_its_results(tmp_path: Path) -> None:
    assert fold(LENS, "--plan", "svg", "--profile", "laser-glowforge", "--out", tmp_path)[0] == REACHED
    text = (tmp_path / "plan.svg").read_text()
    assert 'inkscape:label="score valley"' in text
    assert {path.name for path in tmp_path.iterdir()} == {"folded.obj", "folded.fold", "plan.svg", "report.json"}


def test_what_a_plan_lacks_is_said_before_the_fold(tmp_path: Path) -> None:
    for arguments, sentence in (
        (["--profile", "origamy"], "the nearest known one is 'origami'"),
        (["--profile", "board"], "need the board's thickness"),
    ):
        code, words = fold(LENS, "--plan", "svg", *arguments, "--out", tmp_path / "out")
        assert code == BAD_INPUT
        assert sentence in words
        assert "iterations" not in words
    assert list(tmp_path.iterdir()) == []


def test_a_plan_is_not_written_over_the_drawing_that_is_folded(tmp_path: Path) -> None:
    drawing = tmp_path / "plan.svg"
    shutil.copy(LENS, drawing)
    code, words = fold(drawing, "--plan", "svg", "--out", tmp_path)
    assert code == BAD_INPUT
    assert "over what it is made from" in words
    assert [path.name for path in tmp_path.iterdir()] == ["plan.svg"]
    code, words = fold(LENS, "--plan", "svg", "--out", tmp_path)
    assert code == BAD_INPUT
    assert "a file that is no plan has this name already" in words
    assert [path.name for path in tmp_path.iterdir()] == ["plan.svg"]
