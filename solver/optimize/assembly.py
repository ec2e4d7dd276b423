"""From terms to one sparse system with a frozen pattern.

The structure (stencils) is analysed once; values go into the same slots ever after. Sparse matrices are never
added: an entry that happens to be zero at the flat state keeps its slot (method, section 3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from ..arrays import FloatArray, IntArray, dot
from ..errors import NotPositiveDefiniteError
from .linear_system import LinearSystem
from .term import EdgeTerm, LinearTerm, ResidualTerm, gather

#: Tried one after the other on the diagonal of a Hessian that does not factorise, energy per length².
_RESCUES = (1.0, 100.0, 1e4)


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Residuals at a point: of every objective and of the constraints, as (r,n) arrays by name."""

    objectives: dict[str, FloatArray]
    constraints: dict[str, FloatArray]
    linear: FloatArray  # (L,3) all linear rows
    objective: float
    constraint: FloatArray  # (m,) all constraint rows


@dataclass(frozen=True, eq=False)
class Linearization:
    """The Gauss-Newton model at a point."""

    evaluation: Evaluation
    gradient: FloatArray  # (3V,) of the objective
    values: FloatArray  # objective Hessian plus JᵀJ · stiffness, in the pattern's slots
    jacobians: dict[str, FloatArray]  # constraint Jacobians (r,3,k,n)


