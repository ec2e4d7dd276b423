"""The built zip, installed into a clean user folder of a Blender that has none of the bundled libraries."""

import importlib.util
import json
import os
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest
from dxf_files import border, entity, r12

ROOT = Path(__file__).absolute().parents[2]
SCRIPT = Path(__file__).with_name("install_and_fold.py")
BUNDLED = ("scipy", "shapely", "svgelements", "ezdxf")

#: Python's name of the machine, and Blender's.
PLATFORMS = {
    "linux-aarch64": "linux_arm64",
    "linux-x86_64": "linux_x64",
    "macosx-arm64": "macos_arm64",
    "macosx-x86_64": "macos_x64",
    "win-arm64": "windows_arm64",
    "win-amd64": "windows_x64",
}

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<rect x="0" y="0" width="100" height="100" fill="none" stroke="black"/>
<path d="M 0 45 Q 50 75 100 45" fill="none" stroke="red"/>
</svg>
"""


@pytest.fixture(scope="module")
def built() -> Path:
    parts = sysconfig.get_platform().split("-")
    platform = PLATFORMS[f"{parts[0]}-{parts[-1]}"]
    found = sorted((ROOT / "dist").glob(f"curvefold-*-{platform}.zip"))
    assert len(found) == 1, "run 'make zip' first"
    return found[0]


def test_environment_has_none_of_the_bundled_libraries() -> None:
    assert [name for name in BUNDLED if importlib.util.find_spec(name)] == []


def test_contents(built: Path) -> None:
    with zipfile.ZipFile(built) as archive:
        names = archive.namelist()
    tops = {name.partition("/")[0] for name in names}
    assert tops <= {
        "__init__.py", "blender_manifest.toml", "curvefold_addon", "solver", "wheels",
        "LICENSE", "README.md", "CHANGELOG.md", "sample_patterns",
    }  # fmt: skip
    # Of the samples, what the menu shows and opens.
    samples = {name for name in names if name.startswith("sample_patterns/") and not name.endswith("/")}
    drawings = {name for name in samples if name.endswith(".svg")}
    assert len(drawings) >= 16
    assert samples == drawings | {f"sample_patterns/previews/{Path(name).stem}.png" for name in drawings}
    assert {"__init__.py", "blender_manifest.toml", "curvefold_addon", "solver", "wheels", "LICENSE"} <= tops
    wheels = [name for name in names if name.endswith(".whl")]
    assert not [name for name in wheels if "numpy" in name]
    for library in BUNDLED[:2]:
        assert len([name for name in wheels if f"/{library}-" in name]) == 2, "one for each Python"
    assert len([name for name in wheels if "/curvefold_kernel-" in name]) <= 1, "one for all Pythons, or none"
    assert not [name for name in names if "__pycache__" in name]


def test_every_platform_was_built(built: Path) -> None:
    assert {path.stem.rpartition("-")[2] for path in built.parent.glob("curvefold-*.zip")} == set(
        PLATFORMS.values()
    )


def test_install_enable_fold_and_remove(built: Path, tmp_path: Path) -> None:
    drawing = tmp_path / "arc.svg"
    drawing.write_text(DRAWING)
    from_cad = tmp_path / "arc.dxf"
    crease = entity("ARC", (10, 50), (20, -20), (40, 80), (50, 45), (51, 135), (62, 1))
    from_cad.write_bytes(r12(border(), crease))
    user, out = tmp_path / "user", tmp_path / "out"
    user.mkdir()
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(user)}
    ran = subprocess.run(
        [sys.executable, str(SCRIPT), str(built), str(drawing), str(from_cad), str(out)],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "Traceback" not in ran.stdout + ran.stderr
    found = json.loads((out / "found.json").read_text())
    assert found["warnings"] == {}
    with zipfile.ZipFile(built) as archive:
        bundled = any("/curvefold_kernel-" in name for name in archive.namelist())
    without = "numpy and scipy; the compiled kernel is not installed"
    if os.environ.get("CURVEFOLD_KERNEL") == "0":
        without = "numpy and scipy; the compiled kernel is switched off by CURVEFOLD_KERNEL=0"
        bundled = False
    assert found["linear algebra"].startswith("compiled kernel, " if bundled else without)
    for name in BUNDLED:
        assert Path(found["libraries"][name]).is_relative_to(user)
    assert found["fold"] == 0
    assert found["libraries before"] == []
    assert found["from CAD"] == 0
    assert found["batch"] == 0
    assert (out / "fold" / "report.json").is_file()
    assert (out / "picture.png").is_file()
    assert (out / "batch" / "summary.csv").is_file()
    assert not (user / "extensions" / "user_default" / "curvefold").exists(), "it was removed again"
