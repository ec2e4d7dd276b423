"""One run of the corpus: a drawing dragged, and what came of it."""

from __future__ import annotations

import resource
import time
import traceback
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import solver
from benchmarks.corpus_drags import FRAME_ITERATIONS, Drag, make_drag, protocol_drag
from benchmarks.corpus_drawings import Drawing, make_drawing
from solver.arrays import FloatArray
from solver.fold import MAX_MEAN_STRETCH, Rest, come_to_rest, fold_angle_quantiles, judge
from solver.folding import REACHED

#: SQP iterations after which a run that has not settled ends.
MOST_ITERATIONS = 1500
#: The protocol: quads along the longer side, and frames at rest at the end.
PROTOCOL_RESOLUTION, PROTOCOL_REST = 32, 6
#: A drag that fails is tried with so many times the quads to a side, to tell a net that is too coarse for it.
FINER = (1.5, 2.0, 3.0)
#: A sheet that went back is flat within this part of its longer side.
FLAT_AGAIN = 1e-3


@dataclass(frozen=True)
class Job:
    """One run: a seed of the corpus, or a drawing's file by the protocol."""

    seed: int
    drawing: str | None = None


@dataclass
class Run:
    """What one run gave. Lengths in mean grid edges, angles in degrees, fold_angle 10 %, median and 90 %.

    A drag there and back comes to rest there too, and that rest is what the figures are about; off_flat says how
    far from flat it then was at the end, part of the longer side.
    ok: a feasible drag reached with every crease point folded, the paper whole, and flat again if it went back;
    one too far said to be out of reach. reason: of a feasible one that is not ok, from nets with more quads.
    """

    seed: int
    family: str = ""
    drag: str = ""
    feasible: bool = True
    status: str = "crash"
    reached: bool = False
    folded: float = 0.0
    fold_angle: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    stretch_mean: float = 0.0
    stretch_max: float = 0.0
    ripples: float = 0.0  # solver.gauss_area, steradians
    continuity: float = 0.0
    dog_angle: float = 0.0
    handle_error: float = 0.0
    iterations: int = 0
    seconds: float = 0.0
    memory_mb: float = 0.0
    vertices: int = 0
    off_flat: float | None = None
    certified: bool = False
    sentence: str = ""
    reason: str = ""
    drawing: str | None = None
    ok: bool = False


def do(job: Job) -> Run:
    """Do one job. What the project refuses is a status; anything else that is raised is a crash."""
    run = Run(job.seed, drawing=job.drawing)
    begin = time.perf_counter()
    try:
        if job.drawing is None:
            drawing = make_drawing(job.seed)
            run.family = drawing.family
            net = solver.build_net(drawing.pattern, drawing.resolution)
            drag = make_drag(job.seed, drawing, net)
            drag_net(run, net, drag)
            if drag.feasible and not run.ok and run.status != "not flat again":
                run.reason = _reason(drawing, drag)
        else:
            run.family = Path(job.drawing).stem
            pattern = solver.read_pattern(job.drawing)
            net = solver.build_net(pattern, PROTOCOL_RESOLUTION)
            drag_net(run, net, protocol_drag(pattern))
    except solver.CurvefoldError as error:
        run.status, run.sentence = "refused", str(error)
    except Exception as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        run.status = "crash"
        run.sentence = f"{type(error).__name__}: {error} ({Path(last.filename).name}:{last.lineno})"
    run.seconds = time.perf_counter() - begin
    run.memory_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return run


def drag_net(run: Run, net: solver.PiecewiseDog, drag: Drag) -> None:
    run.drag = f"{drag.kind}{' at once' if drag.frames == 1 else ''}"
    run.feasible = drag.feasible
    run.vertices = len(net.rest)
    model = solver.FoldModel(net)
    there = [(k + 1) / drag.frames for k in range(drag.frames)]
    if drag.kind == "protocol":
        there += [1.0] * PROTOCOL_REST
    report = _follow(run, model, drag, there)
    description = _description(drag, there[-1])
    settles = drag.kind != "protocol"
    rest = come_to_rest(model, description) if settles else judge(model, description, report, 0)
    run.iterations += rest.iterations
    _look(run, net, rest)
    whole = run.reached and run.folded == 1.0 and run.stretch_mean < MAX_MEAN_STRETCH
    if drag.kind == "protocol":
        run.ok = run.reached and run.folded == 1.0
        run.status = "folded" if run.ok else run.status
        return
    run.ok = whole and rest.status.ok if drag.feasible else rest.status is solver.Outcome.OUT_OF_REACH
    if drag.back:
        _follow(run, model, drag, [*there[-2::-1], 0.0])
        back = come_to_rest(model, _description(drag, 0.0))
        run.iterations += back.iterations
        run.off_flat = _off_flat(net, back.positions)
        if run.off_flat >= FLAT_AGAIN:
            run.ok, run.status = False, "not flat again"
            run.sentence = f"{run.off_flat:.1e} of the longer side off flat after there and back"


def _follow(run: Run, model: solver.FoldModel, drag: Drag, way: list[float]) -> solver.SqpReport:
    for part in way:
        model.set_handles(drag.handles(part))
        report = model.advance(FRAME_ITERATIONS)
        run.iterations += report.iterations
    return report


def _description(drag: Drag, part: float) -> solver.FoldDescription:
    return solver.FoldDescription(angle=None, handles=tuple(drag.handles(part)), max_iterations=MOST_ITERATIONS)


def _look(run: Run, net: solver.PiecewiseDog, rest: Rest) -> None:
    report, m = rest.last, rest.measurement
    run.sentence = rest.detail
    run.status = rest.status.name.lower().replace("_", " ")
    run.reached = bool(report.handle_error <= REACHED * net.frame.unit)
    run.folded = m.folded_part
    run.fold_angle = [round(angle, 3) for angle in fold_angle_quantiles(m)]
    run.stretch_mean, run.stretch_max = float(m.stretch.mean()), float(m.stretch.max())
    run.ripples = solver.gauss_area(net, rest.positions)
    run.continuity = float(m.continuity.max(initial=0.0))
    run.dog_angle = float(m.dog_angle.max(initial=0.0))
    run.handle_error = float(report.handle_error / net.frame.unit)
    run.certified = solver.verify(net, rest.positions).ok


def _reason(drawing: Drawing, drag: Drag) -> str:
    """Whether the same drag at once does what was asked in a net with more quads."""
    description = _description(drag, 1.0)
    for times in FINER:
        net = solver.build_net(drawing.pattern, round(times * drawing.resolution))
        model = solver.FoldModel(net)
        model.set_handles(description.handles)
        if come_to_rest(model, description).status.ok:
            return f"the net is too coarse: {times:g} times as many quads to a side do it"
    return f"{FINER[-1]:g} times as many quads to a side do not do it either"


def _off_flat(net: solver.PiecewiseDog, x: FloatArray) -> float:
    """Largest distance of a vertex from the flat sheet laid on it as well as it goes, part of the longer side."""
    flat = np.column_stack([net.rest, np.zeros(len(net.rest))])
    a, b = x - x.mean(axis=0), flat - flat.mean(axis=0)
    u, _, vt = np.linalg.svd(a.T @ b)
    u[:, 2] *= np.sign(np.linalg.det(u @ vt))
    size = float(np.ptp(net.rest, axis=0).max())
    return float(np.linalg.norm(a @ u @ vt - b, axis=1).max()) / size
