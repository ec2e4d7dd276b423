"""The SVG reader: what is drawn, where it lands, and what each stroke is taken for."""

from __future__ import annotations

import io
import math
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import shapely

from solver.errors import CurvefoldError, PatternError, ReadError
from solver.pattern.crease_pattern import CreasePattern
from solver.pattern.reading import read_pattern
from solver.pattern.svg import read_svg

SQUARE = '<rect width="100" height="100" fill="none" stroke="black"/>'
RED_LINE = '<path d="M30 0V100" stroke="red"/>'
BLUE_LINE = '<path d="M60 0V100" stroke="blue"/>'
HEAD = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)


def read(body: str, attributes: str = 'viewBox="0 0 100 100"') -> CreasePattern:
    return read_svg(io.StringIO(f"<svg {HEAD} {attributes}>{body}</svg>"))[0]


def letters(pattern: CreasePattern) -> str:
    return "".join(crease.assignment for crease in pattern.creases)


def note(pattern: CreasePattern, *words: str) -> bool:
    return any(all(word in line for word in words) for line in pattern.notes)


def area(pattern: CreasePattern) -> float:
    return float(shapely.Polygon(pattern.boundary, pattern.holes).area)


def one_crease(body: str, attributes: str = 'viewBox="0 0 100 100"') -> np.ndarray:
    """The points of the only red stroke, on a large sheet and next to a blue line."""
    sheet = '<rect x="-300" y="-300" width="900" height="900" fill="none" stroke="black"/>'
    pattern = read(sheet + body + '<line x1="99" y1="0" x2="99" y2="99" stroke="blue"/>', attributes)
    [crease] = [crease for crease in pattern.creases if crease.assignment == "M"]
    return crease.points


# ---- coordinates


def test_y_points_up_within_the_view_box() -> None:
    pattern = read(
        '<rect x="10" y="20" width="100" height="50" fill="none" stroke="black"/>'
        '<line x1="10" y1="20" x2="60" y2="70" stroke="red"/>',
        'viewBox="10 20 100 50" width="400" height="200"',
    )
    assert pattern.boundary.min(axis=0).tolist() == [10.0, 20.0]
    assert pattern.boundary.max(axis=0).tolist() == [110.0, 70.0]
    assert pattern.creases[0].points.tolist() == [[10.0, 70.0], [60.0, 20.0]]


def test_without_view_box_the_height_in_pixels_is_the_mirror() -> None:
    pattern = read(SQUARE + RED_LINE, 'width="200" height="300"')
    assert pattern.boundary[:, 1].max() == 300.0


def test_without_any_size_the_drawing_is_mirrored_in_its_own_box() -> None:
    pattern = read(
        '<rect x="5" y="7" width="10" height="10" fill="none" stroke="black"/>'
        '<line x1="5" y1="7" x2="15" y2="8" stroke="red"/>',
        "",
    )
    assert pattern.boundary.min(axis=0).tolist() == [5.0, 7.0]
    assert pattern.creases[0].points.tolist() == [[5.0, 17.0], [15.0, 16.0]]


@pytest.mark.parametrize(
    ("attributes", "millimetres"),
    [
        ('viewBox="0 0 100 100" width="100mm" height="100mm"', 1.0),
        ('viewBox="0 0 100 100" width="20cm" height="20cm"', 2.0),
        ('viewBox="0 0 100 100" width="1in"', 0.254),
        ('viewBox="0 0 100 100" width="720pt" height="720pt"', 2.54),
        ('viewBox="0 0 100 100" height="6pc"', 0.254),
        ('viewBox="0 0 100 100" width="100mm" height="200mm"', 1.0),  # meet: the smaller scale
        ('viewBox="0 0 100 100" width="100mm" height="200mm" preserveAspectRatio="xMidYMid slice"', 2.0),
        ('width="100mm" height="100mm"', 25.4 / 96),
        ('viewBox="0 0 100 100" width="100px" height="100px"', None),
        ('viewBox="0 0 100 100" width="100" height="100"', None),
        ('viewBox="0 0 100 100" width="100%" height="100%"', None),
        ('viewBox="0 0 100 100"', None),
    ],
)
def test_millimetres_only_when_the_file_says_so(attributes: str, millimetres: float | None) -> None:
    pattern = read(SQUARE + RED_LINE, attributes)
    assert pattern.unit_mm == (None if millimetres is None else pytest.approx(millimetres, rel=1e-14))
    assert np.ptp(pattern.boundary, axis=0).tolist() == [100.0, 100.0]


def test_a_stretched_drawing_is_read_as_it_is_shown() -> None:
    pattern = read(
        SQUARE + RED_LINE, 'viewBox="0 0 100 100" width="100mm" height="200mm" preserveAspectRatio="none"'
    )
    assert np.ptp(pattern.boundary, axis=0).tolist() == [100.0, 200.0]
    assert pattern.unit_mm == pytest.approx(1.0)
    assert note(pattern, "stretched")


