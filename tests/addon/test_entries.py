"""What the extension offers beside its tab: right-click menu, toolbar, keys; tooltips and other languages."""

import bpy
import pytest

from tests.addon.test_panels import Notes, activate, context

LANGUAGES = ("de", "ja")


class Menu(Notes):
    """A menu's layout, which is also the menu."""

    @property
    def layout(self):
        return self


def entries(extension):
    menu = Menu()
    extension("curvefold_addon.context_menu")._entries(menu, bpy.context)
    return menu.notes["operators"], menu.notes["properties"]


# --- right click -------------------------------------------------------------------------------------------------


def test_a_right_click_on_a_paper_offers_what_can_be_done_with_it(extension, paper):
    operators, properties = entries(extension)
    assert {"curvefold.place_handle", "curvefold.flatten", "curvefold.edit_drawing"} <= set(operators)
    assert properties == ["show"]
    bpy.ops.curvefold.add_handle(at=(0.01, 0.01))
    assert entries(extension)[0] == operators, "the same at its handle"


def test_a_right_click_on_a_drawing_offers_creases_and_the_paper(extension, sheet):
    activate(sheet.children[0])
    operators, _ = entries(extension)
    assert operators == ["curvefold.draw_crease", "curvefold.set_assignment", "curvefold.make_paper"]
    bpy.ops.curvefold.make_paper(resolution=8)
    sheet.curvefold.show = True
    activate(sheet)
    assert entries(extension)[0][-1] == "curvefold.back_to_paper"


def test_a_right_click_on_anything_else_is_blenders(extension, paper):
    bpy.ops.object.camera_add()
    assert entries(extension) == ([], [])
    bpy.context.view_layer.objects.active = None
    bpy.data.objects.remove(paper)
    assert entries(extension) == ([], [])


# --- tools and keys ----------------------------------------------------------------------------------------------


def test_what_the_tools_call_is_there(extension):
    tools = extension("curvefold_addon.tools")
    for tool, _, _ in tools._TOOLS:
        for operator, event, _ in tool.bl_keymap:
            group, _, name = operator.partition(".")
            assert name in dir(getattr(bpy.ops, group)), operator
            assert event["type"] == "LEFTMOUSE"


def test_the_keys_are_the_extensions_own_and_can_be_changed(extension):
    keymaps = extension("curvefold_addon.keymaps")
    config = bpy.context.window_manager.keyconfigs.addon
    items = {item.idname: item for item in config.keymaps[keymaps.KEYMAP].keymap_items}
    for operator, key in keymaps.KEYS:
        assert (items[operator].type, items[operator].ctrl, items[operator].alt) == (key, True, True)
    taken = {
        (item.type, bool(item.ctrl), bool(item.alt), bool(item.shift))
        for keymap in bpy.context.window_manager.keyconfigs.default.keymaps
        if keymap.name in {"Object Mode", "3D View", "Window", "Screen"}
        for item in keymap.keymap_items
    }
    assert not taken & {(key, True, True, False) for _, key in keymaps.KEYS}


# --- tooltips ----------------------------------------------------------------------------------------------------


def described():
    """(name, RNA) of all that the extension has registered and that has properties."""
    for name in dir(bpy.ops.curvefold):
        yield name, getattr(bpy.ops.curvefold, name).get_rna_type()
    for kind in (bpy.types.PropertyGroup, bpy.types.AddonPreferences):
        for cls in kind.__subclasses__():
            if ".curvefold." in cls.__module__ and cls.is_registered:
                yield cls.__name__, cls.bl_rna


def test_every_choice_has_a_tooltip():
    found = 0
    for name, rna in described():
        for prop in rna.properties:
            if prop.type == "ENUM" and not prop.identifier.startswith("bl_"):
                for item in prop.enum_items:
                    found += 1
                    assert item.description, f"{name}.{prop.identifier}: {item.identifier}"
    assert found > 60


def test_every_operator_has_a_tooltip():
    names = dir(bpy.ops.curvefold)
    assert len(names) > 30
    for name in names:
        assert getattr(bpy.ops.curvefold, name).get_rna_type().description, name


# --- languages ---------------------------------------------------------------------------------------------------


def test_the_main_buttons_and_sentences_are_translated(extension):
    texts = extension("curvefold_addon.translations")._TEXTS
    english = [row[0] for row in texts]
    assert len(set(english)) == len(english)
    assert all(len(row) == 1 + len(LANGUAGES) and all(row) for row in texts)
    for operator in ("make_paper", "draw_crease", "place_handle", "flatten", "fold_anew", "back_to_paper"):
        label = getattr(bpy.ops.curvefold, operator).get_rna_type().name
        assert label in english
    wording = extension("curvefold_addon.wording")
    for sentence in (wording.NO_SHEET, wording.NO_CREASE, wording.DRAWING, wording.READY, wording.NEXT):
        assert sentence in english


def test_a_sentence_is_translated_before_it_is_broken_into_lines(extension, monkeypatch):
    parts = extension("curvefold_addon.panel_parts")
    wording = extension("curvefold_addon.wording")
    texts = {row[0]: row for row in extension("curvefold_addon.translations")._TEXTS}
    for column in (1, 2):
        monkeypatch.setattr(parts, "translated", lambda text, column=column: texts[text][column])
        layout = Notes()
        lines = parts.say(layout, context(), wording.NO_SHEET)
        assert "".join(layout.notes["texts"]).replace(" ", "") == texts[wording.NO_SHEET][column].replace(" ", "")
        assert lines == len(layout.notes["texts"]) > 1


@pytest.mark.parametrize("width", [180.0, 260.0])
def test_lines_in_japanese_are_as_wide_as_others(extension, width):
    wording = extension("curvefold_addon.wording")
    texts = {row[0]: row[2] for row in extension("curvefold_addon.translations")._TEXTS}
    latin = max(map(len, wording.lines(wording.NO_SHEET, width)))
    japanese = max(map(len, wording.lines(texts[wording.NO_SHEET], width)))
    assert japanese <= 0.65 * latin
