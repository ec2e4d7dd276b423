"""Drawings as the programs write them that people draw with. No file is copied."""

from __future__ import annotations

from xml.sax.saxutils import escape

import shapely

from tests.solver.pattern.strangers_designs import Rng
from tests.solver.pattern.strangers_habits import Page
from tests.solver.pattern.strangers_pen import Export, Look, groups, pen_for

XML = '<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n'
#: Units of the drawing in a millimetre: Illustrator's, CSS's, old Inkscape's, Affinity's.
PT, PX, PX_90, PX_300 = 72 / 25.4, 96 / 25.4, 90 / 25.4, 300 / 25.4


def _dashes(look: Look, kind: str, scale: float) -> str:
    return ",".join(f"{scale * length:.3g}" for length in look.dash(kind)) or "none"


# --- Inkscape -------------------------------------------------------------------------------------------

_INKSCAPE = (
    'xmlns:dc="http://purl.org/dc/elements/1.1/" xmlns:cc="http://creativecommons.org/ns#"\n'
    '   xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:svg="http://www.w3.org/2000/svg"\n'
    '   xmlns="http://www.w3.org/2000/svg"\n'
    '   xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"\n'
    '   xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)
_METADATA = (
    '  <metadata id="metadata5"><rdf:RDF><cc:Work rdf:about=""><dc:format>image/svg+xml</dc:format>'
    '<dc:type rdf:resource="http://purl.org/dc/dcmitype/StillImage" /><dc:title /></cc:Work></rdf:RDF></metadata>\n'
)


def inkscape_old(page: Page, look: Look, rng: Rng) -> Export:
    """0.91: 90 px to the inch, one layer moved down by the height of the page, relative path data."""
    pen = pen_for(page, PX_90, y=-137.5, digits=5)
    rows = []
    for number, (name, strokes) in enumerate(groups(page, look)):
        label = name or f"Layer {number + 1}"
        rows.append(
            f'  <g\n     inkscape:label="{label}"\n     inkscape:groupmode="layer"\n     id="layer{number + 1}"\n'
            '     transform="translate(0,137.5)">'
        )
        for k, stroke in enumerate(strokes):
            style = (
                f"fill:none;fill-rule:evenodd;stroke:{look.hex(stroke.kind)};stroke-width:1px;stroke-linecap:butt;"
                "stroke-linejoin:miter;stroke-opacity:1;stroke-miterlimit:4;"
                f"stroke-dasharray:{_dashes(look, stroke.kind, PX_90)};stroke-dashoffset:0"
            )
            rows.append(
                f'    <path\n       style="{style}"\n       d="{pen.data(stroke, relative=True)}"\n'
                f'       id="path{3000 + 100 * number + k}"\n       inkscape:connector-curvature="0"\n'
                '       sodipodi:nodetypes="cc" />'
            )
        rows.append("  </g>")
    width, height = pen.number(PX_90 * page.width), pen.number(PX_90 * page.height)
    text = (
        f"{XML}<!-- Created with Inkscape (http://www.inkscape.org/) -->\n\n<svg\n   {_INKSCAPE}\n"
        f'   width="{page.width:.4f}mm"\n   height="{page.height:.4f}mm"\n   viewBox="0 0 {width} {height}"\n'
        '   id="svg2"\n   version="1.1"\n   inkscape:version="0.91 r13725"\n   sodipodi:docname="pattern.svg">\n'
        '  <defs\n     id="defs4" />\n  <sodipodi:namedview\n     id="base"\n     pagecolor="#ffffff"\n'
        '     bordercolor="#666666"\n     borderopacity="1.0"\n     inkscape:pageopacity="0.0"\n'
        '     inkscape:document-units="px"\n     showgrid="false" />\n'
        f"{_METADATA}" + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, PX_90, 25.4 / 90)


def inkscape_new(page: Page, look: Look, rng: Rng) -> Export:
    """1.x: a viewBox in mm, groups moved inside of layers, circles as such, text beside."""
    dx, dy = (round(float(v), 4) for v in rng.uniform(-40, 40, 2))
    pen = pen_for(page, 1.0, -dx, -dy, digits=6)
    rows = []
    for number, (name, strokes) in enumerate(groups(page, look)):
        label = name or f"Layer {number + 1}"
        rows.append(
            f'  <g\n     inkscape:label="{label}"\n     inkscape:groupmode="layer"\n     id="layer{number + 1}"\n'
            f'     transform="translate({dx},{dy})"><g id="g{number + 900}" transform="matrix(1,0,0,1,0,0)">'
        )
        for k, stroke in enumerate(strokes):
            style = (
                f"fill:none;fill-opacity:1;stroke:{look.hex(stroke.kind)};stroke-width:0.264583;"
                "stroke-linecap:round;stroke-linejoin:round;stroke-miterlimit:4;"
                f"stroke-dasharray:{_dashes(look, stroke.kind, 1.0)};stroke-opacity:1;paint-order:normal"
            )
            own = f'style="{style}" id="path{number}-{k}"'
            round_ = stroke.curve.closed and stroke.curve.arc is not None
            rows.append("    " + pen.element(stroke, own, paths=not round_))
        rows.append("  </g></g>")
    for k, (x, y, words) in enumerate(page.texts):
        rows.append(
            f'  <text xml:space="preserve" style="font-size:3.175px;fill:#000000;stroke-width:0.264583" '
            f'x="{x:.3f}" y="{page.height - y:.3f}" id="text{k}"><tspan sodipodi:role="line" '
            f'id="tspan{k}">{escape(words)}</tspan></text>'
        )
    size = f'width="{page.width:.5f}mm"\n   height="{page.height:.5f}mm"'
    text = (
        f"{XML}<!-- Created with Inkscape (http://www.inkscape.org/) -->\n<svg\n   {size}\n"
        f'   viewBox="0 0 {page.width:.5f} {page.height:.5f}"\n   version="1.1"\n   id="svg5"\n'
        f'   inkscape:version="1.3.2 (091e20e, 2023-11-25, custom)"\n   {_INKSCAPE}>\n'
        '  <sodipodi:namedview id="namedview7" pagecolor="#ffffff" bordercolor="#000000" '
        'inkscape:document-units="mm">\n    <sodipodi:guide position="10,20" orientation="0,-1" id="guide1" '
        'inkscape:locked="false" />\n    <inkscape:page x="0" y="0" id="page2" />\n  </sodipodi:namedview>\n'
        '  <defs id="defs2" />\n' + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, 1.0, 1.0)


# --- Adobe Illustrator ----------------------------------------------------------------------------------


def _styles(page: Page, look: Look, scale: float) -> dict[str, str]:
    """Declarations of each kind that is drawn, as Illustrator writes them."""
    made = {}
    for stroke in page.strokes:
        dash = look.dash(stroke.kind)
        dashed = f"stroke-dasharray:{','.join(f'{scale * part:.4g}' for part in dash)};" if dash else ""
        made[stroke.kind] = f"fill:none;stroke:{look.hex(stroke.kind).upper()};stroke-miterlimit:10;{dashed}"
    return made


def illustrator(page: Page, look: Look, rng: Rng) -> Export:
    """Save as SVG: .st0 classes, ids with _x20_, the artboard, no physical size."""
    pen = pen_for(page, PT, digits=1 if rng.random() < 0.3 else 3)
    styles = _styles(page, look, PT)
    rules = "".join(f"\t.st{k}{{{style}}}\n" for k, style in enumerate(styles.values()))
    names = {kind: f"st{k}" for k, kind in enumerate(styles)}
    rows = [f'<rect x="0" class="st{len(styles)}" width="{PT * page.width:.2f}" height="{PT * page.height:.2f}"/>']
    for name, strokes in groups(page, look):
        rows.append(f'<g id="{name.replace(" ", "_x20_")}">' if name else "<g>")
        rows += ["\t" + pen.element(stroke, f'class="{names[stroke.kind]}"') for stroke in strokes]
        rows.append("</g>")
    for x, y, words in page.texts:
        rows.append(
            f'<text transform="matrix(1 0 0 1 {PT * x:.4f} {PT * (page.height - y):.4f})" '
            f"style=\"font-family:'MyriadPro-Regular'; font-size:9px;\">{escape(words)}</text>"
        )
    box = f"0 0 {PT * page.width:.2f} {PT * page.height:.2f}"
    text = (
        '<?xml version="1.0" encoding="utf-8"?>\n<!-- Generator: Adobe Illustrator 27.0.0, SVG Export Plug-In . '
        'SVG Version: 6.00 Build 0)  -->\n<svg version="1.1" id="Layer_1" xmlns="http://www.w3.org/2000/svg" '
        f'xmlns:xlink="http://www.w3.org/1999/xlink" x="0px" y="0px"\n\t viewBox="{box}" '
        f'style="enable-background:new {box};" xml:space="preserve">\n<style type="text/css">\n{rules}'
        f"\t.st{len(styles)}{{fill:#FFFFFF;}}\n</style>\n" + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, PT, None)


def illustrator_export(page: Page, look: Look, rng: Rng) -> Export:
    """Export as: .cls-1 classes, grouped selectors, data-name."""
    pen = pen_for(page, PT, digits=2)
    styles = _styles(page, look, PT)
    names = {kind: f"cls-{k + 1}" for k, kind in enumerate(styles)}
    rules = [
        f"{', '.join('.' + name for name in names.values())} "
        f"{{\n        fill: none;\n        stroke-width: .5px;\n      }}"
    ]
    for kind, name in names.items():
        own = styles[kind].removeprefix("fill:none;").replace(":", ": ").replace(";", ";\n        ")
        rules.append(f".{name} {{\n        {own.rstrip()}\n      }}")
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'  <g id="{name.replace(" ", "_")}" data-name="{name}">' if name else "  <g>")
        rows += ["    " + pen.element(stroke, f'class="{names[stroke.kind]}"') for stroke in strokes]
        rows.append("  </g>")
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<svg id="Layer_1" data-name="Layer 1" '
        f'xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {PT * page.width:.2f} {PT * page.height:.2f}">\n  '
        "<defs>\n"
        "    <style>\n      "
        + "\n\n      ".join(rules)
        + "\n    </style>\n  </defs>\n"
        + "\n".join(rows)
        + "\n</svg>\n"
    )
    return Export(text, PT, None)


