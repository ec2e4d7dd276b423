"""OBJ files say what they were given."""

from __future__ import annotations

import numpy as np
import pytest

from solver.files.obj import obj_text


def parse(text: str) -> dict[str, list[list[str]]]:
    """Lines by keyword, from nothing but the format's description."""
    found: dict[str, list[list[str]]] = {}
    for line in text.splitlines():
        keyword, *words = line.split()
        found.setdefault(keyword, []).append(words)
    return found


def test_round_trip() -> None:
    rng = np.random.default_rng(1)
    vertices = rng.normal(size=(7, 3)) * 10.0 ** rng.integers(-12, 12, size=(7, 1))
    uv = rng.normal(size=(7, 2)) / 3
    faces = [[0, 1, 2], [2, 1, 3, 4], np.array([4, 5, 6, 0, 2])]
    found = parse(obj_text(vertices, uv, faces, [3, 3, 5], "a  sheet", "made of\npaper"))
    assert np.array_equal(np.array(found["v"], dtype=float), vertices)
    assert np.array_equal(np.array(found["vt"], dtype=float), uv)
    corners = [[[int(k) - 1 for k in corner.split("/")] for corner in face] for face in found["f"]]
    assert corners == [[[int(k), int(k)] for k in face] for face in faces]
    assert found["o"] == [["a_sheet"]]
    assert found["g"] == [["patch_3"], ["patch_5"]]
    assert found["#"] == [["made", "of"], ["paper"]]


def test_groups_stand_before_their_faces() -> None:
    lines = obj_text(np.zeros((3, 3)), np.zeros((3, 2)), [[0, 1, 2]] * 3, [1, 0, 0]).splitlines()
    assert [line.split()[0] for line in lines[-5:]] == ["g", "f", "g", "f", "f"]


@pytest.mark.parametrize("face", [[0, 1], [0, 1, 3], [0, 1, -1], [0, 1, 1]])
def test_faces_that_are_none(face: list[int]) -> None:
    with pytest.raises(ValueError, match="face 0"):
        obj_text(np.zeros((3, 3)), np.zeros((3, 2)), [face])


def test_numbers_must_be_finite_and_shapes_fit() -> None:
    with pytest.raises(ValueError, match="finite"):
        obj_text([[0, 0, np.nan]] * 3, np.zeros((3, 2)), [[0, 1, 2]])
    with pytest.raises(ValueError, match="uv"):
        obj_text(np.zeros((3, 3)), np.zeros((2, 2)), [[0, 1, 2]])
    with pytest.raises(ValueError, match="groups"):
        obj_text(np.zeros((3, 3)), np.zeros((3, 2)), [[0, 1, 2]], [0, 1])
