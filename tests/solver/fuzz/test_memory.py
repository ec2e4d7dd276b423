"""Reading a file takes no more memory than a stated multiple of the file."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.large_drawings import LARGE

#: Bytes of memory a byte of a file of a megabyte (docs/reliability.md); Python and its libraries come before.
MULTIPLE = 80
MEGABYTE = 1_000_000
#: Strokes of a large drawing that is read, a little fewer than may be.
STROKES = 19_900
#: Reads the file named in the arguments, and prints by how many bytes its peak of memory grew.
READ = """
import re, sys
import solver
from solver.description import read_handles
from solver.dxf_library import dxf_library
dxf_library()
def peak():  # of this program alone: what getrusage says begins at that of the process that started it
    return int(re.search("VmHWM:\\s*(\\d+) kB", open("/proc/self/status").read())[1])
before = peak()
try:
    if sys.argv[1].endswith(".json"):
        read_handles(sys.argv[1])
    else:
        patterns = solver.read_patterns(sys.argv[1])
        if len(sys.argv) == 2:
            solver.build_net(patterns[0], 16)
except solver.CurvefoldError:
    pass
print(1024 * (peak() - before))
"""
BEGIN = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><rect width="9" height="9" stroke="#000"/>'


def repeated(begin: str, middle: str, end: str) -> str:
    return begin + middle * (MEGABYTE // len(middle)) + end


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "path.svg",
            repeated(f'{BEGIN}<path stroke="red" d="M 0 5', " L 1.2345 6.7891 L 8.1234 2.3456", '"/></svg>'),
        ),
        ("tags.svg", repeated(BEGIN, '<g><path stroke="red" d="M0 0 L1 1"/></g>', "</svg>")),
        (
            "looks.svg",
            BEGIN + "".join(f'<path style="stroke:#{k:06x}" d="M0 0H1"/>' for k in range(22_000)) + "</svg>",
        ),
        (
            "rules.svg",
            BEGIN + "<style>" + "".join(f".c{k}{{stroke:red}}" for k in range(19_000)) + "</style></svg>",
        ),
        ("broken.svg", repeated(BEGIN + "<style>", "a{b(c[", "</style></svg>")),
        ("entities.svg", repeated(f'<!DOCTYPE svg [<!ENTITY a "{"a" * 2}">]>{BEGIN}<g id="', "&a;", '"/></svg>')),
        ("points.fold", repeated('{"vertices_coords":[[0,0]', ",[1,2]", '],"edges_vertices":[[0,1]]}')),
        ("handles.json", repeated('[{"at":[0,0],"target":[1,1,1]}', ',{"at":[0,0],"target":[1,1,1]}', "]")),
    ],
)
@pytest.mark.skipif(sys.platform != "linux", reason="peaks of memory are read from /proc")
def test_reading_takes_no_more_memory_than_a_multiple_of_the_file(tmp_path: Path, name: str, text: str) -> None:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    assert 0 < taken(path) < MULTIPLE * MEGABYTE


@pytest.mark.parametrize("name", LARGE)
@pytest.mark.skipif(sys.platform != "linux", reason="peaks of memory are read from /proc")
def test_thousands_of_strokes_take_no_more_memory_than_a_multiple_of_the_file(tmp_path: Path, name: str) -> None:
    suffix, make = LARGE[name]
    path = tmp_path / f"large{suffix}"
    path.write_text(make(STROKES), encoding="utf-8")
    assert 0 < taken(path, "without a net") < MULTIPLE * path.stat().st_size


def taken(path: Path, *options: str) -> int:
    """Bytes by which the peak of memory grew in a process of its own."""
    command = [sys.executable, "-c", READ, str(path), *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return int(done.stdout)
