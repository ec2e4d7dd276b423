"""The same drawing, told the same, gives the same bits: again, in another process, with other threads."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLD = """
import hashlib, sys
import solver
pattern = solver.read_pattern(sys.argv[1])
result = solver.fold(pattern, solver.FoldDescription(resolution=20, angle=50.0))
print(hashlib.sha256(result.positions.tobytes()).hexdigest())
"""


def bits(drawing: Path, threads: int, hash_seed: int) -> str:
    """Of the shape, folded in a process of its own."""
    environment = {"OPENBLAS_NUM_THREADS": str(threads), "PYTHONHASHSEED": str(hash_seed)}
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
def test_processes_threads_and_hashes_do_not_matter(name: str) -> None:
    drawing = ROOT / "sample_patterns" / f"{name}.svg"
    assert bits(drawing, threads=1, hash_seed=1) == bits(drawing, threads=2, hash_seed=2)
