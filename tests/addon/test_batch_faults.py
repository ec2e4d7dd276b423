"""A batch in trouble: names that would lead out of its folder, odd lists, killed in the middle, a folder it may
not write to. Nothing half-written stands under its final name, and the next run does the rest."""

import contextlib
import itertools
import json
import os
import shutil
import signal
import stat
import string
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

ROOT = Path(__file__).resolve().parents[2]
QUICK = ["--resolution", "10", "--angle", "20"]

ODD = st.text(string.ascii_letters + "./\\ -é\t#", max_size=14)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(names=st.lists(st.sampled_from(["..", ".", "...", "a/..", "../..", "a", ""]) | ODD, max_size=5))
def test_no_drawing_leads_out_of_the_folder(extension, names):
    batch = extension("curvefold_addon.batch")
    out = Path("/somewhere/out")
    sheets = [(Path("/drawings") / f"{name}.svg", sheet) for name in names for sheet in (None, 1, 2)]
    tasks = list(batch._tasks(sheets, out, False, []))
    folders = [Path(os.path.normpath(task.folder)) for task in tasks]
    assert all(folder.parent == out for folder in folders)
    assert len({str(folder).lower() for folder in folders}) == len(sheets)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(data=st.binary(max_size=80))
def test_any_list_is_read_or_refused(extension, data, tmp_path_factory):
    lists = extension("curvefold_addon.drawing_list")
    path = tmp_path_factory.mktemp("lists") / "list.txt"
    path.write_bytes(data)
    with contextlib.suppress(lists.BatchError):
        assert lists.find_drawings(path).drawings


@pytest.mark.skipif(os.name != "posix", reason="needs devices and pipes")
@pytest.mark.parametrize("line", ["/dev/zero", "pipe.svg"])
def test_what_has_no_end_is_one_failure(extension, tmp_path, capsys, line):
    os.mkfifo(tmp_path / "pipe.svg")
    (tmp_path / "list.txt").write_text(line)
    out = tmp_path / "out"
    assert extension("curvefold_addon.cli").main(["batch", str(tmp_path / "list.txt"), "--out", str(out)]) == 1
    assert "it is not a file" in (out / "summary.csv").read_text()


@pytest.mark.parametrize("data", [b"a\0.svg", b"a.svg\n" * 200_000], ids=["NUL", "far too long"])
def test_a_list_that_is_none_is_refused_in_a_line(extension, tmp_path, capsys, data):
    (tmp_path / "list.txt").write_bytes(data)
    argv = ["batch", str(tmp_path / "list.txt"), "--out", str(tmp_path / "out")]
    assert extension("curvefold_addon.cli").main(argv) == 2
    said = capsys.readouterr().err.strip()
    assert said.startswith("curvefold: ")
    assert len(said.splitlines()) == 1


@pytest.mark.parametrize(
    "changed",
    [{"exit_code": "0"}, {"exit_code": 7}, {"sentence": 5}, {"seconds": None}, {"seconds": 10**400}],
    ids=repr,
)
def test_a_stamp_that_says_something_odd_is_not_believed(extension, tmp_path, changed):
    batch = extension("curvefold_addon.batch")
    drawing = tmp_path / "a.svg"
    drawing.write_text("<svg/>")
    (task,) = batch._tasks([(drawing, None)], tmp_path / "out", False, [])
    task.folder.mkdir(parents=True)
    for name in (*batch.RESULTS, task.picture):
        (task.folder / name).write_text("{}")
    stamp = {"made_from": task.stamp(), "report_sha256": batch._sha256(task.folder / batch.REPORT)}
    stamp |= {"exit_code": 0, "sentence": "Folded.", "seconds": 1.0}
    (task.folder / batch.STAMP).write_text(json.dumps(stamp))
    assert batch.is_finished(task) is not None
    (task.folder / batch.STAMP).write_text(json.dumps(stamp | changed))
    assert batch.is_finished(task) is None


def command(folder, out):
    return [sys.executable, "-m", "curvefold_addon", "batch", str(folder), "--out", str(out), "--jobs", "1", *QUICK]


def whole(out):
    """Every file under a final name is complete."""
    for path in out.rglob("*.json"):
        json.loads(path.read_text(encoding="utf-8"))
    for path in out.rglob("folded.obj"):
        assert path.read_text(encoding="utf-8").rstrip().splitlines()[-1].startswith("f ")


@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
def test_killed_in_the_middle_it_goes_on_where_it_was(drawing, tmp_path):
    folder, out = tmp_path / "drawings", tmp_path / "out"
    folder.mkdir()
    for name in "abc":
        shutil.copy(drawing, folder / f"{name}.svg")
    first = subprocess.Popen(command(folder, out), cwd=ROOT, start_new_session=True,
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
    for _ in itertools.repeat(None, 1200):
        if list(out.glob("*/batch.json")) or first.poll() is not None:
            break
        time.sleep(0.1)
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    whole(out)
    done = {path.parent.name: path.stat().st_mtime_ns for path in out.glob("*/batch.json")}
    assert done
    again = subprocess.run(command(folder, out), cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert again.returncode == 0, again.stdout + again.stderr
    after = {path.parent.name: path.stat().st_mtime_ns for path in out.glob("*/batch.json")}
    assert set(after) == set("abc")
    assert {name: after[name] for name in done} == done
    whole(out)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_it_may_not_write_to_is_named(drawing, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    out.chmod(stat.S_IRUSR | stat.S_IXUSR)
    done = subprocess.run(command(drawing, out), cwd=ROOT, capture_output=True, text=True, timeout=300)
    assert done.returncode != 0
    assert "Traceback" not in done.stdout + done.stderr
    assert not list(out.iterdir())
