"""Milliseconds per SQP iteration, by part, at several sizes: ``python -m benchmarks.speed``.

A square sheet with three arcs folds by the angle drive; every iteration of the run is timed and the medians are
shown, beside scipy's splu on the same matrices. Nothing is asserted: the figures are for reading.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

os.environ.setdefault(
    "OPENBLAS_NUM_THREADS", "1"
)  # before numpy: assembly is memory-bound, factors thread themselves

import numpy as np

from benchmarks.linear_system import time_splu
from benchmarks.marked import write_between
from solver import Crease, CreasePattern, FoldModel, build_net

#: Resolution of the square sheet for about 500, 1,000, 2,000 and 4,000 vertices.
RESOLUTIONS = (18, 27, 40, 59)
#: Iterations in one call, as in the paper (section 7).
PER_FRAME = 5
PARTS = ("assembly", "factor", "solve", "line search", "total")


def arcs() -> CreasePattern:
    """A square of side 100 with three parallel arcs."""
    x = np.linspace(-5.0, 105.0, 200)
    rows = [Crease(np.column_stack([x, y + 12 * np.sin(np.pi * x / 100) - 6])) for y in (25.0, 50.0, 75.0)]
    return CreasePattern([(0, 0), (100, 0), (100, 100), (0, 100)], creases=rows)


def measure_size(resolution: int, frames: int) -> tuple[int, dict[str, float], float]:
    """Vertices, median ms an iteration by part, and splu's ms on the matrix of the last iteration."""
    net = build_net(arcs(), resolution)
    model = FoldModel(net)
    model.set_fold_angle(60.0)
    model.advance(3)
    rows = [model.advance(PER_FRAME).seconds for _ in range(frames)]
    medians = {p: 1e3 / PER_FRAME * float(np.median([row.get(p, 0.0) for row in rows])) for p in PARTS}
    problem = model.problem
    values = problem.linearize(net.frame.to_net(model.positions), 1e3, 1e-3).values
    right = np.random.default_rng(0).standard_normal(3 * len(net.rest))
    return len(net.rest), medians, 1e3 * time_splu(problem.rows, problem.columns, values, right)


def markdown(rows: list[tuple[int, dict[str, float], float]]) -> str:
    """The table for the README."""
    lines = ["| vertices | " + " | ".join(PARTS) + " | splu instead of factor and solve |"]
    lines.append("| " + " | ".join(["--:"] * (len(PARTS) + 2)) + " |")
    for count, medians, splu in rows:
        cells = [f"{count:,}", *(f"{medians[part]:.1f}" for part in PARTS), f"{splu:.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=12, help="calls of five iterations (default 12)")
    parser.add_argument("--write", action="store_true", help="put the table into README.md")
    args = parser.parse_args()
    print(f"{'vertices':>9}" + "".join(f"{part:>13}" for part in PARTS) + f"{'splu instead':>14}   (ms, medians)")
    rows = []
    for resolution in RESOLUTIONS:
        count, medians, splu = measure_size(resolution, args.frames)
        rows.append((count, medians, splu))
        print(f"{count:9d}" + "".join(f"{medians[part]:13.2f}" for part in PARTS) + f"{splu:14.1f}", flush=True)
    if args.write:
        write_between(Path(__file__).resolve().parents[1] / "README.md", "speed", markdown(rows))


if __name__ == "__main__":
    main()
