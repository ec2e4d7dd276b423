"""``python -m solver verify``: exit codes, words and JSON."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest

from solver.command_line import main
from solver.files.obj import obj_text

FLAT = np.array([(x, y) for y in range(4) for x in range(4)], dtype=float)
FACES = [[k, k + 1, k + 5, k + 4] for k in (0, 1, 2, 4, 5, 6, 8, 9, 10)]
#: Folded to a right angle along x = 1.
FOLDED = np.column_stack([np.minimum(FLAT[:, 0], 1), FLAT[:, 1], np.maximum(FLAT[:, 0] - 1, 0)])


@pytest.fixture
def written(tmp_path: Path) -> Path:
    path = tmp_path / "sheet.obj"
    path.write_text(obj_text(FOLDED, FLAT, FACES))
    return path


@pytest.fixture
def torn(tmp_path: Path) -> Path:
    """A vertex far off, and a face gone for it."""
    path = tmp_path / "torn.obj"
    x = FOLDED.copy()
    x[5] = x[10]
    path.write_text(obj_text(x, FLAT, FACES))
    return path


def run(*arguments: object) -> tuple[int, str]:
    stream = io.StringIO()
    return main(["verify", *map(str, arguments)], stream), stream.getvalue()


def test_paper(written: Path) -> None:
    sentence = "paper: lengths change by 0.00% in the mean and 0.0% at most, angles around a vertex by 0.00°"
    assert run(written) == (0, f"{written} is {sentence}\n")


def test_no_paper(torn: Path) -> None:
    code, said = run(torn)
    assert code == 1
    first, *more = said.splitlines()
    assert first.startswith(f"{torn} is not paper: edges are stretched by ")
    assert first.endswith(f"; and {len(more)} more faults")
    assert all(line.startswith("also: ") for line in more)
    assert any("of its flat area" in line for line in more)


def test_json(written: Path, torn: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(written, "--json") == (0, "")
    found = json.loads(capsys.readouterr().out)
    assert found["ok"] is True
    assert found["figures"]["area_min"] == pytest.approx(1.0)
    assert run(torn, "--json") == (1, "")
    found = json.loads(capsys.readouterr().out)
    assert found["ok"] is False
    assert found["faults"][0].startswith("edges are stretched by ")


def test_what_cannot_be_read(tmp_path: Path, written: Path) -> None:
    code, said = run(tmp_path / "none.fold")
    assert code == 2
    assert said.startswith(f"{tmp_path / 'none.fold'}: the file cannot be read")
    assert said.count("\n") == 1
    written.write_text(written.read_text().replace("vt", "vn"))
    code, said = run(written, "--json")
    assert code == 2
    assert "texture coordinates" in said or "so far" in said
