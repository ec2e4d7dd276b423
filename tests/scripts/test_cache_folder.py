"""Where the scripts keep environments and downloads, with a home and without."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
#: A folder that nobody can write to, not even root.
UNWRITABLE = Path("/proc")


def cache_folder(tree: Path, **variables: str) -> Path:
    """What the script prints in a tree of its own, with these environment variables and PATH only."""
    scripts = tree / "scripts"
    scripts.mkdir(exist_ok=True)
    (scripts / "cache_folder.sh").write_bytes((ROOT / "scripts" / "cache_folder.sh").read_bytes())
    done = subprocess.run(
        ["bash", str(scripts / "cache_folder.sh")], env={"PATH": os.environ["PATH"], **variables},
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    return Path(done.stdout.removesuffix("\n"))


def test_with_a_home(tmp_path: Path) -> None:
    home, cache = tmp_path / "a home", tmp_path / "cache"
    assert cache_folder(tmp_path, HOME=str(home)) == home / ".cache" / "curvefold"
    assert cache_folder(tmp_path, HOME=str(home), XDG_CACHE_HOME=str(cache)) == cache / "curvefold"
    # The specification has relative ones ignored.
    assert cache_folder(tmp_path, HOME=str(home), XDG_CACHE_HOME="cache") == home / ".cache" / "curvefold"
    assert (home / ".cache" / "curvefold").is_dir()


@pytest.mark.parametrize("variables", [{}, {"HOME": ""}], ids=["unset", "empty"])
def test_without_home_it_is_the_one_that_the_system_knows(tmp_path: Path, variables: dict[str, str]) -> None:
    pwd = pytest.importorskip("pwd")
    home = Path(pwd.getpwuid(os.getuid()).pw_dir)
    if not os.access(home, os.W_OK):
        pytest.skip("this user has no home")
    assert cache_folder(tmp_path, **variables) == home / ".cache" / "curvefold"


@pytest.mark.skipif(not UNWRITABLE.is_dir(), reason="needs a file system that takes no files")
def test_where_nothing_can_be_written_it_is_in_the_tree(tmp_path: Path) -> None:
    nowhere = str(UNWRITABLE)
    assert cache_folder(tmp_path, HOME=nowhere) == tmp_path / ".cache" / "curvefold"
    assert cache_folder(tmp_path, HOME=nowhere, XDG_CACHE_HOME=nowhere) == tmp_path / ".cache" / "curvefold"
