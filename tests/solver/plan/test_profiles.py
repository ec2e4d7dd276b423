"""Profiles: those of the house, and one sentence for what is wrong in somebody's own."""

from __future__ import annotations

from pathlib import Path

import pytest

import solver
from solver.errors import DescriptionError
from solver.plan.data import Kind
from solver.plan.planning import PlanDescription, plan
from solver.plan.profile import FOLDER, profile_names, read_profile

SMALL = """
about = "a profile"
[[layer]]
name = "cut"
kinds = ["border", "hole"]
"""


def own(folder: Path, text: str) -> Path:
    path = folder / "own.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", profile_names())
def test_profiles_of_the_house_draw_the_sheet_and_its_creases(name: str) -> None:
    profile = read_profile(name)
    assert profile.about
    for kind in (Kind.BORDER, Kind.HOLE, Kind.FLAT):
        assert profile.draws(kind)
    assert profile.draws(Kind.GROOVE) or (profile.draws(Kind.MOUNTAIN) and profile.draws(Kind.VALLEY))


def test_red_is_a_mountain_for_folders_and_a_cut_for_lasers() -> None:
    colours = {
        name: {layer.colour for layer in read_profile(name).layers if kind in layer.kinds}
        for name, kind in (
            ("origami", Kind.MOUNTAIN),
            ("laser-lightburn", Kind.BORDER),
            ("laser-glowforge", Kind.BORDER),
        )
    }
    assert set(map(frozenset, colours.values())) == {frozenset({"#ff0000"})}


def test_one_colour_is_one_process_on_a_laser() -> None:
    for name in ("laser-lightburn", "laser-glowforge"):
        colours = [layer.colour for layer in read_profile(name).layers]
        assert len(set(colours)) == len(colours)


def test_a_copy_that_is_changed_is_a_profile(tmp_path: Path) -> None:
    text = (FOLDER / "plotter.toml").read_text(encoding="utf-8").replace("dash_mm = [3.0, 1.5]", "dash_mm = [5, 2]")
    profile = read_profile(own(tmp_path, text))
    assert profile.name == "own"
    assert {layer.dash_mm for layer in profile.layers} == {(5.0, 2.0), ()}
    assert plan(solver.read_pattern("sample_patterns/lens.svg"), PlanDescription(own(tmp_path, text))).pages


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("about", "abuot"), "the profile has an unknown key 'abuot', the nearest known one is 'about'"),
        (
            ("kinds", "kind"),
            "layer 1 (cut) has an unknown key 'kind', the nearest known one is 'kinds'",
        ),
        (('"hole"', '"holes"'), "unknown value 'holes', the nearest known one is 'hole'"),
        (('name = "cut"', ""), "layer 1 lacks the key 'name'"),
        (('about = "a profile"', ""), "the profile lacks the key 'about'"),
        (("[[layer]]", "[[layers]]"), "the nearest known one is 'layer'"),
        (("[[layer]]", "colour = 3\n[[layer]]"), "unknown key 'colour'"),
        (("kinds", 'colour = "red"\nkinds'), 'it must be a colour such as "#ff0000"'),
        (("kinds", "dash_mm = [1]\nkinds"), "a dash and a gap"),
        (("kinds", "dash_mm = [0, 1]\nkinds"), "from 0.05 to 1000"),
        (("kinds", "width_mm = true\nkinds"), "it must be a number"),
        (("kinds", 'face = "rear"\nkinds'), "unknown value 'rear'"),
        (("[[layer]]", 'pages = "tile"\n[[layer]]'), "the nearest known one is 'tiles'"),
        (("[[layer]]", "groove_passes = 1\n[[layer]]"), "a whole number from 2"),
        (("[[layer]]", "registration = 1\n[[layer]]"), "true or false"),
        (("[[layer]]", "[layer"), "not valid TOML"),
    ],
)
def test_a_mistake_is_one_sentence_with_the_file(tmp_path: Path, change: tuple[str, str], sentence: str) -> None:
    with pytest.raises(DescriptionError) as caught:
        read_profile(own(tmp_path, SMALL.replace(*change, 1)))
    assert sentence in str(caught.value)
    assert "own.toml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_unknown_profile_names_the_nearest_one() -> None:
    with pytest.raises(
        DescriptionError, match="no profile 'laser-lightburm', the nearest known one is 'laser-lightburn'"
    ):
        read_profile("laser-lightburm")


def test_a_profile_that_is_not_there_or_no_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="cannot be read"):
        read_profile(tmp_path / "none.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(DescriptionError, match="not valid TOML"):
        read_profile(tmp_path / "bytes.toml")
