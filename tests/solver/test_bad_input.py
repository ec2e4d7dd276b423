"""Bad input: one sentence with file, element and place; exit code not 0; nothing half-written."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import solver

ROOT = Path(__file__).resolve().parents[2]

GOOD = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" width="100mm" height="100mm">
<rect x="0" y="0" width="100" height="100" stroke="black" fill="none"/>
<path id="bow" d="M 0 45 Q 50 75 100 45" stroke="red" fill="none"/>
</svg>"""
THIN = (
    GOOD.replace("100 100", "100 2")
    .replace('height="100"', 'height="2"')
    .replace("M 0 45 Q 50 75 100 45", "M 0 1 Q 50 1.8 100 1")
)


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "solver", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        timeout=120,
    )


def write(folder: Path, name: str, content: str | bytes) -> str:
    data = content.encode() if isinstance(content, str) else content
    (folder / name).write_bytes(data)
    return name


# --- the command line, as a user runs it ----------------------------------------------------------------


def handles(*entries: tuple[tuple[float, ...], tuple[float, ...]]) -> str:
    return json.dumps([{"at": at, "target": target} for at, target in entries])


#: name -> drawing, handle file, more arguments, words of the one sentence.
REFUSED: dict[str, tuple[str | bytes, str | None, tuple[str, ...], tuple[str, ...]]] = {
    "an open border": (GOOD.replace('<rect x="0" y="0" width="100" height="100"', '<path d="M0 0H100V100H0V40"'),
                       None, (), ("drawing.svg", "border", "(0, 80)", "open by 40")),
    "empty file": ("", None, (), ("drawing.svg",)),
    "broken file": (GOOD[:150], None, (), ("drawing.svg",)),
    "not a drawing": (bytes(range(256)), None, (), ("drawing.svg",)),
    "not a number": (GOOD.replace("Q 50 75", "Q NaN 75"), None, (), ("drawing.svg", "bow")),
    "too thin for its grid": (THIN, None, ("--resolution", "10"), ("drawing.svg", "border", "50")),
    "a handle off the sheet": (GOOD, handles(((50, 50), (50, 50, 0)), ((150, 50), (0, 0, 0))), (),
                               ("handles.json", "handle 2", "(150, 50)", "off the sheet")),
    "two handles on one point": (GOOD, handles(((50, 20), (50, 20, 5)), ((50, 20), (50, 20, 9))), (),
                                 ("handles.json", "handle 2", "(50, 20)", "handle 1")),
    "a broken handle file": (GOOD, "[{", (), ("handles.json", "JSON")),
    "a handle without target": (GOOD, '[{"at": [1, 2]}]', (), ("handles.json", "handle 1", "target")),
    "a resolution of nothing": (GOOD, None, ("--resolution", "0"), ("resolution",)),
    "an angle beyond shut": (GOOD, None, ("--angle", "200"), ("angle",)),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_unusable_input_is_refused_in_one_sentence_and_nothing_is_written(tmp_path: Path, name: str) -> None:
    drawing, handle_file, more, words = REFUSED[name]
    arguments = ["fold", write(tmp_path, "drawing.svg", drawing), "--out", "out", *more]
    if handle_file is not None:
        arguments += ["--handles", write(tmp_path, "handles.json", handle_file)]
    before = sorted(p.name for p in tmp_path.iterdir())
    done = run(tmp_path, *arguments)
    said = (done.stdout + done.stderr).strip()
    assert done.returncode not in (0, None), said
    assert "Traceback" not in said
    *notes, sentence = said.splitlines()
    assert all(note.startswith("note: ") for note in notes), said
    for word in words:
        assert word in sentence, said
    assert sorted(p.name for p in tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("fold", "drawing.svg", "--out", "out", "--deep"), "--deep"),
        (("fold", "drawing.svg", "--out", "out", "--angle", "deep"), "--angle"),
        (("fold", "drawing.svg", "--out", "out", "--assignments", "maybe"), "--assignments"),
        (("fold", "drawing.svg"), "--out"),
        (("unfold", "drawing.svg"), "unfold"),
        ((), "command"),
    ],
)
def test_an_unknown_option_is_named_and_nothing_is_written(
    tmp_path: Path, arguments: tuple[str, ...], word: str
) -> None:
    write(tmp_path, "drawing.svg", GOOD)
    done = run(tmp_path, *arguments)
    assert done.returncode != 0
    assert word in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_drawing_that_is_not_there_or_of_another_kind_is_named(tmp_path: Path) -> None:
    for name in ("nothing.svg", "drawing.xyz"):
        done = run(tmp_path, "fold", name, "--out", "out")
        assert done.returncode != 0
        assert name in done.stderr
        assert len(done.stderr.strip().splitlines()) == 1
        assert not (tmp_path / "out").exists()


