"""The sidebar: what it says and offers to whom. Panels draw into a layout that only takes notes."""

from dataclasses import fields
from types import SimpleNamespace

import bpy
import pytest


class Told:
    """The properties of a button that adds a sample."""

    def __init__(self, samples):
        object.__setattr__(self, "samples", samples)

    def __setattr__(self, name, value):
        assert name == "sample"
        self.samples.append(value)


class Notes:
    """Stands in for UILayout: checks that what is asked for exists, and writes it down."""

    def __init__(self, notes=None, enabled=True, split=False):
        kinds = ("texts", "operators", "properties", "menus", "grey", "pictures", "samples")
        self.notes = {kind: [] for kind in kinds} | {"lines": 0} if notes is None else notes
        self.enabled = enabled
        self.use_property_split = split

    def _part(self, **options):
        return Notes(self.notes, self.enabled, self.use_property_split)

    column = row = box = split = _part

    def label(self, text="", icon="NONE", text_ctxt="*"):
        assert icon in ICONS
        self.notes["lines"] += 1
        if text:
            self.notes["texts"].append(text)

    def template_icon(self, icon_value, scale=1.0):
        self.notes["pictures"].append(icon_value)

    def separator(self):
        pass

    def prop(self, data, name, text=None, icon="NONE", **options):
        assert name in data.bl_rna.properties, name
        assert icon in ICONS
        self.notes["properties"].append(name)
        label = data.bl_rna.properties[name].name if text is None else text
        if self.use_property_split and data.bl_rna.properties[name].type != "BOOLEAN":
            assert len(label) <= BESIDE, f"{label} is cut"
        if not self.enabled:
            self.notes["grey"].append(name)

    def progress(self, factor=0.0, text=""):
        assert 0.0 <= factor <= 1.0
        self.notes["texts"].append(text)

    def operator(self, idname, text="", icon="NONE", depress=False, text_ctxt="*"):
        assert icon in ICONS
        group, _, name = idname.partition(".")
        assert name in dir(getattr(bpy.ops, group)), idname
        self.notes["operators"].append(idname)
        told = SimpleNamespace()
        if idname == "curvefold.add_sample":
            told = Told(self.notes["samples"])
        if not self.enabled:
            self.notes["grey"].append(idname)
        return told

    def operator_menu_enum(self, idname, name, text="", icon="NONE"):
        self.operator(idname, text, icon)

    def menu(self, idname, text="", icon="NONE"):
        assert hasattr(bpy.types, idname)
        self.notes["menus"].append(idname)

    def template_list(self, kind, name, data, collection, active_data, active, rows=5):
        assert hasattr(bpy.types, kind)
        assert collection in data.bl_rna.properties
        assert active in active_data.bl_rna.properties
        self.notes["properties"].append(collection)


#: Letters of a name that stands beside its field, in a sidebar of Blender's usual width.
BESIDE = 14
ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())


@pytest.fixture
def panels(extension):
    return extension("curvefold_addon.panels")


@pytest.fixture
def wording(extension):
    return extension("curvefold_addon.wording")


def context():
    real = bpy.context
    return SimpleNamespace(
        active_object=real.active_object,
        selected_objects=real.selected_objects,
        scene=real.scene,
        mode=real.mode,
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
        region=SimpleNamespace(width=260),
    )


def drawn(panel):
    layout = Notes()
    panel.draw(SimpleNamespace(layout=layout), context())
    return layout.notes


def said(notes):
    return " ".join(notes["texts"])


def shown(panels):
    return {
        cls.__name__
        for cls in panels._CLASSES
        if issubclass(cls, bpy.types.Panel) and ("poll" not in dir(cls) or cls.poll(context()))
    }


@pytest.fixture
def paper():
    bpy.ops.curvefold.add_sample(sample="one_arc")
    bpy.ops.curvefold.make_paper(resolution=12, fold=60.0)
    return bpy.context.active_object


