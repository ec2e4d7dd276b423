"""Whether a paper's mesh is as the extension has written it, or somebody has changed it by hand since.

Joining, sculpting, applying a scale or a modifier, and Edit Mode all change the geometry itself, which a paper
would write over. So each mesh keeps a fingerprint of what was last written to it, beside the shape that is kept.
"""

from __future__ import annotations

from collections import OrderedDict
from hashlib import blake2b
from typing import Any

import numpy as np
from mathutils import Matrix  # type: ignore[import-not-found]
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SHOWN = "curvefold_shown"

#: Bytes of a fingerprint: enough that no two shapes share one.
_DIGEST = 16
#: Fingerprints that are remembered. Undo may lead a mesh in Edit Mode to an older shape than its properties.
_REMEMBERED = 1 << 14
#: A mesh is moved as one when no vertex is farther from where that puts it, relative to the mesh's longest side.
_AS_ONE = 1e-5

_written: OrderedDict[str, None] = OrderedDict()


def note(mesh: Any) -> None:
    """The mesh is as the extension wants it."""
    written = f"{_parts(mesh)} {_places(mesh)}"
    mesh[_SHOWN] = written
    _written[written] = None
    while len(_written) > _REMEMBERED:
        _written.popitem(last=False)


def forget() -> None:
    """Another file: nothing of the old one is left."""
    _written.clear()


def is_changed(mesh: Any) -> bool:
    """Whether somebody has changed the geometry since it was last written.

    Vertices of a mesh with shape keys are where the keys want them, so there only the number of its parts counts.
    """
    noted = mesh.get(_SHOWN)
    if noted is None:
        return False  # never written, or by a version that noted nothing
    if mesh.shape_keys is not None:
        return has_other_parts(mesh)
    present = f"{_parts(mesh)} {_places(mesh)}"
    return bool(present != noted) and present not in _written


def has_other_parts(mesh: Any) -> bool:
    """Whether the mesh has more or fewer vertices, edges, corners or faces than were last written to it."""
    noted = mesh.get(_SHOWN)
    return noted is not None and str(noted).rpartition(" ")[0] != _parts(mesh)


def moved_as_one(mesh: Any, shown: Array) -> Any:
    """The 4×4 matrix that takes ``shown`` (R,3) to the vertices of a mesh; None when no single one does.

    Of a plane shape nothing is known about its third axis: it gets the mean length of the other two.
    """
    present = _positions(mesh).reshape(-1, 3).astype(np.float64)
    if present.shape != shown.shape or not np.isfinite(present).all():
        return None
    start, end = shown.mean(axis=0), present.mean(axis=0)
    _, sizes, axes = np.linalg.svd(shown - start, full_matrices=False)
    if not sizes[1] > 1e-6 * sizes[0]:
        return None
    plane = not sizes[2] > 1e-6 * sizes[0]
    known = axes[:2] if plane else axes
    images = np.linalg.lstsq((shown - start) @ known.T, present - end, rcond=None)[0]  # one row for each axis
    if plane:
        normal = np.cross(images[0], images[1]) * np.sign(np.linalg.det(axes))
        area = float(np.linalg.norm(normal))
        if not area > 0.0:
            return None
        images = np.vstack([images, normal / np.sqrt(area)])
    linear = images.T @ axes
    gaps = np.abs((shown - start) @ linear.T + end - present)
    if gaps.max() > _AS_ONE * np.ptp(present, axis=0).max() or not abs(np.linalg.det(linear)) > 0.0:
        return None
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, end - linear @ start
    return Matrix(matrix.tolist())


def move_objects(mesh: Any, matrix: Any, objects: Any) -> bool:
    """Moves those of ``objects`` that show a mesh by a matrix of its local coordinates; what hangs on them stays.

    Nothing is moved, and False returned, where an object can be neither moved nor turned nor scaled like that.
    """
    showing = [item for item in objects if item.data == mesh]
    before = [item.matrix_basis.copy() for item in showing]
    for item, basis in zip(showing, before, strict=True):
        item.matrix_basis = basis @ matrix
    size = max(1e-30, *(abs(value) for row in matrix for value in row))
    for item, basis in zip(showing, before, strict=True):
        gap = max(abs(value) for row in item.matrix_basis - basis @ matrix for value in row)
        if gap > 1e-4 * size * max(1e-30, *(abs(value) for row in basis for value in row)):
            for moved, place in zip(showing, before, strict=True):
                moved.matrix_basis = place
            return False
    back = matrix.inverted()
    for item in showing:
        for child in item.children:
            child.matrix_parent_inverse = back @ child.matrix_parent_inverse
    return True


def _parts(mesh: Any) -> str:
    return f"{len(mesh.vertices)} {len(mesh.edges)} {len(mesh.loops)} {len(mesh.polygons)}"


def _places(mesh: Any) -> str:
    # A zero is a zero: transforms that move nothing may change its sign.
    return blake2b((_positions(mesh) + np.float32(0.0)).tobytes(), digest_size=_DIGEST).hexdigest()


def _positions(mesh: Any) -> NDArray[np.float32]:
    """(3V,) as they were when Edit Mode was last entered, left, or read out."""
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    if mesh.is_editmode:
        mesh.vertices.foreach_get("co", values)  # there, attributes are those of the edited mesh
    elif len(values):
        mesh.attributes["position"].data.foreach_get("vector", values)  # many times as fast
    return values
