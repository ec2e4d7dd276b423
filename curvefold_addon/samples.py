"""The sample drawings that come with the extension, and their pictures."""

from pathlib import Path

import bpy.utils.previews

FOLDER = Path(__file__).parent.parent / "sample_patterns"

_previews: bpy.utils.previews.ImagePreviewCollection | None = None


def names() -> list[str]:
    """The samples by name."""
    return sorted(path.stem for path in FOLDER.glob("*.svg"))


def drawing(name: str) -> Path:
    """The file of a sample."""
    return FOLDER / f"{name}.svg"


def label(name: str) -> str:
    """A sample's name as people write it."""
    return name.replace("_", " ").capitalize()


def icon(name: str) -> int:
    """Blender's number for a sample's picture, 0 when there is none. Loaded when it is first asked for."""
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    if name not in _previews:
        path = FOLDER / "previews" / f"{name}.png"
        if not path.is_file():
            return 0
        _previews.load(name, str(path), "IMAGE")
    return _previews[name].icon_id


def forget() -> None:
    """Frees the pictures."""
    global _previews
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
        _previews = None
