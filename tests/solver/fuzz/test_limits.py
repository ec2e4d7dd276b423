"""Huge drawings are simplified or refused with one sentence, before time and memory are gone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import solver
from solver.net.layout import MAX_VERTICES

BOX = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def wave(count: int) -> solver.Crease:
    x = np.linspace(0.0, 1.0, count)
    return solver.Crease(np.column_stack([x, 0.5 + 0.1 * np.sin(3 * x)]))


def scribble(count: int) -> solver.CreasePattern:
    return solver.CreasePattern(BOX, creases=[solver.Crease(np.random.default_rng(0).random((count, 2)))])


def stack(count: int) -> solver.CreasePattern:
    heights = np.linspace(0.001, 0.99, count)
    return solver.CreasePattern(BOX, creases=[solver.Crease([(0, y), (0.5, y + 0.001), (1, y)]) for y in heights])


def fan(count: int) -> solver.CreasePattern:
    heights = np.linspace(0.001, 0.99, count)
    return solver.CreasePattern(BOX, creases=[solver.Crease([(0, y), (1, 1 - y)]) for y in heights])


def hatching(count: int) -> solver.CreasePattern:
    """Count times count crossings."""
    at = np.linspace(0.05, 0.95, count)
    upright = [solver.Crease([(x + 0.01, 0), (x - 0.01, 1)]) for x in at]
    level = [solver.Crease([(0, y + 0.01), (1, y - 0.01)]) for y in at]
    return solver.CreasePattern(BOX, creases=[*upright, *level])


def tangle(count: int) -> solver.CreasePattern:
    """A line that nearly retraces itself all over the sheet."""
    k = np.arange(count)
    return solver.CreasePattern(
        BOX, creases=[solver.Crease(0.5 + np.column_stack([0.5 * np.cos(0.1 * k), 0.45 * np.sin(0.07 * k)]))]
    )


#: Drawing, resolution, words of the sentence.
REFUSED: dict[str, tuple[Callable[[], solver.CreasePattern], int, tuple[str, ...]]] = {
    "100,000 points that mean something": (lambda: scribble(100_000), 32, ("100,004 points",)),
    "5,000 creases": (lambda: stack(5_000), 32, ("5,000 creases", "1,000")),
    "creases that cross too often": (lambda: fan(700), 32, ("cross", "20,000")),
    "more crossings than lines can cross": (
        lambda: hatching(40),
        10,
        ("cross 1,600 times", "841 crossings", "about 14 quads"),
    ),
    "a tangle": (lambda: tangle(600), 10, ("creases at (", "pieces of paper", "thinner than a thousandth")),
    "resolution 1,000": (lambda: solver.CreasePattern(BOX, creases=[wave(41)]), 1000, ("resolution", "1,000,000")),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_too_much_is_refused(name: str) -> None:
    make, resolution, words = REFUSED[name]
    with pytest.raises((solver.PatternError, solver.NetError)) as caught:
        solver.build_net(make(), resolution)
    assert len(str(caught.value).splitlines()) == 1
    for word in words:
        assert word in str(caught.value)


def test_the_quads_that_crossings_are_said_to_need_are_enough() -> None:
    assert len(solver.build_net(hatching(40), 14).chain_crease) > 3000


def test_a_hundred_thousand_points_on_smooth_curves_are_simplified() -> None:
    t = np.linspace(0.0, 2 * np.pi, 50_000, endpoint=False)
    disc = 0.5 + 0.5 * np.column_stack([np.cos(t), np.sin(t)])
    many = solver.build_net(solver.CreasePattern(disc, creases=[wave(50_000)]), 16)
    few = solver.build_net(solver.CreasePattern(disc[::250], creases=[wave(200)]), 16)
    assert any("100,000 points were simplified" in note for note in many.notes)
    assert not few.notes
    assert len(many.rest) == len(few.rest)
    assert np.abs(many.crease_points.position - few.crease_points.position).max() < 5e-3


def test_a_long_strip_may_be_as_fine_as_it_likes() -> None:
    """What counts is the number of vertices, not the resolution."""
    strip = solver.CreasePattern(
        [(0, 0), (1, 0), (1, 0.004), (0, 0.004)], creases=[solver.Crease([(0, 0.001), (0.5, 0.003), (1, 0.001)])]
    )
    assert len(solver.build_net(strip, 1000).rest) < MAX_VERTICES
