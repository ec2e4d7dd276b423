"""A curve that a program wrote as many straight lines is the curve again, whatever the format; polygons stay."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import shapely
from dxf_files import entity, r12
from dxf_files import line as dxf_line
from typed_files import cp, opx

import solver
from solver.arrays import FloatArray
from solver.fold import fold_angle_quantiles
from solver.pattern.curves import sample_crease

SAMPLES = Path(__file__).resolve().parents[3] / "sample_patterns"
SIDE = 100.0
CORNERS = np.array([(0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE)])
SIDES = list(zip(CORNERS.tolist(), np.roll(CORNERS, -1, axis=0).tolist(), strict=True))
#: A crease between points (P,2) in a square, as a file.
Writer = Callable[[FloatArray], bytes]


def pieces(points: FloatArray) -> list[tuple[list[float], list[float]]]:
    return list(zip(points[:-1].tolist(), points[1:].tolist(), strict=True))


def svg(points: FloatArray) -> bytes:
    shown = " ".join(f"{x!r},{SIDE - y!r}" for x, y in points.tolist())
    box = f'viewBox="0 0 {SIDE} {SIDE}" width="100mm" height="100mm" fill="none"'
    sheet = f'<rect width="{SIDE}" height="{SIDE}" stroke="black"/>'
    crease = f'<polyline stroke="red" points="{shown}"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {box}>{sheet}{crease}</svg>'.encode()


def dxf_polyline(points: FloatArray) -> bytes:
    vertices = [tag for x, y in points.tolist() for tag in ((0, "VERTEX"), (8, "0"), (10, x), (20, y))]
    crease = [*entity("POLYLINE", (66, 1), (62, 1)), *vertices, (0, "SEQEND")]
    return r12(*(dxf_line(tuple(a), tuple(b)) for a, b in SIDES), crease)


def dxf_lines(points: FloatArray) -> bytes:
    sides = [dxf_line(tuple(a), tuple(b)) for a, b in SIDES]
    return r12(*sides, *(dxf_line(tuple(a), tuple(b), (62, 1)) for a, b in pieces(points)))


def typed(points: FloatArray) -> list[tuple[int, float, float, float, float]]:
    drawn = [(1, *a, *b) for a, b in SIDES] + [(2, *a, *b) for a, b in pieces(points)]
    return [(kind, x0, -y0, x1, -y1) for kind, x0, y0, x1, y1 in drawn]


def fold(points: FloatArray) -> bytes:
    count = len(points)
    sides = [(count + k, count + (k + 1) % 4) for k in range(4)]
    edges = [*sides, *((k, k + 1) for k in range(count - 1))]
    content = {
        "vertices_coords": np.vstack([points, CORNERS]).tolist(),
        "edges_vertices": edges,
        "edges_assignment": ["B"] * 4 + ["M"] * (count - 1),
    }
    return json.dumps(content).encode()


WRITERS: dict[str, tuple[str, Writer]] = {
    "SVG": (".svg", svg),
    "FOLD": (".fold", fold),
    "DXF polyline": (".dxf", dxf_polyline),
    "DXF lines": (".dxf", dxf_lines),
    "CP": (".cp", lambda points: cp(typed(points))),
    "OPX": (".opx", lambda points: opx(typed(points))),
}


def read(form: str, points: FloatArray, folder: Path) -> solver.CreasePattern:
    suffix, write = WRITERS[form]
    path = folder / f"sampled{suffix}"
    path.write_bytes(write(points))
    return solver.read_pattern(path)


def wave(t: FloatArray) -> FloatArray:
    """Across the sheet, bending both ways."""
    return np.column_stack([SIDE * t, 50.0 + 15.0 * np.sin(2.0 * np.pi * t + 0.4)])


def chords(crease: solver.Crease, count: int) -> tuple[FloatArray, FloatArray]:
    """A crease sampled finely, and by this many chords of one length."""
    fine = sample_crease(crease, 1e-3 * float(np.ptp(crease.points, axis=0).max()))
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fine, axis=0).T))])
    places = np.linspace(0.0, along[-1], count + 1)
    return fine, np.column_stack([np.interp(places, along, fine[:, k]) for k in (0, 1)])


@pytest.mark.parametrize("form", WRITERS)
def test_chords_are_a_smooth_curve_again(form: str, tmp_path: Path) -> None:
    sampled = wave(np.linspace(0.0, 1.0, 25))
    exact = shapely.LineString(wave(np.linspace(0.0, 1.0, 5001)))
    assert exact.hausdorff_distance(shapely.LineString(sampled)) > 0.1
    [crease] = read(form, sampled, tmp_path).creases
    points = sample_crease(crease, 1.0)
    assert len(points) > 80
    assert exact.hausdorff_distance(shapely.LineString(points)) < 0.01
    # What was drawn is on it.
    assert shapely.distance(shapely.LineString(points), shapely.points(sampled)).max() < 1e-3


@pytest.mark.parametrize("form", WRITERS)
def test_a_corner_between_curves_is_kept(form: str, tmp_path: Path) -> None:
    t = np.linspace(0.0, 1.0, 13)
    left = np.column_stack([50.0 * t, 40.0 + 20.0 * t * t])
    corner = np.vstack([left, (100.0 - left[:, 0])[:-1][::-1, None] * (1.0, 0.0) + left[:-1][::-1] * (0.0, 1.0)])
    creases = read(form, corner, tmp_path).creases
    points = np.vstack([sample_crease(crease, 1.0) for crease in creases])
    # Both sides come up to the corner with their own slopes.
    near = points[np.abs(points[:, 0] - 50.0) < 2.0]
    assert np.abs(near[:, 1] - (60.0 - 0.8 * np.abs(near[:, 0] - 50.0))).max() < 0.05


@pytest.mark.parametrize("form", WRITERS)
@pytest.mark.parametrize(
    "points",
    [
        [(0, 20), (30, 60), (60, 20), (100, 70)],  # corners
        [(0, 50), (20, 54), (40, 50), (60, 54), (80, 50), (100, 54)],  # a flat zigzag
        [(0, 40), (40, 42), (100, 60)],  # too few to be samples
        [(0, 30), (100, 70)],
    ],
)
def test_polygons_stay_what_they_are(form: str, points: list[tuple[float, float]], tmp_path: Path) -> None:
    drawn = np.array(points, dtype=np.float64)
    creases = read(form, drawn, tmp_path).creases
    seen = shapely.union_all([shapely.LineString(sample_crease(crease, 1.0)) for crease in creases])
    assert seen.hausdorff_distance(shapely.LineString(drawn)) < 1e-9


@pytest.mark.parametrize("name", ["one_arc", "waves", "four_parallel_arcs", "circle_in_square", "fan"])
@pytest.mark.parametrize("count", [32, 64])
def test_samples_of_sample_patterns_are_their_curves(name: str, count: int, tmp_path: Path) -> None:
    pattern = solver.read_pattern(SAMPLES / f"{name}.svg")
    size = float(np.ptp(pattern.boundary, axis=0).max())
    shift = pattern.boundary.min(axis=0)
    for crease in pattern.creases:
        fine, sampled = chords(crease, count)
        [again] = read("DXF polyline", (sampled - shift) * (SIDE / size), tmp_path).creases
        back = sample_crease(again, 0.5) * (size / SIDE) + shift
        assert shapely.LineString(fine).hausdorff_distance(shapely.LineString(back)) < 1e-4 * size


def test_a_sampled_curve_folds_like_the_curve(tmp_path: Path) -> None:
    told = solver.FoldDescription(angle=60.0, resolution=12)
    angles = []
    for count in (1000, 20):
        t = np.linspace(0.0, 1.0, count + 1)
        points = np.column_stack([SIDE * t, 35.0 + 20.0 * np.sin(np.pi * t)])
        result = solver.fold(read("CP", points, tmp_path), told)
        assert result.status.ok
        angles.append(fold_angle_quantiles(result.measurement))
    assert np.array(angles[0]) == pytest.approx(np.array(angles[1]), abs=0.5)
