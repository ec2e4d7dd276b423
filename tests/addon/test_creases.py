"""Drawing creases, making them of curves and strokes, and saying to which side they fold."""

import bpy
import numpy as np
import pytest
import shapely
from mathutils import Euler, Matrix


@pytest.fixture
def read(extension):
    return extension("curvefold_addon.bridge.drawing").read_drawing


@pytest.fixture
def sheet():
    """A square of 2 by 2, moved, turned and scaled."""
    bpy.ops.curvefold.add_sheet(size="SQUARE", side=2.0)
    item = bpy.context.active_object
    item.location, item.rotation_euler, item.scale = (5, -3, 2), (0.4, 0.3, -1), (2, 2, 2)
    bpy.context.view_layer.update()
    return item


def select(*items):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    for item in items:
        item.select_set(True)
    bpy.context.view_layer.objects.active = items[-1]


def shown_on(sheet, item):
    """The vertices Blender shows of a curve, in the sheet's coordinates."""
    bpy.context.view_layer.update()
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    depth, item.data.bevel_depth = item.data.bevel_depth, 0.0
    bpy.context.view_layer.update()
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    to_sheet = np.linalg.inv(np.array(sheet.matrix_world)) @ np.array(item.matrix_world)
    points = np.array([[*vertex.co, 1.0] for vertex in mesh.vertices]) @ to_sheet.T
    evaluated.to_mesh_clear()
    item.data.bevel_depth = depth
    return points[:, :3]


# --- draw_crease ---------------------------------------------------------------------------------------


def test_draw_crease_without_a_window(extension, sheet):
    assert bpy.ops.curvefold.draw_crease(assignment="V") == {"FINISHED"}
    crease = bpy.context.active_object
    assert (crease.parent, crease.curvefold.role, crease.curvefold.assignment) == (sheet, "CREASE", "V")
    assert crease.data.dimensions == "2D"  # the draw tool stays in the plane of such a curve
    assert crease.mode == "OBJECT"
    bpy.context.view_layer.update()
    assert np.array(crease.matrix_world) == pytest.approx(np.array(sheet.matrix_world))
    troubles = extension("curvefold_addon.bridge.drawing").troubles(sheet)
    assert troubles[0].sentence == "Crease: it is empty: draw a curve in it, or delete it"


def test_draw_another_crease_from_edit_mode(sheet):
    bpy.ops.curvefold.draw_crease()
    first = bpy.context.active_object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curvefold.draw_crease()
    assert first.mode == "OBJECT"
    assert bpy.context.active_object != first
    assert len(sheet.children) == 2


def test_draw_crease_on_a_hidden_sheet(sheet):
    sheet.hide_set(True)
    hidden = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(hidden)
    for collection in sheet.users_collection:
        collection.objects.unlink(sheet)
    hidden.objects.link(sheet)
    bpy.context.view_layer.layer_collection.children["Hidden"].hide_viewport = True
    with pytest.raises(RuntimeError, match="is hidden: show it to draw on it"):
        bpy.ops.curvefold.draw_crease()
    assert not sheet.children


def test_draw_crease_needs_a_sheet():
    with pytest.raises(RuntimeError, match="Select a paper sheet"):
        bpy.ops.curvefold.draw_crease()
    bpy.ops.mesh.primitive_plane_add()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Works in Object Mode, or while a curve is edited"):
        bpy.ops.curvefold.draw_crease()
    bpy.ops.object.mode_set(mode="OBJECT")


def test_which_sheet_is_meant(extension, sheet):
    active_sheet = extension("curvefold_addon.drawing_context").active_sheet
    bpy.ops.curvefold.draw_crease()
    assert active_sheet(bpy.context) == sheet  # that of the active crease
    bpy.ops.mesh.primitive_plane_add()
    assert active_sheet(bpy.context) == sheet  # the only one
    paper = bpy.context.active_object
    bpy.ops.curvefold.add_sheet()
    other = bpy.context.active_object
    assert active_sheet(bpy.context) == other
    select(sheet, paper)
    assert active_sheet(bpy.context) == sheet  # the selected one
    select(paper)
    assert active_sheet(bpy.context) is None  # one of two
    paper.data.curvefold.is_paper = True
    paper.data.curvefold.sheet = other
    assert active_sheet(bpy.context) == other  # that of the active paper


