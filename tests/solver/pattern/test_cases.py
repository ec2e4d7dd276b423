"""Small drawings of the kinds that people and programs make, and what each means.

Every file of ``cases/`` stands for a kind of drawing; the notes that explain a reading are a part of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import shapely

import solver
from solver.drive import MAX_MEAN_STRETCH

CASES = Path(__file__).parent / "cases"


@dataclass(frozen=True)
class Meant:
    """What a drawing means: the area of its sheet, its holes, its creases' letters, and words of its notes.

    Letters are sorted. Each entry of notes is words of one note.
    """

    area: float
    letters: str
    notes: tuple[tuple[str, ...], ...] = ()
    holes: int = 0
    unit_mm: float | None = None


MEANT = {
    # no border is drawn: the page is the sheet
    "viewbox_sheet.svg": Meant(1e4, "U", (("no border is drawn", "the page is the sheet"),)),
    # one curve as many strokes
    "lines12.svg": Meant(1e4, "U", (("12 strokes", "continue each other", "1 line"),), unit_mm=1.0),
    "split.svg": Meant(1e4, "U", (("10 strokes", "continue each other", "1 line"),)),
    "split40.svg": Meant(1e4, "U", (("40 strokes", "continue each other", "1 line"),)),
    # ends that stop short: read as they are drawn, and joined where the net is made
    "one_gap.svg": Meant(1e4, "U"),
    "flaps_gap0.3.svg": Meant(4300, "UUUUUUUU"),
    # borders that do not quite close
    "gap_small.svg": Meant(1e4, "U", (("border was open by 0.03", "closed"),)),
    "corner_gap.fold": Meant(1e4, "V", (("border was open by 0.021", "closed"),)),
    # words before dashes before colours
    "green_crease_layer.svg": Meant(1e4, "U", (("alone would mean a cut", "'CREASE'", "unassigned crease"),)),
    "dashed_green_fold.svg": Meant(1e4, "U", (("alone would mean a cut", "dashed", "unassigned crease"),)),
    "cad_layers.svg": Meant(1e4, "U", (("'DIM'", "left out: dimension line"), ("'CUT'", "border"))),
    "red_cut_class.svg": Meant(1e4 - np.pi * 64, "U", (("'cut'", "hole"), ("'cut'", "border")), holes=1),
    "blue_mountain_class.svg": Meant(1e4, "MV", (("'mountain'", "mountain crease"),)),
    "valley_group_hue.svg": Meant(1e4, "V", (("'valley'", "class of its group"),)),
    "data_assignment.svg": Meant(1.0, "V", (("'V'", "valley crease (data-assignment)"),)),
    # lines that happen to enclose something, and a slit
    "hash_hole.svg": Meant(1e4, "U", (("4 strokes", "left out", "cut"),)),
    "slit_black.svg": Meant(1e4, "U", (("1 stroke", "left out", "cut inside the sheet"),)),
    # a frame called folded that is not folded yet
    "foldedform_flat_xz.fold": Meant(1.0, "V", (("folded form lies flat",),), unit_mm=100.0),
    # all sides are drawn
    "miura8.svg": Meant(1e4, "M" * 60 + "V" * 52),
    "miurab8.svg": Meant(1e4, "M" * 60 + "V" * 52),
    "strip20x1.svg": Meant(2000, "U" * 19, unit_mm=1.0),
    "arcs2.svg": Meant(2e4, "U" * 5),
    # colours as a browser computes them
    "figma_colours.svg": Meant(1e4, "MV", unit_mm=1.0),
    "icc_colour.svg": Meant(1e4, "MV", unit_mm=1.0),
    "important.svg": Meant(1e4, "MV", unit_mm=1.0),
    "entity.svg": Meant(1e4, "U", unit_mm=1.0),
    # one line, two meanings
    "red_on_blue.svg": Meant(1e4, "U", (("a mountain and as a valley", "#ff0000", "#0000ff"),), unit_mm=1.0),
    "no_unit.svg": Meant(283.46**2, "U", (("no physical size", "1 mm"),)),
    "hairline.svg": Meant(1e4, "U", (("2 strokes of width 0", "hairlines"),), unit_mm=1.0),
    "blank.svg": Meant(1e4, "", (("no crease", "blank paper"),)),
    # two of the sample drawings as Inkscape exports them: with splines, and with lines for curves
    "inkscape_r14.dxf": Meant(180 * 120, "U", (("no physical size", "1 mm"),)),
    "inkscape_r12.dxf": Meant(25_132.7, "UUUU", (("192 strokes", "continue each other", "6 lines"),)),
}
#: Files of several sheets, each like the first.
SHEETS = {"three_sheets.svg": (3, Meant(1200, "U")), "two_sheets.fold": (2, Meant(1.0, "V", unit_mm=100.0))}


def check(pattern: solver.CreasePattern, meant: Meant) -> None:
    assert shapely.Polygon(pattern.boundary, pattern.holes).area == pytest.approx(meant.area, rel=1e-3)
    assert len(pattern.holes) == meant.holes
    assert "".join(sorted(crease.assignment for crease in pattern.creases)) == meant.letters
    assert pattern.unit_mm == (None if meant.unit_mm is None else pytest.approx(meant.unit_mm))
    for words in meant.notes:
        assert any(all(word in note for word in words) for note in pattern.notes), (words, pattern.notes)


def test_every_case_is_here() -> None:
    assert {path.name for path in CASES.iterdir()} == {*MEANT, *SHEETS}


@pytest.mark.parametrize("name", MEANT)
def test_a_drawing_is_read_as_it_is_meant(name: str) -> None:
    [pattern] = solver.read_patterns(CASES / name)
    check(pattern, MEANT[name])


@pytest.mark.parametrize("name", SHEETS)
def test_each_sheet_of_a_file_is_read(name: str) -> None:
    count, meant = SHEETS[name]
    patterns = solver.read_patterns(CASES / name)
    assert [pattern.name for pattern in patterns] == [f"{Path(name).stem} {k + 1}" for k in range(count)]
    for pattern in patterns:
        check(pattern, meant)
    boxes = [shapely.Polygon(pattern.boundary) for pattern in patterns]
    assert shapely.union_all(boxes).area == pytest.approx(sum(box.area for box in boxes))
    # One alone is never silently all of them.
    first = solver.read_pattern(CASES / name)
    assert any(f"{count} sheets" in note for note in first.notes)
    second = solver.read_pattern(CASES / name, solver.ReadOptions(sheet=2))
    assert second.boundary.tolist() == patterns[1].boundary.tolist()
    with pytest.raises(solver.PatternError, match=f"{count} sheets, and sheet 9"):
        solver.read_pattern(CASES / name, solver.ReadOptions(sheet=9))


def test_the_page_may_be_chosen_where_an_outline_is_drawn() -> None:
    path = CASES / "cad_layers.svg"
    page = solver.read_pattern(path, solver.ReadOptions(border="page"))
    assert shapely.Polygon(page.boundary).area == pytest.approx(120**2)
    with pytest.raises(solver.PatternError, match="no border found"):
        solver.read_pattern(CASES / "viewbox_sheet.svg", solver.ReadOptions(border="outline"))


@pytest.mark.parametrize(
    ("unit", "scale", "unit_mm"),
    [(None, 1.0, None), ("cm", 1.0, 10.0), ("72dpi", 1.0, 25.4 / 72), (None, 2.0, 2.0), ("in", 0.5, 12.7)],
)
def test_unit_and_scale_are_chosen_where_the_file_has_none(
    unit: str | None, scale: float, unit_mm: float | None
) -> None:
    pattern = solver.read_pattern(CASES / "no_unit.svg", solver.ReadOptions(unit=unit, scale=scale))
    assert pattern.unit_mm == (None if unit_mm is None else pytest.approx(unit_mm))


def test_a_refused_drawing_tells_what_its_lines_were_taken_for(tmp_path: Path) -> None:
    path = tmp_path / "open.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">'
        '<path d="M0 0H100V100H0V30" fill="none" stroke="#000"/><path d="M0 80H100" stroke="red"/>'
        '<path d="M20 50H80" stroke="#0f0"/></svg>'
    )
    with pytest.raises(solver.PatternError, match=r"border at \(0, 85\): the border does not close") as refused:
        solver.read_pattern(path)
    assert any("of colour #00ff00: cut" in note for note in refused.value.notes)


def test_sides_that_contradict_each_other_do_not_bind() -> None:
    pattern = solver.read_pattern(CASES / "red_on_blue.svg")
    with pytest.raises(solver.PatternError, match="mountain and as a valley"):
        solver.fold(pattern, solver.FoldDescription(assignments="bind"))


def test_a_contradiction_on_one_sheet_leaves_the_others_free(tmp_path: Path) -> None:
    path = tmp_path / "two.svg"
    twice = "".join(f'<path d="M120 40H180" stroke="{colour}"/>' for colour in ("red", "blue"))
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 60"><g fill="none" stroke="#000">'
        '<rect width="60" height="60"/><rect x="120" width="60" height="60"/></g>'
        f'<path d="M0 20H60" stroke="red"/><path d="M0 40H60" stroke="blue"/>{twice}</svg>'
    )
    first, second = solver.read_patterns(path)
    assert first.conflicts == ()
    assert len(second.conflicts) == 1


# ---- folded, by what the drive makes of the reading


@pytest.mark.parametrize("name", ["split40.svg", "one_gap.svg", "strip20x1.svg"])
def test_a_drawing_folds_to_the_angle_that_is_asked(name: str) -> None:
    result = solver.fold(solver.read_pattern(CASES / name))
    assert result.status.ok, result.detail
    assert result.report()["fold_angle"][1] == pytest.approx(60.0, abs=1.5)
    assert result.measurement.stretch.mean() < MAX_MEAN_STRETCH


def test_flaps_that_stop_short_of_the_border_fold() -> None:
    result = solver.fold(solver.read_pattern(CASES / "flaps_gap0.3.svg"))
    assert result.measurement.folded_part == 1.0
    assert result.report()["fold_angle"][1] > 47.0


def test_a_curve_in_forty_pieces_folds_in_as_many_steps_as_the_curve(tmp_path: Path) -> None:
    path = tmp_path / "curve.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><rect width="100" height="100" '
        'fill="none" stroke="#000"/><path d="M0 40Q50 80 100 40" fill="none" stroke="#f00"/></svg>'
    )
    whole, pieces = (solver.fold(solver.read_pattern(p)) for p in (path, CASES / "split40.svg"))
    assert pieces.iterations == pytest.approx(whole.iterations, rel=0.2)
    assert len(pieces.net.rest) == len(whole.net.rest)
