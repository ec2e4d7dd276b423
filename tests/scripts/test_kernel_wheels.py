"""The wheels of the compiled kernel: what is in them, and that none is taken for another."""

import base64
import csv
import hashlib
import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def kernel_wheels(script: Callable[[str], ModuleType]) -> ModuleType:
    return script("kernel_wheels")


@pytest.fixture
def sources(kernel_wheels: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the kernel's sources that the script reads."""
    for path in (ROOT / "kernel").iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    monkeypatch.setattr(kernel_wheels, "SOURCES", tmp_path)
    return tmp_path


def test_another_source_another_version(kernel_wheels: ModuleType, sources: Path) -> None:
    """Blender keeps a wheel whose name it knows: a library that changed must have a new one."""
    versions = {kernel_wheels.version()}
    for name in ("kernel.c", "front.inc", "plan.h"):
        with (sources / name).open("a") as file:
            file.write("/* more */\n")
        versions.add(kernel_wheels.version())
    assert len(versions) == 4
    assert all(re.fullmatch(r"1\.\d+", version) for version in versions)


def test_python_and_c_agree_on_the_number_of_the_abi() -> None:
    said = re.search(r"#define CURVEFOLD_ABI (\d+)", (ROOT / "kernel" / "plan.h").read_text())
    expected = re.search(r"^ABI = (\d+)$", (ROOT / "solver/optimize/multifrontal/library.py").read_text(), re.M)
    assert said is not None
    assert expected is not None
    assert said[1] == expected[1]


@pytest.mark.parametrize(
    ("platform", "tag", "file"),
    [
        ("linux-x64", "manylinux_2_17_x86_64", "kernel.so"),
        ("windows-arm64", "win_arm64", "kernel.dll"),
        ("macos-arm64", "macosx_11_0_arm64", "kernel.dylib"),
    ],
)
def test_a_wheel_holds_one_library_and_says_for_what(
    kernel_wheels: ModuleType, tmp_path: Path, platform: str, tag: str, file: str
) -> None:
    library = tmp_path / file
    library.write_bytes(b"a library")
    wheels = [tmp_path / "first.whl", tmp_path / "second.whl"]
    for path in wheels:
        kernel_wheels.pack(library, platform, path)
    assert wheels[0].read_bytes() == wheels[1].read_bytes()
    assert kernel_wheels.wheel_name(platform).endswith(f"-py3-none-{tag}.whl")
    with zipfile.ZipFile(wheels[0]) as archive:
        names = archive.namelist()
        assert [n for n in names if n.startswith("curvefold_kernel/")] == [
            "curvefold_kernel/__init__.py",
            f"curvefold_kernel/{file}",
        ]
        info = next(n for n in names if n.endswith("/WHEEL"))
        assert f"Tag: py3-none-{tag}" in archive.read(info).decode()
        record = list(csv.reader(archive.read(info.replace("WHEEL", "RECORD")).decode().splitlines()))
        assert [row[0] for row in record] == names
        for name, digest, size in record[:-1]:
            data = archive.read(name)
            assert len(data) == int(size)
            found = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
            assert digest == f"sha256={found}"


def test_a_platform_that_is_not_known_is_refused_in_words() -> None:
    ran = subprocess.run(
        [sys.executable, str(ROOT / "scripts" / "kernel_wheels.py"), "amiga-m68k"], capture_output=True, text=True
    )
    assert ran.returncode == 1
    assert ran.stderr == "curvefold: the kernel is not built for amiga-m68k\n"


def test_a_compiler_that_cannot_be_had_is_a_sentence(
    kernel_wheels: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert kernel_wheels.cache_folder() == tmp_path / "curvefold"
    failed = subprocess.CompletedProcess([], 1, "", "long\nERROR: no matching distribution\n")
    monkeypatch.setattr(kernel_wheels.subprocess, "run", lambda *a, **k: failed)
    with pytest.raises(kernel_wheels.BuildError, match=r"could not be installed: ERROR: no matching distribution$"):
        kernel_wheels.wheel("linux-x64")
    assert not list(tmp_path.rglob("*.whl"))
    monkeypatch.setattr(kernel_wheels, "zig", lambda: Path("zig"))
    with pytest.raises(kernel_wheels.BuildError, match=r"zig could not build kernel\.so for x86_64-linux"):
        kernel_wheels.wheel("linux-x64")
    assert not list(tmp_path.rglob("*.whl"))


def test_the_extension_is_put_together_without_a_kernel_that_cannot_be_built(
    kernel_wheels: ModuleType,
    script: Callable[[str], ModuleType],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    wheels = script("wheels")

    def fail(platform: str) -> Path:
        raise kernel_wheels.BuildError("no compiler")

    monkeypatch.setattr(wheels.kernel_wheels, "wheel", fail)
    assert wheels.kernel_wheel("linux-x64") is None
    assert capsys.readouterr().out == "the extension for linux-x64 goes without the compiled kernel: no compiler\n"
