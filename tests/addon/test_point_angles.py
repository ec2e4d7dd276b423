"""Fold angles at single points of creases."""

from functools import partial
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector
from papers import edit, rests, shape


def entries(paper):
    return paper.data.curvefold.angles


@pytest.fixture
def arrays(extension):
    return extension("curvefold_addon.bridge.overlay")


@pytest.fixture
def folded_paper(paper, live):
    paper.data.curvefold.fold = 50.0
    live.settle(paper.data)
    return paper


def select(paper, *xs, others=False) -> None:
    """Edit Mode with the vertices of the crease selected that are nearest to these x, or with all others."""
    edited, flat = edit(paper)
    crease = edited.edges.layers.int["crease"]
    x = {vertex: place.x for vertex, place in flat.items()}
    creased = [vertex for vertex in x if any(edge[crease] >= 0 for edge in vertex.link_edges)]
    for vertex in x:
        vertex.select = others and vertex not in creased
    for wanted in xs:
        min(creased, key=lambda vertex: abs(x[vertex] - wanted)).select = True
    bmesh.update_edit_mesh(paper.data)


def measured(live, arrays, paper, at) -> float:
    found = live.session(paper.data)
    return arrays.angle_at(found.net, found.positions, at)


@pytest.fixture
def asked(folded_paper):
    """A folded paper whose crease has an angle of its own at one point."""
    select(folded_paper, 0.0)
    assert bpy.ops.curvefold.add_angles() == {"FINISHED"}
    assert len(entries(folded_paper)) == 1
    return folded_paper


# --- at vertices ----------------------------------------------------------------------------------------------


def test_an_angle_begins_as_it_is_and_then_leads_its_point(asked, live, arrays):
    assert asked.mode == "OBJECT"
    angle = entries(asked)[0]
    assert angle.name == "Angle 1"
    assert angle.at[0] == pytest.approx(0.0, abs=0.004)
    assert np.degrees(angle.angle) == pytest.approx(45.0, abs=2.0), "the slider's"
    angle.angle = np.radians(25.0)
    live.settle(asked.data)
    assert measured(live, arrays, asked, angle.at) == pytest.approx(25.0, abs=2.0)
    assert measured(live, arrays, asked, (-0.04, -0.04)) is None, "far from the crease there is none"
    ends = [label for label in (-0.04, 0.04) if measured(live, arrays, asked, _place(asked, label)) > 33.0]
    assert ends, "the rest of the crease is the slider's"
    assert rests(live, asked)
    live.forget()
    assert rests(live, asked)


def _place(paper, x):
    """A point of the flat crease, by its x."""
    mesh = paper.data
    flat = {loop.vertex_index: mesh.uv_layers["flat"].uv[loop.index].vector for loop in mesh.loops}
    marks = mesh.attributes["crease"].data
    places = [flat[v] for edge in mesh.edges if marks[edge.index].value >= 0 for v in edge.vertices]
    return min(places, key=lambda place: abs(place.x - x))[:]


def test_on_a_flat_paper_it_begins_at_sixty_degrees_and_folds(paper, live, arrays):
    select(paper, 0.0)
    assert bpy.ops.curvefold.add_angles() == {"FINISHED"}
    angle = entries(paper)[0]
    assert np.degrees(angle.angle) == pytest.approx(60.0)
    assert measured(live, arrays, paper, angle.at) == pytest.approx(60.0, abs=3.0)


def test_a_signed_angle_chooses_the_side(paper, live):
    select(paper, 0.0)
    bpy.ops.curvefold.add_angles()
    paper.data.curvefold.use_assignments = False
    angle = entries(paper)[0]
    angle.signed = True
    for degrees, side in ((40.0, "V"), (-40.0, "M")):
        angle.angle = np.radians(degrees)
        bpy.ops.curvefold.flatten()
        live.settle(paper.data)
        assert live.report(paper.data).creases[0].found == side
        assert live.report(paper.data).lacks == ()


