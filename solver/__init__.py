"""Curved folding of paper: drawings in, piecewise DOGs folded along their creases out. Needs no Blender.

    pattern = solver.read_pattern("x.svg")
    result = solver.fold(pattern, solver.FoldDescription(angle=60.0))
    solver.write_results(result, "out")

or step by step: ``build_net``, ``FoldModel``, ``measure``.
"""

from .description import FoldDescription, Handle, Weights, read_handles
from .errors import (
    CurvefoldError,
    DescriptionError,
    HandleError,
    NetError,
    PatternError,
    ReadError,
)
from .files.results import write_results
from .fold import FoldResult, Outcome, fold
from .folding import FoldModel, SqpReport, Status
from .measurement import Measurement, measure
from .net.build import build_net
from .net.piecewise_dog import PiecewiseDog
from .net.render_map import RenderMap
from .pattern.crease_pattern import Crease, CreasePattern
from .pattern.reading import read_pattern

__all__ = [
    "Crease",
    "CreasePattern",
    "CurvefoldError",
    "DescriptionError",
    "FoldDescription",
    "FoldModel",
    "FoldResult",
    "Handle",
    "HandleError",
    "Measurement",
    "NetError",
    "Outcome",
    "PatternError",
    "PiecewiseDog",
    "ReadError",
    "RenderMap",
    "SqpReport",
    "Status",
    "Weights",
    "build_net",
    "fold",
    "measure",
    "read_handles",
    "read_pattern",
    "write_results",
]
