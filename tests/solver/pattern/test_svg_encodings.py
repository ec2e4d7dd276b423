"""SVG, FOLD and JSON files in every encoding and wrapper that programs write."""

from __future__ import annotations

import gzip
import io
import json
import time
import tracemalloc
from pathlib import Path

import pytest

import solver
from solver.errors import CurvefoldError, ReadError
from solver.pattern.fold_file import read_fold
from solver.pattern.svg import read_svg
from solver.pattern.text import inflate

SHEET = '<rect width="100" height="100" fill="none" stroke="black"/>'


def svg(name: str, encoding: str | None, before: str = "") -> str:
    declared = f' encoding="{encoding}"' if encoding else ""
    return (
        f'<?xml version="1.0"{declared}?>{before}<svg xmlns="http://www.w3.org/2000/svg">{SHEET}'
        f'<path id="{name}" d="M9 0v99" stroke="red"/></svg>'
    )


def name_in(data: bytes) -> str:
    [pattern] = read_svg(io.BytesIO(data))
    return pattern.creases[0].name


@pytest.mark.parametrize(
    ("declared", "written", "name"),
    [
        ("Shift_JIS", "cp932", "谷折り①"),
        ("x-sjis", "cp932", "谷"),
        ("EUC-JP", "euc_jp", "谷"),
        ("iso-2022-jp", "iso2022_jp", "谷"),
        ("gb18030", "gb18030", "谷"),
        ("GB2312", "gb18030", "谷"),
        ("Big5", "big5", "谷"),
        ("EUC-KR", "cp949", "똠"),
        ("windows-1252", "cp1252", "é“"),
        ("koi8-r", "koi8_r", "ж"),
        ("macintosh", "mac_roman", "é"),
        ("UTF-16", "utf-16", "谷"),
        ("UTF-16", "utf-16-le", "谷"),
        ("UTF-16", "utf-16-be", "谷"),
        ("UTF-32", "utf-32", "谷"),
        ("utf-8", "utf-8-sig", "谷"),
        (None, "utf-8-sig", "谷"),
        (None, "utf-16", "谷"),
        # Programs that keep text in UTF-16 and write UTF-8 declare the former.
        ("utf-16", "utf-8", "谷"),
    ],
)
def test_declared_encodings(declared: str | None, written: str, name: str) -> None:
    assert name_in(svg(name, declared).encode(written)) == name


def test_a_byte_order_mark_in_text() -> None:
    assert read_svg(io.StringIO("\ufeff" + svg("谷", "utf-16")))[0].creases[0].name == "谷"


@pytest.mark.parametrize(
    ("declared", "written", "words"),
    [
        ("klingon", "utf-8", "'klingon'"),
        ("zip", "utf-8", "'zip'"),
        ("rot13", "utf-8", "'rot13'"),
        ("idna", "utf-8", "'idna'"),
        ("unicode_escape", "utf-8", "'unicode_escape'"),
        ("cp500", "utf-8", "declares cp500"),
        ("utf-8", "latin-1", "declares utf-8; wrong in line 1"),
        (None, "latin-1", "declares no encoding"),
        ("utf-8", "utf-8-sig then latin-1", "first bytes say UTF-8"),
    ],
)
def test_unknown_and_wrong_declarations_are_said(declared: str | None, written: str, words: str) -> None:
    start = b"\xef\xbb\xbf" if "sig" in written else b""
    data = start + svg("é", declared).encode(written.rpartition(" ")[2])
    with pytest.raises(ReadError) as caught:
        read_svg(io.BytesIO(data))
    assert words in str(caught.value)
    assert "save it as UTF-8" in str(caught.value)


# ---- compression


@pytest.mark.parametrize("name", ["sheet.svgz", "sheet.SVGZ", "sheet.svg", "sheet.svg.gz"])
def test_compressed_drawings_have_any_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(gzip.compress(svg("a", "utf-8").encode()))
    pattern = solver.read_pattern(path)
    assert pattern.name == "sheet"
    assert len(pattern.creases) == 1


def test_several_members_are_one_file() -> None:
    data = svg("谷", "utf-8").encode()
    assert name_in(gzip.compress(data[:70]) + gzip.compress(data[70:]) + b"\0" * 512) == "谷"


@pytest.mark.parametrize("cut", [-1, -8, -20, 12, 5])
def test_a_compressed_file_that_is_cut_short_is_said(cut: int) -> None:
    with pytest.raises(ReadError, match="ends too early"):
        read_svg(io.BytesIO(gzip.compress(svg("a", "utf-8").encode())[:cut]))


def test_a_damaged_compressed_file_is_said(tmp_path: Path) -> None:
    data = bytearray(gzip.compress(svg("a", "utf-8").encode() * 9))
    data[-6] ^= 255  # of the checksum
    path = tmp_path / "damaged.svgz"
    path.write_bytes(data)
    with pytest.raises(ReadError, match="damaged") as caught:
        solver.read_pattern(path)
    assert str(path) in str(caught.value)


