"""The sheet of small pictures."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def sheets(extension):
    return extension("curvefold_addon.bridge.contact_sheet")


def picture(path, width, height, color):
    image = bpy.data.images.new("made", width, height)
    image.pixels.foreach_set(np.tile(np.array([*color, 1.0], dtype=np.float32), width * height))
    image.filepath_raw = str(path)
    image.file_format = "PNG"
    image.save()
    return path


def test_pictures_are_fitted_and_keep_their_colours(sheets, tmp_path):
    red = picture(tmp_path / "red.png", 640, 480, (0.8, 0.2, 0.2))
    tall = picture(tmp_path / "tall.png", 300, 701, (0.2, 0.8, 0.2))
    tiles = [
        sheets.Tile("red", "", red), sheets.Tile("tall", "", tall), sheets.Tile("gone", "failed", None)
    ]  # fmt: skip
    sheets.save(tmp_path / "sheet.png", tiles)
    image = bpy.data.images.load(str(tmp_path / "sheet.png"))
    width, height = image.size
    pixels = np.array(image.pixels[:]).reshape(height, width, 4)[::-1, :, :3]
    y, x = sheets.GAP + sheets.TILE_HEIGHT // 2, sheets.GAP + sheets.TILE_WIDTH // 2
    step = sheets.TILE_WIDTH + sheets.GAP
    assert pixels[y, x] == pytest.approx([0.8, 0.2, 0.2], abs=0.01)
    assert pixels[y, x + step] == pytest.approx([0.2, 0.8, 0.2], abs=0.01)
    assert pixels[y, sheets.GAP + step + 5] == pytest.approx([sheets.BLANK] * 3, abs=0.01)
    label = pixels[sheets.GAP + sheets.TILE_HEIGHT + 2 : sheets.GAP + sheets.TILE_HEIGHT + sheets.LABEL_HEIGHT]
    assert label[:, sheets.GAP : sheets.GAP + 60].min() < 0.3


@pytest.mark.parametrize("count", [1, 2, 5, 17])
def test_any_number(sheets, count):
    sheet = sheets.compose(
        [sheets.Tile("a name that is far too long to fit below it " * 3, "failed", None)] * count
    )
    assert sheet.shape[0] * sheet.shape[1] >= count * sheets.TILE_WIDTH * sheets.TILE_HEIGHT


def test_letters(extension):
    lettering = extension("curvefold_addon.bridge.lettering").lettering
    assert lettering("I", 1, 100).shape == (5, 5)
    assert lettering("il", 2, 100).shape[0] == 10
    assert np.array_equal(lettering("é", 1, 100), lettering("-", 1, 100))
    assert lettering("abc", 1, 4).shape == (5, 4)
