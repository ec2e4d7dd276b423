"""The sheet of small pictures."""

import tracemalloc

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
def test_any_number(sheets, tmp_path, count):
    tile = sheets.Tile("a name that is far too long to fit below it " * 3, "failed", None)
    sheets.save(tmp_path / "sheet.png", [tile] * count)
    width, height = bpy.data.images.load(str(tmp_path / "sheet.png")).size
    assert width * height >= count * sheets.TILE_WIDTH * sheets.TILE_HEIGHT


def test_a_sheet_holds_so_many_that_each_can_be_looked_at(sheets):
    tiles = [sheets.Tile(str(k), "", None) for k in range(250)]
    assert [len(some) for some in sheets.sheets(tiles)] == [100, 100, 50]
    assert [tile for some in sheets.sheets(tiles) for tile in some] == tiles


def test_memory_does_not_grow_with_the_number_of_drawings(sheets, tmp_path):
    """A row of tiles and one picture at a time; no picture stays loaded."""
    red = picture(tmp_path / "red.png", 320, 240, (0.8, 0.2, 0.2))
    bpy.data.images.remove(bpy.data.images["made"])
    before = set(bpy.data.images)
    tiles = [sheets.Tile("red", "", red)] * 100
    sheets.save(tmp_path / "sheet.png", tiles[:4])  # what is made once
    tracemalloc.start()
    sheets.save(tmp_path / "sheet.png", tiles)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 0.2e6 * len(tiles)  # bytes; the pixels alone are 0.27e6 each
    assert set(bpy.data.images) == before


def test_a_picture_is_what_its_bands_are(extension, tmp_path):
    pixels = np.random.default_rng(0).integers(0, 256, (37, 19, 3), dtype=np.uint8)
    write_png = extension("curvefold_addon.bridge.png").write_png
    write_png(tmp_path / "noise.png", 19, 37, [pixels[:10], pixels[10:11], pixels[11:]])
    image = bpy.data.images.load(str(tmp_path / "noise.png"))
    read = np.array(image.pixels[:]).reshape(37, 19, 4)[::-1, :, :3]
    assert np.array_equal(np.round(read * 255), pixels)


def test_letters(extension):
    lettering = extension("curvefold_addon.bridge.lettering").lettering
    assert lettering("I", 1, 100).shape == (5, 5)
    assert lettering("il", 2, 100).shape[0] == 10
    assert np.array_equal(lettering("é", 1, 100), lettering("-", 1, 100))
    assert lettering("abc", 1, 4).shape == (5, 4)
