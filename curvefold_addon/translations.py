"""The tab's main buttons and sentences in other languages, as far as somebody has put them there.

What is missing stays English. Whole sentences are looked up before they are broken into lines (``say``).
"""

import bpy

from . import wording

#: English, German, Japanese.
_TEXTS = (
    ("Paper Sheet", "Papierbogen", "用紙"),
    ("Drawing…", "Zeichnung …", "図面…"),
    ("Samples", "Beispiele", "サンプル"),
    ("Sheet from Object", "Bogen aus Objekt", "オブジェクトから用紙"),
    ("Draw Crease", "Falz zeichnen", "折り線を描く"),
    ("Make Crease", "Zum Falz machen", "折り線にする"),
    ("Selected creases fold to", "Gewählte Falze werden zu", "選択した折り線の種類"),
    ("Valley", "Tal", "谷折り"),
    ("Mountain", "Berg", "山折り"),
    ("Flat", "Flach", "平ら"),
    ("Free", "Frei", "自由"),
    ("Make Paper", "Papier machen", "紙を作成"),
    ("Another Paper", "Noch ein Papier", "別の紙を作成"),
    ("Back to the Paper", "Zurück zum Papier", "紙に戻る"),
    ("Show Drawing", "Zeichnung", "図面を表示"),
    ("Edit", "Bearbeiten", "編集"),
    ("Edit Drawing", "Zeichnung bearbeiten", "図面を編集"),
    ("Fold", "Falten", "折る"),
    ("Live", "Live", "ライブ"),
    ("Flatten", "Flach legen", "平らにする"),
    ("Fold Anew", "Neu falten", "折り直す"),
    ("Place Handles", "Griffe setzen", "ハンドルを配置"),
    ("Restore the Paper", "Papier wiederherstellen", "紙を復元"),
    ("Make Ordinary Mesh", "Gewöhnliches Mesh daraus machen", "通常のメッシュにする"),
    ("Check Paper", "Papier prüfen", "紙を検査"),
    ("Handles", "Griffe", "ハンドル"),
    ("Creases", "Falze", "折り線"),
    ("Joints", "Verbindungen", "接合"),
    ("Import Notes", "Hinweise zum Import", "読み込みの注記"),
    ("At Vertices", "An Punkten", "頂点に"),
    ("Hook Selected", "Anhängen", "選択をフック"),
    ("Settled", "In Ruhe", "静止"),
    ("Folding…", "Faltet …", "折っています…"),
    (
        wording.NO_SHEET,
        "Beginne mit einem Bogen Papier, einem Beispiel oder einer Zeichnung",
        "用紙、サンプル、または図面から始めます",
    ),
    (
        wording.NO_CREASE,
        "Zeichne Falze darauf: Kurven, an denen sich das Papier faltet",
        "折り線を描きます。紙はこの曲線に沿って折れます",
    ),
    (
        wording.DRAWING,
        "Zeichne von Rand zu Rand, oder bearbeite die Punkte; Tab beendet es",
        "端から端まで描くか、点を編集します。Tab で終了",
    ),
    (wording.READY, "Papier machen macht daraus einen Bogen, der sich faltet", "「紙を作成」で折れる紙になります"),
    (
        wording.NEXT,
        "Schiebe Falten, oder setze Griffe und ziehe sie",
        "「折る」を動かすか、ハンドルを配置して引きます",
    ),
    (wording.NEXT_BLANK, "Setze Griffe und ziehe sie", "ハンドルを配置して引きます"),
    (wording.NOT_LIVE, "Nicht live: es bleibt, wie es ist", "ライブではありません。形は変わりません"),
    (wording.BAKED, "Gebacken: es spielt seine Shape Keys", "ベイク済み: シェイプキーを再生します"),
)

#: Where Blender looks words up: those of properties and labels, those of operators, and those that mean something
#: else elsewhere in Blender.
_CONTEXTS = ("*", "Operator", wording.CONTEXT)


def _of_language(column: int) -> dict[tuple[str, str], str]:
    return {(context, row[0]): row[column] for row in _TEXTS for context in _CONTEXTS}


def register() -> None:
    bpy.app.translations.register(__package__, {"de": _of_language(1), "ja": _of_language(2)})


def unregister() -> None:
    bpy.app.translations.unregister(__package__)
