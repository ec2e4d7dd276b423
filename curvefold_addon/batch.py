"""Many drawings: each sheet in its own folder and its own process, what is finished is not done again."""

import csv
import errno
import hashlib
import io
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy

from .. import solver
from ..solver.files.ruling_files import RULING_FILES
from ..solver.files.writable import check_writable
from .bridge import contact_sheet
from .drawing_list import BatchError, count_sheets, find_drawings
from .whole_files import whole_file, write_text

__all__ = ["BatchError", "Outcome", "Task", "run"]

REPORT = "report.json"
RESULTS = ("folded.obj", "folded.fold", REPORT)
PICTURE = "picture.png"
THUMBNAIL = "thumbnail.png"
LOG = "log.txt"
#: Says from what the results beside it were made. Written last.
STAMP = "batch.json"
STAMP_FORMAT = 1

SUMMARY = "summary.csv"
CONTACT_SHEET = "contact_sheet.png"
#: What no folder of results may be called.
OWN_FILES = re.compile(r"summary\.csv|contact_sheet(-\d+)?\.png")

#: Without --render, a small quick picture for the contact sheet.
THUMBNAIL_OPTIONS = ("--size", "320x240", "--samples", "12")

#: Exit codes of a drawing that was folded: its targets reached, or not all of them.
FOLDED_CODES = (0, 1)

#: What is said of a process that ended without results.
CRASHED = 3

#: How long a process may take to end after it was interrupted, seconds.
INTERRUPT_SECONDS = 10.0
#: How often Ctrl-C is looked for, seconds: on Windows nothing else wakes a thread that waits.
LISTEN_SECONDS = 0.5
#: What is written before it is moved to its name (``whole_files``, the solver's ``atomic``).
PARTIAL_FILES = ".*.part*"

#: The package of the whole extension.
EXTENSION = __package__.rpartition(".")[0]


@dataclass(frozen=True)
class Task:
    """One drawing, or one sheet of it, and the folder of its results."""

    drawing: Path
    folder: Path
    picture: str
    options: tuple[str, ...]

    @property
    def results(self) -> tuple[str, ...]:
        """The files that a fold of it leaves."""
        more = RULING_FILES if "--rulings" in self.options else ()
        return (*RESULTS, *more, self.picture)

    def stamp(self) -> dict[str, Any]:
        """What the results are made from."""
        return {
            "format": STAMP_FORMAT,
            "drawing_sha256": _sha256(self.drawing),
            "options": [_named_content(option) for option in self.options],
            "picture": self.picture,
        }


@dataclass(frozen=True)
class Outcome:
    """How one drawing went."""

    task: Task
    exit_code: int
    sentence: str
    seconds: float
    skipped: bool = False

    @property
    def word(self) -> str:
        if self.exit_code == 0:
            return "folded"
        return "partly folded" if self.exit_code in FOLDED_CODES else "failed"


def run(
    source: Path, out: Path, *, jobs: int, render: bool, options: list[str], reading: solver.ReadOptions
) -> int:
    """Folds all drawings; 0 when every one reached its targets, 1 otherwise. Raises BatchError, CurvefoldError.

    options: the arguments of ``fold``; reading: what they say of how drawings are read
    """
    found = find_drawings(source)
    check_writable(out, [SUMMARY, CONTACT_SHEET])
    tasks = list(_tasks(_sheets(found.drawings, reading), out, render, options))
    if found.hidden:
        print(f"{found.hidden} hidden {'file is' if found.hidden == 1 else 'files are'} passed over", flush=True)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BatchError(f"{out}: cannot be made: {error.strerror}") from error
    outcomes: dict[Task, Outcome] = {}
    crew = _Crew(jobs)
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(crew.work, task) for task in tasks]
        try:
            for future in _as_completed(futures):
                outcome = future.result()
                outcomes[outcome.task] = outcome
                _say(outcome, len(outcomes), len(tasks))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            crew.stop()
            raise
    ordered = [outcomes[task] for task in tasks]
    write_text(out / SUMMARY, summary(ordered))
    pictures = _save_contact_sheets(out, [_tile(outcome) for outcome in ordered])
    bad = [outcome for outcome in ordered if outcome.exit_code != 0]
    things = "drawings" if len({task.drawing for task in tasks}) == len(tasks) else "sheets"
    print(f"{len(ordered) - len(bad)} of {len(ordered)} {things} folded; {out / SUMMARY}, {pictures}", flush=True)
    return 1 if bad else 0


def _as_completed(futures: Iterable[Future[Outcome]]) -> Iterator[Future[Outcome]]:
    """Each future when it is done, in a way that Ctrl-C can break off everywhere."""
    waiting = set(futures)
    while waiting:
        done, waiting = wait(waiting, LISTEN_SECONDS, FIRST_COMPLETED)
        yield from done


