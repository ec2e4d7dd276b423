"""Papers, sheets and creases that are linked from another .blend, or overridden: nothing is done that gets lost."""

import bpy
import numpy as np
import pytest

LIBRARY = "library.blend"
SENTENCE = "is linked from library.blend; make it local to change it"

#: Operators that change the active paper.
ON_PAPERS = {
    "add_angles",
    "add_handle",
    "add_handles",
    "bake",
    "flatten",
    "flip_crease",
    "fold_anew",
    "free_bake",
    "free_sides",
    "glue_borders",
    "hook_object",
    "join_points",
    "keep_patch",
    "lock_sides",
    "make_ordinary_mesh",
    "pick_crease",
    "pin",
    "place_angle",
    "place_handle",
    "remove_angle",
    "remove_handle",
    "remove_joint",
    "restore_paper",
    "rulings_as_attribute",
    "settle",
    "usual_weights",
}
#: Operators that change the active sheet, or selected creases.
ON_DRAWINGS = {"draw_crease", "edit_drawing", "make_crease", "set_assignment"}
#: Operators that only look, make something new, or leave the work to one of the others.
NEUTRAL = {
    "add_sample",
    "add_sheet",
    "animate_picture",
    "back_to_paper",
    "check_paper",
    "export_plan",
    "fold_drawing",
    "follow",
    "gauss_image_as_object",
    "import_drawing",
    "make_paper",
    "remove_picture",
    "rulings_as_object",
    "set_up_picture",
    "sheet_from_object",
    "stroke_crease",
    "take_handle",
}


@pytest.fixture
def library(paper, live, tmp_path):
    """A file with a folded paper that is pinned, animated and hooked to an empty, its sheet, and a loose curve."""
    settings = paper.data.curvefold
    settings.fold = 50.0
    live.settle(paper.data)
    empty = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(empty)
    empty.parent, empty.location = paper, (0.0, 0.04, 0.01)
    bpy.context.view_layer.update()
    paper.select_set(True)
    empty.select_set(True)
    bpy.context.view_layer.objects.active = paper
    assert bpy.ops.curvefold.hook_object() == {"FINISHED"}
    empty["curvefold_handle"] = True
    paper.data.keyframe_insert("curvefold.fold", frame=1)
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.02)
    bpy.context.active_object.name = "Loose"
    path = str(tmp_path / LIBRARY)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