def illustrator_old(page: Page, look: Look, rng: Rng) -> Export:
    """Illustrator 10 to CS: entities for namespaces and styles."""
    pen = pen_for(page, PT)
    styles = _styles(page, look, PT)
    own = "".join(f'\t<!ENTITY st{k} "{style}">\n' for k, style in enumerate(styles.values()))
    names = {kind: f"&st{k};" for k, kind in enumerate(styles)}
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'<g id="{name.replace(" ", "_x0020_") or "Layer_1"}" i:layer="yes" i:dimmedPercent="50">')
        rows += ["\t" + pen.element(stroke, f'style="{names[stroke.kind]}"') for stroke in strokes]
        rows.append("</g>")
    size = f'width="{PT * page.width:.3f}" height="{PT * page.height:.3f}"'
    text = (
        '<?xml version="1.0" encoding="iso-8859-1"?>\n<!-- Generator: Adobe Illustrator 11.0, SVG Export Plug-In  '
        '-->\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.0//EN" '
        '"http://www.w3.org/TR/2001/REC-SVG-20010904/DTD/svg10.dtd" [\n'
        '\t<!ENTITY ns_extend "http://ns.adobe.com/Extensibility/1.0/">\n'
        '\t<!ENTITY ns_ai "http://ns.adobe.com/AdobeIllustrator/10.0/">\n'
        '\t<!ENTITY ns_svg "http://www.w3.org/2000/svg">\n\t<!ENTITY ns_xlink "http://www.w3.org/1999/xlink">\n'
        f'{own}]>\n<svg  xmlns:x="&ns_extend;" xmlns:i="&ns_ai;" i:viewOrigin="0 0" i:rulerOrigin="0 0" '
        f'xmlns="&ns_svg;" xmlns:xlink="&ns_xlink;" {size}\n\t viewBox="0 0 {PT * page.width:.3f} '
        f'{PT * page.height:.3f}" overflow="visible" xml:space="preserve">\n' + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, PT, None)


