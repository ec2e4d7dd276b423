"""The one door to linear algebra: sparse symmetric positive definite systems of one frozen pattern."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ..arrays import FloatArray, IntArray
from ..errors import NotPositiveDefiniteError
from .kernel import linear_algebra
from .multifrontal.compiled import CompiledFactorization
from .multifrontal.lapack import LapackUnavailableError, Routines
from .multifrontal.numeric import Factorization
from .multifrontal.ordering import dissect, vertex_graph
from .multifrontal.symbolic import Symbolic, analyse, entry_addresses


class _Backend(Protocol):
    def factorize(self, values: FloatArray) -> None: ...

    def solve(self, rhs: FloatArray) -> FloatArray: ...


class LinearSystem:
    """Frozen-pattern SPD system; dof ``3*v + c`` belongs to vertex ``v``.

    ``rows``, ``cols``: (nnz,) scalar indices of the lower triangle (rows >= cols) of an N x N matrix,
    N = 3 V, unique, in any order, all diagonals included. ``plane``: (V,2) plane coordinates; they steer
    the order of elimination and may be any finite numbers. ``threads``: 1 or 2, more count as 2; the
    results are the same to the last bit. Raises ValueError for a pattern that is not such a triangle.

    The compiled kernel is used where it is to be had, otherwise numpy and scipy; results differ by rounding.

    One system must not be used from several threads at once.
    """

    def __init__(self, rows: IntArray, cols: IntArray, plane: FloatArray, *, threads: int = 2) -> None:
        rows, cols = np.asarray(rows, np.int64).ravel(), np.asarray(cols, np.int64).ravel()
        plane = np.asarray(plane, np.float64)
        _check_pattern(rows, cols, plane)
        self.size: int = 3 * len(plane)
        self.entries: int = len(rows)
        self.factorizations: int = 0
        self.solves: int = 0
        self._factorized = False
        self._pending: FloatArray | None = None
        self.flops: float
        """Multiplications and additions of one factorisation (0 where unknown)."""
        self.factor_nonzeros: int
        """Numbers kept for one factor, zeros among them included."""
        self.backend: str
        """``"kernel"``; without it ``"multifrontal"``, or ``"splu"`` where scipy has no LAPACK pointers."""
        self._implementation: _Backend
        library = linear_algebra().library
        if library is not None:
            symbolic = _analysed(rows, cols, plane)
            compiled = CompiledFactorization(library, symbolic, rows, cols, threads=threads)
            self._implementation = compiled
            self.backend, self.flops = "kernel", symbolic.flops
            self.factor_nonzeros = compiled.factor_nonzeros
            return
        try:
            routines = Routines()
        except LapackUnavailableError:
            self._implementation = _SuperLU(rows, cols, self.size)
            self.backend, self.flops, self.factor_nonzeros = "splu", 0.0, 0
            return
        symbolic = _analysed(rows, cols, plane)
        addresses = entry_addresses(symbolic, rows, cols)
        self._implementation = Factorization(symbolic, addresses, routines, threads=threads)
        self.backend, self.flops = "multifrontal", symbolic.flops
        self.factor_nonzeros = int(symbolic.panel_starts[-1])

    def factorize(self, values: FloatArray, rhs: FloatArray | None = None) -> None:
        """Factorises the matrix with ``values`` (nnz,), aligned with ``rows`` and ``cols``.

        With ``rhs`` (N,) half of its solution may be done on the way; ``solution`` gives it.
        Raises NotPositiveDefiniteError (values that are not finite included) and ValueError for a wrong
        shape. After an error there is no factor.
        """
        values = np.ascontiguousarray(values, np.float64)
        if values.shape != (self.entries,):
            raise ValueError(f"values has shape {values.shape}, expected ({self.entries},)")
        if rhs is not None:
            rhs = self._checked_rhs(rhs)
        self._factorized, self._pending = False, None
        if isinstance(self._implementation, CompiledFactorization):
            self._implementation.factorize(values, rhs)
        else:
            self._implementation.factorize(values)
        self._factorized, self._pending = True, rhs
        self.factorizations += 1
        if isinstance(self._implementation, _SuperLU):
            self.factor_nonzeros = self._implementation.factor_nonzeros

    def solve(self, rhs: FloatArray) -> FloatArray:
        """The solution (N,) of the latest factorised matrix for ``rhs`` (N,). Raises ValueError."""
        rhs = self._checked_rhs(rhs)
        if not self._factorized:
            raise ValueError("there is no factor to solve with")
        self._pending = None
        self.solves += 1
        return self._implementation.solve(rhs)

    def solution(self) -> FloatArray:
        """The solution (N,) for the ``rhs`` given to ``factorize``, before any other solve. Raises ValueError."""
        rhs, self._pending = self._pending, None
        if rhs is None:
            raise ValueError("the latest factorisation was given no right-hand side, or it has been solved for")
        self.solves += 1
        if isinstance(self._implementation, CompiledFactorization):
            return self._implementation.solution()
        return self._implementation.solve(rhs)

    def _checked_rhs(self, rhs: FloatArray) -> FloatArray:
        rhs = np.asarray(rhs, np.float64)
        if rhs.shape != (self.size,):
            raise ValueError(f"rhs has shape {rhs.shape}, expected ({self.size},)")
        return rhs


def _analysed(rows: IntArray, cols: IntArray, plane: FloatArray) -> Symbolic:
    graph = vertex_graph(rows // 3, cols // 3, len(plane))
    return analyse(graph, dissect(graph, plane))


def _check_pattern(rows: IntArray, cols: IntArray, plane: FloatArray) -> None:
    if plane.ndim != 2 or plane.shape[1] != 2 or len(plane) == 0:
        raise ValueError(f"plane has shape {plane.shape}, expected (V, 2) with V >= 1")
    if not np.isfinite(plane).all():
        raise ValueError("plane coordinates are not finite")
    size = 3 * len(plane)
    if rows.shape != cols.shape:
        raise ValueError("rows and cols differ in length")
    if len(rows) == 0 or cols.min() < 0 or rows.max() >= size or (rows < cols).any():
        raise ValueError("rows and cols are not of a lower triangle of 3 V rows")
    keys = np.sort(rows * size + cols)
    if (np.diff(keys) == 0).any():
        raise ValueError("rows and cols repeat an entry")
    if np.count_nonzero(rows == cols) != size:
        raise ValueError("rows and cols lack a diagonal entry")


class _SuperLU:
    """The same through scipy's general LU factorisation, three to ten times slower."""

    def __init__(self, rows: IntArray, cols: IntArray, size: int) -> None:
        mirrored = np.flatnonzero(rows != cols)
        self._rows = np.concatenate([rows, cols[mirrored]])
        self._cols = np.concatenate([cols, rows[mirrored]])
        self._mirrored = mirrored
        self._size = size
        self._factor: Any = None
        self.factor_nonzeros = 0

    def factorize(self, values: FloatArray) -> None:
        if not np.isfinite(values).all():
            raise NotPositiveDefiniteError("The system of the step has entries that are not finite")
        data = np.concatenate([values, values[self._mirrored]])
        matrix = sp.csc_matrix((data, (self._rows, self._cols)), shape=(self._size, self._size))
        try:
            # No pivoting off the diagonal, so that the pivots' signs tell whether it is positive definite.
            factor = splu(
                matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError as error:  # exactly singular
            raise NotPositiveDefiniteError("The system of the step is not positive definite") from error
        if not np.array_equal(factor.perm_r, factor.perm_c) or not (factor.U.diagonal() > 0).all():
            raise NotPositiveDefiniteError("The system of the step is not positive definite")
        self._factor = factor
        self.factor_nonzeros = int(factor.L.nnz)

    def solve(self, rhs: FloatArray) -> FloatArray:
        solution: FloatArray = self._factor.solve(rhs)
        return solution
