"""Hostile batches: lists, names, options, and what stands in the folder of results already.

The processes that fold are not started; in their place odd results are written where they would be.
"""

from __future__ import annotations

import contextlib
import csv
import hashlib
import io
import json
import os
import zlib
from collections.abc import Callable
from pathlib import Path
from random import Random
from types import ModuleType
from typing import Any

from benchmarks.fuzz_inputs import changed_json, spoilt
from benchmarks.fuzz_run import Door

_NAMES = (
    "a.svg", "b.svg", "A.SVG", "c d.svg", "é.svg", "...svg", "..svg", ".svg", "x" * 300 + ".svg",
    "../drawings/a.svg",
    "../../../../etc/passwd", "/etc/passwd", "/dev/zero", "/dev/tty.svg", "/", "", "#", "# a.svg", "a.svg\0", "\0",
    "a.svg/", "a.svg/b.svg", "nothing.svg", "pipe.svg", "folder.svg", "loop.svg", "~/a.svg", "-x.svg", "a\tb.svg",
    "summary.csv.svg", "contact_sheet.png.svg", "Contact_Sheet-2.PNG.svg",
    "file:///etc/passwd", "con.svg", "b.svg ", "\ufeffa.svg", "a\u2028b.svg", "\x0b.svg",
)  # fmt: skip
_OPTIONS = (
    ("--resolution", "8"), ("--jobs", "2"), ("--jobs", "0"), ("--jobs", "x"), ("--render",), ("--angle", "nan"),
    ("--size", "0x0"), ("--samples", "-1"), ("--handles", "list.txt"), ("--nothing",),
    ("--description", "pipe.svg"), ("--blend", "x.blend"), ("--angle", "9" * 400), ("--jobs", "9" * 30), ("stray",),
)  # fmt: skip
_STAMP = {"exit_code": 0, "sentence": "Folded.", "seconds": 1.5}
_REPORT = {"sentence": "Folded.", "iterations": 12, "measurement": {"stretch_mean": 1e-4, "folded": True}}
#: How deep JSON can be before Python's own reader gives up.
_DEEP = b"[" * 100_000


def batch_door(extension: Callable[[str], ModuleType]) -> Door:
    cli, batch = extension("curvefold_addon.cli"), extension("curvefold_addon.batch")

    def use(data: bytes, folder: Path) -> None:
        _use(json.loads(data), folder, cli, batch)

    return Door(made_batch, use, (), frozenset())


def made_batch(rng: Random) -> bytes:
    lines = [rng.choice(_NAMES) for _ in range(rng.randrange(6))]
    if rng.random() < 0.5:
        lines.append("a.svg")
    if rng.random() < 0.02:
        lines *= rng.choice((10, 60))  # more than one contact sheet holds
    text = rng.choice(("\n", "\n", "\r\n", "\r")).join(lines).encode()
    if rng.random() < 0.3:
        text = spoilt(rng, text)
    told = {
        "source": rng.choice(("list.txt",) * 6 + ("drawings", "drawings/a.svg", "nothing", "pipe.svg", "")),
        "list": text.decode("latin-1"),
        "options": [word for option in rng.sample(_OPTIONS, rng.choice((0, 0, 0, 1, 2))) for word in option],
        "jobs": rng.choice((1, 1, 2, 3)),
        "again": rng.random() < 0.5,
        "codes": [rng.choice((0, 0, 0, 1, 2, 3, -9, 139)) for _ in range(3)],
        "log": spoilt(rng, b"note: one\ncurvefold: two\n").decode("latin-1"),
        "picture": rng.choice((200, 200, 200, 30, 0)),
        "stamp": _STAMP,
        "report": _REPORT,
    }
    for name in ("stamp", "report"):
        while rng.random() < 0.4:
            told[name] = changed_json(rng, told[name])
    told["deep"] = rng.choice((None,) * 20 + ("batch.json", "report.json"))
    return json.dumps(told).encode()


