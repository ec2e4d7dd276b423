"""Fetches the wheels that the extension bundles and writes their list into the manifest.

    python scripts/wheels.py            fetch what is missing, copy into ./wheels, write the list
    python scripts/wheels.py --check    only say whether the manifest lists what it should

The wheels are unmodified files from the package index, taken by pip, for every platform and Python that
Blender has; Blender picks the right one. They are cached in the folder that scripts/cache_folder.sh names.
The compiled kernel's own wheels are built (scripts/kernel_wheels.py); where that fails, the zips go without them.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import kernel_wheels

ROOT = Path(__file__).resolve().parent.parent
MANIFEST = ROOT / "blender_manifest.toml"
REQUIREMENTS = ROOT / "requirements"
FOLDER = ROOT / "wheels"

PYTHONS = ("311", "313")

#: For each of Blender's platforms, the wheel platforms that run there, as pip names them. The macOS ones
#: stop at the version where scipy still brings its own linear algebra.
PLATFORMS = {
    "linux-arm64": ("manylinux_2_28_aarch64", "manylinux_2_17_aarch64", "manylinux2014_aarch64"),
    "linux-x64": ("manylinux_2_28_x86_64", "manylinux_2_17_x86_64", "manylinux2014_x86_64"),
    "macos-arm64": ("macosx_12_0_arm64", "macosx_11_0_arm64"),
    "macos-x64": ("macosx_10_13_x86_64", "macosx_10_9_x86_64"),
    "windows-arm64": ("win_arm64",),
    "windows-x64": ("win_amd64",),
}
#: Which libraries a platform gets, where not those of bundled.txt.
OTHER_REQUIREMENTS = {"windows-arm64": "bundled_windows_arm64.txt"}
#: Libraries of which the pure wheel is taken everywhere. There are faster ones for each platform, of 5 MB each.
PURE = frozenset({"ezdxf", "fonttools"})

LIST = re.compile(r"^wheels = \[.*?^\]$", re.MULTILINE | re.DOTALL)


def bundled_folder() -> Path:
    """Where the wheels of the package index are kept."""
    return kernel_wheels.cache_folder() / "bundled"


def requirements(platform: str) -> list[tuple[str, str]]:
    """(name, version) of each library that is bundled for one of Blender's platforms."""
    path = REQUIREMENTS / OTHER_REQUIREMENTS.get(platform, "bundled.txt")
    lines = (line.split("#")[0].strip() for line in path.read_text(encoding="utf-8").splitlines())
    pairs = []
    for line in filter(None, lines):
        name, version = line.split("==")
        pairs.append((name, version))
    return pairs


def wanted() -> Iterator[tuple[str, str, str, str]]:
    """(name, version, python, platform) of every wheel; a pure one comes up for each and is found again."""
    for platform in PLATFORMS:
        for name, version in requirements(platform):
            for python in PYTHONS:
                yield name, version, python, platform


def find(name: str, version: str, python: str, platform: str) -> Path | None:
    """The cached wheel for this Python and platform, if it is there."""
    for path in sorted(bundled_folder().glob(f"{name}-{version}-*.whl")):
        pythons, abi, tags = path.stem.split("-")[2:]
        if abi == "none" and tags == "any":
            return path
        if (
            name not in PURE
            and pythons == f"cp{python}"
            and any(tag in PLATFORMS[platform] for tag in tags.split("."))
        ):
            return path
    return None


def fetch(name: str, version: str, python: str, platform: str) -> Path:
    """Downloads one wheel into the cache."""
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    command += ["--only-binary=:all:", "--python-version", python]
    if name in PURE:
        command += ["--implementation", "py", "--abi", "none", "--platform", "any"]
    else:
        command += ["--implementation", "cp"]
        for tag in PLATFORMS[platform]:
            command += ["--platform", tag]
    # In a folder of its own first: an interrupted download must not look like a wheel.
    partial = bundled_folder() / "partial"
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    print(f"fetching {name} {version} for Python {python[0]}.{python[1:]} on {platform}", flush=True)
    subprocess.run([*command, "--dest", str(partial), f"{name}=={version}"], check=True)
    for path in partial.glob("*.whl"):
        path.replace(bundled_folder() / path.name)
    shutil.rmtree(partial)
    found = find(name, version, python, platform)
    if found is None:
        raise SystemExit(f"no wheel of {name} {version} for Python {python} on {platform}")
    return found


def kernel_wheel(platform: str) -> Path | None:
    """The compiled kernel's wheel for a platform; None, and a line that says why, where it cannot be built."""
    try:
        return kernel_wheels.wheel(platform)
    except (kernel_wheels.BuildError, OSError) as error:
        print(f"the extension for {platform} goes without the compiled kernel: {error}", flush=True)
        return None


def manifest_list(names: list[str]) -> str:
    return "\n".join(["wheels = [", *(f'  "./wheels/{name}",' for name in names), "]"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 if the manifest is out of date"
    )
    arguments = parser.parse_args()

    wheels = {}
    for want in wanted():
        path = find(*want) or fetch(*want)
        wheels[path.name] = path
    for path in filter(None, map(kernel_wheel, PLATFORMS)):
        wheels[path.name] = path

    text = MANIFEST.read_text(encoding="utf-8")
    new = LIST.sub(lambda _: manifest_list(sorted(wheels)), text, count=1)
    if arguments.check:
        if new != text:
            raise SystemExit("the manifest's list of wheels is out of date: run scripts/wheels.py")
        return
    FOLDER.mkdir(exist_ok=True)
    for stale in FOLDER.glob("*.whl"):
        if stale.name not in wheels:
            stale.unlink()
    for name, path in wheels.items():
        target = FOLDER / name
        if not target.exists() or target.stat().st_size != path.stat().st_size:
            shutil.copyfile(path, target)
    if new != text:
        MANIFEST.write_text(new, encoding="utf-8")
    print(f"{len(wheels)} wheels in {FOLDER.relative_to(ROOT)}/")


if __name__ == "__main__":
    main()
