"""Adjust Last Operation: the box in the corner of a view belongs to what was done last, and takes nothing back."""

import bpy
import numpy as np
import pytest
from mathutils import Vector

DOWN = Vector((0, 0, -1))


@pytest.fixture(autouse=True)
def _forget_timers(extension):
    yield
    come_forward = extension("curvefold_addon.later_work").come_forward
    if bpy.app.timers.is_registered(come_forward):
        bpy.app.timers.unregister(come_forward)


@pytest.fixture
def placing(extension):
    return extension("curvefold_addon.operators.place_handle")


@pytest.fixture
def made(sheet):
    """A paper, made as a button does it: an operator that can be adjusted."""
    bpy.ops.ed.undo_push(message="drawn")
    assert bpy.ops.curvefold.make_paper("EXEC_DEFAULT", True, resolution=12) == {"FINISHED"}
    return bpy.context.active_object


def last():
    """The operator to which the box belongs: as Blender finds it."""
    listed = bpy.context.window_manager.operators
    return next(op for op in reversed(listed) if op.bl_options >= {"REGISTER", "UNDO"})


def adjust(**values):
    """As the box does it: other values, back to before the operator, and the operator once more."""
    for name, value in values.items():
        setattr(last().properties, name, value)
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    with bpy.context.temp_override(window=window, area=area, region=area.regions[-1]):
        return bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)


def the_paper():
    (paper,) = (o for o in bpy.context.scene.objects if o.type == "MESH" and o.data.curvefold.is_paper)
    return paper


def fold(paper, amount):
    """As a script does it: Blender's list of operators does not notice, and the undo step has a name of its own."""
    paper.data.curvefold.fold = amount
    bpy.ops.ed.undo_push(message="Fold")


def comes_forward(extension):
    """What happens a moment after an operator has refused; without a window no timer comes."""
    come_forward = extension("curvefold_addon.later_work").come_forward
    assert bpy.app.timers.is_registered(come_forward)
    come_forward()


def test_a_new_paper_can_be_adjusted(made):
    before = len(made.data.vertices)
    assert last().bl_idname == "CURVEFOLD_OT_make_paper"
    assert adjust(resolution=20, fold=30.0) == {"FINISHED"}
    assert len(the_paper().data.vertices) > before
    assert the_paper().data.curvefold.fold == 30.0
    assert adjust(resolution=12, fold=0.0) == {"FINISHED"}, "and again"
    assert len(the_paper().data.vertices) == before


def test_a_click_is_what_was_done_last(placing, made):
    fold(made, 40.0)
    for x in (-0.03, 0.03):
        placing.place_along(bpy.context, the_paper(), placing.MouseRay(Vector((x, 0.03, 1)), DOWN))
    assert last().bl_idname == "CURVEFOLD_OT_add_handle"
    assert adjust(at=(0.01, 0.02)) == {"FINISHED"}
    settings = the_paper().data.curvefold
    assert settings.fold == pytest.approx(40.0)
    assert [handle.name for handle in settings.handles] == ["Handle 1", "Handle 2"]
    assert settings.handles[0].at[0] == pytest.approx(-0.03, abs=2e-3)
    assert settings.handles[1].at[:] == pytest.approx((0.01, 0.02))
    assert {handle.hook.name for handle in settings.handles} == {"Handle 1", "Handle 2"}


def test_a_point_off_the_sheet_leaves_the_handle_where_it_was(placing, made):
    placing.place_along(bpy.context, made, placing.MouseRay(Vector((0.03, 0.03, 1)), DOWN))
    assert adjust(at=(5.0, 5.0)) == {"CANCELLED"}
    (handle,) = the_paper().data.curvefold.handles
    assert handle.at[:] == pytest.approx((0.03, 0.03), abs=1e-6)


