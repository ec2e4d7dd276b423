"""Folded meshes from OBJ and FOLD files: what comes back, what others write, and what is refused."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import solver
from solver.files import obj_reading
from solver.files.fold_format import fold_text
from solver.files.fold_mesh import read_fold_mesh
from solver.files.mesh_reading import read_mesh
from solver.files.obj import obj_text
from solver.files.obj_reading import read_obj_mesh

# Two squares and a triangle in a row.
FLAT = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [3, 0.5]])
FACES = [[0, 1, 2, 3], [1, 4, 5, 2], [4, 6, 5]]
FOLDED = np.column_stack([FLAT, np.array([0, 1, 1, 0, 0, 0, 1]) / 3])


def obj(text: str) -> solver.SheetMesh:
    return read_obj_mesh(io.StringIO(text))


def fold(change: Callable[[dict[str, Any]], None] = lambda content: None) -> solver.SheetMesh:
    content = json.loads(fold_text(FOLDED, FLAT, FACES, [[1, 2]], [0], [-60.0], "mm"))
    change(content)
    return read_fold_mesh(io.BytesIO(json.dumps(content).encode()))


def same(mesh: solver.SheetMesh) -> bool:
    return (
        np.array_equal(mesh.vertices, FOLDED)
        and np.split(mesh.face_vertices, mesh.face_start[1:-1])[2].tolist() == FACES[2]
        and np.array_equal(mesh.face_vertices, np.concatenate(FACES))
        and np.array_equal(mesh.corner_flat, FLAT[np.concatenate(FACES)])
    )


def test_what_is_written_comes_back_bit_for_bit(tmp_path: Path) -> None:
    written = obj_text(FOLDED, FLAT, FACES, [0, 1, 1], "a sheet", "of a test")
    assert same(obj(written))
    assert obj(written).scale is None
    assert same(fold())
    assert fold().scale == 1.0
    path = tmp_path / "Sheet.OBJ"
    path.write_text(written)
    assert same(read_mesh(path))


def test_obj_as_others_write_it() -> None:
    """Negative numbers count backwards, normals and colours, lines that go on, comments, seams, CR LF."""
    text = (
        "# made elsewhere\r\nmtllib a.mtl\r\nv 0 0 0 1.0 0.5 0.5 0.5\r\nv 1e0 0 0\r\nv 1 1 0 # the last\r\n"
        "vt 0 0\r\nvt 1 0 0\r\nvt 1 1\r\nvn 0 0 1\r\ns off\r\nf -3/-3/1 -2/-2/1 \\\r\n -1/-1/1 # a face\r\n"
        "v 0 1 0\nvt 0.1 1\nvt 5 5\nvt 6 6\nl 1 2\nf 1/5 3/6 4/4 \\"
    )
    mesh = obj(text)
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.face_vertices.tolist() == [0, 1, 2, 0, 2, 3]
    assert mesh.corner_flat.tolist() == [[0, 0], [1, 0], [1, 1], [5, 5], [6, 6], [0.1, 1]]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "it has no face"),
        ("v 0 0 0\nvt 0 0\n", "it has no face"),
        ("v 0 0\n", "line 1: 3 numbers are expected"),
        ("v 0 0 zero\n", "line 1: 3 numbers are expected"),
        ("vt 0\n", "line 1: 2 numbers are expected"),
        ("v 0 0 0\nf 1 1 1\n", "line 2: a face has no texture coordinates"),
        ("v 0 0 0\nvn 0 0 1\nf 1//1 1//1 1//1\n", "line 3: a face has no texture coordinates"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1\n", "line 3: a face has fewer than three corners"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 2/1\n", "line 3: a face names '2', and there are 1 of these so far"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 1/0\n", "line 3: a face names '0'"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 1/-2\n", "line 3: a face names '-2'"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 one/1\n", "line 3: a face names 'one'"),
    ],
)
def test_obj_that_is_none(text: str, said: str) -> None:
    with pytest.raises(solver.ReadError) as caught:
        obj(text)
    assert said in str(caught.value)


def test_a_huge_obj_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj_reading, "MAX_ITEMS", 10)
    with pytest.raises(solver.ReadError, match="more than 10 vertices or corners"):
        obj(obj_text(FOLDED, FLAT, FACES))


def drop(*keys: str) -> Callable[[dict[str, Any]], None]:
    return lambda content: [content.pop(key) for key in keys] and None


def test_fold_as_others_write_it() -> None:
    """The sheet first and the folded form second; counted from 1; without a z; the units not the same."""

    def turned(content: dict[str, Any]) -> None:
        frame = content["file_frames"][0]
        for key in ("vertices_coords", "frame_classes"):
            content[key], frame[key] = frame[key], content[key]

    def twice(content: dict[str, Any]) -> None:
        """A folded form that says nothing of its own comes first."""
        turned(content)
        content["file_frames"].insert(
            0, {"frame_classes": ["foldedForm"], "frame_parent": 0, "frame_inherit": True}
        )

    assert same(fold(turned))
    assert same(fold(twice))
    assert same(fold(lambda c: c.update(faces_vertices=[[k + 1 for k in face] for face in FACES])))
    other = fold(lambda c: c["file_frames"][0].update(frame_unit="cm"))
    assert same(other)
    assert other.scale is None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (drop("faces_vertices"), "its folded form has no faces"),
        (drop("frame_classes"), "no frame called foldedForm"),
        (lambda c: c["file_frames"].clear(), "it holds only a folded form"),
        (lambda c: c["vertices_coords"].pop(), "6 vertices and its crease pattern 7"),
        (lambda c: c["faces_vertices"][2].append(99), "faces_vertices[2]: vertex 99 does not exist"),
        (lambda c: c["faces_vertices"][1].__setitem__(0, "a"), "faces_vertices[1]: a vertex of it is not"),
    ],
)
def test_fold_that_is_none(change: Callable[[dict[str, Any]], None], said: str) -> None:
    with pytest.raises(solver.CurvefoldError) as caught:
        fold(change)
    assert said in str(caught.value)


def test_a_vertex_that_is_null_is_lost() -> None:
    mesh = fold(lambda c: c["vertices_coords"].__setitem__(3, None))
    assert [fault.check for fault in solver.verify_mesh(mesh).faults] == ["finite"]


def test_files_that_are_not_there_or_of_another_kind(tmp_path: Path) -> None:
    for name, said in (("none.obj", "cannot be read"), ("none.fold", "cannot be read"), ("a.ply", r"\(\.ply\)")):
        with pytest.raises(solver.ReadError, match=said) as caught:
            read_mesh(tmp_path / name)
        assert name in str(caught.value)
    broken = tmp_path / "broken.obj"
    broken.write_bytes(b"v 0 0 0\nf 1 \xff\xfe 1\n")
    with pytest.raises(solver.ReadError, match="line 2"):
        read_mesh(broken)


WORDS = ["v", "vt", "f", "g", "#", "\\", "/", "1", "-1", "1.5", "nan", "inf", "1e999", "é", "\0"]
CORNERS = ["1/1", "2/2", "3/3", "-1/-1", "0/0", "9999999999/1"]


@settings(max_examples=200, deadline=None)
@given(st.lists(st.lists(st.sampled_from(WORDS + CORNERS), max_size=6), max_size=12))
def test_lines_of_any_kind_are_read_or_refused(lines: list[list[str]]) -> None:
    start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    try:
        mesh = obj(start + "\n".join(" ".join(words) for words in lines))
    except solver.CurvefoldError:
        return
    json.dumps(solver.verify_mesh(mesh).to_json(), allow_nan=False)
