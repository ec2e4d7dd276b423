"""Builds the compiled kernel for every platform, from any of them, and packs each library as a wheel.

    python scripts/kernel_wheels.py [PLATFORM …]     all platforms, those named, or "here": this machine's own

Prints the wheels' paths. The compiler is zig, a package like any other; the kernel needs no C library, so nothing
else is needed. Compiler and wheels are kept in the folder that scripts/cache_folder.sh names; a wheel is built
again when the sources, the compiler or its flags change. Exits with 1 and a sentence when a wheel cannot be had.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
import zlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCES = ROOT / "kernel"

#: The version of the package ``ziglang``.
ZIG = "0.17.1"

#: Contraction is off because the kernel says itself what it fuses. Without builtins no loop becomes a call of a
#: C library's memset, and there is none.
FLAGS = (
    *("-O3", "-ffp-contract=off", "-fno-math-errno", "-fno-builtin", "-fvisibility=hidden"),
    *("-std=c11", "-Wall", "-Wextra", "-Werror", "-g0", "-shared", "-nostdlib"),
)

PACKAGE = "curvefold_kernel"
#: The first date that a zip file can hold: the same library gives the same wheel.
ZIP_DATE = (1980, 1, 1, 0, 0, 0)
#: What pip may take to answer, seconds; it asks twice.
PIP_TIMEOUT = 20


@dataclass(frozen=True)
class Target:
    """How one platform is called by zig and by wheels, and its libraries."""

    zig: str
    wheel: str
    suffix: str


#: By Blender's names of platforms.
TARGETS = {
    "linux-x64": Target("x86_64-linux-gnu.2.17", "manylinux_2_17_x86_64", ".so"),
    "linux-arm64": Target("aarch64-linux-gnu.2.17", "manylinux_2_17_aarch64", ".so"),
    "windows-x64": Target("x86_64-windows-gnu", "win_amd64", ".dll"),
    "windows-arm64": Target("aarch64-windows-gnu", "win_arm64", ".dll"),
    "macos-x64": Target("x86_64-macos.11.0", "macosx_11_0_x86_64", ".dylib"),
    "macos-arm64": Target("aarch64-macos.11.0", "macosx_11_0_arm64", ".dylib"),
}


class BuildError(Exception):
    """A wheel cannot be built; the text says why."""


def this_platform() -> str:
    """Blender's name of the machine that this runs on."""
    system = {"linux": "linux", "darwin": "macos", "win32": "windows"}.get(sys.platform, sys.platform)
    machine = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64"}.get(platform.machine().lower())
    return f"{system}-{machine or platform.machine().lower()}"


@cache
def cache_folder() -> Path:
    """Where downloads and what is built are kept, outside the tree."""
    script = ROOT / "scripts" / "cache_folder.sh"
    printed = subprocess.run([str(script)], stdout=subprocess.PIPE, text=True, check=True).stdout
    return Path(printed.removesuffix("\n"))


def version() -> str:
    """The ABI and a number made of all that a library depends on: another library never has the same."""
    checksum = zlib.crc32(" ".join([ZIG, *FLAGS]).encode())
    for path in sorted(SOURCES.glob("*")):
        if path.suffix in (".c", ".h", ".inc") and path.name != "harness.c":
            checksum = zlib.crc32(path.read_bytes(), checksum)
    abi = re.search(r"^#define CURVEFOLD_ABI (\d+)$", (SOURCES / "plan.h").read_text(encoding="utf-8"), re.M)
    if abi is None:
        raise SystemExit("kernel/plan.h says no CURVEFOLD_ABI")
    return f"{abi[1]}.{checksum}"


def wheel_name(name: str) -> str:
    return f"{PACKAGE}-{version()}-py3-none-{TARGETS[name].wheel}.whl"


