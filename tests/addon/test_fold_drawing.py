"""File > Import > Crease Pattern."""

from math import radians

import bpy
import pytest


def test_adds_the_paper_and_can_be_undone(drawing):
    bpy.ops.ed.undo_push(message="before")
    done = bpy.ops.curvefold.fold_drawing(
        "EXEC_DEFAULT", True, filepath=str(drawing), resolution=12, angle=radians(50)
    )
    assert done == {"FINISHED"}
    paper = bpy.context.view_layer.objects.active
    assert paper.select_get()
    assert paper.data.curvefold.is_paper
    assert paper.data.curvefold.angle == pytest.approx(radians(50))
    assert paper.data.materials[0].name == "Curvefold Paper"
    bpy.ops.ed.undo()
    assert not bpy.data.objects


def test_a_bad_drawing_is_one_sentence(broken_drawing):
    with pytest.raises(RuntimeError, match=r"broken\.svg") as caught:
        bpy.ops.curvefold.fold_drawing(filepath=str(broken_drawing))
    assert "Traceback" not in str(caught.value)
    assert not bpy.data.objects


def test_no_drawing():
    with pytest.raises(RuntimeError, match="No drawing was chosen"):
        bpy.ops.curvefold.fold_drawing()
