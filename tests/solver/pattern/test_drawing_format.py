"""The registry of formats: what commands, dialogs and batches offer follows from it."""

from __future__ import annotations

import io
from collections import Counter
from pathlib import Path

import pytest
import shapely

import solver
from solver.command_line import main
from solver.pattern import reading
from solver.pattern.drawing_format import DrawingFormat
from solver.pattern.read_options import ReadOptions
from solver.pattern.stroke import Lines


def test_every_suffix_belongs_to_one_format() -> None:
    suffixes = Counter(suffix for one in reading.FORMATS for suffix in one.suffixes)
    assert list(suffixes) == list(solver.DRAWING_SUFFIXES)
    assert set(suffixes.values()) == {1}
    assert all(suffix.startswith(".") and suffix == suffix.lower() for suffix in suffixes)
    assert tuple(one.name for one in reading.FORMATS) == solver.DRAWING_FORMATS


def test_the_command_says_what_is_read(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["fold", "--help"], io.StringIO())
    said = capsys.readouterr().out
    assert all(suffix in said for suffix in solver.DRAWING_SUFFIXES)


def test_another_kind_of_file_is_refused_with_all_that_are_read(tmp_path: Path) -> None:
    with pytest.raises(solver.ReadError, match="are not read") as caught:
        solver.read_patterns(tmp_path / "sheet.doc")
    assert all(suffix in str(caught.value) for suffix in solver.DRAWING_SUFFIXES)


@pytest.mark.parametrize(
    "wrong",
    [ZeroDivisionError("x"), KeyError("x"), RecursionError("x"), MemoryError(), shapely.errors.GEOSException()],
)
def test_whatever_goes_wrong_in_a_reader_is_one_sentence_with_the_file(wrong: Exception, tmp_path: Path) -> None:
    def fail(_data: bytes | str, _options: ReadOptions) -> Lines:
        raise wrong

    path = tmp_path / "sheet.toy"
    path.write_bytes(b"toy")
    with pytest.raises(solver.PatternError, match=r"sheet\.toy: the drawing cannot be understood"):
        DrawingFormat("Toy", (".toy",), fail).read(path)
