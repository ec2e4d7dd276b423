"""The independent check: it passes what is exact, and each of its parts fails when just that is spoilt."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

import solver
from solver.verify import verify


@pytest.fixture(scope="module")
def folded(drawings: ModuleType) -> solver.FoldResult:
    plain = drawings.off_centre()
    # Not at the origin and not of size 1: places must come back in these units.
    pattern = solver.CreasePattern(
        plain.boundary * 40 + (300, -70),
        creases=[solver.Crease(c.points * 40 + (300, -70)) for c in plain.creases],
    )
    return solver.fold(pattern, solver.FoldDescription(resolution=16, angle=50.0))


def checks(net: solver.PiecewiseDog, x: np.ndarray) -> set[str]:
    return {fault.check for fault in verify(net, x).faults}


def test_a_settled_fold_passes(folded: solver.FoldResult) -> None:
    result = verify(folded.net, folded.positions)
    assert result.ok, result.faults
    assert folded.status is solver.Outcome.FOLDED
    assert folded.report()["verification"] == result.to_json()
    assert result.figures["stretch_mean"] == pytest.approx(folded.measurement.stretch.mean(), rel=1e-9)


def test_exact_states_pass_and_the_same_sheet_bent_without_a_fold_does_not(exact: ModuleType) -> None:
    """States in closed form, made by no solver."""
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 40)
    result = verify(net, state.positions(net))
    assert result.ok, result.faults
    assert result.figures["angle_gap_max"] < 1e-6
    assert checks(net, state.bent(net)) == {"sides"}
    flat = np.column_stack([net.rest, np.zeros(len(net.rest))])
    assert checks(net, flat) == {"sides"}


# --- every check fails when its own matter is spoilt ----------------------------------------------------


def lost(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    x[7, 1] = np.nan


def stretched_everywhere(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    x *= 1.004


def stretched_in_one_place(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    centre, right = net.stars[len(net.stars) // 2, :2]
    x[right] += 0.3 * (x[right] - x[centre])


def sheared(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    """Lengths along the grid stay, its angles do not."""
    centre, right, up = net.stars[len(net.stars) // 2, :3]
    x[right] += 0.02 * (x[up] - x[centre])


def torn(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    """One patch moved off its neighbour: nothing is wrong inside either."""
    x[net.vertex_patch == 0] += (0, 0, 0.03 * net.frame.unit)


def torn_a_little_everywhere(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    x[net.vertex_patch == 0] += (0, 0, 0.006 * net.frame.unit)


def unfolded(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    x[:] = np.column_stack([net.rest, np.zeros(len(net.rest))])


def doubled_over(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    """Flat paper folded shut along a grid line where no crease is."""
    unfolded(net, x)
    line = np.median(np.unique(net.rest[:, 0].round(9)))
    over = x[:, 0] > line
    x[over, 0] = 2 * line - x[over, 0]


def crossed(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    """Two corners of a quad change places."""
    a, b = net.quads[len(net.quads) // 2, :2]
    x[[a, b]] = x[[b, a]]


def vanished(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    x[net.quads[3]] = x[net.quads[3]].mean(axis=0)


def squeezed(net: solver.PiecewiseDog, x: np.ndarray) -> None:
    """Across the creases, so that their points come too near."""
    x[:, 0] = 0.4 * x[:, 0]


#: What is done, and the checks that must notice; others may notice too.
SPOILT: dict[Callable[[solver.PiecewiseDog, np.ndarray], None], set[str]] = {
    lost: {"finite"},
    stretched_everywhere: {"isometry"},
    stretched_in_one_place: {"isometry", "angles"},
    sheared: {"angles"},
    torn: {"continuity"},
    torn_a_little_everywhere: {"continuity"},
    unfolded: {"sides"},
    doubled_over: {"quads"},
    crossed: {"quads", "isometry"},
    vanished: {"quads", "isometry"},
    squeezed: {"crease points", "isometry"},
}
#: Spoils that are about one thing alone: no other check may notice.
ALONE = (lost, stretched_everywhere, torn_a_little_everywhere, unfolded)


@pytest.mark.parametrize("spoil", SPOILT, ids=lambda spoil: spoil.__name__)
def test_a_spoilt_state_is_noticed(
    folded: solver.FoldResult, spoil: Callable[[solver.PiecewiseDog, np.ndarray], None]
) -> None:
    x = folded.positions.copy()
    spoil(folded.net, x)
    found = checks(folded.net, x)
    assert found >= SPOILT[spoil]
    if spoil in ALONE:
        assert found == SPOILT[spoil]


def test_a_crease_point_off_its_place_is_noticed(folded: solver.FoldResult) -> None:
    points = folded.net.crease_points
    moved = points.position.copy()
    moved[5] += (0.01, 0.0)
    net = replace(folded.net, crease_points=replace(points, position=moved))
    assert "crease points" in checks(net, folded.positions)


def test_a_fault_has_its_place_in_the_drawings_units(folded: solver.FoldResult) -> None:
    net, x = folded.net, folded.positions.copy()
    centre, right = net.stars[4, :2]
    x[right] += 0.3 * (x[right] - x[centre])
    fault = next(f for f in verify(net, x).faults if f.check == "isometry")
    assert fault.place == pytest.approx(net.rest[[centre, right]].mean(axis=0))
    assert "stretched" in str(fault)
    assert f"{fault.place[0]:.6g}" in str(fault)


def test_positions_of_another_shape_are_refused(folded: solver.FoldResult) -> None:
    with pytest.raises(ValueError, match="positions"):
        verify(folded.net, folded.positions[:-1])


def test_a_shape_that_does_not_pass_is_not_called_folded(
    folded: solver.FoldResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.modules["solver.verify"], "MAX_MEAN_STRETCH", 0.0)
    result = solver.fold(folded.pattern, folded.description)
    assert result.status is solver.Outcome.UNCERTIFIED
    assert "stretched" in result.detail
    assert len(result.detail.splitlines()) == 1
