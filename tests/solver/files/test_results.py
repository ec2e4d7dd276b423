"""The files of a finished fold: read back, they are the sheet, whole, and they say what happened."""

from __future__ import annotations

import json
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import shapely

import solver

FILES = {"folded.obj", "folded.fold", "report.json"}


@pytest.fixture(scope="module")
def result(drawings: ModuleType) -> solver.FoldResult:
    plain = drawings.two_arcs()
    pattern = solver.CreasePattern(
        boundary=100 * plain.boundary,
        creases=[
            solver.Crease(points=100 * c.points, name=name, assignment=letter)
            for c, name, letter in zip(plain.creases, ("low", "high"), "VU", strict=True)
        ],
        name="two arcs",
        unit_mm=1.0,
        notes=("a note of the reader",),
    )
    return solver.fold(pattern, solver.FoldDescription(resolution=10, angle=50.0))


@pytest.fixture(scope="module")
def folder(result: solver.FoldResult, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results") / "new" / "folder"
    solver.write_results(result, folder)
    return folder


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray, list[list[int]], list[str]]:
    positions, texture, faces, groups = [], [], [], []
    for line in path.read_text(encoding="utf-8").splitlines():
        word, *rest = line.split()
        if word == "v":
            positions.append([float(r) for r in rest])
        elif word == "vt":
            texture.append([float(r) for r in rest])
        elif word == "g":
            groups.append(rest[0])
        elif word == "f":
            corners = [corner.split("/") for corner in rest]
            assert all(len(c) == 2 and c[0] == c[1] for c in corners)
            faces.append([int(c[0]) - 1 for c in corners])
        else:
            assert word in ("#", "o")
    return np.array(positions), np.array(texture), faces, groups


def read_json(path: Path) -> dict[str, Any]:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    return dict(json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse))