# --- Figma, Affinity, CorelDRAW -------------------------------------------------------------------------


def figma(page: Page, look: Look, rng: Rng) -> Export:
    """fill="none" on the root, a white frame, clipping, colours in display-p3 beside plain ones."""
    pen = pen_for(page, 4.0, digits=4)
    wide = rng.random() < 0.5
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'<g id="{name}">' if name else "<g>")
        for k, stroke in enumerate(strokes):
            paint = f'stroke="{look.hex(stroke.kind).upper()}"'
            if wide:
                red, green, blue = (f"{value / 255:.4f}" for value in look.colour(stroke.kind))
                other = f"color(display-p3 {red} {green} {blue})"
                paint += f' style="stroke:{look.hex(stroke.kind)};stroke:{other};stroke-opacity:1;"'
            dash = look.dash(stroke.kind)
            paint += f' stroke-dasharray="{" ".join(f"{4 * part:.3g}" for part in dash)}"' if dash else ""
            paint += f' id="Vector {k + 1}"' if name else ""
            rows.append(pen.element(stroke, paint, paths=not (stroke.curve.closed and stroke.curve.arc)))
        rows.append("</g>")
    width, height = pen.number(4 * page.width), pen.number(4 * page.height)
    text = (
        f'<svg width="{width}" height="{height}" viewBox="0 0 {width} {height}" fill="none" '
        'xmlns="http://www.w3.org/2000/svg">\n<g clip-path="url(#clip0_1_2)">\n'
        f'<rect width="{width}" height="{height}" fill="white" style="fill:white;fill-opacity:1;"/>\n'
        + "\n".join(rows)
        + f'\n</g>\n<defs>\n<clipPath id="clip0_1_2">\n<rect width="{width}" height="{height}" fill="white" '
        'style="fill:white;fill-opacity:1;"/>\n</clipPath>\n</defs>\n</svg>\n'
    )
    return Export(text, 4.0, None)


