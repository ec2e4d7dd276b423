"""Reads and folds drawings as people drew them, and says what became of each.

Run it: python -m benchmarks.drawings [PATH ...] [--folder FOLDER ...] [--read-only] [--json FILE] [--jobs J]
        python -m benchmarks.drawings --strangers N     files as programs write them, read against what they mean
        python -m benchmarks.drawings --large           reading drawings of thousands of strokes
A PATH is a drawing or a folder of them. Without one: sample_patterns/, and cases/ and patterns/ of a folder
"shared" beside the checkout, or of one named by --folder. Every sheet of every drawing is folded twice: by the
drive at 60 degrees, and by its two lower corners (the protocol of benchmarks.corpus). Each reading and each fold is
a process with a limit of time.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.drawings_run import WAYS, Fold, FoldJob, Reading, StrangerRun, fold, read, read_stranger, read_warm
from benchmarks.large_drawings import LARGE
from benchmarks.processes import each_alone
from solver.pattern.reading import READERS

ROOT = Path(__file__).resolve().parents[1]
#: Seconds after which a reading or a fold counts as hung.
TIME_LIMIT = 300.0
#: The share of the generator's files that should be read as meant.
BAR = 0.97
#: Strokes of large drawings, and in how many seconds such a drawing should be read.
LARGE_BARS = {2_000: 1.0, 20_000: 10.0}
#: Bytes of memory that a byte of a drawing may take.
MEMORY_BAR = 80
_HEADER = ("drawing", "creases", "letters", "read s", "notes", "way", "outcome", "angle 10/50/90",
           "stretch mean/max", "ripples sr", "cells", "iterations", "seconds")  # fmt: skip
#: A sheet with a median below this is hardly folded, degrees.
SHALLOW = 5.0
#: Letters of a reason that the summary groups by.
_REASON = 90

# --- what there is --------------------------------------------------------------------------------------


def found(paths: Sequence[Path]) -> list[Path]:
    """The drawings among files and folders, in the order of their names. Raises FileNotFoundError."""
    files: list[Path] = []
    for path in paths:
        if path.is_dir():
            files += sorted(one for one in path.iterdir() if one.suffix.lower() in READERS and one.is_file())
        elif path.is_file():
            files.append(path)
        else:
            raise FileNotFoundError(path)
    return files


def usual_folders(shared: Sequence[Path]) -> list[Path]:
    """The samples, and the cases and patterns in those of the folders that are there."""
    inside = [folder / name for folder in shared for name in ("cases", "patterns")]
    return [ROOT / "sample_patterns", *(folder for folder in inside if folder.is_dir())]


# --- drawings -------------------------------------------------------------------------------------------


def read_all(
    files: Sequence[Path], jobs: int, time_limit: float, work: Callable[[str], Reading] = read
) -> list[Reading]:
    """Every file read in a process of its own, in the order of the files."""
    made: dict[str, Reading] = {}
    for ended in each_alone([str(path) for path in files], work, jobs, time_limit):
        status = "hang" if ended.hung else "crash"
        path, seconds = ended.job, ended.seconds
        made[path] = ended.result or Reading(path, status, ended.sentence, seconds=seconds)
    return [made[str(path)] for path in files]


def fold_all(
    readings: Sequence[Reading], resolution: int | None, jobs: int, time_limit: float
) -> dict[FoldJob, Fold]:
    """Every sheet that was read folded in both ways, each in a process of its own."""
    tasks = [
        FoldJob(one.path, sheet, way, resolution)
        for one in readings
        for sheet in range(1, len(one.sheets) + 1)
        for way in WAYS
    ]
    made: dict[FoldJob, Fold] = {}
    for ended in each_alone(tasks, fold, jobs, time_limit):
        status = "hang" if ended.hung else "crash"
        made[ended.job] = ended.result or Fold(ended.job, status, sentence=ended.sentence, seconds=ended.seconds)
    return {task: made[task] for task in tasks}


def rows(readings: Sequence[Reading], folds: dict[FoldJob, Fold]) -> list[str]:
    """The table: a line for every fold, or for every sheet where nothing was folded."""
    by_sheet = defaultdict(list)
    for job, one in folds.items():
        by_sheet[job.path, job.sheet].append(one)
    cells: list[tuple[str, ...]] = [_HEADER]
    blank = [""] * (len(_HEADER) - 5)
    for reading in readings:
        name = Path(reading.path).name
        if reading.status != "read":
            cells.append((name, "", "", f"{reading.seconds:.2f}", str(len(reading.notes)), "", reading.status,
                          reading.sentence, *blank[3:]))  # fmt: skip
        for number, sheet in enumerate(reading.sheets, 1):
            label = f"{name} {number}" if len(reading.sheets) > 1 else name
            letters = " ".join(f"{count} {letter}" for letter, count in sorted(sheet.letters.items()))
            first = (label, str(sheet.creases), letters, f"{reading.seconds:.2f}", str(len(sheet.notes)))
            folded = by_sheet[reading.path, number]
            cells += [(*(first if k == 0 else [""] * 5), *_folded(one)) for k, one in enumerate(folded)]
            if not folded:
                cells.append((*first, *blank))
    return _aligned(cells)


def _folded(one: Fold) -> tuple[str, ...]:
    if not one.fold_angle:
        return (one.job.way, one.status, one.sentence, "", "", "", "", f"{one.seconds:.1f}")
    return (
        one.job.way,
        one.status,
        " / ".join(f"{angle:.0f}°" for angle in one.fold_angle),
        f"{one.stretch_mean:.1e} / {one.stretch_max:.1e}",
        f"{one.ripples:.2f}",
        str(one.resolution),
        str(one.iterations),
        f"{one.seconds:.1f}",
    )


def _aligned(cells: Sequence[tuple[str, ...]]) -> list[str]:
    # A sentence instead of figures makes no column wide.
    widths = [max(len(row[k]) for row in cells if len(row[k]) <= 40) for k in range(len(cells[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]


def summary(readings: Sequence[Reading], folds: dict[FoldJob, Fold]) -> list[str]:
    """How many were read and folded, and the reasons why others were not."""
    count = Counter(one.status for one in readings)
    lines = [f"{count['read']} of {len(readings)} read, {count['refused']} refused, {count['crash']} crashes, "
             f"{count['hang']} hangs"]  # fmt: skip
    lines += _reasons(
        "refused", [(one.sentence, Path(one.path).name) for one in readings if one.status == "refused"]
    )
    for way in WAYS if folds else ():
        mine = [one for job, one in folds.items() if job.way == way]
        told = ", ".join(f"{n} {status}" for status, n in Counter(one.status for one in mine).most_common())
        lines.append(f"folded by {way}: {sum(one.ok for one in mine)} of {len(mine)} sheets ({told})")
        angles = np.array([one.fold_angle for one in mine if one.fold_angle])
        if len(angles):
            tenth, middle = np.median(angles[:, 0]), np.median(angles[:, 1])
            lines.append(
                f"    median sheet: {middle:.0f}° in the median, {tenth:.0f}° at the lowest tenth; "
                f"{np.mean(angles[:, 1] < SHALLOW):.0%} of the sheets below {SHALLOW:.0f}°; "
                f"largest edge {max(one.stretch_max for one in mine):.1%}"
            )
    crashes = [(one.sentence, Path(one.path).name) for one in readings if one.status in ("crash", "hang")]
    crashes += [
        (one.sentence, Path(job.path).name) for job, one in folds.items() if one.status in ("crash", "hang")
    ]
    return lines + _reasons("CRASH OR HANG", crashes)


def _reasons(what: str, told: Sequence[tuple[str, str]]) -> list[str]:
    """One line a reason, the most frequent first, with the names of the drawings."""
    names = defaultdict(list)
    for sentence, name in told:
        names[sentence[:_REASON]].append(name)
    ordered = sorted(names.items(), key=lambda item: -len(item[1]))
    return [f"  {what}, {len(some)}: {reason} ({', '.join(some)})" for reason, some in ordered]


# --- strangers and large drawings -----------------------------------------------------------------------


def strangers(count: int, jobs: int, time_limit: float) -> tuple[list[StrangerRun], list[str]]:
    """The first files of the generator, read; and a table by program, with the faults of every file above it."""
    runs: list[StrangerRun] = []
    with tempfile.TemporaryDirectory() as folder:
        work = partial(read_stranger, folder=folder)
        for ended in each_alone(range(count), work, jobs, time_limit):
            told = (ended.sentence,)
            runs.append(ended.result or StrangerRun(ended.job, "a process", ended.sentence, told, crash=True))
    runs.sort(key=lambda run: run.number)
    lines = [f"{run.number}  {run.words}: {'; '.join(run.faults)}" for run in runs if run.faults]
    names = list(dict.fromkeys(run.exporter for run in runs))
    cells = [("program", "files", "as meant")]
    for name in names:
        mine = [run for run in runs if run.exporter == name]
        cells.append((name, str(len(mine)), str(sum(not run.faults for run in mine))))
    good = sum(not run.faults for run in runs)
    crashes = sum(run.crash for run in runs)
    lines += ["", *_aligned(cells), ""]
    lines.append(f"{good} of {len(runs)} read as meant ({good / len(runs):.1%}; bar {BAR:.0%}), {crashes} crashes")
    return runs, lines


def large(time_limit: float) -> list[str]:
    """Seconds and memory of reading drawings of thousands of strokes, one after the other."""
    cells = [("made of", "strokes", "kB", "outcome", "seconds", "bar", "memory / size", "bar")]
    with tempfile.TemporaryDirectory() as folder:
        for name, (suffix, make) in LARGE.items():
            for count, bar in LARGE_BARS.items():
                path = Path(folder) / f"{make.__name__}_{count}{suffix}"
                path.write_text(make(count), encoding="utf-8")
                one = read_all([path], 1, time_limit, read_warm)[0]
                outcome = f"{one.sheets[0].creases} creases" if one.sheets else f"{one.status}: {one.sentence}"
                times = one.memory / path.stat().st_size
                cells.append((name, f"{count:,}", f"{path.stat().st_size / 1e3:.0f}", outcome, f"{one.seconds:.2f}",
                              f"{bar:g}", f"{times:.0f}", str(MEMORY_BAR)))  # fmt: skip
    return _aligned(cells)


# --- the command ----------------------------------------------------------------------------------------


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.drawings", description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path, metavar="PATH", help="drawings, and folders of drawings")
    parser.add_argument("--folder", action="append", type=Path, metavar="FOLDER", default=[],
                        help="a folder with cases/ and patterns/ in it, beside the usual one")  # fmt: skip
    parser.add_argument("--read-only", action="store_true", help="read without folding")
    parser.add_argument("--notes", action="store_true", help="print what was noted about every drawing")
    parser.add_argument("--resolution", type=int, help="quads along the longer side (default: as usual)")
    parser.add_argument("--jobs", type=int, default=2, help="processes (default %(default)s)")
    parser.add_argument("--time-limit", type=float, default=TIME_LIMIT, metavar="SECONDS",
                        help="for one reading or fold (default %(default)g)")  # fmt: skip
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all that was found")
    parser.add_argument("--strangers", type=int, metavar="N", help="the first N files of the generator instead")
    parser.add_argument("--large", action="store_true", help="drawings of thousands of strokes instead")
    args = parser.parse_args()
    if args.large:
        print(*large(args.time_limit), sep="\n")
        return 0
    if args.strangers is not None:
        runs, lines = strangers(args.strangers, args.jobs, args.time_limit)
        print(*lines, sep="\n")
        _write(args.json, {"strangers": [asdict(run) for run in runs]})
        return 0 if sum(not run.faults for run in runs) >= BAR * len(runs) else 1
    try:
        files = found(args.paths or usual_folders([ROOT.parent / "shared", *args.folder]))
    except FileNotFoundError as error:
        print(f"{error}: there is no such file or folder", file=sys.stderr)
        return 2
    readings = read_all(files, args.jobs, args.time_limit)
    folds = {} if args.read_only else fold_all(readings, args.resolution, args.jobs, args.time_limit)
    print(*rows(readings, folds), "", *summary(readings, folds), sep="\n")
    if args.notes:
        print(*_notes(readings), sep="\n")
    _write(args.json, {"readings": [asdict(one) for one in readings], "folds": [asdict(f) for f in folds.values()]})
    crashed = any(one.status in ("crash", "hang") for one in (*readings, *folds.values()))
    return 1 if crashed else 0


def _notes(readings: Sequence[Reading]) -> list[str]:
    lines = []
    for one in readings:
        lines += ["", Path(one.path).name, *(f"  {note}" for note in one.notes)]
        lines += [f"  {sheet.name}: {note}" for sheet in one.sheets for note in sheet.notes]
    return lines


def _write(path: Path | None, data: dict[str, object]) -> None:
    if path is not None:
        path.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    raise SystemExit(main())
