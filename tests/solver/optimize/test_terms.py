"""Every term against finite differences, and the assembled system against a dense sum over stencils."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

import solver
import solver.constraints
import solver.objectives
from solver.constraints.orthogonal_geodesic import LinkAngles, StarAngles
from solver.controls.amount import Amount
from solver.controls.angle import Angle
from solver.controls.control import Control
from solver.controls.curve import Curve
from solver.controls.glue import Glue
from solver.controls.keep import Keep
from solver.controls.pair import Pair
from solver.controls.registry import BY_NAME, KINDS
from solver.controls.side import Side
from solver.drive import AngleDrive
from solver.objectives.bending import bending
from solver.objectives.continuity import continuity
from solver.objectives.fold_angle import driven_points, fold_angle
from solver.objectives.fold_condition import fold_condition
from solver.objectives.handles import AxisHandles, handles
from solver.objectives.isometry import isometry
from solver.objectives.signed_fold import signed_fold, signed_points
from solver.optimize.assembly import Problem
from solver.optimize.term import LinearTerm, ResidualTerm, gather

Term = ResidualTerm | LinearTerm

PLACES = [(0.1, 0.1), (0.5, 0.52), (0.93, 0.4), (1.0, 1.0), (0.0, 0.45)]

#: Two of the net's creases, flat patches, borders: examples of every kind of control.
EXAMPLES: tuple[Control, ...] = (
    Amount(1, 0.5),
    Side(1, "V"),
    Side(2, "M"),
    Angle(40.0, crease=1),
    Angle(-70.0, crease=2, signed=True),
    Pair((0.1, 0.1), (0.9, 0.15)),
    Pair((0.1, 0.1), (0.9, 0.8), axes=(True, False, True)),
    Pair((0.0, 1.0), (1.0, 0.2), distance=0.6),
    Keep((0.1, 0.1)),
    Curve(1, curvature_times=1.3, torsion_plus=0.4),
    Glue(((0.0, 0.2), (0.0, 0.8)), ((1.0, 0.2), (1.0, 0.8))),
)
#: Files beside the terms that hold none.
NO_TERMS = ("solver.objectives.bounded",)
#: All terms but those of the controls, which the registry tells. A new file of terms must have one here or there.
NAMES = (
    "bending",
    "border bending",
    "isometry",
    "continuity",
    "handles",
    "handles on axes",
    "fold condition",
    "fold angle",
    "least fold",
    "star angles",
    "border angles",
)
#: What asks a flat sheet to move.
MOVING = ("handles", "handles on axes", "fold angle", "least fold")
STATES = ("flat", "bent", "random")


def terms_by_module(net: solver.PiecewiseDog) -> dict[str, list[Term]]:
    located = [net.locate(place) for place in PLACES]
    targets = np.random.default_rng(1).normal(size=(len(PLACES), 3))
    points = np.array([v for v, _ in located]), np.array([w for _, w in located])
    # Slanting axes; the first handle is free along one of them.
    axes = np.linalg.qr(np.random.default_rng(2).normal(size=(len(PLACES), 3, 3)))[0].transpose(1, 0, 2)
    axes[2, 0] = 0.0
    angles = np.linspace(20.0, 140.0, len(driven_points(net)))
    return {
        "solver.objectives.bending": list(bending(net, 1.3)),
        "solver.objectives.isometry": [isometry(net, 20000.0)],
        "solver.objectives.continuity": [continuity(net, 1e4)],
        "solver.objectives.handles": [
            handles(*points, targets, np.full(len(PLACES), 5.0)),
            AxisHandles(*points, targets, axes, np.full(len(PLACES), 3.0)),
        ],
        "solver.objectives.fold_condition": [fold_condition(net, 0.7)],
        "solver.objectives.fold_angle": [fold_angle(net, angles, 400.0)],
        "solver.objectives.signed_fold": [_least_fold(net)],
        "solver.constraints.orthogonal_geodesic": [StarAngles(net.stars), LinkAngles(net.links)],
    }


def _least_fold(net: solver.PiecewiseDog) -> Term:
    points = signed_points(net)
    return signed_fold(net, points, np.full(len(points), 30.0), 1, 2.0, "least fold")


def control_terms(net: solver.PiecewiseDog, kind: str) -> list[Term]:
    """The terms of the examples of one kind, with targets that the flat sheet does not meet."""
    x = np.column_stack([net.flat, np.zeros(len(net.flat))])
    entry = next(entry for entry in KINDS if entry.control.kind == kind)
    pull = entry.pull(net, solver.Weights(), AngleDrive(net, 100.0))
    pull.set([(kind, control) for control in EXAMPLES if control.kind == kind], x)
    for _ in range(20):
        pull.move(x, 1.0)
    return pull.terms()


@pytest.fixture(scope="module")
def net(drawings: ModuleType) -> solver.PiecewiseDog:
    """Everything at once: two creases that cross, a hole (re-entrant corners), 8 cells a side."""
    square = np.array([(0.62, 0.1), (0.88, 0.1), (0.88, 0.3), (0.62, 0.3)])
    plain = drawings.crossing()
    return solver.build_net(solver.CreasePattern(boundary=plain.boundary, holes=[square], creases=plain.creases), 8)


@pytest.fixture(scope="module")
def terms(net: solver.PiecewiseDog) -> dict[str, Term]:
    return {term.name: term for group in terms_by_module(net).values() for term in group}


def shape(net: solver.PiecewiseDog, state: str) -> np.ndarray:
    """Net positions (V,3), net units."""
    x, y = net.flat.T
    if state == "flat":
        return np.column_stack([x, y, 0 * x])
    if state == "bent":
        # Different cylinders in different patches: every crease point is bent or folded, none is flat.
        curl = 0.05 + 0.02 * net.vertex_patch
        return np.column_stack([np.sin(curl * x) / curl, y, (1 - np.cos(curl * x)) / curl + 0.01 * x * y])
    rng = np.random.default_rng(11)
    return np.column_stack([x, y, 0 * x]) + rng.uniform(-0.3, 0.3, (len(x), 3))


def derivative(function: Callable[[float], np.ndarray], step: float) -> np.ndarray:
    """Of fourth order in the step, at 0."""
    near = function(step) - function(-step)
    far = function(2 * step) - function(-2 * step)
    return (8 * near - far) / (12 * step)


def jacobian_by_differences(term: Term, x: np.ndarray) -> np.ndarray:
    """(r,3,k,n): the places of a stencil are independent of each other, and all stencils go at once."""
    here = gather(np.ascontiguousarray(x.T), term.stencil)
    columns = []
    for c in range(3):
        for k in range(here.shape[1]):

            def moved(step: float, c: int = c, k: int = k) -> np.ndarray:
                there = here.copy()
                there[c, k] += step
                return term.residual(there)

            columns.append(derivative(moved, 1e-5))
    r, n = columns[0].shape
    return np.array(columns).reshape(3, here.shape[1], r, n).transpose(2, 0, 1, 3)


def test_every_file_of_terms_is_tested_here(
    net: solver.PiecewiseDog, terms: dict[str, Term], drawings: ModuleType
) -> None:
    assert {control.kind for control in EXAMPLES} == set(BY_NAME), "a kind of control has no example"
    controlled = [term for kind in BY_NAME for term in control_terms(net, kind)]
    tested = {*terms_by_module(net), *(type(term).__module__ for term in controlled), *NO_TERMS}
    for package in (solver.objectives, solver.constraints):
        for module in pkgutil.iter_modules(package.__path__, package.__name__ + "."):
            assert module.name in tested, f"{module.name} has no finite-difference test"
            importlib.import_module(module.name)
    assert set(terms) == set(NAMES)
    model = solver.FoldModel(net)
    model.set_handles([solver.Handle(at=place, target=(*place, 0.1)) for place in PLACES])
    model.set_fold_angle(30)
    model.set_controls(EXAMPLES)
    names = set(model.advance(1).objective)
    assert names <= set(terms) | {term.name for term in controlled}
    assert {term.name for term in controlled} <= names


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("kind", BY_NAME)
def test_jacobian_of_a_control_is_the_derivative_of_its_residual(
    net: solver.PiecewiseDog, kind: str, state: str
) -> None:
    terms = control_terms(net, kind)
    assert terms or kind == "amount"
    assert len({term.name for term in terms}) == len(terms)
    x = np.ascontiguousarray(shape(net, state).T)
    for term in terms:
        residual, jacobian = term.linearize(gather(x, term.stencil))
        assert np.array_equal(residual, term.residual(gather(x, term.stencil)))
        expected = jacobian_by_differences(term, x.T)
        scale = np.abs(expected).max()
        assert scale > 0.1 or (term.name, state) == ("angles", "flat")
        assert np.abs(jacobian - expected).max() < 1e-6 * max(scale, 1.0), term.name


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("name", NAMES)
def test_jacobian_is_the_derivative_of_the_residual(
    net: solver.PiecewiseDog, terms: dict[str, Term], name: str, state: str
) -> None:
    term, x = terms[name], shape(net, state)
    assert len(term.stencil) > 0
    residual, jacobian = term.linearize(gather(np.ascontiguousarray(x.T), term.stencil))
    assert np.array_equal(residual, term.residual(gather(np.ascontiguousarray(x.T), term.stencil)))
    expected = jacobian_by_differences(term, x)
    assert jacobian.shape == expected.shape
    scale = np.abs(expected).max()
    # A flat crease is a minimum or maximum of its own angle: there, and only there, nothing pulls.
    assert scale > 0.1 or (name, state) == ("fold angle", "flat")
    assert np.abs(jacobian - expected).max() < 1e-6 * max(scale, 1.0)


@pytest.mark.parametrize("name", [n for n in NAMES if n not in MOVING])
def test_a_flat_sheet_satisfies_every_term_that_asks_for_no_move(
    net: solver.PiecewiseDog, terms: dict[str, Term], name: str
) -> None:
    x = np.ascontiguousarray(shape(net, "flat").T)
    assert np.abs(terms[name].residual(gather(x, terms[name].stencil))).max() < 1e-7


@pytest.mark.parametrize("name", [n for n in NAMES if not n.startswith("handles")])
def test_a_term_does_not_feel_a_rigid_motion(net: solver.PiecewiseDog, terms: dict[str, Term], name: str) -> None:
    term, x = terms[name], shape(net, "random")
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    moved = x @ turn.T + np.array([3.0, -7.0, 2.0])
    before = term.residual(gather(np.ascontiguousarray(x.T), term.stencil))
    after = term.residual(gather(np.ascontiguousarray(moved.T), term.stencil))
    # Vector-valued residuals turn with the sheet, scalar ones stay.
    sizes = (np.linalg.norm(r, axis=0) if name in ("bending", "border bending", "continuity") else r
             for r in (before, after))  # fmt: skip
    first, second = sizes
    assert second == pytest.approx(first, abs=1e-9 * max(1.0, np.abs(first).max()))


def test_the_fold_angle_asks_for_the_angle_of_the_lemma(exact: ModuleType) -> None:
    """On a straight fold by theta every edge satisfies <t1,t2> = cos² alpha + sin² alpha cos theta."""
    pattern = solver.CreasePattern(
        boundary=[(-1, -1), (1, -1), (1, 1), (-1, 1)],
        creases=[solver.Crease(points=[(-0.31, -1), (0.47, 1)])],
    )
    net = solver.build_net(pattern, 8)
    start, end = net.frame.to_net(pattern.creases[0].points)
    along = (end - start) / np.hypot(*(end - start))
    across = np.array([-along[1], along[0]])
    inside = net.frame.to_net(np.array([np.array(p.representative_point().coords[0]) for p in net.patch_polygons]))
    left = ((inside - start) @ across > 0)[net.vertex_patch]
    u, v = (net.flat - start) @ along, (net.flat - start) @ across
    for theta in (15.0, 60.0, 120.0):
        half = np.radians(theta / 2)
        x = np.column_stack(
            [
                start + u[:, None] * along + (np.cos(half) * v)[:, None] * across,
                np.where(left, v, -v) * np.sin(half),
            ]
        )
        count = len(driven_points(net))
        assert count >= 8
        for asked, met in ((theta, True), (theta + 10, False), (theta - 10, False)):
            term = fold_angle(net, np.full(count, asked), 1.0)
            residual = np.abs(term.residual(gather(np.ascontiguousarray(x.T), term.stencil)))
            assert (residual.max() < 1e-6) if met else (residual.min() > 1e-3)


def test_the_fold_condition_vanishes_on_a_fold_and_not_on_a_bend(exact: ModuleType) -> None:
    state = exact.Prism(1.25, (0.5, 0.5, 0.25, 0.125, -0.25, -0.125, -0.5, -0.25, 0.5, 0.25), 4, 10)
    net = state.net()
    term = fold_condition(net, 1.0)
    folded = net.frame.to_net(state.positions(net))
    assert np.abs(term.residual(gather(np.ascontiguousarray(folded.T), term.stencil))).max() < 1e-6
    bend = exact.sine(1.5)
    net = solver.build_net(bend.pattern(), 16)
    term = fold_condition(net, 1.0)
    bent = net.frame.to_net(bend.bent(net))
    residual = np.abs(term.residual(gather(np.ascontiguousarray(bent.T), term.stencil)))
    # All but the few edges whose own chord carries the crease's three points.
    assert (residual > 1.0).mean() > 0.75


# --- assembled ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def problem(net: solver.PiecewiseDog, terms: dict[str, Term]) -> Problem:
    constraints = [terms["star angles"], terms["border angles"]]
    return Problem([t for t in terms.values() if t not in constraints], constraints, net.flat, bending(net, 1.0))


def dense_hessian(term: Term, x: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """The sum of weight JᵀJ over a term's stencils, one stencil after the other."""
    size = x.size
    total = np.zeros((size, size))
    _, jacobian = term.linearize(gather(np.ascontiguousarray(x.T), term.stencil))
    for n, vertices in enumerate(term.stencil):
        unknowns = (3 * vertices[None] + np.arange(3)[:, None]).ravel()
        rows = jacobian[..., n].reshape(len(jacobian), -1)
        np.add.at(total, np.ix_(unknowns, unknowns), weight[n] * rows.T @ rows)
    return total


