"""Generated parts of documents: what stands between two markers."""

from __future__ import annotations

from pathlib import Path

from solver.files.atomic import write_whole


def write_between(path: Path, name: str, text: str) -> None:
    """Put ``text`` between the markers ``name`` of a file. Raises ValueError when it has no such markers."""
    start, stop = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    old = path.read_text(encoding="utf-8")
    head, begin, rest = old.partition(start)
    _, end, tail = rest.partition(stop)
    if not (begin and end):
        raise ValueError(f"{path} has no lines {start} and {stop}")
    write_whole(path, f"{head}{start}\n{text}\n{stop}{tail}")