def _save_contact_sheets(out: Path, tiles: list[contact_sheet.Tile]) -> str:
    """Saves as many sheets as the tiles fill, and removes those that an earlier run had more of. Says where."""
    sheets = contact_sheet.sheets(tiles)
    for number, some in enumerate(sheets, 1):
        with whole_file(_contact_sheet(out, number)) as partial:
            contact_sheet.save(partial, some)
    number = len(sheets) + 1
    while (old := _contact_sheet(out, number)).is_file():
        old.unlink()
        number += 1
    return " to ".join(str(_contact_sheet(out, number)) for number in sorted({1, len(sheets)}))


def _contact_sheet(out: Path, number: int) -> Path:
    path = out / CONTACT_SHEET
    return path if number == 1 else path.with_stem(f"{path.stem}-{number}")


def is_finished(task: Task) -> Outcome | None:
    """The outcome of an earlier run, if it was made from the same drawing and options and is all there."""
    try:
        stamp = json.loads((task.folder / STAMP).read_text(encoding="utf-8"))
        dict(_flat(json.loads((task.folder / REPORT).read_text(encoding="utf-8"))))
        same = stamp["made_from"] == task.stamp() and stamp["report_sha256"] == _sha256(task.folder / REPORT)
        if not same or not all((task.folder / name).is_file() for name in task.results):
            return None
        code, sentence, seconds = stamp["exit_code"], stamp["sentence"], stamp["seconds"]
        if code not in FOLDED_CODES or not isinstance(sentence, str):
            return None
        return Outcome(task, int(code), " ".join(sentence.split()), float(seconds), skipped=True)
    # Whatever it holds instead, the drawing is folded again.
    except (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
        return None


def summary(outcomes: list[Outcome]) -> str:
    """The table: a row for each drawing, with every plain number of its report."""
    reports = [_report_values(outcome) for outcome in outcomes]
    columns = list(dict.fromkeys(key for report in reports for key in report))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["drawing", "folder", "result", "exit_code", "seconds_in_all", "sentence", *columns])
    for outcome, report in zip(outcomes, reports, strict=True):
        task = outcome.task
        row = [str(task.drawing), task.folder.name, outcome.word, outcome.exit_code, f"{outcome.seconds:.1f}"]
        writer.writerow([*row, outcome.sentence, *(report.get(column, "") for column in columns)])
    return text.getvalue()


