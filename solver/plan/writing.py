"""Plans as files, whole or not at all, and never over a file that is no plan."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from ..errors import CurvefoldError
from ..files.atomic import write_whole
from ..files.writable import check_writable
from .dxf_pen import DxfPen
from .pdf_pen import PdfPen
from .pen import SIGN, Page, Pen, draw
from .svg_pen import SvgPen

#: Suffix -> pen for a title. A new format is one line here.
PENS: dict[str, Callable[[str], Pen]] = {".svg": SvgPen, ".dxf": DxfPen, ".pdf": PdfPen}
#: Formats that hold several pages in one file.
_BOOKS = (".pdf",)
#: A file of more bytes is not looked through for the sign of a plan.
_MAX_BYTES = 200_000_000


def plan_files(pages: Sequence[Page], path: str | os.PathLike[str], title: str) -> dict[Path, bytes]:
    """The content of each file: one, or in formats of one page one for each page, named after it.

    Raises CurvefoldError for a suffix that is no plan's.
    """
    path = Path(path)
    pen = PENS.get(path.suffix.lower())
    if pen is None:
        raise CurvefoldError(
            f"plans of this kind ({path.suffix or 'no suffix'}) are not written, only {', '.join(PENS)}",
            file=str(path),
        )
    try:
        if path.suffix.lower() in _BOOKS:
            return {path: draw(pages, pen(title))}
        return {
            path.with_name(f"{path.stem}-{page.name}{path.suffix}" if page.name else path.name): draw(
                [page], pen(title)
            )
            for page in pages
        }
    except CurvefoldError as error:
        raise (error if error.where.file else error.in_file(str(path))) from None


def write_files(files: dict[Path, bytes], sources: Iterable[str | os.PathLike[str]] = ()) -> None:
    """Write files of plans, each whole or not at all.

    sources: what the plan is made from. Raises CurvefoldError, before anything is written, where a file would be
    written over one of them, over a file that is no plan, or cannot be written.
    """
    own = list(sources)
    for path in files:
        check_place(path, own)
    for path, content in files.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise CurvefoldError(f"the folder cannot be made ({error.strerror})", file=str(path.parent)) from None
        write_whole(path, content)


def check_place(path: Path, sources: Iterable[str | os.PathLike[str]] = ()) -> None:
    """Raises CurvefoldError where a plan must not be written, or cannot be."""
    if os.path.realpath(path) in {os.path.realpath(source) for source in sources}:
        raise CurvefoldError(
            "the plan would be written over what it is made from; choose another name", file=str(path)
        )
    check_writable(path.parent, [path.name])
    if path.exists() and not _is_plan(path):
        raise CurvefoldError("a file that is no plan has this name already; choose another one", file=str(path))


def _is_plan(path: Path) -> bool:
    """Whether a file was written as a plan, or is empty."""
    try:
        size = path.stat().st_size
        if not path.is_file() or size > _MAX_BYTES:
            return False
        return size == 0 or SIGN.encode("ascii") in path.read_bytes()
    except OSError:
        return False
