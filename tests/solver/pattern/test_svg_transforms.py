"""Transforms by attribute and by style, with origins and boxes."""

from __future__ import annotations

import numpy as np
import pytest

from solver.errors import PatternError
from solver.pattern.segments import Subpath, arc, cubic
from solver.pattern.svg_bounds import exact_box
from solver.pattern.svg_transforms import css_origin
from solver.pattern.svg_values import SvgValueError
from solver.pattern.svg_walk import Drawing, read_drawing
from solver.pattern.svg_xml import parse_svg_tree


def drawing(body: str, css: str = "") -> Drawing:
    style = f"<style>{css}</style>" if css else ""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 200">{style}{body}</svg>'
    return read_drawing(parse_svg_tree(text))


def start(body: str, css: str = "") -> list[float]:
    """Where the last line starts, y down as in the file, to 9 digits."""
    x, y = drawing(body, css).shapes[-1].subpaths[0].segments[0].start
    return [round(float(x), 9) + 0.0, round(200.0 - float(y), 9) + 0.0]


LINE = '<path d="M10 0H30" stroke="red" {}/>'


@pytest.mark.parametrize(
    ("attributes", "where"),
    [
        ('style="transform:translate(5px,1mm)"', [15, 96 / 25.4]),
        ('style="transform:translate(10%, 10%)"', [20, 20]),
        ('style="transform:translateY(50%)"', [10, 100]),
        ('style="transform:rotate(90deg)"', [0, 10]),
        ('style="transform:rotate(.25turn) scale(2)"', [0, 20]),
        ('style="transform:scale(200%, 1)"', [20, 0]),
        ('style="transform:skewX(45deg) translateY(1px)"', [11, 1]),
        ('style="transform:matrix(0,1,-1,0,5,6)"', [5, 16]),
        ('style="transform:none" transform="translate(9)"', [10, 0]),
        ('style="transform:translate(1px)" transform="translate(9)"', [11, 0]),
        # In CSS, lengths and angles have units; a browser passes this over, and the attribute stands.
        ('style="transform:rotate(90)" transform="translate(9)"', [19, 0]),
        ('style="translate:5px 6px"', [15, 6]),
        ('style="rotate:90deg"', [0, 10]),
        ('style="scale:2"', [20, 0]),
        ('style="translate:1px;rotate:90deg;scale:2;transform:translate(1px)"', [1, 22]),
        # Origins are in the nearest viewport, 100 x 200.
        ('transform="rotate(90)" transform-origin="10 10"', [20, 10]),
        ('transform="rotate(180)" transform-origin="center"', [90, 200]),
        ('transform="rotate(180)" style="transform-origin:50% 50%"', [90, 200]),
        ('transform="rotate(180)" style="transform-origin:right"', [190, 200]),
        ('transform="rotate(180)" style="transform-origin:top left"', [-10, 0]),
        ('transform="rotate(180)" style="transform-origin:bottom"', [90, 400]),
        ('transform="scale(2)" style="transform-origin:1cm 0 0"', [20 - 960 / 25.4, 0]),
        # The box of the line itself is from (10, 0) to (30, 0).
        ('transform="rotate(180)" style="transform-box:fill-box;transform-origin:center"', [30, 0]),
        ('transform="rotate(180)" style="transform-box:fill-box"', [10, 0]),
        ('style="transform-box:fill-box;transform:translate(50%)"', [20, 0]),
    ],
)
def test_where_a_line_goes(attributes: str, where: list[float]) -> None:
    assert start(LINE.format(attributes)) == pytest.approx(where, abs=1e-6)


def test_rules_give_transforms_too() -> None:
    assert start(LINE.format('class="t"'), ".t{transform:translate(1px,2px)}") == [11, 2]


def test_the_box_of_a_group_is_that_of_all_in_it() -> None:
    css = "g{transform-box:fill-box;transform-origin:center;transform:rotate(180deg)}"
    rect = '<rect x="40" y="10" width="10" height="10" fill="none" stroke="black"/>'
    assert start(f"<g>{rect}{LINE.format('')}</g>", css) == [50, 20]


def test_the_box_is_in_the_coordinates_of_the_element() -> None:
    css = ".t{transform-box:fill-box;transform-origin:0 0;transform:rotate(90deg)}"
    line = LINE.format('class="t"')
    assert start(f'<g transform="translate(5 5) scale(2)">{line}</g>', css) == [25, 5]


def test_quarter_turns_are_exact() -> None:
    [shape] = drawing(LINE.format('transform="rotate(90)"')).shapes
    assert shape.subpaths[0].segments[0].points.tolist() == [[0.0, 190.0], [0.0, 170.0]]


@pytest.mark.parametrize("text", ["", "left right", "1px 2px 3px 4px", "middle", "top 20px", "5px left", "1vw 1px"])
def test_what_is_no_origin(text: str) -> None:
    with pytest.raises(SvgValueError):
        css_origin(text, (0.0, 0.0, 1.0, 1.0))


def test_origins_beyond_all_bounds_are_refused() -> None:
    with pytest.raises(PatternError, match="finite"):
        drawing(LINE.format('transform="scale(1e200)" transform-origin="1e200 1e200"'))


def test_boxes_of_curves_are_tight() -> None:
    assert exact_box([Subpath((cubic([(0, 0), (0, 4), (4, 4), (4, 0)]),), False)]) == pytest.approx((0, 0, 4, 3))
    t = np.linspace(0, 1, 100_001)[:, None]
    points = np.array([(0.0, 0.0), (9.0, -3.0), (-6.0, 7.0), (2.0, 1.0)])
    a, b, c, d = points
    dense = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
    box = exact_box([Subpath((cubic(points),), False)])
    assert box == pytest.approx((*dense.min(axis=0), *dense.max(axis=0)), abs=1e-8)


@pytest.mark.parametrize("sweep", [0.5, 2.0, 5.0, -0.5, -2.0, -5.0])
def test_boxes_of_arcs_are_tight(sweep: float) -> None:
    u, v, begin = np.array([3.0, 1.0]), np.array([-1.0, 2.0]), 0.7
    t = np.linspace(begin, begin + sweep, 100_001)[:, None]
    dense = np.cos(t) * u + np.sin(t) * v
    box = exact_box([Subpath((arc(dense[0], dense[-1], (0, 0), u, v, begin, sweep),), False)])
    assert box == pytest.approx((*dense.min(axis=0), *dense.max(axis=0)), abs=1e-8)
