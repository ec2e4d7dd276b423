"""What a stroke means: by its colour, then its class, then its group or layer, then its dashes."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .stroke import Decision, Role
from .svg_values import Colour
from .svg_walk import Drawn

#: Less colour than this is grey. Illustrator's rich black #231F20 has 0.016, a pale pink #FFD0D0 0.18.
MIN_CHROMA = 0.12
#: Greys lighter than this are "clearly lighter" than black: above #737373, so that #808080 (ORIPA) is.
MIN_GREY = 0.45

#: (from, to, role), degrees on the colour wheel, around the exact colours of Origami Simulator and ORIPA.
#: The gaps (orange, cyan, violet) say nothing, so that class, group and dashes are asked.
_HUES = (
    (0.0, 25.0, Role.MOUNTAIN),
    (45.0, 70.0, Role.FACET),
    (80.0, 165.0, Role.CUT),
    (195.0, 265.0, Role.VALLEY),
    (285.0, 330.0, Role.CREASE),
    (338.0, 360.0, Role.MOUNTAIN),
)

#: Beginnings of words, in the order they are looked for: "mountain_fold" is a mountain before it is a fold.
#: Mitani's files, which many people fold from, use the Japanese words.
_WORDS: tuple[tuple[Role, tuple[str, ...]], ...] = (
    (Role.FACET, ("facet", "aux", "auxil", "ruling", "hidden", "helper", "guide", "construction", "補助")),
    (Role.HOLE, ("hole", "opening", "穴")),
    (Role.CUT, ("cut", "slit", "切")),
    (Role.BORDER, ("border", "boundary", "outline", "contour", "perimeter", "輪郭")),
    (Role.CREASE, ("fold", "crease", "score", "scoring", "bend", "undriven", "unassigned", "hinge", "折")),
)
_MOUNTAIN = ("mountain", "mtn", "山")
_VALLEY = ("valley", "谷")
#: Words that only look like one of the above.
_NOT_WORDS = frozenset({"cute", "outliner", "folder", "folders", "guided"})
_SPLIT = re.compile(r"[^\W\d_]+")
_CAMEL = re.compile(r"(?<=[^\W\d_A-Z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{2,4})_")  # Illustrator's way to write a blank in an id


def classify(shape: Drawn) -> Decision:
    """The role of a stroked shape on its own, without looking at the rest of the drawing."""
    colour = shape.stroke
    assert colour is not None
    hue = hue_role(colour)
    shown = f"of colour {colour.hex}"
    if hue is not None:
        return Decision(hue, "hue", shown)
    for why, texts in (("class", shape.classes), ("group or layer name", shape.names)):
        for text in texts:
            role = word_role(text)
            if role is not None:
                return Decision(role, why, f"{shown} named {text[:60]!r}")
    role = dash_role(shape.dashes)
    if role is not None:
        kind = "dash-dot" if role is Role.MOUNTAIN else "dashed"
        return Decision(role, "dash pattern", f"{shown}, {kind},")
    if colour.chroma >= MIN_CHROMA:
        return Decision(Role.CREASE, "a colour without a meaning", shown)
    if colour.lightness >= MIN_GREY:
        return Decision(Role.PALE, "grey", shown)
    return Decision(Role.DARK, "black", shown)


def hue_role(colour: Colour) -> Role | None:
    """The role of a colour; None for greys and for hues that have no meaning."""
    if colour.chroma < MIN_CHROMA:
        return None
    for low, high, role in _HUES:
        if low <= colour.hue <= high:
            return role
    return None


def word_role(text: str) -> Role | None:
    """The role that a class, id or layer name tells, or None.

    >>> word_role("MountainLine"), word_role("valley_folds-2"), word_role("Layer 1")
    (<Role.MOUNTAIN: 'mountain crease'>, <Role.VALLEY: 'valley crease'>, None)
    """
    text = _ESCAPE.sub(" ", text[:200])
    if text.strip() in ("M", "m"):
        return Role.MOUNTAIN
    if text.strip() in ("V", "v"):
        return Role.VALLEY
    words = [part.lower() for whole in _SPLIT.findall(text) for part in _CAMEL.split(whole)]
    words = [word for word in words if word not in _NOT_WORDS]
    # Mountain and valley are long enough to be found inside a word ("foldmountain").
    mountain = any(key in word for word in words for key in _MOUNTAIN)
    valley = any(key in word for word in words for key in _VALLEY)
    if mountain or valley:
        return Role.CREASE if mountain and valley else Role.MOUNTAIN if mountain else Role.VALLEY
    for role, keys in _WORDS:
        if any(word.startswith(key) for word in words for key in keys):
            return role
    return None


def dash_role(dashes: Sequence[float]) -> Role | None:
    """Dash-dot (dashes of two lengths) is mountain, plain dashes are valley: Yoshizawa and Randlett."""
    if not dashes:
        return None
    # An odd list is used twice, as SVG says, so that dashes stand at even places.
    strokes = list(dashes if len(dashes) % 2 == 0 else [*dashes, *dashes])[::2]
    return Role.MOUNTAIN if max(strokes) > 1.5 * min(strokes) else Role.VALLEY
