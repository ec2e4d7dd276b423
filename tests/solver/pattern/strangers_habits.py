"""How people draw what they mean: forms of curves, gaps, ends that miss, doubled lines, what lies beside."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import shapely

from tests.solver.pattern.strangers_designs import Curve, Design, FloatArray, Rng, lines

#: What a stroke is for its author.
KINDS = ("border", "hole", "cut", "M", "V", "U", "facet", "dimension")
#: How a crease is drawn: as it was constructed, as one polyline, as a stroke for each of its pieces, or as dashes
#: that a program drew one by one.
FORMS = ("as it is", "polyline", "pieces", "dashes")
#: How the border is drawn.
BORDERS = ("closed", "sides", "open sides", "page")
#: What says what a line is.
MARKS = ("colours", "names", "dashes", "plain", "one colour")


@dataclass(frozen=True)
class Habits:
    """What one author does. Lengths of ``gap`` and ``miss`` are parts of the longer side of the sheet."""

    border: str = "closed"
    form: str = "as it is"
    marks: str = "colours"
    gap: float = 0.0  # between the sides of an open border
    miss: float = 0.0  # by which creases end short of the border, or beyond it when negative
    doubled: bool = False
    beside: tuple[str, ...] = ()  # "dimensions", "legend"
    sheets: int = 1

    def words(self) -> str:
        told = [f"border {self.border}", f"creases {self.form}", f"marked by {self.marks}"]
        told += [f"gaps of {self.gap:.2%}"] if self.gap else []
        told += [f"ends {abs(self.miss):.2%} {'short' if self.miss > 0 else 'too long'}"] if self.miss else []
        told += ["doubled lines"] if self.doubled else []
        told += [" and ".join(self.beside) + " beside"] if self.beside else []
        told += [f"{self.sheets} sheets"] if self.sheets > 1 else []
        return ", ".join(told)


@dataclass(frozen=True, eq=False)
class Stroke:
    """One thing that is drawn: page coordinates in mm, y up. smooth: whether curves stay curves."""

    kind: str
    curve: Curve
    smooth: bool = True


@dataclass(frozen=True, eq=False)
class Page:
    """A page with all its strokes, mm. texts: (x, y, words)"""

    width: float
    height: float
    strokes: tuple[Stroke, ...]
    texts: tuple[tuple[float, float, str], ...] = ()

    def of(self, *kinds: str) -> list[Stroke]:
        return [stroke for stroke in self.strokes if stroke.kind in kinds]


@dataclass(frozen=True, eq=False)
class MeantSheet:
    """What the author means. outline and holes: rings; folds: (points, letters that are right); cuts: points."""

    outline: FloatArray
    holes: tuple[FloatArray, ...]
    folds: tuple[tuple[FloatArray, str], ...]
    cuts: tuple[FloatArray, ...]


@dataclass(frozen=True, eq=False)
class Layout:
    page: Page
    sheets: tuple[MeantSheet, ...]


def lay_out(designs: list[Design], habits: Habits, rng: Rng) -> Layout:
    """The sheets side by side on a page, drawn as these habits draw them, with what each should be read as."""
    margin = 0.0 if habits.border == "page" else float(rng.uniform(12, 20))
    strokes: list[Stroke] = []
    sheets: list[MeantSheet] = []
    texts: list[tuple[float, float, str]] = []
    letters = {_letter(letter, habits) for design in designs for _, letter in design.folds}
    at = np.array([margin, margin])
    top = 0.0
    for design in designs:
        width, height = design.size
        strokes += _drawn(design, at, habits, rng)
        sheets.append(_meant(design, at, habits, letters))
        if "dimensions" in habits.beside:
            strokes += _dimension(at, width)
            texts.append((at[0] + 0.4 * width, at[1] - 9, f"{width:.1f} mm"))
        top = max(top, height)
        at = at + np.array([width + margin, 0.0])
    page_width, page_height = float(at[0]), float(margin + top + margin)
    if "legend" in habits.beside:
        for k, (kind, words) in enumerate((("M", "mountain"), ("V", "valley"))):
            y = margin + top + 4 + 4 * k
            if kind in letters:
                strokes.append(Stroke(kind, lines((margin, y), (margin + 8, y))))
            texts.append((margin + 10, y, words))
    return Layout(Page(page_width, page_height, tuple(strokes), tuple(texts)), tuple(sheets))


def _letter(letter: str, habits: Habits) -> str:
    return "U" if habits.marks in ("plain", "one colour") else letter


def _meant(design: Design, at: FloatArray, habits: Habits, letters: set[str]) -> MeantSheet:
    def right(letter: str) -> str:
        letter = _letter(letter, habits)
        own = {_letter(one, habits) for _, one in design.folds}
        # Where all creases look the same, their look may mean "a crease" only. Names are meant.
        alone = habits.marks in ("colours", "dashes") and (len(letters) == 1 or len(own) == 1)
        return f"{letter}U" if alone else letter

    return MeantSheet(
        design.outline.moved(at).points(),
        tuple(hole.moved(at).points() for hole in design.holes),
        tuple((curve.moved(at).points(), right(letter)) for curve, letter in design.folds),
        tuple(cut.moved(at).points() for cut in design.cuts),
    )


# --- strokes --------------------------------------------------------------------------------------------


def _drawn(design: Design, at: FloatArray, habits: Habits, rng: Rng) -> list[Stroke]:
    side = float(design.size.max())
    smooth = habits.form == "as it is"
    strokes: list[Stroke] = []
    if habits.border != "page":
        strokes += [Stroke("border", curve.moved(at), smooth) for curve in _sides(design.outline, habits, side)]
    strokes += [Stroke("hole", hole.moved(at), smooth) for hole in design.holes]
    strokes += [Stroke("cut", cut.moved(at)) for cut in design.cuts]
    for curve, letter in design.folds:
        kind = _letter(letter, habits)
        ends = [float(_distance(design, curve.points()[k]) < 1e-6) for k in (0, -1)]
        if habits.miss and not curve.closed:
            # Not all ends miss by the same.
            curve = curve.stretched(*(-habits.miss * side * end * rng.uniform(0.5, 1.0) for end in ends))
        parts = _formed(curve, habits.form, side)
        strokes += [Stroke(kind, part.moved(at), smooth) for part in parts]
        if habits.doubled and rng.random() < 0.5:
            strokes += [Stroke(kind, part.moved(at), smooth) for part in parts]
    return strokes


def _distance(design: Design, point: FloatArray) -> float:
    """From a point to the border of the sheet or of a hole, mm."""
    rings = [shapely.LineString(curve.points(65)) for curve in (design.outline, *design.holes)]
    return min(ring.distance(shapely.Point(point)) for ring in rings)


def _sides(outline: Curve, habits: Habits, side: float) -> list[Curve]:
    if habits.border == "closed" or not outline.straight:
        return [outline]
    sides = [Curve(segment[None], straight=True) for segment in outline.beziers]
    if habits.border == "open sides":
        sides = [one.stretched(-0.5 * habits.gap * side, -0.5 * habits.gap * side) for one in sides]
    return sides


def _formed(curve: Curve, form: str, side: float) -> list[Curve]:
    if form in ("as it is", "polyline"):
        return [curve]
    points = curve.points()
    if form == "pieces":
        return [lines(a, b) for a, b in itertools.pairwise(points)]
    return dashed(points, 0.03 * side, 0.012 * side)


def dashed(points: FloatArray, dash: float, gap: float) -> list[Curve]:
    """Dashes along a polyline, one stroke each; the last one ends where it does."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    count = max(1, round((along[-1] + gap) / (dash + gap)))
    period = (along[-1] + gap) / count
    made = []
    for k in range(count):
        start, end = k * period, min(k * period + period - gap, along[-1])
        at = np.concatenate([[start], along[(along > start) & (along < end)], [end]])
        made.append(lines(*np.column_stack([np.interp(at, along, axis) for axis in points.T])))
    return made