def link(library, override=False) -> None:
    """A new file with everything of the library linked, or overridden."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(library, link=True) as (source, target):
        target.objects = source.objects
    for item in list(target.objects):
        if override:
            item = item.override_create(remap_local_usages=True)
        bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.update()


def named(name: str) -> bpy.types.Object:
    return bpy.context.scene.objects[name]


def choose(*names: str) -> None:
    """Selects objects; the first one is active."""
    for item in bpy.context.selected_objects:
        item.select_set(False)
    for name in names:
        named(name).select_set(True)
    bpy.context.view_layer.objects.active = named(names[0])


def told(mesh: bpy.types.Mesh) -> tuple:
    settings = mesh.curvefold
    shown = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", shown)
    return (
        bytes(mesh["curvefold_positions"]),
        shown.tobytes(),
        settings.is_paper,
        settings.fold,
        settings.use_assignments,
        [crease.side for crease in settings.creases],
        [(handle.name, handle.hook.name) for handle in settings.handles],
        mesh.shape_keys,
    )


def drawn() -> list:
    creases = [item for item in bpy.data.objects if item.curvefold.role != "NONE"]
    return sorted(
        (item.name, item.curvefold.role, item.curvefold.assignment, item.parent and item.parent.name)
        for item in creases
    )


def crease_name() -> str:
    return next(item.name for item in bpy.context.scene.objects if item.curvefold.role == "CREASE")


def sheet_name() -> str:
    return next(item.name for item in bpy.context.scene.objects if item.curvefold.role == "SHEET")


def tick_until_rest(live) -> None:
    assert any(not live.tick(0.05) for _ in range(1000)), "it never rests"


@pytest.fixture(params=[False, True], ids=["linked", "overridden"])
def opened(request, library):
    link(library, request.param)
    return request.param


def test_every_operator_has_been_thought_of():
    assert set(dir(bpy.ops.curvefold)) == ON_PAPERS | ON_DRAWINGS | NEUTRAL


@pytest.mark.parametrize("operator", sorted(ON_PAPERS))
def test_operators_on_a_linked_paper_say_so(opened, operator):
    choose("Paper", "Hook")
    before = told(named("Paper").data)
    run = getattr(bpy.ops.curvefold, operator)
    if operator == "restore_paper":
        named("Paper").data.vertices[0].co.z += 0.01
        before = told(named("Paper").data)
    assert not run.poll()
    with pytest.raises(RuntimeError, match=f"Paper {SENTENCE}"):
        run()
    assert told(named("Paper").data) == before


@pytest.mark.parametrize("operator", sorted(ON_DRAWINGS | {"sheet_from_object"}))
def test_operators_on_a_linked_drawing_say_so(opened, operator):
    chosen = {
        "draw_crease": (sheet_name(),),
        "edit_drawing": (sheet_name(),),
        "make_crease": (sheet_name(), "Loose"),
        "set_assignment": (crease_name(),),
        "sheet_from_object": ("Loose",),
    }[operator]
    choose(*chosen)
    before = drawn()
    with pytest.raises(RuntimeError, match=SENTENCE):
        getattr(bpy.ops.curvefold, operator)()
    assert drawn() == before


def test_a_linked_curve_becomes_no_crease_of_a_sheet_that_is_not(opened):
    bpy.ops.curvefold.add_sheet(size="A6")
    choose("A6 Sheet", "Loose")
    with pytest.raises(RuntimeError, match=f"Loose {SENTENCE}"):
        bpy.ops.curvefold.make_crease()
    assert named("Loose").curvefold.role == "NONE"


def test_some_of_several_creases_are_linked(opened):
    bpy.ops.curvefold.add_sheet(size="A6")
    bpy.ops.curvefold.draw_crease()
    local = bpy.context.active_object.name
    choose(local, crease_name())
    before = [item for item in drawn() if item[0] != local]
    assert bpy.ops.curvefold.set_assignment(assignment="M") == {"FINISHED"}
    assert named(local).curvefold.assignment == "M"
    assert [item for item in drawn() if item[0] != local] == before


def test_it_is_opened_ticked_played_and_saved_without_a_word(opened, live, tmp_path, capfd, extension):
    path = str(tmp_path / "user.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    mesh = named("Paper").data
    before, values = told(mesh), drawn()
    tick_until_rest(live)
    for frame in (1, 2, 3, 1):
        bpy.context.scene.frame_set(frame)
    mesh.curvefold.fold = 20.0
    named("Hook").location.z += 0.01
    live.rebuild(mesh)
    bpy.context.view_layer.update()
    tick_until_rest(live)
    mesh.curvefold.fold = 50.0
    assert (told(mesh), drawn()) == (before, values)
    report = live.report(mesh)
    assert (report.state, report.sentence) == ("trouble", f"Paper {SENTENCE}")
    state = extension("curvefold_addon.bridge.state")
    with pytest.raises(state.StateError, match=SENTENCE):
        live.settle(mesh)
    assert "Traceback" not in capfd.readouterr().err
    assert not extension("curvefold_addon.handlers")._said
    assert not live._broken


def test_looking_at_a_linked_paper_works_and_changes_nothing(opened, live, tmp_path):
    choose("Paper")
    before = told(named("Paper").data)
    assert bpy.ops.curvefold.check_paper() == {"FINISHED"}
    choose("Paper")
    assert bpy.ops.curvefold.rulings_as_object() == {"FINISHED"}
    choose("Paper")
    assert bpy.ops.curvefold.gauss_image_as_object() == {"FINISHED"}
    assert told(named("Paper").data) == before


def local(name: str) -> bpy.types.Object:
    """What is linked may have the same name."""
    return next(item for item in bpy.context.scene.objects if item.name == name and item.library is None)


def test_what_was_made_of_linked_things_is_there_after_reopening(library, live, tmp_path):
    """A paper of a linked sheet is this file's own, whatever its hook is."""
    link(library)
    choose(sheet_name())
    assert bpy.ops.curvefold.make_paper(resolution=8, fold=40.0) == {"FINISHED"}
    made = bpy.context.active_object
    name = made.name
    assert name == "Paper", "as the linked one"
    live.settle(made.data)
    named("Loose").select_set(True)
    assert bpy.ops.curvefold.hook_object() == {"FINISHED"}
    named("Loose")["curvefold_handle"] = True
    before, hook = told(made.data), named("Loose").location.copy()
    path = str(tmp_path / "user.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    made = local(name)
    assert told(made.data) == before
    assert live.paper_of(made.data) == made
    made.data.curvefold.fold = 60.0
    tick_until_rest(live)
    assert told(made.data)[0] != before[0], "it follows"
    bpy.context.view_layer.objects.active = made
    assert bpy.ops.curvefold.flatten() == {"FINISHED"}
    assert named("Loose").location == hook, "which would be there again"
    assert bpy.ops.curvefold.remove_handle() == {"FINISHED"}
    assert "Loose" in bpy.context.scene.objects


def test_new_things_go_where_they_stay(library):
    """Beside what lies in a linked collection, which cannot take them."""
    kit = bpy.data.collections.new("Kit")
    bpy.context.scene.collection.children.link(kit)
    for item in list(bpy.context.scene.objects):
        for collection in item.users_collection:
            collection.objects.unlink(item)
        kit.objects.link(item)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(library, link=True) as (_, target):
        target.collections = ["Kit"]
    bpy.context.scene.collection.children.link(target.collections[0])
    bpy.context.view_layer.update()
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children["Kit"]
    choose("Paper")
    assert bpy.ops.curvefold.rulings_as_object() == {"FINISHED"}
    choose(sheet_name())
    assert bpy.ops.curvefold.make_paper(resolution=8) == {"FINISHED"}
    assert bpy.ops.curvefold.add_sample(sample="one_arc") == {"FINISHED"}
    layer.active_layer_collection = layer.layer_collection.children["Kit"]
    assert bpy.ops.curvefold.add_sheet() == {"FINISHED"}
    made = {item.name for item in bpy.context.scene.collection.objects}
    assert len(made) >= 4, "rulings, a paper, a sheet with a crease"


def test_made_local_it_folds(library, live):
    link(library)
    choose("Paper")
    # Its hook would keep the linked one.
    for item in bpy.context.scene.objects:
        item.select_set(True)
    assert bpy.ops.object.make_local(type="SELECT_OBDATA") == {"FINISHED"}
    mesh = named("Paper").data
    assert mesh.library is None
    before = told(mesh)
    assert bpy.ops.curvefold.settle() == {"FINISHED"}
    mesh.curvefold.fold = 70.0
    bpy.context.scene.frame_set(1)
    assert bpy.ops.curvefold.flatten() == {"FINISHED"}
    assert told(mesh) != before