@pytest.mark.parametrize(
    ("unit", "pixels"),
    [("", 1), ("px", 1), ("mm", 96 / 25.4), ("cm", 96 / 2.54), ("in", 96), ("pt", 96 / 72), ("pc", 16)],
)
def test_units_on_shapes(unit: str, pixels: float) -> None:
    points = one_crease(f'<line x1="0{unit}" y1="0" x2="0.5{unit}" y2="1" stroke="red"/>')
    assert points[1, 0] == pytest.approx(0.5 * pixels)


def test_units_of_paper_on_shapes_fix_the_pixel() -> None:
    pattern = read(
        '<rect width="10mm" height="10mm" fill="none" stroke="black"/><path d="M9 0V30" stroke="red"/>', ""
    )
    assert pattern.unit_mm == pytest.approx(25.4 / 96)
    assert np.ptp(pattern.boundary[:, 0]) * pattern.unit_mm == pytest.approx(10.0)


def test_percentages_are_of_the_view_box() -> None:
    points = one_crease('<line x1="0" y1="50%" x2="25%" y2="100%" stroke="red"/>', 'viewBox="0 0 100 100"')
    assert points.tolist() == [[0.0, 50.0], [25.0, 0.0]]


# ---- transforms and structure


@pytest.mark.parametrize(
    ("transform", "x", "y"),
    [
        ("translate(1)", 11, 0),
        ("translate(1,2)", 11, 2),
        ("scale(2)", 20, 0),
        ("scale(2 , -3)", 20, 0),
        ("rotate(90)", 0, 10),
        ("rotate(90 10 10)", 20, 10),
        ("skewY(45)", 10, 10),
        ("matrix(0 1 -1 0 5 6)", 5, 16),
        ("translate(5 0)scale(2)", 25, 0),
        ("translate(5 0),rotate(90)", 5, 10),
        ("", 10, 0),
    ],
)
def test_transforms(transform: str, x: float, y: float) -> None:
    points = one_crease(f'<line x1="10" y1="0" x2="20" y2="33" transform="{transform}" stroke="red"/>')
    np.testing.assert_allclose(points[0], [x, 100 - y], atol=1e-12)


def test_groups_nest_and_a_flip_of_y_is_undone() -> None:
    points = one_crease(
        '<g transform="translate(0 100)"><g transform="scale(1,-1)"><a>'
        '<line x1="10" y1="20" x2="30" y2="40" stroke="red"/></a></g></g>'
    )
    assert points.tolist() == [[10.0, 20.0], [30.0, 40.0]]


def test_use_repeats_with_position_transform_and_inherited_stroke() -> None:
    pattern = read(
        SQUARE
        + '<defs><g id="pair"><path id="a" d="M10 10h5"/></g></defs>'
        + '<g stroke="red"><use xlink:href="#pair" x="1" y="2"/></g>'
        + '<use href="#a" stroke="blue" transform="scale(2)"/>'
    )
    assert letters(pattern) == "MV"
    assert pattern.creases[0].points.tolist() == [[11.0, 88.0], [16.0, 88.0]]
    assert pattern.creases[1].points.tolist() == [[20.0, 80.0], [30.0, 80.0]]


def test_symbols_and_inner_svgs_have_viewports() -> None:
    pattern = read(
        SQUARE
        + '<symbol id="s" viewBox="0 0 10 10"><path d="M0 0L10 10" stroke="red"/></symbol>'
        + '<use href="#s" x="20" y="30" width="40" height="20"/>'
        + '<svg x="50" y="0" width="10" height="10" viewBox="0 0 1 1" preserveAspectRatio="none">'
        + '<path d="M0 0L1 1" stroke="blue"/></svg>'
    )
    # xMidYMid meet: scale 2, centred in the width of 40.
    assert pattern.creases[0].points.tolist() == [[30.0, 70.0], [50.0, 50.0]]
    assert pattern.creases[1].points.tolist() == [[50.0, 100.0], [60.0, 90.0]]


def test_what_is_not_displayed_is_not_read() -> None:
    hidden = "".join(
        f"<{tag} {attributes}><path d='M0 0L50 50' stroke='red'/></{tag}>"
        for tag, attributes in [
            ("defs", ""),
            ("clipPath", ""),
            ("mask", ""),
            ("marker", ""),
            ("pattern", ""),
            ("symbol", ""),
            ("g", 'display="none"'),
            ("g", 'style="display:none"'),
            ("g", 'visibility="hidden"'),
            ("g", 'stroke-width="0"'),
            ("g", 'opacity="0"'),
        ]
    )
    seen = '<g visibility="hidden"><path visibility="visible" d="M9 0V50" stroke="blue"/></g>'
    pattern = read(SQUARE + RED_LINE + hidden + seen)
    assert letters(pattern) == "MV"
    assert note(pattern, "not displayed")
    assert note(pattern, "hidden")
    assert note(pattern, "transparent")


