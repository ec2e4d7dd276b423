"""Every sample, profile and format, as libraries of others read them."""

import io
import re
from pathlib import Path

import ezdxf
import numpy as np
import plan_readers
import pypdf
import pytest
import shapely

import solver
from solver.plan.data import Kind
from solver.plan.planning import PlanDescription, PlanResult, plan
from solver.plan.profile import profile_names, read_profile
from solver.plan.writing import plan_files

SAMPLES = sorted(Path("sample_patterns").glob("*.svg"))
PROFILES = [name for name in profile_names() if not read_profile(name).draws(Kind.GROOVE)]
#: Lengths that other programs find differ by no more, mm.
NEAR = 0.01


def drawn(result: PlanResult) -> list[dict[str, float]]:
    """Of each page the length of lines by layers."""
    return [
        {part.layer.name: sum(walk.length for walk, _ in part.lines) for part in page.layers}
        for page in result.pages
    ]


def contents(result: PlanResult, suffix: str) -> list[bytes]:
    return list(plan_files(result.pages, f"plan{suffix}", "a plan").values())


@pytest.fixture(scope="module", params=SAMPLES, ids=lambda path: path.stem)
def sample(request: pytest.FixtureRequest) -> solver.CreasePattern:
    return solver.read_pattern(request.param)


@pytest.mark.parametrize("profile", PROFILES)
def test_every_format_has_every_line_at_its_true_length(sample: solver.CreasePattern, profile: str) -> None:
    result = plan(sample, PlanDescription(profile))
    wanted = drawn(result)
    assert wanted
    assert all(page for page in wanted)
    for found in (
        [plan_readers.svg_lengths(data) for data in contents(result, ".svg")],
        [plan_readers.dxf_lengths(data) for data in contents(result, ".dxf")],
        plan_readers.pdf_lengths(*contents(result, ".pdf")),
    ):
        assert [page.keys() for page in found] == [page.keys() for page in wanted]
        for page, expected in zip(found, wanted, strict=True):
            for layer, length in expected.items():
                assert page[layer] == pytest.approx(length, abs=NEAR, rel=1e-6), layer


def test_every_format_has_every_line_in_its_place(sample: solver.CreasePattern) -> None:
    result = plan(sample, PlanDescription("laser-glowforge"))
    (page,) = result.pages
    drawn = [walk.samples(1e-4)[0] for part in page.layers for walk, _ in part.lines]
    wanted = shapely.MultiLineString(drawn)
    for found in (
        plan_readers.svg_points(*contents(result, ".svg"), page.height),
        plan_readers.dxf_points(*contents(result, ".dxf")),
        plan_readers.pdf_points(*contents(result, ".pdf")),
    ):
        # Both ways: nothing is missing, and nothing lies elsewhere.
        ours, theirs = (shapely.points(np.vstack(rows)) for rows in (drawn, found))
        assert shapely.distance(wanted, theirs).max() < NEAR
        assert shapely.distance(shapely.MultiLineString(found), ours).max() < NEAR


def test_a_circle_stays_a_circle_and_an_arc_an_arc() -> None:
    ring = plan(solver.read_pattern("sample_patterns/annulus.svg"), PlanDescription("laser-glowforge"))
    document = plan_readers.read_dxf(contents(ring, ".dxf")[0])
    assert [entity.dxftype() for entity in document.modelspace()] == ["CIRCLE"] * 4
    assert sorted(entity.dxf.radius for entity in document.modelspace()) == pytest.approx([48, 62, 76, 90])
    assert contents(ring, ".svg")[0].count(b"<circle ") == 4
    lens = plan(solver.read_pattern("sample_patterns/lens.svg"), PlanDescription("laser-glowforge"))
    entities = plan_readers.read_dxf(contents(lens, ".dxf")[0]).modelspace()
    assert [entity.dxftype() for entity in entities] == ["ARC", "ARC", "LWPOLYLINE"]
    assert [entity.dxf.radius for entity in entities.query("ARC")] == pytest.approx([190.0, 190.0], abs=1e-3)
    radii = [float(radius) for radius in re.findall(rb'd="M[^"]*A([0-9.]+),', contents(lens, ".svg")[0])]
    assert radii == pytest.approx([190.0, 190.0], abs=1e-3)


def test_outlines_with_arcs_are_one_closed_polyline_with_bulges() -> None:
    fan = plan(solver.read_pattern("sample_patterns/fan.svg"), PlanDescription("laser-glowforge"))
    (outline,) = plan_readers.read_dxf(contents(fan, ".dxf")[0]).modelspace().query('*[layer=="cut"]')
    assert outline.dxftype() == "LWPOLYLINE"
    assert outline.closed
    assert sum(bool(bulge) for *_, bulge in outline.get_points("xyb")) == 2
    (cut,) = re.findall(rb'inkscape:label="border" d="([^"]*)"', contents(fan, ".svg")[0])
    assert cut.endswith(b"Z")
    assert cut.count(b"A") == 2