# --- make_crease ---------------------------------------------------------------------------------------


def bezier_on(sheet, height):
    """A Bezier curve of its own, turned and scaled, that hovers over the sheet."""
    bpy.ops.curve.primitive_bezier_curve_add(radius=0.8)
    item = bpy.context.active_object
    points = item.data.splines[0].bezier_points
    points.add(1)
    points[2].co = (1.2, 0.6, 0.0)
    for point in points:
        point.handle_left_type = point.handle_right_type = "AUTO"
    hover = Matrix.Translation((0.1, 0.2, height))
    item.matrix_world = sheet.matrix_world @ hover @ Matrix.LocRotScale(None, Euler((0, 0, 0.7)), (1, 0.5, 1))
    return item


@pytest.mark.parametrize("height", [0.0, 0.4])
def test_a_curve_becomes_a_crease_and_keeps_its_shape(read, sheet, height):
    item = bezier_on(sheet, height)
    before = shown_on(sheet, item)
    select(item, sheet)
    assert bpy.ops.curvefold.make_crease() == {"FINISHED"}
    assert item.parent == sheet
    after = shown_on(sheet, item)
    assert after[:, :2] == pytest.approx(before[:, :2], abs=1e-5)
    assert after[:, 2] == pytest.approx(0, abs=1e-5)
    assert item.matrix_basis == Matrix()
    first = item.data.splines[0].bezier_points[0]
    first.co = first.co  # Blender sets automatic handles anew
    assert shown_on(sheet, item)[:, :2] == pytest.approx(before[:, :2], abs=1e-5)
    (crease,) = read(sheet).creases
    line = shapely.LineString(crease.points)
    assert shapely.distance(shapely.points(before[:, :2]), line).max() < 1e-5


@pytest.mark.parametrize("kind", ["NURBS", "POLY"])
def test_other_curves(read, sheet, kind):
    bpy.ops.curve.primitive_nurbs_path_add(radius=0.2)
    item = bpy.context.active_object
    item.data.splines[0].type = kind
    item.matrix_world = sheet.matrix_world @ Matrix.Translation((0, 0.1, 0.3))
    item.delta_location = (0.01, 0, 0)
    before = shown_on(sheet, item)
    select(item, sheet)
    bpy.ops.curvefold.make_crease()
    assert shown_on(sheet, item)[:, :2] == pytest.approx(before[:, :2], abs=1e-5)
    assert len(read(sheet).creases) == 1


def test_a_shared_curve_is_not_changed_for_others(sheet):
    item = bezier_on(sheet, 0.0)
    twin = bpy.data.objects.new("Twin", item.data)
    bpy.context.collection.objects.link(twin)
    before = tuple(twin.data.splines[0].bezier_points[0].co)
    select(item, sheet)
    bpy.ops.curvefold.make_crease()
    assert item.data != twin.data
    assert tuple(twin.data.splines[0].bezier_points[0].co) == before


@pytest.mark.parametrize("make", ["draw_crease", "make_crease"])
def test_a_sheet_that_was_converted_to_a_mesh_says_so(extension, sheet, make):
    item = bezier_on(sheet, 0.0)
    select(sheet)
    bpy.ops.object.convert(target="MESH")
    assert sheet.type == "MESH"
    select(item, sheet)
    assert getattr(bpy.ops.curvefold, make)() == {"FINISHED"}
    troubles = extension("curvefold_addon.bridge.drawing").troubles(sheet)
    assert any("it is no longer a curve, so it has no border" in trouble.sentence for trouble in troubles)


def test_a_constrained_curve_keeps_its_constraint(read, sheet):
    item = bezier_on(sheet, 0.0)
    target = bpy.data.objects.new("Target", None)
    bpy.context.collection.objects.link(target)
    target.matrix_world = sheet.matrix_world
    item.constraints.new("COPY_LOCATION").target = target
    before = shown_on(sheet, item)
    select(item, sheet)
    bpy.ops.curvefold.make_crease()
    assert len(item.constraints) == 1
    assert shown_on(sheet, item) == pytest.approx(before, abs=1e-5)
    assert len(read(sheet).creases) == 1