def test_a_newcomer_is_offered_a_sheet_a_sample_and_a_drawing(panels, extension):
    notes = drawn(panels.MainPanel)
    assert notes["operators"][:2] == ["curvefold.add_sheet", "curvefold.import_drawing"]
    names = extension("curvefold_addon.samples").names()
    assert notes["operators"].count("curvefold.add_sample") == len(notes["pictures"]) == len(names)
    assert notes["samples"] == names
    assert shown(panels) == {"MainPanel"}


def test_a_closed_curve_can_become_a_sheet(panels):
    bpy.ops.curve.primitive_bezier_circle_add()
    assert "curvefold.sheet_from_object" in drawn(panels.MainPanel)["operators"]


def test_a_sheet_is_offered_creases_and_then_paper(panels, wording):
    bpy.ops.curvefold.add_sheet()
    notes = drawn(panels.MainPanel)
    assert {"curvefold.draw_crease", "curvefold.make_paper"} <= set(notes["operators"])
    assert notes["grey"] == [], "a sheet without creases is paper too"
    assert said(notes) == f"A4 Sheet: No creases Selected creases fold to {wording.NO_CREASE}", "nothing is wrong"
    bpy.ops.curvefold.draw_crease()
    bpy.ops.object.mode_set(mode="EDIT")
    texts = drawn(panels.MainPanel)["texts"]
    assert texts[:2] == ["A4 Sheet: 1 crease", "Selected creases fold to"], "nor with a crease being drawn"
    assert " ".join(texts[2:]) == wording.DRAWING
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    assert "Crease: it is empty" in said(drawn(panels.MainPanel))
    bpy.ops.curvefold.add_sample(sample="one_arc")
    notes = drawn(panels.MainPanel)
    assert "1 crease" in notes["texts"][0]
    assert notes["grey"] == []
    assert shown(panels) == {"MainPanel", "NotesPanel", "OverlaysPanel"}


def test_troubles_of_the_drawing_are_named(panels):
    bpy.ops.curvefold.add_sample(sample="one_arc")
    crease = bpy.context.active_object.children[0]
    crease.location.x += 100.0
    bpy.context.view_layer.update()
    assert crease.name in " ".join(drawn(panels.MainPanel)["texts"])


def test_a_selected_crease_can_be_assigned(panels):
    bpy.ops.curvefold.add_sample(sample="one_arc")
    crease = bpy.context.active_object.children[0]
    bpy.ops.object.select_all(action="DESELECT")
    crease.select_set(True)
    bpy.context.view_layer.objects.active = crease
    assert drawn(panels.MainPanel)["operators"].count("curvefold.set_assignment") == 4


def test_a_paper_says_how_it_stands_and_has_its_slider(panels, extension, paper):
    notes = drawn(panels.MainPanel)
    report = extension("curvefold_addon.live").report(paper.data)
    said = " ".join(notes["texts"])
    assert report.sentence in said
    assert f"Stretch {report.stretch_mean:.2%} mean" in said
    assert notes["properties"] == ["fold", "live", "show"]
    assert shown(panels) == {cls.__name__ for cls in panels._CLASSES if issubclass(cls, bpy.types.Panel)}


def activate(item):
    bpy.ops.object.select_all(action="DESELECT")
    item.select_set(True)
    bpy.context.view_layer.objects.active = item