def test_text_and_pictures_are_left_out_and_said() -> None:
    pattern = read(SQUARE + RED_LINE + '<text stroke="red">cut here</text><image href="a.png"/>')
    assert note(pattern, "<text>")
    assert note(pattern, "<image>")


# ---- styles


def test_classes_ids_types_and_descendants_in_a_style_element() -> None:
    pattern = read(
        "<style>/* c */ @media print { path { stroke: none } }\n"
        ".cls-1,.cls-2{fill:none;stroke-miterlimit:10}.cls-1{stroke:#EF0C0C}\n"
        ".cls-2 { stroke : #1034E8 } #third { stroke: rgb(100%,0%,0%) }\n"
        "g.layer > line { stroke: hsl(240, 100%, 50%) } line { stroke: lime }</style>"
        + SQUARE
        + '<path class="cls-1" d="M10 0v100"/><path class="other cls-2" d="M20 0v100"/>'
        + '<path id="third" class="cls-2" d="M30 0v100"/>'
        + '<g class="layer"><line x1="40" y1="0" x2="40" y2="100" stroke="red"/></g>'
    )
    assert letters(pattern) == "MVMV"
    assert note(pattern, "style rules", "@media")


def test_the_style_element_may_come_last_and_style_attributes_win() -> None:
    pattern = read(
        SQUARE
        + '<path class="a" d="M10 0v100"/><path class="a" style="stroke:blue;" d="M20 0v100"/>'
        + "<style><![CDATA[ .a { stroke: red } ]]></style>"
    )
    assert letters(pattern) == "MV"


def test_strokes_are_inherited_and_current_color_is_followed() -> None:
    pattern = read(
        SQUARE
        + '<g style="stroke:red"><g><path d="M10 0v100"/></g><path d="M15 0v100" stroke="none"/></g>'
        + '<g color="blue"><path d="M20 0v100" stroke="currentColor"/></g>'
    )
    assert letters(pattern) == "MV"


def test_hues() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M80 0v100" stroke="orange"/>')
    assert letters(pattern) == "MVU"


def test_yellow_facet_lines_are_left_out() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M80 0v100" stroke="yellow"/>')
    assert letters(pattern) == "MV"
    assert note(pattern, "1 stroke", "facet", "hue")


@pytest.mark.parametrize("colour", ["#000", "black", "#231F20", "#1D1D1B", "#333", "rgb(10,10,12)"])
def test_near_black_is_black(colour: str) -> None:
    pattern = read(SQUARE.replace("black", colour) + RED_LINE + BLUE_LINE)
    assert area(pattern) == 10000.0
    assert letters(pattern) == "MV"


def test_grey_is_auxiliary_when_there_are_creases() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M0 80h100" stroke="#999"/>')
    assert letters(pattern) == "MV"
    assert note(pattern, "#999999", "auxiliary")


def test_grey_is_a_crease_when_there_is_no_other() -> None:
    pattern = read(SQUARE + '<path d="M0 80h100" stroke="#999"/>')
    assert letters(pattern) == "U"


def test_a_grey_border_is_found() -> None:
    pattern = read(SQUARE.replace("black", "#999") + RED_LINE + BLUE_LINE)
    assert area(pattern) == 10000.0
    assert note(pattern, "border is grey")


@pytest.mark.parametrize("where", ["class", "id", "inkscape:label", "data-name", "data-layer"])
def test_names_of_classes_groups_and_layers(where: str) -> None:
    pattern = read(
        f'<g {where}="Valley_x0020_fold"><g><path d="M50 0V100" stroke="#000"/></g></g>'
        f'<g id="Border">{SQUARE}</g><path d="M0 9h100" class="MountainLine" stroke="black"/>'
    )
    assert letters(pattern) == "VM"
    assert area(pattern) == 10000.0


def test_facets_are_left_out_by_name() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<g id="aux_lines"><path d="M0 9h99" stroke="black"/></g>')
    assert letters(pattern) == "MV"
    assert note(pattern, "aux_lines", "left out")


def test_own_names_go_before_the_group_before_dashes_before_colour() -> None:
    pattern = read(
        SQUARE
        + '<g id="valley"><path id="mountain" d="M10 0V100" stroke="blue"/>'
        + '<path d="M20 0V100" stroke="red" stroke-dasharray="9 3 1 3"/></g>'
        + '<g class="valley"><g class="mountain"><path d="M30 0V100" stroke="black"/></g></g>'
        + '<path d="M40 0V100" stroke="blue" stroke-dasharray="9 3 1 3"/>'
        + '<path d="M50 0V100" stroke="black" style="stroke-dasharray:4,2"/>'
        + '<path d="M60 0V100" stroke="red"/>'
    )
    assert letters(pattern) == "MVMMVM"
    for why in ("hue", "id", "class of its group", "group or layer name", "dash pattern"):
        assert note(pattern, f"({why})")


