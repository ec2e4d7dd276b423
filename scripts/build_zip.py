"""Builds the extension's zips, one a platform, with Blender's own packager.

    PYTHON-WITH-BPY scripts/build_zip.py [--output-dir DIR]

bpy is not imported; only the packager that comes with it is run.
"""

from __future__ import annotations

import argparse
import importlib.util
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

#: Extension platforms refuse larger files.
LARGEST_ZIP_MB = 100


def packager() -> Path:
    """``blender_ext.py`` of the installed bpy."""
    spec = importlib.util.find_spec("bpy")
    if spec is None or spec.origin is None:
        raise SystemExit("this Python has no bpy module")
    found = sorted(Path(spec.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    if not found:
        raise SystemExit("this bpy module brings no packager")
    return found[-1]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output-dir", type=Path, default=ROOT / "dist")
    output = parser.parse_args().output_dir.absolute()
    output.mkdir(parents=True, exist_ok=True)
    for old in output.glob("curvefold-*.zip"):
        old.unlink()

    run = [sys.executable, str(packager())]
    subprocess.run([*run, "validate", str(ROOT)], check=True)
    subprocess.run(
        [*run, "build", "--source-dir", str(ROOT), "--output-dir", str(output), "--split-platforms"],
        check=True,
    )
    for path in sorted(output.glob("curvefold-*.zip")):
        subprocess.run([*run, "validate", str(path)], check=True)
        size = path.stat().st_size / 1e6
        print(f"{path.name}: {size:.1f} MB")
        if size > LARGEST_ZIP_MB:
            raise SystemExit(f"{path.name} is larger than {LARGEST_ZIP_MB} MB")


if __name__ == "__main__":
    main()