@pytest.mark.parametrize("part", ["sheet", "crease", "new crease", "crease being edited"])
def test_at_a_drawing_the_paper_that_follows_it_is_shown_and_one_button_leads_back(panels, extension, paper, part):
    sheet = paper.data.curvefold.sheet
    if part == "new crease":
        activate(sheet)
        bpy.ops.curvefold.draw_crease()
    else:
        activate(sheet if part == "sheet" else sheet.children[0])
    if part == "crease being edited":
        bpy.ops.object.mode_set(mode="EDIT")
    notes = drawn(panels.MainPanel)
    assert extension("curvefold_addon.live").report(paper.data).sentence in said(notes)
    assert notes["properties"] == ["show", "fold", "live"]
    assert {"curvefold.draw_crease", "curvefold.back_to_paper", "curvefold.make_paper"} <= set(notes["operators"])
    assert {"HandlesPanel", "CreasesPanel", "AdvancedPanel"} <= shown(panels)
    assert "curvefold.draw_crease" not in drawn(panels.DrawingPanel)["operators"], "once is enough"
    assert bpy.ops.curvefold.back_to_paper() == {"FINISHED"}
    assert bpy.context.mode == "OBJECT"
    assert bpy.context.selected_objects == [bpy.context.active_object] == [paper]
    assert "curvefold.make_paper" not in drawn(panels.MainPanel)["operators"]


def test_a_trouble_of_the_paper_is_said_at_its_drawing(panels, extension, paper, cross_border):
    sheet = paper.data.curvefold.sheet
    cross_border(sheet)
    live = extension("curvefold_addon.live")
    live.rebuild(paper.data)
    while live.tick(0.02):
        pass
    activate(sheet.children[0])
    report = live.report(paper.data)
    assert report.state == "trouble"
    assert report.sentence in said(drawn(panels.MainPanel))


def test_of_several_papers_of_a_drawing_the_first_by_name_is_shown(panels, paper):
    sheet = paper.data.curvefold.sheet
    activate(sheet)
    bpy.ops.curvefold.make_paper(resolution=12)
    other = bpy.context.active_object
    assert other != paper
    activate(sheet)
    assert "Paper, one of 2 papers of this drawing" in said(drawn(panels.MainPanel))
    bpy.ops.curvefold.back_to_paper()
    assert bpy.context.active_object == paper
    bpy.data.objects.remove(paper)
    activate(sheet)
    bpy.ops.curvefold.back_to_paper()
    assert bpy.context.active_object == other


def test_a_drawing_that_no_paper_follows_is_offered_paper(panels, paper):
    bpy.ops.curvefold.add_sheet()
    assert "curvefold.make_paper" in drawn(panels.MainPanel)["operators"]
    assert drawn(panels.MainPanel)["properties"] == ["show"]
    assert not bpy.ops.curvefold.back_to_paper.poll()
    sheet = paper.data.curvefold.sheet
    bpy.data.objects.remove(paper)
    activate(sheet)
    assert drawn(panels.MainPanel)["operators"][-1] == "curvefold.make_paper"
    assert not bpy.ops.curvefold.back_to_paper.poll()


def test_beside_a_drawing_that_a_paper_follows_the_way_back_is_offered_too(panels, paper):
    bpy.ops.object.camera_add()
    notes = drawn(panels.MainPanel)
    assert {"curvefold.back_to_paper", "curvefold.make_paper"} <= set(notes["operators"])
    assert shown(panels) == {"MainPanel", "NotesPanel", "OverlaysPanel"}, "a camera is no part of it"
    assert bpy.ops.curvefold.back_to_paper() == {"FINISHED"}
    assert bpy.context.active_object == paper


def test_there_is_no_way_back_to_a_hidden_paper(paper):
    activate(paper.data.curvefold.sheet.children[0])
    bpy.ops.object.mode_set(mode="EDIT")
    paper.hide_set(True)
    with pytest.raises(RuntimeError, match="Paper is hidden: show it"):
        bpy.ops.curvefold.back_to_paper()
    assert bpy.context.mode == "EDIT_CURVE"


def test_a_paper_whose_session_is_gone_is_drawn_too(panels, extension, wording, paper):
    live = extension("curvefold_addon.live")
    live.forget()
    said = " ".join(drawn(panels.MainPanel)["texts"])
    assert wording.ASLEEP in said
    for panel in (panels.CreasesPanel, panels.AdvancedPanel, panels.HandlesPanel):
        drawn(panel)
    assert live.session(paper.data) is None, "drawing a panel must not start work"