def stretched_strings(isometry: Term, x: np.ndarray) -> np.ndarray:
    """The positive part of Σ 2 w r ∇²r with r = |e|² - l²: 4 w r for each coordinate of a stretched edge."""
    total = np.zeros((x.size, x.size))
    for (a, b), rest, weight in zip(isometry.stencil, isometry.rest_squared, isometry.weight, strict=True):
        pull = 4 * weight * max(float(np.sum((x[b] - x[a]) ** 2)) - rest, 0.0)
        for axis in range(3):
            i, j = 3 * a + axis, 3 * b + axis
            total[np.ix_([i, j], [i, j])] += pull * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return total


@pytest.mark.parametrize("state", STATES)
def test_gradient_is_the_derivative_of_the_objective(
    net: solver.PiecewiseDog, problem: Problem, state: str
) -> None:
    x = shape(net, state)
    gradient = problem.linearize(x, 1e3, 0.0).gradient
    rng = np.random.default_rng(2)
    for _ in range(8):
        direction = rng.normal(size=x.shape)

        def objective(step: float, direction: np.ndarray = direction) -> np.ndarray:
            return np.float64(problem.evaluate(x + step * direction).objective)

        slope = float(derivative(objective, 2e-6))
        assert gradient @ direction.ravel() == pytest.approx(slope, rel=1e-6, abs=1e-6 * np.abs(gradient).max())


