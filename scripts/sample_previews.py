"""Small square pictures of the samples for Blender's menu, from those in sample_patterns/pictures.

PYTHON-WITH-PILLOW scripts/sample_previews.py
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image

FOLDER = Path(__file__).resolve().parent.parent / "sample_patterns"
#: Side of a preview in pixels: what Blender shows of one on a screen of usual resolution.
SIDE = 128
#: Enough for paper, shadow and lines.
COLOURS = 96
#: The part of a half's width that holds sheet and shadow.
_SEEN = 0.9


def preview(picture: Image.Image) -> Image.Image:
    """The folded sheet, from the right half of a sample's picture, in a square with all of it."""
    whole = picture.convert("RGB")
    width, height = whole.size
    side = round(_SEEN * width / 2)
    square = Image.new("RGB", (side, side), whole.getpixel((0, 0)))
    square.paste(whole, (round(side / 2 - 0.75 * width), (side - height) // 2))
    return square.resize((SIDE, SIDE), Image.Resampling.LANCZOS).quantize(COLOURS, dither=Image.Dither.NONE)


def main() -> None:
    target = FOLDER / "previews"
    target.mkdir(exist_ok=True)
    for path in sorted((FOLDER / "pictures").glob("*.png")):
        with Image.open(path) as picture:
            preview(picture).save(target / path.name, "PNG", optimize=True)


if __name__ == "__main__":
    main()
