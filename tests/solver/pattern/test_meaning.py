"""What a line means: by words, dashes and colours, and by what distinguishes lines within one drawing."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from solver.pattern.crease_pattern import CreasePattern
from solver.pattern.meaning import MAX_WORDS, Evidence, classify_all, dash_role, hue_role
from solver.pattern.reading import read_pattern
from solver.pattern.stroke import Decision, Role
from solver.pattern.svg_values import Colour
from solver.pattern.words import Letters, linetype_dashes, read_name

M, V, U = Role.MOUNTAIN, Role.VALLEY, Role.CREASE
DASHED = (4.0, 2.0)
DASH_DOT = (9.0, 3.0, 1.0, 3.0)


#: CSS colours of the tests.
COLOURS = {
    "red": "#ff0000",
    "blue": "#0000ff",
    "lime": "#00ff00",
    "yellow": "#ffff00",
    "orange": "#ffa500",
    "black": "#000000",
}


def paint(text: str) -> Colour:
    digits = COLOURS.get(text, text)[1:]
    return Colour(*(int(digits[k : k + 2], 16) / 255.0 for k in (0, 2, 4)))


def line(colour: str = "black", dashes: tuple[float, ...] = (), *words: tuple[str, str]) -> Evidence:
    return Evidence(paint(colour), dashes, words)


def layer(name: str, colour: str = "black", dashes: tuple[float, ...] = ()) -> Evidence:
    return line(colour, dashes, ("layer", name))


def decide(*lines: Evidence) -> list[Decision]:
    return classify_all(lines)


def roles(*lines: Evidence) -> list[Role]:
    return [decision.role for decision in classify_all(lines)]


# ---- words

NAMES = {
    Role.MOUNTAIN: """
        mountain, MOUNTAIN, MountainLine, mountain_folds, Mountain-Fold_1_, foldmountain, Mountain_x0020_fold, mtn,
        mountain text, M, m, Bergfalte, Bergfalten, BERGFALZ, Berg-Falz, pli montagne, Montaña, pliegue en monte,
        piega a monte, dobra montanha, 山折り, 山折り線, 山, やまおり, ridge creases, montan\u0303a""",
    Role.VALLEY: """
        valley, ValleyLine, valleyfolds, valley_folds-2, valley_text, V, v, Talfalz, Talfalte, pli vallée,
        Pli_x20_vall_xE9_e, valle, PLIEGUE VALLE, piega a valle, dobra vale, 谷折り, 谷, たにおり線""",
    Role.CREASE: """
        crease, CREASES, Fold, FoldLines, fold lines, foldline, score, Score-Line, bend, BENDLINES, hinge, Undriven,
        unassigned, half cut, HALFCUT, HalfCut, partial cut, perf, PERF, Perforation, perforated cut, Faltlinie,
        Falz, Rilllinie, Rillinien, Knickkante, Biegelinie, Ritzlinie, Halbschnitt, Perforationslinie, pli, Plis,
        rainage, mi-chair, Mi chair, perfo, pliegue, doblez, HENDIDO, medio corte, piega, cordonatura, mezzo taglio,
        dobra, vinco, 折り線, 折り目, ミシン目, ﾐｼﾝ目, ハーフカット, mountain-valley, mountain and valley folds,
        fold no. 3""",
    Role.CUT: """
        cut, CUT, Cuts, CutLine, cut_lines, cutting, die cut, diecut, kiss cut, KissCut, through cut, CutContour,
        Layer_cut_copy, slit, slots, Schnittkante, Schnitt, Schnittlinien, Stanzlinie, découpe, decoupe, coupe,
        trait de coupe, ligne de coupe, línea de corte, Corte, troquel, taglio, 切り取り線, カット, 裁断""",
    Role.BORDER: """
        border, Border_1, boundary, boundaries, outline, Contour, perimeter, paper edge, sheet edges, outer edge,
        trim, trim line, sheet, paper, Umriss, Außenkontur, Aussenkontur, Blattrand, Papierkante, Endformat,
        contours, bord, format fini, contorno, borde, bordo, 輪郭, 外形線, 仕上がり線, Crease pattern border""",
    Role.HOLE: """
        hole, Holes, hole_cut, window, WindowOutline, opening, cut-out, cutouts, Loch, Löcher, Loecher, Fenster,
        trou, fenêtre, agujero, ventana, foro, furo, 穴, 窓""",
    Role.FACET: """
        facet, facets, facet creases, triangulation, rulings, aux, aux_lines, auxiliary, hidden, flat, join,
        líneas auxiliares, 補助線""",
}
ASIDE = {
    "dimension line": "DIM, Dims, dimension, cut dimensions, measurements, Bemaßung, BEMASSUNG, "
    "Bemaßungslinien, Maßlinie, cote, cotes, cotation, cota, Cotas, quotatura, 寸法, 寸法線",
    "annotation": "annotation, annotations, notes, callouts, Anmerkungen, nota",
    "label": "label, fold labels, Beschriftung, étiquettes, etiqueta, ラベル",
    "legend": "legend, Legende, légende, leyenda, legenda, 凡例",
    "title block": "title, Title Block, titleblock, Schriftfeld, cartouche, cajetín, 表題欄",
    "text": "text, TEXT, text outlines, fold text, Texte, texto, testo, 文字, テキスト",
    "guide line": "guide, Guides, guidelines, helper, Hilfslinie, HILFSLINIEN, repère, guía, Guías, guida, ガイド",
    "construction line": "construction, Construction lines, Konstruktion, Konstruktionslinien, construcción",
    "glue area": "GLUE, glue tab, GlueFlap, Klebelasche, Klebefläche, Leim, colle, pegamento, のりしろ",
    "bleed": "bleed, BLEED, bleed border, Anschnitt, Beschnitt, fond perdu, sangre, 塗り足し",
    "safe area": "SAFETY, safe, safe area, safe_zone, Sicherheitsabstand, sécurité, seguridad",
    "margin": "margin, margins, marge, margen, 余白",
    "registration mark": "registration, Registration Marks, regmarks, crop marks, cut marks, trim marks, "
    "Schnittmarken, Passermarken, トンボ",
    "frame, page or background": "frame, Frame 1, page, Page-1, background, Artboard 1, Viewport, page border, "
    "Rahmen, Zeichnungsrahmen, Hintergrund, cadre, fond, 背景",
    "grid": "grid, Gridlines, Gitter, grille, cuadrícula",
    "definition point": "Defpoints, DEFPOINTS",
    "print or picture": "print, artwork, image, Druck, impression, imagen, 印刷",
}


def split(texts: str) -> list[str]:
    return [name.strip() for name in texts.split(",")]


@pytest.mark.parametrize(("name", "role"), [(name, role) for role, texts in NAMES.items() for name in split(texts)])
def test_names(name: str, role: Role) -> None:
    said = read_name(name)
    assert said is not None
    assert (said.role, said.word) == (role, "")


@pytest.mark.parametrize(
    ("name", "word"),
    [(name, word) for word, texts in ASIDE.items() for name in split(texts)],
)
def test_names_of_what_is_no_part_of_the_sheet(name: str, word: str) -> None:
    said = read_name(name)
    assert said is not None
    assert (said.role, said.word) == (Role.ASIDE, word)


SILENT = """
    cute, outliner, folder, folders, cutter, guided, guidedtour, textured, executive, mvp, path123, Group, Layer 1,
    Ebene_1, Calque_1, Capa 1, svg2, Line 3, Vector, Rectangle 2, border-radius, outline-width, bordeaux, total,
    portal, metal, horizontal, digital, random, shortcut, cutoff, threshold, manifold, scaffold, scoreboard,
    underscore, folded, unfolded, edges, faces, B, C, F, U, 1, 2, x, a, cls-1, st0, レイヤー1, , _, _x20_, _xD800_,
    ́,
    no fold, uncut, not cut, do not cut, don't cut, kein Schnitt, sans pli, sin corte, 切らない, 折りなし,
    No. 3 fold, cut_and_fold, CutFold layer, CUTFOLD, cut/crease, fold & border, corte y doblez, カットと折り線,
    cut guide, glue crease, cut text, mountain valley cut, mountain valley legend, hidden cut,
    crease pattern, CreasePattern, Faltmuster, cutting pattern, flat pattern, 展開図"""


@pytest.mark.parametrize("name", split(SILENT))
def test_names_that_say_nothing_or_two_contrary_things(name: str) -> None:
    assert read_name(name) is None


def test_letters_and_numbers_only_where_they_are_expected() -> None:
    def read(name: str, letters: Letters) -> Role | None:
        said = read_name(name, letters)
        return said and said.role

    expected = {"M": M, "V": V, "B": Role.BORDER, "C": Role.CUT, "F": Role.FACET, "J": Role.FACET, "U": U}
    for letter, role in expected.items():
        assert read(letter, Letters.ALL) is read(f" {letter.lower()} ", Letters.NUMBERS) is role
        assert read(letter, Letters.SIDES) is (role if letter in "MV" else None)
        assert read(letter, Letters.NONE) is None
    for number, role in zip("0123", (Role.FACET, Role.BORDER, M, V), strict=True):
        assert read(number, Letters.NUMBERS) is role
        assert read(number, Letters.ALL) is None
    assert read("4", Letters.NUMBERS) is None
    assert read("mountain", Letters.NONE) is M


def test_only_the_start_of_a_long_name_is_read() -> None:
    assert read_name("x" * 200 + " cut") is None
    assert read_name("cut " + "x" * 10_000) is not None


def test_notes_show_names_without_their_numbers() -> None:
    assert [read_name(name).shown for name in ("fold_1", "Fold 22", " Fold lines ")] == [
        "fold",
        "fold",
        "Fold lines",
    ]


# ---- colours and dashes


@pytest.mark.parametrize(
    ("colour", "role"),
    [
        *((red, M) for red in ("red", "#EF0C0C", "#800000", "#dc143c", "#fa141e")),
        *((blue, V) for blue in ("blue", "#1e90ff", "#000080", "#1034E8")),
        *((pink, U) for pink in ("#ff00ff", "#ee10e0")),
        *((yellow, Role.FACET) for yellow in ("yellow", "#FFF200")),
        *((green, Role.CUT) for green in ("lime", "#008000", "#00aa00")),
        *((other, None) for other in ("orange", "#00ffff", "#231F20", "black", "#888888", "#ffffff")),
    ],
)
def test_hues(colour: str, role: Role | None) -> None:
    assert hue_role(paint(colour)) is role


@pytest.mark.parametrize(
    ("colour", "role", "why"),
    [
        ("red", M, "hue"),
        ("orange", U, "a colour without a meaning"),
        ("black", Role.DARK, "black"),
        ("#333333", Role.DARK, "black"),
        ("#999999", Role.PALE, "grey"),
    ],
)
def test_a_colour_alone(colour: str, role: Role, why: str) -> None:
    [decision] = decide(line(colour))
    assert (decision.role, decision.why) == (role, why)
    assert decision.detail == f"of colour {line(colour).colour.hex}"


def test_no_colour_is_black() -> None:
    [decision] = classify_all([Evidence(None, (), ())])
    assert decision == Decision(Role.DARK, "no colour", "without a colour")


@pytest.mark.parametrize(
    ("dashes", "role"),
    [
        ((), None),
        ((4, 2), V),
        ((3,), V),
        ((0, 3), V),  # dots, drawn by their round caps
        ((1, 1), V),
        ((4, 2, 5, 2), V),
        (DASH_DOT, M),
        ((5, 2, 0, 2), M),
        ((9, 3, 1, 3, 1, 3), M),
        ((9, 3, 1), M),  # used twice: 9 gap 1 gap 3 gap
    ],
)
def test_dashes(dashes: tuple[float, ...], role: Role | None) -> None:
    assert dash_role(dashes) is role


@pytest.mark.parametrize(
    ("name", "role"),
    [
        *((name, V) for name in ("DASHED", "Dashed2", "DASHEDX2", "HIDDEN", "Hidden2", "DOT", "ACAD_ISO02W100")),
        *((name, M) for name in ("DASHDOT", "DASHDOTX2", "CENTER", "Center2", "PHANTOM", "DIVIDE", "BORDER")),
        *((name, M) for name in ("ACAD_ISO04W100", "BORDER2")),
        *((name, None) for name in ("CONTINUOUS", "Continuous", "ByLayer")),
    ],
)
def test_line_types_are_dash_patterns(name: str, role: Role | None) -> None:
    dashes = linetype_dashes(name)
    assert dashes is not None
    assert dash_role(dashes) is role
    # Whatever their names: a line type BORDER is no border. Dashes of its own go before.
    [decision] = decide(line("black", (), ("linetype", name)))
    assert decision.role is (role or Role.DARK)
    assert roles(line("black", DASH_DOT, ("linetype", "DASHED"))) == [M]


def test_other_line_types_are_names() -> None:
    assert linetype_dashes("PERFORATION") is None
    assert roles(line("black", (), ("linetype", "MOUNTAIN"))) == [M]


# ---- words beat dashes, dashes beat colours


def test_words_beat_dashes_beat_colours() -> None:
    words, dashes, colour = decide(line("lime", DASHED, ("class", "mountain")), line("lime", DASHED), line("lime"))
    assert (words.role, words.why) == (M, "class")
    assert (dashes.role, dashes.why) == (V, "dash pattern")
    assert (colour.role, colour.why) == (Role.CUT, "hue")


def test_notes_name_a_colour_that_says_otherwise() -> None:
    named, dashed, same, edge = decide(
        layer("mountain", "blue"), line("lime", DASHED), layer("valley", "blue"), layer("border", "lime")
    )
    assert named.detail == "of colour #0000ff, which alone would mean a valley crease, but named 'mountain'"
    assert dashed.detail == "of colour #00ff00, which alone would mean a cut, but dashed"
    assert same.detail == "of colour #0000ff named 'valley'"
    assert edge.detail == "of colour #00ff00 named 'border'"


def test_the_first_name_that_says_something_wins() -> None:
    words = (("class", "cls-1"), ("id", "path7"), ("layer", "cut_and_fold"), ("layer", "Valley"), ("layer", "cut"))
    [decision] = decide(line("red", (), *words))
    assert (decision.role, decision.why) == (V, "layer")


def test_a_line_that_just_says_crease_has_the_side_of_its_group() -> None:
    assert roles(line("black", (), ("class", "fold"), ("layer", "Mountain"))) == [M]
    assert roles(line("black", (), ("class", "mountain-valley"), ("layer", "cut"))) == [U]


def test_what_is_no_part_of_the_sheet_is_called_by_its_word() -> None:
    decision, _ = decide(layer("DIM", "lime"), layer("CUT"))
    assert (decision.role, decision.word) == (Role.ASIDE, "dimension line")


@pytest.mark.parametrize(
    ("why", "text", "role"),
    [
        ("data-assignment", "V", V),
        ("data-assignment", "B", Role.BORDER),
        ("data-assignment", "valley", V),
        ("data-assignment", "2", M),
        ("data-type", "C", Role.CUT),
        ("data-type", "2", Role.DARK),
        ("data-layer", "B", Role.DARK),
        ("class", "M", M),
        ("class", "B", Role.DARK),
        ("id", "M", Role.DARK),
        ("id", "c", Role.DARK),
    ],
)
def test_letters_in_data_classes_and_ids(why: str, text: str, role: Role) -> None:
    assert roles(line("black", (), (why, text))) == [role]


def test_letters_of_layers_beside_m_or_v() -> None:
    assert roles(*(layer(letter) for letter in "BCFUV")) == [Role.BORDER, Role.CUT, Role.FACET, U, V]
    assert roles(line("black", (), ("id", "B")), layer("V")) == [Role.DARK, V]


def test_only_so_many_names_are_looked_at() -> None:
    words = [("layer", "Layer 1")] * MAX_WORDS
    assert roles(line("black", (), *words, ("layer", "cut"))) == [Role.DARK]
    assert roles(line("black", (), *words[1:], ("layer", "cut"))) == [Role.CUT]


# ---- names of whole drawings


def test_a_name_that_all_lines_share_distinguishes_nothing() -> None:
    lines = [line(colour, (), ("layer", "Folds")) for colour in ("black", "red", "blue")]
    assert roles(*lines) == [Role.DARK, M, V]
    # Also where something beside is left out, but not where anything else is drawn.
    assert roles(*lines, layer("notes")) == [Role.DARK, M, V, Role.ASIDE]
    assert roles(*lines, line()) == [U, M, V, Role.DARK]
    # Lines that look alike are what their name says.
    assert roles(*[layer("Folds", "lime")] * 2) == [U, U]
    assert roles(layer("Valley", "blue")) == [V]


def test_a_drawing_that_is_left_out_whole_is_not_meant_so() -> None:
    assert roles(layer("Artwork"), layer("Artwork", "red")) == [Role.DARK, M]
    assert roles(layer("Page 1"), layer("Legend")) == [Role.DARK, Role.DARK]
    assert roles(layer("aux")) == [Role.DARK]
    assert roles(layer("Artwork"), line("red"), line()) == [Role.ASIDE, M, Role.DARK]


def test_pages_and_sheets_may_hold_anything() -> None:
    for name in ("Page 1", "Sheet 1", "Frame 1", "print"):
        lines = [layer(name, colour) for colour in ("black", "red", "blue")]
        assert roles(*lines, layer("DIM"), line()) == [Role.DARK, M, V, Role.ASIDE, Role.DARK]
    assert roles(layer("sheet"), line("red")) == [Role.BORDER, M]


def test_a_frame_is_the_border_where_nothing_else_could_be() -> None:
    assert roles(layer("frame"), line("red"), line("blue")) == [Role.BORDER, M, V]
    assert roles(layer("frame"), line("red"), line("black")) == [Role.ASIDE, M, Role.DARK]
    assert roles(layer("frame"), line("red"), layer("cut", "red")) == [Role.ASIDE, M, Role.CUT]
    assert roles(layer("bleed"), line("red"), line("blue")) == [Role.ASIDE, M, V]


# ---- sides by looks within a name


def test_colours_tell_the_sides_within_a_name_that_just_says_crease() -> None:
    red, blue, black, border = decide(layer("Folds", "red"), layer("Folds", "blue"), layer("Folds"), layer("cut"))
    assert [d.role for d in (red, blue, black, border)] == [M, V, U, Role.CUT]
    assert (red.why, red.detail) == ("hue", "of colour #ff0000, named 'Folds'")
    assert black.why == "layer"


def test_the_colour_of_a_layer_tells_no_side() -> None:
    found = roles(layer("Fold", "red"), layer("Fold", "red"), layer("Perf", "blue"), layer("Cut", "lime"))
    assert found == [U, U, U, Role.CUT]


def test_dashes_tell_the_sides_within_a_name_that_just_says_crease() -> None:
    assert roles(layer("Folds", "black", DASHED), layer("Folds", "black", DASH_DOT), line()) == [V, M, Role.DARK]


# ---- dashes of a whole drawing


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        # Two patterns: Yoshizawa and Randlett, whatever the colours.
        ([("black", DASH_DOT), ("black", DASHED)], [M, V]),
        ([("red", DASH_DOT), ("blue", DASHED)], [M, V]),
        ([("blue", DASH_DOT), ("red", DASHED)], [M, V]),
        ([("red", DASH_DOT), ("red", DASHED)], [M, V]),
        # One pattern: it says crease, and colours say the sides.
        ([("red", DASHED), ("blue", DASHED)], [M, V]),
        ([("red", DASH_DOT), ("blue", DASH_DOT)], [M, V]),
        ([("red", DASHED), ("blue", DASHED), ("black", DASHED), ("lime", DASHED)], [M, V, U, U]),
        ([("red", DASHED)], [M]),
        ([("lime", DASHED)], [V]),
        ([("black", DASHED)], [V]),
        ([("black", DASHED), ("red", DASHED)], [V, M]),
        # Dashed beside solid creases.
        ([("red", ()), ("blue", DASHED)], [M, V]),
        ([("red", ()), ("red", DASHED)], [M, V]),
        ([("blue", ()), ("red", DASHED)], [V, M]),
        ([("red", ()), ("blue", DASH_DOT)], [M, V]),
        ([("red", ()), ("blue", DASH_DOT), ("black", DASHED)], [M, M, V]),
        # Colours say the sides, and one pattern goes through them.
        ([("red", ()), ("blue", ()), ("red", DASHED)], [M, V, M]),
        ([("red", DASHED), ("blue", DASHED), ("blue", DASH_DOT)], [M, V, V]),
        # Other dashed lines beside red and blue: yellow and grey stay what they are.
        ([("red", ()), ("blue", ()), ("lime", DASHED)], [M, V, U]),
        ([("red", ()), ("blue", ()), ("yellow", DASHED)], [M, V, Role.FACET]),
        ([("red", ()), ("blue", ()), ("#999999", DASHED)], [M, V, Role.PALE]),
        ([("red", ()), ("blue", ()), ("black", DASHED), ("black", DASH_DOT)], [M, V, V, M]),
        # The border says nothing about creases.
        ([("black", ()), ("black", DASHED)], [Role.DARK, V]),
        ([("lime", ()), ("black", DASHED)], [Role.CUT, V]),
    ],
)
def test_dashes_tell_sides_only_where_they_distinguish(
    lines: list[tuple[str, tuple[float, ...]]], expected: list[Role]
) -> None:
    assert roles(*(line(colour, dashes) for colour, dashes in lines)) == expected
    assert roles(*(line(colour, dashes) for colour, dashes in lines[::-1])) == expected[::-1]


def test_lines_of_known_meaning_do_not_change_what_dashes_say() -> None:
    dimension = layer("DIM", "black", DASH_DOT)
    assert roles(dimension, line("red", DASHED), line("blue", DASHED)) == [Role.ASIDE, M, V]


# ---- many lines


def test_many_lines_take_little_time() -> None:
    rng = np.random.default_rng(5)
    ids = ["".join(rng.choice(list("abcdefgfoldcutline"), 12)) for _ in range(20_000)]
    groups = tuple(("group or layer name", f"group {k} of layers") for k in range(30))
    lines = [
        line(colour, DASHED, ("class", "cls-1"), ("id", f"{name}_{k}"), *groups)
        for k, (name, colour) in enumerate(zip(ids, ["red", "blue"] * 10_000, strict=True))
    ]
    start = time.process_time()
    found = classify_all(lines)
    assert time.process_time() - start < 1.0
    assert len(found) == 20_000
    assert len({(decision.detail, decision.why) for decision in found}) < 50


def test_numbered_names_are_one_note() -> None:
    lines = [line("black", (), ("id", f"fold_{k}")) for k in range(300)]
    assert len({decision.detail for decision in decide(line(), *lines)}) == 2


# ---- whole drawings

CASES = Path(__file__).parent / "cases"


def case(name: str) -> CreasePattern:
    return read_pattern(CASES / f"{name}.svg")


@pytest.mark.parametrize(
    ("name", "letters", "holes", "notes"),
    [
        (
            "green_crease_layer",
            "U",
            0,
            [
                "1 stroke of colour #000000 named 'CUT': border (group or layer name)",
                "1 stroke of colour #00ff00, which alone would mean a cut, but named 'CREASE': "
                "unassigned crease (group or layer name)",
            ],
        ),
        (
            "dashed_green_fold",
            "U",
            0,
            [
                "1 stroke of colour #00aa00, which alone would mean a cut, but dashed: "
                "unassigned crease, since all creases look the same (dash pattern)"
            ],
        ),
        (
            "cad_layers",
            "U",
            0,
            [
                "1 stroke of colour #0000ff, which alone would mean a valley crease, but named 'CUT': "
                "border (group or layer name)",
                "1 stroke of colour #00ff00, which alone would mean a cut, but named 'DIM': "
                "left out: dimension line (group or layer name)",
            ],
        ),
        (
            "red_cut_class",
            "U",
            1,
            [
                "1 stroke of colour #ff0000, which alone would mean a mountain crease, but named 'cut': "
                "border (class)",
                "1 stroke of colour #0000ff, which alone would mean a valley crease, but named 'fold': "
                "unassigned crease (class)",
            ],
        ),
        (
            "blue_mountain_class",
            "MV",
            0,
            [
                "1 stroke of colour #0000ff, which alone would mean a valley crease, but named 'mountain': "
                "mountain crease (class)"
            ],
        ),
        (
            "valley_group_hue",
            "V",
            0,
            ["1 stroke of colour #0000ff named 'valley': valley crease (class of its group)"],
        ),
        (
            "data_assignment",
            "V",
            0,
            [
                "1 stroke of colour #000000 named 'B': border (data-assignment)",
                "1 stroke of colour #000000 named 'V': valley crease (data-assignment)",
            ],
        ),
    ],
)
def test_cases(name: str, letters: str, holes: int, notes: list[str]) -> None:
    pattern = case(name)
    side = 1.0 if name == "data_assignment" else 100.0
    np.testing.assert_allclose(np.ptp(pattern.boundary, axis=0), side, atol=1e-9)
    assert "".join(crease.assignment for crease in pattern.creases) == letters
    assert len(pattern.holes) == holes
    assert set(notes) <= set(pattern.notes)
