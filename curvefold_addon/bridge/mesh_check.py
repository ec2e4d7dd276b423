"""Whether a mesh is paper, as it is shown: its flat sheet is its UV map, and a paper's net is asked as well."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...solver.sheet_mesh import SheetMesh
from ...solver.verify import Fault, Verification, verify
from ...solver.verify_mesh import verdict, verify_mesh
from . import mesh as surface
from . import mesh_overlay, report
from .session import Session

#: The object's axes are as long as each other, and square, within this.
_EVEN = 1e-4
#: Blender's own attributes of what is selected.
_SELECTED = (".select_vert", ".select_edge", ".select_poly")
#: How sentences about meshes without modifiers begin.
_AS_IT_IS = "This"

Array = NDArray[np.float64]


class CheckError(ValueError):
    """A mesh cannot be checked; ``str()`` is one sentence."""


@dataclass(frozen=True)
class PaperCheck:
    """sentence: what was found, for the user; vertex: of the mesh, where it is wrong first, None if nowhere."""

    ok: bool
    sentence: str
    vertex: int | None


def check(item: Any, depsgraph: Any, session: Session | None) -> PaperCheck:
    """Checks what an object shows; session: that of a paper, whose net is checked where the mesh shows it.

    Modifiers that only move vertices count; where they make others the mesh is checked without them. Raises
    CheckError when the mesh has no faces or no UV map.
    """
    mesh = item.data
    layer = mesh.uv_layers.get(surface.FLAT_UV) or mesh.uv_layers.active
    if not len(mesh.polygons):
        raise CheckError(f"{item.name} has no faces")
    if layer is None:
        raise CheckError(f"{item.name} has no UV map, which has to be its flat sheet")
    evaluated = item.evaluated_get(depsgraph)
    positions, shown = _shown(evaluated, mesh)
    axes = np.array(evaluated.matrix_world, dtype=np.float64)[:3, :3]
    corners, starts, flat = _corners(mesh, layer)
    found = verify_mesh(SheetMesh(positions @ axes.T, starts, corners, flat))
    begin, words, folds = _begin(item, shown), "", ""
    if session is not None and surface.shows(mesh, session.net.render_map.apply(session.positions)):
        found, folds = _with_net(found, verify(session.net, session.positions)), _folds(session)
        # Modifiers make another shape of it.
        words = _figures(session, found) if begin == _AS_IT_IS and found.ok else ""
    sentence = f"{begin} is {words or verdict(found)}"
    if found.ok:
        return PaperCheck(True, sentence + folds, None)
    if not _is_even(axes) and any(fault.check == "isometry" for fault in found.faults):
        sentence += "; the object is scaled unevenly"
    return PaperCheck(False, sentence, _first_vertex(found.faults, corners, flat))


def select_vertex(mesh: Any, vertex: int) -> None:
    """Nothing but one vertex is selected when Edit Mode begins."""
    # Where an attribute is missing nothing is selected; Blender 5.0 crashes when edges are set one by one.
    for name in _SELECTED:
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    mesh.vertices[vertex].select = True


def _shown(evaluated: Any, mesh: Any) -> tuple[Array, bool]:
    """(V,3) positions of the mesh's own vertices, and whether they are those that are shown."""
    made = evaluated.to_mesh()
    try:
        if mesh_overlay.counts(made) == mesh_overlay.counts(mesh):
            values = np.empty(3 * len(made.vertices), dtype=np.float32)
            made.attributes["position"].data.foreach_get("vector", values)
            return values.reshape(-1, 3).astype(np.float64), True
    finally:
        evaluated.to_mesh_clear()
    return mesh_overlay.shown_positions(mesh), False


def _corners(mesh: Any, layer: Any) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """(L,) vertices of the corners, (F+1,) where faces begin among them, (L,2) corners on the flat sheet."""
    count = len(mesh.loops)
    corners = np.empty(count, dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    flat = np.empty(2 * count, dtype=np.float32)
    layer.uv.foreach_get("vector", flat)
    return corners.astype(np.int64), np.append(starts, count).astype(np.int64), flat.reshape(-1, 2).astype(float)


def _with_net(shown: Verification, net: Verification) -> Verification:
    """The faults of both; a crease that is not folded is paper too."""
    faults = tuple(fault for fault in net.faults if fault.check != "sides")
    return Verification(shown.figures, (*shown.faults, *faults))


def _figures(session: Session, found: Verification) -> str:
    """What is said of a paper without faults, with the stretch that the tab shows."""
    stretch = session.measurement.stretch
    words = report.stretch_words(float(stretch.mean()), float(stretch.max()))
    return f"paper: {words}, angles around a vertex change by {found.figures['angle_defect_mean']:.2f}°"


def _folds(session: Session) -> str:
    """What is to be added about a paper's folds, in the words of the tab."""
    if report.is_flat(session):
        return "; none of its creases is folded" if session.net.crease_labels else ""
    unfolded = report.not_folded(report.describe_creases(session))
    return f"; {unfolded}" if unfolded else ""


def _begin(item: Any, shown: bool) -> str:
    if not any(modifier.show_viewport for modifier in item.modifiers):
        return _AS_IT_IS
    return "With its modifiers this" if shown else "Without its modifiers this"


def _is_even(axes: Array) -> bool:
    products = axes.T @ axes
    size = float(np.trace(products)) / 3.0
    return bool(np.abs(products - size * np.eye(3)).max() <= _EVEN * size)


def _first_vertex(faults: tuple[Fault, ...], corners: NDArray[np.int64], flat: Array) -> int | None:
    """Where the first fault is that is in one place."""
    place = next((fault.place for fault in faults if fault.place is not None), None)
    return None if place is None else int(corners[np.argmin(np.linalg.norm(flat - np.array(place), axis=1))])
