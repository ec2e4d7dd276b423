"""What ``--version`` and a report say of the version and of what computes."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from solver import command_line
from solver.optimize.kernel import SWITCH, linear_algebra

ROOT = Path(__file__).resolve().parents[2]
OFF = f"numpy and scipy; the compiled kernel is switched off by {SWITCH}=0"

#: Of the sheet, mm.
SIDE = 100.0
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<rect x="0" y="0" width="100" height="100" fill="none" stroke="black"/>
<path d="M 0 45 Q 50 75 100 45" fill="none" stroke="red"/>
</svg>
"""


def run(*arguments: str, **environment: str) -> str:
    """The standard output of ``python -m solver`` in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "solver", *arguments],
        cwd=ROOT,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    return done.stdout


def test_the_version_says_what_computes(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        command_line.main(["--version"], io.StringIO())
    assert stop.value.code == 0
    manifest = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    said = capsys.readouterr().out
    name, version, what = said.strip().split(" ", 2)
    assert name == "curvefold"
    assert f'\nversion = "{version}"\n' in manifest
    assert what == f"({linear_algebra().phrase})"


def test_a_process_with_the_switch_off_says_so() -> None:
    assert f"({OFF})" in run("--version", **{SWITCH: "0"})


def test_a_fold_and_its_report_are_the_same_paper_with_the_kernel_and_without(tmp_path: Path) -> None:
    """Within rounding: a millionth of the sheet's side. The report says which of both it was."""
    (tmp_path / "arc.svg").write_text(DRAWING)
    shapes = []
    for switch, phrase in (("0", OFF), ("1", linear_algebra().phrase)):
        out = tmp_path / switch
        run("fold", str(tmp_path / "arc.svg"), "--out", str(out), "--resolution", "24", **{SWITCH: switch})
        assert json.loads((out / "report.json").read_text(encoding="utf-8"))["linear_algebra"] == phrase
        lines = (out / "folded.obj").read_text(encoding="utf-8").splitlines()
        shapes.append([[float(number) for number in line.split()[1:4]] for line in lines if line.startswith("v ")])
    without, with_it = shapes
    assert len(without) == len(with_it) > 100
    largest = max(abs(a - b) for p, q in zip(without, with_it, strict=True) for a, b in zip(p, q, strict=True))
    assert largest <= 1e-6 * SIDE
