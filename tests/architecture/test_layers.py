"""The house's rules that only reading the source can hold."""

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

BLENDER = {"bpy", "bmesh", "mathutils", "gpu", "gpu_extras", "blf", "bl_ui", "addon_utils", "bpy_extras"}
ARRAYS = {"numpy", "scipy", "shapely"}
OURS = {"solver", "curvefold_addon"}

SOLVER = sorted((ROOT / "solver").rglob("*.py"))
BRIDGE = sorted((ROOT / "curvefold_addon" / "bridge").rglob("*.py"))
THIN = sorted(set((ROOT / "curvefold_addon").rglob("*.py")) - set(BRIDGE))


def imports(path: Path) -> Iterator[tuple[int, str, int]]:
    """(dots, module, line) of every import in a file; ``from . import x`` counts as importing x."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield 0, alias.name, node.lineno
        elif isinstance(node, ast.ImportFrom):
            if node.module is not None:
                yield node.level, node.module, node.lineno
            else:
                for alias in node.names:
                    yield node.level, alias.name, node.lineno


def outside_modules(path: Path) -> set[str]:
    return {module.partition(".")[0] for dots, module, _ in imports(path) if dots == 0}


def own_modules(path: Path) -> set[tuple[str, ...]]:
    """What a file imports of the project, as paths from the root: ("curvefold_addon", "bridge", "mesh")."""
    package = path.relative_to(ROOT).parent.parts
    found = set()
    for dots, module, line in imports(path):
        if dots:
            climbed = dots - 1
            assert climbed <= len(package), f"{path}:{line} climbs out of the extension"
            found.add((*package[: len(package) - climbed], *module.split(".")))
    return found


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


def test_there_is_something_to_read() -> None:
    assert SOLVER
    assert BRIDGE
    assert THIN


@pytest.mark.parametrize("path", SOLVER, ids=name)
def test_solver_knows_no_blender(path: Path) -> None:
    assert not outside_modules(path) & BLENDER
    assert all(module[0] == "solver" for module in own_modules(path))


@pytest.mark.parametrize("path", THIN, ids=name)
def test_thin_layer_has_no_arrays(path: Path) -> None:
    assert not outside_modules(path) & ARRAYS


@pytest.mark.parametrize("path", BRIDGE, ids=name)
def test_bridge_imports_downward(path: Path) -> None:
    above = {
        module
        for module in own_modules(path)
        if module[0] != "solver" and module[:2] != ("curvefold_addon", "bridge")
    }
    assert not above


@pytest.mark.parametrize("path", SOLVER + BRIDGE + THIN, ids=name)
def test_imports_of_the_extension_are_relative(path: Path) -> None:
    assert not outside_modules(path) & OURS


def test_root_imports_nothing_at_module_level() -> None:
    tree = ast.parse((ROOT / "__init__.py").read_text(encoding="utf-8"))
    assert not [node for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)]


def test_solver_prints_only_on_its_command_line() -> None:
    allowed = {ROOT / "solver" / "__main__.py", ROOT / "solver" / "command_line.py"}
    for path in set(SOLVER) - allowed:
        calls = (
            node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)
        )
        assert not [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "print"], path


#: Written in pieces, so that this file does not find itself.
PLACES = re.compile(r"(?<![\w.~])/(?:ro" r"ot|ho" r"me|wo" r"rk|Us" r"ers)/\w")
HOSTS = re.compile(r"py" r"pi\.org|python" r"hosted|download\.ble" r"nder\.org|--(?:extra-)?index-" r"url")


def project_files() -> list[Path]:
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
        cwd=ROOT,
        capture_output=True,
        check=True,
        text=True,
    )
    paths = (ROOT / entry for entry in listed.stdout.split("\0") if entry)
    return [path for path in paths if path.is_file() and path.suffix not in {".png", ".jpg", ".blend", ".npz"}]


def test_no_file_names_a_machine() -> None:
    found = []
    for path in project_files():
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if PLACES.search(line) or HOSTS.search(line):
                found.append(f"{name(path)}:{number}: {line.strip()}")
    assert not found
