"""The shape of one net for another."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import solver
from solver.net.carry_over import carry_over, scaled


def flat(net: solver.PiecewiseDog) -> np.ndarray:
    return np.column_stack([net.rest, np.zeros(len(net.rest))])


def turned(points: np.ndarray) -> np.ndarray:
    """Some rigid motion of flat points (N,2)."""
    c, s = np.cos(0.7), np.sin(0.7)
    return np.column_stack([c * points[:, 0], points[:, 1] + 0.3, s * points[:, 0] - 0.1])


def test_a_flat_sheet_stays_exactly_flat(drawings: ModuleType) -> None:
    old = solver.build_net(drawings.one_arc(), 10)
    new = solver.build_net(drawings.two_arcs(), 17)
    assert np.array_equal(carry_over(old, flat(old), new), flat(new))


def test_the_same_net_keeps_its_shape(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 16)
    positions = state.positions(net)
    assert carry_over(net, positions, net) == pytest.approx(positions, abs=1e-12)


def test_another_resolution_shows_the_same_fold(exact: ModuleType) -> None:
    """Both sides of the crease come from their own side: the error falls with the square of the cells."""
    state = exact.sine(1.5)
    errors = []
    for resolution in (12, 24):
        old = solver.build_net(state.pattern(), resolution)
        new = solver.build_net(state.pattern(), 31)
        errors.append(np.abs(carry_over(old, state.positions(old), new) - state.positions(new)).max())
    assert errors[0] < 0.05
    assert errors[1] < 0.4 * errors[0]


def test_a_rigid_motion_is_carried_exactly_even_beyond_the_old_sheet(drawings: ModuleType) -> None:
    old = solver.build_net(drawings.one_arc(), 12)
    larger = solver.CreasePattern(drawings.rectangle(1.5, 1.4) - 0.2, (), drawings.two_arcs().creases)
    slanted = solver.CreasePattern(
        [(0, 0), (1.0, 0.2), (0.8, 1.2), (-0.2, 1.0)], (), [drawings.curve([(-0.1, 0.5), (0.9, 0.7)], 0.1)]
    )
    for pattern in (larger, slanted):
        new = solver.build_net(pattern, 14)
        assert carry_over(old, turned(old.rest), new) == pytest.approx(turned(new.rest), abs=1e-9)


def test_a_new_crease_divides_a_patch_without_moving_it(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    old = solver.build_net(state.pattern(), 24)
    pattern = state.pattern()
    across = solver.Crease([(0.1, -1.0), (0.2, 1.0)])
    new = solver.build_net(solver.CreasePattern(pattern.boundary, (), [*pattern.creases, across]), 24)
    assert len(new.patch_polygons) == 4
    assert np.abs(carry_over(old, state.positions(old), new) - state.positions(new)).max() < 0.02


def test_a_moved_crease_stays_folded_and_whole(exact: ModuleType) -> None:
    """Each patch takes its shape from the one it overlaps; at the new crease the two meet nearly."""
    state = exact.sine(1.5)
    old = solver.build_net(state.pattern(), 24)
    pattern = state.pattern()
    lifted = solver.Crease(pattern.creases[0].points + np.array([0.0, 0.04]))
    new = solver.build_net(solver.CreasePattern(pattern.boundary, (), [lifted]), 24)
    positions = carry_over(old, state.positions(old), new)
    measurement = solver.measure(new, positions)
    assert measurement.continuity.max() < 1.0
    assert measurement.folded.all()


def test_scaled_is_the_same_net_in_other_units(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 16)
    large = scaled(net, 100.0)
    positions = state.positions(net)
    at = (0.31, -0.42)
    (vertices, weights), (same, alike) = net.locate(at), large.locate((100 * at[0], 100 * at[1]))
    assert np.array_equal(vertices, same)
    assert weights == pytest.approx(alike, abs=1e-9)
    first, second = solver.measure(net, positions), solver.measure(large, 100 * positions)
    assert first.stretch == pytest.approx(second.stretch, abs=1e-12)
    assert 100 * first.crease_position == pytest.approx(second.crease_position)
    assert 100 * net.render_map.uv == pytest.approx(large.render_map.uv)
    assert [100**2 * polygon.area for polygon in net.patch_polygons] == pytest.approx(
        [polygon.area for polygon in large.patch_polygons]
    )
