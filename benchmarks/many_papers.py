"""Ten papers that fold together: ``PYTHON -m benchmarks.many_papers`` in bpy.

    "$(scripts/setup.sh bpy 5.0.1)" -m benchmarks.many_papers [--papers 10] [--resolution 26] [--redraws 0.02 0.4]

Each paper's slider is set to 70 %, and ticks come until all rest, with a pause between them as for drawing: a quick
one, and one of a view that is drawn slowly. Shown is how long ticks took, when the active paper and when all of
them rested, and which part of that time the solver worked. Figures for reading; nothing is asserted.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from curvefold_addon import checkout

ROOT = Path(__file__).absolute().parents[1]
SAMPLE = "two_parallel_arcs"
#: Per cent of the whole angle that all papers are folded to.
FOLD = 70.0
#: What a tick may take at most, seconds.
LONGEST = 0.04
#: Seconds after which papers that do not rest are left alone.
PATIENCE = 120.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--papers", type=int, default=10)
    parser.add_argument("--resolution", type=int, default=26, help="about 900 vertices")
    parser.add_argument("--redraws", type=float, nargs="+", default=[0.02, 0.4], help="seconds between two ticks")
    arguments = parser.parse_args()
    print(
        "| papers | vertices | redraw | ticks: median | 99 % | longest | its processor time | over 40 ms |", end=""
    )
    print(" active rests (s) | all rest (s) | all moved (s) | thread worked |  (redraw in s, ticks in ms)")
    print("| --: " * 12 + "|")
    for pause in arguments.redraws:
        print(run(arguments.papers, arguments.resolution, pause), flush=True)


def run(count: int, resolution: int, pause: float) -> str:
    """One row of the table."""
    import bpy

    live = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.live")
    follow = importlib.import_module(f"{checkout.PACKAGE}.curvefold_addon.operators.follow")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    papers = []
    for number in range(count):
        bpy.ops.object.select_all(action="DESELECT")
        bpy.context.view_layer.objects.active = None
        bpy.ops.curvefold.add_sample(sample=SAMPLE)
        bpy.ops.curvefold.make_paper(resolution=resolution)
        papers.append(bpy.context.object)
        papers[-1].location.x = 0.3 * number
    active = bpy.context.object
    sessions = {paper.name: live.make_session(paper) for paper in papers}
    for paper in papers:
        paper.data.curvefold.fold = FOLD
    bpy.context.view_layer.update()

    manager = SimpleNamespace(
        windows=[SimpleNamespace(modal_operators=[])],
        event_timer_add=lambda step, window: step,
        event_timer_remove=lambda timer: None,
        modal_handler_add=lambda operator: None,
    )
    context = SimpleNamespace(window_manager=manager, window=None)
    operator = SimpleNamespace(_ended=0.0, cancel=lambda context: follow.stop(manager))
    follow.Follow.invoke(operator, context, None)
    event = SimpleNamespace(type="TIMER")
    ticks: list[float] = []
    own: list[float] = []  # processor time
    moved: dict[str, float] = {}
    rested: dict[str, float] = {}
    begin, worked = time.perf_counter(), _thread_seconds()
    while live.is_at_work() and time.perf_counter() - begin < PATIENCE:
        start, mine = time.perf_counter(), time.thread_time()
        follow.Follow.modal(operator, context, event)
        end = time.perf_counter()
        ticks.append(end - start)
        own.append(time.thread_time() - mine)
        for name, found in sessions.items():
            if found.iterations:
                moved.setdefault(name, end - begin)
            if found.rest is not None and found.inputs is not None and found.inputs.angle:
                rested.setdefault(name, end - begin)
        bpy.context.view_layer.update()  # as Blender does before it draws
        time.sleep(pause)
    whole = time.perf_counter() - begin
    follow.stop(manager)
    share = (_thread_seconds() - worked) / whole
    vertices = len(sessions[active.name].net.rest)
    times = 1e3 * np.array(ticks)
    figures = [np.median(times), np.quantile(times, 0.99), times.max(), 1e3 * max(own)]
    row: list[Any] = [count, f"{vertices:,}", pause, *(f"{figure:.1f}" for figure in figures)]
    row += [int(np.count_nonzero(times > 1e3 * LONGEST)), f"{rested.get(active.name, np.inf):.1f}"]
    row += [f"{max(rested.values()) if len(rested) == count else np.inf:.1f}", f"{max(moved.values()):.1f}"]
    return "| " + " | ".join(map(str, [*row, f"{100.0 * share:.0f} %"])) + " |"


def _thread_seconds() -> float:
    """Processor time of all threads but this one."""
    return time.process_time() - time.thread_time()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="curvefold-many-", ignore_cleanup_errors=True) as folder:
        checkout.link(ROOT, Path(folder))
        checkout.enable(Path(folder))
        main()
    sys.stdout.flush()
    # Blender's own clean-up at exit may crash or hang.
    os._exit(0)
