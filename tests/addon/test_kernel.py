"""The extension says what computes: the compiled kernel, or numpy and scipy and why."""

from types import SimpleNamespace

import pytest


@pytest.fixture
def phrase(extension) -> str:
    return extension("solver.optimize.kernel").linear_algebra().phrase


def test_the_preferences_say_what_computes(extension, phrase, monkeypatch):
    preferences = extension("curvefold_addon.preferences")
    monkeypatch.setattr(preferences.keymaps, "draw", lambda layout, context: None)
    texts = []
    layout = SimpleNamespace(prop=lambda *a: None, label=lambda text: texts.append(text))
    preferences.CurvefoldPreferences.draw(SimpleNamespace(layout=layout), None)
    assert f"Linear algebra: {phrase}" in texts


def test_the_command_line_says_what_computes(extension, phrase, capsys):
    version = extension("solver.version").version()
    assert extension("curvefold_addon.cli").main(["--version"]) == 0
    assert capsys.readouterr().out.strip() == f"curvefold {version} ({phrase})"
