"""Drawings as CAD, origami, laser and plotting programs and libraries write them. No file is copied."""

from __future__ import annotations

import itertools
from xml.sax.saxutils import escape

import numpy as np

from tests.solver.pattern.strangers_designs import Rng, lines
from tests.solver.pattern.strangers_editors import PT, PX
from tests.solver.pattern.strangers_habits import Page, Stroke
from tests.solver.pattern.strangers_pen import Export, Look, Pen, groups, pen_for

SVG = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


def _pieces(stroke: Stroke) -> list[Stroke]:
    """The stroke as straight lines, one each."""
    points = stroke.curve.points()
    return [Stroke(stroke.kind, lines(a, b)) for a, b in itertools.pairwise(points)]


# --- CAD ------------------------------------------------------------------------------------------------


def librecad(page: Page, look: Look, rng: Rng) -> Export:
    """A layer is a group, told by lc:layername; every line an element of its own; arcs as arcs."""
    pen = pen_for(page, 1.0, digits=5)
    rows = []
    for name, strokes in groups(page, look):
        rows.append(
            f'<g lc:layername="{name or "0"}" lc:is_locked="false" lc:is_printable="true" '
            'lc:is_construction="false" '
            'fill="none" stroke="black" stroke-width="0.25">'
        )
        for stroke in strokes:
            parts = _pieces(stroke) if stroke.curve.straight else [stroke]
            own = f'stroke="{look.hex(stroke.kind)}"' if look.marks != "names" else ""
            rows += [pen.element(part, own, arcs=True) for part in parts]
        rows.append("</g>")
    text = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<svg {SVG} xmlns:lc="https://librecad.org" '
        f'width="{page.width:.5f}mm" height="{page.height:.5f}mm" viewBox="0 0 {page.width:.5f} '
        f'{page.height:.5f}">\n' + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, 1.0, 1.0)


def qcad(page: Page, look: Look, rng: Rng) -> Export:
    """y up by scale(1,-1), one path for each line or arc, layers as groups."""
    pen = Pen(1.0, flipped=False, digits=6)
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'    <g id="{name}">' if name else "    <g>")
        for stroke in strokes:
            dash = look.dash(stroke.kind)
            dashes = f"stroke-dasharray:{','.join(f'{part:g}' for part in dash)};" if dash else ""
            style = f"stroke:{look.hex(stroke.kind)};stroke-width:0.25;{dashes}fill:none"
            for part in _pieces(stroke) if stroke.curve.straight else [stroke]:
                rows.append(f"      <!-- {'Line' if part.curve.straight else 'Arc'} -->")
                rows.append(f'      <path style="{style}" d="{pen.arc_data(part)}"/>')
        rows.append("    </g>")
    box = f"0 {-page.height:.6f} {page.width:.6f} {page.height:.6f}"
    text = (
        f'<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n<svg {SVG} width="{page.width:.6f}mm" '
        f'height="{page.height:.6f}mm" viewBox="{box}" version="1.1">\n  <g transform="scale(1,-1)">\n'
        + "\n".join(rows)
        + "\n  </g>\n</svg>\n"
    )
    return Export(text, 1.0, 1.0)


def autocad(page: Page, look: Look, rng: Rng) -> Export:
    """A DXF converter: everything straight lines inside a scaled group, y up."""
    pen = Pen(10.0, flipped=False, digits=4)
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'<g id="{name or "0"}" class="layer">')
        for stroke in strokes:
            rows += [pen.element(piece, f'style="stroke:{look.hex(stroke.kind)}"') for piece in _pieces(stroke)]
        rows.append("</g>")
    text = (
        f'<svg {SVG} version="1.1" width="{PX * page.width:.2f}" height="{PX * page.height:.2f}" '
        f'viewBox="0 0 {page.width:.4f} {page.height:.4f}">\n<g fill="none" stroke-width="1" '
        f'transform="translate(0,{page.height:.4f}) scale(0.1,-0.1)">\n' + "\n".join(rows) + "\n</g>\n</svg>\n"
    )
    return Export(text, 1.0, None)


