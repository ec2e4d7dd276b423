"""The fast subset of the gallery, coarser than it is shown: what is meant to fold does, hardly stretched."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import solver
from benchmarks.gallery_figures import Figure, figures

FAST = [figure for figure in figures() if figure.fast]


def folded(figure: Figure) -> solver.FoldResult:
    return solver.fold(figure.pattern, replace(figure.description, resolution=16))


@pytest.mark.parametrize("figure", FAST, ids=lambda figure: figure.name)
def test_what_is_shown_to_fold_folds_without_stretching(figure: Figure) -> None:
    result = folded(figure)
    m = result.measurement
    assert m.folded.all() == figure.bars
    assert m.stretch.mean() < 0.003
    if figure.bars:
        assert result.status is solver.Outcome.FOLDED
        assert np.nanmedian(m.fold_angle) > 25


def test_every_figure_of_the_paper_is_there_once_and_can_be_told_as_data() -> None:
    all_of_them = figures()
    assert len({figure.name for figure in all_of_them}) == len(all_of_them)
    assert {figure.figure for figure in all_of_them} == {"1", "2", "3", "6", "8", "13", "14", "15"}
    for figure in all_of_them:
        data = json.loads(json.dumps(figure.description.to_json()))
        assert solver.FoldDescription.from_json(data) == figure.description