class _Crew:
    """The processes of one batch."""

    def __init__(self, jobs: int) -> None:
        self._threads = max(1, (os.cpu_count() or 1) // jobs)
        self._lock = threading.Lock()
        self._running: set[subprocess.Popen[bytes]] = set()
        self._stopped = False
        # Asked here, in the main thread: bpy is not to be touched from the others.
        self._command, self._environment = _worker_command()
        # Every process would otherwise start as many threads as there are cores.
        for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
            self._environment[name] = str(self._threads)
        # Their last words are read as UTF-8, whatever the console is; a Blender program writes UTF-8 anyway.
        self._environment["PYTHONIOENCODING"] = "utf-8:backslashreplace"

    def work(self, task: Task) -> Outcome:
        """Folds one drawing unless it is finished. Whatever goes wrong becomes an outcome."""
        try:
            return is_finished(task) or self._fold(task)
        except OSError as error:
            return Outcome(task, 2, f"{error.filename or task.drawing}: {error.strerror or error}", 0.0)

    def stop(self) -> None:
        """Interrupts every process, and ends those that do not heed it."""
        with self._lock:
            self._stopped = True
            running = list(self._running)
        if os.name == "posix":  # on Windows the console has done so, and nobody else can
            for process in running:
                process.send_signal(signal.SIGINT)
        patience = time.monotonic() + INTERRUPT_SECONDS
        for process in running:
            try:
                process.wait(max(0.0, patience - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()

    def _fold(self, task: Task) -> Outcome:
        start = time.monotonic()
        if os.path.realpath(task.drawing.parent) == os.path.realpath(task.folder):
            return Outcome(task, 2, f"{task.drawing}: it lies where its results would be written", 0.0)
        task.folder.mkdir(parents=True, exist_ok=True)
        # Whatever was here is from another drawing or other options.
        for name in (STAMP, *RESULTS, *RULING_FILES, PICTURE, THUMBNAIL):
            (task.folder / name).unlink(missing_ok=True)
        made_from = task.stamp()
        picture = str(task.folder / task.picture)
        command = [*self._command, "fold", str(task.drawing), "--out", str(task.folder), *task.options]
        command += ["--render", picture, "--threads", str(self._threads)]
        log = task.folder / LOG
        with log.open("wb") as stream:
            code = self._wait(command, stream)
        if self._stopped:
            # A process that did not heed the interrupt has left what it was writing.
            for partial in task.folder.glob(PARTIAL_FILES):
                partial.unlink(missing_ok=True)
        seconds = time.monotonic() - start
        if code in FOLDED_CODES and not all((task.folder / name).is_file() for name in task.results):
            code = CRASHED  # Python itself ends with 1 on an error that nobody expected
        if code not in FOLDED_CODES and (self._stopped or _was_interrupted(log)):
            # At most its log tells how Python was interrupted while it started.
            log.unlink()
            return Outcome(task, code, "interrupted", seconds)
        if code not in FOLDED_CODES:
            return Outcome(task, code, _last_words(log, code), seconds)
        sentence = _sentence(task.folder / REPORT)
        stamp = {
            "made_from": made_from,
            "report_sha256": _sha256(task.folder / REPORT),
            "exit_code": code,
            "sentence": sentence,
            "seconds": seconds,
        }
        write_text(task.folder / STAMP, json.dumps(stamp, indent=2) + "\n")
        return Outcome(task, code, sentence, seconds)

    def _wait(self, command: list[str], stream: Any) -> int:
        with self._lock:
            if self._stopped:
                return 2
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=subprocess.STDOUT,
                env=self._environment,
            )
            self._running.add(process)
        try:
            return process.wait()
        finally:
            with self._lock:
                self._running.discard(process)


def _worker_command() -> tuple[list[str], dict[str, str]]:
    """How to start this command line again, and with which environment."""
    environment = dict(os.environ)
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--command", "curvefold"], environment
    # In the bpy module there is no program; sys.executable is this Python.
    worker = Path(__file__).with_name("module_worker.py")
    user_folder = bpy.utils.resource_path("USER")
    return [sys.executable, "-P", str(worker), user_folder, EXTENSION], environment


def _sheets(drawings: Iterable[Path], reading: solver.ReadOptions) -> Iterator[tuple[Path, int | None]]:
    """Each drawing, and the number of its sheet where it has several."""
    for drawing in drawings:
        count = count_sheets(drawing, reading)
        for sheet in range(1, count + 1):
            yield drawing, sheet if count > 1 else None


def _tasks(
    sheets: Iterable[tuple[Path, int | None]], out: Path, render: bool, options: list[str]
) -> Iterator[Task]:
    used: set[str] = set()
    for drawing, sheet in sheets:
        # "...svg" has the stem "..": no name may lead out of the folder.
        stem = drawing.stem if drawing.stem.strip(".") else "drawing"
        own = () if sheet is None else ("--sheet", str(sheet))
        stem = stem if sheet is None else f"{stem}-sheet{sheet}"
        name, number = stem, 1
        # Case does not tell folders apart everywhere.
        while name.lower() in used or OWN_FILES.fullmatch(name.lower()):
            number += 1
            name = f"{stem}-{number}"
        used.add(name.lower())
        picture = PICTURE if render else THUMBNAIL
        extra = () if render else THUMBNAIL_OPTIONS
        yield Task(drawing.absolute(), (out / name).absolute(), picture, (*options, *own, *extra))


def _named_content(option: str) -> str:
    """An option, and the content of the file it names, if it names one: a change of either is a change."""
    path = Path(option.partition("=")[2] or option)
    try:
        return f"{option} sha256:{_sha256(path)}" if path.is_file() else option
    except OSError:
        return option


def _sha256(path: Path) -> str:
    """Raises OSError, also for what has no end, such as a device."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is not a file", str(path))
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _sentence(report: Path) -> str:
    value = json.loads(report.read_text(encoding="utf-8")).get("sentence", "")
    return str(value)


def _was_interrupted(log: Path) -> bool:
    """Whether Ctrl-C met a process while its Python started. All at the console hear it, this one perhaps last."""
    return log.read_bytes().rstrip().endswith(b"KeyboardInterrupt")


def _last_words(log: Path, code: int) -> str:
    lines = [line.strip() for line in log.read_text(encoding="utf-8", errors="replace").splitlines()]
    last = next((line for line in reversed(lines) if line), "")
    return last or f"the process ended with {code} and said nothing"


def _report_values(outcome: Outcome) -> dict[str, Any]:
    if outcome.exit_code not in FOLDED_CODES:
        return {}
    report = json.loads((outcome.task.folder / REPORT).read_text(encoding="utf-8"))
    return dict(_flat(report))


def _flat(values: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        elif isinstance(value, bool | int | float):
            yield prefix + key, value


def _tile(outcome: Outcome) -> contact_sheet.Tile:
    task = outcome.task
    picture = task.folder / task.picture if outcome.exit_code in FOLDED_CODES else None
    return contact_sheet.Tile(task.folder.name, outcome.word if outcome.exit_code else "", picture)


def _say(outcome: Outcome, done: int, total: int) -> None:
    how = "finished before" if outcome.skipped else f"{outcome.seconds:.1f} s"
    print(f"[{done}/{total}] {outcome.task.folder.name}: {outcome.word} ({how}). {outcome.sentence}", flush=True)