def test_curves_are_splines_and_never_chords() -> None:
    waves = plan(solver.read_pattern("sample_patterns/waves.svg"), PlanDescription("laser-glowforge"))
    entities = plan_readers.read_dxf(contents(waves, ".dxf")[0]).modelspace()
    assert [entity.dxftype() for entity in entities] == ["SPLINE"] * 3 + ["LWPOLYLINE"]
    assert all(spline.dxf.degree == 3 and len(spline.control_points) == 7 for spline in entities.query("SPLINE"))


@pytest.mark.parametrize("profile", PROFILES)
def test_auditors_find_nothing_wrong_in_dxf(sample: solver.CreasePattern, profile: str) -> None:
    for data in contents(plan(sample, PlanDescription(profile)), ".dxf"):
        document = plan_readers.read_dxf(data)
        assert not document.audit().errors
        assert document.dxfversion == "AC1015"
        assert document.units == ezdxf.units.MM


def test_the_same_plan_is_the_same_file() -> None:
    pattern = solver.read_pattern("sample_patterns/loop.svg")
    for suffix in (".svg", ".dxf", ".pdf"):
        first, second = (contents(plan(pattern, PlanDescription("origami")), suffix) for _ in range(2))
        assert first == second


def test_svg_has_millimetres_on_its_root_and_nothing_that_machines_misread(sample: solver.CreasePattern) -> None:
    result = plan(sample, PlanDescription("plotter"))
    (text,) = (data.decode() for data in contents(result, ".svg"))
    width, height, box = re.search(r'width="([\d.]+)mm" height="([\d.]+)mm" viewBox="0 0 ([\d. ]+)"', text).groups()
    assert f"{width} {height}" == box
    assert float(width) == pytest.approx(result.plan.width, abs=1e-4)
    for word in ("transform", "dasharray", "style", "clip", "class=", "<text", "%"):
        assert word not in text


def test_pdf_pages_have_the_size_of_the_plan() -> None:
    result = plan(solver.read_pattern("sample_patterns/lens.svg"), PlanDescription("packaging"))
    (page,) = pypdf.PdfReader(io.BytesIO(*contents(result, ".pdf"))).pages
    for box in (page.mediabox, page.cropbox, page.trimbox):
        assert float(box.width) * 25.4 / 72 == pytest.approx(230.0, abs=1e-4)
        assert float(box.height) * 25.4 / 72 == pytest.approx(168.0, abs=1e-4)


def test_packaging_has_spot_colours_and_processing_steps() -> None:
    result = plan(solver.read_pattern("sample_patterns/miura.svg"), PlanDescription("packaging"))
    reader = pypdf.PdfReader(io.BytesIO(*contents(result, ".pdf")))
    groups = [entry.get_object() for entry in reader.trailer["/Root"]["/OCProperties"]["/OCGs"]]
    steps = {group["/Name"]: group["/GTS_Metadata"]["/GTS_ProcStepsType"] for group in groups}
    assert steps == {
        "Valley creases": "/ReverseCreasing",
        "Mountain creases": "/Creasing",
        "Cut": "/Cutting",
    }
    assert {group["/GTS_Metadata"]["/GTS_ProcStepsGroup"] for group in groups} == {"/Structural"}
    spaces = [space.get_object() for space in reader.pages[0]["/Resources"]["/ColorSpace"].values()]
    assert {space[0] for space in spaces} == {"/Separation"}
    assert {space[1] for space in spaces} == {"/Reverse Crease", "/Crease", "/Cut"}


def test_the_back_is_the_front_mirrored_with_its_marks() -> None:
    result = plan(solver.read_pattern("sample_patterns/miura.svg"), PlanDescription("two-sided"))
    files = plan_files(result.pages, "x.svg", "x")
    assert [path.name for path in files] == ["x-front.svg", "x-back.svg"]
    front, back = result.pages
    assert (front.width, front.height) == (back.width, back.height)
    layers = [{part.layer.name: part.lines for part in page.layers} for page in (front, back)]
    assert "score mountain" in layers[0]
    assert "score mountain" not in layers[1]
    assert "score valley" in layers[1]
    assert "cut" not in layers[1]
    # A mark of the back lies on one of the front when the sheet is turned about its upright middle.
    rings = [
        {
            (round(walk.pieces[0].centre.real, 6), round(walk.pieces[0].centre.imag, 6))
            for walk, _ in lines
            if walk.closed
        }
        for lines in (layers[0]["registration"], layers[1]["registration"])
    ]
    assert len(rings[0]) == 3
    assert rings[1] == {(round(front.width - x, 6), y) for x, y in rings[0]}
    assert rings[1] != rings[0]
