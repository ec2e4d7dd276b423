"""Many pictures on a sheet, each with its name below."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from .lettering import lettering
from .png import write_png

TILE_WIDTH = 320
TILE_HEIGHT = 240
LABEL_HEIGHT = 26
GAP = 10
ROW_HEIGHT = GAP + TILE_HEIGHT + LABEL_HEIGHT
LETTER_SCALE = 2
#: Ten rows of ten: 3,310 pixels wide.
TILES_ON_A_SHEET = 100

PAPER = 0.96
INK = 0.15
#: Where there is no picture.
BLANK = 0.82
NOTE_INK = (0.70, 0.10, 0.06)

Pixels = NDArray[np.float32]
Bytes = NDArray[np.uint8]


@dataclass(frozen=True)
class Tile:
    """One picture: its name, a note in red (empty for none), and the file, None when there is none."""

    label: str
    note: str
    picture: Path | None


def sheets(tiles: Sequence[Tile]) -> list[Sequence[Tile]]:
    """The tiles of each sheet: what is smaller than a tile, or more on one picture, nobody can look at."""
    return [tiles[k : k + TILES_ON_A_SHEET] for k in range(0, len(tiles), TILES_ON_A_SHEET)]


def save(path: Path, tiles: Sequence[Tile]) -> None:
    """Saves one sheet as a PNG file. A row of tiles is in memory at a time, and one picture."""
    columns = max(1, math.isqrt(len(tiles) - 1) + 1)
    rows = [tiles[k : k + columns] for k in range(0, len(tiles), columns)]
    width = columns * (TILE_WIDTH + GAP) + GAP
    height = len(rows) * ROW_HEIGHT + GAP
    write_png(path, width, height, _bands(rows, width))


def _bands(rows: Sequence[Sequence[Tile]], width: int) -> Iterator[Bytes]:
    for tiles in rows:
        yield _band(tiles, width)
    yield np.full((GAP, width, 3), _byte(PAPER), dtype=np.uint8)


def _band(tiles: Sequence[Tile], width: int) -> Bytes:
    """A row of tiles, (ROW_HEIGHT, width, 3) display colours, the uppermost row of pixels first."""
    band = np.full((ROW_HEIGHT, width, 3), _byte(PAPER), dtype=np.uint8)
    for k, tile in enumerate(tiles):
        y, x = GAP, GAP + k * (TILE_WIDTH + GAP)
        band[y : y + TILE_HEIGHT, x : x + TILE_WIDTH] = _byte(_fitted(tile.picture))
        below = band[y + TILE_HEIGHT + 6 : y + TILE_HEIGHT + LABEL_HEIGHT, x : x + TILE_WIDTH]
        _print(below, tile.label, (INK, INK, INK))
        if tile.note:
            _print(below[:, _text_width(tile.label) + 10 :], tile.note, NOTE_INK)
    return band


def _byte(colours: Pixels | float | tuple[float, ...]) -> Bytes:
    return (np.asarray(colours) * 255 + 0.5).clip(0, 255).astype(np.uint8)


def _print(target: Bytes, text: str, ink: tuple[float, float, float]) -> None:
    letters = lettering(text, LETTER_SCALE, target.shape[1])
    target[: letters.shape[0], : letters.shape[1]][letters] = _byte(ink)


def _text_width(text: str) -> int:
    return lettering(text, LETTER_SCALE, TILE_WIDTH).shape[1]


def _fitted(picture: Path | None) -> Pixels:
    """A picture made smaller to fit its tile, in the middle of it."""
    tile = np.full((TILE_HEIGHT, TILE_WIDTH, 3), BLANK, dtype=np.float32)
    if picture is None:
        return tile
    pixels = _read(picture)
    if not pixels.size:  # no picture, whatever it is called
        return tile
    factor = min(TILE_HEIGHT / pixels.shape[0], TILE_WIDTH / pixels.shape[1], 1.0)
    height = max(1, round(pixels.shape[0] * factor))
    width = max(1, round(pixels.shape[1] * factor))
    small = _averaged(_averaged(pixels, height, 0), width, 1)
    y, x = (TILE_HEIGHT - height) // 2, (TILE_WIDTH - width) // 2
    tile[y : y + height, x : x + width] = small
    return tile


def _read(path: Path) -> Pixels:
    image: Any = bpy.data.images.load(str(path))
    try:
        width, height = image.size
        pixels = np.empty(width * height * 4, dtype=np.float32)
        image.pixels.foreach_get(pixels)
        # The last row of Blender's is the highest. A file of bytes comes as it is, in display colours.
        return pixels.reshape(height, width, 4)[::-1, :, :3]
    finally:
        bpy.data.images.remove(image)


def _averaged(pixels: Pixels, count: int, axis: int) -> Pixels:
    """Fewer pixels along an axis, each the mean of those it stands for."""
    edges = np.arange(count + 1) * pixels.shape[axis] // count
    sums = np.add.reduceat(pixels, edges[:-1], axis=axis)
    shape = [1, 1, 1]
    shape[axis] = count
    means: Pixels = sums / np.diff(edges).astype(np.float32).reshape(shape)
    return means