def wheel(name: str) -> Path:
    """The wheel of a platform, built unless it is there. Raises BuildError."""
    if name not in TARGETS:
        raise BuildError(f"the kernel is not built for {name}")
    path = cache_folder() / "kernel" / wheel_name(name)
    if path.is_file():
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        library = Path(folder) / f"kernel{TARGETS[name].suffix}"
        compile_library(name, library)
        partial = Path(folder) / path.name
        pack(library, name, partial)
        partial.replace(path)
    return path


def compile_library(name: str, output: Path) -> None:
    """The kernel's library for a platform. Raises BuildError."""
    strip = [] if TARGETS[name].suffix == ".dylib" else ["-s"]  # zig's linker for macOS has no such option
    compile_with_zig(TARGETS[name].zig, [str(SOURCES / "kernel.c"), *FLAGS, *strip], output)


def compile_with_zig(target: str, arguments: list[str], output: Path) -> None:
    """Raises BuildError, with what the compiler said."""
    command = [str(zig()), "cc", "-target", target, *arguments, "-o", str(output)]
    caches = {f"ZIG_{kind}_CACHE_DIR": str(cache_folder() / "zig-cache") for kind in ("GLOBAL", "LOCAL")}
    print(f"building {output.name} for {target}", file=sys.stderr, flush=True)
    ran = subprocess.run(command, env={**os.environ, **caches}, capture_output=True, text=True)
    if ran.returncode != 0 or not output.is_file():
        raise BuildError(f"zig could not build {output.name} for {target}: {ran.stderr.strip()}")


def zig() -> Path:
    """The compiler, fetched unless it is there. Raises BuildError."""
    folder = cache_folder() / f"ziglang-{ZIG}"
    program = folder / "ziglang" / ("zig.exe" if sys.platform == "win32" else "zig")
    if program.is_file():
        return program
    print(f"fetching the compiler, ziglang {ZIG} (100 MB, once)", file=sys.stderr, flush=True)
    # In a folder of its own first: an interrupted installation must not look like a compiler.
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as partial:
        command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"]
        command += ["--retries", "1", "--timeout", str(PIP_TIMEOUT), "--target", f"{partial}/zig"]
        ran = subprocess.run([*command, f"ziglang=={ZIG}"], capture_output=True, text=True)
        if ran.returncode != 0:
            raise BuildError(f"ziglang {ZIG} could not be installed: {_last_line(ran.stderr)}")
        shutil.rmtree(folder, ignore_errors=True)
        Path(partial, "zig").replace(folder)
    return program


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["pip said nothing"])[-1]


def pack(library: Path, name: str, path: Path) -> None:
    """Writes the wheel ``path`` around a library; the same library gives the same bytes."""
    info = f"{PACKAGE}-{version()}.dist-info"
    files = {
        f"{PACKAGE}/__init__.py": b'"""The compiled kernel of Curvefold, one library."""\n',
        f"{PACKAGE}/{library.name}": library.read_bytes(),
        f"{info}/METADATA": (
            f"Metadata-Version: 2.1\nName: {PACKAGE}\nVersion: {version()}\n"
            "Summary: The compiled kernel of Curvefold\nLicense: GPL-3.0-or-later\n"
        ).encode(),
        f"{info}/WHEEL": (
            "Wheel-Version: 1.0\nGenerator: curvefold\nRoot-Is-Purelib: false\n"
            f"Tag: py3-none-{TARGETS[name].wheel}\n"
        ).encode(),
    }
    record = [f"{file},sha256={_digest(data)},{len(data)}\n" for file, data in files.items()]
    files[f"{info}/RECORD"] = "".join([*record, f"{info}/RECORD,,\n"]).encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file, data in files.items():
            entry = zipfile.ZipInfo(file, ZIP_DATE)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)


def _digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("platforms", nargs="*", metavar="PLATFORM", help=f"here, {', '.join(TARGETS)}")
    names = parser.parse_args().platforms or list(TARGETS)
    try:
        for name in names:
            print(wheel(this_platform() if name == "here" else name))
    except (BuildError, OSError) as error:
        raise SystemExit(f"curvefold: {error}") from None


if __name__ == "__main__":
    main()
