"""Numeric factorisation and solution: the fronts turned once into fixed lists of calls.

Every front keeps its panel (pivot rows over border rows, column-major). Its pivot block is factorised and
*inverted* in place, W = L11^-1, since multiplying by a small triangle runs two to three times as fast as
solving with it; the border rows become L21 = A21 W^T, and the update -L21 L21^T plus the children's
updates goes to the parent. Addresses, sizes and views are all made beforehand: a factorisation is a walk
along a list of (function, arguments).
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import NotPositiveDefiniteError
from .lapack import Routines, argument
from .symbolic import Front, Symbolic, border_runs, front_flops, update_places

Call = tuple[Callable[..., Any], tuple[Any, ...]]

# Pivot blocks up to this size are factorised and inverted by LAPACK directly, larger ones by halves:
# OpenBLAS's own dpotrf and dtrtri run at a fifth of dtrmm's speed on small blocks.
DIRECT_PIVOTS = 48
# Below this many operations in the smaller lane, handing it to a second thread costs more than it brings.
MIN_LANE_FLOPS = 2e7

_ITEM = 8  # bytes of a double, and of an integer here


class _Scalars:
    """Constants as arguments of Fortran calls, each made once; an argument keeps its constant alive."""

    def __init__(self) -> None:
        self._kept: dict[tuple[str, Any], Any] = {}

    def integer(self, value: int) -> Any:
        return self._argument("i", value, ctypes.c_int64)

    def real(self, value: float) -> Any:
        return self._argument("d", value, ctypes.c_double)

    def letter(self, value: str) -> Any:
        return self._argument("c", value.encode(), ctypes.c_char)

    def _argument(self, kind: str, value: Any, make: Callable[[Any], Any]) -> Any:
        key = kind, value
        if key not in self._kept:
            self._kept[key] = ctypes.byref(make(value))
        return self._kept[key]


class Factorization:
    """Cholesky factors of matrices that share one pattern. Not safe to use from two threads at once.

    ``addresses`` (nnz,) says where in the factor's storage each value goes (``symbolic.entry_addresses``).
    Results are the same to the last bit for any number of threads.
    """

    def __init__(self, symbolic: Symbolic, addresses: IntArray, routines: Routines, *, threads: int) -> None:
        self._symbolic = symbolic
        self._addresses = addresses
        self._routines = routines
        self._scalars = _Scalars()
        self._panels = np.zeros(int(symbolic.panel_starts[-1]))
        sizes = np.array([front.border_size**2 for front in symbolic.fronts])
        self._update_starts, total = update_places(symbolic, sizes)
        self._updates = np.zeros(total)
        size = 3 * len(symbolic.position)
        self._vector = np.zeros(size)
        self._border = np.zeros(max(f.border_size for f in symbolic.fronts))
        self._order = (3 * symbolic.position[:, None] + np.arange(3)).ravel()
        self._build()
        self._pool = None
        if threads > 1 and self._smaller_lane_flops() >= MIN_LANE_FLOPS:
            # Its thread ends with this object: the executor holds no reference to it between tasks.
            self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="curvefold-factor")

    def factorize(self, values: FloatArray) -> None:
        """Factorises the matrix with ``values`` (nnz,). Raises NotPositiveDefiniteError."""
        with np.errstate(all="ignore"):
            total = values.sum()  # not finite if any value is not, and much faster than looking at each
        if not np.isfinite(total):
            raise NotPositiveDefiniteError("The system of the step has entries that are not finite")
        self._panels.fill(0.0)
        self._panels[self._addresses] = values
        # Unused triangles of the updates collect leftovers, which must not grow from call to call.
        self._updates.fill(0.0)
        self._infos.fill(0)
        with self._routines.blas_threads.single():
            for first, second in self._factor_stages:
                self._side_by_side(first, second)
        if self._infos.any() or not self._pivots_finite():
            raise NotPositiveDefiniteError("The system of the step is not positive definite")

    def solve(self, rhs: FloatArray) -> FloatArray:
        """The solution (N,) for ``rhs`` (N,) with the latest factor."""
        # One thread only: the calls are so short that two would mostly wait for each other's GIL.
        self._vector[self._order] = rhs
        with self._routines.blas_threads.single():
            _run(self._solve_calls)
        solution: FloatArray = self._vector[self._order]
        return solution

    def _side_by_side(self, first: list[Call], second: list[Call]) -> None:
        if self._pool is None or not first or not second:
            _run(first)
            _run(second)
            return
        other = self._pool.submit(_run, second)
        try:
            _run(first)
        finally:
            other.result()

    def _pivots_finite(self) -> bool:
        """Overflow anywhere ends up in the last pivot of some root."""
        roots = [i for i, f in enumerate(self._symbolic.fronts) if f.border_size == 0]
        last = [int(self._symbolic.panel_starts[i + 1]) - 1 for i in roots]
        inverses = self._panels[last]  # an infinite pivot has the inverse 0
        return bool((np.isfinite(inverses) & (inverses > 0)).all())

    def _smaller_lane_flops(self) -> float:
        lanes = [[f for i, f in enumerate(self._symbolic.fronts) if self._lane(i) == lane] for lane in (0, 1)]
        return min(sum(front_flops(f.pivot_size, f.border_size) for f in lane) for lane in lanes)

    def _lane(self, front: int) -> int:
        first, second = self._symbolic.lane_ends
        return int(front >= first) + int(front >= second)

    def _build(self) -> None:
        fronts = self._symbolic.fronts
        first, second = self._symbolic.lane_ends
        self._factor_calls: list[list[Call]] = [[] for _ in fronts]
        forward: list[Call] = []
        backward: list[Call] = []
        blocks: list[Any] = []
        for i, front in enumerate(fronts):
            if front.pivot_size == 0:
                continue
            early, late = self._child_additions(i)
            calls = self._factor_calls[i]
            calls.extend(early)
            self._pivot_calls(self._panel_address(i), front.pivot_size, self._height(front), calls, blocks)
            if front.border_size:
                self._border_calls(i, calls)
            calls.extend(late)
            self._substitution_calls(i, forward, backward)
        self._solve_calls = [*forward, *reversed(backward)]
        self._infos = np.zeros(len(blocks), np.int64)
        base = int(self._infos.ctypes.data)
        for k, (calls, index) in enumerate(blocks):
            function, arguments = calls[index]
            calls[index] = function, (*arguments[:-1], argument(base + k * _ITEM))
        sides = [(range(first), range(first, second)), *self._symbolic.top_stages]
        self._factor_stages = [(self._calls_of(left), self._calls_of(right)) for left, right in sides]

    def _calls_of(self, fronts: Iterable[int]) -> list[Call]:
        return [call for i in fronts for call in self._factor_calls[i]]

    @staticmethod
    def _height(front: Front) -> int:
        return front.pivot_size + front.border_size

    def _panel_address(self, i: int) -> int:
        return int(self._panels.ctypes.data) + _ITEM * int(self._symbolic.panel_starts[i])

    def _panel_blocks(self, i: int) -> tuple[Any, Any]:
        """The panel's pivot block and its border rows, as arguments."""
        at = self._panel_address(i)
        return argument(at), argument(at + _ITEM * self._symbolic.fronts[i].pivot_size)

    def _update_address(self, i: int) -> int:
        return int(self._updates.ctypes.data) + _ITEM * int(self._update_starts[i])

    def _panel(self, i: int) -> FloatArray:
        """(pivots, height): the panel's transpose, in which rows are pivots."""
        front, starts = self._symbolic.fronts[i], self._symbolic.panel_starts
        return self._panels[starts[i] : starts[i + 1]].reshape(front.pivot_size, self._height(front))

    def _update(self, i: int) -> FloatArray:
        """(border, border): the update's transpose; only its upper triangle has a meaning."""
        size, start = self._symbolic.fronts[i].border_size, int(self._update_starts[i])
        return self._updates[start : start + size * size].reshape(size, size)

    def _child_additions(self, i: int) -> tuple[list[Call], list[Call]]:
        """Additions of the children's updates: to the panel, and (after the front's own) to its update."""
        front = self._symbolic.fronts[i]
        early: list[Call] = []
        late: list[Call] = []
        panel = self._panel(i)
        update = self._update(i)
        pivots = front.stop - front.start
        for child in front.children:
            source = self._update(child)
            runs = border_runs(self._symbolic.fronts[child], front)
            for a, (to_col, from_col, cols) in enumerate(runs):
                for to_row, from_row, count in _merged(runs[a:], pivots if to_col >= pivots else -1):
                    block = source[_dofs(from_col, cols), _dofs(from_row, count)]
                    if to_col < pivots:
                        target = panel[_dofs(to_col, cols), _dofs(to_row, count)]
                        early.append(self._addition(target, block))
                    else:
                        target = update[_dofs(to_col - pivots, cols), _dofs(to_row - pivots, count)]
                        late.append(self._addition(target, block))
        return early, late

    def _addition(self, target: FloatArray, block: FloatArray) -> Call:
        """``target += block`` for two blocks whose rows are contiguous."""
        if self._routines.geadd is None:
            return np.add, (target, block, target)
        s, one = self._scalars, self._scalars.real(1.0)
        size = s.integer(block.shape[1]), s.integer(block.shape[0])
        source = argument(block.ctypes.data), s.integer(block.strides[0] // _ITEM)
        return self._routines.geadd, (
            *size,
            *(one, *source),
            *(one, argument(target.ctypes.data), s.integer(target.strides[0] // _ITEM)),
        )

    def _pivot_calls(self, at: int, size: int, ld: int, calls: list[Call], blocks: list[Any]) -> None:
        """A -> W = L^-1 with A = L L^T, lower triangle of ``size`` rows at address ``at``, in place."""
        routines, s = self._routines, self._scalars
        lower, height, one, minus = s.letter("L"), s.integer(ld), s.real(1.0), s.real(-1.0)
        left, right, plain, transposed = s.letter("L"), s.letter("R"), s.letter("N"), s.letter("T")
        block = argument(at)
        if size <= DIRECT_PIVOTS:
            n = s.integer(size)
            blocks.append([calls, len(calls)])
            calls.append((routines.potrf, (lower, n, block, height, None)))
            blocks.append([calls, len(calls)])
            calls.append((routines.trtri, (lower, plain, n, block, height, None)))
            return
        upper_size = size // 2
        lower_size = size - upper_size
        m, n = s.integer(lower_size), s.integer(upper_size)
        corner_at = at + _ITEM * upper_size * (1 + ld)
        below, corner = argument(at + _ITEM * upper_size), argument(corner_at)
        self._pivot_calls(at, upper_size, ld, calls, blocks)
        calls.append((routines.trmm, (right, lower, transposed, plain, m, n, one, block, height, below, height)))
        calls.append((routines.syrk, (lower, plain, m, n, minus, below, height, one, corner, height)))
        self._pivot_calls(corner_at, lower_size, ld, calls, blocks)
        calls.append((routines.trmm, (left, lower, plain, plain, m, n, minus, corner, height, below, height)))
        calls.append((routines.trmm, (right, lower, plain, plain, m, n, one, block, height, below, height)))

    def _border_calls(self, i: int, calls: list[Call]) -> None:
        routines, s = self._routines, self._scalars
        front = self._symbolic.fronts[i]
        height = s.integer(self._height(front))
        block, below = self._panel_blocks(i)
        p, b = s.integer(front.pivot_size), s.integer(front.border_size)
        lower, right, plain, transposed = s.letter("L"), s.letter("R"), s.letter("N"), s.letter("T")
        one, minus, zero = s.real(1.0), s.real(-1.0), s.real(0.0)
        calls.append((routines.trmm, (right, lower, transposed, plain, b, p, one, block, height, below, height)))
        update = argument(self._update_address(i))
        calls.append((routines.syrk, (lower, plain, b, p, minus, below, height, zero, update, b)))

    def _substitution_calls(self, i: int, forward: list[Call], backward: list[Call]) -> None:
        """``backward`` is run in reverse, so it is written backwards."""
        routines, s = self._routines, self._scalars
        front = self._symbolic.fronts[i]
        vector, border = self._vector, self._border[: front.border_size]
        x, t = argument(vector.ctypes.data + _ITEM * 3 * front.start), argument(border.ctypes.data)
        height = s.integer(self._height(front))
        block, below = self._panel_blocks(i)
        p, b, step = s.integer(front.pivot_size), s.integer(front.border_size), s.integer(1)
        lower, plain, transposed = s.letter("L"), s.letter("N"), s.letter("T")
        one, minus = s.real(1.0), s.real(-1.0)
        forward.append((routines.trmv, (lower, plain, plain, p, block, height, x, step)))
        backward.append((routines.trmv, (lower, transposed, plain, p, block, height, x, step)))
        if front.border_size:
            where = (3 * front.border[:, None] + np.arange(3)).ravel()
            gather = (vector.take, (where, None, border, "clip"))
            forward.append(gather)
            forward.append((routines.gemv, (plain, b, p, minus, below, height, x, step, one, t, step)))
            forward.append((vector.__setitem__, (where, border)))
            backward.append((routines.gemv, (transposed, b, p, minus, below, height, t, step, one, x, step)))
            backward.append(gather)


def _dofs(vertex: int, count: int) -> slice:
    return slice(3 * vertex, 3 * (vertex + count))


def _merged(runs: list[tuple[int, int, int]], pivots: int) -> list[tuple[int, int, int]]:
    """Runs of (target, source, count) put together where they follow each other across the pivots' end."""
    if pivots >= 0:
        return runs
    merged = [runs[0]]
    for to_row, from_row, count in runs[1:]:
        last = merged[-1]
        if last[0] + last[2] == to_row:
            merged[-1] = last[0], last[1], last[2] + count
        else:
            merged.append((to_row, from_row, count))
    return merged


def _run(calls: list[Call]) -> None:
    # An indefinite matrix may overflow in numpy's additions, before its pivots are looked at.
    with np.errstate(all="ignore"):
        for function, arguments in calls:
            function(*arguments)
