"""Writing files whole or not at all."""

from __future__ import annotations

import contextlib
import os
import secrets
from pathlib import Path

from ..errors import CurvefoldError


def write_whole(path: str | os.PathLike[str], content: str | bytes) -> None:
    """Write ``content`` so that ``path`` is either the old file or the whole new one.

    Text is written as UTF-8; what is no text in it, as in names of files that are none, is escaped.

    The content goes to a temporary file in the same folder, onto the disk, and is then moved over ``path``.
    A link stays a link: the file it points to is replaced. Raises CurvefoldError, and leaves nothing behind.
    """
    data = content.encode("utf-8", "backslashreplace") if isinstance(content, str) else content
    target = Path(os.path.realpath(path))
    # Not tempfile: its files are private to the user, and this one becomes an ordinary file of the folder.
    # Not named after the target, whose name may already be as long as the file system allows.
    temporary = target.with_name(f".{secrets.token_hex(8)}.part")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    try:
        try:
            with open(os.open(temporary, flags, 0o666), "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            if target.is_file():
                os.chmod(temporary, target.stat().st_mode & 0o777)
            os.replace(temporary, target)
        except BaseException:
            with contextlib.suppress(OSError):
                temporary.unlink()
            raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CurvefoldError(f"the file cannot be written ({reason})", file=str(path)) from error
    _sync_folder(target.parent)


def _sync_folder(folder: Path) -> None:
    """Make the move itself last through a power cut, where the system can (not on Windows)."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