def affinity(page: Page, look: Look, rng: Rng) -> Export:
    """width and height of 100 %, 300 dots to the inch, an artboard moved by a matrix, serif:id."""
    x, y = (float(v) for v in rng.integers(100, 3000, 2))
    pen = pen_for(page, PX_300, x, y)
    board = f'<rect x="{x:g}" y="{y:g}" width="{PX_300 * page.width:.3f}" height="{PX_300 * page.height:.3f}"'
    rows = []
    for name, strokes in groups(page, look):
        slug = name.replace(" ", "-")
        rows.append(f'<g id="{slug}" serif:id="{name}">' if name else "<g>")
        for stroke in strokes:
            dash = look.dash(stroke.kind)
            dashed = f"stroke-dasharray:{','.join(f'{PX_300 * part:.4g}' for part in dash)};" if dash else ""
            style = f"fill:none;fill-rule:nonzero;stroke:{look.rgb(stroke.kind)};stroke-width:4.17px;{dashed}"
            rows.append(
                pen.element(stroke, f'style="{style}"', paths=not (stroke.curve.closed and stroke.curve.arc))
            )
        rows.append("</g>")
    text = (
        '<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n<svg width="100%" height="100%" viewBox="0 0 '
        f'{PX_300 * page.width:.0f} {PX_300 * page.height:.0f}" version="1.1" xmlns="http://www.w3.org/2000/svg" '
        'xmlns:xlink="http://www.w3.org/1999/xlink" xml:space="preserve" xmlns:serif="http://www.serif.com/" '
        'style="fill-rule:evenodd;clip-rule:evenodd;stroke-linecap:round;stroke-linejoin:round;'
        f'stroke-miterlimit:1.5;">\n    <g transform="matrix(1,0,0,1,{-x:g},{-y:g})">\n'
        f'        <g id="Artboard1" serif:id="Artboard 1">\n{board} style="fill:none;"/>\n'
        + "\n".join(rows)
        + "\n        </g>\n    </g>\n</svg>\n"
    )
    return Export(text, PX_300, None)


