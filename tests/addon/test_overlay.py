"""What is drawn over papers and drawings: facts about the arrays, and when they are made anew."""

import logging
import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest


@pytest.fixture
def arrays(extension):
    return extension("curvefold_addon.bridge.overlay")


@pytest.fixture
def shape(arrays, folded):
    return arrays.PaperShape(folded.net, folded.positions)


@pytest.fixture
def flat(arrays, folded):
    net = folded.net
    return arrays.PaperShape(net, np.column_stack([net.rest, np.zeros(len(net.rest))]))


@pytest.fixture
def paper():
    """A sample, folded, as the user makes it."""
    bpy.ops.curvefold.add_sample(sample="one_arc")
    bpy.ops.curvefold.make_paper(resolution=12, fold=60.0)
    return bpy.context.active_object


@pytest.fixture
def settings():
    return bpy.context.scene.curvefold


def colors_of(lines):
    return {tuple(color) for color in np.round(lines.colors.astype(float), 4)}


def rounded(color):
    return tuple(np.round(np.float32(color).astype(float), 4))


# --- creases and angles ----------------------------------------------------------------------------------


def test_creases_are_the_crease_edges_of_the_shown_mesh(shape, folded):
    lines = shape.creases()
    surface = folded.net.render_map
    assert len(lines.points) == len(lines.colors) == 2 * len(surface.crease_edges)
    shown = surface.apply(folded.positions)
    assert lines.points == pytest.approx(shown[surface.crease_edges].reshape(-1, 3), abs=1e-4)


def test_a_crease_has_the_colour_of_its_side(arrays, shape, folded):
    side = int(np.nanmax(shape.measurement.fold_sign)) or int(np.nanmin(shape.measurement.fold_sign))
    wanted = arrays.VALLEY if side > 0 else arrays.MOUNTAIN
    assert colors_of(shape.creases()) == {rounded(wanted)}
    mirrored = arrays.PaperShape(folded.net, folded.positions * [1, 1, -1])
    other = arrays.MOUNTAIN if side > 0 else arrays.VALLEY
    assert colors_of(mirrored.creases()) == {rounded(other)}


def test_creases_of_a_flat_sheet_are_not_folded(arrays, flat):
    assert colors_of(flat.creases()) == {rounded(arrays.UNFOLDED)}


def test_a_crease_that_is_folded_by_next_to_nothing_is_not_folded(arrays, folded):
    faint = arrays.PaperShape(folded.net, folded.positions * [1, 1, 0.01])
    assert 0.1 < np.nanmax(faint.measurement.fold_angle) < arrays.FOLDED_FROM
    assert colors_of(faint.creases()) == {rounded(arrays.UNFOLDED)}


def test_the_colour_changes_where_the_side_does(arrays, folded):
    """One half of the crease as it is folded, the other half pressed flat."""
    net, positions = folded.net, folded.positions.copy()
    middle = net.rest[:, 0].mean()
    right = net.rest[:, 0] > middle
    positions[right] = np.column_stack([net.rest, np.zeros(len(net.rest))])[right]
    lines = arrays.PaperShape(net, positions).creases()
    unfolded = (np.round(lines.colors[::2], 4) == np.round(np.float32(arrays.UNFOLDED), 4)).all(axis=1)
    uv = net.render_map.uv[net.render_map.crease_edges].mean(axis=1)[:, 0]
    cell = np.ptp(net.rest[:, 0]) / 12
    assert unfolded[uv > middle + 2 * cell].all()
    assert not unfolded[uv < middle - 3 * cell].any()


def test_angles_are_those_measured_and_stand_on_the_crease(shape, folded):
    labels = shape.angles()
    assert len(labels) in (1, 3)
    known = shape.measurement.fold_angle[np.isfinite(shape.measurement.fold_angle)]
    shown = shape.shown[folded.net.render_map.crease_edges].reshape(-1, 3)
    for label in labels:
        assert label.text.endswith("°")
        assert known.min() - 0.5 <= float(label.text[:-1]) <= known.max() + 0.5
        assert np.linalg.norm(shown - label.place, axis=1).min() < 0.05 * np.ptp(shown[:, 0])


