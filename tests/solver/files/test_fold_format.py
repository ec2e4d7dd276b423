"""FOLD files are valid JSON and keep to FOLD 1.2."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from solver.files.fold_format import fold_text

# Two squares and a triangle in a row: creases at x = 1 and x = 2.
FLAT = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [3, 0.5]])
FACES = [[0, 1, 2, 3], [1, 4, 5, 2], [4, 6, 5]]
FOLDED = np.column_stack([FLAT, np.array([0, 1, 1, 0, 0, 0, 1]) / 3])


def fold(**changes: Any) -> dict[str, Any]:
    arguments: dict[str, Any] = {
        "vertices": FOLDED,
        "uv": FLAT,
        "faces": FACES,
        "crease_edges": [[2, 1], [4, 5]],
        "crease_edge_crease": [7, 3],
        "crease_edge_angle": [-60.5, np.nan],
        "unit": "mm",
    }
    text = fold_text(**{**arguments, **changes})

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    return dict(json.loads(text, parse_constant=refuse))


def by_edge(content: dict[str, Any], key: str) -> dict[tuple[int, int], Any]:
    return dict(zip(map(tuple, content["edges_vertices"]), content[key], strict=True))


def test_coordinates_and_frames() -> None:
    content = fold(title="wavy")
    assert content["file_spec"] == 1.2
    assert content["file_title"] == "wavy"
    assert content["frame_unit"] == "mm"
    assert content["frame_classes"] == ["foldedForm"]
    assert np.array_equal(content["vertices_coords"], FOLDED)
    assert content["faces_vertices"] == FACES
    [frame] = content["file_frames"]
    assert frame["frame_classes"] == ["creasePattern"]
    assert frame["frame_parent"] == 0
    assert frame["frame_inherit"] is True
    assert np.array_equal(frame["vertices_coords"], FLAT)


def test_edges_letters_and_angles() -> None:
    content = fold()
    letters = by_edge(content, "edges_assignment")
    assert len(letters) == 9
    assert sorted(letters) == sorted({tuple(sorted((f[k - 1], f[k]))) for f in FACES for k in range(len(f))})
    assert letters.pop((1, 2)) == "M"
    assert letters.pop((4, 5)) == "U"
    assert set(letters.values()) == {"B"}
    angles = by_edge(content, "edges_foldAngle")
    assert angles.pop((1, 2)) == -60.5
    assert angles.pop((4, 5)) is None
    assert set(angles.values()) == {0.0}
    crease = by_edge(content, "edges_curvefold:crease")
    assert crease.pop((1, 2)) == 7
    assert crease.pop((4, 5)) == 3
    assert set(crease.values()) == {None}


def test_inner_edges_are_facets_and_angles_give_letters() -> None:
    content = fold(crease_edges=[[1, 2]], crease_edge_crease=[0], crease_edge_angle=[12.0])
    letters = by_edge(content, "edges_assignment")
    assert letters[1, 2] == "V"
    assert letters[4, 5] == "F"
    content = fold(crease_edge_angle=[0.0, -1e-9])
    assert by_edge(content, "edges_assignment")[1, 2] == "U"
    assert by_edge(content, "edges_assignment")[4, 5] == "U"


def test_no_creases_at_all() -> None:
    content = fold(crease_edges=[], crease_edge_crease=[], crease_edge_angle=[])
    assert set(content["edges_assignment"]) == {"B", "F"}


def test_own_keys_need_a_colon() -> None:
    assert fold(extra={"curvefold:steps": [1, 2]})["curvefold:steps"] == [1, 2]
    with pytest.raises(ValueError, match="colon"):
        fold(extra={"steps": 1})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"vertices": np.full_like(FOLDED, np.inf)}, "finite"),
        ({"uv": FLAT[:-1]}, "uv"),
        ({"unit": "furlong"}, "unit"),
        ({"crease_edges": [[0, 5], [4, 5]]}, "not an edge"),
        ({"crease_edges": [[1, 2], [2, 1]]}, "twice"),
        ({"crease_edge_angle": [np.inf, 0]}, "infinite"),
        ({"faces": [[0, 1]]}, "face 0"),
        ({"extra": {"a:b": float("nan")}}, "JSON"),
    ],
)
def test_wrong_arguments(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        fold(**changes)


def test_every_key_is_of_the_format_or_has_a_colon() -> None:
    known = {"file_spec", "file_creator", "file_classes", "file_title", "file_frames"}
    for key in fold(title="t"):
        assert key in known or key.startswith(("frame_", "vertices_", "edges_", "faces_")) or ":" in key
