"""Times the direct solver on square grids with the solver's own stencil, beside scipy's splu.

Run it: python -m benchmarks.linear_system [--repeats 15]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from functools import partial

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from solver.arrays import FloatArray, IntArray
from solver.optimize.linear_system import LinearSystem

GRID_SIDES = (22, 32, 45, 63, 100)  # about 500, 1,000, 2,000, 4,000, 10,000 vertices
SPLU_LIMIT = 4000  # vertices; beyond it splu takes seconds


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
    system.factorize(values)
    system.solve(rhs)
    return time.perf_counter() - start


def best_and_median(measure: Callable[[], float], repeats: int) -> tuple[float, float]:
    """Least and median milliseconds over ``repeats`` after one warm-up."""
    measure()
    times = [1e3 * measure() for _ in range(repeats)]
    return min(times), float(np.median(times))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15)
    repeats = parser.parse_args().repeats
    print("factor + solve in ms, least / median")
    print("vertices   set-up    Mflop   1 thread        2 threads       splu")
    for side in GRID_SIDES:
        rows, cols, plane = diamond_pattern(side)
        size = 3 * len(plane)
        values, rhs = dominant_values(rows, cols, size), np.ones(size)
        cells = []
        for threads in (1, 2):
            start = time.perf_counter()
            system = LinearSystem(rows, cols, plane, threads=threads)
            set_up = 1e3 * (time.perf_counter() - start)
            least, median = best_and_median(partial(time_system, system, values, rhs), repeats)
            cells.append(f"{least:6.2f} /{median:7.2f}")
        if len(plane) <= SPLU_LIMIT:
            least, median = best_and_median(partial(time_splu, rows, cols, values, rhs), 3)
            cells.append(f"{least:6.1f} /{median:7.1f}")
        print(f"{len(plane):8d} {set_up:8.0f} {system.flops / 1e6:8.1f}  {'  '.join(cells)}")


if __name__ == "__main__":
    main()
