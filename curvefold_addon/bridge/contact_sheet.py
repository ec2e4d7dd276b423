"""Many pictures on one sheet, each with its name below."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from .lettering import lettering

TILE_WIDTH = 320
TILE_HEIGHT = 240
LABEL_HEIGHT = 26
GAP = 10
LETTER_SCALE = 2

PAPER = 0.96
INK = 0.15
#: Where there is no picture.
BLANK = 0.82
NOTE_INK = (0.70, 0.10, 0.06)

Pixels = NDArray[np.float32]


@dataclass(frozen=True)
class Tile:
    """One picture: its name, a note in red (empty for none), and the file, None when there is none."""

    label: str
    note: str
    picture: Path | None


def save(path: Path, tiles: Sequence[Tile]) -> None:
    """Saves the sheet as a PNG file."""
    sheet = compose(tiles)
    height, width = sheet.shape[:2]
    image = bpy.data.images.new("Curvefold contact sheet", width, height)
    try:
        rgba = np.ones((height, width, 4), dtype=np.float32)
        # Blender's first row is the lowest.
        rgba[:, :, :3] = sheet[::-1]
        image.pixels.foreach_set(rgba.ravel())
        image.filepath_raw = str(path)
        image.file_format = "PNG"
        image.save()
    finally:
        bpy.data.images.remove(image)


def compose(tiles: Sequence[Tile]) -> Pixels:
    """(height, width, 3) display colours, top row first."""
    columns = max(1, int(np.ceil(np.sqrt(len(tiles)))))
    rows = max(1, -(-len(tiles) // columns))
    step_x, step_y = TILE_WIDTH + GAP, TILE_HEIGHT + LABEL_HEIGHT + GAP
    sheet = np.full((rows * step_y + GAP, columns * step_x + GAP, 3), PAPER, dtype=np.float32)
    for k, tile in enumerate(tiles):
        y, x = GAP + (k // columns) * step_y, GAP + (k % columns) * step_x
        sheet[y : y + TILE_HEIGHT, x : x + TILE_WIDTH] = _fitted(tile.picture)
        below = sheet[y + TILE_HEIGHT + 6 : y + TILE_HEIGHT + LABEL_HEIGHT, x : x + TILE_WIDTH]
        _print(below, tile.label, (INK, INK, INK))
        if tile.note:
            _print(below[:, _text_width(tile.label) + 10 :], tile.note, NOTE_INK)
    return sheet


def _print(target: Pixels, text: str, ink: tuple[float, float, float]) -> None:
    letters = lettering(text, LETTER_SCALE, target.shape[1])
    target[: letters.shape[0], : letters.shape[1]][letters] = ink


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
