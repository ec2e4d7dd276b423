"""The same drawings folded by the command line in several Blender versions, and how far their shapes differ.

    python -m benchmarks.blender_versions [--versions 4.2.23 5.0.1 5.2.3] [--samples NAME …] [--resolution N]

Each version is the module that ``scripts/setup.sh bpy VERSION`` makes. Every drawing is folded in each with one and
with two threads of the linear algebra; those two must agree to the last bit, the versions as far as is said.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
SAMPLES = ROOT / "sample_patterns"
VERSIONS = ("4.2.23", "5.0.1", "5.2.3")
THREADS = (1, 2)
#: Exit codes of the command line with a shape: all that was asked is reached, or not all of it.
WITH_A_SHAPE = (0, 1)


def main(argv: list[str] | None = None) -> int:
    arguments = _arguments(argv)
    pythons = {version: _python(version) for version in arguments.versions}
    print(f"| drawing | {' | '.join(f'{version}, threads alike' for version in pythons)} | largest difference |")
    print("| --- " * (len(pythons) + 2) + "|")
    worst = 0.0
    for name in arguments.samples:
        shapes, alike = [], []
        for python in pythons.values():
            one, two = (_fold(python, name, arguments.resolution, threads) for threads in THREADS)
            shapes.append(one)
            alike.append("yes" if np.array_equal(one, two) else "NO")
        apart = _apart(shapes)
        worst = max(worst, apart)
        print(f"| {name} | {' | '.join(alike)} | {apart:.1e} |", flush=True)
    print(f"\nLargest difference of a coordinate, relative to the longest side of the folded sheet: {worst:.1e}")
    return 0


def _arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="One drawing, several Blender versions, one shape?")
    parser.add_argument("--versions", nargs="+", default=VERSIONS, metavar="VERSION")
    every = sorted(path.stem for path in SAMPLES.glob("*.svg"))
    parser.add_argument("--samples", nargs="+", default=every, choices=every, metavar="NAME")
    parser.add_argument("--resolution", type=int, default=24)
    return parser.parse_args(argv)


def _python(version: str) -> str:
    made = subprocess.run(
        [str(ROOT / "scripts" / "setup.sh"), "bpy", version], check=True, stdout=subprocess.PIPE, text=True
    )
    return made.stdout.strip()


def _fold(python: str, name: str, resolution: int, threads: int) -> NDArray[np.float64]:
    """(V,3) vertices of the folded sheet. Raises RuntimeError when there is none."""
    with tempfile.TemporaryDirectory(prefix="curvefold-versions-") as folder:
        drawing = SAMPLES / f"{name}.svg"
        options = ["--out", folder, "--resolution", str(resolution)]
        done = subprocess.run(
            [python, "-m", "curvefold_addon", "fold", str(drawing), *options],
            cwd=ROOT,
            env={**os.environ, "OPENBLAS_NUM_THREADS": str(threads)},
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode not in WITH_A_SHAPE:
            raise RuntimeError(f"{name} in {python}: {done.stderr.strip()}")
        folded = json.loads((Path(folder) / "folded.fold").read_text(encoding="utf-8"))
        return np.array(folded["vertices_coords"], dtype=np.float64)


def _apart(shapes: list[NDArray[np.float64]]) -> float:
    """The largest difference of a coordinate between any two, relative to the longest side; infinite when they
    have not the same vertices."""
    if len({shape.shape for shape in shapes}) > 1:
        return float("inf")
    stack = np.array(shapes)
    return float(np.ptp(stack, axis=0).max() / np.ptp(stack[0], axis=0).max())


if __name__ == "__main__":
    sys.exit(main())
