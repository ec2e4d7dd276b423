"""The check of any mesh: what is paper passes however it comes, and each part fails when just that is spoilt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import solver
from solver import SheetMesh, verify_mesh
from solver.verify_mesh import verdict

SAMPLES = Path(__file__).parents[2] / "sample_patterns"


def grid(columns: int = 12, rows: int = 10) -> tuple[np.ndarray, np.ndarray]:
    """(R,2) places one apart and (F,4) faces of a sheet of squares."""
    number = np.arange((columns + 1) * (rows + 1)).reshape(rows + 1, columns + 1)
    flat = np.stack(np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0)), axis=2).reshape(-1, 2)
    faces = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=2)
    return flat, faces.reshape(-1, 4)


def sheet(bend: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, ...]]) -> SheetMesh:
    """A sheet of squares whose point (x, y) is at bend(x, y)."""
    flat, faces = grid()
    return SheetMesh.from_faces(np.column_stack(bend(*flat.T)), list(faces), flat)


def cylinder(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, ...]:
    """Bent by 6 degrees an edge; chords are as long as the paper's edges in the mean."""
    radius = 0.5 / np.sin(np.radians(3))
    return radius * np.sin(np.radians(6) * x), y, radius * np.cos(np.radians(6) * x)


def checks(mesh: SheetMesh) -> set[str]:
    return {fault.check for fault in verify_mesh(mesh).faults}


@pytest.fixture(scope="module")
def folded(drawings: ModuleType) -> SheetMesh:
    result = solver.fold(drawings.off_centre(), solver.FoldDescription(resolution=12, angle=50.0))
    surface = result.net.render_map
    return SheetMesh.from_faces(surface.apply(result.positions), surface.faces(), surface.uv)


# --- what is paper --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "handles"), [("corner_arcs", False), ("loop", True), ("strip", False)])
def test_samples_folded_coarsely_pass_through_both_files(tmp_path: Path, name: str, handles: bool) -> None:
    told = (
        solver.FoldDescription(resolution=12, handles=solver.read_handles(SAMPLES / f"{name}.handles.json"))
        if handles
        else solver.FoldDescription(resolution=12, angle=60.0)
    )
    solver.write_results(solver.fold(solver.read_pattern(SAMPLES / f"{name}.svg"), told), tmp_path)
    obj, fold = (verify_mesh(solver.read_mesh(tmp_path / f"folded.{suffix}")) for suffix in ("obj", "fold"))
    assert obj.ok, obj.faults
    assert fold.ok, fold.faults
    assert fold.figures["scale"] == 1.0
    assert obj.figures["scale"] == pytest.approx(1.0, abs=0.003)
    assert obj.figures["pieces"] == 1.0


def test_flat_and_bent_paper_passes_exactly() -> None:
    for bend in (lambda x, y: (x, y, 0 * x), cylinder):
        found = verify_mesh(sheet(bend))
        assert found.ok, found.faults
        # The diagonals of a cylinder's squares lie straight across what is bent.
        assert found.figures["stretch_max"] < 1e-12
        assert found.figures["shear_max"] < 1e-3
        assert found.figures["angle_defect_mean"] < 1e-9
        assert found.figures["area_min"] == pytest.approx(1.0, abs=1e-12)


def test_a_state_in_closed_form_passes(exact: ModuleType) -> None:
    state = exact.sine(1.5)
    net = solver.build_net(state.pattern(), 30)
    surface = net.render_map
    for positions in (state.positions(net), state.bent(net)):
        assert checks(SheetMesh.from_faces(surface.apply(positions), surface.faces(), surface.uv)) == set()


def test_the_figures_do_not_depend_on_where_and_how_large_it_is(folded: SheetMesh) -> None:
    plain = verify_mesh(folded)
    assert plain.ok
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    mirror = np.diag([1.0, 1.0, -1.0])
    quarter = np.array([[0.0, 1.0], [-1.0, 0.0]])
    x, flat = folded.vertices, folded.corner_flat
    moved = [
        (replace(folded, vertices=x @ turn + (3, -4, 5)), 1.0),
        (replace(folded, vertices=x @ mirror), 1.0),
        (replace(folded, vertices=1e-6 * x), 1e-6),
        (replace(folded, vertices=1e9 * x), 1e9),
        (replace(folded, corner_flat=flat @ quarter + (7, 8)), 1.0),
        (replace(folded, corner_flat=flat * (-1, 1)), 1.0),
        (replace(folded, corner_flat=0.25 * flat), 4.0),
    ]
    for mesh, scale in moved:
        found = verify_mesh(mesh)
        assert found.ok, found.faults
        expected = plain.figures | {"scale": scale * plain.figures["scale"]}
        assert found.figures == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_vertices_that_lie_on_each_other_say_nothing_about_angles() -> None:
    """The sheet's middle vertex is there twice, and the edge between the two points anywhere in space."""
    flat, faces = grid()
    middle, second = 6 + 13 * 5, len(flat)
    polygons = [face.tolist() for face in faces]
    # Left and right of it, above and below: two faces have one of them, two have both.
    for face, corners in ((53, [second, middle]), (54, [second]), (66, [middle, second])):
        place = polygons[face].index(middle)
        polygons[face][place : place + 1] = corners
    x = np.column_stack(cylinder(*flat.T))
    double = np.vstack([x, x[middle] + np.array([0, 1e-5, 1e-5])])
    found = verify_mesh(
        SheetMesh.from_faces(double, polygons, np.vstack([flat, flat[middle] + np.array([1e-9, 0])]))
    )
    assert found.ok, found.faults
    assert found.figures["angle_defect_mean"] < 1e-4
    assert found.figures["pieces"] == 1.0


