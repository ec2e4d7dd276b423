"""Whether files can be written is found out by trying, and leaves nothing behind."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from solver import CurvefoldError
from solver.files.writable import check_writable


def refusal(folder: Path, *names: str) -> str:
    with pytest.raises(CurvefoldError) as refused:
        check_writable(folder, names)
    return str(refused.value)


def test_a_folder_that_can_be_made_is_not_made(tmp_path: Path) -> None:
    check_writable(tmp_path / "new" / "newer", ["report.json"])
    check_writable(tmp_path, ["report.json"])
    assert not list(tmp_path.iterdir())


def test_a_relative_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    check_writable(Path("new"), [])
    check_writable(Path(), [])
    (tmp_path / "file").touch()
    assert "file is not a folder" in refusal(Path("file", "new"))


def test_older_results_are_no_hindrance(tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    report.write_text("{}")
    report.chmod(stat.S_IRUSR)
    check_writable(tmp_path, ["report.json"])
    assert report.read_text() == "{}"


def test_what_is_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "nowhere").symlink_to(tmp_path / "gone")
    (tmp_path / "out" / "report.json").mkdir(parents=True)
    for way in ("file", "nowhere"):
        said = refusal(tmp_path / way / "new")
        assert said == (
            f"{tmp_path / way / 'new'}: nothing can be written there ({tmp_path / way} is not a folder)"
        )
    said = refusal(tmp_path / "out", "folded.obj", "report.json")
    assert said == f"{tmp_path / 'out' / 'report.json'}: it cannot be written: it is a folder"


@pytest.mark.parametrize("name", ["x" * 300, "a\0b"], ids=["too long", "NUL"])
def test_a_name_that_no_folder_can_have(tmp_path: Path, name: str) -> None:
    assert "nothing can be written there" in refusal(tmp_path / "new" / name)


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a file system that takes no files")
def test_a_file_system_that_takes_no_files() -> None:
    assert "nothing can be written there" in refusal(Path("/proc/self/new"))


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_the_right_to_write(tmp_path: Path) -> None:
    tmp_path.chmod(stat.S_IRUSR | stat.S_IXUSR)
    assert "nothing can be written there (Permission denied)" in refusal(tmp_path / "new")
    tmp_path.chmod(stat.S_IRWXU)
