"""Enables the extension in the bpy module, straight from a checkout, in a user folder of its own."""

import os
import sys
from pathlib import Path
from types import ModuleType

REPOSITORY = "user_default"
NAME = "curvefold"
PACKAGE = f"bl_ext.{REPOSITORY}.{NAME}"

#: What the extension consists of; the manifest is copied, not linked.
_PARTS = ("__init__.py", "curvefold_addon", "sample_patterns", "solver")
_MANIFEST = "blender_manifest.toml"


def link(checkout: Path, user_folder: Path) -> None:
    """Makes the checkout an installed extension of a user folder."""
    target = user_folder / "extensions" / REPOSITORY / NAME
    target.mkdir(parents=True)
    for part in _PARTS:
        (target / part).symlink_to(checkout / part)
    # Without its wheels: here the libraries come with the Python environment, and unpacking the bundled
    # ones into a new user folder at every start would take seconds.
    lines = (checkout / _MANIFEST).read_text(encoding="utf-8").splitlines(keepends=True)
    (target / _MANIFEST).write_text("".join(_without_wheels(lines)), encoding="utf-8")


def enable(user_folder: Path, package: str = PACKAGE) -> ModuleType:
    """Imports bpy with this user folder and enables the extension in it."""
    if "bpy" in sys.modules:
        raise RuntimeError("bpy has been imported already, with another user folder")
    os.environ["BLENDER_USER_RESOURCES"] = str(user_folder)
    import bpy  # noqa: F401  (only now, and before addon_utils, which it brings)
    import addon_utils  # isort: skip

    module = addon_utils.enable(package, default_set=True)
    if module is None:
        raise RuntimeError(f"{package} could not be enabled; Blender has said why above")
    return module


def _without_wheels(lines: list[str]) -> list[str]:
    start = next(k for k, line in enumerate(lines) if line.startswith("wheels ="))
    end = next(k for k in range(start, len(lines)) if lines[k].strip().endswith("]"))
    return [*lines[:start], "wheels = []\n", *lines[end + 1 :]]
