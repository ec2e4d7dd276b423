"""The tool that draws creases: on loan while one is drawn, then given back. Single points are dropped."""

from types import SimpleNamespace

import bpy
import pytest

#: Blender without a window can set no tool that has keys of its own, so these stand for those of the drawing.
DRAWS, MINE, OTHER = "builtin.select_box", "builtin.select_circle", "builtin.select_lasso"


@pytest.fixture
def tool(extension, monkeypatch):
    module = extension("curvefold_addon.drawing_tool")
    monkeypatch.setattr(module, "DRAW_TOOL", DRAWS)
    windowed = SimpleNamespace(app=SimpleNamespace(background=False), data=bpy.data, types=bpy.types)
    monkeypatch.setattr(extension("curvefold_addon.operators.draw_crease"), "bpy", windowed)
    yield module
    module.forget()


@pytest.fixture
def sheet(tool):
    """A sheet, and Edit Mode of curves with a tool that somebody has chosen."""
    bpy.ops.curve.primitive_bezier_curve_add()
    bpy.ops.object.mode_set(mode="EDIT")
    choose(MINE)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(bpy.context.active_object)
    bpy.ops.curvefold.add_sheet()
    return bpy.context.active_object


def in_view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return bpy.context.temp_override(window=window, area=area)


def choose(name):
    with in_view():
        bpy.ops.wm.tool_set_by_id(name=name, space_type="VIEW_3D")


def present():
    return bpy.context.workspace.tools.from_space_view3d_mode("EDIT_CURVE", create=False).idname


def draw():
    """As it goes in a window."""
    with in_view():
        assert bpy.ops.curvefold.draw_crease() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_CURVE"
    return bpy.context.active_object


def change_mode(tool, mode):
    """As the Tab key does it."""
    bpy.ops.object.mode_set(mode=mode)
    time_goes_by(tool)


def time_goes_by(tool):
    """Blender notices what has changed, and calls who waits for it; without a window no timer comes."""
    bpy.context.view_layer.update()
    if bpy.app.timers.is_registered(tool.take_turns):
        tool.forget()
        tool.take_turns()


def edit_again(tool):
    bpy.ops.object.mode_set(mode="OBJECT")
    change_mode(tool, "OBJECT")
    change_mode(tool, "EDIT")
    return present()


def click(crease, *places):
    """A spline of so many points, as clicks with the tool leave them."""
    points = crease.data.splines.new("POLY").points
    points.add(len(places) - 1)
    for point, (x, y) in zip(points, places, strict=True):
        point.co = (x, y, 0.0, 1.0)


def test_the_former_tool_is_back_when_edit_mode_is_entered_again(tool, sheet):
    draw()
    assert present() == DRAWS
    change_mode(tool, "EDIT")
    assert present() == DRAWS, "as long as it is drawn"
    assert edit_again(tool) == MINE
    choose(DRAWS)
    assert edit_again(tool) == DRAWS, "chosen by hand it stays"


def test_it_is_back_on_the_sheet_too(tool, sheet):
    draw()
    change_mode(tool, "OBJECT")
    bpy.context.view_layer.objects.active = sheet
    change_mode(tool, "EDIT")
    assert present() == MINE


def test_several_creases_in_a_row(tool, sheet):
    draw()
    draw()
    assert present() == DRAWS
    change_mode(tool, "OBJECT")
    draw()
    change_mode(tool, "EDIT")
    assert present() == DRAWS
    assert edit_again(tool) == MINE


def test_a_tool_that_was_chosen_while_drawing_stays(tool, sheet):
    draw()
    choose(OTHER)
    assert edit_again(tool) == OTHER
    assert edit_again(tool) == OTHER


def test_who_never_had_a_tool_gets_the_usual_one(tool, monkeypatch):
    monkeypatch.setattr(tool, "USUAL_TOOL", OTHER)
    bpy.ops.curvefold.add_sheet()
    draw()
    assert edit_again(tool) == OTHER


@pytest.mark.parametrize("how", ["tab", "make_paper", "draw_crease", "back_to_paper"])
def test_single_points_are_gone_when_the_drawing_ends(tool, sheet, how):
    if how == "back_to_paper":
        bpy.ops.curvefold.make_paper(resolution=12)
    crease = draw()
    bpy.ops.object.mode_set(mode="OBJECT")
    click(crease, (0.01, 0.01))
    click(crease, (-0.2, 0.0), (0.0, 0.02), (0.2, 0.0))
    click(crease, (0.02, 0.01))
    bpy.ops.object.mode_set(mode="EDIT")
    if how == "tab":
        change_mode(tool, "OBJECT")
    else:
        with in_view():
            assert getattr(bpy.ops.curvefold, how)() == {"FINISHED"}
    assert [len(spline.points) for spline in crease.data.splines] == [3]


def test_points_that_are_left_later_stay(tool, sheet):
    crease = draw()
    change_mode(tool, "OBJECT")
    click(crease, (0.01, 0.01))
    edit_again(tool)
    change_mode(tool, "OBJECT")
    assert len(crease.data.splines) == 1


def test_a_crease_that_is_deleted_is_finished_too(tool, sheet):
    crease = draw()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(crease)
    time_goes_by(tool)
    bpy.context.view_layer.objects.active = sheet
    change_mode(tool, "EDIT")
    assert present() == MINE


def test_where_nothing_was_drawn_nothing_is_done(tool, sheet):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.update()
    assert not bpy.app.timers.is_registered(tool.take_turns)
    assert present() == MINE
