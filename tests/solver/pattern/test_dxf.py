"""DXF files: by hand from the DXF reference, and as ezdxf writes them."""

from __future__ import annotations

import io
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from dxf_files import CORNERS, block, border, entity, insert, layer, line, linetype, r12, text
from ezdxf import colors, recover
from ezdxf.math import BSpline

import solver
from solver.pattern.curves import sample_crease
from solver.pattern.dxf import read_dxf
from solver.pattern.sizes import NO_SIZE

VERSIONS = ("R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018")
MM = [(9, "$INSUNITS"), (70, 4)]


def read(data: bytes, **options: Any) -> solver.CreasePattern:
    [pattern] = read_dxf(io.BytesIO(data), solver.ReadOptions(**options))
    return pattern


def letters(pattern: solver.CreasePattern) -> str:
    return "".join(sorted(crease.assignment for crease in pattern.creases))


def written(draw: Callable[[Any, Any], None], version: str = "R2010", binary: bool = False) -> bytes:
    """A file of ezdxf: a border of 100 by 80 on layer "border", and what ``draw(document, model space)`` adds."""
    document = ezdxf.new(version, units=4)
    document.layers.add("border")
    model = document.modelspace()
    corners = [(0, 0), (100, 0), (100, 80), (0, 80)]
    if version == "R12":
        model.add_polyline2d(corners, close=True, dxfattribs={"layer": "border"})
    else:
        model.add_lwpolyline(corners, close=True, dxfattribs={"layer": "border"})
    draw(document, model)
    if binary:
        stream = io.BytesIO()
        document.write(stream, fmt="bin")
        return stream.getvalue()
    out = io.StringIO()
    document.write(out)
    return out.getvalue().encode(document.output_encoding, errors="dxfreplace")


def only_crease(draw: Callable[[Any, Any], None], version: str = "R2010") -> solver.Crease:
    [crease] = read(written(draw, version)).creases
    return crease


def off_circle(crease: solver.Crease, centre: tuple[float, float], radius: float) -> float:
    """How far a crease is from a circle at most, between the points of its drawing too."""
    points = sample_crease(crease, 1.0)
    return float(np.abs(np.hypot(*(points - centre).T) - radius).max())


# ---- by hand


def test_lines_of_a_file_without_tables() -> None:
    pattern = read(r12(border(), line((0, 30), (100, 40), (62, 1)), line((0, 50), (100, 60), (62, 5))))
    assert letters(pattern) == "MV"
    assert shapely.Polygon(pattern.boundary).area == pytest.approx(8000)
    assert pattern.unit_mm is None
    assert NO_SIZE in pattern.notes


def test_layers_come_before_colours() -> None:
    """As an old program for origami writes them: mountains blue, valleys red."""
    pattern = read(
        r12(
            border(),
            line((0, 30), (100, 40), (6, "CONTINUOUS"), (62, 5), layer="MountainLine"),
            line((0, 60), (50, 60), (6, "CONTINUOUS"), (62, 1), layer="ValleyLine"),
        )
    )
    first, second = pattern.creases
    assert (first.assignment, second.assignment) == ("M", "V")
    assert any("alone would mean a valley crease" in note and "(layer)" in note for note in pattern.notes)


@pytest.mark.parametrize(
    ("code", "mm"), [(1, 25.4), (2, 304.8), (4, 1.0), (5, 10.0), (6, 1000.0), (13, 1e-3), (14, 100.0), (10, 914.4)]
)
def test_units_of_the_header(code: int, mm: float) -> None:
    pattern = read(r12(border(), line((0, 30), (100, 40)), header=[(9, "$INSUNITS"), (70, code)]))
    assert pattern.unit_mm == pytest.approx(mm)
    assert NO_SIZE not in pattern.notes


def test_unit_and_scale_may_be_chosen(tmp_path: Path) -> None:
    path = tmp_path / "sheet.dxf"
    path.write_bytes(r12(border(), line((0, 30), (100, 40)), header=MM))
    assert solver.read_pattern(path, solver.ReadOptions(unit="in", scale=2.0)).unit_mm == pytest.approx(50.8)
    assert solver.read_pattern(path).name == "sheet"


