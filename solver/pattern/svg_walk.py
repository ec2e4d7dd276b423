"""From the tree of an SVG file to the outlines it draws: styles, transforms, <use>, visibility."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray
from ..errors import PatternError, ReadError
from .meaning import MAX_WORDS
from .safe_xml import MAX_DEPTH
from .segments import MAX_COORDINATE, MAX_POINTS, Subpath
from .svg_bounds import exact_box
from .svg_css import MAX_PROPERTY, MEASURES, Stylesheet, css_path
from .svg_shapes import SHAPES, shape_subpaths
from .svg_style import Computed, Styler
from .svg_transforms import (
    about,
    css_origin,
    css_rotate,
    css_scale,
    css_transform,
    css_translate,
    parse_transform,
)
from .svg_values import MM_PER_PIXEL, UNKNOWN_COLOUR, Colour, Length, SvgValueError, parse_length, parse_numbers
from .svg_xml import Node

#: Elements drawn, those repeated by <use> counted each time.
MAX_ELEMENTS = 50_000
#: What a browser assumes of an image without any size (CSS 2.1, section 10.3.2).
_DEFAULT_VIEWPORT = (300.0, 150.0)

_CONTAINERS = frozenset({"g", "a", "switch", "svg"})
#: Drawn only when something refers to them, or never.
_SILENT = frozenset(
    {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "linearGradient", "radialGradient", "filter"}
    | {"style", "title", "desc", "metadata", "script", "view", "font"}
    | {"animate", "animateTransform", "animateMotion", "set"}
)
#: Attributes in which programs say what a line is. They make a line of a shape that nothing else gives a look.
DATA_ATTRIBUTES = (
    "data-assignment",
    "data-type",
    "data-layer",
    "data-role",
    "data-kind",
    "data-fold",
    "data-linetype",
)


@dataclass(frozen=True, eq=False, slots=True)
class Drawn:
    """One drawn shape.

    element   for messages, as ``<path> 3 (id 'a')``
    identity  its id, or empty
    subpaths  its outlines, in the drawing's units, y up
    stroke    colour, None when the outline is not stroked
    filled    whether its inside is painted
    opacity   of the stroke, all factors multiplied
    dashes    dash lengths, empty for a solid line
    words     (kind, text) of all that says in words what it is, for ``meaning.Evidence``: its own first, then those
              of its groups from the inside out; of each element data, then classes, then id and labels
    """

    element: str
    identity: str
    subpaths: tuple[Subpath, ...]
    stroke: Colour | None
    filled: bool
    opacity: float
    dashes: tuple[float, ...]
    words: tuple[tuple[str, str], ...]


@dataclass(frozen=True, eq=False)
class Drawing:
    """All that a file draws.

    shapes   in the order they are drawn
    unit_mm  millimetres in one unit, None when the file does not say it
    notes    what was left out on the way, and what was decided
    page     (x0, y0, x1, y1) of what the root shows, in the drawing's units, y up: its viewBox, else its width and
             height, else None
    text     how many <text> elements were left out
    """

    shapes: tuple[Drawn, ...]
    unit_mm: float | None
    notes: tuple[str, ...]
    page: tuple[float, float, float, float] | None = None
    text: int = 0


#: Of coordinates that nothing has moved: told by what it is, so that nothing is computed for it.
_IDENTITY: FloatArray = np.eye(3)
#: Properties that move an element.
_MOVING = frozenset({"transform", "translate", "rotate", "scale"})


@dataclass(frozen=True, eq=False, slots=True)
class _State:
    """What an element hands down to its children."""

    matrix: FloatArray
    look: Computed
    opacity: float
    width: float  # of the nearest viewport, for percentages
    height: float
    words: tuple[tuple[str, str], ...] = ()
    depth: int = 0
    used: tuple[Node, ...] = field(default=())

    def moved(self, matrix: FloatArray) -> _State:
        """Inside of a transform. Raises SvgValueError when it is not finite."""
        return replace(self, matrix=_joined(self.matrix, matrix))


def read_drawing(root: Node) -> Drawing:
    """Walk the tree. Raises ReadError and PatternError."""
    return _Walk(root).drawing()


class _Walk:
    """One pass over one file. Not reusable."""

    def __init__(self, root: Node) -> None:
        self._root = root
        self._sheet = Stylesheet(root)
        self._styler = Styler()
        self._by_id: dict[str, Node] = {}
        for node in root.walk():
            if node.tag:
                self._by_id.setdefault(node.attributes.get("id", ""), node)
        self._by_id.pop("", None)
        self._shapes: list[Drawn] = []
        self._outlines: dict[Node, list[Subpath]] = {}
        self._left_out: Counter[str] = Counter()
        self._notes: list[str] = []
        self._elements = 0
        self._segments = 0
        self._hairlines = 0
        self._filled_hairlines = 0
        self._paper_units = False  # whether any length was given in units of paper

    def drawing(self) -> Drawing:
        root = self._root
        look = self._look(root, self._styler.initial)
        viewport = self._viewport(_measured(root, look))
        matrix = _IDENTITY if viewport.stretch == 1.0 else np.diag([1.0, viewport.stretch, 1.0])
        state = _State(matrix, self._styler.initial, 1.0, viewport.width, viewport.height)
        self._element_inside(root, state, self._children, named=False)
        unit = viewport.unit_mm
        if unit is None and self._paper_units and viewport.pixels_per_unit is not None:
            # The shapes themselves are measured in paper units, which fixes what a pixel is.
            unit = viewport.pixels_per_unit * MM_PER_PIXEL
        shapes = self._shapes
        if shapes:
            middle = viewport.middle
            if middle is None:
                points = np.vstack([s.hull() for shape in shapes for s in shape.subpaths])
                middle = float(points[:, 1].min() + points[:, 1].max())
            flip = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, middle], [0.0, 0.0, 1.0]])
            # One by one, so that the shapes are in memory once.
            for k, shape in enumerate(shapes):
                shapes[k] = replace(shape, subpaths=tuple(p.transformed(flip) for p in shape.subpaths))
        if viewport.stretch != 1.0:
            self._notes.append(
                f"the drawing is shown stretched by {viewport.stretch:.6g} in y, and is read as it is shown"
            )
        self._notes += [_hairlines(self._hairlines, filled=False)] if self._hairlines else []
        self._notes += [_hairlines(self._filled_hairlines, filled=True)] if self._filled_hairlines else []
        self._notes += [f"{count} {what}" for what, count in self._left_out.items()]
        if self._sheet.skipped:
            self._notes.append(f"style rules that are left out: {', '.join(self._sheet.skipped[:5])}")
        if ignored := list(self._sheet.ignored)[:5]:
            self._notes.append(f"declarations that are not understood, and passed over: {'; '.join(ignored)}")
        return Drawing(tuple(shapes), unit, tuple(self._notes), viewport.page, self._left_out[_left_out("text")])

    # ---- viewports

    def _viewport(self, attributes: Mapping[str, str]) -> _Viewport:
        width, height = (self._root_length(name, attributes) for name in ("width", "height"))
        box = self._view_box(self._root)
        sizes = [length for length in (width, height) if length is not None]
        if box is None:
            return _Viewport(
                width.pixels if width else _DEFAULT_VIEWPORT[0],
                height.pixels if height else _DEFAULT_VIEWPORT[1],
                height.pixels if height else None,
                MM_PER_PIXEL if any(length.absolute for length in sizes) else None,
                1.0,
                page=(0.0, 0.0, width.pixels, height.pixels) if width and height else None,
            )
        x, y, box_width, box_height = box
        scales = (
            None if width is None else width.pixels / box_width,
            None if height is None else height.pixels / box_height,
        )
        known = [scale for scale in scales if scale is not None]
        stretch = 1.0
        scale: float | None = None
        if len(known) == 2:
            align, slice_ = _aspect(attributes)
            if align == "none":
                scale, stretch = known[0], known[1] / known[0]
            else:
                scale = max(known) if slice_ else min(known)
        elif known:
            scale = known[0]
        absolute = bool(sizes) and all(length.absolute for length in sizes)
        return _Viewport(
            box_width,
            box_height,
            stretch * (2 * y + box_height),
            scale * MM_PER_PIXEL if scale is not None and absolute else None,
            scale,
            stretch,
            (x, stretch * y, x + box_width, stretch * (y + box_height)),
        )

    def _root_length(self, name: str, attributes: Mapping[str, str]) -> Length | None:
        """The root's width or height; None when missing or relative. Raises ReadError when not positive."""
        text = attributes.get(name, "auto").strip()
        if text in ("", "auto"):
            return None
        try:
            length = parse_length(text)
        except SvgValueError as problem:
            raise ReadError(f"{name}: {problem}", element="<svg>") from problem
        if length.percent or length.unit in ("em", "rem", "ex", "ch"):
            return None
        if not length.pixels > 0.0:
            raise ReadError(f"{name} is {text}, so that nothing is drawn", element="<svg>")
        return length

    def _view_box(self, node: Node) -> tuple[float, float, float, float] | None:
        text = node.attributes.get("viewBox", "").strip()
        if not text or text.lower() == "none":
            return None
        try:
            values = parse_numbers(text, 4)
        except SvgValueError as problem:
            raise ReadError(f"viewBox: {problem}", element=str(node)) from problem
        if len(values) != 4 or not (values[2] > 0.0 and values[3] > 0.0):
            raise ReadError("viewBox is not four numbers with a positive width and height", element=str(node))
        return values[0], values[1], values[2], values[3]

    def _fit(self, node: Node, width: float, height: float) -> FloatArray:
        """(3,3) matrix from the viewBox of an inner <svg> or <symbol> to its viewport."""
        box = self._view_box(node)
        if box is None:
            return np.eye(3)
        x, y, box_width, box_height = box
        sx, sy = width / box_width, height / box_height
        align, slice_ = _aspect(node.attributes)
        if align != "none":
            sx = sy = max(sx, sy) if slice_ else min(sx, sy)
        spare = {"min": 0.0, "mid": 0.5, "max": 1.0}
        tx = spare.get(align[1:4], 0.5) * (width - sx * box_width) - sx * x
        ty = spare.get(align[5:8], 0.5) * (height - sy * box_height) - sy * y
        return np.array([[sx, 0.0, tx], [0.0, sy, ty], [0.0, 0.0, 1.0]])

    # ---- elements

    def _children(self, node: Node, state: _State | None) -> None:
        if state is None:
            return
        for child in node.children:
            self._element(child, state)

    def _element(self, node: Node, state: _State) -> None:
        tag = node.tag
        # All count, also those that draw nothing: a group full of them can be repeated as well.
        self._elements += 1
        if self._elements > MAX_ELEMENTS:
            raise PatternError(f"the drawing has more than {MAX_ELEMENTS:,} elements")
        if tag in _SILENT or not tag:
            return
        if state.depth > MAX_DEPTH:
            raise PatternError(f"elements are nested more than {MAX_DEPTH} deep", element=str(node))
        if tag not in _CONTAINERS and tag not in SHAPES and tag != "use":
            self._left_out[_left_out(tag)] += 1
            return
        self._element_inside(node, state, self._draw)

    def _draw(self, node: Node, state: _State) -> None:
        """What ``node`` draws, from the state inside it."""
        if node.tag in SHAPES:
            self._shape(node, state)
        elif node.tag == "use":
            self._use(node, state)
        elif node.tag == "svg":
            self._children(node, self._inner_viewport(node, state, _measured(node, state.look)))
        else:
            self._children(node, state)

    def _element_inside(
        self, node: Node, state: _State, draw: Callable[[Node, _State], None], named: bool = True
    ) -> None:
        """Lets ``draw`` draw inside ``node``, under its style and transforms, unless it is not displayed."""
        try:
            inner = self._enter(node, state, named)
            if inner is None:
                return
            own = inner.look.own
            first = len(self._shapes)
            boxed = own.get("transform-box", "view-box").lower() != "view-box"
            if not boxed:
                transform = self._transform(node, inner, (0.0, 0.0, state.width, state.height))
                draw(node, inner if transform is None else inner.moved(transform))
                return
            # The box is that of what is drawn, and so it is drawn first.
            draw(node, inner)
            if drawn := self._shapes[first:]:
                self._shapes[first:] = self._moved_in_their_box(node, inner, drawn)
        except SvgValueError as problem:
            raise PatternError(str(problem), element=str(node)) from problem

    def _moved_in_their_box(self, node: Node, state: _State, drawn: list[Drawn]) -> list[Drawn]:
        """What ``node`` has drawn, after its transforms about the box of it. Raises SvgValueError."""
        outer = state.matrix
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                back = np.linalg.inv(outer)
                x0, y0, x1, y1 = exact_box(p.transformed(back) for shape in drawn for p in shape.subpaths)
        except np.linalg.LinAlgError as error:
            raise SvgValueError("it has no box, since it is flattened or too large") from error
        transform = self._transform(node, state, (x0, y0, x1 - x0, y1 - y0))
        if transform is None:
            return drawn
        change = _joined(_joined(outer, transform), back)
        return [_moved(shape, change) for shape in drawn]

    def _look(self, node: Node, parent: Computed) -> Computed:
        return self._styler.compute(self._sheet.style(node), parent)

    def _enter(self, node: Node, state: _State, named: bool = True) -> _State | None:
        """The state inside ``node`` but for its transforms, None when it is not displayed."""
        look = self._look(node, state.look)
        if look.own:
            if look.own.get("display", "").lower() == "none":
                self._left_out[f"<{node.tag}> left out: not displayed"] += 1
                return None
            if any(look.own.get(name, "none").lower() != "none" for name in ("clip-path", "mask")):
                self._left_out[f"<{node.tag}> read whole: clipping is not applied"] += 1
        return _State(
            state.matrix,
            look,
            state.opacity * look.opacity,
            state.width,
            state.height,
            (*_words(node), *state.words)[:MAX_WORDS] if named else (),
            state.depth + 1,
            state.used,
        )

    def _transform(self, node: Node, state: _State, box: tuple[float, float, float, float]) -> FloatArray | None:
        """(3,3) of all that moves ``node``, about its origin in the reference ``box``; None for nothing."""
        own = state.look.own
        attribute = node.attributes.get("transform", "")
        if not attribute and not own.keys() & _MOVING:
            return None
        if len(attribute) > MAX_PROPERTY:
            raise ReadError(f"transform has more than {MAX_PROPERTY:,} characters", element=str(node))
        matrix = np.eye(3)
        with np.errstate(over="ignore", invalid="ignore"):
            if own.get("translate", "none").lower() != "none":
                matrix = matrix @ css_translate(own["translate"], *box[2:])
            if own.get("rotate", "none").lower() != "none":
                matrix = matrix @ css_rotate(own["rotate"])
            if own.get("scale", "none").lower() != "none":
                matrix = matrix @ css_scale(own["scale"])
            css = own.get("transform")
            matrix = matrix @ (parse_transform(attribute) if css is None else css_transform(css, *box[2:]))
            # Of lines, the origin is that of the coordinates, and not the middle (CSS Transforms 1, section 6).
            if origin := own.get("transform-origin"):
                matrix = about(matrix, *css_origin(origin, box))
            elif own.get("transform-box", "view-box").lower() != "view-box":
                matrix = about(matrix, box[0], box[1])
        return matrix

    def _inner_viewport(self, node: Node, state: _State, attributes: Mapping[str, str]) -> _State | None:
        def length(name: str, default: str, whole: float) -> float:
            text = attributes.get(name, "").strip() or default
            return self._length(parse_length(default if text == "auto" else text), whole)

        x, y = length("x", "0", state.width), length("y", "0", state.height)
        width, height = length("width", "100%", state.width), length("height", "100%", state.height)
        if not (width > 0.0 and height > 0.0):
            return None
        move = np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
        box = self._view_box(node)
        return replace(
            state,
            matrix=state.matrix @ move @ self._fit(node, width, height),
            width=width if box is None else box[2],
            height=height if box is None else box[3],
        )

    def _use(self, node: Node, state: _State) -> None:
        href = node.attributes.get("href", "").strip()
        if not href.startswith("#"):
            self._left_out["<use> left out: it refers to another file"] += 1
            return
        target = self._by_id.get(href[1:])
        if target is None:
            raise PatternError(f"it refers to {href[:40]!r}, which is not in the file", element=str(node))
        if target in state.used:
            raise PatternError(f"it refers to itself through {href[:40]!r}", element=str(node))
        state = replace(state, used=(*state.used, target))
        measured = _measured(node, state.look)
        if target.tag not in ("symbol", "svg"):
            x = self._length(parse_length(measured.get("x", "0") or "0"), state.width)
            y = self._length(parse_length(measured.get("y", "0") or "0"), state.height)
            move = np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
            self._element(target, replace(state, matrix=state.matrix @ move))
            return
        # SVG 1.1, section 5.6: a symbol is an inner <svg> with the size given at the <use>.
        self._elements += 1
        given = {k: v for k, v in measured.items() if k in ("x", "y", "width", "height")}

        def draw(node: Node, inner: _State) -> None:
            names = ("width", "height") if node.tag == "svg" else ()
            own = {k: v for k, v in _measured(node, inner.look).items() if k in names}
            self._children(node, self._inner_viewport(node, inner, {**own, **given}))

        self._element_inside(target, state, draw)

    # ---- shapes

    def _length(self, length: Length, whole: float) -> float:
        self._paper_units |= length.absolute
        value = length.resolve(whole)
        if not math.isfinite(value):
            raise SvgValueError("a length is not finite")
        return value

    def _shape(self, node: Node, state: _State) -> None:
        look = state.look
        if not look.visible:
            self._left_out[f"<{node.tag}> left out: hidden"] += 1
            return
        stroke, fill = look.stroke, look.fill
        if not look.declared and any(kind in DATA_ATTRIBUTES for kind, _ in state.words):
            # Nothing says how it looks, but what it is.
            stroke, fill = UNKNOWN_COLOUR, None
            self._left_out[
                f"<{node.tag}> without stroke and fill read as a line, since its data say what it is"
            ] += 1
        for problem in look.problems:
            self._left_out[f"<{node.tag}> {problem}"] += 1
        diagonal = math.hypot(state.width, state.height) / math.sqrt(2.0)
        filled = fill is not None and state.opacity * fill.opacity * look.fill_opacity > 0.0
        opacity = 0.0
        if stroke is not None:
            opacity = state.opacity * stroke.opacity * look.stroke_opacity
            if opacity == 0.0:
                self._left_out[f"<{node.tag}> stroke left out: fully transparent (no fold)"] += 1
            elif self._length(parse_length(look.stroke_width), diagonal) == 0.0:
                # A browser shows no such line, but cutters and CAD programs do: it is as thin as the pen.
                if filled and node.tag != "line":
                    opacity = 0.0
                    self._filled_hairlines += 1
                else:
                    self._hairlines += 1
        if opacity == 0.0 and not filled:
            return
        outlines = self._outlines.get(node)
        if outlines is None:
            wholes = {"x": state.width, "y": state.height, "": diagonal}
            measured = _measured(node, look)
            outlines = shape_subpaths(
                node.tag,
                measured,
                lambda length, direction: self._length(length, wholes[direction]),
            )
            # Only what <use> draws is drawn again. Percentages and styles depend on the place, all else does not.
            alone = measured is node.attributes and (
                node.tag in ("path", "polyline", "polygon") or "%" not in "".join(measured.values())
            )
            if state.used and alone:
                self._outlines[node] = outlines
        self._segments += sum(len(outline.segments) for outline in outlines)
        if self._segments > MAX_POINTS:
            raise PatternError(f"the drawing needs more than {MAX_POINTS:,} points")
        if not outlines:
            self._left_out[f"<{node.tag}> left out: it has no length"] += 1
            return
        subpaths = tuple(_transformed(outline, state.matrix) for outline in outlines)
        self._shapes.append(
            Drawn(
                str(node),
                node.attributes.get("id", ""),
                subpaths,
                stroke if opacity > 0.0 else None,
                filled,
                opacity,
                look.dashes,
                state.words,
            )
        )


