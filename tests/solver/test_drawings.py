"""The measurement of drawings: what is read and folded, what is refused, what crashes and what hangs."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

import solver
from benchmarks.drawings import fold_all, found, read_all, rows, summary, usual_folders
from benchmarks.drawings_run import Fold, FoldJob, Reading, fold, read
from benchmarks.large_drawings import LARGE
from benchmarks.processes import each_alone

ROOT = Path(__file__).resolve().parents[2]
STRIP = ROOT / "sample_patterns" / "strip.svg"


def work(job: int) -> int:
    if job == 0:
        time.sleep(60)
    if job == 1:
        raise SystemExit(3)
    return 10 * job


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "one.svg").write_bytes(STRIP.read_bytes())
    (tmp_path / "none.svg").write_text("no drawing", encoding="utf-8")
    (tmp_path / "words.txt").write_text("no drawing", encoding="utf-8")
    return tmp_path


def test_work_ends_with_a_result_or_says_why_there_is_none() -> None:
    ended = {one.job: one for one in each_alone([0, 1, 2, 3], work, 2, 2.0)}
    assert [ended[job].result for job in (2, 3)] == [20, 30]
    assert ended[0].hung
    assert ended[0].sentence == "no end after 2 s"
    assert not ended[1].hung
    assert ended[1].sentence == "the process died (3)"


def test_a_sheet_is_read_and_folded_in_both_ways(folder: Path) -> None:
    readings = read_all(found([folder]), 1, 60.0)
    assert [Path(one.path).name for one in readings] == ["none.svg", "one.svg"]
    refused, one = readings
    assert refused.status == "refused"
    assert refused.sentence
    sheet = one.sheets[0]
    assert (sheet.creases, sheet.holes, sheet.letters) == (11, 0, {"M": 5, "V": 6})
    assert sheet.size == (320.0, 64.0)
    assert sheet.area == pytest.approx(320 * 64)
    folds = fold_all(readings, None, 1, 120.0)
    assert [job.way for job in folds] == ["angle", "corners"]
    by_angle, by_corners = folds.values()
    assert by_angle.ok
    assert by_angle.fold_angle == pytest.approx((60, 60, 60), abs=3)
    assert by_corners.status == "folded"
    assert by_corners.iterations == 24 * 5
    assert by_corners.resolution == 32
    assert 0 < by_corners.stretch_mean < by_corners.stretch_max
    table = "\n".join(rows(readings, folds))
    assert "5 M 6 V" in table
    told = summary(readings, folds)
    assert told[0] == "1 of 2 read, 1 refused, 0 crashes, 0 hangs"
    assert "none.svg" in told[1]
    assert told[2] == "folded by angle: 1 of 1 sheets (1 folded)"


def test_a_crash_is_called_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError("a slip")

    monkeypatch.setattr(solver, "read_patterns", broken)
    one = read(str(STRIP))
    assert one.status == "crash"
    assert one.sentence.startswith("ZeroDivisionError: a slip (test_drawings.py:")
    job = FoldJob(str(STRIP), 1, "angle", None)
    assert fold(job).status == "crash"
    told = summary([one], {job: Fold(job, "hang", sentence="no end after 9 s")})
    assert told[0] == "0 of 1 read, 0 refused, 1 crashes, 0 hangs"
    assert sum("CRASH OR HANG" in line for line in told) == 2


def test_the_usual_drawings_are_the_samples_and_those_of_folders_that_are_there(tmp_path: Path) -> None:
    (tmp_path / "cases").mkdir()
    assert usual_folders([tmp_path, tmp_path / "nothing"]) == [ROOT / "sample_patterns", tmp_path / "cases"]
    with pytest.raises(FileNotFoundError):
        found([tmp_path / "nothing"])


def test_the_command_writes_all_it_found(folder: Path) -> None:
    out = folder / "out.json"
    command = [
        sys.executable,
        "-m",
        "benchmarks.drawings",
        str(folder),
        "--read-only",
        "--notes",
        "--json",
        str(out),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "1 of 2 read" in done.stdout
    assert "one: 5 strokes of colour" in done.stdout
    data = json.loads(out.read_text(encoding="utf-8"))
    assert [one["status"] for one in data["readings"]] == ["refused", "read"]
    assert data["folds"] == []


def test_strangers_are_reported_by_program() -> None:
    command = [sys.executable, "-m", "benchmarks.drawings", "--strangers", "9", "--jobs", "1"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode in (0, 1), done.stderr
    assert " of 9 read as meant (" in done.stdout
    assert ", 0 crashes" in done.stdout
    assert "inkscape_new" in done.stdout


@pytest.mark.parametrize("name", LARGE)
def test_large_drawings_are_drawings(tmp_path: Path, name: str) -> None:
    suffix, make = LARGE[name]
    path = tmp_path / f"large{suffix}"
    path.write_text(make(300), encoding="utf-8")
    one = read(str(path))
    assert one.status == "read", one.sentence
    assert len(one.sheets) == 1
    assert one.sheets[0].area == pytest.approx(1e6, rel=1e-6)
    assert set(one.sheets[0].letters) == {"M", "V"}
    assert one.size == path.stat().st_size


def test_a_reading_says_what_it_took() -> None:
    one = read(str(STRIP))
    assert isinstance(one, Reading)
    assert one.seconds > 0
    assert one.memory >= 0
