"""Large SVG files take time in proportion to their size: looks are computed once for elements that share them."""

from __future__ import annotations

import cProfile
import pstats

import pytest

from solver.pattern.svg_walk import read_drawing
from solver.pattern.svg_xml import parse_svg_tree

CSS = ".m{stroke:#f00;fill:none}.v{stroke:blue}.a,.b{fill:none}g.layer > .m{stroke:red}line{stroke-width:2}"
LINE = '<line class="{c} a" x1="{x}" y1="{y}" x2="{z}" y2="4.25"/>'
STYLED = '<path style="fill:none;stroke:{h};stroke-width:0.26" d="M {x},{y} C {z},1 2,{x} {y},{z}" id="path{k}"/>'
MOVED = '<g id="g{k}" transform="translate({x},{y})"><path class="{c}" d="M0 0L{z} 1"/></g>'
#: Looks that no two elements share.
ALL_DIFFERENT = (
    '<path style="stroke:#{k:06x};--a{k}:{k}" d="M0 0h1"/>',
    '<g style="--a{k}:{k};stroke:var(--a{k}, red)"><path d="M0 0h1"/></g>',
    '<path class="c{k} d{k} e{k}" d="M0 0h1"/>',
)


def calls(element: str, count: int) -> int:
    """Calls of functions that reading so many elements takes; the same in every run."""
    body = "".join(
        element.format(c="mv"[k % 2], h=("#ff0000", "#0000ff")[k % 2], x=k % 97, y=k % 89 + 0.125, z=k % 83, k=k)
        for k in range(count)
    )
    css = CSS + "".join(f".c{k}{{stroke:#{k:06x}}}" for k in range(count // 10))
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99"><style>{css}</style><g class="layer">{body}'
    )
    profile = cProfile.Profile()
    profile.runcall(lambda: read_drawing(parse_svg_tree(f"{text}</g></svg>".encode())))
    return int(pstats.Stats(profile).total_calls)


@pytest.mark.parametrize("element", [LINE, STYLED, MOVED, *ALL_DIFFERENT])
def test_twice_as_many_strokes_take_twice_as_many_steps(element: str) -> None:
    assert calls(element, 4000) < 2.1 * calls(element, 2000)
