"""A sheet without creases is paper too: it bends by its handles."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def blank(sheet):
    """A live paper of a square sheet on which nothing is drawn."""
    for crease in list(sheet.children):
        bpy.data.objects.remove(crease)
    bpy.context.view_layer.update()
    assert bpy.ops.curvefold.make_paper(resolution=12) == {"FINISHED"}
    return bpy.context.active_object


@pytest.fixture
def bent(blank, live):
    """That paper, its corners held 20 mm above its middle."""
    settings = blank.data.curvefold
    for x, y, z in ((-0.05, 0, 0.02), (0.05, 0, 0.02), (0, 0, 0)):
        handle = settings.handles.add()
        handle.at, handle.offset, handle.pinned = (x, y), (0.9 * x, y, z), True
    live.settle(blank.data)
    return blank


def height(paper):
    return float(np.ptp([vertex.co.z for vertex in paper.data.vertices]))


def test_it_is_made_and_lies_flat(blank, live):
    facts = live.report(blank.data)
    assert (facts.state, facts.sentence) == ("settled", "Flat")
    assert facts.creases == ()
    assert height(blank) == 0.0


def test_an_automatic_resolution_suits_it_too(blank, live):
    blank.data.curvefold.resolution = 0
    live.settle(blank.data)
    assert live.session(blank.data).source.automatic


def test_it_bends_by_handles(bent, live):
    facts = live.report(bent.data)
    assert (facts.state, facts.sentence) == ("settled", "Settled")
    assert height(bent) == pytest.approx(0.02, abs=0.002)
    assert facts.stretch_mean < 0.005


def test_the_slider_asks_nothing_of_it(bent, live):
    """There is nothing to fold: no angle is spoken of, neither on the way nor at its end."""
    bent.data.curvefold.fold = 50.0
    live.wake(bent.data)
    assert live.report(bent.data).sentence in ("Folding…", "Settled")
    live.settle(bent.data)
    assert "°" not in live.report(bent.data).sentence
    live.forget()
    live.make_session(bent)
    assert "°" not in live.report(bent.data).sentence


def test_everything_is_drawn_over_it(extension, bent, content, live):
    settings = bpy.context.scene.curvefold
    for name in ("creases", "angles", "stretch", "rulings", "gauss_image", "pulls"):
        setattr(settings, name, True)
    drawn = content.of_paper(bent, settings)
    assert drawn.angles == ()
    assert len(drawn.stretch.triangles) > 0
    live.forget()
    content.forget()
    assert content.of_paper(bent, settings) is not None


def test_what_is_there_of_other_papers_is_there_of_it(bent):
    assert bpy.ops.curvefold.check_paper() == {"FINISHED"}
    for name in ("rulings_as_object", "gauss_image_as_object"):
        assert getattr(bpy.ops.curvefold, name)() == {"FINISHED"}
        bpy.ops.object.select_all(action="DESELECT")
        bent.select_set(True)
        bpy.context.view_layer.objects.active = bent
    assert bpy.ops.curvefold.flatten() == {"FINISHED"}


def test_a_paper_keeps_its_creases_when_the_last_is_deleted_and_follows_a_new_one(extension, paper, sheet, live):
    paper.data.curvefold.fold = 40.0
    live.settle(paper.data)
    folded = bytes(paper.data["curvefold_positions"])
    crease = sheet.children[0]
    curve = crease.data
    bpy.data.objects.remove(crease)
    live.rebuild(paper.data)
    while live.is_at_work():
        live.tick(1.0)
    assert bytes(paper.data["curvefold_positions"]) == folded
    assert "it has no crease any more" in live.report(paper.data).sentence
    with pytest.raises(extension("solver").PatternError, match="no crease any more"):
        live.settle(paper.data)
    extension("curvefold_addon.bridge.drawing_objects").new_crease(curve, sheet, "U")
    bpy.context.view_layer.update()
    paper.data.curvefold.fold = 40.0
    live.rebuild(paper.data)
    live.settle(paper.data)
    assert live.report(paper.data).fold_angle > 30.0


def test_a_file_without_creases_is_imported_and_folded_flat(tmp_path):
    path = tmp_path / "blank.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
        '<rect width="100" height="100" fill="none" stroke="black"/></svg>'
    )
    assert bpy.ops.curvefold.import_drawing(filepath=str(path)) == {"FINISHED"}
    assert bpy.context.active_object.children == ()
    assert bpy.ops.curvefold.make_paper() == {"FINISHED"}