@pytest.mark.parametrize("state", STATES)
def test_matrix_is_the_dense_sum_over_all_stencils(
    net: solver.PiecewiseDog, problem: Problem, terms: dict[str, Term], state: str
) -> None:
    x = shape(net, state)
    stiffness, shift, damping = 300.0, 0.25, 2.0
    expected = shift * np.eye(x.size)
    for name, term in terms.items():
        if name in ("star angles", "border angles"):
            expected += dense_hessian(term, x, np.full(len(term.stencil), stiffness))
        else:
            expected += dense_hessian(term, x, 2 * term.weight)
    expected += stretched_strings(terms["isometry"], x)
    for term in bending(net, 1.0):
        expected += damping * dense_hessian(term, x, 2 * term.weight)
    model = problem.linearize(x, stiffness, shift, damping)
    assembled = np.zeros((x.size, x.size))
    assembled[problem.rows, problem.columns] = model.values
    assert (problem.rows >= problem.columns).all()
    assert np.abs(assembled - np.tril(expected)).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("state", STATES)
def test_transposed_constraint_jacobian_is_that_of_their_differences(
    net: solver.PiecewiseDog, problem: Problem, terms: dict[str, Term], state: str
) -> None:
    x = shape(net, state)
    model = problem.linearize(x, 1.0, 0.0)
    rng = np.random.default_rng(4)
    step, multipliers = rng.normal(size=x.shape), rng.normal(size=len(model.evaluation.constraint))
    small = 1e-6
    ahead, behind = (problem.evaluate(x + s * small * step).constraint for s in (1, -1))
    forward = (ahead - behind) / (2 * small)
    back = problem.transposed(model.jacobians, multipliers)
    assert multipliers @ forward == pytest.approx(back @ step.ravel(), rel=1e-6, abs=1e-6)