def test_a_sheet_of_slivers_alone_has_no_angles() -> None:
    flat = np.array([(0, 0), (3, 0), (3, 0.01), (0, 0.01)])
    found = verify_mesh(SheetMesh.from_faces(np.column_stack([flat, np.zeros(4)]), [[0, 1, 2, 3]], flat))
    assert found.ok
    assert found.figures["angle_defect_mean"] == 0.0


def test_a_paper_model_of_a_cube_is_paper_in_six_pieces() -> None:
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    places = np.vstack([square + np.array([2 * k, 0]) for k in range(6)])
    apart = SheetMesh(corners, np.arange(0, 25, 4), np.concatenate(faces), places)
    found = verify_mesh(apart)
    assert found.ok, found.faults
    assert found.figures["pieces"] == 6.0
    assert verdict(found).endswith(", in 6 pieces")


# --- every check fails when its own matter is spoilt ----------------------------------------------------


def test_lost_vertices() -> None:
    for number in (np.nan, np.inf, -1e200):
        x = sheet(cylinder).vertices.copy()
        x[20, 1] = number
        found = verify_mesh(replace(sheet(cylinder), vertices=x))
        assert [fault.check for fault in found.faults] == ["finite"]
        assert found.faults[0].place == tuple(grid()[0][20])
        assert str(found.faults[0]).startswith("1 vertex is not at a finite place, at (")
    places = sheet(cylinder).corner_flat.copy()
    places[3, 0] = np.nan
    assert checks(replace(sheet(cylinder), corner_flat=places)) == {"finite"}


def test_a_vertex_that_no_face_has_may_be_anywhere() -> None:
    mesh = sheet(cylinder)
    assert checks(replace(mesh, vertices=np.vstack([mesh.vertices, (np.nan, 0, 0)]))) == set()


def test_stretched_a_little_everywhere() -> None:
    mesh = sheet(lambda x, y: (x, 1.012 * y, 0 * x))
    assert checks(mesh) == {"isometry"}
    # The same in both directions is a scale, unless that is known.
    even = sheet(lambda x, y: (1.012 * x, 1.012 * y, 0 * x))
    assert checks(even) == set()
    assert checks(replace(even, scale=1.0)) == {"isometry"}


def test_stretched_in_one_place() -> None:
    mesh = sheet(cylinder)
    x = mesh.vertices.copy()
    x[6 + 13 * 5, 1] += 0.2
    found = verify_mesh(replace(mesh, vertices=x))
    assert {fault.check for fault in found.faults} == {"isometry"}
    assert str(found.faults[0]).startswith("an edge is stretched by 20.0%, over 5%, at (6, ")
    assert found.figures["stretch_max"] == pytest.approx(0.2)


def test_a_fishnet_on_a_ball_is_no_paper() -> None:
    """No edge of it is stretched: each face is a rhombus, made by half a turn about its middle."""
    count, step = 11, 0.05
    ball = np.zeros((count, count, 3))
    t = step * np.arange(count)
    ball[0] = np.column_stack([np.sin(t), 0 * t, np.cos(t)])
    ball[:, 0] = np.column_stack([0 * t, np.sin(t), np.cos(t)])
    for j in range(1, count):
        for i in range(1, count):
            middle = ball[j - 1, i] + ball[j, i - 1]
            middle /= np.linalg.norm(middle)
            ball[j, i] = 2 * (middle @ ball[j - 1, i - 1]) * middle - ball[j - 1, i - 1]
    flat, faces = grid(count - 1, count - 1)
    found = verify_mesh(SheetMesh.from_faces(ball.reshape(-1, 3), list(faces), flat))
    assert found.figures["stretch_max"] < 1e-9
    assert [str(fault)[:42] for fault in found.faults] == [
        "faces are stretched from corner to corner ", "a face is stretched by 11.9%, over 5%, at "
    ]  # fmt: skip


def test_a_cap_with_its_projection_as_flat_sheet_is_no_paper() -> None:
    def cap(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, ...]:
        return x, y, np.sqrt(15.0**2 - (x - 6) ** 2 - (y - 5) ** 2)

    assert "isometry" in checks(sheet(cap))


