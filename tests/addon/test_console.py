"""The command line on consoles that cannot show every word, and after Ctrl-C."""

import itertools
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
QUICK = ["--resolution", "10", "--angle", "20"]
posix_only = pytest.mark.skipif(os.name != "posix", reason="on Windows only a console can interrupt")


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-u", "-m", "curvefold_addon", *arguments]


# --- encodings -------------------------------------------------------------------------------------------


@pytest.fixture
def strange(tmp_path, drawing, broken_drawing):
    """A folder of two drawings whose names no Western encoding has; the second one is broken."""
    folder = tmp_path / "折り紙"
    folder.mkdir()
    (folder / "crane 鶴.svg").write_text(drawing.read_text())
    (folder / "torn ≤ ∞.svg").write_text(broken_drawing.read_text())
    return folder


@pytest.mark.parametrize("encoding", ["cp1252", "utf-8"])
def test_a_batch_says_everything_on_any_console(strange, tmp_path, encoding):
    out = tmp_path / "出力"
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = subprocess.run(command("batch", str(strange), "--out", str(out), *QUICK), cwd=ROOT, env=environment,
                          capture_output=True, timeout=300)  # fmt: skip
    said = (done.stdout + done.stderr).decode(encoding)
    assert done.returncode == 1, said
    assert "Error" not in said
    names = ("crane 鶴: folded", "torn ≤ ∞: failed", "折り紙")
    for name in names:
        assert name.encode(encoding, "backslashreplace").decode(encoding) in said
    # The table is UTF-8, and what the processes said came through whole.
    table = (out / "summary.csv").read_text(encoding="utf-8")
    assert "\N{REPLACEMENT CHARACTER}" not in table
    assert f"{strange / 'torn ≤ ∞.svg'}: " in table
    assert "°" in (out / "crane 鶴" / "log.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("arguments", [["--help"], ["fold", "--help"], ["batch", "--help"], ["verify", "--help"]])
def test_help_is_shown_in_ascii(arguments):
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command(*arguments), cwd=ROOT, env=environment, capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(b"usage: ")


def test_streams_are_left_as_they_were(extension, capsys):
    before = (sys.stdout.errors, sys.stderr.errors)
    assert extension("curvefold_addon.cli").main(["--help"]) == 0
    assert (sys.stdout.errors, sys.stderr.errors) == before


# --- Ctrl-C ----------------------------------------------------------------------------------------------


class Interrupted:
    """A command in a session of its own that is interrupted once some event is there. Everything it said."""

    def __init__(self, arguments: list[str], tmp_path: Path, everyone: bool = False) -> None:
        self.temporary = tmp_path / "temporary"
        self.temporary.mkdir()
        environment = os.environ | {"TMPDIR": str(self.temporary)}
        self.process = subprocess.Popen(
            arguments, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            start_new_session=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )  # fmt: skip
        self.everyone = everyone
        self.said = ""

    def when_it_says(self, words: str) -> None:
        for line in self.process.stdout:
            self.said += line
            if words in line:
                self.interrupt()
                return
        raise AssertionError(f"it ended before it said {words!r}:\n{self.said}")

    def when(self, happens) -> None:
        for _ in itertools.repeat(None, 3000):
            if happens():
                break
            assert self.process.poll() is None, self.process.stdout.read()
            time.sleep(0.05)
        self.interrupt()

    def interrupt(self) -> None:
        # A console interrupts everyone who runs in it; "kill" only one.
        (os.killpg if self.everyone else os.kill)(self.process.pid, signal.SIGINT)
        self.said += self.process.communicate(timeout=300)[0]

    def left_nothing(self, out: Path) -> None:
        assert self.process.returncode == 130, self.said
        assert self.said.splitlines()[-1] == "curvefold: interrupted"
        assert "Traceback" not in self.said
        assert not list(out.rglob(".*")), "half-written files"
        assert not list(self.temporary.glob("curvefold-*"))
        with pytest.raises(ProcessLookupError):
            os.killpg(self.process.pid, 0)


@posix_only
def test_interrupted_while_it_folds(drawing, tmp_path):
    out = tmp_path / "out"
    run = Interrupted(command("fold", str(drawing), "--out", str(out), "--resolution", "60"), tmp_path)
    run.when_it_says("iterations")
    run.left_nothing(out)
    assert not out.exists()


@posix_only
def test_interrupted_while_blender_renders(drawing, tmp_path):
    out, picture = tmp_path / "out", tmp_path / "picture.png"
    slow = ["--size", "9000x9000", "--samples", "4000"]
    run = Interrupted(
        command("fold", str(drawing), "--out", str(out), "--render", str(picture), *QUICK, *slow), tmp_path
    )
    # The report comes last; then Blender takes over.
    run.when(lambda: (out / "report.json").exists())
    run.left_nothing(out)
    assert json.loads((out / "report.json").read_text())
    assert not list(tmp_path.glob("*.png"))
    assert not list(tmp_path.glob(".*"))


@posix_only
@pytest.mark.parametrize("everyone", [False, True])
def test_an_interrupted_batch_goes_on_where_it_was(drawing, tmp_path, everyone):
    folder, out = tmp_path / "drawings", tmp_path / "out"
    folder.mkdir()
    for name in "abc":
        (folder / f"{name}.svg").write_text(drawing.read_text())
    arguments = command("batch", str(folder), "--out", str(out), "--jobs", "2", *QUICK)
    run = Interrupted(arguments, tmp_path, everyone)
    run.when(lambda: list(out.glob("*/batch.json")))
    run.left_nothing(out)
    assert not (out / "summary.csv").exists()
    for log in out.glob("*/log.txt"):
        assert "Traceback" not in log.read_text()
    done = {path.parent.name: path.stat().st_mtime_ns for path in out.glob("*/batch.json")}
    assert done
    again = subprocess.run(arguments, cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert again.returncode == 0, again.stdout + again.stderr
    after = {path.parent.name: path.stat().st_mtime_ns for path in out.glob("*/batch.json")}
    assert set(after) == set("abc")
    assert {name: after[name] for name in done} == done


@posix_only
def test_interrupted_while_blender_starts(tmp_path):
    run = Interrupted(command("fold", "none.svg", "--out", str(tmp_path / "out")), tmp_path)
    # Its user folder is the first thing that it makes.
    run.when(lambda: list(run.temporary.glob("curvefold-*")))
    run.left_nothing(tmp_path / "out")


def test_a_process_that_does_not_heed_the_interrupt_is_ended(extension, drawing, tmp_path, monkeypatch):
    batch = extension("curvefold_addon.batch")
    monkeypatch.setattr(batch, "INTERRUPT_SECONDS", 0.2)
    deaf = (
        "import signal, sys, time, pathlib; signal.signal(signal.SIGINT, signal.SIG_IGN); "
        "pathlib.Path(sys.argv[4], '.0123456789abcdef.part.png').touch(); time.sleep(600)"
    )
    monkeypatch.setattr(batch, "_worker_command", lambda: ([sys.executable, "-c", deaf], dict(os.environ)))
    (task,) = batch._tasks([(drawing, None)], tmp_path / "out", False, [])

    def stop_when_it_is_there(futures):
        while not list(task.folder.glob(batch.PARTIAL_FILES)):
            time.sleep(0.01)
        raise KeyboardInterrupt

    monkeypatch.setattr(batch, "_as_completed", stop_when_it_is_there)
    main = extension("curvefold_addon.cli").main
    assert main(["batch", str(drawing), "--out", str(tmp_path / "out")]) == 130
    assert not list(task.folder.iterdir())
