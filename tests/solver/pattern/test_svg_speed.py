"""Large SVG files are read in seconds: looks are computed once for all elements that share them."""

from __future__ import annotations

import time

import pytest

from solver.errors import CurvefoldError
from solver.pattern.meaning import classify
from solver.pattern.svg_walk import read_drawing
from solver.pattern.svg_xml import parse_svg_tree

CSS = ".m{stroke:#f00;fill:none}.v{stroke:blue}.a,.b{fill:none}g.layer > .m{stroke:red}line{stroke-width:2}"
LINE = '<line class="{c} a" x1="{x}" y1="{y}" x2="{z}" y2="4.25"/>'
STYLED = '<path style="fill:none;stroke:{h};stroke-width:0.26" d="M {x},{y} C {z},1 2,{x} {y},{z}" id="path{k}"/>'
MOVED = '<g id="g{k}" transform="translate({x},{y})"><path class="{c}" d="M0 0L{z} 1"/></g>'
#: Processor seconds for 20,000 strokes: several times what they take on a machine that does nothing else.
SECONDS = 10.0


@pytest.mark.parametrize("element", [LINE, STYLED, MOVED])
def test_twenty_thousand_strokes(element: str) -> None:
    body = "".join(
        element.format(c="mv"[k % 2], h=("#ff0000", "#0000ff")[k % 2], x=k % 97, y=k % 89 + 0.125, z=k % 83, k=k)
        for k in range(20_000)
    )
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99"><style>{CSS}</style><g class="layer">{body}'
    )
    start = time.process_time()
    drawing = read_drawing(parse_svg_tree(f"{text}</g></svg>".encode()))
    roles = {classify(shape).role.name for shape in drawing.shapes}
    assert time.process_time() - start < SECONDS
    assert len(drawing.shapes) == 20_000
    assert roles == {"MOUNTAIN", "VALLEY"}


@pytest.mark.parametrize(
    "element",
    [
        '<path style="stroke:#{k:06x};--a{k}:{k}" d="M0 0h1"/>',  # no two look the same
        '<g style="--a{k}:{k};stroke:var(--a{k}, red)"><path d="M0 0h1"/></g>',
        '<path class="c{k} d{k} e{k}" d="M0 0h1"/>',
    ],
)
def test_looks_that_are_all_different_take_no_more_than_seconds(element: str) -> None:
    body = "".join(element.format(k=k) for k in range(20_000))
    css = "".join(f".c{k}{{stroke:#{k:06x}}}" for k in range(2_000))
    start = time.process_time()
    try:
        read_drawing(parse_svg_tree(f"<svg><style>{css}</style>{body}</svg>"))
    except CurvefoldError as error:
        pytest.fail(str(error))
    assert time.process_time() - start < SECONDS
