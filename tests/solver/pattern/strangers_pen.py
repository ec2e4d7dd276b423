"""What all exporters share: colours and words for kinds of lines, numbers, path data, the simplest element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.solver.pattern.strangers_designs import FloatArray, Rng
from tests.solver.pattern.strangers_habits import Page, Stroke

Rgb = tuple[int, int, int]


@dataclass(frozen=True)
class Export:
    """A file as a program writes it.

    unit        units of the drawing in a millimetre of the page
    unit_mm     millimetres in one unit, as the file says; None where it does not
    refused     a word that the refusal must say, where no program can read this as lines; else empty
    """

    text: str
    unit: float
    unit_mm: float | None
    suffix: str = ".svg"
    refused: str = ""


@dataclass(frozen=True)
class Look:
    """How an author tells kinds of lines apart: by ``marks`` (strangers_habits.MARKS)."""

    marks: str
    colours: dict[str, Rgb]
    names: dict[str, str]

    def colour(self, kind: str) -> Rgb:
        return self.colours.get(kind, (0, 0, 0))

    def hex(self, kind: str) -> str:
        return "#" + "".join(f"{value:02x}" for value in self.colour(kind))

    def rgb(self, kind: str) -> str:
        return "rgb({},{},{})".format(*self.colour(kind))

    def name(self, kind: str) -> str:
        """A word for a layer or a class; empty where the author uses none."""
        return self.names.get(kind, "")

    def dash(self, kind: str) -> tuple[float, ...]:
        """Lengths of dashes and gaps, mm: Yoshizawa and Randlett's."""
        if self.marks != "dashes":
            return ()
        return {"M": (4.0, 1.2, 0.8, 1.2), "V": (2.5, 1.5)}.get(kind, ())


_NAMES = {
    "border": ("Cut", "Border", "outline", "Cut lines", "CUT"),
    "hole": ("Cut", "Holes", "hole", "Cut-out"),
    "cut": ("Cut", "slits", "Cut lines"),
    "M": ("Mountain", "mountain folds", "MOUNTAIN", "mountain-fold", "Mountains"),
    "V": ("Valley", "valley folds", "VALLEY", "valley-fold", "Valleys"),
    "U": ("Fold", "crease", "Score", "score lines", "Fold lines"),
    "dimension": ("Dimensions", "dimension", "DIM", "Dimensions 1"),
}
#: Colours of programs and of people. Black of one kind or another is an edge.
_PALETTES: tuple[dict[str, Rgb], ...] = (
    {"M": (255, 0, 0), "V": (0, 0, 255)},
    {"M": (237, 28, 36), "V": (46, 49, 146), "border": (35, 31, 32), "hole": (35, 31, 32), "cut": (35, 31, 32)},
    {"M": (220, 20, 30), "V": (30, 60, 220), "cut": (0, 160, 60), "dimension": (120, 120, 120)},
    {"M": (255, 0, 0), "V": (0, 0, 255), "hole": (0, 255, 0), "cut": (0, 255, 0)},
)
#: Colours that say nothing, or the wrong thing, beside names that say the right one.
_AGAINST: tuple[dict[str, Rgb], ...] = (
    {},
    {
        "M": (0, 0, 255),
        "V": (0, 160, 0),
        "U": (0, 160, 0),
        "border": (255, 0, 0),
        "hole": (255, 0, 0),
        "cut": (255, 0, 0),
    },
    {"border": (0, 0, 255), "hole": (0, 0, 255), "cut": (0, 0, 255), "U": (255, 0, 0), "dimension": (0, 255, 0)},
    {"M": (0, 170, 80), "V": (0, 170, 80), "U": (0, 255, 0), "dimension": (255, 0, 0)},
)


def look(rng: Rng, marks: str) -> Look:
    """Colours and names of one author."""
    if marks == "names":
        names = {kind: str(rng.choice(words)) for kind, words in _NAMES.items()}
        return Look(marks, dict(_AGAINST[rng.integers(len(_AGAINST))]), names)
    if marks == "colours":
        return Look(marks, dict(_PALETTES[rng.integers(len(_PALETTES))]), {})
    if marks == "one colour":
        colour = [(255, 0, 255), (200, 0, 200), (255, 0, 0), (0, 0, 255)][rng.integers(4)]
        return Look(marks, {"U": colour}, {})
    return Look(marks, {}, {})