def rhino(page: Page, look: Look, rng: Rng) -> Export:
    pen = pen_for(page, PT, digits=5)
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'\t<g id="{name}">' if name else "\t<g>")
        for stroke in strokes:
            dash = look.dash(stroke.kind)
            dashes = f' stroke-dasharray="{",".join(f"{PT * part:.4g}" for part in dash)}"' if dash else ""
            own = (
                f'fill="none" stroke="{look.hex(stroke.kind)}" stroke-width="0.25" stroke-linecap="butt" '
                f'stroke-linejoin="miter" stroke-miterlimit="10"{dashes}'
            )
            rows.append("\t\t" + pen.element(stroke, own))
        rows.append("\t</g>")
    text = (
        '<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n<!--Created with Rhino -->\n'
        f'<svg {SVG} version="1.1" width="{page.width / 25.4:.4f}in" height="{page.height / 25.4:.4f}in" '
        f'viewBox="0 0 {PT * page.width:.4f} {PT * page.height:.4f}" overflow="visible">\n'
        + "\n".join(rows)
        + "\n</svg>\n"
    )
    return Export(text, PT, 25.4 / 72)


def openscad(page: Page, look: Look, rng: Rng) -> Export:
    """One outline of all that is there, and nothing else: a blank sheet with its holes."""
    pen = Pen(1.0, flipped=True)
    rings = [Stroke(ring.kind, ring.curve, False) for ring in (*page.of("border"), *page.of("hole"))]
    data = "\n".join(pen.data(ring) for ring in rings)
    text = (
        '<?xml version="1.0" standalone="no"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n'
        f'<svg width="{page.width:.0f}mm" height="{page.height:.0f}mm" viewBox="0 -{page.height:.0f} '
        f'{page.width:.0f} {page.height:.0f}" xmlns="http://www.w3.org/2000/svg" version="1.1">\n'
        f'<title>OpenSCAD Model</title>\n<path d="\n{data}\n" stroke="black" fill="lightgray" '
        'stroke-width="0.5"/>\n</svg>\n'
    )
    return Export(text, 1.0, 1.0)


# --- origami --------------------------------------------------------------------------------------------


def origami_simulator(page: Page, look: Look, rng: Rng) -> Export:
    """Every curve as straight lines, fold angles as opacities, yellow facets between, no units."""
    pen = pen_for(page, 4.0)
    rows = []
    for stroke in page.strokes:
        if stroke.kind in ("border", "hole", "cut"):
            own = f'stroke="{"rgb(0,255,0)" if stroke.kind == "cut" else "rgb(0,0,0)"}" opacity="1"'
        else:
            own = f'stroke="{look.rgb(stroke.kind)}" opacity="{rng.choice([0.25, 0.5, 0.75, 1.0]):g}"'
        rows += [
            pen.element(piece, f'{own} fill="none" stroke-width="2" stroke-linecap="round"')
            for piece in _pieces(stroke)
        ]
    creases = page.of("M", "V")
    for one, other in itertools.pairwise(creases):
        # Facets between neighbours that have as many points, a few of each.
        first, last = one.curve.points(), other.curve.points()
        if len(first) == len(last) and len(first) > 4 and not one.curve.closed:
            for a, b in zip(first[2:-2:4], last[2:-2:4], strict=True):
                row = pen.element(
                    Stroke("facet", lines(a, b)), 'stroke="rgb(255,255,0)" opacity="1" stroke-width="1"'
                )
                rows.append(row)
    text = (
        f'<?xml version="1.0" encoding="utf-8"?>\n<svg version="1.1" {SVG} x="0px" y="0px" '
        f'width="{4 * page.width:.3f}px" '
        f'height="{4 * page.height:.3f}px" viewBox="0 0 {4 * page.width:.3f} {4 * page.height:.3f}" '
        'enable-background="new 0 0 400 400" xml:space="preserve">\n<g>\n' + "\n".join(rows) + "\n</g>\n</svg>\n"
    )
    return Export(text, 4.0, None)


