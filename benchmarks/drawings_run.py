"""How one drawing is read, and how one of its sheets folds: each is done in a process of its own."""

from __future__ import annotations

import re
import time
import traceback
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

import shapely

import solver
from benchmarks.corpus_drags import protocol_drag
from benchmarks.corpus_run import PROTOCOL_RESOLUTION, Run, drag_net
from benchmarks.large_drawings import LARGE
from solver.fold import fold_angle_quantiles
from tests.solver.pattern.strangers import stranger

#: What the drive asks of every crease, degrees.
ANGLE = 60.0
#: The two ways in which every sheet is folded: by the angle drive, and by the protocol's two corners.
WAYS = ("angle", "corners")


@dataclass(frozen=True)
class Sheet:
    """A sheet as it was read. area, size: drawing units; letters: creases by FOLD letter."""

    name: str
    size: tuple[float, float]
    area: float
    holes: int
    creases: int
    letters: dict[str, int]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class Reading:
    """What came of reading a file. status: "read", "refused" or "crash"; sentence: why it was not read.

    seconds: of reading alone; size, memory: bytes of the file, and by how many its peak of memory grew
    """

    path: str
    status: str
    sentence: str = ""
    sheets: tuple[Sheet, ...] = ()
    notes: tuple[str, ...] = ()
    seconds: float = 0.0
    size: int = 0
    memory: int = 0


@dataclass(frozen=True)
class FoldJob:
    """A sheet of a file, from 1, to be folded in one of WAYS. resolution: None for the default."""

    path: str
    sheet: int
    way: str
    resolution: int | None


@dataclass(frozen=True)
class Fold:
    """What came of folding a sheet. status: an outcome's name, "refused", "crash" or "hang"; angles in degrees.

    ok: folded as asked; fold_angle: 10 %, median and 90 %; stretch: relative
    ripples: what the Gauss image covers, steradians (``solver.gauss_area``): smooth paper has none
    resolution: quads along the longer side
    """

    job: FoldJob
    status: str
    ok: bool = False
    sentence: str = ""
    folded: float = 0.0
    fold_angle: tuple[float, ...] = ()
    stretch_mean: float = 0.0
    stretch_max: float = 0.0
    ripples: float = 0.0
    iterations: int = 0
    seconds: float = 0.0
    resolution: int | None = None
    notes: tuple[str, ...] = field(default=())


def read(path: str) -> Reading:
    """Read all sheets of a file. What the project refuses is a status; anything else that is raised is a crash."""
    size, before, begin = Path(path).stat().st_size, _peak(), time.perf_counter()
    try:
        patterns = solver.read_patterns(path, solver.ReadOptions())
    except solver.CurvefoldError as error:
        result = Reading(path, "refused", error.message, notes=error.notes)
    except Exception as error:
        result = Reading(path, "crash", crash_sentence(error))
    else:
        result = Reading(path, "read", sheets=tuple(_sheet(pattern) for pattern in patterns))
    return replace(result, seconds=time.perf_counter() - begin, size=size, memory=_peak() - before)


def read_warm(path: str) -> Reading:
    """The same, after a small drawing of the same format: what a process needs once does not count."""
    first = Path(path).with_name(f"first{Path(path).suffix}")
    first.write_text(next(make for suffix, make in LARGE.values() if suffix == first.suffix)(40), encoding="utf-8")
    read(str(first))
    return read(path)


def _sheet(pattern: solver.CreasePattern) -> Sheet:
    low, high = pattern.boundary.min(axis=0), pattern.boundary.max(axis=0)
    return Sheet(
        pattern.name,
        (float(high[0] - low[0]), float(high[1] - low[1])),
        float(shapely.Polygon(pattern.boundary, pattern.holes).area),
        len(pattern.holes),
        len(pattern.creases),
        dict(Counter(crease.assignment for crease in pattern.creases)),
        pattern.notes,
    )


def fold(job: FoldJob) -> Fold:
    """Fold a sheet of a file that can be read."""
    begin = time.perf_counter()
    try:
        pattern = solver.read_patterns(job.path, solver.ReadOptions(sheet=job.sheet))[0]
        result = _by_angle(job, pattern) if job.way == "angle" else _by_corners(job, pattern)
    except solver.CurvefoldError as error:
        result = Fold(job, "refused", sentence=error.message, notes=error.notes)
    except Exception as error:
        result = Fold(job, "crash", sentence=crash_sentence(error))
    return replace(result, seconds=time.perf_counter() - begin)


def _by_angle(job: FoldJob, pattern: solver.CreasePattern) -> Fold:
    description = solver.FoldDescription(angle=ANGLE)
    if job.resolution is not None:
        description = replace(description, resolution=job.resolution)
    result = solver.fold(pattern, description)
    m = result.measurement
    return Fold(
        job,
        result.status.name.lower().replace("_", " "),
        result.status.ok,
        result.detail,
        m.folded_part,
        tuple(round(angle, 3) for angle in fold_angle_quantiles(m)),
        float(m.stretch.mean()),
        float(m.stretch.max()),
        solver.gauss_area(result.net, result.positions),
        result.iterations,
        resolution=result.net.resolution,
        notes=tuple(result.net.notes),
    )


def _by_corners(job: FoldJob, pattern: solver.CreasePattern) -> Fold:
    run = Run(seed=0)
    net = solver.build_net(pattern, job.resolution or PROTOCOL_RESOLUTION)
    drag_net(run, net, protocol_drag(pattern))
    return Fold(
        job, run.status, run.ok, run.sentence, run.folded, tuple(run.fold_angle), run.stretch_mean,
        run.stretch_max, run.ripples, run.iterations, resolution=net.resolution, notes=tuple(net.notes),
    )  # fmt: skip


# --- strangers ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class StrangerRun:
    """How a file of the generator was read. faults: against what its author meant; crash: what was raised."""

    number: int
    exporter: str
    words: str
    faults: tuple[str, ...]
    crash: bool = False


def read_stranger(number: int, folder: str) -> StrangerRun:
    """Write a file of the generator into a folder, read it and judge it."""
    made = stranger(number)
    path = made.write(Path(folder))
    crash = False
    try:
        faults = made.faults(solver.read_patterns(path))
    except solver.CurvefoldError as error:
        faults = made.faults(error)
    except Exception as error:
        crash, faults = True, [f"crash: {crash_sentence(error)}"]
    return StrangerRun(number, made.exporter, made.words(), tuple(faults), crash)


# --- what is measured -----------------------------------------------------------------------------------


def crash_sentence(error: Exception) -> str:
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({Path(last.filename).name}:{last.lineno})"


def _peak() -> int:
    """The most memory that this process has had, bytes; 0 where the system does not say."""
    status = Path("/proc/self/status")
    found = re.search(r"VmHWM:\s*(\d+) kB", status.read_text()) if status.exists() else None
    return 1024 * int(found.group(1)) if found else 0