def test_a_new_paper_says_what_to_do_with_it(panels, wording, paper):
    def said():
        return " ".join(drawn(panels.MainPanel)["texts"])

    settings = paper.data.curvefold
    assert wording.NEXT not in said()
    settings.fold = 0.0
    assert wording.NEXT in said()
    settings.handles.add()
    assert wording.NEXT not in said()


def test_blank_paper_is_not_told_to_slide_what_folds_creases(panels, wording):
    bpy.ops.curvefold.add_sheet()
    bpy.ops.curvefold.make_paper(resolution=8)
    said = " ".join(drawn(panels.MainPanel)["texts"])
    assert wording.NEXT_BLANK in said
    assert wording.NEXT not in said


def test_a_paper_that_does_not_follow_says_so(panels, wording, paper):
    paper.data.curvefold.live = False
    assert wording.NOT_LIVE in " ".join(drawn(panels.MainPanel)["texts"])


def test_creases_are_listed_with_side_and_angle(panels, paper):
    notes = drawn(panels.CreasesPanel)
    assert {"creases", "side", "amount", "use_angle", "angle", "signed", "use_assignments"} == set(
        notes["properties"]
    )
    settings = paper.data.curvefold
    layout = Notes()
    settings.creases[0].side = "V"
    panels.CreaseList.draw_item(
        None, context(), layout, settings, settings.creases[0], 0, settings, "active_crease", 0
    )
    texts = layout.notes["texts"]
    assert layout.notes["lines"] == 3, "the third is a lock"
    assert texts[0] == "Crease 1"
    assert 40 < float(texts[1].rstrip("°")) < 60
    below = notes["texts"][-1].split()
    assert below[:3] in (["Crease", "1:", "Valley"], ["Crease", "1:", "Mountain"])
    assert below[3] == texts[1], "the same number in words below"


def test_a_handle_is_listed_with_all_that_can_be_set(panels, paper):
    assert drawn(panels.HandlesPanel)["properties"] == []
    settings = paper.data.curvefold
    settings.handles.add().name = "Corner"
    notes = drawn(panels.HandlesPanel)
    assert notes["properties"] == ["handles", "least_fold", "hook", "axes", "axes", "axes", "strength"]
    assert {"curvefold.remove_handle", "curvefold.pin", "curvefold.place_handle"} <= set(notes["operators"])
    layout = Notes()
    panels.HandleList.draw_item(
        None, context(), layout, settings, settings.handles[0], 0, settings, "chosen_handle"
    )
    assert layout.notes["properties"] == ["enabled", "name"]
    settings.active_handle = 5
    assert drawn(panels.HandlesPanel)["properties"] == ["handles", "least_fold"]


def test_every_overlay_can_be_switched(panels, paper):
    names = set(bpy.context.scene.curvefold.bl_rna.properties.keys()) - {"rna_type", "name", "show"}
    assert set(drawn(panels.OverlaysPanel)["properties"]) == names
    layout = Notes()
    panels.OverlaysPanel.draw_header(SimpleNamespace(layout=layout), context())
    assert layout.notes["properties"] == ["show"]


def test_rulings_and_gauss_image_are_offered_as_objects_or_it_says_why_there_are_none(
    panels, extension, wording, paper
):
    settings = bpy.context.scene.curvefold
    names = ("rulings_as_object", "gauss_image_as_object", "rulings_as_attribute")
    offered = [f"curvefold.{name}" for name in names]
    assert drawn(panels.OverlaysPanel)["operators"] == offered
    settings.gauss_image = True
    assert said(drawn(panels.OverlaysPanel)) == ""
    extension("curvefold_addon.live").forget()
    assert said(drawn(panels.OverlaysPanel)) == wording.NO_RULINGS_ASLEEP
    bpy.context.scene.frame_end = 2
    bpy.ops.curvefold.bake()
    assert said(drawn(panels.OverlaysPanel)) == wording.NO_RULINGS_BAKED
    settings.gauss_image = False
    settings.rulings = True
    assert said(drawn(panels.OverlaysPanel)) == wording.NO_RULINGS_BAKED
    settings.rulings = False
    assert said(drawn(panels.OverlaysPanel)) == ""
    bpy.context.view_layer.objects.active = paper.data.curvefold.sheet
    assert drawn(panels.OverlaysPanel)["operators"] == offered, "those of the paper that follows the sheet"
    bpy.ops.curvefold.add_sheet()
    assert drawn(panels.OverlaysPanel)["operators"] == []