def oripa(page: Page, look: Look, rng: Rng) -> Export:
    """Lines only, on a page of 512 dots."""
    scale = 512 / max(page.width, page.height)
    pen = pen_for(page, scale, digits=6)
    styles = {
        "M": "stroke:red;stroke-width:2;",
        "V": "stroke:blue;stroke-width:2;stroke-opacity:1",
        "U": "stroke:magenta;stroke-width:2;",
    }
    rows = [
        "  " + pen.element(piece, f'style="{styles.get(stroke.kind, "stroke:black;stroke-width:4;")}"')
        for stroke in page.strokes
        for piece in _pieces(stroke)
    ]
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n'
        f'<svg {SVG} xmlns:ev="http://www.w3.org/2001/xml-events" version="1.1" baseProfile="full" '
        f'width="512px" height="512px" viewBox="0 0 512 512">\n' + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, scale, None)


def oriedita(page: Page, look: Look, rng: Rng) -> Export:
    """Lines with widths of their own, moved by an offset, on a white rectangle without a viewBox."""
    scale, left, top = 3.5, 57.0, 83.0
    pen = pen_for(page, scale, left, top, digits=7)
    rows = []
    for stroke in page.strokes:
        dash = look.dash(stroke.kind)
        dashes = f' stroke-dasharray="{" ".join(f"{scale * part:.3g}" for part in dash)}"' if dash else ""
        own = f'style="stroke:{look.hex(stroke.kind)};stroke-width:1;"{dashes}'
        rows += [pen.element(piece, own) for piece in _pieces(stroke)]
    width, height = f"{scale * page.width + 2 * left:.2f}", f"{scale * page.height + 2 * top:.2f}"
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:svg="http://www.w3.org/2000/svg" width="{width}" '
        f'height="{height}" version="1.1">\n<rect x="0" y="0" width="{width}" height="{height}" fill="#ffffff"/>\n'
        + "\n".join(rows)
        + "\n</svg>\n"
    )
    return Export(text, scale, None)


def rabbit_ear(page: Page, look: Look, rng: Rng) -> Export:
    """A square of one unit, y down; classes tell what an edge is, and in half of the files nothing else does."""
    size = max(page.width, page.height)
    scale = 1.0 / size
    pen = pen_for(page, scale, digits=6)
    plain = rng.random() < 0.5
    words = {
        "M": "mountain",
        "V": "valley",
        "U": "unassigned",
        "border": "boundary",
        "hole": "boundary",
        "cut": "cut",
    }
    colours = {"M": "red", "V": "blue", "U": "lightgray"}
    rows = []
    for kind in dict.fromkeys(stroke.kind for stroke in page.strokes if stroke.kind in words):
        own = "" if plain else f' stroke="{colours.get(kind, "black")}"'
        dash = ' stroke-dasharray="0.02 0.01"' if kind == "V" and rng.random() < 0.5 else ""
        rows.append(f'<g class="{words[kind]}"{own}{dash}>')
        rows += [pen.element(piece, "") for stroke in page.of(kind) for piece in _pieces(stroke)]
        rows.append("</g>")
    faces = "".join(
        f'<path class="front" fill="#fff" stroke="none" d="{pen.data(stroke)}"/>'
        for stroke in page.of("border")
        if stroke.curve.closed
    )
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {pen.number(scale * page.width)} '
        f'{pen.number(scale * page.height)}" width="500px" class="creasePattern"><g class="graph">'
        f'<g class="faces">{faces}</g>\n<g class="edges" stroke-width="0.005" fill="none" stroke="black">'
        + "\n".join(rows)
        + "</g></g></svg>\n"
    )
    return Export(text, scale, None)


# --- lasers ---------------------------------------------------------------------------------------------


