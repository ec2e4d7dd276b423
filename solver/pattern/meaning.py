"""What each line of a drawing means, whatever its format: explicit words beat dashes, dashes beat colours.

All lines are looked at together: a name that all of them share distinguishes nothing, nor do dashes of all creases.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from .stroke import CREASE_ROLES, EDGE_ROLES, Decision, Role
from .svg_values import Colour
from .words import Letters, Saying, linetype_dashes, read_name

#: Less colour than this is grey. Illustrator's rich black #231F20 has 0.016, a pale pink #FFD0D0 0.18.
MIN_CHROMA = 0.12
#: Greys lighter than this are "clearly lighter" than black: above #737373, so that #808080 (ORIPA) is.
MIN_GREY = 0.45
#: Names of one line with its groups that are looked at, the line's own first.
MAX_WORDS = 100

#: (from, to, role), degrees on the colour wheel, around the exact colours of Origami Simulator and ORIPA.
#: The gaps (orange, cyan, violet) say nothing.
_HUES = (
    (0.0, 25.0, Role.MOUNTAIN),
    (45.0, 70.0, Role.FACET),
    (80.0, 165.0, Role.CUT),
    (195.0, 265.0, Role.VALLEY),
    (285.0, 330.0, Role.CREASE),
    (338.0, 360.0, Role.MOUNTAIN),
)
_SIDES = frozenset({Role.MOUNTAIN, Role.VALLEY})
_WITH_ARTICLE = {
    Role.MOUNTAIN: "a mountain crease",
    Role.VALLEY: "a valley crease",
    Role.CREASE: "an unassigned crease",
    Role.CUT: "a cut",
    Role.FACET: "a facet line",
}
#: Evidence of these kinds has rules of its own; any other kind is a name.
_LINETYPES = frozenset({"linetype", "data-linetype"})
_LETTERS = {
    "id": Letters.NONE,
    "data-assignment": Letters.NUMBERS,
    **dict.fromkeys(("data-type", "data-kind", "data-role", "data-fold", "type"), Letters.ALL),
}


@dataclass(frozen=True)
class Evidence:
    """What a file says about one line.

    colour  None when it has none
    dashes  dash and gap lengths, empty for a solid line
    words   (kind, text), most specific first: names, classes, layers, data. The kind is what notes give as the
            reason. "linetype" is the name of a dash pattern, an "id" is no letter of FOLD, since lines are also
            counted a, b, c.
    """

    colour: Colour | None
    dashes: tuple[float, ...]
    words: tuple[tuple[str, str], ...]


def classify_all(evidence: Sequence[Evidence]) -> list[Decision]:
    """The role of each line of a drawing, in order, with the reason."""
    return _Drawing(evidence).decisions()


def hue_role(colour: Colour | None) -> Role | None:
    """The role of a colour; None for greys and for hues that have no meaning."""
    if colour is None or colour.chroma < MIN_CHROMA:
        return None
    for low, high, role in _HUES:
        if low <= colour.hue <= high:
            return role
    return None


def dash_role(dashes: Sequence[float]) -> Role | None:
    """Dash-dot (dashes of two lengths) is mountain, plain dashes and dots are valley: Yoshizawa and Randlett."""
    if not dashes:
        return None
    # An odd list is used twice, as SVG says, so that dashes stand at even places.
    strokes = list(dashes if len(dashes) % 2 == 0 else [*dashes, *dashes])[::2]
    return Role.MOUNTAIN if max(strokes) > 1.5 * min(strokes) else Role.VALLEY


@dataclass(frozen=True)
class _Look:
    """One line without its names: what its colour and its dashes each say alone."""

    colour: Colour | None
    hue: Role | None
    dash: Role | None

    @property
    def plain(self) -> Role:
        """The role of a solid line of this colour."""
        if self.hue is not None:
            return self.hue
        if self.colour is None:
            return Role.DARK
        if self.colour.chroma >= MIN_CHROMA:
            return Role.CREASE
        return Role.PALE if self.colour.lightness >= MIN_GREY else Role.DARK

    @property
    def side(self) -> Role | None:
        return self.hue if self.hue in _SIDES else None

    @property
    def kind(self) -> tuple[Role, Role | None]:
        """Lines of one kind look alike."""
        return self.plain, self.dash


class _Drawing:
    """The decisions about the lines of one drawing. Not reusable."""

    def __init__(self, evidence: Sequence[Evidence]) -> None:
        self._looks = [_look(line) for line in evidence]
        sayings = _Sayings(evidence)
        self._said = [sayings.of(line) for line in evidence]
        self._silence_containers()
        self._chosen = [_first(said) for said in self._said]
        self._silence_common()
        self._frame_as_border()
        self._dashes = _DashRule(
            look
            for look, chosen in zip(self._looks, self._chosen, strict=True)
            if chosen is None or chosen[1].role is Role.CREASE
        )

    def decisions(self) -> list[Decision]:
        told = [self._dashes.decide(look) for look in self._looks]
        sided = self._sided_names(told)
        return [
            look_decision if chosen is None else _named(look, chosen, look_decision, chosen[1].key in sided)
            for look, chosen, look_decision in zip(self._looks, self._chosen, told, strict=True)
        ]

    def _silence_containers(self) -> None:
        """Names such as "page" or "print" only mean the lines themselves if these look alike."""
        looks = defaultdict(set)
        for look, said in zip(self._looks, self._said, strict=True):
            for _, saying in said:
                if saying.weak:
                    looks[saying].add(look.kind)
        self._silence({saying for saying, kinds in looks.items() if len(kinds) > 1})

    def _silence_common(self) -> None:
        """A drawing without any line that is folded or cut, or one of a single name, cannot be meant so."""
        left_out = {Role.ASIDE, Role.FACET}
        if all(chosen is not None and chosen[1].role in left_out for chosen in self._chosen):
            self._silence({saying for said in self._said for _, saying in said if saying.role in left_out})
            self._chosen = [_first(said) for said in self._said]
        kept = [i for i, chosen in enumerate(self._chosen) if chosen is None or chosen[1].role not in left_out]
        if len({self._looks[i].kind for i in kept}) < 2:
            return
        common = {saying for _, saying in self._said[kept[0]]}
        for i in kept:
            if not common:
                return
            common &= {saying for _, saying in self._said[i]}
        self._silence(common)
        self._chosen = [_first(said) for said in self._said]

    def _silence(self, sayings: set[Saying]) -> None:
        if sayings:
            self._said = [
                tuple((why, saying) for why, saying in said if saying not in sayings) for said in self._said
            ]

    def _frame_as_border(self) -> None:
        """Where nothing else could be the border, the frame or page that is drawn is the sheet."""
        possible = EDGE_ROLES | {Role.DARK, Role.PALE}
        roles = (
            look.plain if chosen is None else chosen[1].role
            for look, chosen in zip(self._looks, self._chosen, strict=True)
        )
        if any(role in possible for role in roles):
            return
        self._chosen = [
            (chosen[0], replace(chosen[1], role=Role.BORDER, word=""))
            if chosen is not None and chosen[1].frame
            else chosen
            for chosen in self._chosen
        ]

    def _sided_names(self, told: list[Decision]) -> set[str]:
        """Names that just say "crease" of lines of both sides: their looks say which is which.

        Where all lines of a name look the same, the look is that of the layer and says nothing about sides.
        """
        sides = defaultdict(set)
        for chosen, decision in zip(self._chosen, told, strict=True):
            if chosen is not None and chosen[1].role is Role.CREASE and decision.role in _SIDES:
                sides[chosen[1].key].add(decision.role)
        return {key for key, roles in sides.items() if len(roles) > 1}


class _DashRule:
    """What dashes say in a drawing with these lines, of which names say nothing or just that they are creases.

    Dashes tell the sides only where they distinguish creases. In a drawing of dashed red and dashed blue lines they
    say that these are creases, and the colours say the sides.
    """

    def __init__(self, looks: Iterable[_Look]) -> None:
        kinds = {(look.dash, look.side) for look in looks if look.dash is not None or look.side is not None}
        hues = defaultdict(set)
        for dash, side in kinds:
            hues[dash].add(side)
        both = {side for _, side in kinds} >= _SIDES
        mixed = any(sides >= _SIDES for sides in hues.values())
        # One pattern beside solid lines may go against the colours and make all of them one side.
        told = {dash or side for dash, side in kinds if side is not None}
        collapsed = both and len(told) < 2 and not hues.keys() >= _SIDES
        self._tell = len(hues) > 1 and not mixed and not collapsed
        # Among lines without such a colour they may still tell sides, if there are two patterns.
        colourless = {dash for dash, side in kinds if side is None}
        self._tell_colourless = not both or colourless >= _SIDES

    def decide(self, look: _Look) -> Decision:
        """The role of a line by its look alone."""
        if look.dash is None:
            return _coloured(look)
        if self._tell:
            return _dashed(look, look.dash)
        if look.side is not None:
            return _coloured(look)
        if self._tell_colourless:
            return _dashed(look, look.dash)
        # Colours say the sides, and these are other lines beside: yellow and grey stay what they are.
        return _coloured(look) if look.plain in (Role.FACET, Role.PALE) else _dashed(look, Role.CREASE)


class _Sayings:
    """What the names of a drawing say; each name is read once."""

    def __init__(self, evidence: Sequence[Evidence]) -> None:
        names = {name for line in evidence for name in line.words[:MAX_WORDS]}
        # Letters such as B and C name layers only beside M or V.
        sides = any(text.strip() in ("M", "V", "m", "v") for _, text in names)
        layers = Letters.ALL if sides else Letters.SIDES
        self._said: dict[tuple[str, str], Saying] = {}
        for why, text in names:
            if why in _LINETYPES and linetype_dashes(text) is not None:
                continue
            saying = read_name(text, _LETTERS.get(why, layers))
            if saying is not None:
                self._said[why, text] = saying

    def of(self, line: Evidence) -> tuple[tuple[str, Saying], ...]:
        """(kind, saying) of the names that say something, in order."""
        said = self._said
        return tuple((name[0], said[name]) for name in line.words[:MAX_WORDS] if name in said)


def _look(line: Evidence) -> _Look:
    dashes = line.dashes
    if not dashes:
        types = (linetype_dashes(text) for why, text in line.words[:MAX_WORDS] if why in _LINETYPES)
        dashes = next((named for named in types if named is not None), ())
    return _Look(line.colour, hue_role(line.colour), dash_role(dashes))


def _first(said: tuple[tuple[str, Saying], ...]) -> tuple[str, Saying] | None:
    """The most specific name that says something. One that just says "crease" leaves the side to the next."""
    if not said:
        return None
    if said[0][1].role is Role.CREASE:
        return next((named for named in said if named[1].role in _SIDES), said[0])
    return said[0]


# ---- decisions with their words


def _named(look: _Look, chosen: tuple[str, Saying], told: Decision, sided: bool) -> Decision:
    why, saying = chosen
    name = f"named {saying.shown!r}"
    if sided and saying.role is Role.CREASE and told.role in _SIDES:
        return replace(told, detail=f"{told.detail}, {name}")
    return Decision(saying.role, why, _shown(look, saying.role, f" {name}", "but "), saying.word)


def _coloured(look: _Look) -> Decision:
    if look.hue is not None:
        return Decision(look.hue, "hue", _shown(look, look.hue))
    why = {Role.CREASE: "a colour without a meaning", Role.PALE: "grey", Role.DARK: "black"}[look.plain]
    return Decision(look.plain, why if look.colour is not None else "no colour", _shown(look, look.plain))


def _dashed(look: _Look, role: Role) -> Decision:
    kind = "dash-dot" if look.dash is Role.MOUNTAIN else "dashed"
    return Decision(role, "dash pattern", _shown(look, role, f", {kind}", "but "))


def _shown(look: _Look, role: Role, more: str = "", but: str = "") -> str:
    colour = "without a colour" if look.colour is None else f"of colour {look.colour.hex}"
    if look.hue is None or _agree(role, look.hue):
        return colour + more
    more = more.removeprefix(",").lstrip()
    return f"{colour}, which alone would mean {_WITH_ARTICLE[look.hue]}, {but}{more}"


def _agree(role: Role, hue: Role) -> bool:
    if role is hue or (hue is Role.CUT and role in EDGE_ROLES):
        return True
    return (hue is Role.CREASE and role in CREASE_ROLES) or (hue is Role.FACET and role is Role.ASIDE)
