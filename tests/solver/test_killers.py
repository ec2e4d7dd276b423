"""Four kinds of drawing that stop other solvers, folded at three resolutions, certificate and all."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import solver

FOLDER = Path(__file__).resolve().parents[2] / "sample_patterns"
#: Two creases that cross, a crease with a loop, a cusp, a hairpin across a second crease.
KILLERS = ("crossing", "loop", "cusp", "hairpin")
RESOLUTIONS = (20, 26, 32)
ANGLE = 45.0


@pytest.mark.parametrize("resolution", RESOLUTIONS)
@pytest.mark.parametrize("name", KILLERS)
def test_killer_folds(name: str, resolution: int) -> None:
    pattern = solver.read_pattern(FOLDER / f"{name}.svg")
    result = solver.fold(pattern, solver.FoldDescription(resolution=resolution, angle=ANGLE))
    assert result.status is solver.Outcome.FOLDED, result.detail
    assert solver.verify(result.net, result.positions).ok
    # The median of all points is what was asked (FOLDED says so); to the eye, every crease is folded.
    for crease in range(len(pattern.creases)):
        angles = result.measurement.fold_angle[result.measurement.crease == crease]
        assert np.nanmedian(angles) > 0.5 * ANGLE