def test_layers_that_are_off_or_frozen_are_left_out_and_told() -> None:
    pattern = read(
        r12(
            border(),
            line((0, 30), (100, 40), layer="folds"),
            line((0, 50), (100, 60), layer="Old"),
            line((0, 55), (100, 65), layer="OLD"),
            line((0, 60), (100, 70), layer="ice"),
            line((0, 5), (100, 5), (60, 1)),
            layers=[*layer("folds", 1), *layer("old", -1), *layer("ice", 1, flags=1)],
        )
    )
    assert len(pattern.creases) == 1
    assert "2 entities on layer 'old', which is off: left out" in pattern.notes
    assert "1 entity on layer 'ice', which is frozen: left out" in pattern.notes
    assert any("1 entity invisible" in note for note in pattern.notes)


def test_a_line_takes_colour_and_line_type_from_its_layer() -> None:
    pattern = read(
        r12(
            border(),
            line((0, 30), (100, 40), layer="one"),
            line((0, 50), (100, 60), layer="two"),
            line((0, 60), (100, 70), (62, 1), layer="two"),
            layers=[*layer("one", 1), *layer("two", 5)],
        )
    )
    assert [crease.assignment for crease in pattern.creases] == ["M", "V", "M"]


def test_line_types_are_dashes_by_their_lengths_whatever_their_name() -> None:
    pattern = read(
        r12(
            border(),
            line((0, 30), (100, 40), (6, "A")),
            line((0, 50), (100, 60), layer="one"),
            layers=layer("one", 7, linetype="B"),
            linetypes=[*linetype("A", 0.5, -0.25, 0.0, -0.25), *linetype("B", 0.5, -0.25)],
        )
    )
    assert [crease.assignment for crease in pattern.creases] == ["M", "V"]


def test_blocks_in_blocks_scaled_mirrored_and_turned() -> None:
    """An arc of radius 1 around (1, 0) through (0, 0), first doubled at (10, 0), then mirrored and turned."""
    inner = block("inner", entity("ARC", (10, 1), (20, 0), (40, 1), (50, 90), (51, 180)))
    outer = block("outer", insert("inner", (10, 0), (41, 2), (42, 2)), base=(10, 0))
    pattern = read(r12(border(), insert("outer", (50, 40), (41, -10), (42, 10), (50, 90)), blocks=[*inner, *outer]))
    [crease] = pattern.creases
    # In the outer block the arc goes from (2, 2) to (0, 0) about (2, 0); x is turned round and becomes y.
    assert off_circle(crease, (50, 20), 20) < 1e-4
    ends = sorted(map(tuple, np.round(crease.points[[0, -1]], 6).tolist()))
    assert ends == [(30.0, 20.0), (50.0, 40.0)]
    assert crease.beziers is not None


def test_a_block_takes_layer_and_colour_of_its_reference() -> None:
    parts = block(
        "part",
        line((0, 0), (100, 0)),  # on layer 0: where the reference is
        line((0, 10), (100, 10), (62, 0), layer="red"),  # of the colour of the reference
        line((0, 20), (100, 20), layer="red"),
    )
    pattern = read(
        r12(
            border(),
            insert("part", (0, 30), (62, 5), layer="blue"),
            blocks=parts,
            layers=[*layer("red", 1), *layer("blue", 5)],
        )
    )
    assert [crease.assignment for crease in pattern.creases] == ["V", "V", "M"]


def test_rows_and_columns_of_a_block() -> None:
    part = block("part", line((0, 0), (5, 5)))
    grid = insert("part", (10, 10), (70, 3), (71, 2), (44, 20), (45, 30))
    pattern = read(r12(border(), grid, blocks=part))
    starts = sorted(tuple(np.round(crease.points[0], 6)) for crease in pattern.creases)
    assert starts == [(10, 10), (10, 40), (30, 10), (30, 40), (50, 10), (50, 40)]


