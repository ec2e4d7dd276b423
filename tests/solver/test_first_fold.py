"""Which way creases start to fold: sides that paper can have, and those that are drawn."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import solver
from benchmarks.straight_patterns import StraightPattern, miura, yoshimura
from solver.first_fold import choose_sides

LETTERS = {1: "V", -1: "M"}


def net_of(drawn: StraightPattern, folder: Path, letters: bool) -> solver.PiecewiseDog:
    path = folder / "drawing.svg"
    path.write_text(drawn.svg(), encoding="utf-8")
    pattern = solver.read_pattern(path)
    if not letters:
        creases = [replace(crease, assignment="U") for crease in pattern.creases]
        pattern = solver.CreasePattern(pattern.boundary, pattern.holes, creases)
    return solver.build_net(pattern, 24)


def sides_at_vertices(net: solver.PiecewiseDog) -> list[list[int]]:
    """The sides of the arms of each crease vertex inside the sheet."""
    chosen = choose_sides(net)
    points = net.crease_points
    arms: dict[tuple[float, float], list[int]] = defaultdict(list)
    low, high = net.flat.min(axis=0) + 1e-3, net.flat.max(axis=0) - 1e-3
    for k in np.flatnonzero(points.end):
        place = points.position[k]
        if (place > low).all() and (place < high).all():
            arms[tuple(np.round(place, 3).tolist())].append(int(chosen[points.chain[k]]))
    return list(arms.values())


def test_a_miura_fold_of_112_creases_finds_the_sides_that_it_is_folded_with(tmp_path: Path) -> None:
    """It has no others, but for turning the sheet over."""
    net = net_of(miura(8, 8), tmp_path, letters=False)
    drawn = net_of(miura(8, 8), tmp_path, letters=True)
    assert net.crease_letters == ("U",) * 112
    chosen = "".join(LETTERS[int(side)] for side in choose_sides(net))
    wanted = "".join(drawn.crease_letters)
    assert chosen in (wanted, wanted.translate(str.maketrans("MV", "VM")))


@pytest.mark.parametrize("pattern", [miura(6, 6), yoshimura(3, 4)], ids=lambda pattern: pattern.name)
def test_chosen_sides_keep_the_rules_of_crease_vertices(pattern: StraightPattern, tmp_path: Path) -> None:
    """Four arms: three of one side and one of the other (Maekawa); six: not all of one side."""
    vertices = sides_at_vertices(net_of(pattern, tmp_path, letters=False))
    assert len(vertices) > 5
    for arms in vertices:
        assert abs(sum(arms)) == 2 if len(arms) == 4 else abs(sum(arms)) < len(arms)


def test_the_same_drawing_starts_the_same_way(tmp_path: Path) -> None:
    net = net_of(miura(6, 6), tmp_path, letters=False)
    assert np.array_equal(choose_sides(net), choose_sides(net))


@pytest.mark.parametrize("drawn", ["MV", "VM"])
def test_drawn_sides_come_first_where_both_are_drawn(drawings: ModuleType, drawn: str) -> None:
    """Undrawn, the first crease is a valley."""
    plain = drawings.two_arcs()
    creases = [replace(c, assignment=letter) for c, letter in zip(plain.creases, drawn, strict=True)]
    pattern = solver.CreasePattern(plain.boundary, plain.holes, creases)
    m = solver.fold(pattern, solver.FoldDescription(resolution=9, angle=40.0)).measurement
    assert m.side(0) + m.side(1) == drawn


def test_creases_that_are_all_drawn_on_one_side_are_free(drawings: ModuleType) -> None:
    """Many programs draw every line in one colour: it means a line, not a side."""
    plain = drawings.two_arcs()
    pattern = solver.CreasePattern(plain.boundary, plain.holes, [replace(c, assignment="M") for c in plain.creases])
    assert choose_sides(solver.build_net(pattern, 9)).tolist() == [1, -1]


def test_drawn_sides_that_no_paper_can_have_are_not_taken(tmp_path: Path) -> None:
    pattern = miura(6, 6)
    # Rows red, columns blue: two and two at every vertex.
    wrong = replace(pattern, lines=tuple(("M" if a[0] != b[0] else "V", a, b) for _, a, b in pattern.lines))
    taken = choose_sides(net_of(wrong, tmp_path, letters=True))
    free = choose_sides(net_of(wrong, tmp_path, letters=False))
    assert np.array_equal(taken, free)


def test_what_is_bound_goes_before_what_is_drawn(drawings: ModuleType) -> None:
    plain = drawings.two_arcs()
    creases = [replace(c, assignment=letter) for c, letter in zip(plain.creases, "VM", strict=True)]
    net = solver.build_net(solver.CreasePattern(plain.boundary, plain.holes, creases), 9)
    assert choose_sides(net, {0: -1}).tolist()[0] == -1
