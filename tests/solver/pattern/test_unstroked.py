"""What is said of a drawing whose lines are filled shapes."""

from __future__ import annotations

import io

import pytest

from solver.errors import PatternError
from solver.pattern.svg import read_svg

STRIP = '<path d="M0 {y}H100V{z}H0Z"/>'
RING = '<path d="M0 0H100V100H0Z M1 1V99H99V1Z"/>'


def refusal(body: str) -> str:
    with pytest.raises(PatternError) as caught:
        read_svg(io.StringIO(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>'))
    return str(caught.value)


def test_strokes_that_were_expanded_are_named_and_counted() -> None:
    said = refusal(RING + "".join(STRIP.format(y=y, z=y + 1) for y in (20, 40)))
    assert "3 filled shapes, all of them as thin as a line" in said
    assert '"Stroke to Path"' in said
    assert '"Outline Stroke"' in said


def test_one_of_several_is_thin() -> None:
    assert "2 filled shapes, 1 of them as thin" in refusal(RING + '<circle r="9"/>')


def test_shapes_that_are_no_lines_are_not_called_thin() -> None:
    said = refusal('<rect width="100" height="100"/><circle r="9"/>')
    assert "2 filled shapes; give the border and the creases a stroke" in said
    assert "as thin" not in said


def test_nothing_at_all() -> None:
    assert "nothing in it is stroked" in refusal("")