def test_what_is_seen_from_below_is_mirrored() -> None:
    """Extrusion (0, 0, -1): x of the entity's own system points to the left."""
    down = ((210, 0), (220, 0), (230, -1))
    pattern = read(r12(border(), entity("ARC", (10, -50), (20, 40), (40, 30), (50, 0), (51, 90), *down)))
    [crease] = pattern.creases
    assert off_circle(crease, (50, 40), 30) < 1e-4
    ends = sorted(map(tuple, np.round(crease.points[[0, -1]], 6).tolist()))
    assert ends == [(20.0, 40.0), (50.0, 70.0)]


def test_an_old_polyline_with_a_bulge_and_without_the_frame_of_its_spline() -> None:
    vertex = [(0, "VERTEX"), (8, "0")]
    bulged = [
        *entity("POLYLINE", (66, 1), (70, 4)),
        *vertex, (10, 20), (20, 40), (42, 1.0),
        *vertex, (10, 50), (20, 99), (70, 16),
        *vertex, (10, 80), (20, 40),
        (0, "SEQEND"),
    ]  # fmt: skip
    [crease] = read(r12(border(), bulged)).creases
    # A bulge of 1 is half a circle, counter-clockwise: below.
    assert off_circle(crease, (50, 40), 30) < 1e-4
    assert crease.points[:, 1].min() == pytest.approx(10, abs=1e-3)


def test_what_is_no_line_is_told() -> None:
    pattern = read(
        r12(
            border(),
            line((0, 30), (100, 40)),
            entity("TEXT", (10, 5), (20, 5), (40, 2), (1, "fold here")),
            entity("POINT", (10, 5), (20, 5)),
            entity("NOVELTY", (10, 5)),
            entity("POINT", (10, 6), (20, 5)),
            insert("lost", (0, 0)),
        )
    )
    assert any("1 TEXT, 2 POINT, 1 NOVELTY" in note for note in pattern.notes)
    assert "1 INSERT left out: the file has no block 'lost'" in pattern.notes


# ---- by ezdxf


@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
@pytest.mark.parametrize("version", VERSIONS)
def test_all_versions(version: str, binary: bool) -> None:
    def draw(document: Any, model: Any) -> None:
        document.layers.add("Bergfalz", color=5)
        model.add_arc((50, 0), 60, 30, 150, dxfattribs={"layer": "Bergfalz"})

    pattern = read(written(draw, version, binary))
    [crease] = pattern.creases
    assert crease.assignment == "M"
    assert off_circle(crease, (50, 0), 60) < 1e-4
    assert pattern.unit_mm == (None if version == "R12" else 1.0)


def test_a_name_in_any_alphabet() -> None:
    def draw(document: Any, model: Any) -> None:
        document.layers.add("谷折り線")
        model.add_line((0, 30), (100, 40), dxfattribs={"layer": "谷折り線"})

    assert letters(read(written(draw, "R2000"))) == "V"
    assert letters(read(written(draw, "R2018"))) == "V"


def test_circles_and_ellipses_are_closed_and_stay_round() -> None:
    def draw(_document: Any, model: Any) -> None:
        model.add_circle((30, 40), 20, dxfattribs={"color": 1})
        model.add_ellipse((75, 40), (0, 30), 0.5, dxfattribs={"color": 1})

    circle, ellipse = read(written(draw)).creases
    assert circle.closed
    assert ellipse.closed
    assert off_circle(circle, (30, 40), 20) < 1e-4
    seen = (sample_crease(ellipse, 1.0) - (75, 40)) / (15, 30)
    assert np.abs(np.hypot(*seen.T) - 1).max() < 1e-5


def test_a_part_of_an_ellipse() -> None:
    crease = only_crease(lambda _, model: model.add_ellipse((50, 40), (30, 0), 0.5, 0.0, math.pi / 2))
    ends = np.round(crease.points[[0, -1]], 6).tolist()
    assert ends == [[80.0, 40.0], [50.0, 55.0]]


def test_bulges_are_arcs() -> None:
    crease = only_crease(
        lambda _, model: model.add_lwpolyline([(0, 40, math.tan(math.pi / 8)), (100, 40)], format="xyb")
    )
    # A quarter of a circle over a chord of 100, bending down.
    radius = 100 / math.sqrt(2)
    assert off_circle(crease, (50, 40 + radius / math.sqrt(2)), radius) < 1e-4
    assert crease.beziers is not None
    assert len(crease.beziers) < 5