def test_lines_that_are_no_part_of_the_sheet_are_left_out_by_name() -> None:
    pattern = read(
        f'<g id="CUT">{SQUARE}</g><g id="Cotes"><path d="M0 5H100M0 3V7" stroke="black"/></g>' + RED_LINE
    )
    assert letters(pattern) == "U"
    assert pattern.holes == ()
    assert (
        "2 strokes of colour #000000 named 'Cotes': left out: dimension line (group or layer name)" in pattern.notes
    )


def test_dashes_that_are_solid_lines_say_nothing() -> None:
    pattern = read(
        SQUARE + '<path d="M10 0V100" stroke="black" stroke-dasharray="none"/>'
        '<path d="M20 0V100" stroke="black" stroke-dasharray="0 0"/>'
    )
    assert letters(pattern) == "UU"


@pytest.mark.parametrize("look", ['stroke="red"', 'stroke="blue"', 'stroke="black" stroke-dasharray="3 1"'])
def test_one_look_for_all_creases_is_unassigned(look: str) -> None:
    pattern = read(SQUARE + f'<path d="M10 0V100" {look}/><path d="M20 0V100" {look}/>')
    assert letters(pattern) == "UU"
    assert note(pattern, "2 strokes", "unassigned", "look the same")


def test_one_name_for_all_creases_is_meant() -> None:
    assert letters(read(SQUARE + '<g id="Mountain"><path d="M10 0V100" stroke="black"/></g>')) == "M"


def test_notes_group_strokes() -> None:
    pattern = read(SQUARE + RED_LINE + RED_LINE.replace("30", "40") + BLUE_LINE)
    assert "2 strokes of colour #ff0000: mountain creases (hue)" in pattern.notes
    assert "1 stroke of colour #0000ff: valley crease (hue)" in pattern.notes
    assert "1 stroke of colour #000000: border (black)" in pattern.notes


def test_opacity_is_noted() -> None:
    pattern = read(SQUARE + BLUE_LINE + '<g opacity="0.5"><path d="M10 0V100" stroke="red"/></g>')
    assert note(pattern, "opacity of 1 crease")


def test_an_unknown_colour_is_noted() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M0 9h100" stroke="var(--ink)"/>')
    assert letters(pattern) == "MVU"
    assert note(pattern, "colour", "var(--ink)")


# ---- border and holes


def test_a_border_of_separate_lines_is_stitched() -> None:
    lines = "".join(
        f'<line x1="{a}" y1="{b}" x2="{c}" y2="{d}" stroke="black"/>'
        for a, b, c, d in [
            (0, 0, 40, 0),
            (40, 0.004, 100, 0),
            (100, 100, 100, 0),
            (0, 100, 100, 100),
            (0, 0, 0, 100),
        ]
    )
    pattern = read(lines + RED_LINE + BLUE_LINE)
    assert area(pattern) == pytest.approx(10000.0, rel=1e-4)
    assert letters(pattern) == "MV"
    assert {(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)} <= set(map(tuple, pattern.boundary.tolist()))


def test_border_lines_that_cross_at_the_corners() -> None:
    lines = '<path d="M-5 0H105M-5 100H105M0 -5V105M100 -5V105" stroke="black"/>'
    pattern = read(lines + RED_LINE + BLUE_LINE)
    assert area(pattern) == 10000.0
    assert letters(pattern) == "MV"


def test_holes_black_and_green() -> None:
    pattern = read(
        SQUARE
        + RED_LINE
        + BLUE_LINE
        + '<circle cx="15" cy="50" r="5" stroke="black" fill="none"/>'
        + '<path d="M80 10h10v10z" stroke="#0f0" fill="none"/>'
        + '<path d="M80 40h10M90 40v10M90 50L80 40" stroke="#0f0"/>'
    )
    assert len(pattern.holes) == 3
    assert area(pattern) == pytest.approx(10000 - 25 * math.pi - 100, abs=2e-2)
    assert letters(pattern) == "MV"


def test_holes_in_a_hole_fall_out_with_it() -> None:
    rings = "".join(f'<circle cx="15" cy="50" r="{r}" stroke="black" fill="none"/>' for r in (2, 8, 5))
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + rings)
    assert len(pattern.holes) == 1
    assert area(pattern) == pytest.approx(10000 - 64 * math.pi, abs=0.1)
    assert note(pattern, "2 strokes", "inside a hole")


def test_lines_that_cross_too_often_are_refused() -> None:
    rng = np.random.default_rng(1)
    lines = "".join(
        '<path d="M{} {}L{} {}" stroke="black"/>'.format(*row) for row in rng.uniform(0, 100, (2500, 4))
    )
    with pytest.raises(PatternError, match="too often"):
        read(SQUARE + lines)


def test_one_colour_the_outermost_outline_is_the_border_and_the_rest_creases() -> None:
    pattern = read(
        '<path d="M0 0H100V100H0Z" fill="none" stroke="black"/>'
        '<circle cx="50" cy="50" r="20" stroke="black"/>'
        '<path d="M0 50H30" stroke="black"/>'
    )
    assert letters(pattern) == "UU"
    assert [crease.closed for crease in pattern.creases] == [True, False]
    assert pattern.holes == ()


