"""The extension, enabled from the checkout in a user folder of its own, for the tests that run inside bpy."""

import importlib
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).absolute().parents[2]

ARC = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<rect x="0" y="0" width="100" height="100" fill="none" stroke="black"/>
<path d="M 0 45 Q 50 75 100 45" fill="none" stroke="red"/>
</svg>
"""
BROKEN = "<svg xmlns='http://www.w3.org/2000/svg'><path d="


def _load(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, ROOT / "curvefold_addon" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def pytest_configure(config: pytest.Config) -> None:
    checkout = _load("checkout")
    folder = tempfile.TemporaryDirectory(prefix="curvefold-test-", ignore_cleanup_errors=True)
    config.stash[_FOLDER] = folder
    checkout.link(ROOT, Path(folder.name))
    checkout.enable(Path(folder.name))
    config.stash[_PACKAGE] = checkout.PACKAGE


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[_STATUS] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    config.stash[_FOLDER].cleanup()
    sys.stdout.flush()
    sys.stderr.flush()
    # Blender's clean-up at exit may crash or hang; then the exit code would not be that of the tests.
    os._exit(config.stash.get(_STATUS, 3))


_FOLDER: pytest.StashKey[tempfile.TemporaryDirectory[str]] = pytest.StashKey()
_PACKAGE: pytest.StashKey[str] = pytest.StashKey()
_STATUS: pytest.StashKey[int] = pytest.StashKey()


@pytest.fixture(scope="session")
def extension(pytestconfig: pytest.Config) -> Callable[[str], ModuleType]:
    """``extension("solver")``: a module of the enabled extension."""
    package = pytestconfig.stash[_PACKAGE]
    return lambda name: importlib.import_module(f"{package}.{name}")


@pytest.fixture(autouse=True)
def _empty_file() -> None:
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    """A square of 100 mm with one arc across."""
    path = tmp_path / "arc.svg"
    path.write_text(ARC)
    return path


@pytest.fixture
def broken_drawing(tmp_path: Path) -> Path:
    path = tmp_path / "broken.svg"
    path.write_text(BROKEN)
    return path


@pytest.fixture(scope="session")
def folded(extension: Callable[[str], ModuleType], tmp_path_factory: pytest.TempPathFactory) -> object:
    """The FoldResult of that square."""
    solver = extension("solver")
    path = tmp_path_factory.mktemp("folded") / "arc.svg"
    path.write_text(ARC)
    return solver.fold(solver.read_pattern(path), solver.FoldDescription(resolution=12, angle=60.0))


@pytest.fixture
def sheet(extension: Callable[[str], ModuleType], drawing: Path) -> object:
    """That square as a drawing in the scene, active."""
    import bpy

    pattern = extension("solver").read_pattern(drawing)
    item = extension("curvefold_addon.bridge.drawing").add_drawing(pattern, bpy.context.collection)
    bpy.context.view_layer.objects.active = item
    return item


@pytest.fixture
def cross_border() -> Callable[[object], None]:
    """Makes a drawing one that nothing can be made of: a corner of its border goes through the opposite edge."""

    def cross(sheet: object) -> None:
        sheet.data.splines[0].points[0].co = (0.2, 0.03, 0.0, 1.0)

    return cross


@pytest.fixture
def paper(sheet: object) -> object:
    """A live paper of it, flat and active."""
    import bpy

    assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
    return bpy.context.active_object


@pytest.fixture
def live(extension: Callable[[str], ModuleType]) -> ModuleType:
    return extension("curvefold_addon.live")


@pytest.fixture
def content(extension):
    """What is drawn over papers, forgotten afterwards."""
    module = extension("curvefold_addon.overlay.content")
    yield module
    module.forget()
