"""What the name of a layer, a class or a line says in words: English, German, French, Spanish, Italian, Portuguese
and Japanese, as programs for design, CAD, packaging, laser cutters and origami write them.

A name is split into words and every word is looked up whole. English and German words may be written together
("foldline", "Talfalz"), if all their parts are known. So "cute", "folder" and "cutter" say nothing.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum, auto

from .stroke import Role

#: Characters of a name that are looked at, and of one word that may be several written together.
MAX_NAME = 200
_MAX_COMPOUND = 40
#: Characters of a name that a note shows.
_MAX_SHOWN = 60


class Term(IntEnum):
    """What one word is about."""

    MOUNTAIN = auto()
    VALLEY = auto()
    CREASE = auto()
    PART_CUT = auto()  # perforated or cut half through: paper is folded along it
    CUT = auto()
    HOLE = auto()
    BORDER = auto()
    FACET = auto()
    # No part of the sheet:
    DIMENSION = auto()
    ANNOTATION = auto()
    LABEL = auto()
    LEGEND = auto()
    TITLE = auto()
    TEXT = auto()
    GUIDE = auto()
    CONSTRUCTION = auto()
    GLUE = auto()
    BLEED = auto()
    SAFE = auto()
    MARGIN = auto()
    REGISTRATION = auto()
    FRAME = auto()
    GRID = auto()
    DEFPOINTS = auto()
    PRINT = auto()
    # These change what the others say:
    HALF = auto()
    MARK = auto()
    EDGE = auto()
    PAPER = auto()
    PATTERN = auto()
    STYLE = auto()
    NOT = auto()
    PLAIN = auto()  # says nothing itself, as "line"


#: How a note calls what is no part of the sheet.
_ASIDE = {
    Term.DIMENSION: "dimension line",
    Term.ANNOTATION: "annotation",
    Term.LABEL: "label",
    Term.LEGEND: "legend",
    Term.TITLE: "title block",
    Term.TEXT: "text",
    Term.GUIDE: "guide line",
    Term.CONSTRUCTION: "construction line",
    Term.GLUE: "glue area",
    Term.BLEED: "bleed",
    Term.SAFE: "safe area",
    Term.MARGIN: "margin",
    Term.REGISTRATION: "registration mark",
    Term.FRAME: "frame, page or background",
    Term.GRID: "grid",
    Term.DEFPOINTS: "definition point",
    Term.PRINT: "print or picture",
}
#: These are *about* a line: "fold labels" are labels.
_ABOUT = frozenset({Term.DIMENSION, Term.ANNOTATION, Term.LABEL, Term.LEGEND, Term.TITLE, Term.TEXT})
_CREASES = frozenset({Term.CREASE, Term.PART_CUT})
_EDGES = frozenset({Term.HOLE, Term.CUT, Term.BORDER})  # a hole is cut out and has a border: the first one wins

#: Words without accents, in small letters. English and German ones may be compounded, and have their plurals.
_COMPOUNDED = {
    Term.MOUNTAIN: "mountain mtn ridge berg",
    Term.VALLEY: "valley vly tal",
    Term.CREASE: """
        fold folding crease creasing score scoring scored bend bending hinge undriven unassigned
        falz falze falte faltung falt falzung rill rille rillung rillinie knick knicke biege biegung
        scharnier""",
    Term.PART_CUT: """
        perf perfo perforation perforate perforated perforating perforiert perforierung microperf
        ritz ritze ritzung anritzen""",
    Term.CUT: """
        cut cutting slit slot kisscut thrucut throughcut cutcontour
        schnitt schnitte schneid schneide ausschnitt einschnitt stanz stanze stanzung""",
    Term.HOLE: """
        hole window opening aperture cutout punch
        loch locher loecher fenster offnung oeffnung aussparung ausstanzung""",
    Term.BORDER: """
        border boundary boundaries outline contour perimeter trim
        umriss umrisse kontur konturen rand rander raender umrandung begrenzung endformat finishedsize""",
    Term.FACET: """
        facet triangulation triangulated ruling aux auxil auxiliary hidden
        facette triangulierung erzeugende""",
    Term.DIMENSION: """
        dim dimension dimensioning measure measurement
        bemassung vermassung masslinie messung""",
    Term.ANNOTATION: "annotation note comment remark callout leader anmerkung notiz kommentar hinweis",
    Term.LABEL: "label beschriftung etikett etikette",
    Term.LEGEND: "legend legende",
    Term.TITLE: "title titleblock titel schriftfeld",
    Term.TEXT: "text texte",
    Term.GUIDE: "guide guideline helper hilf hilfe",
    Term.CONSTRUCTION: "construction konstruktion",
    Term.GLUE: "glue gluing adhesive klebe klebung kleber leim",
    Term.BLEED: "bleed anschnitt beschnitt beschnittzugabe",
    Term.SAFE: "safe safety sicherheit",
    Term.MARGIN: "margin seitenrand",
    Term.REGISTRATION: "registration register regmark crop fiducial passer passkreuz passkreuze",
    Term.FRAME: """
        frame page background artboard canvas viewport vport
        rahmen seite hintergrund zeichenflache zeichenflaeche""",
    Term.GRID: "grid gitter",
    Term.DEFPOINTS: "defpoint",
    Term.PRINT: "print printing printed artwork image picture druck bild bilder",
    Term.HALF: "half halb partial",
    Term.MARK: "mark marking marke markierung",
    Term.EDGE: "edge kante outer outside exterior aussen",
    Term.PAPER: "paper sheet blatt papier",
    Term.PATTERN: "pattern diagram muster",
    Term.PLAIN: """
        line path layer stroke curve segment group area zone box flap tab die lasche
        flache flaeche linie ebene strich striche zeichnung abstand""",
}
_WHOLE = {
    Term.MOUNTAIN: "montagne montagnes mont monts montana montanas monte montes monti montagna montanha montanhas",
    Term.VALLEY: "vallee vallees valle valles vale vales valli",
    Term.CREASE: """
        pli plis pliage pliure pliures rainage rainages rainure rainures charniere charnieres
        pliegue pliegues doblez dobleces doblado plegado hendido hendidos hendidura bisagra bisagras
        piega pieghe piegatura piegature cordonatura cordonature cerniera cerniere
        dobra dobras dobradura vinco vincos vincagem dobradica""",
    Term.PART_CUT: """
        michair perfos picotage perforacion perforaciones perforado perforada semicorte semicortes
        perforazione perforazioni mezzotaglio perfuracao picote""",
    Term.CUT: """
        coupe coupes coupure decoupe decoupes decoupage decouper couper
        corte cortes cortar troquel troqueles troquelado taglio tagli fustella recorte recortes cortante""",
    Term.HOLE: """
        trou trous fenetre fenetres ouverture ouvertures evidement evidements agujero agujeros ventana ventanas
        hueco huecos foro fori buco buchi finestra finestre furo furos janela janelas""",
    Term.BORDER: """
        contours bord bords bordure perimetre borde bordes contorno contornos perimetro
        bordo bordi contorni borda bordas formatfini""",
    Term.FACET: """
        facettes auxiliaire auxiliaires auxiliar auxiliares ausiliaria ausiliarie ausiliario faceta facetas
        triangulacion triangolazione triangulacao""",
    Term.DIMENSION: """
        cote cotes cotation cotations cota cotas acotacion acotaciones quotatura quotature medida medidas
        mesure mesures misura misure cotagem""",
    Term.ANNOTATION: "nota notas commentaire commentaires comentario comentarios anotacion anotaciones annotazioni",
    Term.LABEL: "etiquette etiquettes etiqueta etiquetas etichetta etichette",
    Term.LEGEND: "legenda legendas leyenda leyendas leggenda",
    Term.TITLE: "titre titres titulo titulos titolo cartouche cajetin cartiglio",
    Term.TEXT: "textes texto textos testo testi",
    Term.GUIDE: "repere reperes guia guias guida",
    Term.CONSTRUCTION: "construccion costruzione construcao",
    Term.GLUE: "colle encollage pegamento pegado cola colla incollaggio colagem",
    Term.BLEED: "fondperdu fondsperdus sangre sangrado sangria abbondanza",
    Term.SAFE: "securite seguridad segura sicurezza seguranca",
    Term.MARGIN: "marge marges margen margenes margine margini margem margens",
    Term.REGISTRATION: "hirondelle hirondelles registro crocini",
    Term.FRAME: """
        cadre fond arriereplan marco fondo pagina paginas cornice sfondo moldura fundo""",
    Term.GRID: "grille grilla cuadricula rejilla griglia",
    Term.PRINT: "impression imprimir impresion imagen imagenes stampa immagine immagini imagem imagens impressao",
    Term.HALF: "mi medio media meio meia mezzo mezza demi",
    Term.MARK: "marca marcas marque marques",
    Term.PAPER: "feuille feuilles hoja hojas foglio fogli folha folhas papel",
    Term.PATTERN: "patron patrones diagrama diagramme schema",
    Term.STYLE: "radius width color colour style collapse spacing offset",
    Term.NOT: "no not non never dont without uncut nocut kein keine nicht ohne sans pas sin senza nao sem",
}
#: Parts of Japanese words; the longest one that fits wins. 山折 is a mountain, 折 alone a crease.
_JAPANESE = {
    Term.MOUNTAIN: "山 山折 やまおり",
    Term.VALLEY: "谷 谷折 たにおり",
    Term.CREASE: "折 おり線 クリース 筋押",
    Term.PART_CUT: "ミシン ハーフカット 半切",
    Term.CUT: "切 きりとり キリトリ カット 裁断 断裁 抜き",
    Term.HOLE: "穴 窓 くり抜",
    Term.BORDER: "輪郭 外形 外周 境界 縁 仕上",
    Term.FACET: "補助 隠線",
    Term.DIMENSION: "寸法",
    Term.ANNOTATION: "注釈 注記",
    Term.LABEL: "ラベル",
    Term.LEGEND: "凡例",
    Term.TITLE: "表題 タイトル",
    Term.TEXT: "文字 テキスト",
    Term.GUIDE: "ガイド",
    Term.CONSTRUCTION: "作図",
    Term.GLUE: "のりしろ ノリシロ 糊 接着",
    Term.BLEED: "塗り足し 塗足 ぬりたし 裁ち落とし",
    Term.SAFE: "安全",
    Term.MARGIN: "余白 マージン",
    Term.REGISTRATION: "トンボ",
    Term.FRAME: "枠 ページ 背景 アートボード",
    Term.GRID: "グリッド 方眼",
    Term.PRINT: "印刷 画像",
    Term.PAPER: "用紙",
    Term.PATTERN: "展開図",
    Term.NOT: "ない 無し なし",
}

#: The letters of FOLD for a whole name: M and V anywhere, the others where letters are expected.
_SIDES = {"m": Role.MOUNTAIN, "v": Role.VALLEY}
_LETTERS = {
    **_SIDES,
    "b": Role.BORDER,
    "c": Role.CUT,
    "f": Role.FACET,
    "j": Role.FACET,
    "u": Role.CREASE,
}
#: Words of FOLD's letters that only mean it alone: a "flat pattern" is no facet line.
_ALONE = {"flat": Role.FACET, "join": Role.FACET}
#: The numbers of line types in .cp files.
_NUMBERS = {"0": Role.FACET, "1": Role.BORDER, "2": Role.MOUNTAIN, "3": Role.VALLEY}

#: AutoCAD's line types by what they look like, without their scales ("DASHED2", "CENTERX2").
_DASHED_TYPES = frozenset(
    {"dashed", "hidden", "dot", "dotted", "dashspace", "verdeckt", "strichlinie", "punkt", "gestrichelt"}
)
_DASH_DOT_TYPES = frozenset(
    {"dashdot", "dashdotted", "center", "divide", "phantom", "border", "mitte", "strichpunkt", "strichpunktlinie"}
)
_SOLID_TYPES = frozenset({"continuous", "solid", "bylayer", "byblock"})
_ISO_DASHED = frozenset({"02", "03", "07"})  # dashed, dashed with wide gaps, dotted (ISO 128)
_ISO_TYPE = re.compile(r"acad_iso(\d\d)w\d+\Z")

_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{2,4})_")  # Illustrator's and CorelDRAW's way to write a blank in an id
_JAPANESE_LETTER = r"\u3040-\u30ff\u3400-\u9fff"
_SPLIT = re.compile(rf"[{_JAPANESE_LETTER}]+|[^\W\d_{_JAPANESE_LETTER}]+")
_CAMEL = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_DIGIT = re.compile(r"\d")


class Letters(IntEnum):
    """Which single letters a name may stand for."""

    NONE = auto()  # the id of a line: they are counted a, b, c
    SIDES = auto()
    ALL = auto()
    NUMBERS = auto()  # all, and the numbers of .cp


@dataclass(frozen=True)
class Saying:
    """What one name says.

    role   what it says a line is
    shown  how notes show the name: as it is; without its numbers, so that "fold_1" and "fold_2" are one note
    key    its words with a meaning, the same for names that say the same
    word   what a line is called that is no part of the sheet, else empty
    weak   a container may have this name, whatever is in it
    frame  the name is one of a frame or a page, which may be the sheet when nothing else is
    """

    role: Role
    shown: str
    key: str
    word: str = ""
    weak: bool = False
    frame: bool = False


def read_name(text: str, letters: Letters = Letters.SIDES) -> Saying | None:
    """What a name says, None if nothing, or two contrary things.

    >>> read_name("MountainLine").role, read_name("talfalz-2").role, read_name("Layer 1")
    (<Role.MOUNTAIN: 'mountain crease'>, <Role.VALLEY: 'valley crease'>, None)
    """
    text = _ESCAPE.sub(_unescape, text[:MAX_NAME]).strip()
    whole = text.casefold()
    role = _whole_role(whole, letters)
    if role is not None:
        return Saying(role, text, whole)
    found = [(word, term) for word in _phrases(list(_words(text))) for term in _terms(word)]
    said = _judge([term for _, term in found]) if found else None
    if said is None:
        return None
    role, aside, weak = said
    key = " ".join(dict.fromkeys(word for word, term in found if term is not Term.PLAIN))
    shown = key if _DIGIT.search(text) else text
    word = "" if aside is None else _ASIDE[aside]
    return Saying(role, shown[:_MAX_SHOWN], key, word, weak, aside is Term.FRAME)


def linetype_dashes(text: str) -> tuple[float, ...] | None:
    """The dash lengths that the name of a line type stands for, () for a solid line; None for any other name.

    >>> linetype_dashes("DASHED2"), linetype_dashes("CENTER"), linetype_dashes("Continuous")
    ((2.0, 1.0), (4.0, 1.0, 1.0, 1.0), ())
    """
    name = text[:MAX_NAME].strip().casefold()
    iso = _ISO_TYPE.match(name)
    base = re.sub(r"[\s_-]+", "", name)
    base = re.sub(r"(x?\d+|tiny|large|small)\Z", "", base)
    if base in _SOLID_TYPES:
        return ()
    if base in _DASHED_TYPES or (iso and iso.group(1) in _ISO_DASHED):
        return (2.0, 1.0)
    if base in _DASH_DOT_TYPES or iso:
        return (4.0, 1.0, 1.0, 1.0)
    return None


def _whole_role(name: str, letters: Letters) -> Role | None:
    if letters is Letters.NONE:
        return None
    if letters is Letters.SIDES:
        return _SIDES.get(name) or _ALONE.get(name)
    role = _LETTERS.get(name) or _ALONE.get(name)
    return _NUMBERS.get(name) if role is None and letters is Letters.NUMBERS else role


def _judge(terms: list[Term]) -> tuple[Role, Term | None, bool] | None:
    """(role, what it is aside from the sheet, weak) of a name with these words; None if they say nothing."""
    said = _combined(terms)
    if said is None:
        return None
    sides = said & {Term.MOUNTAIN, Term.VALLEY}
    if len(sides) == 1:
        return (Role.MOUNTAIN if Term.MOUNTAIN in sides else Role.VALLEY), None, False
    creases = said & (_CREASES | sides)
    edges = said & _EDGES
    aside = next((term for term in _ASIDE if term in said), None)
    if aside is not None:
        # A picture of a sheet, or the border of a bleed, is none of the sheet; the crease of a glue flap may be.
        drawn = said - set(_ASIDE) - {Term.BORDER, Term.FACET}
        if aside in _ABOUT:
            drawn -= _CREASES
            if aside is not Term.TEXT:
                drawn -= _EDGES
        return None if drawn else (Role.ASIDE, aside, said <= {Term.FRAME, Term.PRINT, Term.BORDER})
    if Term.FACET in said:
        return None if edges or sides else (Role.FACET, None, False)
    if creases and edges:
        return None
    if creases:
        return Role.CREASE, None, False
    for term, role in ((Term.HOLE, Role.HOLE), (Term.CUT, Role.CUT), (Term.BORDER, Role.BORDER)):
        if term in said:
            return role, None, False
    if Term.PAPER in terms and Term.PATTERN not in terms:
        return Role.BORDER, None, True
    return None


def _combined(terms: list[Term]) -> set[Term] | None:
    """The words' meanings after those that change others; None when the name denies what it names."""
    said = set(terms)
    if Term.NOT in said:
        return None
    if Term.CUT in said and said & {Term.HALF, Term.PART_CUT}:
        said = said - {Term.CUT} | {Term.PART_CUT}
    if Term.MARK in said and said & {Term.CUT, Term.BORDER}:
        said = said - {Term.CUT, Term.BORDER} | {Term.REGISTRATION}
    if Term.EDGE in said and (Term.PAPER in said or terms.count(Term.EDGE) > 1):  # "outer edge"
        said.add(Term.BORDER)
    if Term.PATTERN in said:
        said -= _CREASES | {Term.CUT}  # of the whole drawing
    if Term.STYLE in said:
        said.discard(Term.BORDER)  # "border-radius"
    return said - {Term.HALF, Term.MARK, Term.EDGE, Term.PAPER, Term.PATTERN, Term.STYLE, Term.PLAIN}