def test_several_at_once_and_undo(sheet):
    first, second = bezier_on(sheet, 0.1), bezier_on(sheet, 0.0)
    first.curvefold.assignment = "M"
    select(first, second, sheet)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.curvefold.make_crease("EXEC_DEFAULT", True)
    assert set(bpy.context.selected_objects) == {first, second}
    assert [item.curvefold.assignment for item in (first, second)] == ["M", "U"]
    name = first.name
    bpy.ops.ed.undo()
    assert bpy.data.objects[name].curvefold.role == "NONE"
    assert bpy.data.objects[name].parent is None


def strokes_object(strokes):
    """A grease pencil object, as this Blender has it, with strokes of (points, closed)."""
    if bpy.app.version >= (4, 3, 0):
        blocks = bpy.data.grease_pencils_v3 if hasattr(bpy.data, "grease_pencils_v3") else bpy.data.grease_pencils
        data = blocks.new("Strokes")
        layer = data.layers.new("Layer")
        drawing = layer.frames.new(bpy.context.scene.frame_current).drawing
        drawing.add_strokes([len(points) for points, _ in strokes])
        for stroke, (points, closed) in zip(drawing.strokes, strokes, strict=True):
            stroke.cyclic = closed
            for point, place in zip(stroke.points, points, strict=True):
                point.position = place
    else:
        data = bpy.data.grease_pencils.new("Strokes")
        frame = data.layers.new("Layer").frames.new(bpy.context.scene.frame_current)
        for points, closed in strokes:
            stroke = frame.strokes.new()
            stroke.use_cyclic = closed
            stroke.points.add(len(points))
            for point, place in zip(stroke.points, points, strict=True):
                point.co = place
    item = bpy.data.objects.new("Strokes", data)
    bpy.context.collection.objects.link(item)
    return item


def trembling(curve, count=200, amount=0.001):
    """``curve`` of [0, 1] with a hand's noise."""
    random = np.random.default_rng(7)
    places = np.array([curve(t) for t in np.linspace(0, 1, count)])
    return np.column_stack([places + random.uniform(-amount, amount, places.shape), np.zeros(count)])


def test_strokes_become_smooth_creases(read, sheet):
    def wave(t):
        return (1.8 * t - 0.9, 0.3 * np.sin(5 * t))

    def ring(t):
        return (0.5 * np.cos(2 * np.pi * t), 0.5 * np.sin(2 * np.pi * t))

    pencil = strokes_object([(trembling(wave), False), (trembling(ring)[:-1], True), (np.zeros((1, 3)), False)])
    pencil.matrix_world = sheet.matrix_world @ Matrix.Translation((0, 0, 0.5))
    bpy.context.view_layer.update()
    select(pencil, sheet)
    assert bpy.ops.curvefold.make_crease() == {"FINISHED"}
    assert pencil.name in bpy.context.scene.objects  # the strokes stay
    open_one, closed_one = read(sheet).creases
    assert (open_one.closed, closed_one.closed) == (False, True)
    x, y = open_one.points.T
    assert np.abs(y - 0.3 * np.sin(5 * (x + 0.9) / 1.8)).max() < 0.004
    assert np.abs(np.hypot(*closed_one.points.T) - 0.5).max() < 0.004
    for crease in (open_one, closed_one):
        assert len(crease.beziers) < 20
        assert crease.points[0] == pytest.approx(crease.beziers[0, 0])
        places = np.vstack([crease.points, crease.points[:2]]) if crease.closed else crease.points
        directions = np.diff(places, axis=0)
        turns = np.diff(np.unwrap(np.arctan2(directions[:, 1], directions[:, 0])))
        assert np.abs(turns).max() < 0.05  # no trembling is left
    spline = bpy.context.active_object.data.splines[0]
    assert spline.bezier_points[1].handle_left_type == "ALIGNED"


def test_a_corner_in_a_stroke_stays(read, sheet):
    pencil = strokes_object([(trembling(lambda t: (1.6 * t - 0.8, abs(t - 0.5))), False)])
    pencil.matrix_world = sheet.matrix_world
    bpy.context.view_layer.update()
    select(pencil, sheet)
    bpy.ops.curvefold.make_crease()
    (crease,) = read(sheet).creases
    assert shapely.LineString(crease.points).distance(shapely.Point(0, 0)) < 0.006
    assert len(crease.beziers) < 5


