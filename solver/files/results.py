"""The files of a finished fold: folded.obj, folded.fold, report.json, and of its rulings where they are wanted."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import FloatArray
from ..errors import CurvefoldError
from ..fold import FoldResult
from ..optimize.kernel import linear_algebra
from .atomic import write_whole
from .fold_format import fold_text
from .obj import obj_text
from .ruling_files import RULING_FILES, ruling_texts

OBJ_NAME, FOLD_NAME, REPORT_NAME = "folded.obj", "folded.fold", "report.json"
#: FOLD's frame units by millimetres a unit.
_UNITS = {1.0: "mm", 10.0: "cm", 1000.0: "m", 25.4: "in", 25.4 / 72: "pt", 1e-3: "um", 1e-6: "nm"}
#: Units that differ by less, relatively, are the same: a drawing's unit is a quotient of its sizes.
_SAME_UNIT = 1e-9


def result_names(with_rulings: bool = False) -> tuple[str, ...]:
    """The names of the files that ``write_results`` writes."""
    return (OBJ_NAME, FOLD_NAME, *(RULING_FILES if with_rulings else ()), REPORT_NAME)


def write_results(result: FoldResult, folder: str | Path, with_rulings: bool = False) -> None:
    """Write the files, each whole or not at all; the report comes last and so says that all are there.

    with_rulings: also rulings.obj, rulings.svg and gauss_image.obj, with a summary in the report.

    Raises CurvefoldError when the folder cannot be made or a file not be written.
    """
    folder = Path(folder)
    surface = result.net.render_map
    vertices = surface.apply(result.positions)
    faces = surface.faces()
    name = result.pattern.name or "folded"
    report = result.report() | {"linear_algebra": linear_algebra().phrase}
    texts = {
        OBJ_NAME: obj_text(
            vertices,
            surface.uv,
            [face.tolist() for face in faces],
            surface.face_patch,
            name,
            f"folded by Curvefold: {result.detail}",
        ),
        FOLD_NAME: fold_text(
            vertices,
            surface.uv,
            faces,
            surface.crease_edges,
            surface.crease_edge_crease,
            crease_edge_angles(result),
            _unit(result.pattern.unit_mm),
            name,
        ),
    }
    if with_rulings:
        more, report["rulings"] = ruling_texts(result)
        texts |= more
    texts[REPORT_NAME] = json.dumps(report, indent=1, allow_nan=False) + "\n"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CurvefoldError(f"the folder cannot be made ({error.strerror})", file=str(folder)) from None
    for file, text in texts.items():
        write_whole(folder / file, text)


def _unit(unit_mm: float | None) -> str:
    close = (name for mm, name in _UNITS.items() if unit_mm and abs(unit_mm / mm - 1.0) < _SAME_UNIT)
    return next(close, "unit")


def crease_edge_angles(result: FoldResult) -> FloatArray:
    """Signed fold angle (n,) in degrees at each shown crease edge: that of the nearest point of its chain."""
    surface, m = result.net.render_map, result.measurement
    middle = surface.uv[surface.crease_edges].mean(axis=1)
    angles = np.full(len(middle), np.nan)
    signed = m.fold_angle * m.fold_sign
    chains = result.net.crease_points.chain
    for chain in np.unique(surface.crease_edge_chain):
        points = np.flatnonzero((chains == chain) & np.isfinite(signed))
        edges = np.flatnonzero(surface.crease_edge_chain == chain)
        if len(points):
            _, nearest = cKDTree(m.crease_position[points]).query(middle[edges])
            angles[edges] = signed[points[nearest]]
    return angles