def _unescape(match: re.Match[str]) -> str:
    letter = chr(int(match.group(1), 16))
    return letter if letter.isprintable() else " "


def _plain(text: str) -> str:
    """Without accents; the marks of Japanese letters stay."""
    parts = unicodedata.normalize("NFKD", text)
    return unicodedata.normalize("NFC", re.sub("[\u0300-\u036f]", "", parts))


def _words(text: str) -> Iterator[str]:
    for run in _SPLIT.findall(_plain(text.replace("'", "").replace("’", " "))):
        for part in _CAMEL.split(run):
            yield part.casefold()


def _phrases(words: list[str]) -> Iterator[str]:
    """The words, with two put together where that is a word of its own: "mi chair", "fond perdu", "cut out"."""
    if words[-1:] == ["no"]:
        words = words[:-1]  # "fold no. 3" denies nothing
    start = 0
    while start < len(words):
        pair = "".join(words[start : start + 2])
        long = pair in _LEXICON
        yield pair if long else words[start]
        start += 2 if long else 1


def _terms(word: str) -> list[Term]:
    """What a word is about; several for one written together, none for an unknown one."""
    term = _LEXICON.get(word)
    if term is not None:
        return [term]
    if "\u3040" <= word[0] <= "\u9fff":
        return list(_japanese_terms(word))
    parts = _compound(word) if len(word) <= _MAX_COMPOUND else None
    if parts is not None:
        return parts
    # These two are long enough to be meant wherever they are found.
    return [term for key, term in (("mountain", Term.MOUNTAIN), ("valley", Term.VALLEY)) if key in word]


