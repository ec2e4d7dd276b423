"""Rulings of exact states: straight lines where paper has them, none where it is plane."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
import shapely

import solver
from solver import RulingKind, rulings
from solver.rulings import _kinds


def directions(found: object) -> np.ndarray:
    step = found.flat[:, 1] - found.flat[:, 0]  # type: ignore[attr-defined]
    return step / np.hypot(*step.T)[:, None]


def off_vertical(found: object) -> np.ndarray:
    """Degrees between the rulings and the y axis."""
    return np.degrees(np.arcsin(np.abs(directions(found)[:, 0])))


def off_centre(found: object) -> np.ndarray:
    """Degrees between the rulings and the direction to the origin."""
    middle = found.flat.mean(axis=1)  # type: ignore[attr-defined]
    outward = middle / np.hypot(*middle.T)[:, None]
    d = directions(found)
    return np.degrees(np.arcsin(np.abs(d[:, 0] * outward[:, 1] - d[:, 1] * outward[:, 0])))


def flat_sheet(net: solver.PiecewiseDog) -> np.ndarray:
    return np.column_stack([net.rest, np.zeros(len(net.rest))])


def cone(exact: ModuleType) -> object:
    return exact.Pleats(np.radians(60), (1.0, 1.5), 0.5, 2.0, 0.9)


@pytest.mark.parametrize("b", [3.0, 1.5, 1.0])
def test_rulings_of_a_are_parallel(exact: ModuleType, b: float) -> None:
    state = exact.sine(b)
    errors = []
    for resolution in (12, 24, 48):
        net = solver.build_net(state.pattern(), resolution)
        found = rulings(net, state.positions(net))
        assert len(found.flat) > 40
        assert set(found.kind) == {RulingKind.CYLINDRICAL}
        assert set(found.patch) == {0, 1}
        errors.append(off_vertical(found).mean())
    assert errors[2] < 0.5 * errors[0]
    assert errors[2] < 0.06


def test_rulings_of_b_are_concurrent(exact: ModuleType) -> None:
    state = cone(exact)
    errors = []
    for resolution in (16, 32, 64):
        net = solver.build_net(state.pattern(), resolution)
        found = rulings(net, state.positions(net))
        assert len(found.flat) > 40
        assert (found.kind == RulingKind.CONICAL).mean() > 0.95
        assert len(set(found.patch)) == 3
        errors.append(off_centre(found).mean())
    assert errors[1] < 0.6 * errors[0]
    assert errors[2] < 0.6 * errors[1]
    assert errors[2] < 0.25


def test_rulings_lie_on_the_paper_and_are_straight_there(exact: ModuleType) -> None:
    state = cone(exact)
    net = solver.build_net(state.pattern(), 40)
    found = rulings(net, state.positions(net))
    lowest = [net.patch_polygons[p].representative_point() for p in found.patch]
    branch = np.searchsorted(state.radii, [np.hypot(p.x, p.y) for p in lowest])
    for k, b in enumerate(branch):
        # Bilinear in a cell of 0.1: off by the sag of its chords.
        assert found.segments[k] == pytest.approx(state.fold(found.flat[k], int(b)), abs=2e-3)
    flat, space = (np.linalg.norm(s[:, 1] - s[:, 0], axis=1) for s in (found.flat, found.segments))
    assert space == pytest.approx(flat, rel=0.02)


def test_rulings_go_with_a_sheet_that_moves_on(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 24)
    found = rulings(net, exact.sine(1.5).positions(net))
    assert found.carried(exact.sine(1.5).positions(net)) == pytest.approx(found.segments)
    flat = found.carried(flat_sheet(net))
    assert flat[..., :2] == pytest.approx(found.flat, abs=1e-9)
    assert np.abs(flat[..., 2]).max() < 1e-12
    # The other shape is a cylinder of the same rulings: there they are straight too.
    other = found.carried(exact.sine(3.0).positions(net))
    length = np.linalg.norm(found.flat[:, 1] - found.flat[:, 0], axis=1)
    assert np.linalg.norm(other[:, 1] - other[:, 0], axis=1) == pytest.approx(length, rel=0.02)


def test_rulings_end_on_the_border_of_their_patch(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 20)
    found = rulings(net, state.positions(net))
    for line, patch in zip(found.flat, found.patch, strict=True):
        polygon = net.patch_polygons[patch]
        assert polygon.buffer(1e-9).contains(shapely.LineString(line))
        assert polygon.boundary.distance(shapely.points(line)).max() < 1e-9


def test_rulings_of_one_patch_do_not_cross_even_where_paper_is_crumpled(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 20)
    noise = np.random.default_rng(1).normal(scale=4e-3, size=(len(net.rest), 3))
    found = rulings(net, state.positions(net) + noise)
    assert len(found.flat) > 20
    for patch in np.unique(found.patch):
        lines = shapely.linestrings(found.flat[found.patch == patch])
        assert not shapely.crosses(lines[:, None], lines[None, :]).any()


@pytest.mark.parametrize("spacing", [0.1, 0.25])
def test_rulings_are_as_far_apart_as_asked(exact: ModuleType, spacing: float) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 20)
    found = rulings(net, state.positions(net), spacing)
    for patch in (0, 1):
        x = np.sort(found.flat[found.patch == patch].mean(axis=1)[:, 0])
        assert np.diff(x).min() > 0.6 * spacing
        assert np.median(np.diff(x)) < 1.1 * spacing


def test_a_flat_sheet_has_no_rulings(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 16)
    found = rulings(net, flat_sheet(net))
    assert found.segments.shape == (0, 2, 3)
    assert found.plane.all()
    assert found.summary(net) == {"cylindrical": 0, "conical": 0, "general": 0, "plane_part": 1.0}


def half_bent(net: solver.PiecewiseDog, radius: float) -> np.ndarray:
    """The sheet plane where x < 0 and rolled on a cylinder where x > 0."""
    x, y = net.rest.T
    turn = np.maximum(x, 0.0) / radius
    return np.column_stack([np.minimum(x, 0.0) + radius * np.sin(turn), y, radius * (1 - np.cos(turn))])


def test_plane_and_bent_parts_are_told_apart() -> None:
    pattern = solver.CreasePattern(
        boundary=[(-1, -0.5), (1, -0.5), (1, 0.5), (-1, 0.5)],
        creases=[solver.Crease(points=[(-1, 0), (1, 0)])],
    )
    net = solver.build_net(pattern, 24)
    found = rulings(net, half_bent(net, 0.6))
    cell = 2 / 24
    assert found.flat[..., 0].min() > -2 * cell
    assert np.ptp(found.flat[..., 0]) > 0.85
    assert set(found.kind) == {RulingKind.CYLINDRICAL}
    centre = net.rest[net.quads].mean(axis=1)[:, 0]
    assert found.plane[centre < -1.1 * cell].all()
    assert not found.plane[centre > 0].any()
    assert found.summary(net) == {
        "cylindrical": len(found.kind),
        "conical": 0,
        "general": 0,
        "plane_part": pytest.approx(0.5, abs=1.1 * cell / 2),
    }


def test_kinds_of_lines_in_the_plane() -> None:
    turn = np.linspace(0.2, 1.4, 24)
    out = np.column_stack([np.cos(turn), np.sin(turn)])
    around = np.column_stack([-out[:, 1], out[:, 0]])
    along = np.linspace(0, 1, 24)[:, None] * [1.0, 0.0]
    one = np.zeros(24, dtype=np.int64)
    parallel = np.stack([along, along + np.array([0.1, 1.0])], axis=1)
    concurrent = np.stack([0.2 * out, out], axis=1)
    tangents = np.stack([out + 0.1 * around, out + around], axis=1)
    assert set(_kinds(parallel, one, 1.0)) == {RulingKind.CYLINDRICAL}
    assert set(_kinds(concurrent, one, 1.0)) == {RulingKind.CONICAL}
    assert set(_kinds(tangents, one, 1.0)) == {RulingKind.GENERAL}


def test_rulings_move_with_the_paper(exact: ModuleType) -> None:
    state = cone(exact)
    net = solver.build_net(state.pattern(), 24)
    positions = state.positions(net)
    q, _ = np.linalg.qr(np.array([[1.0, 2.0, 0.3], [-0.5, 1.0, 2.0], [0.7, -1.0, 1.0]]))
    q *= np.sign(np.linalg.det(q))
    here, there = rulings(net, positions), rulings(net, positions @ q.T + [3.0, -1.0, 7.0])
    assert there.flat == pytest.approx(here.flat, abs=1e-6)
    assert there.segments == pytest.approx(here.segments @ q.T + [3.0, -1.0, 7.0], abs=1e-6)


def test_what_is_no_shape_or_no_spacing_is_refused(exact: ModuleType) -> None:
    net = solver.build_net(exact.sine(1.5).pattern(), 8)
    with pytest.raises(ValueError, match="positions"):
        rulings(net, np.zeros((3, 3)))
    with pytest.raises(ValueError, match="spacing"):
        rulings(net, flat_sheet(net), 0.0)
