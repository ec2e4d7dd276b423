"""Bytes of a file -> its text: compression and encodings."""

from __future__ import annotations

import codecs
import re
import zlib

from ..errors import ReadError

_GZIP = b"\x1f\x8b"
#: Names that Japanese programs write and Python does not know, and encodings whose name stands for more than it
#: says on the web (Encoding Standard, WHATWG): Windows has added characters to them.
_MEANT = {
    "x-sjis": "cp932",
    "shift_jis": "cp932",
    "shift-jis": "cp932",
    "sjis": "cp932",
    "x-euc-jp": "euc_jp",
    "gb2312": "gb18030",
    "gbk": "gb18030",
    "euc-kr": "cp949",
    "ks_c_5601-1987": "cp949",
}
#: Python's text encodings that no drawing is written in: some take quadratic time, others run escapes.
_NOT_OF_FILES = frozenset(
    {"idna", "punycode", "unicode-escape", "raw-unicode-escape", "undefined", "utf-7", "mbcs", "oem", "palmos"}
)
_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
#: How the beginning of "<?xml" or "<svg" looks in encodings of two bytes a character without a mark.
_WIDE = ((b"<\x00", "utf-16-le"), (b"\x00<", "utf-16-be"))
_DECLARED = re.compile(rb"\s*<\?xml\s[^>]{0,200}?\bencoding\s*=\s*[\"']([A-Za-z0-9._:+-]{1,40})[\"']")
_CHUNK = 1 << 20


def inflate(data: bytes, limit: int) -> bytes:
    """``data`` as it was before gzip, or as it is when it is not compressed.

    Never makes more than ``limit`` bytes and a chunk. Raises ReadError when there are more, or it is damaged.
    """
    if not data.startswith(_GZIP):
        return data
    parts: list[bytes] = []
    size = 0
    rest = data
    # A file may hold several members, one after the other; what follows them otherwise is padding.
    while rest.startswith(_GZIP):
        inflater = zlib.decompressobj(wbits=31)
        while not inflater.eof:
            try:
                part = inflater.decompress(rest, _CHUNK)
            except zlib.error as error:
                raise ReadError(f"the compressed file is damaged ({error})") from error
            size += len(part)
            if size > limit:
                raise ReadError(f"the compressed file holds more than {limit / 2**20:.0f} MB, and more is not read")
            parts.append(part)
            rest = inflater.unconsumed_tail
            if not part and not rest and not inflater.eof:
                raise ReadError("the compressed file ends too early: the last part of it is missing")
        rest = inflater.unused_data
    return b"".join(parts)


def decode_xml(data: bytes | str) -> str:
    """The text of an XML file by its byte order mark, else by the encoding that it declares, else UTF-8.

    Raises ReadError when the encoding is not known, or when it is not the one that the file is written in.
    """
    if isinstance(data, str):
        return data.removeprefix("\ufeff")
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return _decoded(data[len(mark) :], encoding, f"its first bytes say {encoding[:6].upper()}")
    for beginning, encoding in _WIDE:
        if data.startswith(beginning):
            return _decoded(data, encoding, f"it looks like {encoding[:6].upper()}")
    match = _DECLARED.match(data)
    if match is None:
        return _decoded(data, "utf-8", "it declares no encoding, which means UTF-8")
    name = match.group(1).decode("ascii")
    encoding = _MEANT.get(name.lower(), name)
    try:
        info = codecs.lookup(encoding)
    except LookupError:
        info = None
    if info is None or not getattr(info, "_is_text_encoding", True) or info.name in _NOT_OF_FILES:
        raise ReadError(f"the encoding {name!r} that it declares is not known; save it as UTF-8")
    if info.name.startswith(("utf-16", "utf-32")):
        # Its declaration has been read byte by byte: it was written by a program that keeps text in UTF-16.
        return _decoded(data, "utf-8", f"it declares {name}, but is not written in it")
    return _decoded(data, info.name, f"it declares {name}")


def decode_plain(data: bytes | str) -> str:
    """The text of a file of numbers and words by its byte order mark, else as UTF-8.

    What is no text becomes a question mark in a box, so that its line can be told.
    """
    if isinstance(data, str):
        return data.removeprefix("\ufeff")
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return data[len(mark) :].decode(encoding, "replace")
    return data.decode("utf-8", "replace")


def _decoded(data: bytes, encoding: str, why: str) -> str:
    try:
        text = data.decode(encoding)
    except (UnicodeError, ValueError) as error:
        at = getattr(error, "start", 0)
        line = data.count(b"\n", 0, at) + 1
        raise ReadError(
            f"it is not text in its encoding ({why}; wrong in line {line}); save it as UTF-8"
        ) from error
    if not text.lstrip()[:1] == "<" and data.lstrip()[:1] == b"<":
        raise ReadError(f"it is not text in its encoding ({why}); save it as UTF-8")
    return text