def test_one_colour_but_a_group_says_hole() -> None:
    pattern = read(
        SQUARE
        + '<g id="hole"><circle cx="50" cy="50" r="20" stroke="black"/></g><path d="M0 9h99" stroke="black"/>'
    )
    assert len(pattern.holes) == 1
    assert letters(pattern) == "U"


def test_all_lines_red() -> None:
    pattern = read(SQUARE.replace("black", "red") + RED_LINE)
    assert area(pattern) == 10000.0
    assert letters(pattern) == "U"
    assert note(pattern, "outermost closed outline")


def test_an_open_cut_is_left_out_and_said() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M10 10h10" stroke="#0f0"/>')
    assert letters(pattern) == "MV"
    assert note(pattern, "cut that does not close is not supported")


def test_a_black_line_inside_is_an_unassigned_crease() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M0 10h100" stroke="#000"/>')
    assert letters(pattern) == "MVU"


def test_a_filled_shape_is_the_border_when_there_is_no_other() -> None:
    pattern = read('<path d="M0 0h100v100h-100z" fill="#eee"/>' + RED_LINE + BLUE_LINE)
    assert area(pattern) == 10000.0
    assert note(pattern, "filled shape")


def test_a_painted_page_is_not_the_sheet_where_an_outline_of_a_colour_holds_the_creases() -> None:
    slide = '<rect width="100" height="100" fill="#fff"/>'
    outline = '<rect x="20" y="20" width="60" height="40" fill="#fff" stroke="#172c51"/>'
    pattern = read(slide + outline + '<path d="M20 40h60" stroke="#f00"/>')
    assert area(pattern) == 2400.0
    assert letters(pattern) == "U"
    assert note(pattern, "outermost closed outline")


def test_a_frame_around_the_sheet_is_left_out() -> None:
    pattern = read(
        '<rect x="-20" y="-20" width="140" height="140" fill="none" stroke="black"/>'
        + SQUARE
        + RED_LINE
        + BLUE_LINE
    )
    assert area(pattern) == 10000.0
    assert pattern.holes == ()
    assert note(pattern, "frame")


def test_what_lies_beside_the_sheet_is_left_out() -> None:
    pattern = read(SQUARE + RED_LINE + BLUE_LINE + '<path d="M120 0h10" stroke="red"/>')
    assert letters(pattern) == "MV"
    assert note(pattern, "beside the sheet")


# ---- curves


def test_every_path_command() -> None:
    absolute = "M 10 10 L 20 10 H 30 V 20 C 30 30 40 30 40 20 S 50 10 50 20 Q 55 30 60 20 T 70 20"
    absolute += " A 5 8 30 0 1 75 30 Z"
    relative = "m10 10l10 0h10v10c0 10 10 10 10 0s10-10 10 0q5 10 10 0t10 0a5 8 30 0 1 5 10z"
    points = one_crease(f'<path d="{absolute}" stroke="red"/>')
    np.testing.assert_allclose(one_crease(f'<path d="{relative}" stroke="red"/>'), points, atol=1e-12)
    drawn = [[10, 90], [20, 90], [30, 90], [30, 80], [40, 80], [50, 80], [60, 80], [70, 80], [75, 70]]
    for point in drawn:
        assert np.hypot(*(points - point).T).min() < 1e-12


def test_implicit_lines_compact_numbers_and_arc_flags() -> None:
    assert one_crease('<path d="m10,10 5-5 1.5.5" stroke="red"/>').tolist() == [
        [10, 90],
        [15, 95],
        [16.5, 94.5],
    ]
    assert one_crease('<path d="M1.,2.L3e1,4" stroke="red"/>').tolist() == [[1, 98], [30, 96]]
    points = one_crease('<path d="M10 10a5 5 0 0110 0" stroke="red"/>')
    assert points[-1].tolist() == [20, 90]
    np.testing.assert_allclose(np.hypot(*(points - [15, 90]).T), 5.0)


def test_smooth_commands_after_other_curves_do_not_reflect() -> None:
    smooth = one_crease('<path d="M10 10Q20 30 30 10S50 40 60 10" stroke="red"/>')
    plain = one_crease('<path d="M10 10Q20 30 30 10C30 10 50 40 60 10" stroke="red"/>')
    np.testing.assert_allclose(smooth, plain, atol=1e-12)