class Problem:
    """Terms, their frozen sparsity, and the linear system that serves them.

    objectives   nonlinear ResidualTerms and LinearTerms by name
    constraints  ResidualTerms whose residual is to vanish
    plane        (V,2) flat positions, for the elimination order
    damping      LinearTerms, each with the name and stencil of an objective: the metric of the steps' damping
    ``replace`` exchanges a term for one with the same stencil; another stencil needs another Problem.
    """

    def __init__(
        self,
        objectives: Sequence[ResidualTerm | LinearTerm],
        constraints: Sequence[ResidualTerm],
        plane: FloatArray,
        damping: Sequence[LinearTerm] = (),
    ) -> None:
        self.count = len(plane)
        self.nonlinear: dict[str, ResidualTerm] = {}
        self.linear: dict[str, LinearTerm] = {}
        for term in objectives:
            if len(term.stencil) == 0:
                continue
            if isinstance(term, LinearTerm):
                self.linear[term.name] = term
            else:
                self.nonlinear[term.name] = term
        self.constraints: dict[str, ResidualTerm] = {c.name: c for c in constraints if len(c.stencil)}
        # Looked up once: asking a protocol at every step costs more than the stiffness itself.
        self._edge_terms = {name: term for name, term in self.nonlinear.items() if isinstance(term, EdgeTerm)}
        self._plan(plane)
        self._stack_linear()
        self._damping = np.zeros(len(self.rows))
        for metric in damping:
            if metric.name in self.linear:
                np.add.at(self._damping, self._slots_linear[metric.name], _linear_products(metric))

    def replace(self, terms: Mapping[str, ResidualTerm | LinearTerm]) -> None:
        """New values for terms of the same structure."""
        restack = False
        for name, term in terms.items():
            if name in self.linear:
                assert isinstance(term, LinearTerm)
                old = self.linear[name]
                same = np.array_equal(old.coefficients, term.coefficients) and np.array_equal(
                    old.weight, term.weight
                )
                self.linear[name] = term
                if same:
                    a, b = self._linear_rows[name]
                    self._targets[a:b] = term.target
                else:
                    restack = True
            elif name in self.nonlinear:
                assert not isinstance(term, LinearTerm)
                self.nonlinear[name] = term
                if isinstance(term, EdgeTerm):
                    self._edge_terms[name] = term
        if restack:
            self._stack_linear()

    # --- structure -------------------------------------------------------------------------------------

    def _plan(self, plane: FloatArray) -> None:
        keys: list[IntArray] = []
        size = 3 * self.count
        groups = [*self.nonlinear.values(), *self.constraints.values()]
        for term in groups:
            keys.append(_pair_keys(_dofs(term.stencil), size))
        for linear in self.linear.values():
            keys.append(_linear_keys(linear.stencil, size))
        diagonal = np.arange(size, dtype=np.int64) * (size + 1)
        slots, inverse = _numbered(np.concatenate([diagonal, *(key.ravel() for key in keys)]))
        self.rows, self.columns = slots // size, slots % size
        self._diagonal = inverse[:size]
        pieces = np.split(inverse[size:], np.cumsum([key.size for key in keys])[:-1])
        self._slots_linear = dict(zip(self.linear, pieces[len(groups) :], strict=True))
        scatter = [piece.astype(np.int64) for piece in pieces[: len(groups)]]
        flat = np.concatenate(scatter) if scatter else np.zeros(0, dtype=np.int64)
        # Two different places of one stencil with the same vertex (a crease point next to a grid edge that it
        # shares a vertex with) meet on the diagonal twice, as (i, j) and as (j, i).
        counts = [_pair_counts(_dofs(term.stencil)).ravel() for term in groups]
        data = np.concatenate(counts) if counts else np.zeros(0)
        # Row s of the scatter matrix lists what is added into slot s.
        self._scatter = csr_matrix((data, (flat, np.arange(len(flat)))), shape=(len(slots), len(flat)))
        gradient = [_dofs(term.stencil).ravel() for term in groups]
        flat = np.concatenate(gradient) if gradient else np.zeros(0, dtype=np.int64)
        self._scatter_gradient = csr_matrix(
            (np.ones(len(flat)), (flat, np.arange(len(flat)))), shape=(size, len(flat))
        )
        self._buffer = np.empty(self._scatter.shape[1])
        self._buffer_gradient = np.empty(len(flat))
        self.system = LinearSystem(self.rows, self.columns, plane)

    def _stack_linear(self) -> None:
        rows, columns, values, targets, weights = [], [], [], [], []
        constant = np.zeros(len(self.rows))
        self._linear_rows: dict[str, tuple[int, int]] = {}
        offset = 0
        for name, term in self.linear.items():
            n, k = term.stencil.shape
            self._linear_rows[name] = (offset, offset + n)
            rows.append(np.repeat(np.arange(offset, offset + n), k))
            columns.append(term.stencil.ravel())
            values.append(term.coefficients.ravel())
            targets.append(term.target)
            weights.append(term.weight)
            offset += n
            np.add.at(constant, self._slots_linear[name], _linear_products(term))
        if offset == 0:
            self._matrix = csr_matrix((0, self.count))
            self._targets, self._weights = np.zeros((0, 3)), np.zeros(0)
        else:
            self._matrix = csr_matrix(
                (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
                shape=(offset, self.count),
            )
            self._targets, self._weights = np.vstack(targets), np.concatenate(weights)
        self._transpose = self._matrix.T.tocsr()
        self._constant = constant
        self._kept: tuple[tuple[float, float], FloatArray] | None = None

    # --- values ----------------------------------------------------------------------------------------

    def evaluate(self, x: FloatArray) -> Evaluation:
        """All residuals at x (V,3)."""
        xt = np.ascontiguousarray(x.T)
        return self._finish(
            x,
            {name: term.residual(gather(xt, term.stencil)) for name, term in self.nonlinear.items()},
            {name: term.residual(gather(xt, term.stencil)) for name, term in self.constraints.items()},
        )

    def _finish(
        self, x: FloatArray, objectives: dict[str, FloatArray], constraints: dict[str, FloatArray]
    ) -> Evaluation:
        linear = self._matrix @ x - self._targets
        total = dot(self._weights, np.einsum("nc,nc->n", linear, linear))
        for name, residual in objectives.items():
            total += dot(self.nonlinear[name].weight, (residual * residual).sum(0))
        rows = [residual.ravel() for residual in constraints.values()]
        return Evaluation(objectives, constraints, linear, total, np.concatenate(rows) if rows else np.zeros(0))

    def linearize(self, x: FloatArray, stiffness: float, shift: float, damping: float = 0.0) -> Linearization:
        """The quadratic model at x (V,3): objective Hessian + stiffness · JᵀJ of the constraints + shift · I.

        ``damping`` times the Hessian of the damping terms is added to the system, not to the gradient.

        Gauss-Newton throughout: the curvature of the constraints is left out (method, section 3).
        """
        xt = np.ascontiguousarray(x.T)
        objectives, constraints, jacobians = {}, {}, {}
        at, at_gradient = 0, 0
        for name, term in self.nonlinear.items():
            residual, jacobian = term.linearize(gather(xt, term.stencil))
            objectives[name] = residual
            scaled = (2 * term.weight) * residual
            n, k = term.stencil.shape
            gradient = np.einsum("rn,rckn->ckn", scaled, jacobian)
            at_gradient = _put(self._buffer_gradient, at_gradient, gradient)
            jacobian = jacobian * np.sqrt(2 * term.weight)
            begin, at = at, _products(jacobian.reshape(len(residual), 3 * k, n), self._buffer, at)
            if name in self._edge_terms:
                pull = self._edge_terms[name].edge_stiffness(residual)
                _stiffen_edges(self._buffer[begin:at].reshape(-1, n), pull)
        for name, term in self.constraints.items():
            residual, jacobian = term.linearize(gather(xt, term.stencil))
            constraints[name], jacobians[name] = residual, jacobian
            n, k = term.stencil.shape
            self._buffer_gradient[at_gradient : at_gradient + 3 * k * n] = 0.0
            at_gradient += 3 * k * n
            at = _products((jacobian * np.sqrt(stiffness)).reshape(len(residual), 3 * k, n), self._buffer, at)
        evaluation = self._finish(x, objectives, constraints)
        values = self._scatter @ self._buffer
        values += self._constant_part(shift, damping)
        gradient = self._scatter_gradient @ self._buffer_gradient
        linear = 2 * (self._transpose @ (self._weights[:, None] * evaluation.linear))
        return Linearization(evaluation, gradient + linear.ravel(), values, jacobians)

    def _constant_part(self, shift: float, damping: float) -> FloatArray:
        """What linear terms, shift and damping add to the slots; kept while none of them changes."""
        if self._kept is None or self._kept[0] != (shift, damping):
            values = self._constant + damping * self._damping
            values[self._diagonal] += shift
            self._kept = (shift, damping), values
        return self._kept[1]

    def factorize(self, model: Linearization, rhs: FloatArray | None = None) -> None:
        """Factorise a model's Hessian, with more on the diagonal when rounding has made it indefinite.

        rhs (3V,): what ``system.solution`` will be asked for. Raises NotPositiveDefiniteError when even that does
        not help.
        """
        for extra in (0.0, *_RESCUES):
            values = model.values
            if extra:
                values = values.copy()
                values[self._diagonal] += extra
            try:
                self.system.factorize(values, rhs)
                return
            except NotPositiveDefiniteError:
                if extra == _RESCUES[-1]:
                    raise

    def transposed(self, jacobians: Mapping[str, FloatArray], multipliers: FloatArray) -> FloatArray:
        """Jᵀ λ (3V,) of the constraints."""
        self._buffer_gradient[:] = 0.0
        at_gradient = sum(3 * term.stencil.size for term in self.nonlinear.values())
        at = 0
        for name in self.constraints:
            jacobian = jacobians[name]
            r, n = jacobian.shape[0], jacobian.shape[-1]
            part = multipliers[at : at + r * n].reshape(r, n)
            at += r * n
            at_gradient = _put(self._buffer_gradient, at_gradient, np.einsum("rn,rckn->ckn", part, jacobian))
        return np.asarray(self._scatter_gradient @ self._buffer_gradient)

    def objective_by_term(self, evaluation: Evaluation) -> dict[str, float]:
        """The objective's parts by the names of the terms."""
        parts = {
            name: dot(self.nonlinear[name].weight, (residual * residual).sum(0))
            for name, residual in evaluation.objectives.items()
        }
        for name, (a, b) in self._linear_rows.items():
            rows = evaluation.linear[a:b]
            parts[name] = dot(self._weights[a:b], (rows * rows).sum(1))
        return parts


def _put(buffer: FloatArray, at: int, values: FloatArray) -> int:
    buffer[at : at + values.size] = values.ravel()
    return at + values.size


def _numbered(keys: IntArray) -> tuple[IntArray, IntArray]:
    """``np.unique`` with the inverse of keys (n,), three times as fast: each is sorted together with its place.

    Keys of 100,000 vertices, the most there may be, and their places take 62 of the 63 bits.
    """
    bits = (len(keys) - 1).bit_length()
    ordered = np.sort((keys << bits) | np.arange(len(keys)))
    place = ordered & ((1 << bits) - 1)
    ordered >>= bits
    first = np.concatenate([[True], ordered[1:] != ordered[:-1]])
    inverse = np.empty(len(keys), dtype=np.int64)
    inverse[place] = np.cumsum(first) - 1
    return ordered[first], inverse


def _dofs(stencil: IntArray) -> IntArray:
    """Scalar unknowns (3k,n), coordinate-major like a Jacobian (3,k,n), of a stencil (n,k)."""
    n, k = stencil.shape
    return (3 * stencil.T[None] + np.arange(3)[:, None, None]).reshape(3 * k, n)


def _pairs(size: int) -> tuple[IntArray, IntArray]:
    """Index pairs i <= j, i-major: the order in which ``_products`` writes."""
    i, j = np.triu_indices(size)
    return i, j


def _pair_keys(dofs: IntArray, size: int) -> IntArray:
    i, j = _pairs(len(dofs))
    a, b = dofs[i], dofs[j]
    return np.maximum(a, b) * size + np.minimum(a, b)


def _pair_counts(dofs: IntArray) -> FloatArray:
    """(pairs, n): 2 where two different places i < j are the same unknown, 1 elsewhere."""
    i, j = _pairs(len(dofs))
    return np.where((dofs[i] == dofs[j]) & (i != j)[:, None], 2.0, 1.0)


def _linear_keys(stencil: IntArray, size: int) -> IntArray:
    """Keys (pairs, n, 3): the same coordinate only."""
    i, j = _pairs(stencil.shape[1])
    a, b = stencil[:, i].T, stencil[:, j].T
    low, high = np.minimum(a, b), np.maximum(a, b)
    axis = np.arange(3)
    return (3 * high[..., None] + axis) * size + 3 * low[..., None] + axis


def _linear_products(term: LinearTerm) -> FloatArray:
    """The Hessian's entries of a linear term, aligned with its ``_linear_keys``."""
    i, j = _pairs(term.stencil.shape[1])
    products = 2 * term.weight[:, None] * term.coefficients[:, i] * term.coefficients[:, j]
    # Two different places with the same vertex count twice on the diagonal.
    same = (term.stencil[:, i] == term.stencil[:, j]) & (i != j)[None]
    return np.repeat(np.where(same, 2 * products, products).T.ravel(), 3)


def _products(jacobian: FloatArray, buffer: FloatArray, at: int) -> int:
    """Write Σ_r J_ri J_rj for all i <= j of J (r,m,n) into the buffer; returns the next free place."""
    _, m, n = jacobian.shape
    for i in range(m):
        length = (m - i) * n
        target = buffer[at : at + length].reshape(m - i, n)
        np.einsum("rn,rjn->jn", jacobian[:, i], jacobian[:, i:], out=target)
        at += length
    return at


def _stiffen_edges(products: FloatArray, stiffness: FloatArray) -> None:
    """Add stiffness (n,) times [[1, -1], [-1, 1]] in each coordinate to the products (21,n) of edges."""
    for row, sign in _EDGE_ROWS:
        if sign > 0:
            products[row] += stiffness
        else:
            products[row] -= stiffness


def _edge_rows() -> list[tuple[int, int]]:
    """Rows of the products of an edge that hold (a, a), (a, b) and (b, b) of each coordinate, and their signs."""
    i, j = _pairs(6)
    place = {pair: row for row, pair in enumerate(zip(i.tolist(), j.tolist(), strict=True))}
    return [
        (place[p, q], 1 if p == q else -1)
        for axis in range(3)
        for p, q in ((2 * axis, 2 * axis), (2 * axis, 2 * axis + 1), (2 * axis + 1, 2 * axis + 1))
    ]


_EDGE_ROWS = _edge_rows()
