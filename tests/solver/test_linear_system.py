"""The direct solver on every kind of pattern that a net can give, and on some that it cannot."""

from __future__ import annotations

import gc
import threading

import numpy as np
import pytest

import solver.optimize.linear_system as linear_system
from benchmarks.linear_system import diamond_pattern, dominant_values, time_splu
from solver.errors import NotPositiveDefiniteError
from solver.optimize.kernel import LinearAlgebra, linear_algebra
from solver.optimize.linear_system import LinearSystem
from solver.optimize.multifrontal import compiled, numeric
from solver.optimize.multifrontal.lapack import BlasThreads, LapackUnavailableError, Routines
from solver.optimize.multifrontal.ordering import dissect, vertex_graph
from solver.optimize.multifrontal.symbolic import analyse

Pattern = tuple[np.ndarray, np.ndarray, np.ndarray]


def blocks(pairs: np.ndarray, plane: np.ndarray) -> Pattern:
    """Scalar lower-triangle pattern of full 3 x 3 blocks for vertex pairs, all vertices with themselves."""
    size = len(plane)
    own = np.arange(size)
    keys = np.unique(np.concatenate([pairs.max(1) * size + pairs.min(1), own * size + own]))
    c, d = np.divmod(np.arange(9), 3)
    rows = (3 * (keys // size)[:, None] + c).ravel()
    cols = (3 * (keys % size)[:, None] + d).ravel()
    lower = rows >= cols
    return rows[lower], cols[lower], plane


def grid(width: int, height: int, spacing: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Vertex pairs of the diamond stencil and plane coordinates; ``spacing`` > 0: uneven lines."""
    rng = np.random.default_rng(7)
    i, j = np.divmod(np.arange(width * height), height)
    pairs = []
    for di in range(3):
        for dj in range(-2, 3):
            inside = (i + di < width) & (j + dj >= 0) & (j + dj < height)
            if di + abs(dj) <= 2:
                pairs.append(np.stack([np.flatnonzero(inside), ((i + di) * height + j + dj)[inside]], axis=1))
    x = np.cumsum(1 + spacing * rng.random(width))
    y = np.cumsum(1 + spacing * rng.random(height))
    return np.concatenate(pairs), np.stack([x[i], y[j]], axis=1)


def stitched() -> Pattern:
    """Two patches over each other in the plane, tied along a slanted crease."""
    pairs, plane = grid(17, 15)
    size = len(plane)
    crease = np.flatnonzero(abs(plane[:, 0] - 0.7 * plane[:, 1] - 4) < 0.8)
    ties = [np.stack([crease + a, crease + size + b], axis=1) for a in (0, 1) for b in (0, 1)]
    return blocks(np.concatenate([pairs, pairs + size, *ties]), np.concatenate([plane, plane]))


def disconnected() -> Pattern:
    pairs, plane = grid(9, 9)
    small, small_plane = grid(2, 2)
    parts, planes, count = [pairs], [plane], len(plane)
    for k in range(12):
        parts.append(small + count)
        planes.append(small_plane + 0.3 * k)
        count += len(small_plane)
    parts.append(pairs + count)
    planes.append(plane + 100.0)
    return blocks(np.concatenate(parts), np.concatenate(planes))


def long_range() -> Pattern:
    pairs, plane = grid(18, 18)
    far = np.array([[0, 323], [17, 306], [5, 300], [150, 171]])
    return blocks(np.concatenate([pairs, far]), plane)


def dense_row() -> Pattern:
    pairs, plane = grid(16, 16)
    hub = np.stack([np.full(256, 40), np.arange(256)], axis=1)
    return blocks(np.concatenate([pairs, hub]), plane)


def coincident() -> Pattern:
    """Every vertex at one place: nothing to cut in the plane, a chain in the graph."""
    chain = np.arange(199)
    return blocks(np.stack([chain, chain + 1], axis=1), np.zeros((200, 2)))


def scattered() -> Pattern:
    """A random graph at random places: no good order exists, any will do."""
    rng = np.random.default_rng(3)
    return blocks(rng.integers(0, 150, (400, 2)), rng.random((150, 2)))


def diagonal_only() -> Pattern:
    """Vertices without any neighbour, blocks without any coupling."""
    rows = np.arange(150)
    return rows, rows.copy(), np.zeros((50, 2))


PATTERNS = {
    "grid": lambda: blocks(*grid(20, 20)),
    "uneven grid": lambda: blocks(*grid(19, 21, spacing=3.0)),
    "stitched": stitched,
    "strip": lambda: blocks(*grid(150, 3)),
    "disconnected": disconnected,
    "long range": long_range,
    "dense row": dense_row,
    "coincident": coincident,
    "scattered": scattered,
    "diagonal only": diagonal_only,
    "single vertex": lambda: blocks(np.zeros((0, 2), np.int64), np.zeros((1, 2))),
    "two vertices": lambda: blocks(np.array([[0, 1]]), np.zeros((2, 2))),
    "complete": lambda: blocks(np.argwhere(np.ones((70, 70))), np.random.default_rng(0).random((70, 2))),
}


def dense(rows: np.ndarray, cols: np.ndarray, values: np.ndarray, size: int) -> np.ndarray:
    matrix = np.zeros((size, size))
    matrix[rows, cols] = values
    matrix[cols, rows] = values
    return matrix


@pytest.fixture(autouse=True)
def _without_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear_system, "linear_algebra", lambda: LinearAlgebra(None, "numpy and scipy"))


@pytest.fixture(params=["multifrontal", "kernel"])
def backend(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """The test runs once with numpy and scipy and once with the compiled kernel."""
    if request.param == "kernel":
        request.getfixturevalue("kernel_library")
        monkeypatch.setattr(linear_system, "linear_algebra", linear_algebra)
    return str(request.param)


@pytest.fixture
def eager_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """The second thread is used for systems of any size."""
    for module in (numeric, compiled):
        monkeypatch.setattr(module, "MIN_LANE_FLOPS", 0.0)


@pytest.fixture
def no_pointers(monkeypatch: pytest.MonkeyPatch) -> None:
    def unavailable() -> Routines:
        raise LapackUnavailableError("none")

    monkeypatch.setattr(linear_system, "Routines", unavailable)


@pytest.mark.parametrize("name", PATTERNS)
def test_solves_like_a_dense_solver(name: str, backend: str) -> None:
    rows, cols, plane = PATTERNS[name]()
    size = 3 * len(plane)
    shuffle = np.random.default_rng(1).permutation(len(rows))
    rows, cols = rows[shuffle], cols[shuffle]
    values = dominant_values(rows, cols, size)
    rhs = np.random.default_rng(2).standard_normal(size)
    system = LinearSystem(rows, cols, plane)
    assert system.backend == backend
    system.factorize(values)
    matrix = dense(rows, cols, values, size)
    solution = system.solve(rhs)
    assert np.abs(matrix @ solution - rhs).max() < 1e-10
    np.testing.assert_allclose(solution, np.linalg.solve(matrix, rhs), atol=1e-10)


@pytest.mark.usefixtures("backend")
def test_a_stiff_system_is_solved_to_its_condition() -> None:
    """Bending with constraints weighted 1e6 times as much, which is what the solver makes of a fold."""
    pairs, plane = grid(12, 12)
    rows, cols, _ = blocks(pairs, plane)
    rng = np.random.default_rng(5)
    size = 3 * len(plane)
    matrix = np.zeros((size, size))
    for v in range(len(plane)):
        near = np.flatnonzero(np.abs(plane - plane[v]).sum(1) < 1.5)
        dofs = (3 * near[:, None] + np.arange(3)).ravel()
        jacobian = rng.standard_normal((2, len(dofs)))
        matrix[np.ix_(dofs, dofs)] += 1e6 * jacobian.T @ jacobian + np.eye(len(dofs))
    rhs = matrix @ rng.standard_normal(size)
    system = LinearSystem(rows, cols, plane)
    system.factorize(matrix[rows, cols])
    residual = np.abs(matrix @ system.solve(rhs) - rhs).max() / np.abs(rhs).max()
    assert residual < 1e-10


@pytest.mark.parametrize("name", ["grid", "stitched", "disconnected", "long range", "single vertex"])
@pytest.mark.usefixtures("eager_threads", "backend")
def test_two_threads_give_the_same_bits_as_one(name: str) -> None:
    rows, cols, plane = PATTERNS[name]()
    size = 3 * len(plane)
    rhs = np.random.default_rng(2).standard_normal(size)
    one, two = (LinearSystem(rows, cols, plane, threads=threads) for threads in (1, 2))
    for seed in range(10):
        values = dominant_values(rows, cols, size, seed)
        one.factorize(values)
        two.factorize(values)
        assert one.solve(rhs).tobytes() == two.solve(rhs).tobytes()
        one.factorize(values, rhs)
        two.factorize(values, rhs)
        assert one.solution().tobytes() == two.solution().tobytes()


class _Fenced:
    """numpy, but what it makes of zeros lies between two fences."""

    WIDTH, FENCE = 4096, 7.25e77

    def __init__(self) -> None:
        self.fences: list[np.ndarray] = []

    def __getattr__(self, name: str) -> object:
        return getattr(np, name)

    def zeros(self, size: int, dtype: type = np.float64) -> np.ndarray:
        whole = np.full(size + 2 * self.WIDTH, self.FENCE)
        self.fences += [whole[: self.WIDTH], whole[self.WIDTH + size :]]
        inside = whole[self.WIDTH : self.WIDTH + size].view(dtype)
        inside[:] = 0
        return inside


@pytest.mark.parametrize("name", PATTERNS)
@pytest.mark.usefixtures("eager_threads")
def test_nothing_is_written_beside_the_factor(name: str, backend: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Routines are told bare addresses: what they wrote elsewhere would end Blender, minutes later."""
    rows, cols, plane = PATTERNS[name]()
    size = 3 * len(plane)
    fenced = _Fenced()
    monkeypatch.setattr({"multifrontal": numeric, "kernel": compiled}[backend], "np", fenced)
    system = LinearSystem(rows, cols, plane)
    system.factorize(dominant_values(rows, cols, size), np.ones(size))
    system.solution()
    system.solve(np.ones(size))
    # Panels, updates, two vectors, and whether pivots were positive, or the kernel's scratch.
    assert len(fenced.fences) >= 2 * 5
    assert all((fence == _Fenced.FENCE).all() for fence in fenced.fences)


def test_the_addition_of_openblas_gives_the_same_bits_as_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    rows, cols, plane = PATTERNS["grid"]()
    values = dominant_values(rows, cols, 3 * len(plane))
    solutions = []
    for addition in (numeric.Factorization._addition, None):
        if addition is None:
            monkeypatch.setattr("solver.optimize.multifrontal.lapack._addition", lambda libraries: None)
        system = LinearSystem(rows, cols, plane)
        system.factorize(values)
        solutions.append(system.solve(np.ones(3 * len(plane))))
    assert solutions[0].tobytes() == solutions[1].tobytes()


@pytest.mark.usefixtures("eager_threads", "backend")
def test_the_second_thread_ends_with_the_system() -> None:
    before = set(threading.enumerate())
    rows, cols, plane = PATTERNS["grid"]()
    system = LinearSystem(rows, cols, plane, threads=2)
    system.factorize(dominant_values(rows, cols, 3 * len(plane)))
    workers = [t for t in threading.enumerate() if t not in before and t.name.startswith("curvefold")]
    assert len(workers) == 1
    del system
    gc.collect()
    for worker in workers:
        worker.join(10.0)
        assert not worker.is_alive()


@pytest.mark.usefixtures("backend")
def test_an_indefinite_matrix_is_refused_and_a_good_one_solved_after() -> None:
    _refuses_an_indefinite_matrix()


@pytest.mark.usefixtures("no_pointers")
def test_splu_refuses_an_indefinite_matrix_too() -> None:
    _refuses_an_indefinite_matrix()


def _refuses_an_indefinite_matrix() -> None:
    rows, cols, plane = PATTERNS["stitched"]()
    size = 3 * len(plane)
    system = LinearSystem(rows, cols, plane)
    good = dominant_values(rows, cols, size)
    diagonal = np.flatnonzero(rows == cols)
    for bad_value in (-1.0, 0.0, np.nan, np.inf, -np.inf):
        for place in (diagonal[0], diagonal[size // 2], diagonal[-1]):
            bad = good.copy()
            bad[place] = bad_value
            with pytest.raises(NotPositiveDefiniteError):
                system.factorize(bad, np.ones(size))
            with pytest.raises(ValueError, match="no factor"):
                system.solve(np.ones(size))
            with pytest.raises(ValueError, match="no right-hand side"):
                system.solution()
    with pytest.raises(NotPositiveDefiniteError):
        system.factorize(-good)
    system.factorize(good)
    assert np.abs(dense(rows, cols, good, size) @ system.solve(np.ones(size)) - 1).max() < 1e-10


def test_nothing_is_left_of_a_failed_factorisation(backend: str) -> None:
    rows, cols, plane = PATTERNS["stitched"]()
    values = dominant_values(rows, cols, 3 * len(plane))
    clean, spoilt = LinearSystem(rows, cols, plane), LinearSystem(rows, cols, plane)
    implementation = spoilt._implementation
    kept = {
        "multifrontal": ("_updates", "_panels", "_vector"),
        "kernel": ("_updates", "_panels", "_vector", "_carried", "_scratch"),
    }[backend]
    for array in kept:
        getattr(implementation, array).fill(np.nan)
    solutions = []
    for system in (clean, spoilt):
        system.factorize(values)
        solutions.append(system.solve(np.ones(3 * len(plane))).tobytes())
    assert solutions[0] == solutions[1]


@pytest.mark.usefixtures("backend")
def test_an_off_diagonal_nan_is_refused() -> None:
    rows, cols, plane = PATTERNS["grid"]()
    values = dominant_values(rows, cols, 3 * len(plane))
    values[np.flatnonzero(rows != cols)[5]] = np.nan
    with pytest.raises(NotPositiveDefiniteError):
        LinearSystem(rows, cols, plane).factorize(values)


@pytest.mark.usefixtures("backend")
def test_the_pattern_is_frozen_and_the_values_are_not() -> None:
    rows, cols, plane = PATTERNS["stitched"]()
    size = 3 * len(plane)
    system = LinearSystem(rows, cols, plane)
    rhs = np.random.default_rng(0).standard_normal(size)
    for seed in (0, 1, 2):
        values = dominant_values(rows, cols, size, seed)
        values[rows != cols] *= seed > 0  # zeros do not change the pattern
        system.factorize(values)
        for _ in range(2):
            residual = dense(rows, cols, values, size) @ system.solve(rhs) - rhs
            assert np.abs(residual).max() < 1e-10


@pytest.mark.parametrize("name", ["stitched", "strip", "disconnected", "dense row"])
@pytest.mark.usefixtures("backend")
def test_half_a_solution_on_the_way_gives_the_same_bits_as_a_whole_one_after(name: str) -> None:
    rows, cols, plane = PATTERNS[name]()
    size = 3 * len(plane)
    system = LinearSystem(rows, cols, plane)
    values, rhs = dominant_values(rows, cols, size), np.random.default_rng(2).standard_normal(size)
    system.factorize(values, rhs)
    fused = system.solution()
    system.factorize(values)
    assert fused.tobytes() == system.solve(rhs).tobytes()


@pytest.mark.usefixtures("backend")
def test_a_solution_is_given_once_and_not_after_another() -> None:
    rows, cols, plane = PATTERNS["grid"]()
    size = 3 * len(plane)
    system = LinearSystem(rows, cols, plane)
    values = dominant_values(rows, cols, size)
    system.factorize(values, np.ones(size))
    system.solution()
    with pytest.raises(ValueError, match="no right-hand side"):
        system.solution()
    system.factorize(values, np.ones(size))
    system.solve(np.zeros(size))
    with pytest.raises(ValueError, match="no right-hand side"):
        system.solution()
    assert system.solves == 2


@pytest.mark.usefixtures("backend")
def test_counters() -> None:
    rows, cols, plane = PATTERNS["grid"]()
    size = 3 * len(plane)
    system = LinearSystem(rows, cols, plane)
    assert (system.factorizations, system.solves) == (0, 0)
    system.factorize(dominant_values(rows, cols, size))
    system.solve(np.ones(size))
    system.solve(np.zeros(size))
    assert (system.factorizations, system.solves) == (1, 2)
    assert size * 10 < system.factor_nonzeros < size * size / 2
    assert 1e6 < system.flops < size**3 / 3


def test_splu_stands_in_where_there_are_no_pointers(no_pointers: None) -> None:
    rows, cols, plane = PATTERNS["stitched"]()
    size = 3 * len(plane)
    values, rhs = dominant_values(rows, cols, size), np.random.default_rng(4).standard_normal(size)
    system = LinearSystem(rows, cols, plane)
    assert system.backend == "splu"
    system.factorize(values)
    np.testing.assert_allclose(system.solve(rhs), np.linalg.solve(dense(rows, cols, values, size), rhs), atol=1e-10)
    assert system.factor_nonzeros > size


def test_fewer_operations_than_a_band_would_take() -> None:
    rows, cols, plane = diamond_pattern(40)
    system = LinearSystem(rows, cols, plane)
    bandwidth = 3 * 2 * 40
    assert system.flops < 0.6 * 3 * len(plane) * bandwidth**2


def test_a_straight_strip_costs_in_proportion_to_its_length() -> None:
    flops = [LinearSystem(*blocks(*grid(length, 4))).flops for length in (200, 400)]
    assert flops[1] < 2.3 * flops[0]


@pytest.mark.parametrize("name", PATTERNS)
def test_every_vertex_is_eliminated_once_and_borders_lie_later(name: str) -> None:
    rows, cols, plane = PATTERNS[name]()
    graph = vertex_graph(rows // 3, cols // 3, len(plane))
    symbolic = analyse(graph, dissect(graph, plane))
    assert sorted(symbolic.position) == list(range(len(plane)))
    parents = np.full(len(symbolic.fronts), -1)
    for i, front in enumerate(symbolic.fronts):
        assert (front.border >= front.stop).all()
        for child in front.children:
            assert child < i
            assert parents[child] == -1
            parents[child] = i
            inside = np.concatenate([np.arange(front.start, front.stop), front.border])
            assert np.isin(symbolic.fronts[child].border, inside).all()
    for i, front in enumerate(symbolic.fronts):
        assert (parents[i] == -1) == (len(front.border) == 0)


@pytest.mark.parametrize(
    ("rows", "cols", "plane"),
    [
        ([0, 1, 2], [0, 1, 2], np.zeros((0, 2))),
        ([0, 1], [0, 1], np.zeros((1, 2))),
        ([0, 1, 2, 0], [0, 1, 2, 1], np.zeros((1, 2))),
        ([0, 1, 2, 3], [0, 1, 2, 0], np.zeros((1, 2))),
        ([0, 1, 2, 2, 2], [0, 1, 2, 0, 0], np.zeros((1, 2))),
        ([0, 1, 2], [0, 1, 2], np.full((1, 2), np.nan)),
        ([0, 1, 2], [0, 1], np.zeros((1, 2))),
    ],
)
def test_a_pattern_that_is_no_lower_triangle_is_refused(
    rows: list[int], cols: list[int], plane: np.ndarray
) -> None:
    with pytest.raises(ValueError, match=r"rows|plane"):
        LinearSystem(np.array(rows), np.array(cols), plane)


@pytest.mark.usefixtures("backend")
def test_wrong_shapes_are_refused() -> None:
    system = LinearSystem(np.arange(3), np.arange(3), np.zeros((1, 2)))
    with pytest.raises(ValueError, match="values"):
        system.factorize(np.ones(4))
    system.factorize(np.ones(3))
    with pytest.raises(ValueError, match="rhs"):
        system.solve(np.ones(4))
    with pytest.raises(ValueError, match="rhs"):
        system.factorize(np.ones(3), np.ones(4))


def test_blas_threads_are_given_back() -> None:
    threads = Routines().blas_threads
    if not threads.available:
        pytest.skip("scipy's BLAS does not say how many threads it runs")
    assert isinstance(threads, BlasThreads)
    assert threads._get is not None
    before = threads._get()
    with threads.single(), threads.single():
        assert threads._get() == 1
    assert threads._get() == before


def test_splu_can_be_timed_on_the_same_matrix() -> None:
    rows, cols, plane = PATTERNS["grid"]()
    size = 3 * len(plane)
    assert time_splu(rows, cols, dominant_values(rows, cols, size), np.ones(size)) > 0
