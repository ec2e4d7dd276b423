"""Run by test_installed_zip.py in a process of its own: install, enable, fold, look around, remove."""

import importlib
import json
import os
import sys
from pathlib import Path

import bpy  # isort: skip
import addon_utils

PACKAGE = "bl_ext.user_default.curvefold"
LIBRARIES = ("scipy", "shapely", "svgelements", "ezdxf")


def main() -> int:
    archive, drawing, from_cad, out = (Path(argument) for argument in sys.argv[1:])
    out.mkdir()
    bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)
    assert PACKAGE in bpy.context.preferences.addons
    cli = importlib.import_module(f"{PACKAGE}.curvefold_addon.cli")
    quick = ["--resolution", "12", "--size", "80x60", "--samples", "2"]
    found = {
        "fold": cli.main(
            ["fold", str(drawing), "--out", str(out / "fold"), "--render", str(out / "picture.png"), *quick]
        ),
        # Its library is imported when it is read, and not before.
        "libraries before": sorted({"ezdxf"} & sys.modules.keys()),
        "from CAD": cli.main(["fold", str(from_cad), "--out", str(out / "from CAD"), "--resolution", "12"]),
        # In processes of its own, which have to find the installed extension again.
        "batch": cli.main(["batch", str(drawing), "--out", str(out / "batch"), "--resolution", "12"]),
        "libraries": {name: importlib.import_module(name).__file__ for name in LIBRARIES},
        "linear algebra": importlib.import_module(f"{PACKAGE}.solver.optimize.kernel").linear_algebra().phrase,
    }
    # What Blender thinks of the way the extension uses Python's modules; {} when all is well.
    addon_utils._is_first_reset()
    found["warnings"] = addon_utils._extensions_warnings_get()
    (out / "found.json").write_text(json.dumps(found, indent=2, default=str))
    bpy.ops.extensions.package_uninstall(repo_index=_repository(), pkg_id="curvefold")
    return 0


def _repository() -> int:
    modules = [repository.module for repository in bpy.context.preferences.extensions.repos]
    return modules.index("user_default")


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
