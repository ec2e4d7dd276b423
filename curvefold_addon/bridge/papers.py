"""Papers as datablocks: made from a drawing, or from a fold that the command line has made."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import bpy
from mathutils import Matrix  # type: ignore[import-not-found]

from ...solver import Crease, CreasePattern, Handle, Status
from ...solver.description import AUTO
from . import by_hand, controls, drawing_objects, hooks, mesh_attributes, state
from . import mesh as surface
from .curve_targets import target_points
from .kept_controls import keep_controls
from .nets import drawn_of
from .session import Session
from .splines import read_strands

if TYPE_CHECKING:
    from ...solver import FoldResult


def is_paper(item: Any) -> bool:
    """Whether an object shows a paper."""
    return bool(item.type == "MESH" and item.data.curvefold.is_paper)


def new_paper(name: str, collection: Any, material: Any) -> Any:
    """A new object for a paper, without geometry yet."""
    return surface.add_object(bpy.data.meshes.new(name), collection, material)


def show(mesh: Any, session: Session) -> None:
    """Gives a mesh the net and the shape of a session, to be seen and to be kept."""
    surface.fill(mesh, session.net.render_map, session.positions)
    state.store(mesh, session.source, session.positions)


def restore(mesh: Any, session: Session) -> None:
    """Shows the shape of a session, whatever the mesh shows now; geometry of others is thrown away."""
    if by_hand.has_other_parts(mesh):
        surface.fill(mesh, session.net.render_map, session.positions)
    else:
        surface.write_positions(mesh, session.net.render_map.apply(session.positions))


def keep(paper: Any, result: FoldResult) -> None:
    """Makes the object of a finished fold (``mesh.add_paper``) a live paper that rests in it."""
    mesh = paper.data
    scale = surface.metres_per_unit(result.pattern.unit_mm)
    description = result.description
    settings = mesh.curvefold
    automatic = description.resolution == AUTO
    settings.resolution = state.AUTOMATIC if automatic else result.net.resolution
    if description.angle is not None:
        settings.angle = math.radians(description.angle)
        settings.fold = 100.0
    settings.least_fold = math.radians(description.least_fold)
    for number, handle in enumerate(description.handles, 1):
        entry = settings.handles.add()
        entry.name = f"Handle {number}"
        entry.at = [c * scale for c in handle.at]
        entry.offset = [c * scale for c in handle.target]
        entry.pinned = True
        entry.axes = handle.axes
        entry.strength = handle.strength
    settings.is_paper = True
    drawing_objects.keep_notes(settings, result.pattern.notes)
    pattern = result.pattern
    if description.assignments == "free":
        # It was folded as if the drawing named no sides, and so it goes on.
        free = tuple(Crease(c.points, c.closed, "U", c.name, c.beziers) for c in pattern.creases)
        pattern = CreasePattern(pattern.boundary, pattern.holes, free, pattern.name, pattern.unit_mm, pattern.notes)
    source = replace(state.source_of(pattern, result.net.resolution, scale), automatic=automatic)
    state.store(mesh, source, result.positions * scale)
    drawn = drawn_of(source)
    controls.match_creases(settings, drawn)
    keep_controls(paper, description.controls, description.weights, drawn, scale)
    mesh_attributes.write_measured(mesh, result.net, result.measurement)
    if result.last.status is Status.SETTLED:
        state.store_rest(mesh, _told(paper, source).numbers())


def _told(paper: Any, source: state.Source) -> hooks.Inputs:
    """What ``hooks.read`` says of a paper whose handles are all pins and whose curves ride on it."""
    settings = paper.data.curvefold
    handles = tuple(
        Handle(tuple(entry.at), tuple(entry.offset), tuple(entry.axes), entry.strength)
        for entry in settings.handles
    )
    here = Matrix.Identity(4)
    scene = paper.users_scene[0] if paper.users_scene else bpy.context.scene

    def curve_points(item: Any) -> tuple[controls.Place, ...]:
        return target_points(item, scene, lambda curve: here, lambda curve: read_strands(curve.data))

    return hooks.with_controls(settings, settings, handles, drawn_of(source), curve_points)
