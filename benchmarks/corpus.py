"""Folds random drawings by random drags, and says what failed and with which seed.

Run it: python -m benchmarks.corpus [--count N] [--seed S] [--jobs J] [--json FILE]
        python -m benchmarks.corpus --drawings FOLDER [--jobs J] [--json FILE]
One run is one process with a limit of time: a crash or a hang is a line in the table and not the end of it.
With --drawings, every SVG file of a folder is dragged by the protocol instead: longest side 33 vertices, the two
lower corners moved over 18 frames, 6 frames at rest, 5 iterations each; and judged as it then is.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from benchmarks.corpus_drawings import FAMILIES
from benchmarks.corpus_run import FLAT_AGAIN, Job, Run, do
from benchmarks.processes import each_alone
from solver.fold import MAX_MEAN_STRETCH

#: Seconds after which a run counts as hung.
TIME_LIMIT = 300.0

# --- processes ------------------------------------------------------------------------------------------


def do_all(jobs: Sequence[Job], processes: int) -> Iterator[Run]:
    """Every job in a process of its own, ``processes`` at a time; runs come in the order they end."""
    for ended in each_alone(jobs, do, processes, TIME_LIMIT):
        job, run = ended.job, ended.result
        if run is None:
            run = Run(job.seed, sentence=ended.sentence, drawing=job.drawing)
            if ended.hung:
                run.status, run.seconds = "hang", TIME_LIMIT
        if not run.family:
            run.family = Path(job.drawing).stem if job.drawing else list(FAMILIES)[job.seed % len(FAMILIES)]
        yield run


# --- what is printed ------------------------------------------------------------------------------------

_HEADER = ("family", "runs", "feasible", "reached+folded", "whole", "folded %", "angle 10/50/90", "mean stretch",
           "largest edge", "ripples sr", "gap max", "DOG angle", "iterations", "seconds", "MB")  # fmt: skip


def table(runs: Sequence[Run]) -> list[str]:
    """One line a family, medians over its feasible runs, and one for all."""
    families = sorted({run.family for run in runs})
    rows = [_HEADER, *(_row(name, [r for r in runs if r.family == name]) for name in families)]
    if len(families) > 1:
        rows.append(_row("all", runs))
    widths = [max(len(row[k]) for row in rows) for k in range(len(_HEADER))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _row(name: str, runs: Sequence[Run]) -> tuple[str, ...]:
    there = [r for r in runs if r.feasible]
    if not there:
        return (name, str(len(runs)), "0", *[""] * (len(_HEADER) - 3))

    def middle(key: str) -> float:
        return float(np.median([getattr(r, key) for r in there]))

    angles = np.median([r.fold_angle for r in there], axis=0)
    good = sum(r.reached and r.folded == 1.0 for r in there)
    return (
        name, str(len(runs)), str(len(there)), f"{good} ({good / len(there):.1%})", str(sum(r.ok for r in there)),
        f"{np.mean([r.folded for r in there]):.2%}", " / ".join(f"{angle:.0f}°" for angle in angles),
        f"{middle('stretch_mean'):.1e}", f"{max(r.stretch_max for r in there):.1%}", f"{middle('ripples'):.2f}",
        f"{middle('continuity'):.1e}", f"{middle('dog_angle'):.0e}",
        f"{middle('iterations'):.0f}", f"{middle('seconds'):.1f}", f"{max(r.memory_mb for r in there):.0f}",
    )  # fmt: skip


def summary(runs: Sequence[Run]) -> list[str]:
    """The figures of docs/reliability.md."""
    count = Counter(run.status for run in runs)
    there = [r for r in runs if r.feasible]
    back = [r for r in runs if r.off_flat is not None]
    far = [r for r in runs if not r.feasible]
    good = [r for r in there if r.reached and r.folded == 1.0]
    calm = [r for r in good if r.stretch_mean < MAX_MEAN_STRETCH]
    whole = [r for r in runs if r.stretch_mean < MAX_MEAN_STRETCH]
    lines = [f"{len(runs)} runs: {count['crash']} crashes, {count['hang']} hangs, "
             f"{count['not finite']} not finite, {count['refused']} refused"]  # fmt: skip
    for name, some, all_ in (
        ("feasible: reached with every crease point folded", good, there),
        ("of these: mean stretch below 0.003", calm, good),
        ("of these: certified by solver.verify", [r for r in calm if r.certified], calm),
        ("there and back: flat again", [r for r in back if (r.off_flat or 0.0) < FLAT_AGAIN], back),
        ("of all runs, whatever was asked: mean stretch below 0.003", whole, runs),
        ("too far: said to be out of reach", [r for r in far if r.ok], far),
    ):
        if all_:
            lines.append(f"{name}: {len(some)} of {len(all_)} ({len(some) / len(all_):.1%})")
    return lines


def _failure(run: Run) -> str:
    why = f"{run.sentence} ({run.reason})" if run.reason else run.sentence
    return (
        f"seed {run.seed}  {run.family}, {run.drag}: {run.status}; folded {run.folded:.2%}, handle "
        f"{run.handle_error:.2f}, stretch {run.stretch_mean:.1e}, {run.iterations} iterations; {why}"
    )


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.corpus", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000, help="runs (default %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the first run; run k has seed + k")
    parser.add_argument("--only", type=int, nargs="+", metavar="SEED", help="these seeds instead")
    parser.add_argument("--jobs", type=int, default=2, help="processes (default %(default)s)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every run")
    parser.add_argument(
        "--drawings", type=Path, metavar="FOLDER", help="the protocol over the SVG files of a folder"
    )
    args = parser.parse_args()
    if args.drawings is not None:
        files = sorted(args.drawings.glob("*.svg"))
        if not files:
            print(f"{args.drawings}: no SVG files in it", file=sys.stderr)
            return 2
        jobs = [Job(k, str(path)) for k, path in enumerate(files)]
    else:
        jobs = [Job(seed) for seed in args.only or range(args.seed, args.seed + args.count)]
    runs: list[Run] = []
    try:
        for run in do_all(jobs, args.jobs):
            runs.append(run)
            if not run.ok:
                print(_failure(run), flush=True)
    except KeyboardInterrupt:
        print(f"stopped after {len(runs)} of {len(jobs)} runs", flush=True)
        if not runs:
            return 1
    runs.sort(key=lambda run: run.seed)
    print(*table(runs), "", *summary(runs), sep="\n")
    if args.json is not None:
        args.json.write_text(json.dumps({"runs": [asdict(run) for run in runs]}, indent=1) + "\n", encoding="utf-8")
    return 0 if all(run.ok for run in runs) else 1


if __name__ == "__main__":
    raise SystemExit(main())