def laser(page: Page, look: Look, rng: Rng) -> Export:
    """Box generators: outer cuts black, inner cuts blue, etched folds green, red annotations, text for labels."""
    pen = pen_for(page, 1.0)
    rows = []
    order = (
        ("inner cuts", ("hole", "cut"), "rgb(0,0,255)"),
        ("outer cuts", ("border",), "rgb(0,0,0)"),
        ("mountain folds, etched", ("M",), "rgb(0,255,0)"),
        ("valley folds, etched", ("V",), "rgb(0,255,255)"),
        ("fold lines", ("U",), "rgb(0,255,0)"),
        ("annotations", ("dimension",), "rgb(255,0,0)"),
    )
    for number, (name, kinds, colour) in enumerate(order):
        strokes = page.of(*kinds)
        if not strokes:
            continue
        rows.append(
            f'<g id="p-{number}" inkscape:label="{name}" '
            'style="fill:none;stroke-linecap:round;stroke-linejoin:round;">'
        )
        rows += [f'  <path d="{pen.data(stroke)}" stroke="{colour}" stroke-width="0.20"/>' for stroke in strokes]
        rows.append("</g>")
    for x, y, words in page.texts:
        rows.append(
            '<g><text alignment-baseline="hanging" text-anchor="start" font-family="sans-serif" '
            'font-size="4.00px" '
            f'fill="rgb(255,0,0)" stroke="none" transform="matrix( 1.000 0.000 0.000 1.000 {x:.3f} '
            f'{page.height - y:.3f} )">'
            f"{escape(words)}</text></g>"
        )
    text = (
        f"<?xml version='1.0' encoding='utf-8'?>\n<svg height=\"{page.height:.2f}mm\" viewBox=\"0.0 0.0 "
        f"{page.width:.2f} "
        f'{page.height:.2f}" width="{page.width:.2f}mm" {SVG} '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape">\n<title>Box</title>\n'
        + "\n".join(rows)
        + "\n</svg>\n"
    )
    return Export(text, 1.0, 1.0)


# --- typesetting and plotting ---------------------------------------------------------------------------


def _glyphs(page: Page, prefix: str, scale: float, tag: str) -> tuple[str, str]:
    """(definitions, uses) of words as outlines, the way typesetters write them; a glyph is a filled square here."""
    if not page.texts:
        return "", ""
    made = f'<defs>\n<{tag} id="{prefix}-65" d="M0.5 -6H4V0H0.5Z M1.5 -5H3V-1H1.5Z"/>\n</defs>\n'
    uses = []
    for x, y, words in page.texts:
        uses += [
            f'<use x="{scale * x + 5 * k:.3f}" y="{scale * (page.height - y):.3f}" xlink:href="#{prefix}-65"/>'
            for k in range(len(words))
        ]
    return made, "\n".join(uses)


def dvisvgm(page: Page, look: Look, rng: Rng) -> Export:
    """TikZ by way of dvisvgm: TeX's points scaled to PostScript's, y up, words as glyphs."""
    tex = 72.27 / 25.4
    big = 0.996264
    x0, y0 = 56.4094, 53.8583
    pen = Pen(tex, flipped=False, digits=5)
    rows = []
    for stroke in page.strokes:
        dash = look.dash(stroke.kind)
        dashes = f" stroke-dasharray='{','.join(f'{tex * part:.5f}' for part in dash)}'" if dash else ""
        data = pen.data(stroke, blank=" ").replace(",", " ")
        rows.append(f"<g stroke='{look.hex(stroke.kind)}'{dashes}>\n<path d='{data}' fill='none'/>\n</g>")
    definitions, uses = _glyphs(page, "g0", tex * big, "path")
    width, height = tex * big * page.width, tex * big * page.height
    text = (
        "<?xml version='1.0' encoding='UTF-8'?>\n<!-- This file was generated by dvisvgm 2.13.3 -->\n"
        f"<svg version='1.1' {SVG} width='{width:.6f}pt' height='{height:.6f}pt' "
        f"viewBox='{x0} {y0} {width:.6f} {height:.6f}'>\n{definitions}<g id='page1'>\n"
        f"<g stroke-miterlimit='10' transform='translate({x0},{y0 + height:.6f})scale({big},-{big})' fill='#000' "
        "stroke='#000' stroke-width='0.4'>\n"
        + "\n".join(rows)
        + f"\n</g>\n<g transform='translate({x0},{y0})'>{uses}</g>\n"
        "</g>\n</svg>\n"
    )
    return Export(text, tex * big, 25.4 / 72)