def corel(page: Page, look: Look, rng: Rng) -> Export:
    """fil0 and str0 classes in CDATA, thousandths of an inch, hairlines, layers as _x0020_."""
    scale = 1000 / 25.4
    pen = pen_for(page, scale, digits=2)
    kinds = list(dict.fromkeys(stroke.kind for stroke in page.strokes))
    rules = []
    for k, kind in enumerate(kinds):
        dash = look.dash(kind)
        dashed = f";stroke-dasharray:{' '.join(f'{scale * part:.4g}' for part in dash)}" if dash else ""
        rules.append(
            f"    .str{k} {{stroke:{look.hex(kind).upper()};stroke-width:3{dashed};stroke-miterlimit:22.9256}}"
        )
    rows = []
    for number, (name, strokes) in enumerate(groups(page, look), 1):
        label = (name or f"Layer {number}").replace(" ", "_x0020_")
        rows.append(f' <g id="{label}">\n  <metadata id="CorelCorpID_{number}Corel-Layer"/>')
        rows += [
            "  "
            + pen.element(stroke, f'class="fil0 str{kinds.index(stroke.kind)}"', paths=not stroke.curve.straight)
            for stroke in strokes
        ]
        rows.append(" </g>")
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n<!-- Creator: CorelDRAW 2019 (64-Bit) -->\n'
        '<svg xmlns="http://www.w3.org/2000/svg" xml:space="preserve" '
        f'width="{page.width / 25.4:.4f}in" height="{page.height / 25.4:.4f}in" version="1.1" '
        'style="shape-rendering:geometricPrecision; text-rendering:geometricPrecision; '
        "image-rendering:optimizeQuality; "
        f'fill-rule:evenodd; clip-rule:evenodd"\nviewBox="0 0 {scale * page.width:.2f} '
        f'{scale * page.height:.2f}"\n '
        'xmlns:xlink="http://www.w3.org/1999/xlink"\n xmlns:xodm="http://www.corel.com/coreldraw/odm/2003">\n '
        "<defs>\n"
        '  <style type="text/css">\n   <![CDATA[\n'
        + "\n".join(rules)
        + "\n    .fil0 {fill:none}\n   ]]>\n  </style>\n"
        " </defs>\n" + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, scale, 25.4 / 1000)


# --- smaller and online ones ----------------------------------------------------------------------------


def gravit(page: Page, look: Look, rng: Rng) -> Export:
    pen = pen_for(page, PT)
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'<g id="{name}">' if name else "<g>")
        for stroke in strokes:
            dash = look.dash(stroke.kind)
            dashed = f' stroke-dasharray="{" ".join(f"{PT * part:.3g}" for part in dash)}"' if dash else ""
            own = (
                f'd=" {pen.data(stroke)} " fill="none" vector-effect="non-scaling-stroke" stroke-width="1" '
                f'stroke="{look.rgb(stroke.kind)}" stroke-linejoin="miter" stroke-linecap="square" '
                f'stroke-miterlimit="3"{dashed}'
            )
            rows.append(f"<path {own}/>")
        rows.append("</g>")
    width, height = f"{PT * page.width:.3f}", f"{PT * page.height:.3f}"
    text = (
        '<?xml version="1.0" standalone="no"?>\n<!-- Generator: Gravit.io -->\n'
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        'style="isolation:isolate" '
        f'viewBox="0 0 {width} {height}" width="{width}pt" height="{height}pt">'
        f'<defs><clipPath id="_clipPath_a1B2"><rect width="{width}" height="{height}"/></clipPath></defs>'
        '<g clip-path="url(#_clipPath_a1B2)">' + "".join(rows) + "</g></svg>\n"
    )
    return Export(text, PT, 25.4 / 72)


def boxy(page: Page, look: Look, rng: Rng) -> Export:
    pen = pen_for(page, 5.0)
    rows = []
    for name, strokes in groups(page, look):
        rows.append(f'  <g id="{name}">' if name else "  <g>")
        for stroke in strokes:
            dash = look.dash(stroke.kind)
            dashed = f" stroke-dasharray: {', '.join(f'{5 * part:.3g}' for part in dash)};" if dash else ""
            red, green, blue = look.colour(stroke.kind)
            style = f'style="fill: none; stroke: rgb({red}, {green}, {blue});{dashed}"'
            if stroke.curve.closed and stroke.curve.arc is not None and stroke.smooth:
                x, y = pen.at(stroke.curve.arc[:2])
                r = pen.number(5 * stroke.curve.arc[2])
                rows.append(
                    f'    <ellipse {style} cx="{pen.number(x)}" cy="{pen.number(y)}" rx="{r}" ry="{r}" '
                    'transform="matrix(1, 0, 0, 1, 0, 0)"/>'
                )
            else:
                rows.append("    " + pen.element(stroke, style, paths=True))
        rows.append("  </g>")
    text = (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        f'<svg viewBox="0 0 {pen.number(5 * page.width)} {pen.number(5 * page.height)}" '
        'xmlns="http://www.w3.org/2000/svg" xmlns:bx="https://boxy-svg.com">\n  <defs>\n'
        '    <bx:grid x="0" y="0" width="50" height="50"/>\n  </defs>\n' + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, 5.0, None)