@dataclass(frozen=True)
class _Viewport:
    """The root's: size for percentages, ymin + ymax for the flip, and what a user unit is."""

    width: float
    height: float
    middle: float | None
    unit_mm: float | None
    pixels_per_unit: float | None
    stretch: float = 1.0  # of y against x, when preserveAspectRatio is none
    page: tuple[float, float, float, float] | None = None


def _words(node: Node) -> tuple[tuple[str, str], ...]:
    """(kind, text) of what one element is called: data, classes, then names."""
    own = node.attributes
    shape = node.tag in SHAPES
    data = [(name, own[name]) for name in (*DATA_ATTRIBUTES, "type") if own.get(name)]
    classes = [("class" if shape else "class of its group", name) for name in node.classes]
    group = "group or layer name"
    labels = [("name" if shape else group, own.get(name, "")) for name in ("inkscape:label", "data-name")]
    names = [("id" if shape else group, own.get("id", "")), *labels]
    return (*data, *classes, *((kind, text) for kind, text in names if text))


def _left_out(tag: str) -> str:
    return f"<{tag}> left out: not a line"


def _aspect(attributes: Mapping[str, str]) -> tuple[str, bool]:
    words = attributes.get("preserveAspectRatio", "xMidYMid").split()
    if words[:1] == ["defer"]:
        words = words[1:]
    return (words[0] if words else "xMidYMid"), "slice" in words[1:]