def test_an_out_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    write(tmp_path, "drawing.svg", GOOD)
    write(tmp_path, "out", "a file in the way")
    done = run(tmp_path, "fold", "drawing.svg", "--out", "out", "--resolution", "6", "--angle", "10")
    assert done.returncode != 0
    assert "out" in done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "out").read_text() == "a file in the way"


def test_an_unreachable_target_is_said_with_its_place_and_the_result_is_whole(tmp_path: Path) -> None:
    write(tmp_path, "drawing.svg", GOOD)
    write(tmp_path, "handles.json", handles(((0, 0), (0, 0, 0)), ((100, 0), (180, 0, 0))))
    done = run(tmp_path, "fold", "drawing.svg", "--out", "out", "--resolution", "8", "--handles", "handles.json")
    said = done.stdout + done.stderr
    assert done.returncode not in (0, None)
    assert "Traceback" not in said
    assert "out of reach" in said
    assert re.search(r"handles? (1 and )?[12]", said)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"folded.obj", "folded.fold", "report.json"}
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["ok"] is False
    assert report["status"] == "out_of_reach"
    assert report["handle_error"] > 10


def test_a_good_drawing_is_folded_and_written_whole(tmp_path: Path) -> None:
    write(tmp_path, "drawing.svg", GOOD)
    done = run(tmp_path, "fold", "drawing.svg", "--out", "deep/out", "--resolution", "8", "--angle", "40")
    assert done.returncode == 0, done.stderr
    assert {p.name for p in (tmp_path / "deep" / "out").iterdir()} == {
        "folded.obj",
        "folded.fold",
        "report.json",
    }
    assert "fold angle" in done.stdout + done.stderr


# --- the same through the library -----------------------------------------------------------------------

BOX = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
BOW = [(x, 0.45 + 0.5 * x * (1 - x)) for x in np.linspace(0, 1, 21).tolist()]

PATTERNS: dict[str, tuple[Callable[[], object], str]] = {
    "a border of two points": (lambda: solver.CreasePattern([(0, 0), (1, 1)]), "border"),
    "a border without area": (lambda: solver.CreasePattern([(0, 0), (1, 1), (2, 2)]), "border"),
    "a border with NaN": (lambda: solver.CreasePattern([(0, 0), (1, 0), (float("nan"), 1)]), "border"),
    "a border of words": (lambda: solver.CreasePattern("abc"), "border"),
    "a hole with infinity": (
        lambda: solver.CreasePattern(BOX, holes=[[(0.1, 0.1), (0.2, float("inf")), (0.2, 0.2)]]),
        "hole 1",
    ),
    "a crease of one point": (lambda: solver.Crease([(0, 0)], name="stub"), "stub"),
    "a crease with NaN": (lambda: solver.Crease([(0, 0), (float("nan"), 1)], name="gone"), "gone"),
    "a closed crease of two points": (
        lambda: solver.Crease([(0, 0), (1, 0)], closed=True, name="eye"),
        "eye",
    ),
    "an unknown assignment": (lambda: solver.Crease([(0, 0), (1, 0)], assignment="X", name="odd"), "odd"),
}


@pytest.mark.parametrize("name", PATTERNS)
def test_a_drawing_that_is_none_is_refused_by_its_element(name: str) -> None:
    make, element = PATTERNS[name]
    with pytest.raises(solver.PatternError) as caught:
        make()
    assert element in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


NETS: dict[str, tuple[solver.CreasePattern, int, str]] = {
    "a border that crosses itself": (
        solver.CreasePattern([(0, 0), (1, 1), (1, 0), (0, 0.5)], creases=[solver.Crease(BOW)]),
        8,
        "border",
    ),
    "a hole over everything": (
        solver.CreasePattern(BOX, holes=[[(-1, -1), (2, -1), (2, 2), (-1, 2)]], creases=[solver.Crease(BOW)]),
        8,
        "hole",
    ),
    "a hole that cuts the sheet": (
        solver.CreasePattern(BOX, holes=[[(-1, 0.4), (2, 0.4), (2, 0.6), (-1, 0.6)]], creases=[solver.Crease(BOW)]),
        8,
        "hole",
    ),
    "a sheet thinner than a cell": (
        solver.CreasePattern(
            [(0, 0), (1, 0), (1, 0.02), (0, 0.02)], creases=[solver.Crease([(0, 0.01), (1, 0.013)])]
        ),
        8,
        "50",
    ),
    "resolution 0": (solver.CreasePattern(BOX, creases=[solver.Crease(BOW)]), 0, "resolution"),
    "resolution a million": (solver.CreasePattern(BOX, creases=[solver.Crease(BOW)]), 10**6, "resolution"),
    "resolution 7.5": (solver.CreasePattern(BOX, creases=[solver.Crease(BOW)]), 7.5, "resolution"),  # type: ignore[dict-item]
}


