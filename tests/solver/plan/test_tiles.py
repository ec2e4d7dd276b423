"""Plans on several sheets of paper."""

from __future__ import annotations

import io

import pypdf
import pytest

import solver
from solver.errors import DescriptionError
from solver.plan.planning import PlanDescription, PlanResult, plan
from solver.plan.profile import PAPERS
from solver.plan.writing import plan_files


def printed(sample: str, tile: str | None = None, scale: float = 1.0) -> PlanResult:
    pattern = solver.read_pattern(f"sample_patterns/{sample}.svg", solver.ReadOptions(scale=scale))
    return plan(pattern, PlanDescription("print", tile=tile))


def test_a_sheet_that_fits_is_one_page() -> None:
    (page,) = printed("lens").pages
    assert (page.width, page.height) == (297.0, 210.0)


@pytest.mark.parametrize("tile", list(PAPERS))
def test_pages_have_the_size_of_the_paper(tile: str) -> None:
    result = printed("strip", tile)
    reader = pypdf.PdfReader(io.BytesIO(*plan_files(result.pages, "x.pdf", "x").values()))
    for page in reader.pages:
        sides = sorted(float(side) * 25.4 / 72 for side in (page.mediabox.width, page.mediabox.height))
        assert sides == pytest.approx(sorted(PAPERS[tile]), abs=1e-3)


def test_every_point_of_the_sheet_is_on_a_page_at_its_true_place() -> None:
    result = printed("lens", "A5", 1.7)
    pages = {page.name: page for page in result.pages}
    assert list(pages) == ["map", "1-1", "1-2", "2-1", "2-2", "3-1", "3-2"]
    # Pages overlap by 10 mm: what is drawn twice is what lies in the overlaps.
    border = result.plan.strokes[0].walk.length
    shown = sum(
        walk.length
        for name, page in pages.items()
        if name != "map"
        for part in page.layers
        for walk, label in part.lines
        if label == "border"
    )
    assert border < shown <= border + 2 * 2 * 10.0 + 2 * 10.0 + 1e-6


def test_marks_of_pages_side_by_side_are_on_the_same_place_of_the_sheet() -> None:
    result = printed("strip", "A5")
    first, second = result.pages[1:3]
    lines = [
        [walk for part in page.layers for walk, name in part.lines if name == "registration"]
        for page in (first, second)
    ]
    middles = [
        sorted({round(walk.at(0.5 * walk.length).real, 3) for walk in some if walk.length == 6.0}) for some in lines
    ]
    # The right-hand marks of one page are the left-hand ones of the next: 10 mm of overlap, 5 mm to its middle.
    edge = 10.0
    assert middles[0][-1] == pytest.approx(first.width - edge - 5.0)
    assert middles[1][0] == pytest.approx(edge + 5.0)


def test_each_page_has_a_bar_of_100_mm() -> None:
    for page in printed("strip", "A5").pages[1:]:
        bars = [walk.length for part in page.layers for walk, name in part.lines if name == "bar of 100 mm"]
        assert max(bars) == 100.0


def test_a_sheet_larger_than_a_hundred_pages_is_refused() -> None:
    with pytest.raises(DescriptionError, match=r"needs .* pages of A5, and 100 are made at most"):
        printed("lens", "A5", 30.0)


def test_a_front_and_a_back_are_not_printed_in_tiles() -> None:
    with pytest.raises(DescriptionError, match="front and a back"):
        plan(solver.read_pattern("sample_patterns/lens.svg"), PlanDescription("two-sided", tile="A4"))


def test_other_profiles_can_be_printed_too() -> None:
    result = plan(solver.read_pattern("sample_patterns/strip.svg"), PlanDescription("origami", tile="A5"))
    assert [page.name for page in result.pages] == ["map", "1-1", "1-2"]