def test_the_pattern_is_the_same_at_every_state(net: solver.PiecewiseDog, problem: Problem) -> None:
    rows, columns = problem.rows.copy(), problem.columns.copy()
    for state in STATES:
        values = problem.linearize(shape(net, state), 1.0, 0.0).values
        assert values.shape == rows.shape
    assert np.array_equal(rows, problem.rows)
    assert np.array_equal(columns, problem.columns)
    # Entries that happen to be zero on the flat sheet have their slots all the same.
    flat, bent = (problem.linearize(shape(net, s), 1.0, 0.0).values for s in ("flat", "random"))
    assert ((flat == 0) & (bent != 0)).any()


def test_a_replaced_term_gives_the_matrix_of_a_new_problem(
    net: solver.PiecewiseDog, terms: dict[str, Term]
) -> None:
    names = [n for n in NAMES if n not in ("star angles", "border angles")]
    constraints = [terms["star angles"], terms["border angles"]]
    x = shape(net, "random")
    changed = {
        "fold angle": fold_angle(net, np.full(len(driven_points(net)), 77.0), 123.0),
        "handles": LinearTerm(
            "handles",
            terms["handles"].stencil,
            terms["handles"].coefficients,  # type: ignore[union-attr]
            np.ones((len(PLACES), 3)),
            np.full(len(PLACES), 50.0),
        ),
    }
    old = Problem([terms[n] for n in names], constraints, net.flat)
    old.replace(changed)
    new = Problem([changed.get(n, terms[n]) for n in names], constraints, net.flat)
    first, second = old.linearize(x, 1.0, 0.1), new.linearize(x, 1.0, 0.1)
    assert np.array_equal(old.rows, new.rows)
    assert second.values == pytest.approx(first.values, rel=1e-12, abs=1e-9)
    assert second.gradient == pytest.approx(first.gradient, rel=1e-12, abs=1e-9)
    assert second.evaluation.objective == pytest.approx(first.evaluation.objective)
