"""What a fold is told, as data: written, read back, and refused in one sentence when it is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import solver

number = st.floats(allow_nan=False, allow_infinity=False, width=64)
handle = st.builds(solver.Handle, st.tuples(number, number), st.tuples(number, number, number))
weight = st.floats(0, 1e9)
description = st.builds(
    solver.FoldDescription,
    resolution=st.just("auto") | st.integers(4, 200),
    angle=st.none() | st.floats(0, 180),
    handles=st.lists(handle, max_size=4).map(tuple),
    assignments=st.sampled_from(["free", "bind"]),
    weights=st.builds(solver.Weights, weight, weight, weight, weight, weight, weight),
    max_iterations=st.integers(1, 10_000),
    max_vertices=st.integers(100, 100_000),
)


@settings(max_examples=80, deadline=None, derandomize=True)
@given(description)
def test_a_description_comes_back_from_its_file_as_it_was(told: solver.FoldDescription) -> None:
    text = json.dumps(told.to_json(), allow_nan=False)
    assert solver.FoldDescription.from_json(json.loads(text)) == told


def test_an_empty_object_is_the_default_description() -> None:
    assert solver.FoldDescription.from_json({}) == solver.FoldDescription()


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.lists(handle, max_size=5))
def test_handles_come_back_from_their_file_as_they_were(
    tmp_path_factory: pytest.TempPathFactory, handles: list[solver.Handle]
) -> None:
    path = tmp_path_factory.mktemp("handles") / "handles.json"
    path.write_text(json.dumps([{"at": h.at, "target": h.target} for h in handles]), encoding="utf-8")
    assert solver.read_handles(path) == tuple(handles)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "not valid JSON"),
        ("[{", "not valid JSON"),
        ("{}", "list"),
        ("[3]", "handle 1"),
        ('[{"at": [0, 0], "target": [0, 0, 0]}, {"at": [0, 0]}]', "handle 2"),
        ('[{"at": [0, 0, 0], "target": [0, 0, 0]}]', "handle 1"),
        ('[{"at": [0, 0], "target": [0, 0]}]', "handle 1"),
        ('[{"at": [0, "x"], "target": [0, 0, 0]}]', "handle 1"),
        ('[{"at": [0, NaN], "target": [0, 0, 0]}]', "handle 1"),
        ('[{"at": [0, 1e999], "target": [0, 0, 0]}]', "handle 1"),
        ('[{"at": 5, "target": [0, 0, 0]}]', "handle 1"),
        ('[{"at": null, "target": [0, 0, 0]}]', "handle 1"),
        ("[" * 100_000, "not valid JSON"),
        ("\x00\x01", "not valid JSON"),
    ],
)
def test_a_bad_handle_file_is_refused_by_name_and_entry(tmp_path: Path, content: str, words: str) -> None:
    path = tmp_path / "bad handles.json"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(solver.HandleError) as caught:
        solver.read_handles(path)
    text = str(caught.value)
    assert "bad handles.json" in text
    assert words in text
    assert len(text.splitlines()) == 1


def test_a_missing_or_binary_handle_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(solver.HandleError, match=r"nothing\.json"):
        solver.read_handles(tmp_path / "nothing.json")
    with pytest.raises(solver.HandleError):
        solver.read_handles(tmp_path)
    binary = tmp_path / "binary.json"
    binary.write_bytes(bytes(range(256)))
    with pytest.raises(solver.HandleError, match=r"binary\.json"):
        solver.read_handles(binary)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({"resolutoin": 3}, "resolutoin"),
        ({"angle": -1}, "angle"),
        ({"angle": 181}, "angle"),
        ({"angle": float("nan")}, "angle"),
        ({"angle": "deep"}, "angle"),
        ({"assignments": "maybe"}, "assignments"),
        ({"weights": {"bending": -1}}, "bending"),
        ({"weights": {"bendin": 1}}, "weights"),
        ({"weights": 7}, "weights"),
        ({"format": 99}, "format"),
        ({"handles": {"at": [0, 0]}}, "handles"),
        ([1, 2], "object"),
        (None, "object"),
        ({"resolution": "many"}, "resolution"),
        ({"resolution": 7.5}, "resolution"),
        ({"resolution": True}, "resolution"),
        ({"resolution": ["auto"]}, "resolution"),
        ({"max_iterations": "all"}, "max_iterations"),
        ({"max_vertices": "auto"}, "max_vertices"),
        ({"max_vertices": 99}, "max_vertices"),
        ({"max_vertices": 1e4}, "max_vertices"),
    ],
)
def test_a_bad_description_is_refused_by_its_setting(data: Any, words: str) -> None:
    with pytest.raises((solver.DescriptionError, solver.HandleError)) as caught:
        solver.FoldDescription.from_json(data)
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_handle_that_is_no_handle_is_refused() -> None:
    for at, target in (
        ((0, float("inf")), (0, 0, 0)),
        ((0,), (0, 0, 0)),
        ((0, 0), (0, 0, "up")),
        (3, (0, 0, 0)),
    ):
        with pytest.raises(solver.HandleError):
            solver.Handle(at=at, target=target)  # type: ignore[arg-type]