@pytest.mark.parametrize("name", NETS)
def test_a_drawing_without_a_net_is_refused_in_one_sentence(name: str) -> None:
    pattern, resolution, word = NETS[name]
    with pytest.raises((solver.PatternError, solver.NetError)) as caught:
        solver.build_net(pattern, resolution)
    assert word in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_the_place_of_a_crossing_border_is_given_in_the_drawings_own_units() -> None:
    bow_tie = np.array([(0, 0), (2, 2), (2, 0), (0, 2)]) * 50.0 + 1000.0
    with pytest.raises(solver.PatternError) as caught:
        solver.build_net(
            solver.CreasePattern(
                bow_tie + np.array([(0, 0), (0, 1), (0, 0), (0, 0)]), creases=[solver.Crease(bow_tie)]
            )
        )
    assert caught.value.where.place == pytest.approx((1050, 1050), abs=1)


@pytest.mark.parametrize(
    ("at", "words"),
    [((1.5, 0.5), "off the sheet"), ((0.5, -0.2), "off the sheet"), ((-7e5, 0.1), "off the sheet")],
)
def test_a_handle_off_the_sheet_is_refused_with_its_place(
    drawings: ModuleType, at: tuple[float, float], words: str
) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 8))
    good = solver.Handle(at=(0.5, 0.1), target=(0.5, 0.1, 0.1))
    with pytest.raises(solver.HandleError) as caught:
        model.set_handles([good, solver.Handle(at=at, target=(0, 0, 0))])
    assert words in str(caught.value)
    assert caught.value.where.element == "handle 2"
    assert caught.value.where.place == at


def test_two_handles_on_one_point_must_agree(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 8))
    first = solver.Handle(at=(0.5, 0.1), target=(0.5, 0.1, 0.1))
    model.set_handles([first, solver.Handle(at=(0.5, 0.1), target=(0.5, 0.1, 0.1))])
    for at in ((0.5, 0.1), (0.5, 0.1 + 1e-13)):
        with pytest.raises(solver.HandleError) as caught:
            model.set_handles([first, solver.Handle(at=at, target=(0.5, 0.1, 0.2))])
        assert "handle 2" in str(caught.value)
        assert "handle 1" in str(caught.value)


def test_handles_that_are_refused_leave_the_model_as_it_was(drawings: ModuleType) -> None:
    model = solver.FoldModel(solver.build_net(drawings.one_arc(), 8))
    model.set_handles([solver.Handle(at=(0.0, 0.0), target=(0.1, 0.0, 0.1))])
    model.advance(5)
    before = model.positions
    with pytest.raises(solver.HandleError):
        model.set_handles([solver.Handle(at=(9.0, 0.0), target=(0.1, 0.0, 0.1))])
    assert np.array_equal(model.positions, before)
    assert model.advance(5).handle_error > 0


def test_positions_of_the_wrong_shape_or_not_finite_are_refused(drawings: ModuleType) -> None:
    net = solver.build_net(drawings.one_arc(), 8)
    flat = np.column_stack([net.rest, np.zeros(len(net.rest))])
    with pytest.raises(ValueError, match="positions"):
        solver.FoldModel(net, positions=flat[:-1])
    with pytest.raises(ValueError, match="positions"):
        solver.FoldModel(net, positions=np.where(np.arange(len(flat))[:, None] == 3, np.nan, flat))
    with pytest.raises(ValueError, match="positions"):
        solver.measure(net, flat[:, :2])


def test_an_unreachable_target_ends_with_a_status_and_finite_numbers(drawings: ModuleType) -> None:
    for far in (3.0, 1e6):
        result = solver.fold(
            drawings.one_arc(),
            solver.FoldDescription(
                resolution=8,
                angle=None,
                handles=(
                    solver.Handle(at=(0, 0), target=(0, 0, 0)),
                    solver.Handle(at=(1, 1), target=(far, far, 0)),
                ),
                max_iterations=400,
            ),
        )
        assert not result.status.ok
        assert result.status in (solver.Outcome.OUT_OF_REACH, solver.Outcome.NOT_FINITE)
        assert np.isfinite(result.positions).all()
        assert len(result.detail.splitlines()) == 1
