"""Panel, crease list and Check Paper say the same of a paper, before and after undo."""

import bpy
import pytest

RING = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<rect width="100" height="100" fill="none" stroke="black"/>
<circle id="Ring" cx="50" cy="50" r="30" fill="none" stroke="red"/>
</svg>
"""


@pytest.fixture
def wording(extension):
    return extension("curvefold_addon.wording")


@pytest.fixture
def checked(extension, live):
    """What Check Paper says of a paper."""
    module = extension("curvefold_addon.bridge.mesh_check")

    def said(paper):
        return module.check(paper, bpy.context.evaluated_depsgraph_get(), live.make_session(paper)).sentence

    return said


def folded(paper, live, fold):
    paper.data.curvefold.fold = fold
    live.settle(paper.data)
    return paper


def ring(tmp_path, live, degrees):
    path = tmp_path / "ring.svg"
    path.write_text(RING)
    bpy.ops.curvefold.import_drawing(filepath=str(path))
    bpy.ops.curvefold.make_paper(resolution=12)
    paper = bpy.context.active_object
    paper.data.curvefold.angle = degrees * 3.141592653589793 / 180.0
    return folded(paper, live, 100.0)


def facts(live, paper):
    """All that the tab says of the fold."""
    report = live.report(paper.data)
    return report.state, report.sentence, report.stretch_mean, report.stretch_max, report.creases, report.lacks


def test_check_paper_gives_the_stretch_of_the_tab(paper, live, wording, checked):
    for fold in (0.0, 60.0):
        folded(paper, live, fold)
        words = wording.stretch(live.report(paper.data))
        assert words.lower() in checked(paper)


def test_what_is_not_folded_is_not_folded_everywhere(paper, live, wording, checked):
    folded(paper, live, 60.0)
    net = live.make_session(paper).net
    session = live.make_session(paper)
    # One crease point is turned over; nothing else is touched.
    session.measurement.folded.setflags(write=True)
    session.measurement.folded[net.crease_points.carrier[2]] = False
    report = live.report(paper.data)
    sentence = f"{paper.data.curvefold.creases[0].name} not folded everywhere"
    assert report.sentence == sentence
    assert not report.creases[0].folded
    assert wording.crease(report.creases[0]).endswith(", with gaps")
    assert checked(paper).endswith(f"; {sentence}")


def test_a_flat_paper_is_flat_for_all_of_them(paper, live, wording, checked):
    report = live.report(paper.data)
    assert report.sentence == "Flat"
    assert wording.crease(report.creases[0]) == "Not folded"
    assert checked(paper).endswith("; none of its creases is folded")


def test_how_far_a_crease_came_is_the_same_number_in_the_list_and_above_it(tmp_path, live, wording):
    paper = ring(tmp_path, live, 90.0)
    report = live.report(paper.data)
    assert report.sentence.startswith("Ring came to ")
    assert report.sentence.split("came to ")[1].split("°")[0] == f"{report.creases[0].fold_angle:.0f}"
    assert f"{report.creases[0].fold_angle:.0f}°" in wording.crease(report.creases[0])


@pytest.mark.parametrize("steps", [1, 2])
def test_undo_and_redo_change_no_answer(tmp_path, live, checked, steps):
    paper = ring(tmp_path, live, 90.0)
    name = paper.name
    bpy.ops.ed.undo_push(message="deep")
    said = [(facts(live, paper), checked(paper))]
    for degrees in (20.0, 80.0):
        paper.data.curvefold.angle = degrees * 3.141592653589793 / 180.0
        live.settle(paper.data)
        bpy.ops.ed.undo_push(message="other")
        said.append((facts(live, paper), checked(paper)))
    assert len({sentence for (_, sentence, *_), _ in said}) == 3

    def now():
        paper = bpy.data.objects[name]
        live.make_session(paper)
        return facts(live, paper), checked(paper)

    for k in range(1, steps + 1):
        bpy.ops.ed.undo()
        assert now() == said[2 - k]
    for k in range(1, steps + 1):
        bpy.ops.ed.redo()
        assert now() == said[2 - steps + k]
