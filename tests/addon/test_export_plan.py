"""File > Export > Crease Pattern Plan: what is written of a paper, and what is refused."""

import re
from pathlib import Path

import bmesh
import bpy
import papers
import pytest

TWO = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<rect width="100" height="100" fill="none" stroke="black"/>
<path d="M 0 30 Q 50 40 100 30" fill="none" stroke="red"/>
<path d="M 0 70 Q 50 80 100 70" fill="none" stroke="blue"/>
</svg>
"""


@pytest.fixture
def folder(tmp_path):
    """Empty, unlike the one that the drawing lies in."""
    (tmp_path / "plans").mkdir()
    return tmp_path / "plans"


@pytest.fixture
def export(folder):
    def write(name="plan.svg", **options):
        path = folder / name
        assert bpy.ops.curvefold.export_plan(filepath=str(path), **options) == {"FINISHED"}
        return path

    return write


@pytest.fixture
def folded(paper, live):
    paper.data.curvefold.fold = 60.0
    live.settle(paper.data)
    return paper


def layers(path: Path) -> dict[str, list[str]]:
    """The labels of lines by layers."""
    text = path.read_text(encoding="utf-8")
    return {
        name: re.findall(r'<(?:path|circle) inkscape:label="([^"]*)"', body)
        for name, body in re.findall(
            r'<g id="[^"]*" inkscape:groupmode="layer" inkscape:label="([^"]*)"(.*?)</g>', text, re.S
        )
    }


def refused(capfd, **options):
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.curvefold.export_plan(**options)
    return str(caught.value)


def test_it_is_the_sheet_in_true_size_with_sides_as_they_are_folded(extension, live, folded, export):
    text = export().read_text(encoding="utf-8")
    # A sheet of 100 mm with a margin of 5 mm.
    assert 'width="110mm" height="110mm" viewBox="0 0 110 110"' in text
    side = live.session(folded.data).measurement.side(0)
    found = layers(export())
    assert [name for name in found if name in ("mountain", "valley", "flat")] == [
        {"M": "mountain", "V": "valley"}[side]
    ]
    assert found["border"] == ["border"]


def test_a_flat_paper_is_as_it_is_drawn(extension, export, tmp_path):
    papers.paper_of(extension, tmp_path, TWO)
    found = layers(export())
    assert (found["mountain"], found["valley"]) == (["crease 1 (Crease 1)"], ["crease 2 (Crease 2)"])


def test_marks_stand_where_handles_are(extension, folded, live, export):
    assert "marks" not in layers(export())
    entry = folded.data.curvefold.handles.add()
    entry.name = "Handle 1"
    entry.at = (0.02, 0.03)
    entry.offset = (0.02, 0.03, 0.0)
    entry.pinned = True
    live.settle(folded.data)
    found = layers(export())
    assert found["marks"] == ["handle 1"] * 2


def test_rulings_are_drawn_when_they_are_asked_for(folded, export):
    assert "rulings" not in layers(export())
    assert len(layers(export(rulings=True))["rulings"]) > 5


@pytest.mark.parametrize("profile", ["two-sided", "board"])
def test_profiles_with_two_faces_are_two_files(folded, export, folder, profile):
    export("x.svg", profile=profile)
    assert sorted(path.name for path in folder.iterdir()) == ["x-back.svg", "x-front.svg"]


def test_a_pdf_is_one_file_whatever_its_pages(folded, export, folder):
    data = export("x.pdf", profile="print", tile="A5", scale=3.0).read_bytes()
    assert data.startswith(b"%PDF-1.6")
    assert data.count(b"/Type /Page ") > 4
    assert [path.name for path in folder.iterdir()] == ["x.pdf"]


def test_scenes_and_scale_say_how_large_it_is(folded, export):
    bpy.context.scene.unit_settings.scale_length = 0.5
    try:
        text = export(scale=3.0).read_text(encoding="utf-8")
    finally:
        bpy.context.scene.unit_settings.scale_length = 1.0
    assert 'width="160mm"' in text


def test_a_name_without_suffix_has_that_of_the_format(folded, folder):
    assert bpy.ops.curvefold.export_plan(filepath=str(folder / "x"), file_format=".pdf") == {"FINISHED"}
    assert (folder / "x.pdf").is_file()


def test_an_own_profile_is_read(extension, folded, export, folder):
    house = extension("solver.plan.profile").FOLDER
    own = folder / "own.toml"
    own.write_text((house / "origami.toml").read_text(encoding="utf-8").replace('"border"\n', '"edge"\n', 1))
    assert "edge" in layers(export(profile="FILE", profile_file=str(own)))


def test_somebodys_own_file_is_left_alone(capfd, folded, folder):
    own = folder / "own.svg"
    own.write_text("<svg/>")
    assert "a file that is no plan has this name already" in refused(capfd, filepath=str(own))
    assert own.read_text() == "<svg/>"


def test_what_cannot_be_written_is_one_sentence(capfd, folded, folder):
    own = folder / "own.toml"
    own.write_text("abuot = 1")
    words = refused(capfd, filepath=str(folder / "x.svg"), profile="FILE", profile_file=str(own))
    assert "the nearest known one is 'about'" in words
    assert "only .svg, .dxf, .pdf" in refused(capfd, filepath=str(folder / "x.png"))
    assert "No file was chosen" in refused(capfd)
    assert [path.name for path in folder.iterdir()] == ["own.toml"]


def test_every_profile_of_the_house_is_offered(extension):
    offered = {name for name, *_ in extension("curvefold_addon.operators.export_plan").PROFILES}
    assert offered == {*extension("solver").profile_names(), "FILE"}


def test_it_stands_in_the_menu_and_changes_nothing(folded, export):
    before = bytes(folded.data["curvefold_positions"])
    export()
    assert bytes(folded.data["curvefold_positions"]) == before
    assert any(
        entry.__module__.endswith("export_plan") for entry in bpy.types.TOPBAR_MT_file_export._dyn_ui_initialize()
    )


STRIP = """<svg xmlns="http://www.w3.org/2000/svg" width="120mm" height="40mm" viewBox="0 0 120 40">
<rect width="120" height="40" fill="none" stroke="black"/>
<path d="M 0 20 H 120" fill="none" stroke="red"/>
</svg>
"""


def test_glued_borders_have_tabs(extension, live, export, tmp_path):
    strip = papers.paper_of(extension, tmp_path, STRIP, resolution=12)
    _edited, flat = papers.edit(strip)
    for vertex, place in flat.items():
        vertex.select = abs(abs(place.x) - 0.06) < 1e-6
    bmesh.update_edit_mesh(strip.data)
    assert bpy.ops.curvefold.glue_borders() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert 'width="130mm"' in export().read_text(encoding="utf-8")
    path = export(tabs=0.01)
    assert 'width="140mm"' in path.read_text(encoding="utf-8")
    assert "tab 1" in layers(path)["flat"]


def test_a_paper_that_keeps_its_drawings_units_is_as_large_and_folded(extension, live, folder, export):
    pattern = extension("solver").read_pattern(extension("curvefold_addon.samples").FOLDER / "waves.svg")
    corner = extension("solver").Handle((210.0, 148.0), (210.0, 148.0, 0.0))
    description = extension("solver").FoldDescription(resolution=16, angle=50.0, handles=(corner,))
    result = extension("solver").fold(pattern, description)
    paper = extension("curvefold_addon.bridge.mesh").add_paper(result, bpy.context.collection, None)
    extension("curvefold_addon.bridge.papers").keep(paper, result)
    bpy.context.view_layer.objects.active = paper
    assert live.make_session(paper).source.scale == pytest.approx(0.001)
    text = export(rulings=True).read_text(encoding="utf-8")
    assert 'width="220mm" height="158mm"' in text
    found = layers(export(rulings=True))
    sides = [result.measurement.side(k) for k in range(3)]
    assert len(found["valley"]) == sides.count("V")
    assert len(found["mountain"]) == sides.count("M")
    assert found["marks"] == ["handle 1"] * 2
    # A cross at the corner, 5 mm from the upper right one of the page; Blender keeps single precision.
    ends = re.search(r'label="handle 1" d="M([\d.]+),([\d.]+)L([\d.]+),([\d.]+)"', text).groups()
    assert [float(value) for value in ends] == pytest.approx([213.0, 5.0, 217.0, 5.0], abs=1e-3)
    # Rulings lie on the sheet.
    (body,) = re.findall(r'inkscape:label="rulings"(.*?)</g>', text, re.S)
    across = [float(x) for x in re.findall(r"[ML](\d[\d.]*),", body)]
    assert 5.0 <= min(across) < 60.0
    assert 160.0 < max(across) <= 215.0
