"""The text of a DXF file as its pairs of group codes and values, and what is mended in it before it is read."""

from __future__ import annotations

Tag = tuple[bytes, bytes]

_END = b"EOF"
#: What begins an entity, a table or a section.
_STRUCTURE = b"0"
_SUBCLASS = b"100"
#: The class that the numbers of an entity belong to; files before R2000 know none of these entities.
_CLASSES = {b"LWPOLYLINE": b"AcDbPolyline", b"SPLINE": b"AcDbSpline", b"ELLIPSE": b"AcDbEllipse"}
#: Group codes that all entities share: handle, line type, layer, colours, visibility.
_COMMON = frozenset({b"5", b"6", b"8", b"48", b"60", b"62", b"67", b"330", b"370", b"420"})
#: The version that knows those entities, and how a header says so.
_VERSION, _NEWER = b"$ACADVER", b"AC1015"
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def complete(data: bytes) -> tuple[bytes, tuple[str, ...]]:
    """A text file with the end that it lost, without what stood last, which may have lost a part; and a note.

    Lines that end as on old Macs end with line feeds.
    """
    data = data.removeprefix(_BYTE_ORDER_MARK)
    if data.rstrip().endswith(_END) and b"\n" in data:
        return data, ()
    tags = _tags(data)
    last = max((k for k, (code, _) in enumerate(tags) if code == _STRUCTURE), default=None)
    if last is None or tags[last][1] == _END:
        return _text(tags), ()
    whole = tags[last][1] == b"ENDSEC"
    notes = () if whole else ("the file ends too early, and what was in its last part is lost",)
    return _text([*tags[:last], (_STRUCTURE, b"ENDSEC"), (_STRUCTURE, _END)]), notes


def with_classes(data: bytes) -> bytes:
    """A text file whose newer entities say of which class they are, which some programs leave out."""
    tags = _tags(data)
    starts = [k for k, (code, _) in enumerate(tags) if code == _STRUCTURE]
    result: list[Tag] = tags[: starts[0]] if starts else tags
    for start, end in zip(starts, [*starts[1:], len(tags)], strict=True):
        kind, content = tags[start][1], tags[start + 1 : end]
        result.append(tags[start])
        if kind in _CLASSES:
            content = [tag for tag in content if tag[0] != _SUBCLASS]
            result.append((_SUBCLASS, b"AcDbEntity"))
            result.extend(tag for tag in content if tag[0] in _COMMON)
            result.append((_SUBCLASS, _CLASSES[kind]))
            result.extend(tag for tag in content if tag[0] not in _COMMON)
        else:
            result.extend(_newer(content))
    if not any(value == _VERSION for _, value in result):
        header = [(_STRUCTURE, b"SECTION"), (b"2", b"HEADER"), (b"9", _VERSION), (b"1", _NEWER)]
        result = [*header, (_STRUCTURE, b"ENDSEC"), *result]
    return _text(result)


def _newer(tags: list[Tag]) -> list[Tag]:
    """What belongs to a section, with the version of the file that knows the newer entities."""
    return [
        (b"1", _NEWER) if k and tags[k - 1][1] == _VERSION and value < _NEWER else (code, value)
        for k, (code, value) in enumerate(tags)
    ]


def _tags(data: bytes) -> list[Tag]:
    lines = data.splitlines()
    return [(code.strip(), value.strip()) for code, value in zip(lines[::2], lines[1::2], strict=False)]


def _text(tags: list[Tag]) -> bytes:
    return b"".join(code + b"\n" + value + b"\n" for code, value in tags)
