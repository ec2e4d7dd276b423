"""Tabs where borders are glued: the outline goes round them, and both sides have the joint's number."""

from __future__ import annotations

import math

import numpy as np
import plan_readers
import pytest
import shapely

import solver
from solver.errors import DescriptionError, PatternError
from solver.plan.data import Kind, Plan
from solver.plan.planning import PlanDescription, plan
from solver.plan.source import Joint, PlanSource
from solver.plan.writing import plan_files

STRIP = [(0, 0), (200, 0), (200, 50), (0, 50)]
#: The right border on the left one.
ENDS = Joint(((200, 0), (200, 50)), ((0, 0), (0, 50)))


def strip(*joints: Joint, boundary: object = STRIP) -> PlanSource:
    return PlanSource(solver.CreasePattern(boundary, (), (), "strip", 1.0), joints=joints)


def tabbed(source: PlanSource, width: float = 10.0) -> Plan:
    return plan(source, PlanDescription(tabs_mm=width)).plan


def area(made: Plan) -> shapely.Polygon:
    (border,) = made.having(Kind.BORDER)
    assert border.walk.closed
    return shapely.Polygon(border.walk.samples(1e-3)[0])


def test_the_outline_goes_round_a_tab() -> None:
    made = tabbed(strip(ENDS))
    # A trapezoid of 50 mm at its foot and 40 mm at its other side.
    assert area(made).area == pytest.approx(200.0 * 50.0 + 10.0 * 45.0)
    assert area(made).bounds == pytest.approx((0.0, 0.0, 210.0, 50.0))
    assert (made.width, made.height) == pytest.approx((210.0, 50.0))


def test_the_foot_of_a_tab_is_scored() -> None:
    (score,) = tabbed(strip(ENDS)).having(Kind.FLAT)
    assert {score.walk.at(0.0), score.walk.pieces[-1].end} == {200 + 0j, 200 + 50j}


def test_the_number_stands_on_the_tab_and_where_it_is_glued_to() -> None:
    names = [stroke for stroke in tabbed(strip(ENDS)).having(Kind.NAME) if stroke.name == "tab 1"]
    places = [np.mean(stroke.walk.samples(1e-3)[0], axis=0) for stroke in names]
    assert any(200 < x < 210 and 15 < y < 35 for x, y in places)
    assert any(0 < x < 6 and 20 < y < 30 for x, y in places)


def test_a_tab_on_the_left_moves_the_sheet_into_its_page() -> None:
    made = tabbed(strip(Joint(ENDS.second, ENDS.first)))
    assert area(made).bounds == pytest.approx((0.0, 0.0, 210.0, 50.0))
    (score,) = made.having(Kind.FLAT)
    assert score.walk.at(0.0).real == pytest.approx(10.0)


def test_a_curved_border_has_teeth() -> None:
    t = np.linspace(0.0, math.pi, 200)
    arch = np.vstack([np.column_stack([100 * np.cos(t), 100 * np.sin(t)]), [(-100, -80), (100, -80)]])
    made = tabbed(strip(Joint(((100, 0), (-100, 0)), ((-100, -80), (100, -80))), boundary=arch), 8.0)
    teeth = math.ceil(100 * math.pi / 12.0)
    (border,) = made.having(Kind.BORDER)
    # Three sides a tooth, and the three sides of the rest.
    assert len(border.walk.pieces) == 3 * teeth + 3
    assert area(made).is_valid
    assert 8.0 * 0.6 * 100 * math.pi < area(made).area - area(tabbed_off(arch)).area < 8.0 * 108 * math.pi


def tabbed_off(boundary: object) -> Plan:
    return plan(strip(boundary=boundary), PlanDescription()).plan


def test_several_tabs_are_on_one_outline() -> None:
    made = tabbed(strip(Joint(((0, 0), (200, 0)), ((0, 50), (200, 50))), ENDS))
    assert area(made).area == pytest.approx(200.0 * 50.0 + 10.0 * 45.0 + 10.0 * 195.0)
    assert len(made.having(Kind.FLAT)) == 2


def test_tabs_without_room_are_refused_with_the_place() -> None:
    notch = [(0, 0), (100, 0), (100, 100), (54, 100), (54, 20), (46, 20), (46, 100), (0, 100)]
    joint = Joint(((54, 100), (54, 20)), ((46, 100), (46, 20)))
    assert area(tabbed(strip(joint, boundary=notch), 4.0)).is_valid
    with pytest.raises(PatternError, match=r"joint 1 at \(54, .*\): a tab of 10 mm has no room"):
        tabbed(strip(joint, boundary=notch))


def test_glued_borders_that_overlap_are_refused() -> None:
    with pytest.raises(PatternError, match="overlap"):
        tabbed(strip(ENDS, Joint(((200, 10), (200, 40)), ((0, 10), (0, 40)))))


def test_without_glued_borders_there_are_no_tabs() -> None:
    with pytest.raises(PatternError, match="no glued borders"):
        tabbed(strip())
    with pytest.raises(PatternError, match="no glued borders"):
        tabbed(strip(Joint(((0, 0),), ((200, 0),))))
    with pytest.raises(DescriptionError, match="more than 0"):
        PlanDescription(tabs_mm=0.0)


def test_the_outline_is_one_closed_polyline_for_others() -> None:
    result = plan(strip(ENDS), PlanDescription("laser-glowforge", tabs_mm=10.0))
    document = plan_readers.read_dxf(*plan_files(result.pages, "x.dxf", "x").values())
    assert not document.audit().errors
    (outline,) = document.modelspace().query('*[layer=="cut"]')
    assert outline.closed
    assert len(outline) == 6


def test_a_fold_that_glues_has_tabs(tmp_path: object) -> None:
    pattern = solver.CreasePattern(STRIP, (), (), "strip", 1.0)
    glue = solver.Glue(ENDS.first, ENDS.second)
    result = solver.fold(pattern, solver.FoldDescription(resolution=12, angle=None, controls=(glue,)))
    solver.write_results(result, tmp_path)
    made = plan(tmp_path, PlanDescription(tabs_mm=10.0)).plan
    assert area(made).area == pytest.approx(200.0 * 50.0 + 10.0 * 45.0)
