"""Which Curvefold this is, and what solves its linear systems: for ``--version`` and reports."""

from __future__ import annotations

import tomllib
from pathlib import Path

from .optimize.kernel import linear_algebra

_MANIFEST = Path(__file__).resolve().parent.parent / "blender_manifest.toml"


def version() -> str:
    """The extension's version, as its manifest has it."""
    return str(tomllib.loads(_MANIFEST.read_text(encoding="utf-8"))["version"])


def in_words() -> str:
    """Version and linear algebra in a line."""
    return f"curvefold {version()} ({linear_algebra().phrase})"
