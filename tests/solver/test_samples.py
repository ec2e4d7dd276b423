"""Every sample pattern folds: by the angle drive, and by its own handle file without the drive.

Resolution: 24 quads along the longer side, which keeps a fold to a second or two, and the default 32 for the
samples in FINER. The bounds are the same for all samples. No closed crease and no smooth crossing can have one
angle everywhere without stretch, but all of them reach these bounds: the drive gives way where it must.
"""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path

import numpy as np
import pytest
import shapely

import solver
from solver.drive import MAX_MEAN_STRETCH
from solver.fold import fold_angle_quantiles

FOLDER = Path(__file__).resolve().parents[2] / "sample_patterns"
SAMPLES = sorted(path.stem for path in FOLDER.glob("*.svg"))
RESOLUTION = 24
#: Degrees that the median fold angle exceeds, and the largest residual of the DOG angles.
MIN_MEDIAN, MAX_RESIDUAL = 30.0, 1e-4
#: Samples folded at a finer resolution, and why.
FINER_RESOLUTION = 32
FINER = {
    "annulus": "its bands are 2 quads wide at 24, and a closed ring of them shows it as stretch",
    "circle_in_square": "a closed crease: the drive stretches the sheet to its budget, and a coarse net adds to it",
    "hairpin": "two crossings near a tight turn: the drive stretches the sheet to its budget",
    "loop": "a closed crease with a crossing: at 24 its strands are few quads apart",
}
#: What every collection of samples must show.
REQUIRED = {
    "annulus", "circle_in_square", "corner_arcs", "crossing", "cusp", "four_parallel_arcs", "hairpin", "lens",
    "loop", "miura", "mirrored_arcs", "mixed", "one_arc", "s_curve", "star", "strip", "two_parallel_arcs",
}  # fmt: skip


def fold_sample(name: str, way: str) -> solver.FoldResult:
    resolution = FINER_RESOLUTION if name in FINER else RESOLUTION
    description = solver.FoldDescription(resolution=resolution)
    if way == "handles":
        handles = solver.read_handles(FOLDER / f"{name}.handles.json")
        description = solver.FoldDescription(resolution=resolution, angle=None, handles=handles)
    return solver.fold(solver.read_pattern(FOLDER / f"{name}.svg"), description)


@pytest.mark.parametrize("way", ["drive", "handles"])
@pytest.mark.parametrize("name", SAMPLES)
def test_sample_folds(name: str, way: str) -> None:
    result = fold_sample(name, way)
    m = result.measurement
    assert result.status is solver.Outcome.FOLDED, result.detail
    assert result.last.status is solver.Status.SETTLED
    assert m.folded.all()
    assert fold_angle_quantiles(m)[1] > MIN_MEDIAN
    assert m.stretch.mean() < MAX_MEAN_STRETCH
    assert result.last.constraint < MAX_RESIDUAL
    surface = result.net.render_map
    shown = solver.SheetMesh.from_faces(surface.apply(result.positions), surface.faces(), surface.uv, scale=1.0)
    assert solver.verify_mesh(shown).ok
    drawn = [crease.assignment for crease in result.pattern.creases]
    if set(drawn) == {"M", "V"}:  # the first crease is a valley in all of them, as it is in a free fold
        assert [m.side(k) for k in range(len(drawn))] == drawn


def test_samples_are_complete() -> None:
    assert set(SAMPLES) >= REQUIRED
    assert {path.name for path in FOLDER.glob("*.handles.json")} == {f"{name}.handles.json" for name in SAMPLES}


@pytest.mark.parametrize("name", SAMPLES)
def test_sample_is_drawn_in_millimetres(name: str) -> None:
    """One unit of the view box is one millimetre, the sheet lies inside it, and creases keep their colours."""
    text = (FOLDER / f"{name}.svg").read_text(encoding="utf-8")
    width, height = (float(v) for v in re.search(r'width="([\d.]+)mm" height="([\d.]+)mm"', text).groups())
    box = [float(v) for v in re.search(r'viewBox="([^"]+)"', text).group(1).split()]
    assert box[2:] == [width, height]
    pattern = solver.read_pattern(FOLDER / f"{name}.svg")
    assert pattern.unit_mm == pytest.approx(1.0)
    assert (np.ptp(pattern.boundary, axis=0) < [width, height]).all()
    both = 'stroke="#d0202e"' in text and 'stroke="#1c54c8"' in text
    assert {crease.assignment for crease in pattern.creases} == ({"M", "V"} if both else {"U"})


@pytest.mark.parametrize("name", SAMPLES)
def test_handles_are_few_and_within_reach(name: str) -> None:
    """No two targets are farther apart than the paper between their handles is long (0.2 % for rounding)."""
    pattern = solver.read_pattern(FOLDER / f"{name}.svg")
    handles = solver.read_handles(FOLDER / f"{name}.handles.json")
    sheet = shapely.Polygon(pattern.boundary, pattern.holes).buffer(1e-6)
    assert 2 <= len(handles) <= 18
    for one, other in itertools.combinations(handles, 2):
        flat = shapely.LineString([one.at, other.at])
        if sheet.covers(flat):
            assert math.dist(one.target, other.target) <= 1.002 * flat.length
