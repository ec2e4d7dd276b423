"""What an SVG file says beside its lines: its page, its texts, and the data of its elements."""

from __future__ import annotations

import pytest

from solver.pattern.meaning import MAX_WORDS
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
