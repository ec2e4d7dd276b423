"""A fold whose results cannot be written: one sentence, and nothing half-written under a final name."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SAMPLE = ROOT / "sample_patterns" / "strip.svg"
FINAL = {"folded.obj", "folded.fold", "report.json"}

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs POSIX limits and signals")


def command(out: Path, resolution: int = 16) -> list[str]:
    return [sys.executable, "-m", "solver", "fold", str(SAMPLE), "--out", str(out), "--angle", "20",
            "--resolution", str(resolution)]  # fmt: skip


def no_room() -> None:
    """No file may grow beyond this, as on a disk that is full; the error comes as OSError."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))


def test_a_full_disk_is_said_and_leaves_no_final_file(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = subprocess.run(command(out), cwd=ROOT, capture_output=True, text=True, timeout=300, preexec_fn=no_room)
    said = done.stdout + done.stderr
    assert done.returncode == 2
    assert "Traceback" not in said
    *notes, sentence = done.stderr.strip().splitlines()
    assert all(note.startswith("note: ") for note in notes)
    assert "folded.obj" in sentence
    assert list(out.iterdir()) == []


def test_a_place_where_no_folder_can_be_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    out = tmp_path / "file" / "out"
    done = subprocess.run(command(out), cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode == 2
    *notes, sentence = done.stderr.strip().splitlines()
    assert all(note.startswith("note: ") for note in notes)
    assert str(out) in sentence


def test_killed_at_any_moment_the_report_says_that_all_is_there(tmp_path: Path) -> None:
    """The report is written last: where it stands, the other files are whole."""
    finished = 0
    for k, wait in enumerate((0.5, 1.0, 1.5, 2.5, 4.0, 30.0)):
        out = tmp_path / f"out{k}"
        process = subprocess.Popen(command(out, 8), cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + wait
        while time.monotonic() < end and process.poll() is None:
            time.sleep(0.02)
        process.kill()
        process.wait()
        names = {path.name for path in out.iterdir()} & FINAL if out.exists() else set()
        if "report.json" in names:
            finished += 1
            assert names == FINAL
        for path in out.glob("folded.obj"):
            assert path.read_text(encoding="utf-8").rstrip().splitlines()[-1].startswith("f ")
    assert finished >= 1