def test_a_long_crease_has_three_labels_and_a_short_one_has_one(extension, arrays, folded):
    solver = extension("solver")
    for resolution, count in ((8, 1), (24, 3)):
        net = solver.build_net(folded.pattern, resolution)
        assert len(arrays.PaperShape(net, np.column_stack([net.rest, net.rest[:, 0] * 0])).angles()) == count


# --- stretch ---------------------------------------------------------------------------------------------


def test_stretch_covers_the_mesh_and_is_red_where_the_paper_is_torn(arrays, extension, folded):
    mesh = extension("curvefold_addon.bridge.mesh").build_mesh(folded)
    triangles = arrays.shown_triangles(mesh)
    positions = np.column_stack([folded.net.rest, np.zeros(len(folded.net.rest))])
    positions[:, 0] *= np.where(positions[:, 0] > 80.0, 1.3, 1.0)
    surface = arrays.PaperShape(folded.net, positions).stretch(triangles)
    assert triangles.max() < len(surface.points) == len(surface.colors) == len(mesh.vertices)
    assert set(triangles.ravel()) == set(range(len(mesh.vertices)))
    torn = surface.points[:, 0] > 110.0
    left = surface.points[:, 0] < 50.0
    assert surface.colors[torn].mean(axis=0) == pytest.approx(arrays.STRETCH_RAMP[-1][1], abs=0.02)
    assert surface.colors[left] == pytest.approx(np.tile(arrays.STRETCH_RAMP[0][1], (left.sum(), 1)), abs=0.01)


def test_the_ramp_is_straight_between_its_marks_and_ends_at_the_last(arrays):
    (low, first), (high, second) = arrays.STRETCH_RAMP[:2]
    middle = arrays.stretch_colors(np.array([0.5 * (low + high), 7.0]))
    assert middle[0] == pytest.approx(0.5 * (np.array(first) + second), abs=1e-6)
    assert middle[1] == pytest.approx(arrays.STRETCH_RAMP[-1][1])


# --- pull lines ------------------------------------------------------------------------------------------


def test_a_pull_line_goes_from_the_point_to_its_target(extension, shape, folded):
    solver = extension("solver")
    at = (30.0, 20.0)
    vertices, weights = folded.net.locate(at)
    here = weights @ folded.positions[vertices]
    above = here + np.array([0.0, 0.0, 25.0])
    pulls = shape.pulls([solver.Handle(at, tuple(above))])
    assert pulls.points == pytest.approx(here[None], abs=1e-4)
    assert pulls.lines.points == pytest.approx(np.array([here, above]), abs=1e-4)


def test_a_handle_that_is_there_or_free_along_the_way_has_a_point_but_no_line(extension, shape, folded):
    solver = extension("solver")
    at = (30.0, 20.0)
    vertices, weights = folded.net.locate(at)
    here = weights @ folded.positions[vertices]
    there = solver.Handle(at, tuple(here))
    free = solver.Handle((70.0, 20.0), (0.0, 0.0, 0.0), axes=(True, False, False))
    pulls = shape.pulls([there, free])
    assert len(pulls.points) == 2
    assert len(pulls.lines.points) == 2
    start, end = pulls.lines.points
    assert start[1:] == pytest.approx(end[1:])
    assert end[0] == pytest.approx(0.0, abs=1e-5)


def test_joined_points_have_a_line_between_them_until_they_meet(arrays, extension, shape, folded):
    solver = extension("solver")
    first, second, third = (30.0, 20.0), (70.0, 20.0), (50.0, 10.0)

    def place(at):
        vertices, weights = folded.net.locate(at)
        return weights @ folded.positions[vertices]

    joints = shape.joints(
        [
            solver.Pair(first, second, distance=10.0),
            solver.Pair(third, third),
            solver.Pair((900.0, 0.0), first),
            solver.Keep(first),
        ]
    )
    assert joints.lines.points == pytest.approx(np.array([place(first), place(second)]), abs=1e-4)
    assert colors_of(joints.lines) == {rounded(arrays.JOINT)}
    assert joints.points == pytest.approx(np.array([place(p) for p in (first, second, third, third)]), abs=1e-4)
    assert joints.color == arrays.JOINT not in (arrays.PULL, arrays.VALLEY, arrays.MOUNTAIN)