def test_a_cubic_spline_is_exactly_its_cubics() -> None:
    points = [(0, 20), (20, 60), (50, 0), (70, 70), (100, 40)]
    crease = only_crease(lambda _, model: model.add_open_spline(points, degree=3))
    spline = BSpline([(*point, 0) for point in points], order=4)
    assert crease.beziers is not None
    assert len(crease.beziers) == 2
    exact = shapely.LineString([point.vec2 for point in spline.approximate(2000)])
    off = shapely.distance(exact, shapely.points(sample_crease(crease, 0.5)))
    assert off.max() < 1e-3


@pytest.mark.parametrize("degree", [2, 4, 5, 9])
def test_splines_of_other_degrees_within_the_tolerance(degree: int) -> None:
    rng = np.random.default_rng(degree)
    points = np.column_stack([np.linspace(0, 100, 14), rng.uniform(10, 70, 14)])
    crease = only_crease(lambda _, model: model.add_open_spline(points.tolist(), degree=degree))
    spline = BSpline([(*point, 0) for point in points.tolist()], order=degree + 1)
    assert crease.beziers is not None
    exact = shapely.LineString([point.vec2 for point in spline.approximate(20000)])
    joints = crease.beziers[:, [0, 3]].reshape(-1, 2)
    off = shapely.distance(exact, shapely.points(np.vstack([sample_crease(crease, 0.2), joints])))
    assert off.max() < 1e-4


def test_a_rational_spline_is_a_circle() -> None:
    half = math.sqrt(0.5)
    points = [(80, 40), (80, 70), (50, 70), (20, 70), (20, 40)]

    def draw(_document: Any, model: Any) -> None:
        model.add_rational_spline(points, [1, half, 1, half, 1], degree=2, knots=[0, 0, 0, 1, 1, 2, 2, 2])

    assert off_circle(only_crease(draw), (50, 40), 30) < 1e-4


def test_a_spline_of_points_that_it_goes_through() -> None:
    points = [(0, 20), (30, 60), (60, 30), (100, 50)]

    def draw(_document: Any, model: Any) -> None:
        model.add_spline(points)

    crease = only_crease(draw)
    line_ = shapely.LineString(sample_crease(crease, 0.5))
    assert shapely.distance(line_, shapely.points(points)).max() < 1e-2


def test_a_closed_spline_is_closed() -> None:
    """Its knots are not repeated at its ends: the curve begins and ends where the first and last span do."""
    corners = [(20, 20), (80, 20), (80, 60), (20, 60)]

    def draw(_document: Any, model: Any) -> None:
        spline = model.add_spline(degree=3)
        spline.set_closed([(*corner, 0) for corner in corners])

    crease = only_crease(draw)
    assert crease.closed
    assert np.ptp(crease.points, axis=0) == pytest.approx([55, 110 / 3], rel=1e-3)


def test_true_colours_beat_numbers_and_white_is_what_black_is() -> None:
    def draw(_document: Any, model: Any) -> None:
        red, white = colors.rgb2int((255, 0, 0)), colors.rgb2int((255, 255, 255))
        model.add_line((0, 30), (100, 40), dxfattribs={"color": 5, "true_color": red})
        model.add_lwpolyline([(40, 50), (60, 50), (60, 70)], close=True, dxfattribs={"true_color": white})
        model.add_line((0, 10), (100, 10), dxfattribs={"color": 5})

    pattern = read(written(draw))
    assert letters(pattern) == "MV"
    assert len(pattern.holes) == 1


def test_a_drawing_that_lies_on_a_layout() -> None:
    document = ezdxf.new("R2010")
    document.layout().add_lwpolyline([(0, 0), (10, 0), (10, 10)], close=True)
    document.layout().add_line((2, 1), (8, 4), dxfattribs={"color": 1})
    out = io.StringIO()
    document.write(out)
    pattern = read(out.getvalue().encode())
    assert len(pattern.creases) == 1
    assert any("model space is empty" in note for note in pattern.notes)


