"""Milliseconds per SQP iteration, by part, at several sizes: ``python -m benchmarks.speed``.

A square sheet with three arcs folds by the angle drive, twice in turns: with the compiled kernel and with numpy and
scipy. Every iteration is timed. The medians of the former are shown by part, then how many times as long the latter
took, and scipy's splu on the same matrices. Nothing is asserted: the figures are for reading.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault(
    "OPENBLAS_NUM_THREADS", "1"
)  # before numpy: assembly is memory-bound, factors thread themselves

import numpy as np

from benchmarks.linear_system import computing, time_splu
from benchmarks.marked import write_between
from solver import Crease, CreasePattern, FoldModel, PiecewiseDog, build_net
from solver.optimize.kernel import linear_algebra

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


@dataclass(frozen=True)
class Measured:
    """Median ms of an iteration by part, as used here and with numpy and scipy; splu's ms on the last matrix."""

    vertices: int
    used: dict[str, float]
    numpy: dict[str, float]
    splu: float

    def ratio(self, part: str) -> float:
        """How many times as long a part takes with numpy and scipy."""
        return self.numpy[part] / self.used[part]


def _folding(net: PiecewiseDog, *, with_kernel: bool) -> FoldModel:
    """A fold on its way; what it computes with is settled here."""
    with computing(with_kernel=with_kernel):
        model = FoldModel(net)
        model.set_fold_angle(60.0)
        model.advance(3)
    return model


def _medians(rows: list[dict[str, float]]) -> dict[str, float]:
    return {p: 1e3 / PER_FRAME * float(np.median([row.get(p, 0.0) for row in rows])) for p in PARTS}


def measure_size(resolution: int, frames: int) -> Measured:
    """Both ways in turns, so that a busy machine is so to both."""
    net = build_net(arcs(), resolution)
    models = [_folding(net, with_kernel=with_kernel) for with_kernel in (True, False)]
    rows: list[list[dict[str, float]]] = [[], []]
    for _ in range(frames):
        for model, times, with_kernel in zip(models, rows, (True, False), strict=True):
            with computing(with_kernel=with_kernel):
                times.append(model.advance(PER_FRAME).seconds)
    problem = models[0].problem
    values = problem.linearize(net.frame.to_net(models[0].positions), 1e3, 1e-3).values
    right = np.random.default_rng(0).standard_normal(3 * len(net.rest))
    splu = 1e3 * time_splu(problem.rows, problem.columns, values, right)
    return Measured(len(net.rest), _medians(rows[0]), _medians(rows[1]), splu)


def markdown(rows: list[Measured]) -> str:
    """The table for the README."""
    heads = ["vertices", *PARTS, "total with numpy and scipy", "splu instead of factor and solve"]
    lines = ["| " + " | ".join(heads) + " |", "| " + " | ".join(["--:"] * len(heads)) + " |"]
    for row in rows:
        cells = [f"{row.vertices:,}", *(f"{row.used[part]:.1f}" for part in PARTS)]
        cells += [f"{row.numpy['total']:.1f} ({row.ratio('total'):.2f} times)", f"{row.splu:.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=12, help="calls of five iterations (default 12)")
    parser.add_argument("--write", action="store_true", help="put the table into README.md")
    args = parser.parse_args()
    with computing(with_kernel=True):
        print(linear_algebra().phrase)
    print(f"{'vertices':>9}" + "".join(f"{part:>13}" for part in PARTS) + f"{'splu instead':>14}   (ms, medians)")
    rows = []
    for resolution in RESOLUTIONS:
        row = measure_size(resolution, args.frames)
        rows.append(row)
        print(f"{row.vertices:9d}" + "".join(f"{row.used[part]:13.2f}" for part in PARTS) + f"{row.splu:14.1f}")
        ratios = "".join(f"{row.ratio(part):12.2f}x" for part in PARTS)
        print(f"{'numpy':>9}{ratios}", flush=True)
    if args.write:
        write_between(Path(__file__).resolve().parents[1] / "README.md", "speed", markdown(rows))


if __name__ == "__main__":
    main()