def libreoffice(page: Page, look: Look, rng: Rng) -> Export:
    """Hundredths of a millimetre, every object a group with a bounding box, outlines beside their own filling."""
    pen = pen_for(page, 100.0, digits=0)
    rows = []
    for k, stroke in enumerate(page.strokes):
        points = pen.at(stroke.curve.points())
        (x, y), (w, h) = points.min(axis=0), points.max(axis=0) - points.min(axis=0)
        data = pen.data(stroke)
        shape = "LineShape" if len(points) == 2 else "OpenBezierShape"
        filling = ""
        if stroke.kind == "border" and stroke.curve.closed:
            shape, filling = "CustomShape", f'<path fill="rgb(114,159,207)" stroke="none" d="{data}"/>'
        strokes = f'<path fill="none" stroke="{look.rgb(stroke.kind)}" d="{data}"/>'
        if dash := look.dash(stroke.kind):
            strokes = strokes.replace(
                "/>", f' stroke-dasharray="{",".join(f"{100 * part:.0f}" for part in dash)}"/>'
            )
        rows.append(
            f'<g class="com.sun.star.drawing.{shape}"><g id="id{k + 3}"><rect class="BoundingBox" stroke="none" '
            f'fill="none" x="{x:.0f}" y="{y:.0f}" width="{w + 1:.0f}" '
            f'height="{h + 1:.0f}"/>{filling}{strokes}</g></g>'
        )
    for k, (x, y, words) in enumerate(page.texts):
        rows.append(
            f'<g class="com.sun.star.drawing.TextShape"><g id="id{900 + k}"><rect class="BoundingBox" '
            'stroke="none" '
            f'fill="none" x="{100 * x:.0f}" y="{100 * (page.height - y):.0f}" width="2000" height="500"/>'
            '<text class="SVGTextShape"><tspan class="TextParagraph"><tspan class="TextPosition" '
            f'x="{100 * x:.0f}" '
            f'y="{100 * (page.height - y):.0f}"><tspan fill="rgb(0,0,0)" '
            f'stroke="none">{escape(words)}</tspan></tspan>'
            "</tspan></text></g></g>"
        )
    width, height = 100 * page.width, 100 * page.height
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" '
        '"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">\n'
        f'<svg version="1.2" width="{page.width:.2f}mm" height="{page.height:.2f}mm" viewBox="0 0 {width:.0f} '
        f'{height:.0f}" preserveAspectRatio="xMidYMid" fill-rule="evenodd" stroke-width="28.222" '
        'stroke-linejoin="round" xmlns="http://www.w3.org/2000/svg" '
        'xmlns:ooo="http://xml.openoffice.org/svg/export" '
        'xmlns:xlink="http://www.w3.org/1999/xlink" xml:space="preserve">\n <defs class="ClipPathGroup">\n'
        '  <clipPath id="presentation_clip_path" clipPathUnits="userSpaceOnUse">\n'
        f'   <rect x="0" y="0" width="{width:.0f}" height="{height:.0f}"/>\n  </clipPath>\n </defs>\n'
        ' <defs class="TextShapeIndex"><g ooo:slide="id1" ooo:id-list="id3 id4"/></defs>\n'
        ' <g class="SlideGroup"><g><g id="container-id1"><g id="id1" class="Slide" '
        'clip-path="url(#presentation_clip_path)"><g class="Page">\n'
        + "\n".join(rows)
        + "\n </g></g></g></g></g>\n</svg>\n"
    )
    return Export(text, 100.0, 0.01)


