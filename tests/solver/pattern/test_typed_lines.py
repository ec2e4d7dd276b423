"""CP and OPX files, written by hand as ORIPA and Oriedita write them."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from typed_files import SQUARE, Row, cp, opx

import solver
from solver.pattern.cp import read_cp
from solver.pattern.curves import sample_crease
from solver.pattern.opx import read_opx
from solver.pattern.sizes import NO_SIZE

FORMATS: list[Any] = [pytest.param((cp, read_cp), id="cp"), pytest.param((opx, read_opx), id="opx")]
Format = tuple[Callable[[Sequence[Row]], bytes], Callable[..., tuple[solver.CreasePattern, ...]]]


def read(form: Format, rows: Sequence[Row], **options: Any) -> solver.CreasePattern:
    write, reader = form
    [pattern] = reader(io.BytesIO(write(rows)), solver.ReadOptions(**options))
    return pattern


@pytest.mark.parametrize("form", FORMATS)
def test_types_and_y_down(form: Format) -> None:
    pattern = read(
        form,
        [*SQUARE, (2, -200, -100, 200, -100), (3, -200, 0, 200, 50), (0, 0, -200, 0, 200), (4, -200, 9, 0, 9)],
    )
    assert shapely.Polygon(pattern.boundary).area == pytest.approx(160_000)
    mountain, valley = pattern.creases
    assert mountain.assignment == "M"
    # What is above on the screen is above on the sheet.
    assert mountain.points[:, 1].tolist() == [100, 100]
    assert valley.assignment == "V"
    assert valley.points[:, 1].tolist() == [0, -50]
    assert any("1 stroke of type 0: left out: facet line" in note for note in pattern.notes)
    assert NO_SIZE in pattern.notes


@pytest.mark.parametrize("suffix", [".cp", ".opx"])
def test_a_sheet_of_one_unit_and_a_chosen_unit(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"sheet{suffix}"
    write = {".cp": cp, ".opx": opx}[suffix]
    rows = [(1, 0, 0, 1, 0), (1, 1, 0, 1, 1), (1, 1, 1, 0, 1), (1, 0, 1, 0, 0), (2, 0, 0.5, 1, 0.5)]
    path.write_bytes(write(rows))
    assert solver.read_pattern(path).unit_mm == 100.0
    assert solver.read_pattern(path, solver.ReadOptions(unit="cm", scale=3.0)).unit_mm == 30.0
    path.write_bytes(write([*SQUARE, (2, -200, 0, 200, 0)]))
    assert solver.read_pattern(path).unit_mm is None


@pytest.mark.parametrize("form", FORMATS)
def test_a_curve_of_many_lines_is_one_crease(form: Format) -> None:
    t = np.linspace(0.0, math.pi, 25)
    points = np.column_stack([-150 * np.cos(t), 150 * np.sin(t) - 50])
    pieces = [(2, *a, *b) for a, b in zip(points[:-1].tolist(), points[1:].tolist(), strict=True)]
    [crease] = read(form, [*SQUARE, *pieces]).creases
    exact = np.hypot(*(sample_crease(crease, 2.0) - (0, 50)).T)
    # The chords alone are off by 0.3.
    assert np.abs(exact - 150).max() < 0.01


@pytest.mark.parametrize("form", FORMATS)
def test_an_inner_outline_is_a_hole(form: Format) -> None:
    triangle = [(1, 0, 0, 50, 0), (1, 50, 0, 50, 50), (1, 50, 50, 0, 0)]
    pattern = read(form, [*SQUARE, (2, -200, -100, 200, -100), *triangle])
    assert len(pattern.holes) == 1


def test_a_type_without_a_meaning_is_a_crease_and_told() -> None:
    pattern = read((cp, read_cp), [*SQUARE, (2, -200, -100, 200, -100), (7, -200, 0, 200, 0)])
    assert sorted(crease.assignment for crease in pattern.creases) == ["M", "U"]
    assert "1 line of type 7, which has no meaning" in pattern.notes


@pytest.mark.parametrize("separator", [" ", "\t", ", ", "   "], ids=repr)
@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r", "\n\n", " \n"], ids=repr)
def test_ways_to_write_a_cp_file(separator: str, ending: str) -> None:
    [pattern] = read_cp(io.BytesIO(cp([*SQUARE, (2, -200, 0, 200, 0)], separator, ending)))
    assert len(pattern.creases) == 1


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_comments_and_encodings_of_a_cp_file(encoding: str) -> None:
    text = "# Fläche\n" + cp([*SQUARE, (2, -200, 0, 200, 0)]).decode() + "// end\nnot a line\n"
    [pattern] = read_cp(io.BytesIO(text.encode(encoding)))
    assert len(pattern.creases) == 1
    assert any("1 line of the text left out, the first in line 8" in note for note in pattern.notes)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "empty"),
        (b"\n \n", "empty"),
        (b"# only words\n", "no line"),
        (b"hello\nworld\n", "no CP file: line 1"),
        (b"<svg/>", "no CP file"),
        (b"2 0 0 1\n2 0 0\n", "no CP file"),
        (b"2 1 1 1 1\n", "no size"),
        (b"2 nan 0 1 1\n", "no line"),
        (b"2.5 0 0 1 1\n", "no CP file"),
        (b"1 0 0 1e300 1\n", "no line"),
        (b"\0" * 5000, "no CP file"),
    ],
)
def test_what_is_no_cp_file_is_refused_in_a_sentence(data: bytes, said: str) -> None:
    with pytest.raises(solver.CurvefoldError, match=said) as caught:
        read_cp(io.BytesIO(data))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "empty"),
        (b"<java", "not well-formed"),
        (b"<svg/>", "not OPX: its root element is <svg>"),
        (b"<java></java>", "no line"),
        (b"1 0 0 1 1\n", "not well-formed"),
        (opx([(2, 0, 0, 1, 1)]).replace(b"1.0<", b"one<"), "line 1: its x1 is 'one' and no number"),
        (b'<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><java>&b;</java>', "another file"),
        (b"<java>" + b"<object>" * 200 + b"</object>" * 200 + b"</java>", "nested more than"),
    ],
)
def test_what_is_no_opx_file_is_refused_in_a_sentence(data: bytes, said: str) -> None:
    with pytest.raises(solver.CurvefoldError, match=said) as caught:
        read_opx(io.BytesIO(data))
    assert "\n" not in str(caught.value)


def test_objects_of_other_classes_are_data_and_nothing_else(tmp_path: Path) -> None:
    """What a Java program would be told to call is not looked at."""
    call = (
        b'<void class="java.lang.Runtime" method="getRuntime"><void method="exec"><string>touch x</string>'
        b'</void></void><object class="java.io.FileWriter"><string>x</string><void property="x0"><double>5</double>'
        b"</void></object>"
    )
    data = opx([*SQUARE, (2, -200, 0, 200, 0)]).replace(
        b'<void property="lines">', call + b'<void property="lines">'
    )
    path = tmp_path / "crane.opx"
    path.write_bytes(data)
    pattern = solver.read_pattern(path)
    assert pattern.name == "crane"
    assert len(pattern.creases) == 1
    assert [one.name for one in tmp_path.iterdir()] == ["crane.opx"]


@pytest.mark.parametrize("form", FORMATS)
def test_too_many_lines(form: Format) -> None:
    rows: list[Row] = [(2, k, 0, k, 1) for k in range(30_001)]
    with pytest.raises(solver.PatternError, match="more than 30,000 strokes"):
        read(form, rows)


def test_both_say_the_same() -> None:
    rows: list[Row] = [*SQUARE, (2, -200, -100, 200, -100), (3, -200, 0, 0, 0), (3, 0, 0, 200, 0)]
    patterns = [read((write, reader), rows) for write, reader in ((cp, read_cp), (opx, read_opx))]
    assert patterns[0].notes == patterns[1].notes
    for one, other in zip(patterns[0].creases, patterns[1].creases, strict=True):
        assert one.points.tolist() == other.points.tolist()