@pytest.mark.parametrize("large", [0, 1])
@pytest.mark.parametrize("sweep", [0, 1])
@pytest.mark.parametrize("rotation", [0, 37, -120])
@pytest.mark.parametrize("end", [(55.0, 45.0), (30.0, 60.0), (40.001, 50.0), (95.0, 20.0)])
def test_arcs_lie_on_their_ellipse_with_the_right_flags(
    large: int, sweep: int, rotation: float, end: tuple[float, float]
) -> None:
    rx, ry = 12.0, 20.0
    d = f"M40 50A{rx} {ry} {rotation} {large} {sweep} {end[0]} {end[1]}"
    points = one_crease(f'<path d="{d}" stroke="red"/>')
    points = points * [1, -1] + [0, 100]  # back to SVG's y
    assert points[0].tolist() == [40, 50]
    np.testing.assert_allclose(points[-1], end, atol=1e-12)
    # In the ellipse's own frame, scaled to a circle: all on one circle, turning one way, by the asked amount.
    angle = math.radians(rotation)
    frame = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    circle = (points @ frame.T) / [rx, ry]
    chord = circle[-1] - circle[0]
    radius = max(1.0, float(np.hypot(*chord)) / 2)
    steps = np.diff(circle, axis=0)
    turns = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    assert (turns > 0).all() if sweep else (turns < 0).all()
    total = abs(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))[[0, -1]] @ [-1, 1])
    if radius == 1.0:
        assert (total > math.pi) == bool(large) or abs(total - math.pi) < 0.1
    curvature = np.hypot(*steps.T) / 2
    assert np.ptp(curvature) < 1e-9
    # The circumscribed circle of the first, a middle and the last sample has the asked radius.
    a, b, c = circle[0], circle[len(circle) // 2], circle[-1]
    sides = [np.hypot(*(b - a)), np.hypot(*(c - b)), np.hypot(*(c - a))]
    cross = abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
    assert np.prod(sides) / (2 * cross) == pytest.approx(radius, rel=1e-5)


def test_degenerate_arcs() -> None:
    assert one_crease('<path d="M10 10A0 5 0 0 1 20 10" stroke="red"/>').tolist() == [[10, 90], [20, 90]]
    assert one_crease('<path d="M10 10A5 5 0 0 1 10 10L20 10" stroke="red"/>').tolist() == [
        [10, 90],
        [20, 90],
    ]


def test_a_sheared_arc_is_exact() -> None:
    points = one_crease(
        '<circle cx="20" cy="20" r="10" transform="matrix(1.5 .2 .7 .8 3 4)" fill="none" stroke="red"/>'
    )
    points = points * [1, -1] + [0, 100]
    back = (points - [3, 4]) @ np.linalg.inv(np.array([[1.5, 0.7], [0.2, 0.8]])).T
    np.testing.assert_allclose(np.hypot(*(back - 20).T), 10.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("shape", "enclosed"),
    [
        ('<rect x="10" y="10" width="40" height="20"', 800.0),
        ('<rect x="10" y="10" width="40" height="20" rx="5"', 800 - (4 - math.pi) * 25),
        ('<rect x="10" y="10" width="40" height="20" rx="5" ry="4"', 800 - (4 - math.pi) * 20),
        ('<rect x="10" y="10" width="40" height="20" rx="99"', 800 - (4 - math.pi) * 200),
        ('<circle cx="30" cy="30" r="10"', math.pi * 100),
        ('<ellipse cx="30" cy="30" rx="10" ry="20"', math.pi * 200),
        ('<polygon points="10,10 30 10,30,30 10 30"', 400.0),
        ('<path d="M10 10h20v20h-20z"', 400.0),
        ('<polyline points="10,10 30,10 30,30 10,30 10,10"', 400.0),
    ],
)
def test_closed_shapes(shape: str, enclosed: float) -> None:
    pattern = read(SQUARE + f'{shape} stroke="red" fill="none"/>' + BLUE_LINE)
    [crease] = [crease for crease in pattern.creases if crease.assignment == "M"]
    assert crease.closed
    assert shapely.Polygon(crease.points).area == pytest.approx(enclosed, rel=1e-3)
    assert (crease.points[0] != crease.points[-1]).any()


def test_polylines_are_open() -> None:
    points = one_crease('<polyline points="10,10 30,10 30,30" stroke="red" fill="none"/>')
    assert points.tolist() == [[10, 90], [30, 90], [30, 70]]


def test_subpaths_are_creases_of_their_own_also_after_a_close() -> None:
    pattern = read(SQUARE + BLUE_LINE + '<path id="p" d="M10 10h10v10zl0 30M30 30h5" stroke="red" fill="none"/>')
    creases = [crease for crease in pattern.creases if crease.assignment == "M"]
    assert [crease.closed for crease in creases] == [True, False, False]
    assert [crease.name for crease in creases] == ["p part 1", "p part 2", "p part 3"]
    assert creases[1].points.tolist() == [[10, 90], [10, 60]]


def test_segments_without_length_are_dropped() -> None:
    points = one_crease('<path d="M10 10L10 10L20 10l0 0h0L30 20C30 20 30 20 30 20" stroke="red"/>')
    assert points.tolist() == [[10, 90], [20, 90], [30, 80]]


def test_samples_are_fine_and_straight_lines_stay_straight() -> None:
    pattern = read(
        SQUARE
        + BLUE_LINE
        + '<path d="M0 0C0 55 100 45 100 100L10 90C20 80 30 70 40 60Q50 50 60 60" stroke="red" fill="none"/>'
    )
    [crease] = [crease for crease in pattern.creases if crease.assignment == "M"]
    # A cubic, a line, a cubic that is a straight line, a quadratic.
    assert crease.beziers is not None
    assert crease.beziers.shape == (4, 4, 2)
    np.testing.assert_allclose(crease.beziers[3, 1], [40 + 20 / 3, 40 + 20 / 3])
    where = [int(np.flatnonzero((crease.points == p).all(axis=1))[0]) for p in ([100, 0], [10, 10], [40, 40])]
    assert np.diff(where).tolist() == [1, 1]
    t = np.linspace(0, 1, 20001)[:, None]
    b = crease.beziers[0]
    dense = (1 - t) ** 3 * b[0] + 3 * (1 - t) ** 2 * t * b[1] + 3 * (1 - t) * t**2 * b[2] + t**3 * b[3]
    line = shapely.LineString(crease.points[: where[0] + 1])
    assert shapely.distance(line, shapely.points(dense)).max() < 1e-5 * 100


def test_a_flat_curve_still_has_samples() -> None:
    assert len(one_crease('<path d="M10 10Q50 10.001 90 10" stroke="red"/>')) >= 16
    # One that is short beside the drawing has fewer, and is no further from its samples than they promise.
    assert 5 <= len(one_crease('<path d="M10 10Q12 10.001 14 10" stroke="red"/>')) < 16


def test_arcs_as_beziers_are_close() -> None:
    pattern = read(SQUARE + BLUE_LINE + '<circle cx="50" cy="50" r="40" stroke="red" fill="none"/>')
    crease = pattern.creases[1]
    assert crease.assignment == "M"
    assert crease.beziers is not None
    t = np.linspace(0, 1, 101)[None, :, None]
    b = crease.beziers[:, :, None, :]
    dense = (1 - t) ** 3 * b[:, 0] + 3 * (1 - t) ** 2 * t * b[:, 1] + 3 * (1 - t) * t**2 * b[:, 2] + t**3 * b[:, 3]
    assert np.abs(np.hypot(*(dense.reshape(-1, 2) - 50).T) - 40).max() < 1e-6 * 100
    assert np.array_equal(crease.beziers[:-1, 3], crease.beziers[1:, 0])


# ---- errors


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("", ReadError, "empty"),
        ("  \n", ReadError, "empty"),
        ("hello", ReadError, "not well-formed XML"),
        ("<svg", ReadError, "not well-formed XML"),
        ("<html></html>", ReadError, "not SVG"),
        ('<!DOCTYPE svg [<!ENTITY a SYSTEM "b">]><svg>&a;</svg>', ReadError, "entity"),
        (f"<svg {HEAD}/>", PatternError, "no line"),
        (f"<svg {HEAD}>{RED_LINE}</svg>", PatternError, "no border"),
        (f'<svg {HEAD} viewBox="0 0 0 0">{SQUARE}{RED_LINE}</svg>', ReadError, "viewBox"),
        (f'<svg {HEAD} viewBox="0 0 nan 1">{SQUARE}{RED_LINE}</svg>', ReadError, "viewBox"),
        (f'<svg {HEAD} width="-5mm">{SQUARE}{RED_LINE}</svg>', ReadError, "width"),
        (
            f'<svg {HEAD}>{SQUARE}<path id="q" d="M0 0L1e999 1" stroke="red"/></svg>',
            PatternError,
            "<path> 1 (id 'q')",
        ),
        (f'<svg {HEAD}>{SQUARE}<path d="M0 0LNaN 1" stroke="red"/></svg>', PatternError, "not understood"),
        (f'<svg {HEAD}>{SQUARE}<path d="L0 0" stroke="red"/></svg>', PatternError, "does not start"),
        (
            f'<svg {HEAD}>{SQUARE}<path d="M0 0C1 2 3" stroke="red"/></svg>',
            PatternError,
            "middle of a command",
        ),
        (f'<svg {HEAD}>{SQUARE}<line x2="a lot" stroke="red"/></svg>', PatternError, "not a length"),
        (f'<svg {HEAD}>{SQUARE}<line x2="1vw" stroke="red"/></svg>', PatternError, "unit 'vw'"),
        (
            f'<svg {HEAD}>{SQUARE}<line x2="1" transform="spin(3)" stroke="red"/></svg>',
            PatternError,
            "transform",
        ),
        (
            f'<svg {HEAD}>{SQUARE}<line x2="1" transform="scale(1e300)scale(1e300)" stroke="red"/></svg>',
            PatternError,
            "finite",
        ),
        (f'<svg {HEAD}>{SQUARE}<polyline points="1 2 3" stroke="red"/></svg>', PatternError, "odd"),
        (f'<svg {HEAD}>{SQUARE}<use href="#nobody"/></svg>', PatternError, "'#nobody'"),
        (f'<svg {HEAD}>{SQUARE}<g id="a"><use href="#a"/></g></svg>', PatternError, "refers to itself"),
    ],
)
def test_errors_are_one_sentence_with_the_file(
    tmp_path: Path, text: str, error: type[CurvefoldError], words: str
) -> None:
    path = tmp_path / "wrong.svg"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(error) as caught:
        read_pattern(path)
    assert words in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_files_that_are_not_there_or_too_large(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="cannot be read"):
        read_pattern(tmp_path / "missing.svg")
    with pytest.raises(ReadError, match="not a file"):
        read_svg(tmp_path)
    large = tmp_path / "large.svg"
    with open(large, "wb") as file:
        file.truncate(65 * 1024 * 1024)
    with pytest.raises(ReadError, match="64 MB"):
        read_pattern(large)


