"""Drawings in Blender <-> crease patterns."""

from math import cos, pi, radians, sin
from pathlib import Path

import bpy
import numpy as np
import pytest
import shapely
from mathutils import Euler, Matrix

ROOT = Path(__file__).absolute().parents[2]
SAMPLES = sorted((ROOT / "sample_patterns").glob("*.svg"))

#: Relative to the sheet: what single precision leaves.
SAME = 1e-6


@pytest.fixture
def drawing_module(extension):
    return extension("curvefold_addon.bridge.drawing")


@pytest.fixture
def square(extension):
    """A sheet of 2 by 2 about its origin, without creases."""
    objects = extension("curvefold_addon.bridge.drawing_objects")
    splines = extension("curvefold_addon.bridge.splines")
    curve = objects.new_curve("Sheet")
    splines.add_poly_spline(curve, np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]), True)
    return objects.new_sheet(curve, bpy.context.collection)


@pytest.fixture
def add_crease(extension, square):
    """Adds a crease with one spline; ``fill`` gets the Curve datablock."""
    objects = extension("curvefold_addon.bridge.drawing_objects")

    def add(fill, name="Crease", assignment="U"):
        curve = objects.new_curve(name)
        fill(curve)
        return objects.new_crease(curve, square, assignment)

    return add


def poly(*points, closed=False):
    def fill(curve):
        spline = curve.splines.new("POLY")
        spline.points.add(len(points) - 1)
        for point, place in zip(spline.points, points, strict=True):
            point.co = (*place, *(0.0,) * (3 - len(place)), 1.0)
        spline.use_cyclic_u = closed

    return fill


def arc(curve):
    """A quarter circle about (-1, -1), a Bezier spline of one segment."""
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(1)
    start, end = spline.bezier_points
    for point in (start, end):
        point.handle_left_type = point.handle_right_type = "FREE"
    start.co, start.handle_left, start.handle_right = (0, -1, 0), (0, -1.5, 0), (0, -0.4477, 0)
    end.co, end.handle_left, end.handle_right = (-1, 0, 0), (-0.4477, 0, 0), (-1.5, 0, 0)


def line_of(crease):
    points = np.vstack([crease.points, crease.points[:1]]) if crease.closed else crease.points
    return shapely.LineString(points)


def apart(first, second):
    return shapely.hausdorff_distance(line_of(first), line_of(second))


# --- round trip ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
@pytest.mark.parametrize("scale_length", [1.0, 0.001])
def test_a_pattern_comes_back_the_same(extension, drawing_module, path, scale_length):
    bpy.context.scene.unit_settings.scale_length = scale_length
    pattern = extension("solver").read_pattern(path)
    sheet = drawing_module.add_drawing(pattern, bpy.context.collection)
    found = drawing_module.read_drawing(sheet)

    unit = found.unit_mm / pattern.unit_mm  # the drawing's units in one Blender unit
    assert found.unit_mm == pytest.approx(1000 * scale_length)
    middle = 0.5 * (pattern.boundary.min(axis=0) + pattern.boundary.max(axis=0))
    size = np.ptp(pattern.boundary, axis=0).max()

    def same(mine, theirs):
        assert mine.shape == theirs.shape
        assert np.abs(mine * unit + middle - theirs).max() < SAME * size

    same(found.boundary, pattern.boundary)
    for mine, theirs in zip(found.holes, pattern.holes, strict=True):
        same(mine, theirs)
    names = {crease.name or f"Crease {k + 1}": crease for k, crease in enumerate(pattern.creases)}
    assert len(found.creases) == len(pattern.creases) == len(names)
    for crease in found.creases:
        original = names[crease.name]
        assert (crease.closed, crease.assignment) == (original.closed, original.assignment)
        assert original.beziers is not None
        same(crease.beziers, original.beziers)
    assert drawing_module.troubles(sheet) == ()


def test_a_crease_of_samples_only_comes_back_as_samples(extension, drawing_module):
    solver = extension("solver")
    crease = solver.Crease([(0, 5), (3, 6), (7, 6), (10, 5)], assignment="M", name="samples")
    pattern = solver.CreasePattern([(0, 0), (10, 0), (10, 10), (0, 10)], creases=[crease], unit_mm=1000.0)
    sheet = drawing_module.add_drawing(pattern, bpy.context.collection)
    (found,) = drawing_module.read_drawing(sheet).creases
    assert found.beziers is None
    assert np.abs(found.points + 5 - crease.points).max() < 10 * SAME


