"""Whether files can be written, found out before the work that makes them."""

from __future__ import annotations

import contextlib
import secrets
from collections.abc import Iterable
from pathlib import Path

from ..errors import CurvefoldError


def check_writable(folder: Path, names: Iterable[str]) -> None:
    """Raises CurvefoldError when files of these names cannot be written into a folder, which need not exist yet.

    It tries, in the nearest folder that exists: permissions do not tell on Windows, nor for root, nor on a disk
    that is read-only. It leaves nothing behind.
    """
    try:
        nearest = _nearest_folder(folder)
        for part in folder.relative_to(nearest).parts:
            # Names that are too long, or none, are refused without a word about whether they exist.
            with contextlib.suppress(FileNotFoundError):
                (nearest / part).lstat()
        probe = nearest / f".{secrets.token_hex(8)}.part"
        probe.touch(exist_ok=False)
        probe.unlink()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CurvefoldError(f"nothing can be written there ({reason})", file=str(folder)) from None
    for name in names:
        if (folder / name).is_dir():
            raise CurvefoldError("it cannot be written: it is a folder", file=str(folder / name))


def _nearest_folder(folder: Path) -> Path:
    """The folder, or the first one above it that exists. Raises OSError where a file is in the way."""
    for path in (folder, *folder.parents):
        if path.is_dir():
            return path
        if path.exists() or path.is_symlink():
            raise NotADirectoryError(0, f"{path} is not a folder")
    return Path()
