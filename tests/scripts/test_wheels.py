"""The manifest lists what the requirements ask for, on every platform it names."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))


@pytest.fixture
def wheels(script: Callable[[str], ModuleType]) -> ModuleType:
    return script("wheels")


def test_the_platforms_of_the_manifest_get_wheels(wheels: ModuleType) -> None:
    assert sorted(MANIFEST["platforms"]) == sorted(wheels.PLATFORMS)


def test_the_manifest_lists_every_wheel_and_no_other(wheels: ModuleType) -> None:
    listed = {Path(name).stem for name in MANIFEST["wheels"]}
    for name, version, python, platform in wheels.wanted():
        versions = [stem for stem in listed if stem.startswith(f"{name}-{version}-")]
        fitting = [stem for stem in versions if fits(stem, python, wheels.PLATFORMS[platform])]
        assert len(fitting) == 1, (name, version, python, platform)
    kernels = {Path(wheels.kernel_wheels.wheel_name(platform)).stem for platform in wheels.PLATFORMS}
    assert kernels <= listed
    pairs = {tuple(stem.split("-")[:2]) for stem in listed - kernels}
    assert pairs == {pair for platform in wheels.PLATFORMS for pair in wheels.requirements(platform)}


def fits(stem: str, python: str, platforms: tuple[str, ...]) -> bool:
    *_, implementation, abi, tags = stem.split("-")
    if (abi, tags) == ("none", "any"):
        return True
    return implementation == f"cp{python}" and any(tag in platforms for tag in tags.split("."))
