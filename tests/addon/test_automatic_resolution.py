"""A resolution that follows the drawing: chosen within limits, seldom another, and kept with the paper."""

import bpy
import pytest


@pytest.fixture
def nets(extension):
    return extension("curvefold_addon.bridge.nets")


@pytest.fixture
def state(extension):
    return extension("curvefold_addon.bridge.state")


@pytest.fixture
def needs(extension, nets, monkeypatch):
    """``needs(41)``: from now on every drawing needs so many quads."""
    solver = extension("solver")

    def let(quads):
        monkeypatch.setattr(
            nets, "choose_resolution", lambda pattern, most: solver.Resolution(quads, "it needs it")
        )

    return let


@pytest.fixture
def automatic(sheet, needs):
    """A flat live paper whose drawing needs 13 quads."""
    needs(13)
    assert bpy.ops.curvefold.make_paper() == {"FINISHED"}
    return bpy.context.active_object


def resolution(live, paper):
    return live.make_session(paper).source.resolution


def settled(live, paper):
    live.settle(paper.data)
    return resolution(live, paper)


def test_a_new_paper_is_as_fine_as_its_drawing_needs_and_live_papers_may_be(sheet, live, nets, extension):
    bpy.ops.curvefold.make_paper()
    paper = bpy.context.active_object
    found = live.session(paper.data)
    assert paper.data.curvefold.resolution == 0
    assert found.source.automatic
    assert len(found.net.rest) <= nets.LIVE_VERTICES
    pattern = extension("curvefold_addon.bridge.drawing").read_drawing(sheet)
    least = extension("solver").choose_resolution(pattern, nets.LIVE_VERTICES).quads
    assert found.source.resolution == min(step for step in nets.STEPS if step >= least)
    assert live.report(paper.data).resolution == found.source.resolution


@pytest.mark.parametrize(
    ("quads", "most", "chosen"),
    [(12, 3000, 12), (13, 3000, 14), (13, 200, 12), (13, 100, 13), (4, 3000, 4)],
    ids=["a step", "rounded up", "rounded down where up is too much", "as it is where both are", "the least"],
)
def test_it_is_rounded_so_that_it_seldom_changes(
    state, nets, needs, monkeypatch, extension, sheet, quads, most, chosen
):
    needs(quads)
    monkeypatch.setattr(nets, "LIVE_VERTICES", most)
    wanted = state.source_of(extension("curvefold_addon.bridge.drawing").read_drawing(sheet), state.AUTOMATIC)
    found = nets.choose(wanted)
    assert found.source.resolution == chosen
    rounded = "" if quads == chosen else f"; here {chosen}, a number that seldom changes while one draws"
    assert found.notes == (f"it needs it{rounded}",)


def test_why_is_said(sheet, needs, capfd):
    needs(13)
    bpy.ops.curvefold.make_paper()
    assert "Info: it needs it; here 14" in capfd.readouterr().out
    bpy.ops.curvefold.make_paper(resolution=12)
    assert "it needs it" not in capfd.readouterr().out


def test_another_version_that_would_choose_otherwise_leaves_it(automatic, live, needs, tmp_path):
    name, path = automatic.name, str(tmp_path / "paper.blend")
    assert resolution(live, automatic) == 14
    bpy.ops.wm.save_as_mainfile(filepath=path)
    needs(25)
    bpy.ops.wm.open_mainfile(filepath=path)
    paper = bpy.data.objects[name]
    before = bytes(paper.data["curvefold_positions"])
    assert settled(live, paper) == 14
    live.rebuild(paper.data)
    assert settled(live, paper) == 14
    assert bytes(paper.data["curvefold_positions"]) == before


def test_a_changed_drawing_is_looked_at_anew(automatic, live, needs):
    """While it needs about the same, the net stays as fine as it is."""
    settings = automatic.data.curvefold
    crease = settings.sheet.children[0]
    for quads, chosen in ((14, 14), (15, 16), (25, 28)):
        needs(quads)
        crease.location.y += 0.001
        bpy.context.view_layer.update()
        assert settled(live, automatic) == chosen
    assert settings.resolution == 0


def test_it_can_be_switched_off_and_on(automatic, live, needs):
    settings = automatic.data.curvefold
    needs(25)
    settings.resolution = 12
    assert settled(live, automatic) == 12
    settings.resolution = 0
    assert settled(live, automatic) == 28, "what was there before is forgotten"
    settings.resolution = 28
    assert settled(live, automatic) == 28
    needs(13)
    assert settled(live, automatic) == 28, "it is the user's now"


@pytest.mark.parametrize("asked", [1, 3, 4])
def test_less_than_four_quads_are_four(automatic, live, needs, asked):
    automatic.data.curvefold.resolution = asked
    assert settled(live, automatic) == 4
    made = live.session(automatic.data)
    assert settled(live, automatic) == 4
    assert live.session(automatic.data) is made, "nothing is made again"
    bpy.context.view_layer.objects.active = automatic.data.curvefold.sheet
    bpy.ops.curvefold.make_paper(resolution=asked)
    assert resolution(live, bpy.context.active_object) == 4


def test_undo_leads_back_to_the_same_net(automatic, live, needs):
    bpy.ops.ed.undo_push(message="automatic")
    name = automatic.name
    before = len(automatic.data.vertices)
    automatic.data.curvefold.resolution = 20
    live.settle(automatic.data)
    bpy.ops.ed.undo_push(message="20")
    needs(25)
    bpy.ops.ed.undo()
    paper = bpy.data.objects[name]
    assert settled(live, paper) == 14
    assert len(paper.data.vertices) == before
    bpy.ops.ed.redo()
    assert settled(live, bpy.data.objects[name]) == 20


def test_what_older_versions_folded_has_a_resolution_of_its_own(paper, live, state):
    del paper.data["curvefold_resolution_chosen"]
    live.forget()
    assert not state.load_source(paper.data).automatic
    assert settled(live, paper) == 12


def test_a_folded_drawing_has_what_the_solver_chose(extension, drawing, live, monkeypatch):
    solver = extension("solver")
    told = []
    fold = solver.fold

    def noted(pattern, description, *rest):
        told.append(description)
        return fold(pattern, description, *rest)

    monkeypatch.setattr(solver, "fold", noted)
    bpy.ops.curvefold.fold_drawing(filepath=str(drawing), angle=0.3)
    paper = bpy.context.active_object
    assert (told[0].resolution, told[0].max_vertices) == ("auto", 6000)
    assert paper.data.curvefold.resolution == 0
    chosen = solver.choose_resolution(solver.read_pattern(drawing), 6000).quads
    assert resolution(live, paper) == chosen
    before = bytes(paper.data["curvefold_positions"])
    assert settled(live, paper) == chosen, "it is not chosen again"
    assert bytes(paper.data["curvefold_positions"]) == before
    for asked, number in ((2, 4), (12, 12)):
        bpy.ops.curvefold.fold_drawing(filepath=str(drawing), angle=0.3, resolution=asked)
        assert told[-1].resolution == number
        assert bpy.context.active_object.data.curvefold.resolution == number
