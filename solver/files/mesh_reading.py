"""One door for all folded meshes: the file's suffix says which reader."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ..errors import ReadError
from ..sheet_mesh import SheetMesh
from .fold_mesh import read_fold_mesh
from .obj_reading import read_obj_mesh

#: Suffix -> reader. A new format is one line here.
READERS: dict[str, Callable[[str | Path], SheetMesh]] = {".obj": read_obj_mesh, ".fold": read_fold_mesh}


def read_mesh(path: str | Path) -> SheetMesh:
    """The folded mesh in a file, with its flat sheet. Raises ReadError and PatternError, both with the file."""
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ReadError(
            f"meshes of this kind ({path.suffix or 'no suffix'}) are not read, only {', '.join(READERS)}",
            file=str(path),
        )
    return reader(path)