def test_a_drawing_without_a_unit_is_in_millimetres(extension, drawing_module):
    solver = extension("solver")
    pattern = solver.CreasePattern([(0, 0), (210, 0), (210, 297), (0, 297)])
    sheet = drawing_module.add_drawing(pattern, bpy.context.collection)
    assert np.ptp(drawing_module.read_drawing(sheet).boundary, axis=0) == pytest.approx([0.21, 0.297])
    assert drawing_module.sheet_size(sheet) == pytest.approx(0.297)


# --- splines -------------------------------------------------------------------------------------------


def shown(crease_object):
    """Blender's own vertices of a curve."""
    crease_object.data.bevel_depth = 0.0
    evaluated = crease_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = np.array([vertex.co[:] for vertex in mesh.vertices])
    edges = len(mesh.edges)
    evaluated.to_mesh_clear()
    return points[:, :2], edges == len(points)


def assert_shown(crease, crease_object, within=2e-5):
    """The pattern's crease runs through all of Blender's vertices, from the first to the last."""
    points, closed = shown(crease_object)
    assert crease.closed == closed
    assert np.max(shapely.distance(shapely.points(points), line_of(crease))) < within
    assert np.abs(crease.points[0] - points[0]).max() < 1e-6
    if not closed:
        assert np.abs(crease.points[-1] - points[-1]).max() < 1e-6