def test_a_bake_can_be_made_and_freed(panels, wording, paper):
    assert drawn(panels.AnimationPanel)["operators"] == ["curvefold.bake"]
    bpy.context.scene.frame_end = 2
    bpy.ops.curvefold.bake()
    assert drawn(panels.AnimationPanel)["operators"] == ["curvefold.free_bake"]
    assert wording.BAKED in " ".join(drawn(panels.MainPanel)["texts"])
    bpy.ops.curvefold.free_bake()
    paper.shape_key_add(name="Mine")
    assert wording.KEYED in " ".join(drawn(panels.MainPanel)["texts"])


def test_drawing_and_advanced_panels_draw(panels, paper):
    assert "sheet" in drawn(panels.DrawingPanel)["properties"]
    assert "curvefold.export_plan" in drawn(panels.DrawingPanel)["operators"]
    assert {"angle", "resolution"} <= set(drawn(panels.AdvancedPanel)["properties"])


def test_what_an_automatic_resolution_is_stands_below_it(panels, extension, paper):
    live = extension("curvefold_addon.live")
    assert "Automatic" not in said(drawn(panels.AdvancedPanel))
    paper.data.curvefold.resolution = 0
    live.settle(paper.data)
    number = live.session(paper.data).source.resolution
    assert f"Automatic: {number}" in drawn(panels.AdvancedPanel)["texts"]
    live.forget()
    assert "Automatic" not in said(drawn(panels.AdvancedPanel)), "not known while it sleeps"


@pytest.mark.parametrize(
    ("found", "angle", "folded", "text"),
    [
        ("V", 61.7, True, "Valley 62°"),
        ("M", 12.2, False, "Mountain 12°, with gaps"),
        ("M", None, True, "Mountain"),
        ("U", 3.0, False, "Not folded"),
        ("U", 0.01, True, "Not folded"),
        ("U", 60.0, True, "Changes sides 60°"),
    ],
)
def test_what_is_said_of_a_crease(wording, extension, found, angle, folded, text):
    report = extension("curvefold_addon.live").CreaseReport("crease 3 (Wing)", found, angle, folded)
    assert wording.crease(report) == text
    assert wording.crease_name(report) == "Wing"


def test_what_is_said_fits_the_sidebar(wording):
    sentence = "Handle 2 is 3 mm from its target: out of reach"
    assert wording.lines(sentence, 1000.0) == [sentence]
    narrow = wording.lines(sentence, 180.0)
    assert " ".join(narrow) == sentence
    assert max(map(len, narrow)) <= 22
    assert wording.count(0, "crease") == "No creases"
    assert wording.count(1, "crease") == "1 crease"


def test_joints_and_flows_show_what_can_be_set_of_them(panels, paper):
    assert drawn(panels.JointsPanel)["properties"] == []
    settings = paper.data.curvefold
    joint = settings.joints.add()
    expected = {
        "POINTS": ["relation", "strength"],
        "BORDERS": ["bending", "reverse", "strength"],
        "PATCH": ["shape", "strength"],
    }
    for family, names in expected.items():
        joint.family = family
        assert drawn(panels.JointsPanel)["properties"] == ["joints", *names]
    joint.family, joint.relation = "POINTS", "DISTANCE"
    assert "distance" in drawn(panels.JointsPanel)["properties"]
    layout = Notes()
    panels.JointList.draw_item(None, context(), layout, settings, joint, 0, settings, "active_joint")
    assert layout.notes["properties"] == ["enabled", "name"]
    assert drawn(panels.FlowPanel)["properties"] == ["flow"]
    settings.creases[0].flow = "OBJECT"
    assert drawn(panels.FlowPanel)["properties"] == ["flow", "curve", "progress", "flow_speed", "flow_strength"]
    settings.active_joint = settings.active_crease = 7
    assert drawn(panels.JointsPanel)["properties"] == ["joints"]
    assert drawn(panels.FlowPanel)["properties"] == []