def test_other_kinds_of_files_name_what_is_read(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"\.svg"):
        read_pattern(tmp_path / "drawing.xyz")


def test_external_references_are_ignored() -> None:
    [pattern] = read_svg(
        io.BytesIO(
            b'<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://127.0.0.1:9/x.dtd">'
            + f'<svg {HEAD}>{SQUARE}{RED_LINE}<use href="other.svg#a"/></svg>'.encode()
        )
    )
    assert note(pattern, "another file")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_encodings(encoding: str) -> None:
    name = "utf-8" if encoding == "utf-8-sig" else encoding
    line = '<path id="é" d="M9 0v99" stroke="red"/>'
    text = f'<?xml version="1.0" encoding="{name}"?><svg {HEAD}>{SQUARE}{line}</svg>'
    assert read_svg(io.BytesIO(text.encode(encoding)))[0].creases[0].name == "é"


def test_bombs_are_refused() -> None:
    layers = '<g id="l0"><path d="M0 0h1" stroke="red"/></g>' + "".join(
        f'<g id="l{k}">' + f'<use href="#l{k - 1}"/>' * 10 + "</g>" for k in range(1, 12)
    )
    with pytest.raises(PatternError, match="50,000 elements"):
        read(SQUARE + layers)
    with pytest.raises(PatternError, match="200,000"):
        read(SQUARE + f'<path d="M0 0{"h1" * 250_000}" stroke="red"/>'.replace("h1" * 3, "h1h-1h1"))
    with pytest.raises(ReadError, match="deep"):
        read("<g>" * 500 + "</g>" * 500)
    waves = "c0 300 1 -300 1 0" * 6000
    with pytest.raises(PatternError, match="200,000"):
        read(SQUARE + f'<path d="M0 50{waves}" stroke="red" fill="none"/>')


