"""A page on several sheets of paper: with an overlap, crosses to lay them over each other, a bar and a map."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..errors import DescriptionError
from .clip import Box, clipped
from .data import Kind
from .lettering import lettering, width_of
from .marks import cross
from .pen import Page, PageLayer
from .pieces import Line, Motion
from .profile import PAPERS, Layer, Profile
from .walk import Walk

#: Sheets of paper that are made at most.
MAX_TILES = 100
#: Below the drawing a strip of this height holds the bar and the page's number, mm.
_STRIP = 15.0
#: The bar, its ticks, and the height of letters, mm.
_BAR, _TICK, _LETTER = 100.0, 10.0, 3.0
#: Crosses where pages overlap, mm.
_CROSS = 3.0
#: What is drawn around pages where a profile says nothing of it.
_FRAME = Layer("frame", (Kind.FRAME, Kind.REGISTRATION), "#808080", 0.15)

Lines = list[tuple[Walk, str]]


@dataclass(frozen=True)
class _Lattice:
    """How tiles lie on the drawing, mm. window: width and height of what a tile shows; origin: of the first one."""

    paper: tuple[float, float]
    window: tuple[float, float]
    step: tuple[float, float]
    columns: int
    rows: int
    origin: complex

    def corner(self, row: int, column: int) -> complex:
        """The lowest left corner of a tile on the drawing; rows count from above."""
        return self.origin + complex(column * self.step[0], (self.rows - 1 - row) * self.step[1])

    @property
    def count(self) -> int:
        return self.columns * self.rows


def tiled(page: Page, profile: Profile, title: str) -> list[Page]:
    """The page at its true size on sheets of paper, and before them a map where there are several.

    Raises DescriptionError where the paper is too small.
    """
    short, long = PAPERS[profile.tile]
    # Of two ways with as many pages the first one is taken: that in which the drawing lies itself.
    ways = [(long, short), (short, long)] if page.width > page.height else [(short, long), (long, short)]
    lattice = min((_lattice(page, profile, paper) for paper in ways), key=lambda one: one.count)
    if lattice.count > MAX_TILES:
        raise DescriptionError(
            f"the sheet of {page.width:.0f} mm by {page.height:.0f} mm needs {lattice.count:,} pages of "
            f"{profile.tile}, and {MAX_TILES} are made at most; choose larger paper"
        )
    frame = next((layer for layer in profile.layers if Kind.FRAME in layer.kinds), _FRAME)
    pages = [] if lattice.count == 1 else [_map_page(page, profile, lattice, frame, title)]
    for row in range(lattice.rows):
        for column in range(lattice.columns):
            pages.append(_tile(page, profile, lattice, frame, title, row, column))
    return pages


def _lattice(page: Page, profile: Profile, paper: tuple[float, float]) -> _Lattice:
    edge, overlap = profile.page_margin_mm, profile.tile_overlap_mm
    window = (paper[0] - 2 * edge, paper[1] - 2 * edge - _STRIP)
    step = (window[0] - overlap, window[1] - overlap)
    if min(step) <= overlap:
        raise DescriptionError(
            f"a margin of {edge:g} mm and an overlap of {overlap:g} mm leave too little of {profile.tile} paper"
        )
    columns = max(math.ceil((page.width - overlap - 1e-6) / step[0]), 1)
    rows = max(math.ceil((page.height - overlap - 1e-6) / step[1]), 1)
    spare_x = columns * step[0] + overlap - page.width
    spare_y = rows * step[1] + overlap - page.height
    return _Lattice(paper, window, step, columns, rows, complex(-0.5 * spare_x, -0.5 * spare_y))


def _tile(page: Page, profile: Profile, lattice: _Lattice, frame: Layer, title: str, row: int, column: int) -> Page:
    corner = lattice.corner(row, column)
    edge = profile.page_margin_mm
    low = complex(edge, edge + _STRIP)
    motion = Motion(shift=low - corner)
    box = (low.real, low.imag, low.real + lattice.window[0], low.imag + lattice.window[1])
    layers = [_clipped_layer(part, motion, box) for part in page.layers]
    around: Lines = [(_rectangle(box), "edge of the page")] if lattice.count > 1 else []
    if lattice.count > 1 and profile.registration:
        around += [
            (part, "registration")
            for at in _crosses(lattice, profile.tile_overlap_mm)
            for walk in cross(motion.at(at), _CROSS)
            for part in clipped(walk, box)
        ]
    label = (
        f"ROW {row + 1} OF {lattice.rows}, COLUMN {column + 1} OF {lattice.columns}" if lattice.count > 1 else ""
    )
    around += _strip(complex(edge, edge), lattice.window[0], label, title)
    name = f"{row + 1}-{column + 1}" if lattice.count > 1 else ""
    layers.append(PageLayer(frame, tuple(around)))
    return Page(name, *lattice.paper, _merged(layers))


def _clipped_layer(part: PageLayer, motion: Motion, box: Box) -> PageLayer:
    lines = [(piece, name) for walk, name in part.lines for piece in clipped(walk.moved(motion), box)]
    return PageLayer(part.layer, tuple(lines))


def _merged(layers: list[PageLayer]) -> tuple[PageLayer, ...]:
    """Layers that have lines, each once."""
    found: dict[str, PageLayer] = {}
    for part in layers:
        if part.lines:
            known = found.get(part.layer.name)
            found[part.layer.name] = replace(part, lines=(*(known.lines if known else ()), *part.lines))
    return tuple(found.values())


def _crosses(lattice: _Lattice, overlap: float) -> list[complex]:
    """The middles of all overlaps, on the drawing."""
    half = complex(overlap, overlap) / 2
    return [
        lattice.origin + half + complex(column * lattice.step[0], row * lattice.step[1])
        for column in range(lattice.columns + 1)
        for row in range(lattice.rows + 1)
    ]


def _strip(at: complex, width: float, label: str, title: str) -> Lines:
    """The bar of 100 mm with what it measures, and which page of what this is."""
    found: Lines = [(Walk((Line(at, at + _BAR),)), "bar of 100 mm")]
    for k in range(int(_BAR / _TICK) + 1):
        tick = at + k * _TICK
        found.append((Walk((Line(tick, tick + 1j * (3.0 if k % 5 == 0 else 1.5)),)), "bar of 100 mm"))
    found += _words("100 MM, PRINTED AT 100 %", at + 4.2j, _LETTER)
    text = ": ".join(part for part in (title, label) if part)
    height = min(_LETTER, _LETTER * width / width_of(text, _LETTER)) if text else _LETTER
    found += _words(text, at + 8.5j, height)
    return found


def _words(text: str, at: complex, height: float) -> Lines:
    return [(walk, "words") for walk in lettering(text, at, height)]


def _rectangle(box: Box) -> Walk:
    low_x, low_y, high_x, high_y = box
    corners = [complex(low_x, low_y), complex(high_x, low_y), complex(high_x, high_y), complex(low_x, high_y)]
    return Walk(tuple(Line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)), True)


def _map_page(page: Page, profile: Profile, lattice: _Lattice, frame: Layer, title: str) -> Page:
    """The whole drawing, small, with the tiles' edges and numbers."""
    edge = profile.page_margin_mm
    whole = (
        (lattice.columns - 1) * lattice.step[0] + lattice.window[0],
        (lattice.rows - 1) * lattice.step[1] + lattice.window[1],
    )
    scale = min(lattice.window[0] / whole[0], lattice.window[1] / whole[1], 1.0)
    motion = Motion(scale, complex(edge, edge + _STRIP) - scale * lattice.origin)
    layers = [
        PageLayer(part.layer, tuple((walk.moved(motion), name) for walk, name in part.lines))
        for part in page.layers
    ]
    around: Lines = []
    for row in range(lattice.rows):
        for column in range(lattice.columns):
            corner = motion.at(lattice.corner(row, column))
            width, height = (scale * side for side in lattice.window)
            around.append(
                (_rectangle((corner.real, corner.imag, corner.real + width, corner.imag + height)), "page")
            )
            text = f"{row + 1}-{column + 1}"
            size = min(5.0, 0.2 * height)
            around += _words(text, corner + complex(0.5 * size, height - 1.5 * size), size)
    around += _words("MAP OF THE PAGES: ROW - COLUMN", complex(edge, edge + 4.0), _LETTER)
    around += _words(title, complex(edge, edge), _LETTER)
    layers.append(PageLayer(frame, tuple(around)))
    return Page("map", *lattice.paper, _merged(layers))