def test_dimensions_and_hatches_are_told() -> None:
    def draw(_document: Any, model: Any) -> None:
        model.add_line((0, 30), (100, 40))
        model.add_linear_dim(base=(0, -10), p1=(0, 0), p2=(100, 0)).render()
        model.add_hatch().paths.add_polyline_path([(0, 0), (9, 0), (9, 9)])

    pattern = read(written(draw))
    assert len(pattern.creases) == 1
    assert any("1 DIMENSION, 1 HATCH" in note for note in pattern.notes)


# ---- what is wrong


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "empty"),
        (b"  \n", "empty"),
        (b"AC1032\0\0\0\0", "a DWG file"),
        (b"<svg/>", "not a readable DXF file"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00\x00SEC", "not a readable DXF file"),
        (b"\x89PNG\r\n\x1a\n" + bytes(range(256)), "not a readable DXF file"),
        (text([(0, "EOF")]), "no section in it"),
        (r12(), "no line"),
        (r12(line((1, 1), (1, 1))), "no size"),
        (b"SECTION\n" * 2_000_004, "1,000,000 entries"),
        (r12(insert("a", (0, 0)), blocks=block("a", insert("a", (0, 0)))), "circle"),
    ],
)
def test_what_is_no_drawing_is_refused_in_a_sentence(data: bytes, said: str) -> None:
    with pytest.raises(solver.CurvefoldError, match=said) as caught:
        read(data)
    assert "\n" not in str(caught.value)


def test_blocks_that_would_grow_beyond_all_bounds() -> None:
    blocks = [tag for k in range(12) for tag in block(f"b{k}", *(insert(f"b{k + 1}", (0, 0)) for _ in range(10)))]
    blocks += block("b12", line((0, 0), (1, 1)))
    with pytest.raises(solver.PatternError, match="more than"):
        read(r12(border(), insert("b0", (0, 0)), blocks=blocks))
    with pytest.raises(solver.PatternError, match="more than"):
        read(
            r12(
                insert("b", (0, 0), (70, 30000), (71, 30000), (44, 1), (45, 1)),
                blocks=block("b", line((0, 0), (1, 1))),
            )
        )


def test_a_damaged_file_gives_what_is_left_of_it() -> None:
    whole = written(lambda _, model: model.add_line((0, 30), (100, 40)))
    # The sections after the entities are lost, as when a disk was full.
    cut = whole[: whole.index(b"OBJECTS")]
    assert len(read(cut).creases) == 1


def outlined(header: str = "AC1014") -> bytes:
    """As a drawing program writes it: few tables, entities with their classes, a z where there is none."""

    def common(name: str, layer_name: str, handle: str) -> list[tuple[int, Any]]:
        return [(5, handle), (100, "AcDbEntity"), (8, layer_name), (62, 7), (100, name)]

    content: list[tuple[int, Any]] = []
    for k, (a, b) in enumerate(zip(CORNERS, (*CORNERS[1:], CORNERS[0]), strict=True)):
        content += [(0, "LINE"), *common("AcDbLine", "Layer 1", f"10{k}")]
        content += [(10, a[0]), (20, a[1]), (30, 0.0), (11, b[0]), (21, b[1]), (31, 0.0)]
    content += [
        (0, "SPLINE"),
        *common("AcDbSpline", "Mountain", "1A0"),
        (70, 8),
        (71, 3),
        (72, 8),
        (73, 4),
        (74, 0),
    ]
    content += [(40, 0.0)] * 4 + [(40, 1.0)] * 4
    for x, y in ((0, 30), (30, 60), (60, 0), (100, 40)):
        content += [(10, x), (20, y), (30, 0.0)]
    content += [(0, "LWPOLYLINE"), *common("AcDbPolyline", "Valley", "1A1"), (90, 3), (70, 0)]
    for x, y in ((0, 60), (50, 70), (100, 60)):
        content += [(10, x), (20, y), (30, 0.0)]
    top = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, header), (0, "ENDSEC")]
    sections = [*(top if header else []), (0, "SECTION"), (2, "ENTITIES"), *content, (0, "ENDSEC"), (0, "EOF")]
    return text(sections)


