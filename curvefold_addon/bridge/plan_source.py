"""What the plan of a paper is made of: its drawing, and how it is folded now."""

from __future__ import annotations

from ...solver import PlanSource, rulings
from ...solver.plan.source import FoldAngles, angles_of, told_places
from . import hooks, state
from .session import Session

#: Millimetres in one Blender unit of a scene whose unit scale is 1.
_MM = 1000.0


def plan_source(
    session: Session, inputs: hooks.Inputs, name: str, unit_scale: float, with_rulings: bool
) -> PlanSource:
    """The source of a paper's plan. inputs: what the paper is told; unit_scale: metres in one unit of its scene."""
    scale = session.source.scale
    pattern = state.pattern_of(session.source).named(name, scale * _MM * unit_scale)
    found = angles_of(session.measurement)
    handles, joints = told_places(inputs.handles, inputs.controls, 1.0 / scale)
    flat = rulings(session.net, session.positions).flat / scale if with_rulings else None
    angles = FoldAngles(found.places / scale, found.degrees)
    return PlanSource(pattern, angles, handles, joints, flat)