def matplotlib(page: Page, look: Look, rng: Rng) -> Export:
    """A figure with white patches, clipped axes, curves as polylines, words as glyphs."""
    pen = pen_for(page, PT, digits=6)
    width, height = PT * page.width, PT * page.height
    ground = f"M 0 {height:.6f} L {width:.6f} {height:.6f} L {width:.6f} 0 L 0 0 z"
    rows = []
    for k, stroke in enumerate(page.strokes):
        dash = look.dash(stroke.kind)
        dashes = (
            f" stroke-dasharray: {','.join(f'{PT * part:.4g}' for part in dash)}; stroke-dashoffset: 0;"
            if dash
            else ""
        )
        data = pen.data(Stroke(stroke.kind, stroke.curve, False)).replace(",", " ").replace(" L", "\nL")
        patch = stroke.curve.closed
        style = f"fill: none;{dashes} stroke: {look.hex(stroke.kind)}; stroke-width: 1.5; " + (
            "stroke-linejoin: miter" if patch else "stroke-linecap: square"
        )
        rows.append(
            f'   <g id="{"patch" if patch else "line2d"}_{k + 3}">\n    <path d="{data}\n" '
            f'clip-path="url(#p0a1b2c3d)" style="{style}"/>\n   </g>'
        )
    definitions, uses = _glyphs(page, "DejaVuSans", PT, "path")
    text = (
        '<?xml version="1.0" encoding="utf-8" standalone="no"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN"\n'
        f'  "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n<svg xmlns:xlink="http://www.w3.org/1999/xlink" '
        f'width="{width:.6f}pt" height="{height:.6f}pt" viewBox="0 0 {width:.6f} {height:.6f}" '
        'xmlns="http://www.w3.org/2000/svg" version="1.1">\n <metadata>\n </metadata>\n <defs>\n'
        '  <style type="text/css">*{stroke-linejoin: round; stroke-linecap: butt}</style>\n </defs>\n'
        f' <g id="figure_1">\n  <g id="patch_1">\n   <path d="{ground}" style="fill: #ffffff"/>\n  </g>\n'
        f'  <g id="axes_1">\n   <g id="patch_2">\n    <path d="{ground}" style="fill: #ffffff; stroke: '
        'none"/>\n   </g>\n'
        + "\n".join(rows)
        + f'\n   <g id="text_1">{definitions}{uses}</g>\n  </g>\n </g>\n <defs>\n  <clipPath id="p0a1b2c3d">\n'
        f'   <rect x="0" y="0" width="{width:.6f}" height="{height:.6f}"/>\n  </clipPath>\n </defs>\n</svg>\n'
    )
    return Export(text, PT, 25.4 / 72)


