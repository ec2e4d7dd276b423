"""DXF files (R12 to R2018, text and binary) -> lines with a meaning.

Units are the drawing's own, y is up as in the file. The steps: the library ezdxf reads and mends, ``dxf_walk`` goes
through entities and blocks, ``dxf_shapes`` makes outlines of them, ``dxf_looks`` says what else is known of each.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import Any

from ..dxf_library import dxf_library
from ..errors import ReadError
from .drawing_format import DrawingFormat
from .drawn_lines import lines_of_drawn
from .dxf_text import complete, with_classes
from .dxf_walk import walk
from .read_options import ReadOptions
from .sizes import NO_SIZE
from .stroke import Lines

#: Millimetres in one unit by $INSUNITS (DXF reference, header variables). 0 and other numbers say nothing.
_UNIT_MM = {
    1: 25.4,
    2: 304.8,
    3: 1_609_344.0,
    4: 1.0,
    5: 10.0,
    6: 1e3,
    7: 1e6,
    8: 25.4e-6,
    9: 25.4e-3,
    10: 914.4,
    11: 1e-7,
    12: 1e-6,
    13: 1e-3,
    14: 100.0,
    15: 1e4,
    16: 1e5,
}
#: Pairs of a group code and a value, of which each takes a line of text, or some bytes of a binary file at least.
MAX_TAGS = 1_000_000
_LEAST_BYTES = 8
_BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"
_DRAWING = b"AC10"


def _lines(data: bytes | str, options: ReadOptions) -> Lines:
    raw = data.encode("utf-8", "surrogateescape") if isinstance(data, str) else data
    _check(raw)
    document, notes = _document(raw)
    entities, where = _entities(document)
    walked = walk(document, entities)
    notes = (*notes, *where, *walked.notes)
    unit_mm = _UNIT_MM.get(document.header.get("$INSUNITS", 0))
    if unit_mm is None and options.unit is None:
        notes = (*notes, NO_SIZE)
    return lines_of_drawn(walked.lines, unit_mm, notes)


def _check(data: bytes) -> None:
    if not data.strip():
        raise ReadError("the file is empty")
    if data.startswith(_DRAWING):
        raise ReadError("this is a DWG file and no DXF file: save the drawing as DXF")
    if not data.startswith(_BINARY) and b"SECTION" not in data:
        raise ReadError("this is not a readable DXF file (there is no section in it)")
    tags = len(data) // _LEAST_BYTES if data.startswith(_BINARY) else max(data.count(b"\n"), data.count(b"\r")) // 2
    if tags > MAX_TAGS:
        raise ReadError(f"the file has more than {MAX_TAGS:,} entries, and more is not read")


def _document(data: bytes) -> tuple[Any, tuple[str, ...]]:
    """The drawing, mended where it was damaged, with a note about that. Raises CurvefoldError."""
    library = dxf_library()
    try:
        if data.startswith(_BINARY):
            loader = library.lldxf.tagger.binary_tags_loader(data)
            return library.document.Drawing.load(loader), ()
        data, notes = complete(data)
        try:
            document, faults = _recovered(data)
        except library.DXFStructureError:
            document, faults = _recovered(with_classes(data))
    except Exception as error:
        # A damaged file makes the library fail in all ways that Python knows.
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        raise ReadError(f"this is not a readable DXF file ({reason})") from error
    if faults:
        count = "1 fault" if len(faults) == 1 else f"{len(faults):,} faults"
        notes = (*notes, f"the file is damaged, {count} mended: {' '.join(faults[0].split())[:120]}")
    return document, notes


def _recovered(data: bytes) -> tuple[Any, list[str]]:
    """The drawing in a text file, and what was mended in it.

    As ``ezdxf.recover.read`` does it, without the audit that follows there: it takes unknown line types away, which
    say something here, and looks for blocks in blocks by ways that are as many as 2 to the power of the blocks.
    """
    library = dxf_library()
    tool = library.recover.Recover.run(io.BytesIO(data))
    document = library.document.Drawing()
    document._load_section_dict(tool.section_dict)
    return document, [message for _, message in (*tool.fixes, *tool.errors)]


def _entities(document: Any) -> tuple[Iterable[Any], tuple[str, ...]]:
    """What is drawn in the model space, or else on the first layout that holds anything."""
    model = document.modelspace()
    if len(model):
        return model, ()
    for layout in document.layouts:
        if any(entity.dxftype() != "VIEWPORT" for entity in layout):
            return layout, (f"the model space is empty: read is what lies on layout {layout.name[:60]!r}",)
    return model, ()


DXF = DrawingFormat("DXF", (".dxf",), _lines)
read_dxf = DXF.read
