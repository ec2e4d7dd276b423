"""The files of rulings and Gauss image: read back they are what was found, and the drawing stays readable."""

from __future__ import annotations

import io
import json
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solver
from solver import RulingKind, gauss_image, rulings
from solver.command_line import main
from solver.files.ruling_files import RULING_FILES, RULING_INK, gauss_image_obj, rulings_obj, rulings_svg

SVG = "{http://www.w3.org/2000/svg}"
FILES = {"folded.obj", "folded.fold", "report.json"}
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="80mm" viewBox="0 0 50 40">
<rect width="50" height="40" fill="none" stroke="black"/><circle cx="40" cy="35" r="2" fill="none" stroke="black"/>
<path d="M 0 10 Q 25 22 50 10" fill="none" stroke="red"/><path d="M 0 20 Q 25 32 50 20" fill="none" stroke="blue"/>
</svg>
"""


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> solver.FoldResult:
    path = tmp_path_factory.mktemp("drawing") / "arcs.svg"
    path.write_text(DRAWING)
    return solver.fold(solver.read_pattern(path), solver.FoldDescription(resolution=12, angle=50.0))


@pytest.fixture(scope="module")
def folder(result: solver.FoldResult, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    solver.write_results(result, folder, with_rulings=True)
    return folder


def read(text: str) -> tuple[np.ndarray, dict[str, list[list[int]]]]:
    """Vertices, and vertex indices of the elements of each group."""
    vertices, groups, group = [], {}, ""
    for row in text.splitlines():
        word, *rest = row.split()
        if word == "v":
            vertices.append([float(c) for c in rest])
        elif word == "g":
            group = rest[0]
            assert group not in groups
        elif word in ("l", "p"):
            groups.setdefault(group, []).append([int(k) - 1 for k in rest])
        else:
            assert word in ("#", "o")
    return np.array(vertices), groups


def test_three_files_more_are_written_and_only_where_they_are_wanted(
    result: solver.FoldResult, folder: Path, tmp_path: Path
) -> None:
    assert {path.name for path in folder.iterdir()} == FILES | set(RULING_FILES)
    solver.write_results(result, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == FILES
    assert "rulings" not in json.loads((tmp_path / "report.json").read_text())


def test_the_lines_are_the_rulings_in_groups_by_their_kind(result: solver.FoldResult, folder: Path) -> None:
    found = rulings(result.net, result.positions)
    vertices, groups = read((folder / "rulings.obj").read_text())
    names = {kind.name.lower() for kind in RulingKind if (found.kind == kind).any()}
    assert set(groups) == names
    assert len(found.kind) > 20
    for name, lines in groups.items():
        mine = found.kind == RulingKind[name.upper()]
        assert np.array_equal(vertices[lines], found.segments[mine])


def test_every_kind_has_a_group_of_its_own(result: solver.FoldResult) -> None:
    found = rulings(result.net, result.positions)
    mixed = replace(found, kind=np.arange(len(found.kind)) % 3)
    vertices, groups = read(rulings_obj(mixed, "x"))
    assert list(groups) == ["cylindrical", "conical", "general"]
    for k, lines in enumerate(groups.values()):
        assert np.array_equal(vertices[lines], found.segments[k::3])


def test_the_gauss_image_lies_on_the_unit_ball_in_groups_by_patch(result: solver.FoldResult, folder: Path) -> None:
    image = gauss_image(result.net, result.positions)
    points, groups = read((folder / "gauss_image.obj").read_text())
    assert np.array_equal(points, image.normals[image.shown])
    assert np.linalg.norm(points, axis=1) == pytest.approx(1.0)
    groups.pop("points", None)
    assert set(groups) == {f"patch_{k}" for k in np.unique(image.patch)}
    for name, lines in groups.items():
        mine = image.lines[image.patch[image.lines[:, 0]] == int(name.removeprefix("patch_"))]
        assert np.array_equal(points[lines], image.normals[mine])


def test_every_patch_has_a_group_of_its_own_however_quads_are_numbered(result: solver.FoldResult) -> None:
    image = gauss_image(result.net, result.positions)
    last = image.patch.max()
    points, groups = read(gauss_image_obj(replace(image, patch=last - image.patch), "x"))
    groups.pop("points", None)
    assert list(groups) == [f"patch_{k}" for k in range(last + 1)]
    for k, lines in enumerate(groups.values()):
        mine = image.lines[image.patch[image.lines[:, 0]] == last - k]
        assert np.array_equal(points[lines], image.normals[mine])


def test_the_flat_drawing_shows_the_rulings_in_true_scale(result: solver.FoldResult, folder: Path) -> None:
    found = rulings(result.net, result.positions)
    root = ElementTree.parse(folder / "rulings.svg").getroot()
    _, _, width, height = map(float, root.get("viewBox", "").split())
    assert float(root.get("width", "").removesuffix("mm")) == pytest.approx(2.0 * width)
    assert (width, height) == (pytest.approx(50, rel=0.01), pytest.approx(40, rel=0.01))
    margin = 0.5 * (width - 50)
    drawn = 0
    for kind in RulingKind:
        for group in root.findall(f"{SVG}g[@id='rulings-{kind.name.lower()}']"):
            assert group.get("stroke") == RULING_INK[kind]
            lines = [
                [[float(c) for c in place.split(",")] for place in line.get("points", "").split()] for line in group
            ]
            places = np.array(lines) - margin
            places[..., 1] = 40 - places[..., 1]
            assert places == pytest.approx(found.flat[found.kind == kind], abs=1e-6)
            drawn += len(places)
    assert drawn == len(found.kind)


def test_the_flat_drawing_is_read_as_the_drawing_itself(result: solver.FoldResult, folder: Path) -> None:
    again, before = solver.read_pattern(folder / "rulings.svg"), result.pattern
    assert again.unit_mm == pytest.approx(2.0)
    assert [crease.assignment for crease in again.creases] == [crease.assignment for crease in before.creases]
    assert len(again.holes) == 1

    def lengths(pattern: solver.CreasePattern) -> list[float]:
        return [np.linalg.norm(np.diff(crease.points, axis=0), axis=1).sum() for crease in pattern.creases]

    assert lengths(again) == pytest.approx(lengths(before), rel=1e-4)
    assert np.ptp(again.boundary, axis=0) == pytest.approx(np.ptp(before.boundary, axis=0))


@pytest.mark.parametrize("kind", list(RulingKind))
def test_no_kind_of_ruling_is_read_as_a_crease(result: solver.FoldResult, tmp_path: Path, kind: RulingKind) -> None:
    found = rulings(result.net, result.positions)
    path = tmp_path / "rulings.svg"
    path.write_text(rulings_svg(result.pattern, replace(found, kind=np.full(len(found.kind), kind))))
    assert len(solver.read_pattern(path).creases) == 2


def test_a_drawing_that_does_not_say_how_large_it_is_stays_so(result: solver.FoldResult) -> None:
    found = rulings(result.net, result.positions)
    plain = solver.CreasePattern(result.pattern.boundary, name="a < b")
    root = ElementTree.fromstring(rulings_svg(plain, found))
    assert root.get("width") is None
    assert root.findtext(f"{SVG}title") == "a < b"


def test_the_report_counts_them(result: solver.FoldResult, folder: Path) -> None:
    found = rulings(result.net, result.positions)
    report = json.loads((folder / "report.json").read_text())["rulings"]
    assert report == found.summary(result.net)
    assert sum(report[kind.name.lower()] for kind in RulingKind) == len(found.kind)


def test_no_file_is_written_when_the_result_has_a_hole(result: solver.FoldResult, tmp_path: Path) -> None:
    broken = np.array(result.positions)
    broken[result.net.quads[0, 0]] = np.nan
    with pytest.raises((ValueError, solver.CurvefoldError)):
        solver.write_results(replace(result, positions=broken), tmp_path / "out", with_rulings=True)
    assert not (tmp_path / "out").exists()


def test_the_option_of_the_command(tmp_path: Path) -> None:
    drawing, out = tmp_path / "arcs.svg", tmp_path / "out"
    drawing.write_text(DRAWING)
    arguments = ["fold", str(drawing), "--out", str(out), "--resolution", "8", "--angle", "30"]
    assert main(arguments, io.StringIO()) == 0
    assert {path.name for path in out.iterdir()} == FILES
    assert main([*arguments, "--rulings"], io.StringIO()) == 0
    assert {path.name for path in out.iterdir()} == FILES | set(RULING_FILES)


def test_the_drawing_is_not_written_over(tmp_path: Path) -> None:
    drawing = tmp_path / "rulings.svg"
    drawing.write_text(DRAWING)
    words = io.StringIO()
    assert main(["fold", str(drawing), "--out", str(tmp_path), "--rulings"], words) == 2
    assert "another folder" in words.getvalue()
    assert drawing.read_text() == DRAWING