def test_each_selected_vertex_of_a_crease_gets_one_and_others_none(folded_paper):
    select(folded_paper, others=True)
    with pytest.raises(RuntimeError, match="Select vertices on creases"):
        bpy.ops.curvefold.add_angles()
    select(folded_paper, -0.03, 0.02, others=True)
    assert bpy.ops.curvefold.add_angles() == {"FINISHED"}
    assert sorted(round(angle.at[0], 2) for angle in entries(folded_paper)) == [-0.03, 0.02]
    assert [angle.name for angle in entries(folded_paper)] == ["Angle 1", "Angle 2"]
    assert folded_paper.data.curvefold.active_angle == 1
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(RuntimeError, match="Select vertices on creases"):
        bpy.ops.curvefold.add_angles()


# --- on, off, gone, and back ----------------------------------------------------------------------------------


def test_vertices_that_share_a_point_of_the_net_share_an_angle(asked):
    """The shown crease has more vertices than the net has points for."""
    select(asked, -0.0004, 0.0, 0.0004)
    before = len(entries(asked))
    bpy.ops.curvefold.add_angles()
    assert len(entries(asked)) == before == 1
    select(asked, 0.03)
    bpy.ops.curvefold.add_angles()
    assert asked.data.curvefold.active_angle == 1
    select(asked, 0.0)
    bpy.ops.curvefold.add_angles()
    assert (len(entries(asked)), asked.data.curvefold.active_angle) == (2, 0), "the one that is there is shown"


def test_one_that_is_switched_off_does_not_act(asked, live, arrays):
    angle = entries(asked)[0]
    angle.angle = np.radians(25.0)
    angle.enabled = False
    live.settle(asked.data)
    assert live.session(asked.data).inputs.controls == ()
    assert measured(live, arrays, asked, angle.at) == pytest.approx(45.0, abs=2.0)


def test_it_is_removed_and_undo_brings_it_back(asked, live):
    entries(asked)[0].angle = np.radians(25.0)
    live.settle(asked.data)
    name, before = asked.name, shape(asked.data)
    bpy.ops.ed.undo_push(message="asked")
    bpy.ops.curvefold.remove_angle("EXEC_DEFAULT", True)
    assert not entries(asked)
    assert shape(asked.data) != before
    with pytest.raises(RuntimeError, match="no such angle"):
        bpy.ops.curvefold.remove_angle()
    bpy.ops.ed.undo()
    paper = bpy.data.objects[name]
    assert np.degrees(entries(paper)[0].angle) == pytest.approx(25.0)
    assert shape(paper.data) == before
    assert rests(live, paper)


def test_files_keep_it(asked, live, arrays, tmp_path):
    angle = entries(asked)[0]
    angle.angle, angle.strength = np.radians(25.0), 2.0
    live.settle(asked.data)
    path, name, before = str(tmp_path / "asked.blend"), asked.name, shape(asked.data)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    paper = bpy.data.objects[name]
    assert shape(paper.data) == before
    assert rests(live, paper)
    entries(paper)[0].angle = np.radians(35.0)
    live.settle(paper.data)
    assert measured(live, arrays, paper, entries(paper)[0].at) == pytest.approx(35.0, abs=2.0)


def test_a_keyframed_angle_plays_the_same_each_time(asked, live):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 3
    angle = entries(asked)[0]
    for frame, degrees in ((1, 45.0), (3, 35.0)):
        angle.angle = np.radians(degrees)
        angle.keyframe_insert("angle", frame=frame)

    def play():
        shapes = []
        for frame in (1, 2, 3):
            scene.frame_set(frame)
            shapes.append(shape(asked.data))
        return shapes

    first = play()
    assert len(set(first)) == 3
    live.forget()
    assert play() == first


def test_another_resolution_keeps_it(asked, live, arrays):
    angle = entries(asked)[0]
    angle.angle = np.radians(30.0)
    asked.data.curvefold.resolution = 17
    live.settle(asked.data)
    assert measured(live, arrays, asked, angle.at) == pytest.approx(30.0, abs=2.0)
    assert live.report(asked.data).lacks == ()