def test_glued_borders_have_a_line_at_each_end(extension, shape, folded):
    glue = extension("solver").Glue(((0.0, 0.0), (0.0, 40.0)), ((100.0, 0.0), (100.0, 40.0)))
    joints = shape.joints([glue])
    assert len(joints.lines.points) == 4
    ends = joints.lines.points.reshape(2, 2, 3)
    for k, y in enumerate((0.0, 40.0)):
        vertices, weights = folded.net.locate((0.0, y))
        assert ends[k, 0] == pytest.approx(weights @ folded.positions[vertices], abs=1e-4)
    assert shape.joints([glue]) is joints
    assert shape.joints([]) is not joints


def test_an_angle_at_a_point_is_marked_on_its_crease(extension, arrays, shape, folded):
    solver = extension("solver")
    nearest = shape.measurement.crease_position[arrays.nearest_angle(folded.net, (50.0, 41.0))]
    asked = [solver.Angle(60.0, at=(50.0, 41.0)), solver.Angle(60.0, at=(5.0, 5.0)), solver.Angle(60.0, crease=1)]
    marks = shape.asked_angles(asked)
    assert len(marks.lines.points) == 0
    (point,) = marks.points
    vertices, weights = folded.net.locate(tuple(nearest))
    cell = 100.0 / 12
    assert np.linalg.norm(point - weights @ folded.positions[vertices]) < 0.2 * cell
    assert marks.color == arrays.ASKED_ANGLE


# --- rulings ---------------------------------------------------------------------------------------------


def test_rulings_lie_on_the_paper_and_go_with_it(arrays, shape, flat):
    found = arrays.rulings(shape.net, shape.positions)
    lines = shape.rulings(found)
    assert len(lines.points) == 2 * len(found.segments) > 20
    assert lines.points == pytest.approx(found.segments.reshape(-1, 3), abs=1e-4)
    assert shape.rulings(found) is lines
    assert np.abs(flat.rulings(found).points[:, 2]).max() < 1e-6


def test_the_finder_takes_one_shape_after_the_other(arrays, shape, flat):
    finder = arrays.RulingFinder()
    try:
        assert finder.take() is None
        assert finder.ask(shape)
        assert not finder.ask(flat)
        found = wait_for(finder.take)
        assert found[0] is shape
        assert len(found[1].segments) > 10
        assert finder.take() is None
        assert finder.ask(flat)
        assert len(wait_for(finder.take)[1].segments) == 0
    finally:
        finder.stop()