def test_what_a_script_has_done_since_is_not_taken_back(extension, made):
    fold(made, 40.0)
    bpy.data.objects.new("Mine", None)
    bpy.ops.ed.undo_push(message="More")
    before = len(made.data.vertices)
    assert adjust(resolution=20) == {"CANCELLED"}
    comes_forward(extension)
    assert the_paper().data.curvefold.fold == pytest.approx(40.0)
    assert len(the_paper().data.vertices) == before
    assert "Mine" in bpy.data.objects


def add_sheet(sheet):
    bpy.ops.curvefold.add_sheet("EXEC_DEFAULT", True)
    return {"size": "A5"}


def add_sample(sheet):
    bpy.ops.curvefold.add_sample("EXEC_DEFAULT", True, sample="one_arc")
    return {}


def import_drawing(sheet, path):
    bpy.ops.curvefold.import_drawing("EXEC_DEFAULT", True, filepath=str(path))
    return {"scale": 2.0}


def fold_drawing(sheet, path):
    bpy.ops.curvefold.fold_drawing("EXEC_DEFAULT", True, filepath=str(path), resolution=12)
    return {"resolution": 14}


def make_paper(sheet):
    bpy.ops.curvefold.make_paper("EXEC_DEFAULT", True, resolution=12)
    return {"resolution": 14}


def draw_crease(sheet):
    bpy.ops.curvefold.draw_crease("EXEC_DEFAULT", True)
    return {"assignment": "M"}


def edit_drawing(sheet):
    bpy.ops.curvefold.edit_drawing("EXEC_DEFAULT", True)
    return {}


def set_assignment(sheet):
    bpy.context.view_layer.objects.active = sheet.children[0]
    sheet.children[0].select_set(True)
    bpy.ops.ed.undo_push(message="selected")
    bpy.ops.curvefold.set_assignment("EXEC_DEFAULT", True, assignment="V")
    return {"assignment": "M"}


def check_paper(sheet):
    bpy.ops.curvefold.make_paper(resolution=12)
    bpy.ops.ed.undo_push(message="paper")
    bpy.ops.curvefold.check_paper("EXEC_DEFAULT", True)
    return {}


def add_handle(sheet):
    bpy.ops.curvefold.make_paper(resolution=12)
    bpy.ops.ed.undo_push(message="paper")
    bpy.ops.curvefold.add_handle("EXEC_DEFAULT", True, at=(0.01, 0.01))
    return {"at": (0.02, 0.02)}


#: Those with an ``execute`` of their own; all others have that of ``OnPaper``, as adding a handle has.
DONE = (
    add_sheet,
    add_sample,
    import_drawing,
    fold_drawing,
    make_paper,
    draw_crease,
    edit_drawing,
    set_assignment,
    check_paper,
    add_handle,
)


def make_crease(sheet):
    curve = bpy.data.curves.new("Mine", "CURVE")
    curve.splines.new("POLY").points.add(1)
    item = bpy.data.objects.new("Mine", curve)
    bpy.context.collection.objects.link(item)
    item.select_set(True)
    bpy.ops.ed.undo_push(message="curve")
    bpy.ops.curvefold.make_crease("EXEC_DEFAULT", True)


def sheet_from_object(sheet):
    bpy.ops.mesh.primitive_plane_add()
    bpy.ops.ed.undo_push(message="plane")
    bpy.ops.curvefold.sheet_from_object("EXEC_DEFAULT", True)


def make_ordinary_mesh(sheet):
    bpy.ops.curvefold.make_paper(resolution=12)
    bpy.ops.ed.undo_push(message="paper")
    bpy.ops.curvefold.make_ordinary_mesh("EXEC_DEFAULT", True)


def remove_picture(sheet):
    bpy.ops.curvefold.make_paper(resolution=12)
    bpy.ops.curvefold.set_up_picture()
    bpy.ops.ed.undo_push(message="picture")
    bpy.ops.curvefold.remove_picture("EXEC_DEFAULT", True)


