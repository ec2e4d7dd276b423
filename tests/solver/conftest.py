"""Helper modules for the solver's tests, handed out as fixtures (the tests are no package)."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

from solver.optimize.kernel import linear_algebra
from solver.optimize.multifrontal.library import Library

#: Why a machine may do without the kernel; any other reason is a fault.
WITHOUT_KERNEL = ("is not installed", "is switched off", "this processor lacks")


def _helper(name: str) -> ModuleType:
    full = f"curvefold_test_{name}"
    if full not in sys.modules:
        spec = importlib.util.spec_from_file_location(full, Path(__file__).with_name(f"{name}.py"))
        assert spec is not None
        assert spec.loader is not None
        sys.modules[full] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return sys.modules[full]


@pytest.fixture(scope="session")
def exact() -> ModuleType:
    """Folded states in closed form."""
    return _helper("exact_states")


@pytest.fixture(scope="session")
def drawings() -> ModuleType:
    """Small crease patterns."""
    return _helper("drawings")


@pytest.fixture(scope="session")
def on_the_sheet() -> ModuleType:
    """Points of a sheet in space, independent of how its net is numbered."""
    return _helper("on_the_sheet")


@pytest.fixture
def kernel_library() -> Library:
    """The compiled kernel. Without one the test is skipped; with one that cannot be used it fails."""
    found = linear_algebra()
    if found.library is None:
        leave = pytest.skip if any(reason in found.phrase for reason in WITHOUT_KERNEL) else pytest.fail
        leave(found.phrase)
    return found.library