def word(page: Page, look: Look, rng: Rng) -> Export:
    """A drawing of an office program saved as a picture: everything clipped and moved, the sheet a filled shape."""
    left, top = (float(v) for v in rng.integers(100, 400, 2))
    pen = pen_for(page, PX, left, top, digits=3)
    rows = []
    for stroke in page.strokes:
        filled = stroke.kind == "border" and stroke.curve.closed
        dash = look.dash(stroke.kind)
        dashed = f' stroke-dasharray="{" ".join(f"{PX * part:.4g}" for part in dash)}"' if dash else ""
        rows.append(
            f'<path d="{pen.data(stroke)}" stroke="{look.hex(stroke.kind).upper()}" stroke-width="1.33333" '
            f'stroke-miterlimit="8"{dashed} fill="{"#F2F2F2" if filled else "none"}" fill-rule="evenodd"/>'
        )
    for x, y, words in page.texts:
        rows.append(
            f'<text font-family="Calibri,Calibri_MSFontService,sans-serif" font-weight="400" font-size="14" '
            f'transform="translate({left + PX * x:.3f} {top + PX * (page.height - y):.3f})">{escape(words)}</text>'
        )
    width, height = f"{PX * page.width:.0f}", f"{PX * page.height:.0f}"
    text = (
        f'<svg width="{width}" height="{height}" xmlns="http://www.w3.org/2000/svg" '
        'xmlns:xlink="http://www.w3.org/1999/xlink" xml:space="preserve" overflow="hidden"><defs><clipPath '
        'id="clip0">'
        f'<rect x="{left:g}" y="{top:g}" width="{width}" height="{height}"/></clipPath></defs>'
        f'<g clip-path="url(#clip0)" transform="translate({-left:g} {-top:g})">'
        f'<rect x="{left:g}" y="{top:g}" width="{width}" height="{height}" fill="#FFFFFF"/>'
        + "".join(rows)
        + "</g></svg>\n"
    )
    return Export(text, PX, None)


# --- cutters --------------------------------------------------------------------------------------------


def cricut(page: Page, look: Look, rng: Rng) -> Export:
    """Design Space: what is cut is a filled shape without a line, what is scored is a line."""
    pen = pen_for(page, PT, digits=2)
    rows = []
    for sheet in page.of("border"):
        inside = shapely.Polygon(sheet.curve.points())
        rings = [sheet, *(hole for hole in page.of("hole") if inside.covers(shapely.Polygon(hole.curve.points())))]
        data = " ".join(pen.data(ring) for ring in rings)
        rows.append(f'<path id="Cut" fill="#D9D9D9" fill-rule="evenodd" stroke="none" d="{data}"/>')
    for name, kinds in (("Score", ("M", "V", "U")), ("Cut lines", ("cut",))):
        strokes = page.of(*kinds)
        if strokes:
            rows.append(f'<g id="{name}" fill="none" stroke-width="1">')
            rows += ["  " + pen.element(stroke, f'stroke="{look.hex(stroke.kind)}"') for stroke in strokes]
            rows.append("</g>")
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<svg version="1.1" xmlns="http://www.w3.org/2000/svg" x="0px" '
        'y="0px" '
        f'width="{PT * page.width:.2f}px" height="{PT * page.height:.2f}px" viewBox="0 0 {PT * page.width:.2f} '
        f'{PT * page.height:.2f}" xml:space="preserve">\n' + "\n".join(rows) + "\n</svg>\n"
    )
    return Export(text, PT, None)


def silhouette(page: Page, look: Look, rng: Rng) -> Export:
    """Silhouette Studio: one layer, thin lines, inches in the size and points in the viewBox."""
    pen = pen_for(page, PT, digits=4)
    rows = [
        f'    <path d="{pen.data(stroke)}" fill="none" stroke="{look.hex(stroke.kind)}" stroke-width="0.1" '
        'stroke-linecap="butt" stroke-linejoin="miter"/>'
        for stroke in page.strokes
    ]
    text = (
        '<?xml version="1.0" encoding="utf-8"?>\n<svg version="1.1" xmlns="http://www.w3.org/2000/svg" '
        f'width="{page.width / 25.4:.5f}in" height="{page.height / 25.4:.5f}in" '
        f'viewBox="0 0 {PT * page.width:.4f} {PT * page.height:.4f}">\n  <g id="Layer 1">\n'
        + "\n".join(rows)
        + "\n  </g>\n</svg>\n"
    )
    return Export(text, PT, 25.4 / 72)
