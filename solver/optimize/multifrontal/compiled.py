"""Numeric factorisation and solution by the compiled kernel: the same fronts, a call for each list of them.

It stands in for ``numeric.Factorization`` where the kernel is to be had. Its sums run in another order, so results
differ in the last bits; they are the same for one thread and two, and on every instruction set.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import NotPositiveDefiniteError
from .library import Library, PlanAddresses
from .plan import Int32Array, KernelPlan, check, lay_out
from .symbolic import Symbolic, front_flops

#: Below this many operations in the smaller lane (a tenth of a millisecond), handing it to a second thread costs
#: more than it brings.
MIN_LANE_FLOPS = 4e6


class CompiledFactorization:
    """Cholesky factors of matrices that share one pattern. Not safe to use from two threads at once.

    rows, cols (nnz,): the entries' places, either triangle. level: the instruction set, the best by itself.
    """

    def __init__(
        self,
        library: Library,
        symbolic: Symbolic,
        rows: IntArray,
        cols: IntArray,
        *,
        threads: int,
        level: int | None = None,
    ) -> None:
        self._library = library
        self._level = library.level if level is None else level
        if not 1 <= self._level <= library.level:
            raise ValueError(f"the kernel has no instruction set {self._level} here")
        self._plan = plan = lay_out(symbolic, rows, cols)
        check(plan)
        self._panels = np.zeros(plan.panels_size)
        self._updates = np.zeros(plan.updates_size)
        self._carried = np.zeros(plan.carried_size)
        self._scratch = np.zeros(2 * plan.scratch_size)
        self._vector = np.zeros(plan.unknowns)
        self._order = (3 * symbolic.position[:, None] + np.arange(3)).ravel()
        self._addresses = _addresses(plan, self._panels, self._updates, self._carried, self._scratch)
        self._pool = None
        lanes = [sum(_flops(symbolic, i) for i in lane) for lane in plan.stages[0]]
        if threads > 1 and min(lanes) >= MIN_LANE_FLOPS:
            # Its thread ends with this object: the executor holds no reference to it between tasks.
            self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="curvefold-factor")

    @property
    def factor_nonzeros(self) -> int:
        """Numbers kept for one factor, zeros among them included."""
        return self._plan.panels_size

    def factorize(self, values: FloatArray, rhs: FloatArray | None = None) -> None:
        """Factorises the matrix with ``values`` (nnz,). Raises NotPositiveDefiniteError.

        With ``rhs`` (N,) the forward half of its solution comes along, much cheaper than by itself, since the
        factor is in the cache; ``solution`` gives the rest, once.
        """
        if values.shape != self._plan.source.shape or values.dtype != np.float64 or not values.flags.c_contiguous:
            raise ValueError("the values are not as many contiguous doubles as the pattern has entries")
        with np.errstate(all="ignore"):
            total = values.sum()  # not finite if any value is not, and much faster than looking at each
        if not np.isfinite(total):
            raise NotPositiveDefiniteError("The system of the step has entries that are not finite")
        at: int | None = None
        if rhs is not None:
            self._vector[self._order] = rhs
            at = self._vector.ctypes.data
        for first, second in self._plan.stages:
            if not self._side_by_side(first, second, values.ctypes.data, at):
                raise NotPositiveDefiniteError("The system of the step is not positive definite")

    def solution(self) -> FloatArray:
        """The solution (N,) for the ``rhs`` that was given to ``factorize``."""
        # One thread only: the work is small beside that of handing it over.
        for front_list in reversed(list(self._lists())):
            self._library.backward(*self._call(0, front_list), self._vector.ctypes.data)
        solution: FloatArray = self._vector[self._order]
        return solution

    def solve(self, rhs: FloatArray) -> FloatArray:
        """The solution (N,) for ``rhs`` (N,) with the latest factor."""
        self._vector[self._order] = rhs
        for front_list in self._lists():
            self._library.forward(*self._call(0, front_list), self._vector.ctypes.data)
        return self.solution()

    def _side_by_side(self, first: Int32Array, second: Int32Array, values: int, vector: int | None) -> bool:
        """Factorises two lists of fronts; whether all are positive definite."""

        def factor(thread: int, front_list: Int32Array) -> bool:
            return self._library.factor(*self._call(thread, front_list), values, vector) == 0

        if self._pool is None or not len(first) or not len(second):
            return factor(0, first) and factor(0, second)
        other = self._pool.submit(factor, 1, second)
        try:
            good = factor(0, first)
        finally:
            other_good = other.result()
        return good and other_good

    def _call(self, thread: int, front_list: Int32Array) -> tuple[int, int, int, int, int]:
        """The arguments that all functions of the kernel begin with."""
        address = ctypes.addressof(self._addresses)
        return address, self._level, thread, front_list.ctypes.data, len(front_list)

    def _lists(self) -> Iterable[Int32Array]:
        return (side for stage in self._plan.stages for side in stage)


def _addresses(
    plan: KernelPlan, panels: FloatArray, updates: FloatArray, carried: FloatArray, scratch: FloatArray
) -> PlanAddresses:
    """The plan as C has it. Every storage has the size that the plan was checked for."""
    storage = ((panels, plan.panels_size), (updates, plan.updates_size), (carried, plan.carried_size))
    for array, size in (*storage, (scratch, 2 * plan.scratch_size)):
        assert array.shape == (size,)
        assert array.dtype == np.float64
        assert array.flags.c_contiguous
    arrays = (plan.fronts, plan.source, plan.target, plan.children, plan.runs, plan.indices)
    addresses = (array.ctypes.data for array in (*arrays, panels, updates, carried, scratch))
    return PlanAddresses(*addresses, plan.scratch_size)


def _flops(symbolic: Symbolic, front: int) -> float:
    return front_flops(symbolic.fronts[front].pivot_size, symbolic.fronts[front].border_size)