def test_many_closed_subpaths_do_not_take_quadratic_time() -> None:
    pattern = read(SQUARE + BLUE_LINE + f'<path d="M5 5{"h1zm0 .018" * 5000}" stroke="red"/>')
    assert len(pattern.creases) == 2501
    assert note(pattern, "2,500 lines were drawn twice")


def test_a_thousand_dashes_are_no_matter() -> None:
    pattern = read(SQUARE + f'<path d="M9 0v99" stroke="black" stroke-dasharray="{"1e-9 " * 1000}"/>')
    assert letters(pattern) == "U"
    with pytest.raises(ReadError, match="stroke-dasharray"):
        read(SQUARE + f'<path d="M9 0v99" stroke="black" stroke-dasharray="{"1e-9 " * 100_000}"/>')


# ---- drawings of other people, where they are at hand

PATTERNS = Path(__file__).resolve().parents[4] / "shared" / "patterns"
FACTS = {
    # file: (sides of the border, area of the sheet, mountains, valleys; strokes that continue each other are one)
    "Carved_Cylinder.svg": (4, 308.172 * 654.667, 20, 40),
    "Crossing_curves.svg": (4, 410.086 * 410.083, 17, 17),
    "Rotating_Star.svg": (12, None, 9, 21),
    "comet.svg": (6, None, 64, 49),
    "curvedPleatSimple.svg": (4, 261.428 * 261.429, 1, 1),
    "wavy_pleats.svg": (4, 425.2 * 425.2, 3, 2),
}


@pytest.mark.skipif(
    not PATTERNS.is_dir(), reason="the folder of other people's drawings is not next to the project"
)
@pytest.mark.parametrize("file", sorted(FACTS))
def test_other_peoples_drawings(file: str) -> None:
    sides, size, mountains, valleys = FACTS[file]
    pattern = read_pattern(PATTERNS / file)
    assert pattern.name == Path(file).stem
    assert len(pattern.boundary) == sides
    assert pattern.holes == ()
    assert area(pattern) > 0
    if size is not None:
        assert area(pattern) == pytest.approx(size, rel=1e-9)
    assert Counter(letters(pattern)) == {"M": mountains, "V": valleys}
    # Facet lines are yellow; their ends in the two files that have some are nowhere in the creases.
    if file in ("comet.svg", "curvedPleatSimple.svg"):
        assert note(pattern, "#ffff00", "left out")
    sheet = shapely.Polygon(pattern.boundary).buffer(1.0)
    assert all(sheet.covers(shapely.LineString(crease.points)) for crease in pattern.creases)