def cairo(page: Page, look: Look, rng: Rng) -> Export:
    """Cairo's surface: colours in percent, a white rectangle, a matrix at every path."""
    pen = pen_for(page, 10 * PT, digits=4)
    width, height = f"{PT * page.width:.4f}", f"{PT * page.height:.4f}"
    rows = []
    for stroke in page.strokes:
        red, green, blue = (f"{100 * value / 255:.6g}%" for value in look.colour(stroke.kind))
        dash = look.dash(stroke.kind)
        dashes = f"stroke-dasharray:{','.join(f'{10 * PT * part:.4g}' for part in dash)};" if dash else ""
        rows.append(
            f'<path style="fill:none;stroke-width:5;stroke-linecap:butt;stroke-linejoin:miter;'
            f'stroke:rgb({red},{green},{blue});stroke-opacity:1;{dashes}stroke-miterlimit:10;" '
            f'd="{pen.data(stroke).replace(",", " ")}" transform="matrix(0.1,0,0,0.1,0,0)"/>'
        )
    text = (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<svg {SVG} width="{width}pt" height="{height}pt" '
        f'viewBox="0 0 {width} {height}" version="1.1">\n<g id="surface1">\n<rect x="0" y="0" width="{width}" '
        f'height="{height}" style="fill:rgb(100%,100%,100%);fill-opacity:1;stroke:none;"/>\n'
        + "\n".join(rows)
        + "\n</g>\n</svg>\n"
    )
    return Export(text, PT, 25.4 / 72)


def p5(page: Page, look: Look, rng: Rng) -> Export:
    pen = pen_for(page, 3.0, digits=6)
    width, height = pen.number(3 * page.width), pen.number(3 * page.height)
    rows = []
    for stroke in page.strokes:
        dash = " ".join(f"{3 * part:.3g}" for part in look.dash(stroke.kind))
        rows.append(
            f'<path fill="none" stroke="{look.rgb(stroke.kind)}" paint-order="fill stroke markers" '
            f'd=" {pen.data(stroke).replace(",", " ")}" stroke-miterlimit="10" stroke-width="1" '
            'stroke-linecap="round" '
            f'stroke-dasharray="{dash}"/>'
        )
    text = (
        f'<svg version="1.1" {SVG} width="{width}" height="{height}" viewBox="0 0 {width} {height}"><defs/>'
        f'<g transform="scale(1,1)"><rect fill="rgb(255,255,255)" stroke="none" x="0" y="0" width="{width}" '
        f'height="{height}"/>' + "".join(rows) + "</g></svg>\n"
    )
    return Export(text, 3.0, None)


def processing(page: Page, look: Look, rng: Rng) -> Export:
    """Processing by way of Batik: a pile of inherited properties, a group around every line."""
    pen = pen_for(page, 3.0, digits=4)
    hollow = 'style="fill:none;"'
    names = {(255, 0, 0): "red", (0, 0, 255): "blue", (0, 0, 0): "black"}
    rows = []
    for stroke in page.strokes:
        colour = names.get(look.colour(stroke.kind), look.rgb(stroke.kind))
        dash = look.dash(stroke.kind)
        dashes = f' stroke-dasharray="{",".join(f"{3 * part:.3g}" for part in dash)}"' if dash else ""
        rows.append(
            f'<g style="fill-opacity:0; stroke:{colour}; stroke-opacity:1.0;"{dashes}\n    >'
            f"{pen.element(stroke, hollow)}</g\n  >"
        )
    width, height = pen.number(3 * page.width), pen.number(3 * page.height)
    text = (
        "<?xml version=\"1.0\"?>\n<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.0//EN'\n          "
        "'http://www.w3.org/TR/2001/REC-SVG-20010904/DTD/svg10.dtd'>\n"
        '<svg xmlns:xlink="http://www.w3.org/1999/xlink" style="fill-opacity:1; color-rendering:auto; '
        "color-interpolation:auto; text-rendering:auto; stroke:black; stroke-linecap:square; stroke-miterlimit:10; "
        "shape-rendering:auto; stroke-opacity:1; fill:black; stroke-dasharray:none; font-weight:normal; "
        "stroke-width:1; "
        "font-family:'Dialog'; font-style:normal; stroke-linejoin:miter; font-size:12px; stroke-dashoffset:0; "
        f'image-rendering:auto;" width="{width}" height="{height}" xmlns="http://www.w3.org/2000/svg"\n'
        '><!--Generated by the Batik Graphics2D SVG Generator--><defs id="genericDefs"\n  /><g\n  ><g '
        'style="fill:white; '
        f'stroke:white;"\n    ><rect x="0" width="{width}" height="{height}" y="0" style="stroke:none;"\n    '
        "/></g\n  >" + "".join(rows) + "</g\n></svg\n>\n"
    )
    return Export(text, 3.0, None)


