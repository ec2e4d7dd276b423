"""Whether the compiled kernel is used, and why not where it is not. Nothing needs it: numpy and scipy do the same.

It comes as a package of its own, ``curvefold_kernel``, which holds one library file and no Python; ``kernel/`` has
its source. ``CURVEFOLD_KERNEL=0`` in the environment switches it off.
"""

from __future__ import annotations

import functools
import importlib.util
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import NotPositiveDefiniteError
from .multifrontal.compiled import CompiledFactorization
from .multifrontal.library import KernelUnavailableError, Library
from .multifrontal.plan import BrokenPlanError
from .multifrontal.symbolic import Front, Symbolic

#: The environment's switch: "0" is off, all else on.
SWITCH = "CURVEFOLD_KERNEL"
#: The package that holds the library.
PACKAGE = "curvefold_kernel"
#: What the self-test may leave of its right-hand side of size one; it leaves 1e-15.
_SELF_TEST_RESIDUAL = 1e-12


@dataclass(frozen=True, eq=False)
class LinearAlgebra:
    """What solves the linear systems: the kernel's library, None for numpy and scipy; and a phrase that says so."""

    library: Library | None
    phrase: str


@functools.cache
def linear_algebra() -> LinearAlgebra:
    """What is used in this process; found out once."""
    try:
        library = _working_library()
    except KernelUnavailableError as error:
        return LinearAlgebra(None, f"numpy and scipy; {error}")
    return LinearAlgebra(library, f"compiled kernel, {library.instructions}")


def _working_library() -> Library:
    if os.environ.get(SWITCH) == "0":
        raise KernelUnavailableError(f"the compiled kernel is switched off by {SWITCH}=0")
    library = Library(_library_file())
    if not passes_self_test(library):
        raise KernelUnavailableError("the compiled kernel failed its self-test")
    return library


def _library_file() -> Path:
    """Raises KernelUnavailableError where none is installed."""
    found = importlib.util.find_spec(PACKAGE)
    folders = [] if found is None else list(found.submodule_search_locations or ())
    files = [path for folder in folders for path in sorted(Path(folder).glob("kernel.*"))]
    if len(files) != 1:
        raise KernelUnavailableError("the compiled kernel is not installed")
    return files[0]


def passes_self_test(library: Library) -> bool:
    """Whether it solves a small system of three fronts right, both ways, and refuses an indefinite one."""
    symbolic = _three_fronts()
    rows, cols = _entries_of(symbolic)
    size = 3 * len(symbolic.position)
    # Any numbers will do that no two places share; the diagonal outweighs its row.
    values = np.sin(1.0 + np.arange(len(rows)))
    values[rows == cols] = 2.0 * size
    matrix = np.zeros((size, size))
    matrix[rows, cols] = matrix[cols, rows] = values
    rhs = np.cos(np.arange(size))
    try:
        system = CompiledFactorization(library, symbolic, rows, cols, threads=1)
        system.factorize(values, rhs)
        solutions = [system.solution(), system.solve(rhs)]
    except (BrokenPlanError, NotPositiveDefiniteError):
        return False
    values[rows == cols] = -1.0
    try:
        system.factorize(values)
    except NotPositiveDefiniteError:
        return all(_residual(matrix, solution, rhs) < _SELF_TEST_RESIDUAL for solution in solutions)
    return False


def _residual(matrix: FloatArray, solution: FloatArray, rhs: FloatArray) -> float:
    # By einsum: a product by BLAS may start its threads.
    return float(np.abs(np.einsum("ij,j->i", matrix, solution) - rhs).max())


def _three_fronts() -> Symbolic:
    """Two fronts of sizes that are no multiples of eight, and a third that takes the updates of both."""
    left, right = Front(0, 3, np.array([7, 8, 10]), ()), Front(3, 7, np.array([8, 9, 11, 12]), ())
    root = Front(7, 13, np.zeros(0, np.int64), (0, 1))
    fronts = (left, right, root)
    panels = [front.pivot_size * (front.pivot_size + front.border_size) for front in fronts]
    starts = np.concatenate([[0], np.cumsum(panels)]).astype(np.int64)
    return Symbolic(fronts, (1, 2), (([2], []),), np.arange(13), starts)


def _entries_of(symbolic: Symbolic) -> tuple[IntArray, IntArray]:
    """Every entry of the lower triangle that has a place in some front."""
    rows, cols = [], []
    for front in symbolic.fronts:
        unknowns = (3 * front.rows[:, None] + np.arange(3)).ravel()
        row, col = np.meshgrid(unknowns, unknowns[: front.pivot_size], indexing="ij")
        lower = row >= col
        rows.append(row[lower])
        cols.append(col[lower])
    return np.concatenate(rows), np.concatenate(cols)
