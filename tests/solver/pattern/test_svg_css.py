"""The cascade, selectors and computed styles: what browsers paint."""

from __future__ import annotations

import time

import pytest

from solver.errors import ReadError
from solver.pattern.css_syntax import split_declarations, split_rules, unescape
from solver.pattern.svg_values import UNKNOWN_COLOUR
from solver.pattern.svg_walk import Drawing, read_drawing
from solver.pattern.svg_xml import parse_svg_tree


def drawing(body: str, css: str = "", attributes: str = "") -> Drawing:
    style = f"<style><![CDATA[{css}]]></style>" if css else ""
    return read_drawing(parse_svg_tree(f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{style}{body}</svg>'))


def stroke(body: str, css: str = "", attributes: str = "") -> str:
    """The stroke of the last shape."""
    colour = drawing(body, css, attributes).shapes[-1].stroke
    return "none" if colour is None else colour.hex


RED, BLUE, GREEN = "#ff0000", "#0000ff", "#00ff00"
PATH = '<path d="M0 0H9" {}/>'


# ---- the cascade


@pytest.mark.parametrize(
    ("css", "attributes", "expected"),
    [
        ("path{stroke:red}", 'stroke="blue"', RED),
        (".m{stroke:red} path{stroke:blue}", 'class="m"', RED),
        ("#a{stroke:red} .m.n{stroke:blue}", 'class="m n" id="a"', RED),
        (".m{stroke:blue} .m{stroke:red}", 'class="m"', RED),
        (".m{stroke:blue}", 'class="m" style="stroke:red"', RED),
        (".m{stroke:red!important}", 'class="m" style="stroke:blue"', RED),
        (".m{stroke:red ! IMPORTANT}", 'class="m" style="stroke:blue"', RED),
        (".m{stroke:blue!important}", 'class="m" style="stroke:red !important"', RED),
        ("#a{stroke:blue!important} .m{stroke:red!important}", 'class="m" id="a"', BLUE),
        # An invalid declaration is passed over, wherever it is, and an earlier one stands.
        ("", 'style="stroke:#FF0000;stroke:color(unknown 1 0 0)"', RED),
        ("", 'style="stroke:#FF0000;stroke:color(display-p3 0 0 1)"', BLUE),
        (".m{stroke:red} #a{stroke:bogus}", 'class="m" id="a" stroke="blue"', RED),
        ("", 'stroke="red" style="stroke:bogus!important"', RED),
        ("", 'stroke="red" style="stroke:"', RED),
        ("", 'stroke="red" style="STROKE:blue"', BLUE),
        ("", 'stroke="red" style="fill:url(data:a;stroke:blue)"', RED),
        ("", 'stroke="red" style="font:\'a;stroke:blue\'"', RED),
        ("", 'style="/* stroke:blue; */stroke:red/**/"', RED),
        ("", 'stroke="red" style="stroke:inherit"', GREEN),
        ("", 'stroke="red" style="stroke:unset"', GREEN),
        ("", 'stroke="red" style="stroke:initial"', "none"),
    ],
)
def test_which_declaration_counts(css: str, attributes: str, expected: str) -> None:
    assert stroke(f'<g stroke="lime">{PATH.format(attributes)}</g>', css) == expected


def test_what_is_passed_over_is_noted() -> None:
    read = drawing(PATH.format('style="stroke:red;stroke:color(unknown 1 0 0);cursor:grab"'))
    [note] = [note for note in read.notes if "passed over" in note]
    assert "stroke: color(unknown 1 0 0)" in note
    assert "cursor" not in note


def test_a_stroke_that_nothing_understood_describes_is_a_stroke() -> None:
    read = drawing(PATH.format('stroke="color-mix(in srgb, red, blue)"'))
    assert read.shapes[0].stroke == UNKNOWN_COLOUR
    assert any("whose colour is not used" in note and "color-mix" in note for note in read.notes)
    inherited = PATH.format('stroke="bogus"')
    assert stroke(f'<g stroke="red">{inherited}</g>') == RED


def test_system_colours_are_black_and_noted() -> None:
    read = drawing(PATH.format('stroke="CanvasText"'))
    assert read.shapes[0].stroke == UNKNOWN_COLOUR
    assert any("'CanvasText'" in note for note in read.notes)


def test_unusable_widths_and_opacities_leave_the_ones_before() -> None:
    [shape] = drawing(
        PATH.format('stroke="red" stroke-width="thick" opacity="half" style="stroke-width:-3"')
    ).shapes
    assert shape.opacity == 1.0


# ---- custom properties


@pytest.mark.parametrize(
    ("css", "attributes", "expected"),
    [
        ("", 'stroke="var(--stroke-0, #0000FF)"', BLUE),
        (":root{--m:red}", 'stroke="var(--m)"', RED),
        (":root{--m:blue} g{--m:red}", 'stroke="var(--m)"', RED),
        (":root{--m:blue} path{--m:red}", 'style="stroke:var( --m )"', RED),
        ("", 'style="--m:red;stroke:var(--m, blue)"', RED),
        ("", 'stroke="var(--a, var(--b, var(--c, red)))"', RED),
        (":root{--b:red}", 'stroke="var(--a, var(--b, blue))"', RED),
        (":root{--a:red}", 'stroke="var(--a, var(--nothing))"', RED),
        (":root{--a:var(--b);--b:var(--c, red)}", 'stroke="var(--a)"', RED),
        (":root{--r:255;--all:var(--r) 0 0}", 'stroke="rgb(var(--all))"', RED),
        (":root{--M:red;--m:blue}", 'stroke="var(--M)"', RED),
        (":root{--m:red!important} path{--m:blue}", 'stroke="var(--m)"', BLUE),
        (":root{--c:red}", 'color="var(--c)" stroke="currentColor"', RED),
        # What stands for nothing leaves what is inherited.
        (":root{--m:12px}", 'stroke="var(--m)"', GREEN),
        (":root{--a:var(--b);--b:var(--a)}", 'stroke="var(--a)"', GREEN),
    ],
)
def test_custom_properties(css: str, attributes: str, expected: str) -> None:
    assert stroke(f'<g stroke="lime">{PATH.format(attributes)}</g>', css) == expected


def test_custom_properties_do_not_explode() -> None:
    rules = "--a0:red;" + "".join(f"--a{k}:{f'var(--a{k - 1}) ' * 10};" for k in range(1, 40))
    start = time.process_time()
    read = drawing(PATH.format('stroke="var(--a39)"'), f":root{{{rules}}}")
    assert read.shapes[0].stroke == UNKNOWN_COLOUR
    assert time.process_time() - start < 5


def test_a_custom_property_too_long_for_any_value_stands_for_nothing() -> None:
    read = drawing(PATH.format('stroke="var(--a)"'), f":root{{--a:{'x' * 20_000}}}")
    assert read.shapes[0].stroke == UNKNOWN_COLOUR


# ---- selectors

TREE = (
    '<g id="one" class="layer"><path d="M0 0H9" class="a b" id="first" data-x="Yes" data-list="u v"/>'
    '<line x2="9" id="middle" lang="de-CH"/><path d="M0 0H9" id="last"/></g>'
)


@pytest.mark.parametrize(
    ("selector", "matched"),
    [
        ("*", "first middle last"),
        ("path", "first last"),
        ("g path", "first last"),
        ("svg > path", ""),
        ("svg > g > path", "first last"),
        ("svg > g path.a", "first"),
        (".a.b", "first"),
        (".A", ""),
        ("#last,.b", "first last"),
        ("path + line", "middle"),
        ("path + path", ""),
        ("path ~ path", "last"),
        ("g.layer>line~path", "last"),
        ("[data-x]", "first"),
        ("[data-x='Yes']", "first"),
        ('[data-x="yes"]', ""),
        ('[data-x="yes" i]', "first"),
        ("[data-list~=v]", "first"),
        ("[lang|=de]", "middle"),
        ("[id^=mid]", "middle"),
        ("[id$=st]", "first last"),
        ("[id*=s]", "first last"),
        ("[id^='']", ""),
        (":first-child", "first"),
        ("path:last-child", "last"),
        (":nth-child(2)", "middle"),
        (":nth-child(odd)", "first last"),
        (":nth-child(2n + 1)", "first last"),
        (":nth-child(-n+2)", "first middle"),
        (":nth-last-child(1)", "last"),
        ("path:nth-of-type(2)", "last"),
        ("line:only-of-type", "middle"),
        ("path:not(.a)", "last"),
        ("g > :not(path, #x)", "middle"),
        (":is(line, .a)", "first middle"),
        (":root line", "middle"),
        ("path:hover", ""),
        ("svg|path", "first last"),
        (r"#f\69rst", "first"),
    ],
)
def test_selectors(selector: str, matched: str) -> None:
    # Groups inherit nothing here: what a selector matches is seen at the shapes themselves.
    read = drawing(
        TREE, f"g path, g line{{fill:none;stroke-width:1;stroke:black}} {selector}{{stroke:red!important}}"
    )
    assert " ".join(s.identity for s in read.shapes if s.stroke is not None and s.stroke.hex == RED) == matched


@pytest.mark.parametrize("selector", ["path::unknown-thing", "path:has(a)", "a b c d e f g h i j k l", "path!"])
def test_selectors_that_are_not_understood_are_noted(selector: str) -> None:
    read = drawing(PATH.format('stroke="blue"'), f"{selector}, .other{{stroke:red}} path{{fill:none}}")
    assert any("style rules that are left out" in note for note in read.notes)
    assert read.shapes[0].stroke is not None
    assert read.shapes[0].stroke.hex == BLUE


def test_a_child_of_a_farther_match_is_found() -> None:
    body = f'<g class="a"><g class="b"><g><g class="b">{PATH.format("")}</g></g></g></g>'
    assert stroke(body, ".a > .b path{stroke:red}") == RED


# ---- rules


@pytest.mark.parametrize(
    ("css", "expected"),
    [
        ("@media screen{path{stroke:red}}", RED),
        ("@media all and (prefers-color-scheme: light){path{stroke:red}}", RED),
        ("@media (prefers-color-scheme: dark){path{stroke:red}}", BLUE),
        ("@media print{path{stroke:red}}", BLUE),
        ("@media print, screen{path{stroke:red}}", RED),
        ("@media not print{path{stroke:red}}", RED),
        ("@media only screen{@media all{path{stroke:red}}}", RED),
        ("@media print{path{stroke:lime} g{fill:none}} path{stroke:red}", RED),
        ("@supports (color: color(display-p3 1 1 1)){path{stroke:red}}", RED),
        ("@supports (color: unknown-thing(1)){path{stroke:red}}", BLUE),
        ("@import url('a;b{}.css'); path{stroke:red}", RED),
        ("@font-face{font-family:x;src:url(data:font/woff;base64,AA==)} path{stroke:red}", RED),
        ("@charset 'utf-8';path{stroke:red}", RED),
        ("<!-- path{stroke:red} -->", RED),
        ("path{fill:none;.x{stroke:lime} stroke:red}", RED),
        ("path{stroke:red", RED),
        ("path{content:'}'; stroke:red}", RED),
        ("a{b:c}}path{stroke:red}", BLUE),
    ],
)
def test_rules(css: str, expected: str) -> None:
    assert stroke(PATH.format('stroke="blue"'), css) == expected


def test_what_is_left_out_is_noted_and_fonts_are_not() -> None:
    notes = drawing(PATH.format('stroke="red"'), "@font-face{a:b} @import 'x.css'; @media print{a{b:c}}").notes
    [note] = [note for note in notes if "left out" in note]
    assert "@import" in note
    assert "@media print" in note
    assert "font-face" not in note


def test_css_is_cut_at_the_right_places() -> None:
    assert list(split_rules("@a x; b{c:';}'}d{e{f}g}")) == [("@a x", None), ("b", "c:';}'"), ("d", "e{f}g")]
    assert list(split_declarations("a:b;C : d(;) !important;--X:y;z")) == [
        ("a", "b", False),
        ("c", "d(;)", True),
        ("--X", "y", False),
    ]
    assert unescape(r"\31 st\:x\00003b") == "1st:x;"


# ---- measures by style (SVG 2)


def test_measures_may_be_styles() -> None:
    [shape] = drawing(
        '<circle class="c"/>', ".c{cx:5px;cy:5px;r:2px;fill:none;stroke:red}", 'viewBox="0 0 9 9"'
    ).shapes
    assert shape.subpaths[0].segments[0].start.tolist() == [7.0, 4.0]
    [shape] = drawing("<path style=\"d:path('M1 2H3');stroke:red\"/>", "", 'viewBox="0 0 9 9"').shapes
    assert shape.subpaths[0].segments[0].points.tolist() == [[1.0, 7.0], [3.0, 7.0]]


def test_the_size_of_the_page_may_be_a_style() -> None:
    read = drawing(PATH.format('stroke="red"'), "", 'viewBox="0 0 100 100" style="width:50mm;height:50mm"')
    assert read.unit_mm == pytest.approx(0.5)


# ---- hairlines


def test_strokes_without_width_are_hairlines_unless_they_are_filled() -> None:
    read = drawing(
        '<g stroke="red" stroke-width="0" fill="none"><path d="M0 0H9"/><rect width="9" height="9"/></g>'
        '<line x2="9" stroke="blue" stroke-width="0mm"/>'
        '<rect width="9" height="9" stroke="red" stroke-width="0"/>'
    )
    assert [shape.stroke is not None for shape in read.shapes] == [True, True, True, False]
    assert "3 strokes of width 0 are read as hairlines" in read.notes
    assert any("1 stroke of width 0 is left out" in note for note in read.notes)


def test_a_width_in_percent_is_a_width() -> None:
    read = drawing('<rect width="9" height="9" stroke="red" stroke-width="1%"/>', "", 'viewBox="0 0 9 9"')
    assert read.shapes[0].stroke is not None
    assert not any("width 0" in note for note in read.notes)


# ---- bounds


def test_style_sheets_made_to_stall_are_refused() -> None:
    many = "".join(f"g:nth-child({k}) *{{stroke:red}}" for k in range(2000))
    body = "<g><path d='M0 0H9'/></g>" * 3000
    start = time.process_time()
    with pytest.raises(ReadError, match="too many rules"):
        drawing(body, many)
    with pytest.raises(ReadError, match="20,000 rules"):
        drawing(body, "a,b,c,d,e{stroke:red}" * 5000)
    assert time.process_time() - start < 20


@pytest.mark.parametrize(
    "css", ["{" * 200_000, "(" * 200_000, "a{" * 100_000, ":not(" * 50_000, "\\" * 99_999, "'" * 99_999]
)
def test_broken_style_sheets_take_linear_time(css: str) -> None:
    start = time.process_time()
    drawing(PATH.format('stroke="red"'), css)
    assert time.process_time() - start < 5