def _compound(word: str) -> list[Term] | None:
    """The parts of a word that known ones were written together to; longer parts first."""
    ways: list[list[Term] | None] = [None] * len(word) + [[]]
    for start in range(len(word) - _SHORTEST, -1, -1):
        for end in range(min(len(word), start + _LONGEST), start + _SHORTEST - 1, -1):
            rest = ways[end]
            term = _PARTS.get(word[start:end]) if rest is not None else None
            if term is not None and rest is not None:
                ways[start] = [term, *rest]
                break
    return ways[0]


def _japanese_terms(word: str) -> Iterator[Term]:
    start = 0
    while start < len(word):
        for length in range(_LONGEST_JAPANESE, 0, -1):
            term = _JAPANESE_PARTS.get(word[start : start + length])
            if term is not None:
                yield term
                start += length
                break
        else:
            start += 1


def _entries(table: dict[Term, str]) -> dict[str, Term]:
    return {_plain(word): term for term, words in table.items() for word in words.split()}


def _forms(word: str) -> Iterator[str]:
    """The word last, so that it is not taken for a form of another one."""
    yield f"{word}s"
    if word.endswith("e"):
        yield f"{word}n"
    if word.endswith("ung"):
        yield f"{word}en"
    yield word


_PARTS = {form: term for word, term in _entries(_COMPOUNDED).items() for form in _forms(word)}
_LEXICON = {**_PARTS, **_entries(_WHOLE)}
_SHORTEST = min(map(len, _PARTS))
_LONGEST = max(map(len, _PARTS))
_JAPANESE_PARTS = _entries(_JAPANESE)
_LONGEST_JAPANESE = max(map(len, _JAPANESE_PARTS))
