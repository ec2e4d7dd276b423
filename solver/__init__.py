"""Curved folding of paper: drawings in, piecewise DOGs folded along their creases out. Needs no Blender.

    pattern = solver.read_pattern("x.svg")
    result = solver.fold(pattern, solver.FoldDescription(angle=60.0))
    solver.write_results(result, "out")
    solver.write_plan(solver.plan(result, solver.PlanDescription("laser-lightburn")), "out/plan.dxf")

or step by step: ``build_net``, ``FoldModel``, ``measure``.
"""

from .controls.amount import Amount
from .controls.angle import Angle
from .controls.curve import Curve
from .controls.glue import Glue
from .controls.keep import Keep
from .controls.pair import Pair
from .controls.side import Side
from .description import FoldDescription, Handle, Weights, read_description, read_handles
from .errors import (
    CurvefoldError,
    DescriptionError,
    HandleError,
    NetError,
    PatternError,
    ReadError,
)
from .files.mesh_reading import read_mesh
from .files.results import write_results
from .fold import FoldResult, Outcome, fold
from .folding import FoldModel, SqpReport, Status
from .gauss_image import GaussImage, gauss_area, gauss_image
from .measurement import Measurement, measure
from .net.build import build_net
from .net.piecewise_dog import PiecewiseDog
from .net.render_map import RenderMap
from .net.resolution import Resolution, choose_resolution
from .pattern.crease_pattern import Crease, CreasePattern
from .pattern.read_options import ReadOptions
from .pattern.reading import DRAWING_FORMATS, DRAWING_SUFFIXES, read_pattern, read_patterns
from .plan.planning import PlanDescription, PlanResult, plan, write_plan
from .plan.profile import profile_names
from .plan.source import PlanSource, read_plan_source
from .plan.source import of_result as plan_source
from .rulings import RulingKind, Rulings, rulings
from .sheet_mesh import SheetMesh
from .verify import Fault, Verification, verify
from .verify_mesh import verify_mesh

__all__ = [
    "DRAWING_FORMATS",
    "DRAWING_SUFFIXES",
    "Amount",
    "Angle",
    "Crease",
    "CreasePattern",
    "Curve",
    "CurvefoldError",
    "DescriptionError",
    "Fault",
    "FoldDescription",
    "FoldModel",
    "FoldResult",
    "GaussImage",
    "Glue",
    "Handle",
    "HandleError",
    "Keep",
    "Measurement",
    "NetError",
    "Outcome",
    "Pair",
    "PatternError",
    "PiecewiseDog",
    "PlanDescription",
    "PlanResult",
    "PlanSource",
    "ReadError",
    "ReadOptions",
    "RenderMap",
    "Resolution",
    "RulingKind",
    "Rulings",
    "SheetMesh",
    "Side",
    "SqpReport",
    "Status",
    "Verification",
    "Weights",
    "build_net",
    "choose_resolution",
    "fold",
    "gauss_area",
    "gauss_image",
    "measure",
    "plan",
    "plan_source",
    "profile_names",
    "read_description",
    "read_handles",
    "read_mesh",
    "read_pattern",
    "read_patterns",
    "read_plan_source",
    "rulings",
    "verify",
    "verify_mesh",
    "write_plan",
    "write_results",
]