def _measured(node: Node, look: Computed) -> Mapping[str, str]:
    """The attributes of an element, with the measures that its style gives in place of its own (SVG 2)."""
    own = {name: value for name, value in look.own.items() if name in MEASURES} if look.own else {}
    if node.tag == "path" and "d" in look.own:
        own["d"] = css_path(look.own["d"]) or ""
    return {**node.attributes, **own} if own else node.attributes


def _joined(outer: FloatArray, inner: FloatArray) -> FloatArray:
    with np.errstate(over="ignore", invalid="ignore"):
        matrix = outer @ inner
    if not np.isfinite(matrix).all():
        raise SvgValueError("the transforms together are not finite")
    return np.asarray(matrix)


def _moved(shape: Drawn, matrix: FloatArray) -> Drawn:
    return replace(shape, subpaths=tuple(_transformed(subpath, matrix) for subpath in shape.subpaths))


def _transformed(subpath: Subpath, matrix: FloatArray) -> Subpath:
    """Raises SvgValueError when it gets too large."""
    with np.errstate(over="ignore", invalid="ignore"):
        moved = subpath if matrix is _IDENTITY else subpath.transformed(matrix)
    for segment in moved.segments:
        if not np.abs(segment.points).max() < MAX_COORDINATE:
            raise SvgValueError("its coordinates are not finite, or too large to be a drawing")
    return moved


def _hairlines(count: int, filled: bool) -> str:
    strokes, are = ("1 stroke", "is") if count == 1 else (f"{count} strokes", "are")
    if filled:
        return f"{strokes} of width 0 {are} left out, around what is filled"
    return f"{strokes} of width 0 {are} read as {'a hairline' if count == 1 else 'hairlines'}"