def test_when_its_crease_has_moved_away_it_says_so(asked, live):
    crease = asked.data.curvefold.sheet.children[0]
    crease.location.y -= 0.02
    bpy.context.view_layer.update()
    live.rebuild(asked.data)
    live.settle(asked.data)
    assert live.report(asked.data).sentence == "Angle 1: there is no crease near this point"
    assert len(entries(asked)) == 1
    crease.location.y += 0.02
    bpy.context.view_layer.update()
    live.rebuild(asked.data)
    live.settle(asked.data)
    assert live.report(asked.data).lacks == ()


# --- what cannot be had ---------------------------------------------------------------------------------------


def test_two_angles_at_one_point_are_refused_in_words(asked, live, arrays):
    twin = entries(asked).add()
    twin.name, twin.at, twin.angle = "Angle 2", entries(asked)[0].at, np.radians(10.0)
    live.settle(asked.data)
    report = live.report(asked.data)
    assert report.state == "trouble"
    assert report.sentence == "Angle 2: asks for another angle where an earlier one holds"
    assert measured(live, arrays, asked, twin.at) == pytest.approx(45.0, abs=2.0), "the first one acts"


def test_neighbours_that_no_surface_has_are_answered_in_words(paper, live):
    """A fold angle cannot jump along a crease."""
    select(paper, -0.01, 0.0)
    bpy.ops.curvefold.add_angles()
    first, second = entries(paper)
    first.signed = second.signed = True
    first.angle, second.angle = np.radians(-150.0), np.radians(150.0)
    live.settle(paper.data)
    report = live.report(paper.data)
    assert report.state == "trouble"
    assert any("were asked: the sheet allows no more" in lack for lack in report.lacks)
    assert np.isfinite(live.session(paper.data).positions).all()


# --- by clicking ----------------------------------------------------------------------------------------------


@pytest.fixture
def clicks(extension):
    return extension("curvefold_addon.operators.click_on_crease")


def test_a_ray_finds_the_nearest_point_of_a_crease(clicks, folded_paper, live):
    paper = folded_paper
    paper.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Rotation(0.7, 4, (1, 0, 1)) @ Matrix.Scale(2, 4)
    bpy.context.view_layer.update()
    normal = (paper.matrix_world.to_3x3() @ Vector((0, 0, 1))).normalized()
    found = live.session(paper.data)
    for x in (-0.03, 0.011):
        wanted = _place(paper, x)
        beside = paper.matrix_world @ Vector(found.place_of((wanted[0], wanted[1] + 0.001)))
        point = clicks.crease_along(paper, clicks.MouseRay(beside + normal, -normal))
        assert point.crease == 0
        assert point.at == pytest.approx(wanted, abs=0.002)
    assert clicks.crease_along(paper, clicks.MouseRay(Vector((99, 99, 99)), -normal)) is None


class Window(SimpleNamespace):
    """As much of a window, and of its 3D view from above, as the operators ask for."""

    def __init__(self):
        calls = []
        side = SimpleNamespace(type="UI", x=150, y=0, width=50, height=100)
        view = SimpleNamespace(perspective_matrix=Matrix())
        main = SimpleNamespace(type="WINDOW", x=0, y=0, width=100, height=100, data=view)
        area = SimpleNamespace(type="VIEW_3D", regions=[main, side], tag_redraw=lambda: calls.append("redrawn"))
        super().__init__(
            calls=calls,
            screen=SimpleNamespace(areas=[area]),
            cursor_modal_set=calls.append,
            cursor_modal_restore=lambda: calls.append("restored"),
        )