def test_a_face_upside_down_on_the_flat_sheet() -> None:
    flat, faces = grid()
    faces[17] = faces[17, ::-1]
    found = verify_mesh(SheetMesh.from_faces(np.column_stack(cylinder(*flat.T)), list(faces), flat))
    assert [str(fault).partition(", at")[0] for fault in found.faults] == [
        "1 face lies upside down on the flat sheet"
    ]
    assert found.faults[0].check == "faces"


def test_a_face_that_is_rolled_up() -> None:
    """One face of many corners, bent by 240 degrees."""
    radius, turn = 10.0, np.radians(np.linspace(0, 240, 43))
    low, high = (np.column_stack([radius * turn, np.full(43, y)]) for y in (0.0, 1.0))
    flat = np.vstack([low, high[::-1]])
    x = np.column_stack([radius * np.sin(flat[:, 0] / radius), flat[:, 1], radius * np.cos(flat[:, 0] / radius)])
    found = verify_mesh(SheetMesh.from_faces(x, [np.arange(86)], flat))
    assert [fault.check for fault in found.faults] == ["faces"]
    assert "only 41% of its flat area" in str(found.faults[0])


def test_a_face_that_has_grown() -> None:
    """A low triangle twice as high: its edges are hardly longer."""
    flat, faces = grid()
    low = np.array([(20, 0), (22, 0), (21, 0.12)])
    places = np.vstack([flat, low])
    high = np.column_stack([low * (1, 2), np.zeros(3)])
    x = np.vstack([np.column_stack(cylinder(*flat.T)), high])
    triangle = np.arange(3) + len(flat)
    found = verify_mesh(SheetMesh.from_faces(x, [*faces, triangle], places))
    assert [fault.check for fault in found.faults] == ["faces"]
    assert "2.00 times its flat area" in str(found.faults[0])


def test_torn() -> None:
    """The right half has vertices of its own, a little higher."""
    flat, faces = grid()
    right = flat[faces].mean(axis=1)[:, 0] > 6
    faces[right] += len(flat)
    x = np.column_stack(cylinder(*flat.T))
    for gap, expected in ((0.0, set()), (0.01, set()), (0.05, {"continuity"})):
        # The same places, but for the last digits.
        places = np.vstack([flat, flat + 1e-6])
        mesh = SheetMesh.from_faces(np.vstack([x, x + np.array([0, 0, gap])]), list(faces), places)
        found = verify_mesh(mesh)
        assert {fault.check for fault in found.faults} == expected
        assert found.figures["crack_max"] == pytest.approx(gap, abs=1e-6)
        assert found.figures["pieces"] == 2.0


def test_crumpled() -> None:
    """Every other vertex a little higher: lengths are kept to half a per cent, and only the angles show it."""
    found = verify_mesh(sheet(lambda x, y: (x, y, 0.05 * (-1.0) ** (x + y))))
    assert [fault.check for fault in found.faults] == ["angles"]
    assert found.figures["angle_defect_mean"] == pytest.approx(2.27, abs=0.01)
    assert ", worst at (" in str(found.faults[0])


def test_no_sheet_at_all() -> None:
    mesh = sheet(cylinder)
    assert checks(replace(mesh, corner_flat=0 * mesh.corner_flat)) == {"flat"}
    assert checks(replace(mesh, corner_flat=mesh.corner_flat * (1, 0))) >= {"faces", "isometry"}
    assert checks(replace(mesh, vertices=0 * mesh.vertices)) == {"isometry"}
    # Thousands of corners at one place of the flat sheet, and nothing but that is slow about it.
    places = np.where(np.arange(len(mesh.corner_flat))[:, None] < 200, 0.0, mesh.corner_flat)
    assert "isometry" in checks(replace(mesh, corner_flat=places))


def test_words() -> None:
    assert verdict(verify_mesh(sheet(cylinder))).startswith("paper: lengths change by 0.0")
    spoilt = verify_mesh(sheet(lambda x, y: (x, 1.012 * y, 0 * x)))
    assert verdict(spoilt) == "not paper: edges are stretched by 0.60% in the mean, over 0.5%"
    worse = verify_mesh(sheet(lambda x, y: (x, 1.3 * y, 0 * x)))
    assert verdict(worse).startswith("not paper: edges are stretched by 13.04% in the mean")
    assert verdict(worse).endswith("; and 2 more faults")


@pytest.mark.parametrize(
    "change",
    [
        {"face_vertices": np.full(480, 143)},
        {"face_vertices": np.full(480, -1)},
        {"face_start": np.array([0, 2, 480])},
        {"face_start": np.array([0])},
        {"face_start": np.array([0, 4])},
        {"corner_flat": np.zeros((479, 2))},
        {"vertices": np.zeros((143, 2))},
        {"scale": 0.0},
        {"scale": np.nan},
    ],
)
def test_shapes_that_do_not_fit(change: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"vert|face|corner|scale"):
        replace(sheet(cylinder), **change)