def test_a_flow_shows_how_far_it_has_come(panels, extension, paper):
    live = extension("curvefold_addon.live")
    crease = paper.data.curvefold.creases[0]
    crease.flow, crease.curvature_times, crease.progress = "SHAPE", 1.2, 40.0
    assert drawn(panels.FlowPanel)["texts"] == []
    live.settle(paper.data)
    assert drawn(panels.FlowPanel)["texts"] == ["40% of the way"]


def test_angles_at_points_are_listed_and_the_active_one_can_be_set(panels, paper):
    assert drawn(panels.PointAnglesPanel)["operators"] == ["curvefold.place_angle", "curvefold.add_angles"]
    settings = paper.data.curvefold
    angle = settings.angles.add()
    notes = drawn(panels.PointAnglesPanel)
    assert notes["operators"][-1] == "curvefold.remove_angle"
    assert notes["properties"] == ["angles", "angle", "signed", "strength"]
    layout = Notes()
    panels.AngleList.draw_item(None, context(), layout, settings, angle, 0, settings, "active_angle")
    assert layout.notes["properties"] == ["enabled", "name", "angle"]
    settings.active_angle = 7
    assert drawn(panels.PointAnglesPanel)["properties"] == ["angles"]


def test_every_weight_of_the_solver_can_be_set(panels, extension, paper):
    solver = extension("solver")
    assert set(drawn(panels.WeightsPanel)["properties"]) == {field.name for field in fields(solver.Weights)}


def test_what_cannot_be_had_is_said_above_the_creases(panels, extension, paper):
    live = extension("curvefold_addon.live")
    crease = paper.data.curvefold.creases[0]
    crease.use_angle, crease.signed, crease.angle, crease.side = True, True, 0.5, "M"
    live.settle(paper.data)
    lack = live.report(paper.data).lacks[0]
    assert "is to be a mountain" in lack
    assert lack in " ".join(drawn(panels.CreasesPanel)["texts"])


def test_a_paper_that_was_changed_by_hand_offers_both_ways_out(panels, paper, extension):
    assert "curvefold.restore_paper" not in drawn(panels.MainPanel)["operators"]
    assert "curvefold.make_ordinary_mesh" in drawn(panels.AdvancedPanel)["operators"]
    paper.data.vertices[0].co.z += 0.01
    notes = drawn(panels.MainPanel)
    assert extension("curvefold_addon.live").BY_HAND in said(notes)
    assert notes["operators"][-2:] == ["curvefold.restore_paper", "curvefold.make_ordinary_mesh"]
    assert not bpy.ops.curvefold.fold_anew.poll()
    # In the words of the sentence.
    for operator in notes["operators"][-2:]:
        label = getattr(bpy.ops.curvefold, operator.partition(".")[2]).get_rna_type().name
        assert label in said(notes)


# --- nothing moves -----------------------------------------------------------------------------------------------


def height(panel):
    """Lines of text, and rows of buttons below or above them, of a panel."""
    notes = drawn(panel)
    return notes["lines"], len(notes["operators"]), len(notes["properties"])