@dataclass(frozen=True)
class Pen:
    """Writes page coordinates (mm, y up) into a file: x' = scale x + dx, y' = dy - scale y (+ if not flipped)."""

    scale: float
    dx: float = 0.0
    dy: float = 0.0
    flipped: bool = True
    digits: int = 3

    def at(self, points: FloatArray) -> FloatArray:
        sign = -1.0 if self.flipped else 1.0
        return np.asarray(points) * (self.scale, sign * self.scale) + (self.dx, self.dy)

    def number(self, value: float) -> str:
        text = f"{value:.{self.digits}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        return "0" if text == "-0" else text

    def pair(self, point: FloatArray, between: str = ",") -> str:
        return f"{self.number(point[0])}{between}{self.number(point[1])}"

    def points(self, stroke: Stroke) -> FloatArray:
        """(P,2) the corners of a polyline in the file, a closed one without its first point again."""
        points = self.at(stroke.curve.points())
        return points[:-1] if stroke.curve.closed else points

    def data(self, stroke: Stroke, relative: bool = False, blank: str = " ") -> str:
        """Path data: M with L, C or A, as the stroke is."""
        curve = stroke.curve
        end = f"{blank}{'z' if relative else 'Z'}" if curve.closed else ""
        if curve.straight or not stroke.smooth:
            points = self.points(stroke)
            if relative:
                steps = np.vstack([points[:1], np.diff(points, axis=0)])
                return f"m {blank.join(self.pair(step) for step in steps)}{end}"
            rest = "".join(f"{blank}L{blank}{self.pair(point)}" for point in points[1:])
            return f"M{blank}{self.pair(points[0])}{rest}{end}"
        beziers = self.at(curve.beziers)
        start = f"M{blank}{self.pair(beziers[0, 0])}"
        if relative:
            rows = [" ".join(self.pair(p - one[0]) for p in one[1:]) for one in beziers]
            return f"m {self.pair(beziers[0, 0])} c {' '.join(rows)}{end}"
        rows = [" ".join(self.pair(p) for p in one[1:]) for one in beziers]
        return f"{start}{blank}C{blank}{blank.join(rows)}{end}"

    def arc_data(self, stroke: Stroke) -> str:
        """Path data with elliptical arcs, where the stroke is a part of a circle."""
        curve = stroke.curve
        if curve.arc is None or not stroke.smooth:
            return self.data(stroke)
        _, _, radius, first, last = curve.arc
        r = self.number(self.scale * radius)
        # A whole circle takes two arcs; an arc larger than half a circle is written in two as well.
        middle = _on(curve.arc, 0.5 * (first + last))
        turned = (last > first) != self.flipped
        points = self.at(np.array([_on(curve.arc, first), middle, _on(curve.arc, last)]))
        rows = " ".join(f"A {r} {r} 0 0 {int(turned)} {self.pair(point)}" for point in points[1:])
        return f"M {self.pair(points[0])} {rows}{' Z' if curve.closed else ''}"

    def element(self, stroke: Stroke, attributes: str, paths: bool = False, arcs: bool = False) -> str:
        """The plainest element for a stroke: line, polyline, polygon, circle or path."""
        curve = stroke.curve
        n = self.number
        attributes = f" {attributes}" if attributes else ""
        if paths or (not curve.straight and stroke.smooth and curve.arc is None):
            data = self.arc_data(stroke) if arcs else self.data(stroke)
            return f'<path{attributes} d="{data}"/>'
        if not curve.straight and stroke.smooth and curve.closed and curve.arc is not None:
            x, y = self.at(np.array(curve.arc[:2]))
            return f'<circle{attributes} cx="{n(x)}" cy="{n(y)}" r="{n(self.scale * curve.arc[2])}"/>'
        if not curve.straight and stroke.smooth:
            return f'<path{attributes} d="{self.arc_data(stroke) if arcs else self.data(stroke)}"/>'
        points = self.points(stroke)
        if len(points) == 2 and not curve.closed:
            (x1, y1), (x2, y2) = points
            return f'<line{attributes} x1="{n(x1)}" y1="{n(y1)}" x2="{n(x2)}" y2="{n(y2)}"/>'
        tag = "polygon" if curve.closed else "polyline"
        return f'<{tag}{attributes} points="{" ".join(self.pair(point) for point in points)}"/>'


def _on(circle: tuple[float, float, float, float, float], angle: float) -> FloatArray:
    x, y, radius, _, _ = circle
    return np.array([x + radius * np.cos(np.radians(angle)), y + radius * np.sin(np.radians(angle))])


def groups(page: Page, look: Look) -> list[tuple[str, list[Stroke]]]:
    """(name, strokes) by kind, kinds with one name together; one group without a name where there are no names."""
    made: dict[str, list[Stroke]] = {}
    for stroke in page.strokes:
        made.setdefault(look.name(stroke.kind), []).append(stroke)
    return list(made.items())


def pen_for(page: Page, scale: float, x: float = 0.0, y: float = 0.0, digits: int = 3) -> Pen:
    """Puts the page's upper left corner at (x, y) of a file with y down."""
    return Pen(scale, x, y + scale * page.height, digits=digits)