@pytest.mark.parametrize(
    "data",
    [
        outlined(),
        outlined("AC1009"),
        outlined(""),
        b"\xef\xbb\xbf" + outlined(),
        b"999\na comment\n" + outlined(""),
        outlined().replace(b"\n", b"\r\n"),
        outlined().replace(b"\n", b"\r"),
        outlined().removesuffix(b"  0\nEOF\n"),
        outlined("AC1009").replace(b"100\nAcDbEntity\n", b"").replace(b"100\nAcDbPolyline\n", b""),
    ],
    ids=["whole", "too old", "no header", "mark", "comment", "Windows", "old Mac", "no end", "no classes"],
)
def test_what_programs_leave_out(data: bytes) -> None:
    pattern = read(data)
    assert letters(pattern) == "MV"
    assert not any("damaged" in note or "too early" in note for note in pattern.notes)


def test_a_file_that_ends_too_early_loses_its_last_line() -> None:
    whole = outlined()
    pattern = read(whole[: whole.rindex(b"20\n60") + 4])
    assert letters(pattern) == "M"
    assert any("ends too early" in note for note in pattern.notes)


def test_faults_that_draw_nothing_are_not_told() -> None:
    """Well-known programs write dictionaries whose entries are not there."""
    whole = written(lambda _, model: model.add_line((0, 30), (100, 40)))
    begin = whole.index(b"AcDbDictionary\n") + len(b"AcDbDictionary\n")
    wrong = whole[:begin] + b"  3\nSTANDARD\n350\nFFFFF\n" + whole[begin:]
    _, auditor = recover.read(io.BytesIO(wrong))
    assert auditor.fixes
    assert read(wrong).notes == read(whole).notes


def test_a_line_type_that_the_file_does_not_describe() -> None:
    pattern = read(
        r12(border(), line((0, 30), (100, 40), (6, "DASHDOT")), line((0, 50), (100, 60), (6, "HIDDEN2")))
    )
    assert [crease.assignment for crease in pattern.creases] == ["M", "V"]


def test_blocks_that_refer_to_all_later_ones() -> None:
    """The ways through them are as many as 2 to the power of 40."""
    count = 40
    blocks = [
        tag
        for k in range(count)
        for tag in block(f"b{k}", *(insert(f"b{j}", (0, 0)) for j in range(k + 1, count)), line((0, 0), (1, 1)))
    ]
    assert len(read(r12(border(), line((0, 30), (100, 40)), blocks=blocks)).creases) == 1
    with pytest.raises(solver.PatternError, match="more than"):
        read(r12(border(), insert("b0", (0, 0)), blocks=blocks))


def test_numbers_that_are_none_leave_their_line_out() -> None:
    pattern = read(r12(border(), line((0, 30), (100, 40)), line((0, 50), (float("nan"), 60))))
    assert len(pattern.creases) == 1
    assert any("LINE left out" in note for note in pattern.notes)


def test_the_library_is_imported_when_a_file_is_read_and_looks_for_no_fonts(tmp_path: Path) -> None:
    path = tmp_path / "sheet.dxf"
    path.write_bytes(r12(border(), line((0, 30), (100, 40))))
    said = subprocess.run(
        [
            sys.executable,
            "-c",
            "import os, sys, solver\n"
            "before = dict(os.environ)\n"
            "assert 'ezdxf' not in sys.modules\n"
            f"solver.read_pattern({str(path)!r})\n"
            "assert 'ezdxf' in sys.modules and dict(os.environ) == before\n"
            "from ezdxf.fonts.fonts import font_manager\n"
            "assert not font_manager.has_font('DejaVuSans.ttf')\n",
        ],
        check=False,
        capture_output=True,
        text=True,
        cwd=Path(solver.__file__).parents[1],
        env={"PATH": "", "HOME": str(tmp_path), "PYTHONPATH": ":".join(filter(None, sys.path))},
    )
    assert said.returncode == 0, said.stderr
    assert not said.stderr
    assert sorted(one.name for one in tmp_path.iterdir()) == ["sheet.dxf"]