def test_a_stroke_of_a_few_points(read, sheet):
    pencil = strokes_object([(np.array([(-0.5, 0, 0), (0, 0.1, 0), (0.5, 0, 0)]), False)])
    pencil.matrix_world = sheet.matrix_world
    bpy.context.view_layer.update()
    select(pencil, sheet)
    bpy.ops.curvefold.make_crease()
    (crease,) = read(sheet).creases
    assert crease.points == pytest.approx(np.array([(-0.5, 0), (0, 0.1), (0.5, 0)]), abs=1e-6)


def test_only_dots(sheet):
    pencil = strokes_object([(np.zeros((1, 3)), False)])
    select(pencil, sheet)
    curves = len(bpy.data.curves)
    assert bpy.ops.curvefold.make_crease() == {"CANCELLED"}
    assert not sheet.children
    assert len(bpy.data.curves) == curves


def test_make_crease_needs_curves_and_a_sheet(sheet):
    select(sheet)
    with pytest.raises(RuntimeError, match="Select curves or grease pencil strokes as well as the sheet"):
        bpy.ops.curvefold.make_crease()
    item = bezier_on(sheet, 0.0)
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Works in Object Mode"):
        bpy.ops.curvefold.make_crease()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(sheet)
    select(item)
    with pytest.raises(RuntimeError, match="Select a paper sheet"):
        bpy.ops.curvefold.make_crease()


# --- set_assignment ------------------------------------------------------------------------------------


def test_set_assignment_of_all_selected_creases(read, sheet):
    items = [bezier_on(sheet, 0.0) for _ in range(3)]
    select(*items, sheet)
    bpy.ops.curvefold.make_crease()
    select(*items[:2])
    bpy.ops.curvefold.set_assignment(assignment="M")
    select(items[2])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curvefold.set_assignment(assignment="V")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [item.curvefold.assignment for item in items] == ["M", "M", "V"]
    looks = [item.material_slots[0].material.name for item in items[1:]]
    assert looks == ["Curvefold Mountain", "Curvefold Valley"]
    assert tuple(items[0].color) == tuple(items[1].color) != tuple(items[2].color)
    assert sorted(crease.assignment for crease in read(sheet).creases) == ["M", "M", "V"]


def test_set_assignment_needs_creases(sheet):
    with pytest.raises(RuntimeError, match="Select creases"):
        bpy.ops.curvefold.set_assignment(assignment="M")


def test_papers_of_the_drawing_are_told(extension, sheet, monkeypatch):
    live = extension("curvefold_addon.live")
    told = []
    monkeypatch.setattr(live, "rebuild", lambda mesh: told.append(("rebuild", mesh.name)))
    monkeypatch.setattr(live, "settle", lambda mesh: told.append(("settle", mesh.name)))
    for name, of, follows in (("Mine", sheet, True), ("Still", sheet, False), ("Other", None, True)):
        settings = bpy.data.meshes.new(name).curvefold
        settings.is_paper, settings.sheet, settings.live = True, of, follows
    told.clear()
    item = bezier_on(sheet, 0.0)
    select(item, sheet)
    bpy.ops.curvefold.make_crease()
    expected = [("rebuild", "Mine"), ("settle", "Mine"), ("rebuild", "Still")]
    assert told == expected
    told.clear()
    bpy.ops.curvefold.set_assignment(assignment="V")
    assert told == expected


def test_a_paper_that_cannot_be_folded_is_named(extension, sheet, monkeypatch):
    live, solver = extension("curvefold_addon.live"), extension("solver")

    def refuse(mesh):
        raise solver.PatternError("nothing to fold")

    monkeypatch.setattr(live, "rebuild", lambda mesh: None)
    monkeypatch.setattr(live, "settle", refuse)
    mesh = bpy.data.meshes.new("Paper")
    mesh.curvefold.is_paper, mesh.curvefold.sheet = True, sheet
    changed = extension("curvefold_addon.drawing_context").drawing_changed
    assert changed(sheet) == ["Paper: nothing to fold"]