@pytest.mark.parametrize("state", ["flat", "asleep", "not live", "out of reach", "baked"])
def test_the_tab_is_as_high_in_every_state(panels, extension, paper, state):
    live, settings = extension("curvefold_addon.live"), paper.data.curvefold
    before = height(panels.MainPanel)
    first = said(drawn(panels.MainPanel))
    if state == "flat":
        bpy.ops.curvefold.flatten()
    elif state == "asleep":
        live.forget()
    elif state == "not live":
        settings.live = False
    elif state == "out of reach":
        for at in ((-0.02, 0.0), (0.02, 0.0)):
            bpy.ops.curvefold.add_handle(at=at, paper=paper.name)
        settings.handles[0].hook.location.z += 1.0
        bpy.context.view_layer.update()
        live.settle(paper.data)
        assert live.report(paper.data).state == "trouble"
    else:
        bpy.context.scene.frame_end = 2
        bpy.ops.curvefold.bake()
    assert said(drawn(panels.MainPanel)) != first
    assert height(panels.MainPanel) == before


def test_what_is_said_stands_below_what_is_clicked(panels, monkeypatch, paper):
    order = []
    monkeypatch.setattr(Notes, "operator", lambda self, *a, **o: order.append("button") or SimpleNamespace())
    monkeypatch.setattr(Notes, "prop", lambda self, *a, **o: order.append("button"))
    monkeypatch.setattr(panels.KeptBox, "say", lambda *a, **o: order.append("sentence"))
    sheet = paper.data.curvefold.sheet
    for item in (paper, sheet, sheet.children[0]):
        order.clear()
        activate(item)
        drawn(panels.MainPanel)
        assert order.index("sentence") > max(k for k, kind in enumerate(order) if kind == "button")


@pytest.mark.parametrize("panel", ["HandlesPanel", "CreasesPanel", "FlowPanel", "PointAnglesPanel", "JointsPanel"])
def test_a_baked_paper_looks_disabled(panels, extension, paper, panel):
    panel = getattr(panels, panel)

    def enabled():
        layout = Notes()
        panel.draw(SimpleNamespace(layout=layout), context())
        return layout.enabled

    assert enabled()
    assert "fold" not in drawn(panels.MainPanel)["grey"]
    bpy.ops.object.mode_set(mode="EDIT")
    assert enabled(), "points are chosen there"
    assert "fold" in drawn(panels.MainPanel)["grey"], "but nothing folds"
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.scene.frame_end = 2
    bpy.ops.curvefold.bake()
    assert not enabled()
    assert {"fold", "live"} <= set(drawn(panels.MainPanel)["grey"])
    bpy.ops.curvefold.free_bake()
    assert enabled()


def test_buttons_for_chosen_points_look_disabled_in_object_mode(paper):
    operators = [getattr(bpy.ops.curvefold, name) for name in ("add_handles", "add_angles", "glue_borders")]
    operators += [bpy.ops.curvefold.keep_patch, bpy.ops.curvefold.join_points]
    folding = [bpy.ops.curvefold.flatten, bpy.ops.curvefold.fold_anew, bpy.ops.curvefold.settle]
    assert not any(operator.poll() for operator in operators)
    assert all(operator.poll() for operator in folding)
    bpy.ops.object.mode_set(mode="EDIT")
    assert all(operator.poll() for operator in operators)
    assert not any(operator.poll() for operator in folding)


def test_import_notes_can_be_read_again_at_the_sheet_and_at_its_paper(panels):
    bpy.ops.curvefold.add_sheet()
    assert "NotesPanel" not in shown(panels)
    bpy.ops.curvefold.add_sample(sample="one_arc")
    sheet = bpy.context.active_object
    sheet.curvefold.notes = "the page is the border\n2 lines are left out"
    assert drawn(panels.NotesPanel)["texts"] == sheet.curvefold.notes.splitlines()
    bpy.ops.curvefold.make_paper(resolution=8)
    assert drawn(panels.NotesPanel)["texts"] == sheet.curvefold.notes.splitlines()
    bpy.context.active_object.data.curvefold.notes = "folded from a file"
    assert drawn(panels.NotesPanel)["texts"] == ["folded from a file"]


def test_a_picture_is_offered(panels, paper):
    offered = ["set_up_picture", "remove_picture", "animate_picture"]
    assert drawn(panels.PicturePanel)["operators"] == [f"curvefold.{name}" for name in offered]