@pytest.fixture(params=["pick_crease.PickCrease", "point_angles.PlaceAngle"])
def clicking(extension, paper, monkeypatch, request):
    """An operator that waits for its click, a function that sends it events, and what it has said and done.

    The view looks from above; its mouse is at millimetres from the sheet's lower left corner. The interface has the
    scale 0, so that nothing is near the mouse.
    """
    rays = extension("curvefold_addon.mouse_ray")
    module, _, name = request.param.partition(".")
    cls = getattr(extension(f"curvefold_addon.operators.{module}"), name)
    window = Window()
    context = SimpleNamespace(
        scene=bpy.context.scene,
        mode="OBJECT",
        active_object=paper,
        area=SimpleNamespace(type="VIEW_3D"),
        window=window,
        workspace=SimpleNamespace(status_text_set=window.calls.append),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=0.0)),
        window_manager=SimpleNamespace(modal_handler_add=lambda operator: window.calls.append("waits")),
    )

    def origin(region, view, at):
        return Vector((at[0] / 1e3 - 0.05, at[1] / 1e3 - 0.05, 1))

    monkeypatch.setattr(rays.view3d_utils, "region_2d_to_origin_3d", origin)
    monkeypatch.setattr(rays.view3d_utils, "region_2d_to_vector_3d", lambda *_: Vector((0, 0, -1)))
    operator = SimpleNamespace(
        report=lambda kind, text: window.calls.append(text), cursor=cls.cursor, help=cls.help
    )
    for method in ("cancel", "refuse", "clicked", "waiting_paper"):
        setattr(operator, method, partial(getattr(cls, method), operator))
    assert cls.invoke(operator, context, None) == {"RUNNING_MODAL"}
    assert window.calls == [cls.cursor, cls.help, "waits"]
    window.calls.clear()

    def send(kind, x=0, y=0, value="PRESS"):
        return cls.modal(operator, context, SimpleNamespace(type=kind, value=value, mouse_x=x, mouse_y=y))

    return cls, send, window.calls


def test_a_click_on_a_crease_does_it_and_ends(clicking, paper):
    cls, send, said = clicking
    paper.data.curvefold.active_crease = 3
    assert send("MOUSEMOVE", 50, 55) == {"PASS_THROUGH"}
    assert send("LEFTMOUSE", 50, 38, "RELEASE") == {"PASS_THROUGH"}
    assert send("LEFTMOUSE", 50, 38) == {"FINISHED"}
    assert said == ["restored", None, "redrawn"]
    if cls.bl_idname.endswith("pick_crease"):
        assert paper.data.curvefold.active_crease == 0
    else:
        (angle,) = entries(paper)
        assert tuple(angle.at) == pytest.approx(_place(paper, 0.0), abs=0.002)


def test_a_click_beside_the_paper_goes_on_waiting_and_one_on_the_sidebar_is_the_panels(clicking, paper):
    _, send, said = clicking
    paper.matrix_world = Matrix.Translation((5, 0, 0))
    bpy.context.view_layer.update()
    assert send("LEFTMOUSE", 50, 50) == {"RUNNING_MODAL"}
    assert send("LEFTMOUSE", 160, 50) == {"PASS_THROUGH"}
    assert said == ["There is no crease under the mouse"]
    assert not entries(paper)


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_keys_that_leave_it(clicking, key):
    _, send, said = clicking
    assert send(key, value="RELEASE") == {"PASS_THROUGH"}
    assert send(key) == {"CANCELLED"}
    assert said == ["restored", None]


def test_it_ends_when_the_paper_is_gone(clicking, paper):
    _, send, said = clicking
    bpy.data.objects.remove(paper)
    assert send("MOUSEMOVE") == {"CANCELLED"}
    assert said == ["restored", None]


def test_a_spoilt_paper_is_one_sentence(clicking, paper):
    _, send, said = clicking
    paper.data.attributes.remove(paper.data.attributes["crease"])
    assert send("LEFTMOUSE", 50, 50) == {"CANCELLED"}
    assert said[:2] == ["restored", None]
    assert "has lost its crease layer" in said[2]


def test_they_begin_only_in_a_3d_view(extension):
    cls = extension("curvefold_addon.operators.point_angles").PlaceAngle
    said = []
    for area in (None, SimpleNamespace(type="OUTLINER")):
        cls.invoke(SimpleNamespace(refuse=said.append, what=cls.what), SimpleNamespace(area=area), None)
    assert said == ["Creases are clicked in a 3D view"] * 2


def test_without_a_mouse_they_say_what_to_do_instead(paper):
    with pytest.raises(RuntimeError, match="use At Vertices"):
        bpy.ops.curvefold.place_angle()
    with pytest.raises(RuntimeError, match="choose one in the list"):
        bpy.ops.curvefold.pick_crease()