def _use(told: dict[str, Any], folder: Path, cli: ModuleType, batch: ModuleType) -> None:
    place = folder / "place"
    _clear(place)
    drawings = place / "drawings"
    drawings.mkdir(parents=True)
    for name in ("a.svg", "b.svg", "A.SVG", "c d.svg", "...svg", "summary.csv.svg", "contact_sheet.png.svg"):
        (drawings / name).write_text(f"<svg>{name}</svg>", encoding="utf-8")
    Path(os.fsdecode(bytes(drawings) + b"/\xff.svg")).write_bytes(b"")
    (drawings / "folder.svg").mkdir()
    (drawings / "loop.svg").symlink_to("loop.svg")
    os.mkfifo(drawings / "pipe.svg")
    listed = drawings / "list.txt"
    listed.write_bytes(told["list"].encode("latin-1"))
    source = {"": "", "drawings": str(drawings), "drawings/a.svg": str(drawings / "a.svg")}.get(
        told["source"], str(drawings / told["source"])
    )
    out = place / "out"
    argv = ["batch", source, "--out", str(out), "--jobs", str(told["jobs"]), *told["options"]]
    before = _standing(place, out)
    crew, codes = batch._Crew, list(told["codes"])
    true_wait = crew._wait
    crew._wait = lambda _self, command, stream: _fold(told, command, stream, codes)
    try:
        _run(cli, argv, out)
        if told["again"]:
            for one in out.glob("*/batch.json"):
                _spoil(one, told)
            _run(cli, argv, out)
    finally:
        crew._wait = true_wait
    if before != _standing(place, out):
        raise AssertionError("a file outside of the folder of results was changed")
    _clear(place)


def _run(cli: ModuleType, argv: list[str], out: Path) -> None:
    said, complained = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
        status = cli.main(argv)
    if status not in (0, 1, 2):
        raise AssertionError(f"exit code {status}")
    words = complained.getvalue()
    if status == 2 and not words.startswith("usage:") and len(words.strip().splitlines()) != 1:
        raise AssertionError(f"not one line: {words}")
    if status != 2:
        table = list(csv.DictReader(io.StringIO((out / "summary.csv").read_text(encoding="utf-8"))))
        found = [path for path in out.iterdir() if path.is_dir()]
        if len({row["folder"] for row in table}) != len(table) or len(found) > len(table):
            raise AssertionError(f"{len(table)} rows, {len(found)} folders")
    if list(out.rglob("*.part*")):
        raise AssertionError("something half-written")


def _fold(told: dict[str, Any], command: list[str], stream: Any, codes: list[int]) -> int:
    """In place of a process: results as a fold would leave them, its last words, its exit code."""
    stream.write(told["log"].encode("latin-1"))
    stream.flush()
    code = codes[len(command[-1]) % len(codes)]
    if code in (0, 1):
        folder = Path(command[command.index("--out") + 1])
        for name in ("folded.obj", "folded.fold"):
            (folder / name).write_text("f 1 2 3\n", encoding="utf-8")
        (folder / "report.json").write_text(json.dumps(_REPORT), encoding="utf-8")
        picture = command[-command[::-1].index("--render")]
        Path(picture).write_bytes(_PICTURE[: told["picture"]])
    return code


def _spoil(stamp: Path, told: dict[str, Any]) -> None:
    """An old stamp and report that claim to belong together, with something else in them."""
    true = json.loads(stamp.read_text(encoding="utf-8"))
    report = stamp.with_name("report.json")
    report.write_text(json.dumps(told["report"]), encoding="utf-8")
    if told["deep"] == "report.json":
        report.write_bytes(_DEEP)
    if isinstance(told["stamp"], dict):
        digest = hashlib.sha256(report.read_bytes()).hexdigest()
        changed = {"made_from": true["made_from"], "report_sha256": digest, **told["stamp"]}
    else:
        changed = told["stamp"]
    stamp.write_text(json.dumps(changed), encoding="utf-8")
    if told["deep"] == "batch.json":
        stamp.write_bytes(_DEEP)


def _standing(place: Path, out: Path) -> dict[str, bytes | None]:
    """All that stands beside the folder of results."""
    found: dict[str, bytes | None] = {}
    for path in sorted(place.rglob("*")):
        if out not in (path, *path.parents):
            found[str(path)] = path.read_bytes() if path.is_file() else None
    return found


def _clear(place: Path) -> None:
    for path in sorted(place.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
    if place.exists():
        place.rmdir()


def _chunk(kind: bytes, data: bytes) -> bytes:
    return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")


#: A PNG file of one red pixel.
_PICTURE = (
    b"\x89PNG\r\n\x1a\n"
    + _chunk(b"IHDR", bytes([0, 0, 0, 1, 0, 0, 0, 1, 8, 2, 0, 0, 0]))
    + _chunk(b"IDAT", zlib.compress(bytes([0, 255, 0, 0])))
    + _chunk(b"IEND", b"")
)