def wait_for(look, seconds=60.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = look()
        if found is not None:
            return found
        time.sleep(0.01)
    raise AssertionError("nothing came")


# --- papers that nobody works on -------------------------------------------------------------------------


@pytest.fixture
def seen(extension, content, paper, settings):
    """What is drawn over the folded paper with its session, and after the session is gone."""
    settings.angles = settings.stretch = True
    with_session = content.of_paper(paper, settings)
    extension("curvefold_addon.live").forget()
    return with_session, content.of_paper(paper, settings)


def test_without_a_session_creases_have_the_same_places_and_colours(seen):
    def ends(lines):
        points = np.round(lines.points.astype(float), 5).reshape(-1, 2, 3)
        return {frozenset(map(tuple, pair)) for pair in points}

    with_session, without = seen
    assert ends(without.creases) == ends(with_session.creases)
    assert colors_of(without.creases) == colors_of(with_session.creases)
    assert (without.rulings, without.pulls) == (None, ())


def test_without_a_session_angles_and_stretch_are_nearly_those_measured(arrays, seen):
    with_session, without = seen
    (label,) = without.angles
    measured = [float(other.text[:-1]) for other in with_session.angles]
    assert float(label.text[:-1]) == pytest.approx(np.median(measured), abs=2.0)
    assert label.color == with_session.angles[0].color
    assert min(np.linalg.norm(np.subtract(label.place, other.place)) for other in with_session.angles) < 0.03
    assert without.stretch.points == pytest.approx(with_session.stretch.points, abs=1e-6)
    difference = np.abs(without.stretch.colors - with_session.stretch.colors)
    assert np.median(difference) < 0.05


def test_a_mirrored_mesh_folds_to_the_other_side(extension, arrays, content, paper, settings, seen):
    paper.data.transform(np.diag([1.0, 1.0, -1.0, 1.0]))
    other = {rounded(arrays.VALLEY): arrays.MOUNTAIN, rounded(arrays.MOUNTAIN): arrays.VALLEY}
    (before,) = colors_of(seen[1].creases)
    assert colors_of(content.of_paper(paper, settings).creases) == {rounded(other[before])}


def test_without_a_session_arrays_are_made_once_for_a_shape(content, paper, settings, seen):
    again = content.of_paper(paper, settings)
    assert again.creases is seen[1].creases
    assert again.angles is seen[1].angles
    paper.data.vertices[0].co.z += 0.001
    assert content.of_paper(paper, settings).creases is not again.creases


def test_a_mesh_without_its_marks_has_nothing_to_draw(content, paper, settings, seen):
    paper.data.attributes.remove(paper.data.attributes["crease"])
    content.forget()
    assert content.of_paper(paper, settings) is None


def test_only_what_is_switched_on_is_made_of_a_mesh(content, paper, settings, seen):
    settings.creases = settings.angles = False
    drawn = content.of_paper(paper, settings)
    assert (drawn.creases, drawn.angles) == (None, ())
    assert drawn.stretch is seen[1].stretch
    settings.stretch = False
    assert content.of_paper(paper, settings) is None


def test_a_baked_paper_shows_the_creases_of_each_frame(content, paper, settings, monkeypatch):
    """Also between frames, and with a modifier that has another mesh."""
    scene = bpy.context.scene
    scene.frame_end = 4
    for frame, fold in ((1, 10.0), (4, 60.0)):
        paper.data.curvefold.fold = fold
        paper.data.curvefold.keyframe_insert("fold", frame=frame)
    assert bpy.ops.curvefold.bake() == {"FINISHED"}
    ends = content.mesh_overlay.parts_of(paper.data, content.arrays.shown_triangles(paper.data)).creases
    drawn = {}
    for frame, part in ((1, 0.0), (2, 0.5), (3, 0.0), (4, 0.0)):
        scene.frame_set(frame, subframe=part)
        drawn[frame] = content.of_paper(paper, settings).creases
        played = paper.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        shown = np.array([vertex.co[:] for vertex in played.vertices])
        assert drawn[frame].points == pytest.approx(shown[ends].reshape(-1, 3), abs=1e-6)
    assert np.abs(drawn[4].points - drawn[1].points).max() > 0.001
    assert content.of_paper(paper, settings).creases is drawn[4]
    paper.modifiers.new("Thick", "SOLIDIFY")
    bpy.context.view_layer.update()
    assert content.of_paper(paper, settings).creases is drawn[4]
    monkeypatch.setattr(content.mesh_overlay, "shown_positions", lambda mesh: pytest.fail("read again"))
    content.of_paper(paper, settings)
    monkeypatch.undo()
    assert content.is_kept(paper.data.session_uid)
    assert bpy.ops.curvefold.free_bake() == {"FINISHED"}
    assert content.of_paper(paper, settings).pulls, "the live paper again"


# --- when ------------------------------------------------------------------------------------------------


def test_arrays_are_made_once_for_a_shape_and_anew_for_the_next(extension, content, paper, settings):
    live = extension("curvefold_addon.live")
    first = content.of_paper(paper, settings)
    again = content.of_paper(paper, settings)
    assert first.creases is again.creases
    assert all(one is other for one, other in zip(first.pulls, again.pulls, strict=True))
    paper.data.curvefold.fold = 20.0
    live.settle(paper.data)
    after = content.of_paper(paper, settings)
    assert after.creases is not first.creases
    shown = np.array([v.co[:] for v in paper.data.vertices])
    ends = live.session(paper.data).net.render_map.crease_edges.ravel()
    assert after.creases.points == pytest.approx(shown[ends], abs=1e-6)


def test_only_what_is_switched_on_is_made(content, paper, settings):
    for name in ("creases", "angles", "rulings", "pulls", "stretch"):
        setattr(settings, name, False)
    drawn = content.of_paper(paper, settings)
    assert (drawn.creases, drawn.stretch, drawn.rulings, drawn.pulls, drawn.angles) == (None, None, None, (), ())
    settings.stretch = settings.angles = True
    drawn = content.of_paper(paper, settings)
    assert drawn.creases is None
    assert len(drawn.stretch.points) == len(paper.data.vertices)
    assert drawn.angles


def test_rulings_come_when_they_are_found(content, paper, settings):
    settings.rulings = True
    assert content.of_paper(paper, settings).rulings is None
    assert bpy.app.timers.is_registered(content._look_for_rulings)
    wait_for(lambda: True if content._look_for_rulings() is None else time.sleep(0.01))
    lines = content.of_paper(paper, settings).rulings
    assert len(lines.points) > 20
    assert content.of_paper(paper, settings).rulings is lines


def test_papers_are_those_that_the_viewport_shows(content, paper):
    screens = (screen for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D")
    space = next(area.spaces.active for area in next(screens).areas if area.type == "VIEW_3D")
    bpy.ops.mesh.primitive_cube_add()
    view = SimpleNamespace(view_layer=bpy.context.view_layer, space_data=space)
    assert list(content.papers(view)) == [paper]
    paper.hide_set(True)
    bpy.context.view_layer.update()
    assert list(content.papers(view)) == []
    paper.hide_set(False)
    bpy.context.view_layer.objects.active = paper
    bpy.ops.object.mode_set(mode="EDIT")
    assert list(content.papers(view)) == []
    bpy.ops.object.mode_set(mode="OBJECT")


def test_what_is_kept_of_a_mesh_that_is_gone_is_dropped(content, paper, settings):
    content.of_paper(paper, settings)
    uid = paper.data.session_uid
    assert content.is_kept(uid)
    bpy.data.meshes.remove(paper.data)
    bpy.ops.curvefold.add_sample(sample="one_arc")
    bpy.ops.curvefold.make_paper(resolution=8)
    content.of_paper(bpy.context.active_object, settings)
    assert not content.is_kept(uid)


# --- troubles --------------------------------------------------------------------------------------------


@pytest.fixture
def marks(extension):
    watch = extension("curvefold_addon.overlay.drawing_watch")
    watch.register()
    yield extension("curvefold_addon.overlay.trouble_marks")
    watch.unregister()


def test_troubles_are_looked_for_when_the_drawing_has_changed(marks, monkeypatch):
    bpy.ops.curvefold.add_sample(sample="one_arc")
    sheet = bpy.context.active_object
    looked = []
    find = marks.drawing.troubles
    monkeypatch.setattr(marks.drawing, "troubles", lambda sheet: looked.append(1) or find(sheet))
    bpy.context.view_layer.update()
    assert marks.of_sheet(sheet) == ()
    assert marks.of_sheet(sheet) == ()
    assert len(looked) == 1
    crease = sheet.children[0]
    crease.location.x += 10.0 * max(sheet.dimensions)
    bpy.context.view_layer.update()
    (trouble,) = marks.of_sheet(sheet)[:1]
    assert crease.name in trouble.sentence
    assert trouble.place is not None
    assert len(looked) == 2
    bpy.data.objects.remove(crease)
    assert not any("off the sheet" in trouble.sentence for trouble in marks.of_sheet(sheet))
    assert len(looked) == 3


def test_what_is_no_drawing_changes_no_troubles(marks, monkeypatch):
    bpy.ops.curvefold.add_sample(sample="one_arc")
    sheet = bpy.context.active_object
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.update()
    marks.of_sheet(sheet)
    monkeypatch.setattr(marks.drawing, "troubles", lambda sheet: pytest.fail("the drawing was read again"))
    empty.location.x = 1.0
    bpy.context.view_layer.update()
    assert marks.of_sheet(sheet) == ()


# --- lines of drawings -------------------------------------------------------------------------------------


@pytest.fixture
def lines(extension):
    return extension("curvefold_addon.bridge.drawing_lines")


def test_the_lines_of_a_crease_are_those_that_blender_draws(lines):
    bpy.ops.curvefold.add_sample(sample="one_arc")
    crease = bpy.context.active_object.children[0]
    bpy.context.view_layer.update()
    evaluated = crease.evaluated_get(bpy.context.evaluated_depsgraph_get())
    drawn = np.array([vertex.co[:] for vertex in evaluated.to_mesh().vertices])
    evaluated.to_mesh_clear()
    points = lines.lines_of(crease).points
    assert np.array_equal(points[1:-1:2], points[2::2]), "the segments are joined"
    assert np.vstack([points[::2], points[-1:]]) == pytest.approx(drawn, abs=1e-6)


def test_a_border_is_a_closed_line(lines):
    bpy.ops.curvefold.add_sheet(size="SQUARE")
    points = lines.lines_of(bpy.context.active_object).points
    assert len(points) == 8
    assert np.array_equal(points[0], points[-1])
    assert np.ptp(points, axis=0) == pytest.approx([0.2, 0.2, 0.0])


@pytest.mark.parametrize("letter", ["M", "V", "U", "F"])
def test_each_assignment_has_a_colour_of_its_own(lines, letter):
    bpy.ops.curvefold.add_sample(sample="one_arc")
    crease = bpy.context.active_object.children[0]
    crease.curvefold.assignment = letter
    assert lines.color_of(crease) == lines.COLORS[letter]
    assert len(set(lines.COLORS.values()) | {lines.BORDER}) == 5


def test_an_empty_crease_has_no_lines(lines):
    bpy.ops.curvefold.add_sheet()
    bpy.ops.curvefold.draw_crease()
    assert lines.lines_of(bpy.context.active_object) is None


def test_the_lines_of_what_the_viewport_shows_are_drawn(extension, marks):
    drawn = extension("curvefold_addon.overlay.drawing_lines")
    screens = (screen for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D")
    space = next(area.spaces.active for area in next(screens).areas if area.type == "VIEW_3D")
    view = SimpleNamespace(view_layer=bpy.context.view_layer, space_data=space, preferences=bpy.context.preferences)
    bpy.ops.curvefold.add_sample(sample="one_arc")
    sheet = bpy.context.active_object
    crease = sheet.children[0]
    bpy.context.view_layer.update()

    def shown():
        return {found.part.name: found for found in drawn.shown(view)}

    theme = bpy.context.preferences.themes[0].view_3d
    first = shown()
    assert first.keys() == {sheet.name, crease.name}
    assert first[crease.name].color[:3] not in (theme.object_active[:], theme.object_selected[:])
    assert first[sheet.name].color == (*theme.object_active, 1.0)
    assert shown()[crease.name].lines is first[crease.name].lines, "kept until the drawing changes"
    crease.location.x = 0.01
    crease.select_set(True)
    bpy.context.view_layer.update()
    assert shown()[crease.name].lines is not first[crease.name].lines
    assert shown()[crease.name].color == (*theme.object_selected, 1.0)
    sheet.hide_set(True)
    bpy.context.view_layer.update()
    assert shown().keys() == {crease.name}


# --- drawing ---------------------------------------------------------------------------------------------


def test_a_draw_handler_never_raises_and_reports_once(extension, caplog):
    painting = extension("curvefold_addon.overlay.painting")

    def broken(context):
        raise RuntimeError("no such shader")

    handler = painting._safely(broken)
    with caplog.at_level(logging.ERROR):
        handler()
        handler()
    assert len([record for record in caplog.records if "could not be drawn" in record.message]) == 1
    painting.unregister()


def test_without_a_window_nothing_is_hooked_in(extension):
    assert bpy.app.background
    assert extension("curvefold_addon.overlay.painting")._handles == []
    assert not extension("curvefold_addon.overlay.drawing_watch")._watching
