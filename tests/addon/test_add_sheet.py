"""Add > Paper Sheet."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

MILLIMETRES = {"A3": (297, 420), "A4": (210, 297), "A5": (148, 210), "A6": (105, 148), "LETTER": (215.9, 279.4)}


def read(extension):
    return extension("curvefold_addon.bridge.drawing").read_drawing(bpy.context.active_object)


def size_mm(pattern):
    return np.ptp(pattern.boundary, axis=0) * pattern.unit_mm


@pytest.mark.parametrize("scale_length", [1.0, 0.001, 0.0254])
@pytest.mark.parametrize("size", MILLIMETRES)
def test_sizes_are_true(extension, size, scale_length):
    bpy.context.scene.unit_settings.scale_length = scale_length
    assert bpy.ops.curvefold.add_sheet(size=size) == {"FINISHED"}
    assert size_mm(read(extension)) == pytest.approx(MILLIMETRES[size])
    bpy.ops.curvefold.add_sheet(size=size, orientation="LANDSCAPE")
    assert size_mm(read(extension)) == pytest.approx(MILLIMETRES[size][::-1])


@pytest.mark.parametrize("scale_length", [1.0, 0.001])
def test_square_and_circle(extension, scale_length):
    bpy.context.scene.unit_settings.scale_length = scale_length
    bpy.ops.curvefold.add_sheet(size="SQUARE")
    assert size_mm(read(extension)) == pytest.approx([200, 200])
    bpy.ops.curvefold.add_sheet(size="CIRCLE", side=3.0)
    pattern = read(extension)
    assert np.hypot(*pattern.boundary.T) == pytest.approx(1.5, rel=1e-3)
    assert len(pattern.boundary) > 100


@pytest.mark.parametrize("scale_length", [1.0, 0.001])
def test_a_size_of_ones_own(extension, scale_length):
    bpy.context.scene.unit_settings.scale_length = scale_length
    bpy.ops.curvefold.add_sheet(size="OWN")
    assert size_mm(read(extension)) == pytest.approx(MILLIMETRES["A4"]), "until somebody says another"
    bpy.ops.curvefold.add_sheet(size="OWN", width=0.5 / scale_length, height=0.07 / scale_length)
    assert size_mm(read(extension)) == pytest.approx([500, 70])
    assert bpy.context.active_object.name.startswith("Own Size Sheet")


def test_only_a_size_of_ones_own_is_asked_for(extension):
    cls = extension("curvefold_addon.operators.add_sheet").AddSheet
    asked = []
    manager = SimpleNamespace(invoke_props_dialog=lambda operator: asked.append(operator.size) or {"RUNNING_MODAL"})
    context = SimpleNamespace(window_manager=manager, scene=bpy.context.scene)
    for size, answer in (("OWN", {"RUNNING_MODAL"}), ("A4", {"FINISHED"})):
        operator = SimpleNamespace(
            size=size,
            properties=SimpleNamespace(is_property_set=lambda name: False),
            execute=lambda context: {"FINISHED"},
        )
        operator._propose = lambda context, operator=operator: cls._propose(operator, context)
        assert cls.invoke(operator, context, None) == answer
        assert (operator.width, operator.height) == pytest.approx((0.21, 0.297))
    assert asked == ["OWN"]


def test_the_sheet_is_at_the_cursor_selected_and_not_rendered():
    bpy.context.scene.cursor.location = (1, 2, 3)
    bpy.ops.curvefold.add_sheet()
    first = bpy.context.active_object
    assert tuple(first.location) == (1, 2, 3)
    assert first.curvefold.role == "SHEET"
    assert first.hide_render
    bpy.ops.curvefold.add_sheet()
    assert bpy.context.selected_objects == [bpy.context.active_object] != [first]


def test_it_can_be_undone():
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.curvefold.add_sheet("EXEC_DEFAULT", True)
    assert len(bpy.data.objects) == 1
    bpy.ops.ed.undo()
    assert not bpy.data.objects


def test_only_in_object_mode():
    bpy.ops.curvefold.add_sheet()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Works in Object Mode"):
        bpy.ops.curvefold.add_sheet()
    bpy.ops.object.mode_set(mode="OBJECT")
