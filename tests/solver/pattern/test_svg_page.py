"""What an SVG file says beside its lines: its page, its texts, and the data of its elements."""

from __future__ import annotations

import io

import pytest

from solver.pattern.meaning import MAX_WORDS
from solver.pattern.read_options import ReadOptions
from solver.pattern.sizes import NO_SIZE
from solver.pattern.svg import read_svg
from solver.pattern.svg_values import UNKNOWN_COLOUR
from solver.pattern.svg_walk import Drawing, read_drawing
from solver.pattern.svg_xml import parse_svg_tree

HEAD = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'xmlns:xlink="http://www.w3.org/1999/xlink"'
)


def drawing(body: str, attributes: str = "") -> Drawing:
    return read_drawing(parse_svg_tree(f"<svg {HEAD} {attributes}>{body}</svg>"))


@pytest.mark.parametrize(
    ("attributes", "page"),
    [
        ('viewBox="10 20 100 50" width="1" height="9"', (10.0, 20.0, 110.0, 70.0)),
        ('width="96" height="1in"', (0.0, 0.0, 96.0, 96.0)),
        ('width="96"', None),
        ('width="100%" height="100%"', None),
        ("", None),
        (
            'viewBox="0 10 100 100" width="100" height="200" preserveAspectRatio="none"',
            (0.0, 20.0, 100.0, 220.0),
        ),
    ],
)
def test_the_page_is_what_the_root_shows(attributes: str, page: tuple[float, float, float, float] | None) -> None:
    assert drawing('<path d="M0 0H9" stroke="red"/>', attributes).page == page


def test_a_line_from_corner_to_corner_of_the_page_ends_there() -> None:
    read = drawing('<path d="M10 70L110 20" stroke="red"/>', 'viewBox="10 20 100 50"')
    assert read.page is not None
    x0, y0, x1, y1 = read.page
    assert read.shapes[0].subpaths[0].segments[0].points.tolist() == [[x0, y0], [x1, y1]]


def test_texts_are_counted() -> None:
    assert drawing('<text>a</text><g><text>b <tspan>c</tspan></text></g><g display="none"><text/></g>').text == 2
    assert drawing("").text == 0


def test_words_are_of_each_element_its_data_then_classes_then_names_from_the_inside_out() -> None:
    [shape] = drawing(
        '<g id="g1" inkscape:label="Layer 1" type="outer"><g data-layer="folds" data-other="?" class="a b">'
        '<path id="p" data-type="mountain" class="c" data-name="Path" data-assignment="M" d="M0 0H9" '
        'stroke="black"/></g></g>',
        'id="root" class="r"',
    ).shapes
    assert shape.words == (
        ("data-assignment", "M"),
        ("data-type", "mountain"),
        ("class", "c"),
        ("id", "p"),
        ("name", "Path"),
        ("data-layer", "folds"),
        ("class of its group", "a"),
        ("class of its group", "b"),
        ("type", "outer"),
        ("group or layer name", "g1"),
        ("group or layer name", "Layer 1"),
    )


def test_words_are_bounded() -> None:
    body = '<line x2="9" stroke="red" data-type="own"/>'
    for _ in range(90):
        body = f'<g data-type="a" data-fold="b">{body}</g>'
    [shape] = drawing(body).shapes
    assert len(shape.words) == MAX_WORDS
    assert shape.words[0] == ("data-type", "own")


def test_a_shape_that_only_its_data_describe_is_a_line() -> None:
    read = drawing('<rect width="1" height="1" data-assignment="B"/><g data-fold="V"><line x2="1"/></g>')
    assert [shape.stroke for shape in read.shapes] == [UNKNOWN_COLOUR, UNKNOWN_COLOUR]
    assert not any(shape.filled for shape in read.shapes)
    assert any("without stroke and fill" in note for note in read.notes)


@pytest.mark.parametrize(
    "body",
    [
        '<rect width="1" height="1" data-assignment="B" fill="red"/>',
        '<rect width="1" height="1" data-assignment="B" style="stroke:none"/>',
        '<g fill="blue"><rect width="1" height="1" data-assignment="B"/></g>',
        '<g inkscape:label="Layer 1" data-name="Layer 1"><rect width="1" height="1"/></g>',
    ],
)
def test_a_shape_with_a_look_of_its_own_is_no_line_by_its_data(body: str) -> None:
    [shape] = drawing(body).shapes
    assert shape.stroke is None
    assert shape.filled


@pytest.mark.parametrize(
    ("size", "options", "noted"),
    [
        ('width="100" height="100"', None, True),
        ('width="100px" height="100px"', None, True),
        ('width="100%" height="100%"', ReadOptions(), True),
        ("", ReadOptions(scale=2.0), True),
        ("", ReadOptions(unit="cm"), False),  # the user has said it
        ('width="100mm" height="100mm"', None, False),
    ],
)
def test_a_drawing_without_a_physical_size_says_what_is_taken_for_a_unit(
    size: str, options: ReadOptions | None, noted: bool
) -> None:
    body = '<rect width="100" height="100" fill="none" stroke="black"/><path d="M9 0v100" stroke="red"/>'
    [pattern] = read_svg(io.StringIO(f'<svg {HEAD} viewBox="0 0 100 100" {size}>{body}</svg>'), options)
    assert (NO_SIZE in pattern.notes) == noted
    assert (pattern.unit_mm is None) == ("mm" not in size)