#: Those that cannot be called where they have been called just now, so that Blender does not adjust them.
DONE_ONCE = (make_crease, sheet_from_object, make_ordinary_mesh, remove_picture)


@pytest.mark.parametrize("do", DONE_ONCE)
def test_some_are_never_adjusted(extension, sheet, do):
    sheet.select_set(True)
    do(sheet)
    assert last().bl_idname == f"CURVEFOLD_OT_{do.__name__}"
    bpy.context.active_object.location.z = 3.0
    bpy.ops.ed.undo_push(message="later")
    there = sorted(bpy.data.objects.keys())
    assert adjust() == {"CANCELLED"}
    assert sorted(bpy.data.objects.keys()) == there
    assert bpy.context.active_object.location.z == 3.0
    assert not bpy.app.timers.is_registered(extension("curvefold_addon.later_work").come_forward)


@pytest.mark.parametrize("do", DONE)
@pytest.mark.parametrize("later", ["moved", "told"])
def test_no_operator_takes_back_what_was_done_after_it(extension, sheet, drawing, do, later):
    name, crease = sheet.name, sheet.children[0].name
    sheet.select_set(True)
    bpy.ops.ed.undo_push(message="drawn")
    values = do(sheet, drawing) if do in (import_drawing, fold_drawing) else do(sheet)
    assert last().bl_idname == f"CURVEFOLD_OT_{do.__name__}"
    if later == "moved":
        bpy.data.objects[name].location.z = 3.0
    else:
        bpy.data.objects[crease].curvefold.assignment = "F"
    bpy.ops.ed.undo_push(message="later")
    there = sorted(bpy.data.objects.keys())
    assert adjust(**values) == {"CANCELLED"}
    comes_forward(extension)
    assert sorted(bpy.data.objects.keys()) == there
    if later == "moved":
        assert bpy.data.objects[name].location.z == 3.0
    else:
        assert bpy.data.objects[crease].curvefold.assignment == "F"


@pytest.mark.parametrize("do", DONE)
def test_every_operator_can_be_adjusted_as_long_as_nothing_else_was_done(sheet, drawing, do):
    sheet.select_set(True)
    bpy.ops.ed.undo_push(message="drawn")
    values = do(sheet, drawing) if do in (import_drawing, fold_drawing) else do(sheet)
    there = sorted(bpy.data.objects.keys())
    assert adjust(**values) == {"FINISHED"}
    if do is not add_sheet:  # whose name says its size
        assert sorted(bpy.data.objects.keys()) == there


def test_all_operators_with_an_undo_step_keep_later_work(extension):
    """Who adds one with an ``execute`` of its own has to think of it."""
    operators = extension("curvefold_addon.operators")
    on_paper = extension("curvefold_addon.operators.on_paper").OnPaper
    clicking = extension("curvefold_addon.operators.click_on_crease").ClickOnCrease
    names = {do.__name__ for do in (*DONE, *DONE_ONCE)}
    found = set()
    for module in operators._MODULES:
        for cls in vars(module).values():
            if not (isinstance(cls, type) and issubclass(cls, bpy.types.Operator)):
                continue
            if "UNDO" in cls.bl_options:
                name = cls.bl_idname.partition(".")[2]
                found.add(name)
                assert "REGISTER" in cls.bl_options, name
                assert name in names or cls.execute in (on_paper.execute, clicking.execute), name
    assert names <= found


def test_how_a_paper_bends_is_nothing_that_was_done(made, live):
    bpy.ops.ed.undo_push(message="paper")
    bpy.ops.curvefold.add_handle("EXEC_DEFAULT", True, at=(0.01, 0.01))
    paper = the_paper()
    live.session(paper.data).positions[:, 2] += 1e-3  # as ticks of a fold that goes on do it
    live.session(paper.data).write(paper.data)
    assert adjust(at=(0.02, 0.02)) == {"FINISHED"}
    assert np.isfinite([v.co for v in the_paper().data.vertices]).all()
