"""Which outlines of a drawing are sheets of paper: drawn ones, several of them, or else the page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from ..arrays import FloatArray
from ..errors import PatternError
from .near_lines import Geometries
from .rings import JOIN, Gap, Ring, curve_lines, loose_ends, outer_rings, touching_groups
from .segments import Curve
from .stroke import CREASE_ROLES, EDGE_ROLES, Role, Stroke

#: How much of the creases (by length) closed outlines must hold to be the border. Strokes that say they are
#: an edge need less agreement than black ones, these less than a drawing in which nothing says anything.
_SHARE_NAMED = 0.9
_SHARE_BLACK = 0.5
_SHARE_ANY = 0.95
#: Where nothing says anything, outlines that all other lines are inside or beside need to hold this share of them:
#: dimensions and texts stand beside a sheet.
_SHARE_APART = 0.3
#: An outline inside another one that holds this share of the creases is the sheet, and the outer one a frame.
_SHARE_FRAMED = 0.99
#: Frames with several outlines in them that are looked through one in the other; real drawings have two at most.
_MOST_NESTED = 10
#: How far ends of a border may be apart, parts of the drawing's longer side: as near as ends are joined anyway, as
#: far as ends of creases are snapped, and where nothing else closes in steps up to what nobody draws as a gap.
_REACHES = (JOIN, 2e-3, 5e-3, 1e-2, 2e-2)
#: The page holds less than this share of what is drawn when the drawing has slipped off it.
_SHARE_PAGE = 0.5
#: Evidence that a line is a crease which does not keep it from being the border, when nothing else is.
_MILD = ("hue", "dash pattern", "edges_assignment")
#: Sheets of one file. A drawing of more outlines is no drawing of sheets.
MAX_SHEETS = 500


@dataclass(frozen=True, eq=False)
class Found:
    """The sheets of a drawing, in the order of the strokes that they are made of.

    unused  strokes that are outlines of no sheet: index -> what each is
    holes   of each sheet that is a filled shape, what the shape leaves out; empty where sheets are drawn
    notes   why these are the sheets
    """

    sheets: tuple[Ring, ...]
    unused: Mapping[int, str] = field(default_factory=dict)
    holes: tuple[tuple[Ring, ...], ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Search:
    """What sheets are searched in.

    strokes  of the drawing
    filled   of each shape that is filled and not stroked, its closed outlines (P,2)
    page     x and y minimum, x and y maximum, or None
    size     longer side of the drawing
    marked   whether anything says "I am a crease"; otherwise black lines are the creases
    """

    strokes: Sequence[Stroke]
    filled: Sequence[Sequence[FloatArray]]
    page: tuple[float, float, float, float] | None
    size: float
    marked: bool
    curves: list[Curve] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.curves.extend(stroke.curve for stroke in self.strokes)

    @property
    def tolerance(self) -> float:
        return JOIN * self.size

    def having(self, roles: Iterable[Role]) -> list[int]:
        """Indices of the strokes with these roles."""
        wanted = set(roles)
        return [i for i, stroke in enumerate(self.strokes) if stroke.decision.role in wanted]

    def some(self, indices: Iterable[int]) -> list[Curve]:
        return [self.curves[i] for i in indices]


def find_sheets(search: Search, border: str) -> Found:
    """The sheets. border: "auto", "outline" or "page". Raises PatternError, with the place of an open border."""
    if border == "page":
        page = _page(search, "the page is the sheet, as asked")
        outlines = _outlines_on_page(search, page.sheets[0])
        return replace(page, unused=dict.fromkeys(outlines, "an outline on the page, which is the sheet"))
    # A border that is open by a little is meant before what is painted behind it, and before its page.
    for reach in _REACHES:
        found = _drawn(search, reach)
        if found is not None:
            return found
    found = _filled(search, _objects(search))
    if found is not None:
        return found
    for reach in _REACHES[:2]:
        found = _outermost(search, reach)
        if found is not None:
            return found
    found = _filled(search, search.filled)
    if found is not None:
        return found
    gap = _open_place(search)
    if gap is not None:
        x, y = gap.place.tolist()
        raise PatternError(
            f"the border does not close: it is open by {gap.width:.4g}; close it, or choose the page as the sheet",
            element="border",
            place=(x, y),
        )
    if border == "outline":
        raise PatternError(
            "no border found: no closed outline holds the creases; draw one, or choose the page as the sheet"
        )
    return _page(search, "no border is drawn: the page is the sheet")


# ---- drawn outlines


def _drawn(search: Search, reach: float) -> Found | None:
    """Outlines of strokes that say they are an edge, then with black ones, then with grey ones."""
    edges, dark, pale = search.having(EDGE_ROLES), search.having([Role.DARK]), search.having([Role.PALE])
    creases = search.having(CREASE_ROLES)
    dark_share = _SHARE_BLACK if search.marked else _SHARE_ANY
    attempts = [
        (edges, _SHARE_NAMED, ""),
        (edges + dark, dark_share, ""),
        (edges + dark + pale, dark_share, "the border is grey: no darker outline holds the creases"),
        (search.having([Role.BORDER]), _SHARE_BLACK, ""),
    ]
    tried: set[tuple[int, float]] = set()
    for candidates, share, explained in attempts:
        if not candidates or (len(candidates), share) in tried:
            continue
        tried.add((len(candidates), share))
        # Without marked creases all strokes that are not the outlines themselves have to be inside.
        inside = creases if search.marked else [*edges, *dark, *pale]
        rings = _holding(search, candidates, inside, share, reach)
        if rings:
            frames: frozenset[int] = frozenset()
            if candidates is not edges:
                rings, frames = _without_frames(search, rings, candidates)
            return _found(rings, explained, dict.fromkeys(frames, "a frame around the sheet"))
    return None


def _outermost(search: Search, reach: float) -> Found | None:
    """The outermost outlines of all lines, where no stroke says that it is an edge."""
    told = {i for i in search.having(CREASE_ROLES) if search.strokes[i].decision.why not in _MILD}
    lines = [i for i in search.having(set(Role) - {Role.ASIDE, Role.FACET}) if i not in told]
    explained = "the border is the outermost closed outline, since no stroke says that it is one"
    for candidates in (lines, [*lines, *search.having([Role.FACET])]):
        rings = _holding(search, candidates, [*candidates, *told], _SHARE_ANY, reach)
        on_rings = frozenset().union(*(ring.members for ring in rings))
        # A closed crease that holds nothing is no sheet if there is a page for it to be drawn on.
        alone = search.marked and search.page is not None and len(on_rings) == len(candidates) + len(told)
        if rings and not alone:
            return _found(rings, explained)
    return None


def _holding(
    search: Search, candidates: Sequence[int], inside: Sequence[int], share: float, reach: float
) -> list[Ring]:
    """The outlines of ``candidates`` that hold ``share`` of the lines ``inside`` together: those that hold any."""
    if not candidates:
        return []
    rings = outer_rings(search.curves, candidates, search.size, reach)[:MAX_SHEETS]
    if not rings:
        return []
    on_rings = frozenset().union(*(ring.members for ring in rings))
    lines = curve_lines([search.curves[i] for i in inside if i not in on_rings])
    if not len(lines):
        return rings
    total = float(shapely.length(lines).sum())
    tree = shapely.STRtree(lines)
    grown = [ring.polygon.buffer(search.tolerance) for ring in rings]
    held = np.array([_length_inside(polygon, lines, tree) for polygon in grown])
    if held.sum() < share * total and (
        search.marked or held.sum() < _SHARE_APART * total or _crossed(grown, lines) > (1.0 - share) * total
    ):
        return []
    return [ring for ring, length in zip(rings, held.tolist(), strict=True) if length > search.tolerance]


def _crossed(polygons: Sequence[shapely.Polygon], lines: Geometries) -> float:
    """The length of the lines that are neither wholly inside one of the polygons nor wholly outside all."""
    union = shapely.union_all(polygons)
    shapely.prepare(union)
    apart = shapely.covers(union, lines) | ~shapely.intersects(union, lines)
    return float(shapely.length(lines[~apart]).sum())


def _length_inside(polygon: shapely.Polygon, lines: Geometries, tree: shapely.STRtree) -> float:
    shapely.prepare(polygon)
    near = lines[tree.query(polygon)]
    whole = shapely.covers(polygon, near)
    cut = near[~whole & shapely.intersects(polygon, near)]
    return float(shapely.length(near[whole]).sum() + shapely.length(shapely.intersection(cut, polygon)).sum())


def _without_frames(
    search: Search, rings: list[Ring], candidates: Sequence[int]
) -> tuple[list[Ring], frozenset[int]]:
    """The innermost outlines that still hold all marked creases: whatever is around them is a frame."""
    creases = np.array(search.having(CREASE_ROLES), dtype=np.int64)
    if not len(creases):
        return rings, frozenset()
    lines = curve_lines(search.some(creases))
    tree = shapely.STRtree(curve_lines(search.some(candidates)))
    kept: list[Ring] = []
    frames: set[int] = set()
    waiting = [(ring, 0) for ring in reversed(rings)]
    while waiting:
        ring, depth = waiting.pop()
        around = ring.members | frames
        near = np.sort(tree.query(ring.polygon, predicate="intersects")).tolist()
        rest = [candidates[k] for k in near if candidates[k] not in around]
        mine = lines[shapely.intersects(ring.polygon, lines)]
        for reach in _REACHES if rest and depth < _MOST_NESTED else ():
            inner, others = _innermost(search, rest, mine, _SHARE_FRAMED, reach, ring)
            if inner:
                frames |= ring.members | others
                waiting.extend((one, depth + 1) for one in reversed(inner))
                break
        else:
            kept.append(ring)
    return kept, frozenset(frames)


def _innermost(
    search: Search, candidates: Sequence[int], lines: Geometries, share: float, reach: float, sheet: Ring
) -> tuple[list[Ring], frozenset[int]]:
    """Outlines inside ``sheet`` that hold ``share`` of ``lines``, and the strokes of those around them.

    The smallest one that holds as much alone, or else the outermost ones that do together.
    """
    if not len(lines):
        return [], frozenset()
    tree = shapely.STRtree(lines)
    enough = share * float(shapely.length(lines).sum())
    held: list[tuple[Ring, float]] = []
    for group in touching_groups(search.curves, candidates, reach * search.size):
        box = shapely.box(*shapely.total_bounds(curve_lines(search.some(group))))
        if not len(tree.query(box)):
            continue
        for ring in outer_rings(search.curves, group, search.size, reach):
            apart = shapely.distance(ring.polygon.exterior, sheet.polygon.exterior) > search.tolerance
            if ring.polygon.area < sheet.polygon.area and apart:
                held.append((ring, _length_inside(ring.polygon.buffer(search.tolerance), lines, tree)))
    alone = sorted((ring for ring, length in held if length >= enough), key=lambda ring: ring.polygon.area)
    if alone:
        return alone[:1], frozenset().union(*(ring.members for ring in alone[1:])) - alone[0].members
    rings = _outermost_of([ring for ring, length in held if length > search.tolerance])
    outermost = set(rings)
    total = sum(length for ring, length in held if ring in outermost)
    return (rings if total >= enough else []), frozenset()


def _outermost_of(rings: Sequence[Ring]) -> list[Ring]:
    """Those of outlines that do not cross each other which are inside none of the others, largest first."""
    kept: list[Ring] = []
    for ring in sorted(rings, key=lambda ring: -ring.polygon.area):
        if not shapely.covers(np.array([other.polygon for other in kept]), ring.polygon).any():
            shapely.prepare(ring.polygon)
            kept.append(ring)
    return kept


def _outlines_on_page(search: Search, page: Ring) -> frozenset[int]:
    """Strokes inside the page that close around creases: no sheets, as asked, and no holes, as creases are in them.

    Black ones are edges only beside marked creases.
    """
    left = search.having([*EDGE_ROLES, Role.DARK] if search.marked else EDGE_ROLES)
    left = [i for i in left if i not in page.members]
    lines = curve_lines(search.some(search.having(CREASE_ROLES if search.marked else [Role.DARK, Role.PALE])))
    found: set[int] = set()
    for _ in range(_MOST_NESTED):
        rings, others = _innermost(search, left, lines, _SHARE_BLACK, JOIN, page)
        if not rings:
            break
        found |= others.union(*(ring.members for ring in rings))
        left = [i for i in left if i not in found]
    return frozenset(found)


def _found(rings: Sequence[Ring], explained: str, unused: Mapping[int, str] | None = None) -> Found:
    notes = [explained] if explained else []
    for ring in rings:
        for gap in ring.gaps:
            x, y = gap.place.tolist()
            notes.append(f"the border was open by {gap.width:.4g} near ({x:.4g}, {y:.4g}) and was closed there")
    ordered = sorted(rings, key=lambda ring: min(ring.members, default=0))
    return Found(tuple(ordered), unused or {}, notes=tuple(notes))


# ---- no drawn outline


def _objects(search: Search) -> list[Sequence[FloatArray]]:
    """The filled shapes without those that paint the whole page, as slides and artboards do."""
    if search.page is None:
        return list(search.filled)
    page = shapely.box(*search.page).buffer(-search.tolerance)
    areas = map(_painted, search.filled)
    return [
        shape
        for shape, area in zip(search.filled, areas, strict=True)
        if area is None or not shapely.covers(area, page)
    ]


def _filled(search: Search, shapes: Sequence[Sequence[FloatArray]]) -> Found | None:
    """The smallest filled shape that holds the creases, or the shapes that hold them together."""
    chosen = search.having(CREASE_ROLES) or search.having([Role.DARK, Role.PALE])
    lines = curve_lines(search.some(chosen))
    if not len(lines) or not shapes:
        return None
    total = float(shapely.length(lines).sum())
    tree = shapely.STRtree(lines)
    areas = [area for area in map(_painted, shapes) if area is not None and area.area > search.tolerance**2]
    held = [_length_inside(area.buffer(search.tolerance), lines, tree) / total for area in areas]
    single = [k for k, share in enumerate(held) if share >= _SHARE_NAMED]
    if single:
        sheets = [areas[min(single, key=lambda k: (held[k] < _SHARE_FRAMED, areas[k].area))]]
    else:
        sheets = [area for area, share in zip(areas, held, strict=True) if share * total > search.tolerance]
        apart = float(shapely.union_all(sheets).area) > _SHARE_FRAMED * sum(area.area for area in sheets)
        if sum(held) < _SHARE_NAMED or not apart:
            return None
    why = "the border is a filled shape without a stroke: no stroke closes around the creases"
    return Found(
        tuple(_ring(sheet.exterior) for sheet in sheets),
        holes=tuple(tuple(_ring(hole) for hole in sheet.interiors) for sheet in sheets),
        notes=(why,),
    )


def _painted(outlines: Sequence[FloatArray]) -> shapely.Polygon | None:
    """What a shape of one or several closed outlines paints, where that is one piece: inner outlines are holes."""
    rings = sorted((shapely.Polygon(points) for points in outlines), key=lambda ring: -ring.area)
    if not all(ring.is_valid for ring in rings):
        return None
    area = rings[0].difference(shapely.union_all(rings[1:])) if len(rings) > 1 else rings[0]
    return area if isinstance(area, shapely.Polygon) and not area.is_empty else None


def _ring(line: shapely.LinearRing) -> Ring:
    points = shapely.get_coordinates(line)[:-1]
    return Ring(points, shapely.Polygon(points), frozenset())


def _open_place(search: Search) -> Gap | None:
    """Where a border is open that would hold the creases if it were closed, and how wide; None without one."""
    edges = search.having(EDGE_ROLES)
    candidates = edges + search.having([Role.DARK]) if search.marked or edges else []
    creases = curve_lines(search.some(search.having(CREASE_ROLES)))
    if not len(creases):
        return None
    total, tree = float(shapely.length(creases).sum()), shapely.STRtree(creases)
    for group in touching_groups(search.curves, candidates, search.tolerance):
        curves = search.some(i for i in group if not search.curves[i].closed)
        if not curves:
            continue
        ends = np.vstack([curve.points[[0, -1]] for curve in curves])
        loose = loose_ends(ends, search.tolerance)
        if len(loose) != 2:
            continue
        a, b = ends[loose]
        closing = Curve(np.array([a, b]), False, None)
        for ring in outer_rings([*curves, closing], range(len(curves) + 1), search.size)[:1]:
            held = _length_inside(ring.polygon.buffer(search.tolerance), creases, tree)
            if held >= _SHARE_NAMED * total:
                return Gap(0.5 * (a + b), float(np.hypot(*(b - a))))
    return None


def _page(search: Search, explained: str) -> Found:
    """The page, or the box of what is drawn where there is none or the drawing lies beside it."""
    drawn = search.having(set(Role) - {Role.ASIDE})
    lines = curve_lines(search.some(drawn))
    box, where = search.page, "the page"
    if box is not None and len(lines):
        page = shapely.box(*box)
        inside = float(shapely.length(shapely.intersection(lines, page)).sum())
        if inside < _SHARE_PAGE * float(shapely.length(lines).sum()):
            box = None
            explained = explained.replace("the page is", "the drawing lies off its page, and its own box is")
    elif box is None:
        explained = explained.replace("the page is", "the file has no page, and the box of what is drawn is")
    if box is None:
        where, box = "the box", tuple(shapely.total_bounds(lines).tolist())
    x0, y0, x1, y1 = box
    if not (x1 - x0 > search.tolerance and y1 - y0 > search.tolerance):
        raise PatternError(f"no border found: none is drawn, and {where} has no area")
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    polygon = shapely.Polygon(corners)
    band = polygon.exterior.buffer(2.0 * search.tolerance)
    shapely.prepare(band)
    members = np.array(drawn, dtype=np.int64)[shapely.covers(band, lines)].tolist()
    size = f"{x1 - x0:.4g} × {y1 - y0:.4g}"
    return Found((Ring(corners, polygon, frozenset(members)),), notes=(f"{explained} ({size})",))