def test_bombs_of_compression_stop_at_the_limit() -> None:
    bomb = gzip.compress(b" " * 50_000_000)
    tracemalloc.start()
    try:
        with pytest.raises(ReadError, match="compressed file holds more than 4 MB"):
            inflate(bomb, 4 * 2**20)
        assert tracemalloc.get_traced_memory()[1] < 10 * 2**20
    finally:
        tracemalloc.stop()
    many = gzip.compress(b" " * 1_000_000) * 70
    with pytest.raises(ReadError, match="compressed file holds more than 64 MB"):
        read_svg(io.BytesIO(many))


# ---- JSON

FOLD = json.dumps(
    {
        "vertices_coords": [[0, 0], [1, 0], [1, 1], [0, 1]],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
        "edges_assignment": ["B", "B", "B", "B", "M"],
    }
)
HANDLES = '[{"at": [0, 0], "target": [1, 1, 1]}]'
JSON_ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32")


@pytest.mark.parametrize("encoding", JSON_ENCODINGS)
def test_json_in_all_of_its_encodings(tmp_path: Path, encoding: str) -> None:
    assert len(read_fold(io.BytesIO(FOLD.encode(encoding)))[0].creases) == 1
    handles = tmp_path / "handles.json"
    handles.write_bytes(HANDLES.encode(encoding))
    assert solver.read_handles(handles)[0].target == (1.0, 1.0, 1.0)
    description = tmp_path / "description.json"
    description.write_bytes('{"angle": 20}'.encode(encoding))
    assert solver.read_description(description).angle == 20


def test_fold_text_with_a_mark_and_fold_that_is_compressed() -> None:
    assert len(read_fold(io.StringIO("\ufeff" + FOLD))[0].creases) == 1
    assert len(read_fold(io.BytesIO(gzip.compress(FOLD.encode())))[0].creases) == 1


# ---- entities


def with_entities(declared: str, body: str) -> bytes:
    return f'<!DOCTYPE svg [{declared}]><svg xmlns="http://www.w3.org/2000/svg">{SHEET}{body}</svg>'.encode()


def test_entities_of_the_file_are_read() -> None:
    """Old Illustrator keeps styles and namespaces in them."""
    data = with_entities(
        '<!ENTITY st0 "fill:none;"><!ENTITY st1 "&st0;stroke:#FF0000;">'
        + "<!ENTITY part \"<path d='M20 0v99' stroke='blue'/>\">",
        '<path style="&st1;" d="M9 0v99"/>&part;',
    )
    assert [crease.assignment for crease in read_svg(io.BytesIO(data))[0].creases] == ["M", "V"]


TENFOLD = [f'<!ENTITY {chr(98 + k)} "{(f"&{chr(97 + k)};") * 10}">' for k in range(25)]
LETTER = '<!ENTITY a "aaaaaaaaaa">'


@pytest.mark.parametrize(
    ("declared", "body", "words"),
    [
        (LETTER + "".join(TENFOLD), "&z;", "stands for more than"),
        ("".join(TENFOLD[::-1]) + LETTER, "&z;", "stands for more than"),
        (LETTER + "".join(TENFOLD).replace("&", "&#38;"), "&z;", "stands for more than"),
        (LETTER + "".join(TENFOLD) + '<!ATTLIST g x CDATA "&z;">', "<g/>" * 1000, "stands for more than"),
        (f'<!ENTITY a "{"a" * 90_000}">', "&a;" * 100_000, "together"),
        (f'<!ENTITY a "{"a" * 90_000}">', '<g id="&a;"/>' * 1_000, "together"),
        ('<!ENTITY a "&b;"><!ENTITY b "&a;">', "&a;", "refers to itself"),
        ("".join(f'<!ENTITY a{k} "x">' for k in range(9_999)), "", "too many XML entities"),
        ('<!ENTITY a SYSTEM "file:///etc/passwd">', "&a;", "another file ('file:///etc/passwd')"),
        ('<!ENTITY a SYSTEM "file:///etc/passwd">', '<g id="&a;"/>', "external entity"),
        ("<!ENTITY % p \"<!ENTITY q 'x'>\"> %p;", "&q;", "not declared"),
    ],
)
def test_entities_that_are_too_much_or_elsewhere_are_refused_quickly(declared: str, body: str, words: str) -> None:
    start = time.process_time()
    with pytest.raises(CurvefoldError) as caught:
        read_svg(io.BytesIO(with_entities(declared, body)))
    assert words in str(caught.value)
    assert "entit" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert time.process_time() - start < 5


def test_what_a_dtd_gives_to_every_element_is_not_copied_to_it() -> None:
    data = with_entities(
        f'<!ATTLIST g x CDATA "{"a" * 100_000}">', "<g/>" * 20_000 + '<path d="M9 0v99" stroke="red"/>'
    )
    tracemalloc.start()
    try:
        read_svg(io.BytesIO(data))
        assert tracemalloc.get_traced_memory()[1] < 100 * 2**20  # copied it would be 2 GB
    finally:
        tracemalloc.stop()


def test_nothing_is_fetched_for_a_parameter_entity() -> None:
    data = with_entities('<!ENTITY % a SYSTEM "http://127.0.0.1:9/x.dtd"> %a;', '<path d="M9 0v99" stroke="red"/>')
    assert len(read_svg(io.BytesIO(data))[0].creases) == 1
