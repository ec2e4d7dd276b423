"""Colours as browsers compute them. The expected ones are of CSS Color 4's own examples and conversions."""

from __future__ import annotations

import pytest

from solver.pattern.svg_colours import parse_colour, parse_paint
from solver.pattern.svg_values import UNKNOWN_COLOUR, Colour, SvgValueError


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("rebeccapurple", "#663399"),
        ("AliceBlue", "#f0f8ff"),
        ("#F0a8", "#ff00aa"),
        ("rgb(255 0 0)", "#ff0000"),
        ("rgb(100% 0% 50% / 20%)", "#ff0080"),
        ("RGBA(255, 0, 0, .5)", "#ff0000"),
        ("rgb(none 255 none)", "#00ff00"),
        ("rgb(300 -20 0)", "#ff0000"),
        ("hsl(240, 100%, 50%)", "#0000ff"),
        ("hsl(120deg 100% 25%)", "#008000"),
        ("hsl(0.5turn 100% 50%)", "#00ffff"),
        ("hsl(-120 100% 50% / 1)", "#0000ff"),
        ("hsl(133.33333333grad 100 50)", "#00ff00"),
        ("hsl(3.14159265rad 100% 50%)", "#00ffff"),
        ("hwb(0 0% 0%)", "#ff0000"),
        ("hwb(90deg 20% 20%)", "#80cc33"),
        ("hwb(0 80% 80%)", "#808080"),
        # CSS Color 4, examples of lab(), lch(), oklab() and oklch().
        ("lab(29.2345% 39.3825 20.0664)", "#7d2329"),
        ("lab(52.2345% 40.1645 59.9971)", "#c65d07"),
        ("lch(52.2345% 72.2 56.2)", "#c65d06"),
        ("oklab(40.101% 0.1147 0.0453)", "#7d2429"),
        ("oklab(59.686% 0.1009 0.1192)", "#c65d06"),
        ("oklch(59.686% 0.15619 49.7694)", "#c65d06"),
        ("oklch(62.796% 64.46% 0.08120621turn)", "#ff0000"),
        ("color(srgb 1 0 0)", "#ff0000"),
        ("color(srgb-linear 0.2140411 0 none)", "#800000"),
        ("color(display-p3 1 0 0)", "#ff0000"),
        ("color(display-p3 0.9176 0.2003 0.1386)", "#ff0000"),
        ("color(a98-rgb 0.8586 0 0)", "#ff0000"),
        ("color(prophoto-rgb 0.7022 0.2757 0.1035)", "#ff0000"),
        ("color(rec2020 0.792 0.231 0.0738)", "#ff0000"),
        # White stays white under the other white point, and so do greys.
        ("color(prophoto-rgb 1 1 1)", "#ffffff"),
        ("color(xyz-d50 0.2064 0.2140 0.1765)", "#808080"),
        ("color(prophoto-rgb 0.42467 0.42467 0.42467)", "#808080"),
        ("color(xyz 0.4124 0.2126 0.0193)", "#ff0000"),
        ("color(xyz-d50 0.4361 0.2225 0.0139)", "#ff0000"),
        ("color(display-p3 50% 50% 50% / 0.5)", "#808080"),
        ("device-cmyk(0 1 1 0)", "#ff0000"),
        ("device-cmyk(100% 100% 0% 0% / 0.5)", "#0000ff"),
        ("device-cmyk(0 1 1 0, rgb(0 0 255))", "#0000ff"),
        ("#ff0000 icc-color(sRGB, 0, 0, 1)", "#ff0000"),
        ("rgb(0, 0, 255) icc-color(#profile, 0.1, 0.2)", "#0000ff"),
        ("red device-cmyk(0 0 0 1)", "#ff0000"),
        ("light-dark(red, blue)", "#ff0000"),
    ],
)
def test_colours(text: str, expected: str) -> None:
    wanted, found = (
        [int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in (expected, parse_colour(text).hex)
    )
    # The coordinates of the examples are rounded, which is worth a step or two of 255.
    assert all(abs(a - b) <= 2 for a, b in zip(wanted, found, strict=True)), parse_colour(text).hex


@pytest.mark.parametrize("text", ["rgb(1 2 3 / 25%)", "#01020340", "hsl(0 0% 0% / .25)", "lab(0 0 0 / 0.25)"])
def test_opacity(text: str) -> None:
    assert parse_colour(text).opacity == pytest.approx(0.25, abs=2e-3)


@pytest.mark.parametrize(
    "text",
    [
        "notacolour", "#12345", "#ggg", "rgb(", "rgb(1 2)", "rgb(1 2 3 4)", "rgb(1, 2 3)", "rgb(1deg 2 3)",
        "lab(1, 2, 3)", "lab(29deg 1 1)", "color(unknown 1 0 0)", "color(display-p3 1 0)", "color(1 0 0)",
        "color()",
        "oklch(0.5 0.1 10%)", "hsl(10px 1% 1%)", "hsl(1e999 0% 0%)", "device-cmyk(1 0 0)", "light-dark(red)",
        "icc-color(a, 1)", "red green", "#fff blue", "red icc-color(",
    ],
)  # fmt: skip
def test_what_is_no_colour(text: str) -> None:
    with pytest.raises(SvgValueError, match="is not known"):
        parse_colour(text)


def test_numbers_beyond_all_bounds_are_no_error_of_arithmetic() -> None:
    for text in ("lab(1e308 1e308 1e308)", "oklch(1e308 1e308 1e308rad)", "color(rec2020 1e308 0 0)"):
        try:
            colour = parse_colour(text)
        except SvgValueError:
            continue
        assert (
            0.0 <= min(colour.red, colour.green, colour.blue) <= max(colour.red, colour.green, colour.blue) <= 1.0
        )


def test_paints() -> None:
    red = Colour(1.0, 0.0, 0.0)
    assert parse_paint("none") is None
    assert parse_paint("transparent") is None
    assert parse_paint("currentColor", "red") == red
    assert parse_paint("url(#gradient) red") == red
    # What the paint server is like is not looked at, but it paints, whatever there would be without it.
    assert parse_paint("url(#gradient) none") == UNKNOWN_COLOUR
    assert parse_paint("url(#gradient)") == UNKNOWN_COLOUR
    assert parse_paint("CanvasText") == UNKNOWN_COLOUR
