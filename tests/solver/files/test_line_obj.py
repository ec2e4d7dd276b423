"""OBJ files of lines say what they were given."""

from __future__ import annotations

import numpy as np
import pytest

from solver.files.line_obj import line_obj_text


def test_round_trip() -> None:
    rng = np.random.default_rng(1)
    vertices = rng.normal(size=(6, 3)) * 10.0 ** rng.integers(-12, 12, size=(6, 1))
    lines = [[0, 1], [4, 1], [3, 2]]
    text = line_obj_text(vertices, lines, ["one", "one", "the other"], "a  sheet", "made of\npaper").splitlines()
    assert text[:3] == ["# made of", "# paper", "o a_sheet"]
    assert np.array_equal([[float(c) for c in row.split()[1:]] for row in text[3:9]], vertices)
    assert text[9:] == ["g one", "l 1 2", "l 5 2", "g the_other", "l 4 3", "g points", "p 6"]


def test_without_lonely_vertices_there_are_no_points() -> None:
    assert "p" not in [row.split()[0] for row in line_obj_text(np.zeros((2, 3)), [[0, 1]], ["a"]).splitlines()]


def test_nothing_is_a_file_too() -> None:
    assert line_obj_text(np.zeros((0, 3)), np.zeros((0, 2), dtype=int), []) == "o curvefold\n"


@pytest.mark.parametrize("pair", [[0, 2], [-1, 0], [1, 1]])
def test_lines_that_are_none(pair: list[int]) -> None:
    with pytest.raises(ValueError, match="line"):
        line_obj_text(np.zeros((2, 3)), [pair], ["a"])


def test_numbers_must_be_finite_and_shapes_fit() -> None:
    with pytest.raises(ValueError, match="finite"):
        line_obj_text([[0, 0, np.inf]] * 2, [[0, 1]], ["a"])
    with pytest.raises(ValueError, match="lines"):
        line_obj_text(np.zeros((2, 3)), [[0, 1]], ["a", "b"])