def line_along(beziers):
    """(S,4,2) segments as a line so fine that it is as good as they are: 20,000 points or more."""
    t = np.linspace(0, 1, max(64, 20_000 // len(beziers)))[:, None]
    s = 1 - t
    powers = (s**3, 3 * s * s * t, 3 * s * t * t, t**3)
    places = sum(power * beziers[:, None, k] for k, power in enumerate(powers))
    return shapely.LineString(places.reshape(-1, 2))


def test_bezier(drawing_module, square, add_crease):
    item = add_crease(arc)
    (crease,) = drawing_module.read_drawing(square).creases
    assert crease.beziers[0] == pytest.approx(np.array([[0, -1], [0, -0.4477], [-0.4477, 0], [-1, 0]]))
    assert_shown(crease, item)


def test_cyclic_bezier(drawing_module, square, add_crease):
    def fill(curve):
        arc(curve)
        curve.splines[0].use_cyclic_u = True

    item = add_crease(fill)
    (crease,) = drawing_module.read_drawing(square).creases
    assert len(crease.beziers) == 2
    assert_shown(crease, item)


def test_automatic_handles(drawing_module, square, add_crease):
    def fill(curve):
        spline = curve.splines.new("BEZIER")
        spline.bezier_points.add(3)
        for point, place in zip(spline.bezier_points, [(-1, 0), (-0.3, 0.5), (0.2, -0.4), (1, 0.3)], strict=True):
            point.co = (*place, 0)
            point.handle_left_type = point.handle_right_type = "AUTO"

    item = add_crease(fill)
    (crease,) = drawing_module.read_drawing(square).creases
    assert_shown(crease, item)


@pytest.mark.parametrize("cyclic", [False, True])
@pytest.mark.parametrize("endpoint", [False, True])
@pytest.mark.parametrize("bezier", [False, True])
@pytest.mark.parametrize(("count", "order"), [(7, 4), (6, 4), (9, 3), (5, 5), (8, 2), (12, 6), (3, 4), (78, 40)])
def test_nurbs(drawing_module, square, add_crease, cyclic, endpoint, bezier, count, order):
    random = np.random.default_rng(count + 10 * order)

    def fill(curve):
        spline = curve.splines.new("NURBS")
        spline.points.add(count - 1)
        for point in spline.points:
            x, y = random.uniform(-0.9, 0.9, 2)
            point.co = (x, y, 0, random.uniform(0.5, 2))
        spline.order_u = order
        spline.use_cyclic_u, spline.use_endpoint_u, spline.use_bezier_u = cyclic, endpoint, bezier
        curve.resolution_u = 7

    item = add_crease(fill)
    (crease,) = drawing_module.read_drawing(square).creases
    # Samples may be as far from a short cubic as 0.4 % of its length: it is shorter than 1 % of the sheet's 2 m.
    assert_shown(crease, item, within=8e-5)
    if crease.beziers is not None:
        points, _ = shown(item)
        assert np.max(shapely.distance(shapely.points(points), line_along(crease.beziers))) < 1e-6


@pytest.mark.parametrize("closed", [False, True])
def test_poly(drawing_module, square, add_crease, closed):
    places = [(-0.5, -0.5), (0.5, -0.4), (0.3, 0.6), (-0.2, 0.2)]
    item = add_crease(poly(*places, closed=closed))
    (crease,) = drawing_module.read_drawing(square).creases
    assert crease.points == pytest.approx(np.array(places))
    assert crease.beziers is None
    assert_shown(crease, item)


def test_every_spline_is_a_crease(drawing_module, square, add_crease):
    def fill(curve):
        poly((-1, 0), (1, 0.1))(curve)
        arc(curve)

    add_crease(fill, "Pair", "V")
    creases = drawing_module.read_drawing(square).creases
    assert [(crease.name, crease.assignment) for crease in creases] == [("Pair part 1", "V"), ("Pair part 2", "V")]


def test_a_flat_crease_is_not_folded(drawing_module, square, add_crease):
    add_crease(arc, assignment="F")
    assert drawing_module.read_drawing(square).creases == ()


def test_creases_come_by_name(drawing_module, square, add_crease):
    for name in ("Crease 10", "Crease 9", "Crease 1"):
        add_crease(arc, name)
    names = [crease.name for crease in drawing_module.read_drawing(square).creases]
    assert names == ["Crease 1", "Crease 9", "Crease 10"]


def test_a_deleted_crease_is_gone(drawing_module, square, add_crease):
    item = add_crease(arc)
    item.use_fake_user = True
    for collection in item.users_collection:
        collection.objects.unlink(item)
    assert item.parent == square
    assert drawing_module.read_drawing(square).creases == ()


def test_shape_keys_and_hooks_are_seen(drawing_module, square, add_crease):
    item = add_crease(arc)
    item.shape_key_add(name="Basis")
    key = item.shape_key_add(name="Bent")
    key.data[1].co = (-0.9, 0.4, 0)
    key.value = 0.5
    empty = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(empty)
    hook = item.modifiers.new("Hook", "HOOK")
    hook.object = empty
    hook.vertex_indices_set([0, 1, 2])
    bpy.context.view_layer.update()
    empty.location = (0.125, 0, 0)
    bpy.context.view_layer.update()
    (crease,) = drawing_module.read_drawing(square).creases
    assert crease.points[0] == pytest.approx([0.125, -1.0], abs=1e-6)
    assert crease.points[-1] == pytest.approx([-0.95, 0.2], abs=1e-6)


def test_a_curve_is_read_while_it_is_edited(drawing_module, square, add_crease):
    item = add_crease(arc)
    bpy.context.view_layer.objects.active = item
    bpy.ops.object.mode_set(mode="EDIT")
    item.data.splines[0].bezier_points[0].co.x = 0.25
    (crease,) = drawing_module.read_drawing(square).creases
    assert crease.points[0] == pytest.approx([0.25, -1.0])
    bpy.ops.object.mode_set(mode="OBJECT")


# --- transforms and units ------------------------------------------------------------------------------


def test_the_sheet_may_be_anywhere(drawing_module, square, add_crease):
    item = add_crease(arc)
    before = drawing_module.read_drawing(square)
    square.location = (300, -200, 50)
    square.rotation_euler = (1.0, 0.5, -2.0)
    square.scale = (3, 3, 3)
    for update in (False, True):  # also before Blender has evaluated it
        if update:
            bpy.context.view_layer.update()
        after = drawing_module.read_drawing(square)
        assert np.array_equal(after.creases[0].beziers, before.creases[0].beziers)
        assert np.array_equal(after.boundary, before.boundary)
        assert after.unit_mm == pytest.approx(3000.0)
    assert item.parent == square


def test_creases_are_taken_to_the_sheet(drawing_module, square, add_crease):
    """Below a turned parent of the sheet, with a parent inverse, a transform and a delta of their own."""
    item = add_crease(poly((0, 0), (1, 0)))
    above = bpy.data.objects.new("Above", None)
    bpy.context.collection.objects.link(above)
    above.matrix_basis = Matrix.LocRotScale((1, 2, 3), Euler((0.3, 0.2, 0.1)), (2, 2, 2))
    square.parent = above
    item.location = (0.25, -0.5, 0)
    item.delta_location = (0.25, 0, 0)
    item.rotation_euler.z = radians(90)
    item.scale = (0.5, 0.5, 0.5)
    item.matrix_parent_inverse = Matrix.Translation((0, 0.125, 0))
    (crease,) = drawing_module.read_drawing(square).creases
    assert crease.points == pytest.approx(np.array([(0.5, -0.375), (0.5, 0.125)]))
    bpy.context.view_layer.update()
    world = np.array(item.matrix_world) @ [1, 0, 0, 1]
    local = np.linalg.inv(np.array(square.matrix_world)) @ world
    assert crease.points[1] == pytest.approx(local[:2], abs=1e-5)
    assert drawing_module.read_drawing(square).unit_mm == pytest.approx(2000.0)


def test_a_constrained_crease_is_where_blender_has_it(drawing_module, square, add_crease):
    item = add_crease(poly((0, 0), (1, 0)))
    target = bpy.data.objects.new("Target", None)
    bpy.context.collection.objects.link(target)
    target.location = (-0.5, 0.5, 0)
    constraint = item.constraints.new("COPY_LOCATION")
    constraint.target = target
    square.rotation_euler.z = pi
    bpy.context.view_layer.update()
    (crease,) = drawing_module.read_drawing(square).creases
    assert crease.points == pytest.approx(np.array([(0.5, -0.5), (1.5, -0.5)]), abs=1e-6)


def test_a_crease_may_hang_below_another_object(drawing_module, square, add_crease):
    item = add_crease(arc)
    group = bpy.data.objects.new("Group", None)
    bpy.context.collection.objects.link(group)
    group.parent = square
    item.parent = group
    assert len(drawing_module.read_drawing(square).creases) == 1


# --- borders -------------------------------------------------------------------------------------------


def resheet(square, *fills):
    square.data.splines.clear()
    for fill in fills:
        fill(square.data)


def circle(radius, count=40, centre=(0.0, 0.0)):
    places = [
        (centre[0] + radius * cos(2 * pi * k / count), centre[1] + radius * sin(2 * pi * k / count))
        for k in range(count)
    ]
    return poly(*places, closed=True)


def test_holes(drawing_module, square):
    resheet(square, circle(0.3), circle(1.0))
    pattern = drawing_module.read_drawing(square)
    assert len(pattern.boundary) == 40
    assert np.hypot(*pattern.boundary.T) == pytest.approx(1.0)
    (hole,) = pattern.holes
    assert np.hypot(*hole.T) == pytest.approx(0.3)


def test_a_border_of_several_lines(drawing_module, square):
    resheet(square, poly((-1, -1), (1, -1), (1, 1)), poly((1, 1), (-1, 1), (-1, -1)))
    assert shapely.Polygon(drawing_module.read_drawing(square).boundary).area == pytest.approx(4.0)


def test_an_open_border_whose_ends_meet(drawing_module, square):
    resheet(square, poly((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1 + 1e-5)))
    assert len(drawing_module.read_drawing(square).boundary) == 4
    circle(0.3)(square.data)
    pattern = drawing_module.read_drawing(square)
    assert (len(pattern.boundary), len(pattern.holes)) == (4, 1)


BAD_BORDERS = {
    "its border is not closed": (poly((-1, -1), (1, -1), (1, 1), (-1, 1)), (-1, 1)),
    "the border crosses itself": (poly((-1, -1), (1, 1), (1, -1), (-1, 1), closed=True), (0, 0)),
    "it has no border: its curve is empty": (lambda curve: None, None),
    "a point of it is not finite": (poly((-1, -1), (1, float("nan")), (1, 1), closed=True), None),
    "the drawing needs more than 200,000 points": (None, None),
}


@pytest.mark.parametrize("sentence", BAD_BORDERS)
def test_a_border_that_is_none(extension, drawing_module, square, sentence, monkeypatch):
    fill, place = BAD_BORDERS[sentence]
    if fill is None:
        monkeypatch.setattr(drawing_module, "MAX_POINTS", 3)
        fill = arc
    resheet(square, fill)
    square.location.x = 10.0
    with pytest.raises(extension("solver").PatternError) as caught:
        drawing_module.read_drawing(square)
    assert sentence in str(caught.value)
    assert "Sheet" in str(caught.value)
    (trouble,) = drawing_module.troubles(square)
    assert (trouble.sentence, trouble.object_name) == (f"Sheet: {sentence}", "Sheet")
    if place is None:
        assert trouble.place is None
    else:
        assert trouble.place == pytest.approx((place[0] + 10, place[1], 0))


def test_a_sheet_without_size_or_curve(extension, drawing_module, square):
    error = extension("solver").PatternError
    square.scale = (1, 1, 0)
    with pytest.raises(error, match="its scale is zero"):
        drawing_module.read_drawing(square)
    mesh = bpy.data.objects.new("Mesh", bpy.data.meshes.new("Mesh"))
    with pytest.raises(error, match="no longer a curve"):
        drawing_module.read_drawing(mesh)


# --- troubles ------------------------------------------------------------------------------------------


def sentences(drawing_module, sheet):
    return [trouble.sentence for trouble in drawing_module.troubles(sheet)]


def test_a_sheet_on_which_nobody_has_drawn_yet_is_no_trouble(drawing_module, square):
    assert sentences(drawing_module, square) == []


def test_a_drawing_of_flat_creases_only(drawing_module, square, add_crease):
    crease = add_crease(arc, assignment="F")
    assert sentences(drawing_module, square) == ["Sheet: all its creases are Flat, so there is nothing to fold"]
    crease.curvefold.assignment = "U"
    assert sentences(drawing_module, square) == []


def test_an_empty_crease_is_no_trouble_while_it_is_drawn(extension, drawing_module, square, add_crease):
    marks = extension("curvefold_addon.overlay.trouble_marks")
    crease = add_crease(lambda curve: None, "Empty")
    bpy.context.view_layer.objects.active = crease

    def said():
        bpy.context.view_layer.update()
        return [trouble.sentence for trouble in marks.of_sheet(square)]

    empty = ["Empty: it is empty: draw a curve in it, or delete it"]
    assert said() == empty
    bpy.ops.object.mode_set(mode="EDIT")
    assert said() == []
    bpy.ops.object.mode_set(mode="OBJECT")
    assert said() == empty


def test_a_good_drawing_has_no_trouble(drawing_module, square, add_crease):
    add_crease(arc)
    add_crease(poly((-1.2, 0.5), (0, 0.6), (1.2, 0.5)), "Beyond the border")
    assert drawing_module.troubles(square) == ()


BAD_CREASES = {
    "Bad: it lies off the sheet and is left out": (poly((2, 0), (2, 1)), (2, 0.5)),
    "Bad: it runs along the border, where nothing can fold, and is left out": (poly((-1, -1), (1, -1)), (0, -1)),
    "Bad: it is too short to be folded and is left out": (poly((0, 0), (0.002, 0)), (0.001, 0)),
    "Bad: it has no length and is left out": (poly((0.5, 0), (0.5, 0)), (0.5, 0)),
    "Bad: it is empty: draw a curve in it, or delete it": (lambda curve: None, None),
    "Bad: a point of it is not finite, so it is left out": (poly((0, 0), (float("nan"), 0)), None),
}


@pytest.mark.parametrize("sentence", BAD_CREASES)
def test_a_crease_that_is_left_out(drawing_module, square, add_crease, sentence):
    add_crease(arc)
    fill, place = BAD_CREASES[sentence]
    add_crease(fill, "Bad")
    square.location.z = 5.0
    (trouble,) = drawing_module.troubles(square)
    assert (trouble.sentence, trouble.object_name) == (sentence, "Bad")
    if place is None:
        assert trouble.place is None
    else:
        assert trouble.place == pytest.approx((*place, 5.0), abs=1e-6)
    assert [crease.name for crease in drawing_module.read_drawing(square).creases] == ["Crease"]


def test_a_spline_of_one_point_is_nothing(drawing_module, square, add_crease):
    def fill(curve):
        poly((0.1, 0.2))(curve)
        arc(curve)
        curve.splines.new("BEZIER")

    poly((0.5, 0.5))(square.data)
    add_crease(fill, "Clicked")
    assert sentences(drawing_module, square) == []
    assert [crease.name for crease in drawing_module.read_drawing(square).creases] == ["Clicked"]


def test_a_crease_of_single_points_is_empty(drawing_module, square, add_crease):
    def fill(curve):
        poly((0.1, 0.2))(curve)
        poly((0.3, 0.2))(curve)

    add_crease(fill, "Clicked")
    assert sentences(drawing_module, square) == ["Clicked: it is empty: draw a curve in it, or delete it"]
    assert not drawing_module.read_drawing(square).creases


def test_one_bad_spline_of_several(drawing_module, square, add_crease):
    def fill(curve):
        poly((5, 5), (6, 6))(curve)
        poly((0.1, 0.2))(curve)
        arc(curve)

    add_crease(fill, "Three")
    assert sentences(drawing_module, square) == [
        "Three: part 1 lies off the sheet and is left out",
    ]
    assert [crease.name for crease in drawing_module.read_drawing(square).creases] == ["Three part 2"]


def test_a_crease_in_a_hole_is_off_the_sheet(drawing_module, square, add_crease):
    resheet(square, circle(1.0), circle(0.5))
    add_crease(poly((-0.2, 0), (0.2, 0)), "Bad")
    assert "Bad: it lies off the sheet and is left out" in sentences(drawing_module, square)


def test_a_crease_off_the_plane(drawing_module, square, add_crease):
    item = add_crease(poly((-1, 0), (1, 0)))
    item.location.z = 0.01
    square.scale = (3, 3, 3)
    (trouble,) = drawing_module.troubles(square)
    assert trouble.sentence.startswith("Crease: it leaves the sheet's plane by 3 cm")
    assert trouble.place == pytest.approx((-3, 0, 0.03))
    assert len(drawing_module.read_drawing(square).creases) == 1
    bpy.context.scene.unit_settings.system = "NONE"
    assert "by 0.03;" in drawing_module.troubles(square)[0].sentence


def test_an_unevenly_scaled_sheet(drawing_module, square, add_crease):
    add_crease(arc)
    square.scale = (2, 1, 1)
    (sentence,) = sentences(drawing_module, square)
    assert sentence == "Sheet: it is scaled unevenly, so the paper is not as it looks; apply its scale"
    assert drawing_module.read_drawing(square).unit_mm == pytest.approx(1000 * 2**0.5)


def test_parts_of_a_border_that_do_not_belong(drawing_module, square, add_crease):
    add_crease(arc)
    resheet(square, circle(1.0), circle(0.2, centre=(3.0, 0.0)), poly((0, 0), (0.5, 0)))
    assert sentences(drawing_module, square) == [
        "Sheet: a part of its border lies beside the largest one and is left out",
        "Sheet: a part of its border is not closed and is left out",
    ]
    assert drawing_module.read_drawing(square).holes == ()


def test_modifiers_that_the_paper_does_not_see(drawing_module, square, add_crease):
    item = add_crease(arc)
    item.modifiers.new("Array", "ARRAY")
    assert sentences(drawing_module, square) == ["Crease: the paper does not see its modifier Array; apply it"]


def test_a_crease_that_became_a_mesh(drawing_module, square, add_crease):
    add_crease(arc)
    mesh = bpy.data.objects.new("Mesh", bpy.data.meshes.new("Mesh"))
    bpy.context.collection.objects.link(mesh)
    mesh.parent = square
    mesh.curvefold.role = "CREASE"
    assert sentences(drawing_module, square) == ["Mesh: it is no longer a curve, so it is left out"]


def test_reading_leaves_nothing_behind(drawing_module, square, add_crease):
    item = add_crease(arc)
    item.shape_key_add(name="Basis")
    bpy.context.view_layer.update()
    before = {name: len(getattr(bpy.data, name)) for name in ("objects", "curves", "meshes", "materials")}
    for _ in range(20):
        drawing_module.troubles(square)
    assert before == {name: len(getattr(bpy.data, name)) for name in before}


def test_mountains_and_valleys_look_different(extension, square, add_crease):
    objects = extension("curvefold_addon.bridge.drawing_objects")
    first, second = add_crease(arc, "First", "M"), add_crease(arc, "Second", "V")
    second.data = first.data  # creases that share a curve may differ
    objects.show_assignment(second)
    looks = [item.material_slots[0].material for item in (first, second)]
    assert [look.name for look in looks] == ["Curvefold Mountain", "Curvefold Valley"]
    assert looks[0].diffuse_color[0] > looks[0].diffuse_color[2]
    assert looks[1].diffuse_color[0] < looks[1].diffuse_color[2]
