"""The same drawing, told the same, gives the same bits: again, in another process, with other threads.

And all but the same shape where numbers are rounded in another way, as in other versions of numpy, or without the
compiled kernel.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import solver
from benchmarks.linear_system import computing
from solver.description import read_handles
from solver.optimize.kernel import SWITCH
from solver.optimize.sqp import at_rest

ROOT = Path(__file__).resolve().parents[2]
FOLD = """
import hashlib, sys
import solver
pattern = solver.read_pattern(sys.argv[1])
result = solver.fold(pattern, solver.FoldDescription(resolution=20, angle=50.0))
print(hashlib.sha256(result.positions.tobytes()).hexdigest())
"""


def bits(drawing: Path, threads: int, hash_seed: int, switch: str) -> str:
    """Of the shape, folded in a process of its own."""
    environment = {"OPENBLAS_NUM_THREADS": str(threads), "PYTHONHASHSEED": str(hash_seed), SWITCH: switch}
    done = subprocess.run(
        [sys.executable, "-c", FOLD, str(drawing)],
        cwd=ROOT,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    assert len(done.stdout.strip()) == 2 * hashlib.sha256().digest_size
    return done.stdout


@pytest.mark.parametrize("name", ["hairpin", "mixed"])
@pytest.mark.parametrize(
    "switch", [pytest.param("1", id="kernel, if there"), pytest.param("0", id="numpy and scipy")]
)
def test_processes_threads_and_hashes_do_not_matter(name: str, switch: str) -> None:
    drawing = ROOT / "sample_patterns" / f"{name}.svg"
    assert bits(drawing, 1, 1, switch) == bits(drawing, 2, 2, switch)


@pytest.mark.usefixtures("kernel_library")
@pytest.mark.parametrize("name", ["mirrored_arcs", "mixed", "circle_in_square"])
def test_without_the_kernel_the_shape_is_the_same(name: str) -> None:
    """To a millionth of its size."""
    pattern = solver.read_pattern(ROOT / "sample_patterns" / f"{name}.svg")
    shapes = []
    for with_kernel in (True, False):
        with computing(with_kernel=with_kernel):
            shapes.append(solver.fold(pattern, solver.FoldDescription(resolution=24, angle=50.0)).positions)
    side = np.ptp(shapes[0], axis=0).max()
    assert np.abs(shapes[1] - shapes[0]).max() < 1e-6 * side
    assert not np.array_equal(*shapes), "or this test says nothing"


@pytest.mark.parametrize(
    ("name", "angle"),
    [
        ("mirrored_arcs", 50.0),  # symmetric: it has to give way to one of two sides
        ("crossing", None),  # peaks are shared out in sixteen rounds
        ("circle_in_square", None),  # comes to rest on a path that is all but unstable
    ],
)
def test_rounding_does_not_choose_the_shape(name: str, angle: float | None) -> None:
    """Of three folds one starts, and one is made exact, from where the others are but for the last digits."""
    drawing = ROOT / "sample_patterns" / f"{name}.svg"
    net = solver.build_net(solver.read_pattern(drawing), 24)
    shapes = []
    for at_start, at_end in ((0.0, 0.0), (1e-15, 0.0), (0.0, 1e-12)):
        model = solver.FoldModel(net)
        model.set_fold_angle(angle)
        if angle is None:
            model.set_handles(read_handles(drawing.with_suffix(".handles.json")))
        model.advance(1)
        jolt(model, at_start)
        while not model._still:
            model.advance(1)
        jolt(model, at_end)
        while model.status is solver.Status.RUNNING:
            model.advance(50)
        shapes.append(model._state.x)
    side = np.ptp(shapes[0], axis=0).max()
    for shape in shapes[1:]:
        assert np.abs(shape - shapes[0]).max() < 1e-6 * side
        assert not np.array_equal(shape, shapes[0]), "or this test says nothing"


def jolt(model: solver.FoldModel, largest: float) -> None:
    x = model._state.x
    model._state = at_rest(x + largest * np.random.default_rng(0).standard_normal(x.shape))
