"""From classified strokes to a sheet: border, holes, creases, and a sentence for every decision."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
import shapely

from ..errors import PatternError
from .crease_pattern import Crease, CreasePattern
from .meaning import classify
from .rings import JOIN, Ring, curve_line, outer_rings, share_inside, touching_groups
from .segments import MAX_POINTS, Curve, bounds, sample
from .stroke import CREASE_ROLES, EDGE_ROLES, Role, Stroke
from .svg_walk import Drawing, Drawn
from .unstroked import why_no_line

#: How much of the creases (by length) a closed outline must hold to be the border. Strokes that say they are
#: an edge need less agreement than black ones, these less than a drawing in which nothing says anything.
_SHARE_NAMED = 0.9
_SHARE_BLACK = 0.5
_SHARE_ANY = 0.95
#: An outline inside another one that holds this share of the creases is the sheet, and the outer one a frame.
_SHARE_FRAMED = 0.99
#: A stroke that runs along the border for this share of the drawing's side is cut there.
_ALONG = 0.01
#: Strokes (subpaths) and holes of one drawing.
MAX_STROKES = 30_000
MAX_HOLES = 1_000

_LETTERS = {Role.MOUNTAIN: "M", Role.VALLEY: "V"}


def make_pattern(drawing: Drawing) -> CreasePattern:
    """The crease pattern that a drawing means. Raises PatternError: no strokes, no border, no crease."""
    return _Sheet(drawing).pattern()


class _Sheet:
    """The decisions about one drawing, step by step. Not reusable."""

    def __init__(self, drawing: Drawing) -> None:
        self._drawing = drawing
        stroked = [shape for shape in drawing.shapes if shape.stroke is not None]
        if not stroked:
            raise PatternError(why_no_line(drawing.shapes))
        x0, y0, x1, y1 = bounds([subpath for shape in stroked for subpath in shape.subpaths])
        self._size = max(x1 - x0, y1 - y0)
        if not self._size > 0.0:
            raise PatternError("the drawing has no size: all its lines are one point")
        self._tolerance = JOIN * self._size
        self._strokes: list[Stroke] = []
        budget = MAX_POINTS
        for shape in stroked:
            decision = classify(shape)
            for curve, part in self._curves(shape, budget):
                budget -= len(curve.points)
                identity = shape.identity[:80]
                name = f"{identity} part {part}" if identity and part else identity
                if len(self._strokes) == MAX_STROKES:
                    raise PatternError(f"the drawing has more than {MAX_STROKES:,} strokes")
                self._strokes.append(Stroke(curve, decision, name, shape.opacity))
        if not self._strokes:
            raise PatternError("the drawing has no line: all its strokes have no length")
        #: Whether anything says "I am a crease"; otherwise black lines are the creases.
        self._marked = any(stroke.decision.role in CREASE_ROLES for stroke in self._strokes)
        self._notes: list[str] = []

    def _curves(self, shape: Drawn, budget: int) -> Iterable[tuple[Curve, int]]:
        several = len(shape.subpaths) > 1
        for part, subpath in enumerate(shape.subpaths, start=1):
            try:
                curve = sample(subpath, self._size, budget)
            except PatternError as error:
                raise PatternError(error.message, element=shape.element) from error
            if curve is not None:
                budget -= len(curve.points)
                yield curve, part if several else 0

    def pattern(self) -> CreasePattern:
        sheet, explained = self._find_sheet()
        for i in sheet.members:
            self._settle(i, "border")
        if explained:
            self._notes.append(explained)
        self._cut_along(sheet)
        holes = self._find_holes(sheet)
        self._leave_out_far(sheet, holes)
        self._settle_rest()
        creases = self._creases()
        return CreasePattern(
            sheet.points,
            [hole.points for hole in holes],
            creases,
            unit_mm=self._drawing.unit_mm,
            notes=(*self._stroke_notes(), *self._notes, *self._drawing.notes),
        )

    # ---- small helpers

    def _open(self, *roles: Role) -> list[int]:
        """Strokes with these roles that nothing has been decided about yet."""
        return [i for i, s in enumerate(self._strokes) if not s.fate and s.decision.role in roles]

    def _settle(self, index: int, fate: str) -> None:
        self._strokes[index] = replace(self._strokes[index], fate=fate)

    def _some(self, indices: Iterable[int]) -> list[Curve]:
        return [self._strokes[i].curve for i in indices]

    @property
    def _all(self) -> list[Curve]:
        return [stroke.curve for stroke in self._strokes]

    # ---- the border

    def _find_sheet(self) -> tuple[Ring, str]:
        edges = self._open(*EDGE_ROLES)
        dark = self._open(Role.DARK)
        pale = self._open(Role.PALE)
        creases = self._open(*CREASE_ROLES)
        dark_share = _SHARE_BLACK if self._marked else _SHARE_ANY
        attempts = [
            (edges, _SHARE_NAMED, ""),
            (edges + dark, dark_share, ""),
            (edges + dark + pale, dark_share, "the border is grey: no darker outline holds the creases"),
        ]
        for candidates, share, explained in attempts:
            # Without marked creases all strokes that are not the outline itself have to be inside.
            inside = creases if self._marked else [*edges, *dark, *pale]
            ring = self._sheet_of(candidates, inside, share)
            if ring is not None:
                frame_free = self._without_frame(ring, candidates) if candidates is not edges else ring
                return frame_free, explained
        filled = self._filled_sheet(creases or [*dark, *pale])
        if filled is not None:
            return filled
        rest = [*edges, *dark, *pale, *creases]
        ring = self._sheet_of(rest, rest, _SHARE_ANY)
        if ring is not None:
            return ring, "the border is the outermost closed outline, since no stroke says that it is one"
        raise PatternError("no border found: no closed outline, also not one of several lines, holds the creases")

    def _sheet_of(self, candidates: list[int], inside: list[int], share: float) -> Ring | None:
        if not candidates:
            return None
        best: tuple[float, Ring] | None = None
        for ring in outer_rings(self._all, candidates, self._size)[:8]:
            others = self._some(i for i in inside if i not in ring.members)
            held = share_inside(ring.polygon, others, self._tolerance)
            if held >= share and (best is None or held > best[0] + 1e-6):
                best = held, ring
        return None if best is None else best[1]

    def _without_frame(self, sheet: Ring, candidates: list[int]) -> Ring:
        """The innermost outline that still holds all marked creases: whatever is around it is a frame."""
        creases = self._some(self._open(*CREASE_ROLES))
        if not creases:
            return sheet
        box = shapely.box(*shapely.total_bounds([curve_line(curve) for curve in creases]))
        curves = self._all
        while True:
            rest = [i for i in candidates if i not in sheet.members and not self._strokes[i].fate]
            inner = [
                ring
                for group in touching_groups(curves, rest, self._tolerance)
                if self._holds_box(group, box)
                for ring in outer_rings(curves, group, self._size)
                if ring.polygon.area < sheet.polygon.area
                and shapely.distance(ring.polygon.exterior, sheet.polygon.exterior) > self._tolerance
                and share_inside(ring.polygon, creases, self._tolerance) >= _SHARE_FRAMED
            ]
            if not inner:
                return sheet
            for i in sheet.members:
                self._settle(i, "left out: a frame around the sheet")
            sheet = max(inner, key=lambda ring: ring.polygon.area)

    def _holds_box(self, group: list[int], box: shapely.Polygon) -> bool:
        """Whether an outline made of ``group`` could hold most of ``box``. Cheap, so asked first."""
        bounds = shapely.box(*shapely.total_bounds([curve_line(curve) for curve in self._some(group)]))
        width, height = np.ptp(shapely.get_coordinates(box), axis=0)
        slack = (1.0 - _SHARE_FRAMED) * max(width, height) + self._tolerance
        return bool(shapely.covers(bounds.buffer(slack, join_style="mitre"), box))

    def _filled_sheet(self, creases: list[int]) -> tuple[Ring, str] | None:
        best: Ring | None = None
        for shape in self._drawing.shapes:
            if shape.stroke is not None or not shape.filled:
                continue
            for curve, _ in self._curves(shape, MAX_POINTS):
                if not curve.closed:
                    continue
                rings = outer_rings([curve], [0], self._size)
                if (
                    rings
                    and (best is None or rings[0].polygon.area > best.polygon.area)
                    and share_inside(rings[0].polygon, self._some(creases), self._tolerance) >= _SHARE_NAMED
                ):
                    best = replace(rings[0], members=frozenset())
        if best is None:
            return None
        return best, "the border is a filled shape without a stroke: no stroke closes around the creases"

    def _cut_along(self, sheet: Ring) -> None:
        """Split the undecided edge strokes that run along the border for a while; what is on it is border."""
        band = sheet.polygon.exterior.buffer(2.0 * self._tolerance)
        shapely.prepare(band)
        for i in self._open(*EDGE_ROLES, Role.DARK):
            stroke = self._strokes[i]
            whole = curve_line(stroke.curve)
            if not shapely.intersects(band, whole):
                continue
            if shapely.intersection(whole, band).length < _ALONG * self._size:
                continue
            self._settle(i, "border")
            for piece in shapely.get_parts(shapely.line_merge(shapely.difference(whole, band))):
                points = shapely.get_coordinates(piece)
                if len(points) >= 2 and piece.length > 4.0 * self._tolerance:
                    detail = f"{stroke.decision.detail}, the rest of a border stroke,"
                    decision = replace(stroke.decision, detail=detail)
                    self._strokes.append(replace(stroke, curve=Curve(points, False, None), decision=decision))

    # ---- holes

    def _find_holes(self, sheet: Ring) -> list[Ring]:
        roles = (*EDGE_ROLES, Role.DARK) if self._marked else tuple(EDGE_ROLES)
        inside = sheet.polygon.buffer(-self._tolerance)
        shapely.prepare(inside)
        curves = self._all
        holes: list[Ring] = []
        # Closed strokes first: a line that ends at a hole must not make the hole a part of something else.
        for closed in (True, False):
            candidates = [
                i
                for i in self._open(*roles)
                if curves[i].closed == closed and shapely.covers(inside, curve_line(curves[i]))
            ]
            rings = [
                ring
                for group in touching_groups(curves, candidates, self._tolerance)
                for ring in outer_rings(curves, group, self._size)
            ]
            holes = self._outermost(holes, rings)
        return holes

    def _outermost(self, holes: list[Ring], rings: list[Ring]) -> list[Ring]:
        """``holes`` and those of ``rings`` outside them, larger ones first: what falls out has no holes."""
        kept = list(holes)
        for ring in sorted(rings, key=lambda ring: -ring.polygon.area):
            polygons = np.array([hole.polygon for hole in kept])
            if shapely.intersects(polygons, ring.polygon).any():
                if shapely.covers(polygons, ring.polygon).any():
                    for i in ring.members:
                        self._settle(i, "left out: inside a hole")
                continue
            if len(kept) == MAX_HOLES:
                raise PatternError(f"the drawing has more than {MAX_HOLES:,} holes")
            shapely.prepare(ring.polygon)
            kept.append(ring)
            for i in ring.members:
                self._settle(i, "hole")
        return kept

    # ---- the rest

    def _leave_out_far(self, sheet: Ring, holes: Sequence[Ring]) -> None:
        """What has no part on the paper."""
        grown = sheet.polygon.buffer(self._tolerance)
        shapely.prepare(grown)
        gaps = shapely.union_all([hole.polygon.buffer(self._tolerance) for hole in holes])
        shapely.prepare(gaps)
        for i in self._open(*(set(Role) - {Role.FACET})):
            curve = curve_line(self._strokes[i].curve)
            if not shapely.intersects(grown, curve):
                self._settle(i, "left out: beside the sheet")
            elif holes and shapely.covers(gaps, curve):
                self._settle(i, "left out: inside a hole")

    def _settle_rest(self) -> None:
        for i in self._open(Role.FACET):
            self._settle(i, "left out: facet line")
        for i in self._open(Role.CUT, Role.HOLE):
            self._settle(i, "left out: a cut that does not close is not supported")
        for i in self._open(Role.BORDER):
            self._settle(i, "left out: not part of a closed outline")
        for i in self._open(Role.DARK):
            self._settle(i, "unassigned crease")
        pale = self._open(Role.PALE)
        other = self._marked or any(stroke.fate == "unassigned crease" for stroke in self._strokes)
        fate = "left out: auxiliary line, lighter than the creases" if other else "unassigned crease"
        for i in pale:
            self._settle(i, fate)

    def _creases(self) -> list[Crease]:
        marked = self._open(*CREASE_ROLES)
        plain = [i for i, stroke in enumerate(self._strokes) if stroke.fate == "unassigned crease"]
        # One look for all creases distinguishes nothing. Names are meant, also when there is but one.
        roles = {self._strokes[i].decision.role for i in marked}
        looks = all(self._strokes[i].decision.why in ("hue", "dash pattern") for i in marked)
        if marked and not plain and len(roles) == 1 and roles <= set(_LETTERS) and looks:
            for i in marked:
                self._settle(i, "unassigned crease, since all creases look the same")
            plain, marked = marked, []
        letters = dict.fromkeys(plain, "U")
        for i in marked:
            role = self._strokes[i].decision.role
            letters[i] = _LETTERS.get(role, "U")
            self._settle(i, role.value)
        if not letters:
            raise PatternError("no crease found: nothing is drawn inside the border that could be folded")
        faint = sum(self._strokes[i].opacity < 1.0 - 1e-9 for i in letters)
        if faint:
            self._notes.append(
                f"the opacity of {_count(faint, 'crease')} is not used (a fold angle in some programs)"
            )
        return [
            Crease(s.curve.points, s.curve.closed, letters[i], s.name, s.curve.beziers)
            for i, s in enumerate(self._strokes)
            if i in letters
        ]

    def _stroke_notes(self) -> list[str]:
        groups = Counter((s.decision.detail, s.fate, s.decision.why) for s in self._strokes)
        return [
            f"{_count(count, 'stroke')} {detail}: {_plural(fate, count)} ({why})"
            for (detail, fate, why), count in groups.items()
        ]


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def _plural(fate: str, count: int) -> str:
    if count == 1 or fate.startswith("left out"):
        return fate
    head, comma, tail = fate.partition(",")
    return f"{head}s{comma}{tail}" if head.endswith(("crease", "hole")) else fate