def flat_and_folded(content: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    [flat] = content["file_frames"]
    return np.array(flat["vertices_coords"]), np.array(content["vertices_coords"])


def test_three_files_and_no_others_are_written(folder: Path) -> None:
    assert {path.name for path in folder.iterdir()} == FILES


def test_writing_again_replaces_them(result: solver.FoldResult, tmp_path: Path) -> None:
    (tmp_path / "folded.obj").write_text("old")
    for _ in range(2):
        solver.write_results(result, tmp_path)
        assert {path.name for path in tmp_path.iterdir()} == FILES
    assert (tmp_path / "folded.obj").read_text().startswith("#")


def test_obj_and_fold_hold_the_same_surface(result: solver.FoldResult, folder: Path) -> None:
    positions, texture, faces, groups = read_obj(folder / "folded.obj")
    content = read_json(folder / "folded.fold")
    flat, folded = flat_and_folded(content)
    shown = result.net.render_map
    assert len(positions) == len(texture) == len(folded) == len(flat) == len(shown.uv)
    assert np.array_equal(positions, folded)
    assert np.array_equal(texture, flat)
    assert np.array_equal(positions, shown.apply(result.positions))
    assert faces == content["faces_vertices"] == [face.tolist() for face in shown.faces()]
    assert set(groups) == {f"patch_{k}" for k in range(len(result.net.patch_polygons))}


def test_the_flat_frame_is_the_drawing_itself(result: solver.FoldResult, folder: Path) -> None:
    content = read_json(folder / "folded.fold")
    flat, _ = flat_and_folded(content)
    polygons = [shapely.Polygon(flat[face]) for face in content["faces_vertices"]]
    assert sum(p.area for p in polygons) == pytest.approx(100.0**2, rel=1e-9)
    assert shapely.union_all(polygons).symmetric_difference(shapely.Polygon(result.pattern.boundary)).area < 1e-3
    curves = [shapely.LineString(c.points) for c in result.pattern.creases]
    lengths = np.zeros(2)
    for (a, b), crease in zip(content["edges_vertices"], content["edges_curvefold:crease"], strict=True):
        if crease is not None:
            assert curves[crease].distance(shapely.Point(flat[[a, b]].mean(axis=0))) < 0.1
            lengths[crease] += np.hypot(*(flat[a] - flat[b]))
    assert lengths == pytest.approx([c.length for c in curves], rel=1e-3)


def test_the_flat_and_the_folded_frame_are_isometric(result: solver.FoldResult, folder: Path) -> None:
    content = read_json(folder / "folded.fold")
    flat, folded = flat_and_folded(content)
    pairs = np.array(content["edges_vertices"])
    rest = np.linalg.norm(flat[pairs[:, 1]] - flat[pairs[:, 0]], axis=1)
    now = np.linalg.norm(folded[pairs[:, 1]] - folded[pairs[:, 0]], axis=1)
    long = rest > 0.3 * result.net.frame.unit
    stretch = np.abs(now[long] / rest[long] - 1)
    assert long.sum() > 100
    assert stretch.mean() < 0.004
    # Edges across a cell at a crease are chords of bent paper: shorter, by little, but never much longer.
    assert (now[long] / rest[long]).max() < 1.02
    assert np.ptp(folded[:, 2]) > 10


def test_assignments_of_the_file_are_what_the_creases_became(result: solver.FoldResult, folder: Path) -> None:
    content = read_json(folder / "folded.fold")
    letters = np.array(content["edges_assignment"])
    crease = np.array([-1 if c is None else c for c in content["edges_curvefold:crease"]])
    report = read_json(folder / "report.json")
    assert set(letters[crease < 0]) == {"B", "F"}
    for k in (0, 1):
        assert set(letters[crease == k]) == {report["creases"][k]["found"]}
    for letter, angle in zip(letters, content["edges_foldAngle"], strict=True):
        if letter == "V":
            assert angle > 0
        elif letter == "M":
            assert angle < 0
        else:
            assert angle in (0, None)
    assert content["frame_unit"] == "mm"


def test_the_report_has_what_it_promises(result: solver.FoldResult, folder: Path) -> None:
    report = read_json(folder / "report.json")
    m = result.measurement
    assert report["status"] == "folded"
    assert report["ok"] is True
    assert report["drawing"] == "two arcs"
    assert report["vertices"] == len(result.positions)
    assert report["quads"] == len(result.net.quads)
    assert report["patches"] == 3
    assert report["iterations"] == result.iterations > 0
    assert report["seconds"] >= 0
    assert report["stretch_mean"] == pytest.approx(m.stretch.mean())
    assert report["stretch_max"] == pytest.approx(m.stretch.max())
    assert report["continuity_max"] == pytest.approx(m.continuity.max())
    assert report["dog_residual_max"] < 1e-4
    assert report["handle_error"] == 0
    assert report["folded"] == 1.0
    low, median, high = report["fold_angle"]
    assert low <= median <= high
    assert median == pytest.approx(50, rel=0.15)
    assert solver.FoldDescription.from_json(report["description"]) == result.description
    assert [c["name"] for c in report["creases"]] == ["low", "high"]
    assert [c["assignment"] for c in report["creases"]] == ["V", "U"]
    assert all(c["found"] in ("M", "V") and c["folded"] == 1.0 and c["points"] > 5 for c in report["creases"])
    assert "a note of the reader" in report["notes"]
    assert report["sentence"]
    assert sum(report["objective"].values()) > 0


def test_a_failed_fold_is_written_whole_and_says_so(drawings: ModuleType, tmp_path: Path) -> None:
    result = solver.fold(drawings.one_arc(), solver.FoldDescription(resolution=6, angle=60.0, max_iterations=10))
    assert not result.status.ok
    solver.write_results(result, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == FILES
    report = read_json(tmp_path / "report.json")
    assert report["ok"] is False
    assert report["status"] == "unsettled"


def test_nothing_is_left_where_nothing_can_be_written(result: solver.FoldResult, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(solver.CurvefoldError, match="file"):
        solver.write_results(result, tmp_path / "file")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_no_file_is_half_written_when_the_result_has_a_hole(result: solver.FoldResult, tmp_path: Path) -> None:
    from dataclasses import replace

    broken = np.array(result.positions)
    broken[0] = np.nan
    with pytest.raises((ValueError, solver.CurvefoldError)):
        solver.write_results(replace(result, positions=broken), tmp_path / "out")
    assert not (tmp_path / "out").exists()
