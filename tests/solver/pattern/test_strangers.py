"""Drawings as the world's programs write them are read as their authors mean them."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import solver
from benchmarks.drawings import BAR
from tests.solver.pattern.strangers import EXPORTERS, Stranger, stranger
from tests.solver.pattern.strangers_designs import DESIGNS
from tests.solver.pattern.strangers_judge import faults

#: Five files of every program.
COUNT = 5 * len(EXPORTERS)


@cache
def the_file(number: int) -> Stranger:
    return stranger(number)


def as_meant(one: Stranger) -> list[solver.CreasePattern]:
    """What a reader gives that understands all: in the drawing's units, with an origin of its own."""
    unit = one.export.unit
    return [
        solver.CreasePattern(
            unit * sheet.outline[:-1] + (7.0, -3.0),
            [unit * hole[:-1] + (7.0, -3.0) for hole in sheet.holes],
            [solver.Crease(unit * points + (7.0, -3.0), assignment=letters[0]) for points, letters in sheet.folds],
            unit_mm=one.export.unit_mm,
        )
        for sheet in one.sheets
    ]


def test_strangers_are_read_as_they_are_meant(tmp_path: Path) -> None:
    wrong = []
    for number in range(COUNT):
        one = the_file(number)
        try:
            found = one.faults(solver.read_patterns(one.write(tmp_path)))
        except solver.CurvefoldError as error:
            found = one.faults(error)
        if found:
            wrong.append(f"{number} {one.words()}: {'; '.join(found)}")
    assert len(wrong) <= (1.0 - BAR) * COUNT, f"{len(wrong)} of {COUNT}:\n" + "\n".join(wrong)


def test_there_are_enough_of_all_kinds_and_no_two_are_the_same() -> None:
    files = [the_file(number) for number in range(COUNT)]
    assert len({one.export.text for one in files}) == COUNT >= 150
    assert {name for one in files for name in one.designs} == {
        make(np.random.default_rng(0)).name for make in DESIGNS
    }
    assert Counter(one.exporter for one in files) == {exporter.name: 5 for exporter in EXPORTERS}
    habits = [one.habits for one in files]
    assert {one.border for one in habits} == {"closed", "sides", "open sides", "page"}
    assert {one.form for one in habits} == {"as it is", "polyline", "pieces", "dashes"}
    assert {one.marks for one in habits} == {"colours", "names", "dashes", "plain", "one colour"}
    assert {one.sheets for one in habits} == {1, 2, 3}
    assert any(one.miss < 0 for one in habits)
    assert any(one.miss > 0 for one in habits)
    assert any(one.doubled for one in habits)
    assert any("dimensions" in one.beside for one in habits)


def test_a_number_is_always_the_same_file() -> None:
    assert all(stranger(number).export == the_file(number).export for number in range(len(EXPORTERS)))


def test_what_is_written_is_well_formed() -> None:
    for number in range(COUNT):
        one = the_file(number)
        if one.export.suffix == ".svg":
            assert ElementTree.fromstring(one.export.text.encode()).tag == "{http://www.w3.org/2000/svg}svg"
        else:
            assert len(json.loads(one.export.text)["edges_vertices"]) > 4


# --- the judge ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", range(2 * len(EXPORTERS)))
def test_the_judge_accepts_what_is_meant(number: int) -> None:
    one = the_file(number)
    if not one.export.refused:
        assert one.faults(as_meant(one)) == []


def small() -> tuple[Stranger, solver.CreasePattern]:
    """A file with one sheet, a hole, and mountains and valleys; and how it is meant."""
    for number in range(COUNT):
        one = the_file(number)
        letters = {letters for sheet in one.sheets for _, letters in sheet.folds}
        if len(one.sheets) == 1 and one.sheets[0].holes and letters == {"M", "V"} and one.export.unit_mm:
            return one, as_meant(one)[0]
    raise AssertionError("there is no such file")


def test_the_judge_finds_what_is_wrong() -> None:
    one, right = small()
    first, *others = right.creases

    def told(
        boundary: object = right.boundary, holes: object = right.holes, creases: object = right.creases
    ) -> str:
        read = solver.CreasePattern(boundary, holes, creases, unit_mm=right.unit_mm)
        return "; ".join(one.faults([read]))

    turned = {"M": "V", "V": "M"}[first.assignment]
    line = solver.Crease(right.boundary[[0, len(right.boundary) // 2]])
    assert told() == ""
    assert "of its area" in told(boundary=1.1 * right.boundary)
    assert "0 holes instead of 1" in told(holes=())
    assert "of their area" in told(holes=[right.holes[0] + 0.3 * (right.holes[0] - right.holes[0].mean(axis=0))])
    assert "is covered to 0%" in told(creases=others)
    assert f"is read as {turned} instead of {first.assignment}" in told(
        creases=[solver.Crease(first.points, first.closed, turned), *others]
    )
    assert "what is none is read as a crease" in told(creases=[*right.creases, line])
    assert "creases instead of" in told(creases=right.creases * 9)
    assert "2 sheets instead of 1" in "; ".join(one.faults([right, right]))


def test_the_judge_asks_for_the_size_that_the_file_tells() -> None:
    one, right = small()
    other = right.named("", 2.0 * right.unit_mm)
    assert "instead of" in "; ".join(one.faults([other]))
    assert faults(one.sheets, one.export.unit, None, [other]) == []


def test_the_judge_wants_a_reason_for_refusing_shapes_that_are_filled() -> None:
    one = next(the_file(n) for n in range(COUNT) if the_file(n).export.refused)
    assert one.faults(solver.PatternError("all of it is filled shapes")) == []
    assert one.faults(solver.PatternError("no border found")) != []
    assert one.faults(as_meant(one)) != []
    plain = replace(one, export=replace(one.export, refused=""))
    assert plain.faults(solver.PatternError("no border found")) == ["refused: no border found"]