def _dimension(at: FloatArray, width: float) -> list[Stroke]:
    """A measure below the sheet: two short lines and a long one with arrow heads."""
    x, y = at
    drawn = [
        lines((x, y - 2), (x, y - 8)),
        lines((x + width, y - 2), (x + width, y - 8)),
        lines((x, y - 6), (x + width, y - 6)),
        lines((x + 2, y - 5.3), (x, y - 6), (x + 2, y - 6.7)),
        lines((x + width - 2, y - 5.3), (x + width, y - 6), (x + width - 2, y - 6.7)),
    ]
    return [Stroke("dimension", curve) for curve in drawn]


def habits_of(
    rng: Rng, designs: list[Design], marks: tuple[str, ...], forms: tuple[str, ...], page: bool = True
) -> Habits:
    """Habits that leave no doubt about what these designs mean. page: whether it may be the border."""
    closed = any(curve.closed for design in designs for curve, _ in design.folds)
    inner = closed or any(design.holes or design.cuts for design in designs)
    lens = any(design.name == "a closed lens" for design in designs)
    flat = all(design.rectangular for design in designs)
    borders = ["closed", "closed"]
    if all(design.outline.straight for design in designs):
        borders += ["sides", "open sides"]
    if page and flat and len(designs) == 1 and not (inner or lens):
        borders += ["page"]
    # Nothing says whether a black circle in a drawing that is all black is a hole or a crease.
    marks = tuple(mark for mark in marks if mark != "plain" or not (inner or lens)) or ("colours",)
    border, mark = str(rng.choice(borders)), str(rng.choice(marks))
    if border == "page" and mark == "plain":
        mark = "colours" if "colours" in marks else mark
    form = str(rng.choice(forms))
    if form == "dashes" and mark in ("dashes", "plain"):
        form = "polyline"  # dashes that are drawn one by one have no pattern that could be read
    one_more = rng.random()
    return Habits(
        border,
        form,
        mark,
        gap=float(rng.uniform(0.0005, 0.006)) if border == "open sides" else 0.0,
        miss=float(rng.choice([-1, 1]) * rng.uniform(0.001, 0.01)) if one_more < 0.35 else 0.0,
        doubled=bool(0.35 < one_more < 0.45),
        beside=() if border == "page" else _beside(rng),
        sheets=len(designs),
    )


def _beside(rng: Rng) -> tuple[str, ...]:
    return tuple(what for what in ("dimensions", "legend") if rng.random() < 0.3)
