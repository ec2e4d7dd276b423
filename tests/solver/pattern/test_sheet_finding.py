"""Which outlines are sheets, frames and holes, where several could be."""

from __future__ import annotations

import io

import numpy as np
import pytest
import shapely

from solver.pattern.crease_pattern import CreasePattern
from solver.pattern.read_options import ReadOptions
from solver.pattern.svg import read_svg

RED, BLUE, BLACK = 'stroke="#f00"', 'stroke="#00f"', 'stroke="#000"'


def read(body: str, options: ReadOptions | None = None) -> tuple[CreasePattern, ...]:
    text = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" width="100mm" height="100mm">'
        f'<g fill="none">{body}</g></svg>'
    )
    return read_svg(io.BytesIO(text.encode()), options)


def box(x: float, y: float, width: float, height: float, look: str = BLACK) -> str:
    return f'<rect x="{x}" y="{y}" width="{width}" height="{height}" {look}/>'


def line(x0: float, y0: float, x1: float, y1: float, look: str) -> str:
    return f'<path d="M{x0} {y0}L{x1} {y1}" {look}/>'


def extent(pattern: CreasePattern) -> list[float]:
    return [*pattern.boundary.min(axis=0).tolist(), *pattern.boundary.max(axis=0).tolist()]


@pytest.mark.parametrize("look", [BLACK, f'{BLACK} class="border"', 'stroke="#0f0"'])
def test_an_outline_around_the_creases_is_no_hole_of_the_page(look: str) -> None:
    body = box(10, 10, 80, 80, look) + line(10, 50, 90, 50, RED)
    [pattern] = read(body, ReadOptions(border="page"))
    assert extent(pattern) == [0.0, 0.0, 100.0, 100.0]
    assert pattern.holes == ()
    assert len(pattern.creases) == 1
    assert any("left out: an outline on the page, which is the sheet" in note for note in pattern.notes)


def test_outlines_around_each_other_are_no_holes_of_the_page_and_windows_are() -> None:
    frames = "".join(box(k, k, 100 - 2 * k, 100 - 2 * k) for k in (0, 5, 10))
    body = frames + '<circle cx="50" cy="20" r="3" stroke="#000"/>' + line(10, 50, 90, 50, RED)
    [pattern] = read(body, ReadOptions(border="page"))
    assert len(pattern.holes) == 1
    assert len(pattern.creases) == 1


def test_a_border_named_so_around_black_creases_is_no_hole_of_the_page() -> None:
    body = box(10, 10, 80, 80, f'{BLACK} class="border"') + line(10, 50, 90, 50, BLACK)
    [pattern] = read(body, ReadOptions(border="page"))
    assert pattern.holes == ()
    assert len(pattern.creases) == 1


def test_the_innermost_of_several_frames_is_the_one_sheet() -> None:
    frames = "".join(box(k, k, 100 - 2 * k, 100 - 2 * k) for k in (0, 3, 6, 10))
    [pattern] = read(frames + line(10, 50, 90, 50, RED))
    assert extent(pattern) == [10.0, 10.0, 90.0, 90.0]


def test_many_frames_around_a_sheet_are_looked_through_at_once() -> None:
    frames = "".join(box(k / 10, k / 10, 100 - k / 5, 100 - k / 5) for k in range(40))
    [pattern] = read(frames + line(10, 50, 90, 50, RED))
    assert len(pattern.creases) == 1


def test_sides_are_told_apart_over_all_sheets() -> None:
    """One sheet is folded up and the other one down: alone, the colour of each would say nothing."""
    frame = box(0, 0, 100, 100)
    sheets = [box(x, 5, 40, 90) + box(x + 3, 8, 34, 84) for x in (5, 55)]
    folds = line(8, 50, 42, 50, RED) + line(58, 50, 92, 50, BLUE)
    left, right = read(frame + "".join(sheets) + folds)
    assert [crease.assignment for crease in left.creases] == ["M"]
    assert [crease.assignment for crease in right.creases] == ["V"]


def test_holes_that_touch_each_other_are_both_holes() -> None:
    holes = "".join(f'<circle cx="{x}" cy="50" r="10" stroke="#000"/>' for x in (30, 50))
    [pattern] = read(box(10, 10, 80, 80) + holes + line(10, 70, 90, 70, RED))
    assert len(pattern.holes) == 2
    areas = [shapely.Polygon(hole).area for hole in pattern.holes]
    np.testing.assert_allclose(areas, 100 * np.pi, rtol=1e-3)


def test_two_sheets_in_a_file_keep_what_contradicts_itself_with_a_note_more() -> None:
    both = line(0, 50, 40, 50, RED) + line(0, 50, 40, 50, BLUE)
    first = read(box(0, 0, 40, 100) + box(60, 0, 40, 100) + both + line(60, 50, 100, 50, RED))[0]
    assert len(first.conflicts) == 1
    assert first.noted("of two sheets").conflicts == first.conflicts
