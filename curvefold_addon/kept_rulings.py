"""Rulings as an attribute of the meshes that ask for them: found again whenever a paper has come to rest."""

from concurrent.futures import Future

import bpy

from .. import solver
from .bridge import mesh_attributes
from .bridge.session import Session
from .bridge.turns import pool

#: Rulings that are being found in the thread, and of which version of the shape.
_finding: dict[int, tuple[int, Future[solver.Rulings]]] = {}


def mark(mesh: bpy.types.Mesh, found: Session) -> bool:
    """Gives a paper's mesh its rulings, which are kept up from now on; whether it has any. Blocking."""
    lines = solver.rulings(found.net, found.positions)
    mesh_attributes.write_rulings(mesh, found.net, lines)
    found.ruled = found.version
    return len(lines.segments) > 0


def keep(mesh: bpy.types.Mesh, found: Session) -> None:
    """A mesh that asks for rulings gets those of the present shape. Blocking."""
    if mesh_attributes.asks_for_rulings(mesh) and found.ruled != found.version:
        mark(mesh, found)


def find(mesh: bpy.types.Mesh, found: Session) -> bool:
    """The same beside Blender, in the thread, for a paper that rests; whether it is still being done."""
    uid = mesh.session_uid
    if not mesh_attributes.asks_for_rulings(mesh) or found.ruled == found.version:
        return False
    if uid not in _finding:
        _finding[uid] = found.version, pool().submit(solver.rulings, found.net, found.positions)
    version, job = _finding[uid]
    if not job.done():
        return True
    del _finding[uid]
    if version != found.version:
        return True  # it has moved since: once more
    mesh_attributes.write_rulings(mesh, found.net, job.result())
    found.ruled = version
    return False


def drop(uid: int) -> None:
    """Nothing is found any more for the mesh with this ``session_uid``."""
    _finding.pop(uid, None)


def forget() -> None:
    """The same for all meshes."""
    _finding.clear()
