"""Times the direct solver on square grids with the solver's own stencil: kernel, numpy and scipy, scipy's splu.

Run it: python -m benchmarks.linear_system [--repeats 15]
"""

from __future__ import annotations

import argparse
import contextlib
import os
import time
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from solver.arrays import FloatArray, IntArray
from solver.optimize.kernel import SWITCH, linear_algebra
from solver.optimize.linear_system import LinearSystem

GRID_SIDES = (22, 32, 45, 63, 100)  # about 500, 1,000, 2,000, 4,000, 10,000 vertices
SPLU_LIMIT = 4000  # vertices; beyond it splu takes seconds


@contextlib.contextmanager
def computing(*, with_kernel: bool) -> Iterator[bool]:
    """Linear systems made inside use the compiled kernel or not; yields whether they do."""
    before = os.environ.get(SWITCH)
    os.environ[SWITCH] = "1" if with_kernel else "0"
    linear_algebra.cache_clear()
    try:
        yield linear_algebra().library is not None
    finally:
        if before is None:
            del os.environ[SWITCH]
        else:
            os.environ[SWITCH] = before
        linear_algebra.cache_clear()


def diamond_pattern(side: int) -> tuple[IntArray, IntArray, FloatArray]:
    """Lower-triangle scalar rows, cols and (V,2) plane of the 13-point stencil on a square grid."""
    i, j = np.divmod(np.arange(side * side), side)
    rows, cols = [], []
    for di in range(-2, 3):
        for dj in range(-2, 3):
            inside = (i + di >= 0) & (i + di < side) & (j + dj >= 0) & (j + dj < side)
            if abs(di) + abs(dj) <= 2:
                rows.append(np.flatnonzero(inside))
                cols.append(((i + di) * side + j + dj)[inside])
    row, col = np.concatenate(rows), np.concatenate(cols)
    c, d = np.divmod(np.arange(9), 3)
    row, col = (3 * row[:, None] + c).ravel(), (3 * col[:, None] + d).ravel()
    lower = row >= col
    return row[lower], col[lower], np.stack([i, j], axis=1).astype(np.float64)


def dominant_values(rows: IntArray, cols: IntArray, size: int, seed: int = 0) -> FloatArray:
    """Random values of a symmetric, strictly diagonally dominant (so positive definite) matrix."""
    values = np.random.default_rng(seed).standard_normal(len(rows))
    off = rows != cols
    sums = np.bincount(rows[off], abs(values[off]), size) + np.bincount(cols[off], abs(values[off]), size)
    values[~off] = 1.0 + sums[rows[~off]]
    return values


def time_splu(rows: IntArray, cols: IntArray, values: FloatArray, rhs: FloatArray) -> float:
    """Seconds that scipy's splu takes to factorise and solve once; the matrix is put together before."""
    off = rows != cols
    data = np.concatenate([values, values[off]])
    where = np.concatenate([rows, cols[off]]), np.concatenate([cols, rows[off]])
    matrix = sp.csc_matrix((data, where), shape=(len(rhs), len(rhs)))
    start = time.perf_counter()
    factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    factor.solve(rhs)
    return time.perf_counter() - start


def time_system(system: LinearSystem, values: FloatArray, rhs: FloatArray) -> float:
    """Seconds that ``system`` takes to factorise and solve once."""
    start = time.perf_counter()
    system.factorize(values, rhs)
    system.solution()
    return time.perf_counter() - start


def interleaved(measures: list[Callable[[], float]], repeats: int) -> list[tuple[float, float]]:
    """Least and median milliseconds of each, taken in turns after one warm-up: a busy machine is so to all."""
    for measure in measures:
        measure()
    times = 1e3 * np.array([[measure() for measure in measures] for _ in range(repeats)])
    return list(zip(times.min(0).tolist(), np.median(times, axis=0).tolist(), strict=True))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15)
    repeats = parser.parse_args().repeats
    with computing(with_kernel=True):
        print(linear_algebra().phrase)
    print("factor + solve in ms, least / median, one thread and two; how many times as fast the kernel is")
    print(f"{'vertices':>8} {'Mflop':>8}   {'kernel':^35}   {'numpy and scipy':^35}   ratio       splu")
    for side in GRID_SIDES:
        rows, cols, plane = diamond_pattern(side)
        size = 3 * len(plane)
        values, rhs = dominant_values(rows, cols, size), np.ones(size)
        systems = []
        for with_kernel in (True, False):
            with computing(with_kernel=with_kernel):
                systems += [LinearSystem(rows, cols, plane, threads=threads) for threads in (1, 2)]
        measures = [partial(time_system, system, values, rhs) for system in systems]
        times = interleaved(measures, repeats)
        cells = [f"{least:7.2f} /{median:7.2f}" for least, median in times]
        ratios = "  ".join(f"{times[k + 2][0] / times[k][0]:4.2f}" for k in (0, 1))
        splu = f"{1e3 * time_splu(rows, cols, values, rhs):8.1f}" if len(plane) <= SPLU_LIMIT else ""
        print(f"{len(plane):8d} {systems[0].flops / 1e6:8.1f}   {'  '.join(cells)}   {ratios} {splu}", flush=True)


if __name__ == "__main__":
    main()
