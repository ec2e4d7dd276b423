"""From lines that have a meaning to sheets: border, holes, creases, and a sentence for every decision."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely

from ..errors import PatternError
from .crease_pattern import BLANK, Crease, CreasePattern
from .rings import JOIN, Ring, curve_line, curve_lines, outer_rings, touching_groups
from .same_line import settle_same_lines
from .segments import Curve
from .sheet_finding import Found, Search, find_sheets
from .stroke import CREASE_ROLES, EDGE_ROLES, Lines, Role, Stroke

#: A stroke that runs along the border for this share of the drawing's side is cut there.
_ALONG = 0.01
#: Open strokes that cover this share of an outline together are a hole.
_COVERED = 0.99
#: Strokes (subpaths) and holes of one drawing.
MAX_STROKES = 30_000
MAX_HOLES = 1_000

_LETTERS = {Role.MOUNTAIN: "M", Role.VALLEY: "V"}
#: Strokes that say they are nothing to fold, and what becomes of what lies off the sheet.
_NO_PART = frozenset({Role.ASIDE, Role.FACET})
_BESIDE = "beside the sheet"
_NO_CREASE = f"the drawing has no crease: {BLANK}"


def make_patterns(lines: Lines, border: str) -> tuple[CreasePattern, ...]:
    """The sheets that a drawing means, in its order. border: one of BORDERS, how the sheet is found.

    Raises PatternError, with the notes so far: no line, no border.
    """
    if not lines.strokes:
        raise PatternError("the drawing has no line: all its strokes have no length", notes=lines.notes)
    coordinates = np.vstack([stroke.curve.points for stroke in lines.strokes])
    size = float(np.ptp(coordinates, axis=0).max())
    if not size > 0.0:
        raise PatternError("the drawing has no size: all its lines are one point", notes=lines.notes)
    try:
        strokes, twice = settle_same_lines(lines.strokes, JOIN * size)
        marked = any(stroke.decision.role in CREASE_ROLES for stroke in strokes)
        found = find_sheets(Search(strokes, lines.filled, lines.page, size, marked), border)
        notes = (*twice, *found.notes)
        return _patterns(lines, strokes, found, size, marked, notes)
    except PatternError as error:
        roles = Counter((s.decision.detail, s.decision.role.value, s.decision.why) for s in lines.strokes)
        raise error.with_notes((*_in_words(roles), *lines.notes)) from error


def _patterns(
    lines: Lines,
    strokes: Sequence[Stroke],
    found: Found,
    size: float,
    marked: bool,
    notes: Sequence[str],
) -> tuple[CreasePattern, ...]:
    """One pattern a sheet; what lies beside all of them is told with the first."""
    tree = shapely.STRtree(curve_lines([stroke.curve for stroke in strokes]))
    beside = set(range(len(strokes)))
    near: list[list[int]] = []
    for ring in found.sheets:
        grown = ring.polygon.buffer(JOIN * size)
        near.append(
            sorted({*tree.query(grown, predicate="intersects").tolist(), *ring.members} - found.unused.keys())
        )
        beside -= set(near[-1])
    apart = [_fated(strokes[i], found.unused.get(i, _BESIDE)) for i in sorted(beside)]
    on_paper = {i for ring, mine in zip(found.sheets, near, strict=True) for i in mine if i not in ring.members}
    looks = frozenset(strokes[i].decision.role for i in on_paper) & CREASE_ROLES
    patterns = []
    for number, (ring, mine) in enumerate(zip(found.sheets, near, strict=True), 1):
        local = {i: k for k, i in enumerate(mine)}
        own = replace(ring, members=frozenset(local[i] for i in ring.members))
        sheet = _Sheet([strokes[i] for i in mine], size, marked, looks)
        left_out = found.holes[number - 1] if found.holes else ()
        patterns.append(sheet.pattern(own, left_out, lines, [] if number > 1 else apart, notes))
    return tuple(patterns)


def _fated(stroke: Stroke, where: str) -> Stroke:
    """A stroke off the sheets: what it is called if it says so itself, else ``where`` it is."""
    if stroke.decision.role in _NO_PART:
        return replace(stroke, fate=_left_out(stroke))
    return replace(stroke, fate=f"left out: {where}")


def _left_out(stroke: Stroke) -> str:
    return "left out: " + ("facet line" if stroke.decision.role is Role.FACET else stroke.decision.word)


class _Sheet:
    """The decisions about the strokes of one sheet, step by step. Not reusable."""

    def __init__(self, strokes: Sequence[Stroke], size: float, marked: bool, looks: frozenset[Role]) -> None:
        self._strokes = list(strokes)
        self._size = size
        self._tolerance = JOIN * size
        #: Whether anything says "I am a crease"; otherwise black lines are the creases.
        self._marked = marked
        #: What creases of this sheet and of the others beside it say that they are.
        self._looks = looks

    def pattern(
        self,
        sheet: Ring,
        left_out: Sequence[Ring],
        lines: Lines,
        apart: Sequence[Stroke],
        notes: Sequence[str],
    ) -> CreasePattern:
        for i in sheet.members:
            self._settle(i, "border")
        self._cut_along(sheet)
        holes = self._find_holes(sheet, left_out)
        self._leave_out_far(sheet, holes)
        self._settle_rest(sheet, holes)
        creases, said = self._creases()
        fates = Counter((s.decision.detail, s.fate, s.decision.why) for s in (*self._strokes, *apart))
        return CreasePattern(
            sheet.points,
            [hole.points for hole in holes],
            creases,
            unit_mm=lines.unit_mm,
            notes=(*_in_words(fates), *notes, *said, *lines.notes),
            conflicts=(*lines.conflicts, *(s.conflict for s in self._strokes if s.conflict)),
        )

    # ---- small helpers

    def _open(self, *roles: Role) -> list[int]:
        """Strokes with these roles that nothing has been decided about yet."""
        return [i for i, s in enumerate(self._strokes) if not s.fate and s.decision.role in roles]

    def _settle(self, index: int, fate: str) -> None:
        self._strokes[index] = replace(self._strokes[index], fate=fate)

    @property
    def _all(self) -> list[Curve]:
        return [stroke.curve for stroke in self._strokes]

    # ---- the border

    def _cut_along(self, sheet: Ring) -> None:
        """Split the undecided edge strokes that run along the border for a while; what is on it is border."""
        band = sheet.polygon.exterior.buffer(2.0 * self._tolerance)
        shapely.prepare(band)
        mine = self._open(*EDGE_ROLES, Role.DARK)
        lines = curve_lines([self._strokes[i].curve for i in mine])
        for k in np.flatnonzero(shapely.intersects(band, lines)).tolist():
            i, whole = mine[k], lines[k]
            stroke = self._strokes[i]
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

    def _find_holes(self, sheet: Ring, left_out: Sequence[Ring]) -> list[Ring]:
        roles = (*EDGE_ROLES, Role.DARK) if self._marked else tuple(EDGE_ROLES)
        inside = sheet.polygon.buffer(-self._tolerance)
        shapely.prepare(inside)
        curves = self._all
        holes = list(left_out)
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
                # Lines that happen to enclose something on their way are not its outline.
                if self._covered(ring)
            ]
            holes = self._outermost(holes, rings)
        return holes

    def _covered(self, ring: Ring) -> bool:
        drawn = sum(shapely.length(curve_line(self._strokes[i].curve)) for i in ring.members)
        return bool(drawn >= _COVERED * ring.polygon.exterior.length)

    def _outermost(self, holes: list[Ring], rings: list[Ring]) -> list[Ring]:
        """``holes`` and those of ``rings`` outside them, larger ones first: what falls out has no holes."""
        kept = list(holes)
        for ring in sorted(rings, key=lambda ring: -ring.polygon.area):
            polygons = np.array([hole.polygon for hole in kept])
            # Holes may touch each other.
            if shapely.intersects(polygons, ring.polygon.buffer(-2.0 * self._tolerance)).any():
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
        """What has no part on the paper: the rest of a border stroke beside it, and what lies in a hole."""
        grown = sheet.polygon.buffer(self._tolerance)
        shapely.prepare(grown)
        gaps = shapely.union_all([hole.polygon.buffer(self._tolerance) for hole in holes])
        shapely.prepare(gaps)
        mine = self._open(*(set(Role) - _NO_PART))
        lines = curve_lines([self._strokes[i].curve for i in mine])
        on, fallen = shapely.intersects(grown, lines), shapely.covers(gaps, lines)
        for i, here, gone in zip(mine, on.tolist(), fallen.tolist(), strict=True):
            if not here:
                self._settle(i, f"left out: {_BESIDE}")
            elif gone:
                self._settle(i, "left out: inside a hole")

    def _settle_rest(self, sheet: Ring, holes: Sequence[Ring]) -> None:
        for i in self._open(*_NO_PART):
            self._settle(i, _left_out(self._strokes[i]))
        for i in self._open(Role.CUT, Role.HOLE):
            self._settle(i, "left out: a cut that does not close is not supported")
        for i in self._open(Role.BORDER):
            self._settle(i, "left out: not part of a closed outline")
        for i in self._open(Role.DARK):
            # Black beside marked creases is an edge of the paper, unless it would cut the sheet in two.
            if self._marked and not self._spans(self._strokes[i].curve, sheet, holes):
                self._settle(i, "left out: a cut inside the sheet, which is not supported yet")
            else:
                self._settle(i, "unassigned crease")
        pale = self._open(Role.PALE)
        other = self._marked or any(stroke.fate == "unassigned crease" for stroke in self._strokes)
        fate = "left out: auxiliary line, lighter than the creases" if other else "unassigned crease"
        for i in pale:
            self._settle(i, fate)

    def _spans(self, curve: Curve, sheet: Ring, holes: Sequence[Ring]) -> bool:
        """Whether a line runs from an edge of the paper to an edge."""
        if curve.closed:
            return False
        edges = shapely.multilinestrings([ring.polygon.exterior for ring in (sheet, *holes)])
        reach = _ALONG * self._size
        off = ~shapely.covers(sheet.polygon, shapely.points(curve.points[[0, -1]]))
        return bool((off | (shapely.distance(edges, shapely.points(curve.points[[0, -1]])) <= reach)).all())

    def _creases(self) -> tuple[list[Crease], list[str]]:
        marked = self._open(*CREASE_ROLES)
        plain = [i for i, stroke in enumerate(self._strokes) if stroke.fate == "unassigned crease"]
        # One look for all creases distinguishes nothing. Names are meant, also when there is but one.
        looks = all(self._strokes[i].decision.why in ("hue", "dash pattern") for i in marked)
        if marked and not plain and len(self._looks) == 1 and self._looks <= _LETTERS.keys() and looks:
            for i in marked:
                self._settle(i, "unassigned crease, since all creases look the same")
            plain, marked = marked, []
        letters = dict.fromkeys(plain, "U")
        for i in marked:
            role = self._strokes[i].decision.role
            letters[i] = _LETTERS.get(role, "U")
            self._settle(i, role.value)
        notes = [] if letters else [_NO_CREASE]
        faint = sum(self._strokes[i].opacity < 1.0 - 1e-9 for i in letters)
        if faint:
            notes.append(f"the opacity of {_count(faint, 'crease')} is not used (a fold angle in some programs)")
        creases = [
            Crease(s.curve.points, s.curve.closed, letters[i], s.name, s.curve.beziers)
            for i, s in enumerate(self._strokes)
            if i in letters
        ]
        return creases, notes


def _in_words(groups: Counter[tuple[str, str, str]]) -> list[str]:
    return [
        f"{_count(count, 'stroke')} {detail}: {_plural(fate, count)} ({why})"
        for (detail, fate, why), count in groups.items()
    ]


def _count(number: int, word: str) -> str:
    return f"{number:,} {word}" if number == 1 else f"{number:,} {word}s"


def _plural(fate: str, count: int) -> str:
    if count == 1 or fate.startswith("left out"):
        return fate
    head, comma, tail = fate.partition(",")
    return f"{head}s{comma}{tail}" if head.endswith(("crease", "hole")) else fate