def svgwrite(page: Page, look: Look, rng: Rng) -> Export:
    """Python: percentages for the size, no viewBox, lengths in mm at every line; paths cannot have them."""
    millimetre = PX
    pen, measured = pen_for(page, millimetre, digits=6), pen_for(page, 1.0, digits=5)
    rows = []
    for stroke in page.strokes:
        red, green, blue = (f"{100 * value / 255:.4g}%" for value in look.colour(stroke.kind))
        dash = look.dash(stroke.kind)
        dashes = f' stroke-dasharray="{",".join(f"{PX * part:.4g}" for part in dash)}"' if dash else ""
        own = f'stroke="rgb({red},{green},{blue})" stroke-width="0.2mm"{dashes}'
        if stroke.curve.straight and len(stroke.curve.beziers) == 1:
            (x1, y1), (x2, y2) = measured.at(stroke.curve.points())
            rows.append(f'<line {own} x1="{x1:.5f}mm" x2="{x2:.5f}mm" y1="{y1:.5f}mm" y2="{y2:.5f}mm" />')
        elif stroke.curve.closed and stroke.curve.arc is not None and stroke.smooth:
            x, y = measured.at(np.array(stroke.curve.arc[:2]))
            rows.append(
                f'<circle cx="{x:.5f}mm" cy="{y:.5f}mm" fill="none" r="{stroke.curve.arc[2]:.5f}mm" {own} />'
            )
        else:
            rows.append(pen.element(stroke, f'fill="none" {own}'))
    # Where the page is the sheet, it has a size.
    paper = rng.random() < 0.5 or not page.of("border")
    size = (
        f'height="{page.height:.4f}mm" version="1.1" width="{page.width:.4f}mm"'
        if paper
        else 'height="100%" version="1.1" width="100%"'
    )
    text = (
        f'<?xml version="1.0" encoding="utf-8" ?>\n<svg baseProfile="full" {size} '
        f'xmlns="http://www.w3.org/2000/svg" xmlns:ev="http://www.w3.org/2001/xml-events" '
        'xmlns:xlink="http://www.w3.org/1999/xlink"><defs />' + "".join(rows) + "</svg>"
    )
    return Export(text, PX, 25.4 / 96)


def potrace(page: Page, look: Look, rng: Rng) -> Export:
    """A scan that was traced: every line is the outline of its ink, filled. No program can fold that."""
    pen = Pen(10.0, flipped=False, digits=0)
    rows = []
    for stroke in page.strokes:
        points = stroke.curve.points()
        way = np.gradient(points, axis=0)
        left = np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None] * 0.25
        ring = np.vstack([points + left, (points - left)[::-1]])
        rows.append(pen.data(Stroke(stroke.kind, lines(*ring, closed=True))).replace(",", " "))
    text = (
        '<?xml version="1.0" standalone="no"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 20010904//EN"\n '
        '"http://www.w3.org/TR/2001/REC-SVG-20010904/DTD/svg10.dtd">\n<svg version="1.0" '
        f'xmlns="http://www.w3.org/2000/svg"\n width="{page.width:.6f}pt" height="{page.height:.6f}pt" '
        'viewBox="0 0 '
        f'{page.width:.6f} {page.height:.6f}"\n preserveAspectRatio="xMidYMid meet">\n<metadata>\nCreated by '
        "potrace 1.16, "
        f'written by Peter Selinger 2001-2019\n</metadata>\n<g transform="translate(0.000000,{page.height:.6f}) '
        'scale(0.100000,-0.100000)"\nfill="#000000" stroke="none">\n'
        + "\n".join(f'<path d="{row}"/>' for row in rows)
        + "\n</g>\n</svg>\n"
    )
    return Export(text, 1.0, 25.4 / 72, refused="filled")
