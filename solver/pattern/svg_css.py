"""What style sheets, style= and presentation attributes say of an element: the cascade (CSS Cascade 4).

A declaration that is not understood is passed over, so that an earlier one stands, as in browsers.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from ..errors import ReadError
from .css_syntax import split_declarations, split_parts, split_rules, without_comments
from .svg_colours import parse_colour, parse_paint
from .svg_selectors import Budget, Selector, parse_selectors
from .svg_transforms import css_origin, css_rotate, css_scale, css_transform, css_translate
from .svg_values import SvgValueError, parse_length
from .svg_xml import Node

#: Characters of one property. Only transforms and path data come anywhere near.
MAX_PROPERTY = 10_000
#: Rules of all style sheets, every selector counted: a few hundred in real ones.
MAX_RULES = 20_000
#: Depth of @media and @supports in each other.
_MAX_AT_RULES = 10
#: Looks that are kept to be used again, of each kind; real drawings have some dozens. Each takes a few kilobytes.
MAX_KEPT = 2_000

#: Values that CSS knows for every property.
WIDE = frozenset({"inherit", "initial", "unset", "revert", "revert-layer"})
#: Shapes' own measures, which SVG 2 lets style sheets set.
MEASURES = frozenset({"x", "y", "width", "height", "cx", "cy", "r", "rx", "ry"})
_BOXES = frozenset({"view-box", "fill-box", "stroke-box", "content-box", "border-box"})


def _is_number(text: str) -> object:
    length = parse_length(text)
    if length.unit not in ("", "%"):
        raise SvgValueError(f"{text[:40]!r} is not a number")
    return length


def _is_measure(text: str) -> object:
    return text.lower() == "auto" or parse_length(text)


def _is_width(text: str) -> object:
    if parse_length(text).pixels < 0.0:
        raise SvgValueError(f"{text[:40]!r} is not a width")
    return True


def _is_dashes(text: str) -> object:
    return text.lower() == "none" or [parse_length(part) for part in text.replace(",", " ").split()]


def _is_one_of(*words: str) -> Callable[[str], object]:
    def check(text: str) -> object:
        if text.lower() not in words:
            raise SvgValueError(f"{text[:40]!r} is not one of {', '.join(words)}")
        return True

    return check


def _is_path(text: str) -> object:
    if css_path(text) is None:
        raise SvgValueError(f"{text[:40]!r} is not a path")
    return True


def css_path(text: str) -> str | None:
    """The path data in ``path("...")``, empty for ``none``, None for anything else."""
    match = re.fullmatch(r"(?:path\(\s*(?:\w+\s*,\s*)?(?:\"([^\"]*)\"|'([^']*)')\s*\)|none)", text.strip())
    return None if match is None else (match.group(1) or match.group(2) or "")


def _anything(_text: str) -> object:
    return True


#: Property -> what raises SvgValueError (or another ValueError) on values that it cannot have.
_CHECKS: dict[str, Callable[[str], object]] = {
    "stroke": parse_paint,
    "fill": parse_paint,
    "color": parse_colour,
    "visibility": _is_one_of("visible", "hidden", "collapse"),
    "stroke-width": _is_width,
    "stroke-dasharray": _is_dashes,
    "stroke-opacity": _is_number,
    "fill-opacity": _is_number,
    "opacity": _is_number,
    "display": _anything,
    "clip-path": _anything,
    "mask": _anything,
    "transform": css_transform,
    "transform-origin": lambda text: css_origin(text, (0.0, 0.0, 1.0, 1.0)),
    "transform-box": _is_one_of(*_BOXES),
    "translate": lambda text: text.lower() == "none" or css_translate(text),
    "rotate": lambda text: text.lower() == "none" or css_rotate(text),
    "scale": lambda text: text.lower() == "none" or css_scale(text),
    **dict.fromkeys(MEASURES, _is_measure),
    "d": _is_path,
}
#: Properties that are attributes as well. Measures and ``transform`` have a syntax of their own as attributes.
_ATTRIBUTES = frozenset(_CHECKS) - MEASURES - {"d", "transform", "translate", "rotate", "scale"}


@dataclass(frozen=True, eq=False)
class Declarations:
    """The declarations of one rule, one style attribute or one element's attributes, later ones winning.

    normal, important  property -> value; properties with "--" are the file's own
    unknown            property -> a value of it that is not understood
    """

    normal: Mapping[str, str]
    important: Mapping[str, str]
    unknown: Mapping[str, str]


def parse_declarations(text: str) -> Declarations:
    """``"stroke: red; fill:none !important"``, what is not understood set apart."""
    return _checked(split_declarations(text))


def _checked(declared: Iterable[tuple[str, str, bool]]) -> Declarations:
    normal: dict[str, str] = {}
    important: dict[str, str] = {}
    unknown: dict[str, str] = {}
    for name, value, is_important in declared:
        if not name.startswith("--"):
            if name not in _CHECKS:
                continue
            if not understood(name, value):
                unknown[name] = value
                continue
        (important if is_important else normal)[name] = value
    return Declarations(normal, important, unknown)


def understood(name: str, value: str) -> bool:
    """Whether ``value`` is one that the property ``name`` can have; with var() that is seen later."""
    if len(value) > MAX_PROPERTY:
        raise ReadError(f"{name} has more than {MAX_PROPERTY:,} characters")
    if "var(" in value.lower() or value.lower() in WIDE:
        return True
    if not value:
        return False
    try:
        _CHECKS[name](value)
    except (ValueError, ArithmeticError):
        return False
    return True


@dataclass(frozen=True, eq=False)
class _Rule:
    selector: Selector
    order: tuple[int, int, int, int]  # specificity, then the place in the file
    declarations: Declarations


@dataclass(frozen=True, eq=False)
class Style:
    """What is said of one element, before anything is inherited: property -> value.

    unknown  property -> what is said of it but not understood, where nothing that is understood is said
    """

    values: Mapping[str, str]
    unknown: Mapping[str, str]


class Stylesheet:
    """All <style> elements of a drawing.

    skipped  rules that are left out, for the notes
    ignored  declarations that are not understood, for the notes
    """

    def __init__(self, root: Node) -> None:
        self.skipped: list[str] = []
        self.ignored: dict[str, None] = {}
        self._by_key: dict[str, list[_Rule]] = {}
        self._rules = 0
        self._budget = Budget()
        self._texts: dict[str, Declarations] = {}
        self._matched: dict[object, tuple[_Rule, ...]] = {}
        self._styles: dict[object, Style] = {}
        for node in root.walk():
            if node.tag == "style" and _is_css(node):
                if not _is_for_screens(node.attributes.get("media", "")):
                    self.skipped.append(f"<style media={node.attributes['media'][:40]!r}>")
                    continue
                self._read(without_comments(node.text), 0)
        rules = [rule for rules in self._by_key.values() for rule in rules]
        #: Whether type, id and classes of an element alone decide which rules it has.
        self._local = all(rule.selector.local for rule in rules)
        #: Whether in addition nothing but its parent matters.
        self._nested = all(
            not compound.tests and "+" not in rule.selector.combinators and "~" not in rule.selector.combinators
            for rule in rules
            for compound in rule.selector.chain
        )
        self._ids = frozenset(
            compound.identity for rule in rules for compound in rule.selector.chain if compound.identity
        )

    def _read(self, text: str, depth: int) -> None:
        for head, body in split_rules(text):
            if not head.startswith("@"):
                if body is not None:
                    self._add(head, parse_declarations(body))
                continue
            name = re.split(r"[\s(]", head, maxsplit=1)[0].lower()
            rest = head[len(name) :]
            taken = _is_for_screens(rest) if name == "@media" else name == "@supports" and _is_supported(rest)
            if taken and body is not None and depth < _MAX_AT_RULES:
                self._read(body, depth + 1)
            elif name not in ("@font-face", "@charset", "@namespace", "@page", "@keyframes"):
                self.skipped.append(head.split("\n")[0][:40])

    def _add(self, text: str, declarations: Declarations) -> None:
        selectors = parse_selectors(text)
        if selectors is None:
            # A browser drops a whole list for one selector that it does not know, but these it would know.
            selectors = [found for part in split_parts(text, ",") for found in parse_selectors(part) or []]
            self.skipped.append(text[:40])
        for selector in selectors:
            self._rules += 1
            if self._rules > MAX_RULES:
                raise ReadError(f"the drawing's style sheet has more than {MAX_RULES:,} rules")
            rule = _Rule(selector, (*selector.specificity, self._rules), declarations)
            self._by_key.setdefault(selector.key, []).append(rule)

    def style(self, node: Node) -> Style:
        """What is said of ``node``. Equal elements get the same object. Raises ReadError."""
        rules = self._rules_of(node)
        attributes = node.attributes
        presentation = tuple(item for item in attributes.items() if item[0] in _ATTRIBUTES)
        inline = attributes.get("style", "")
        key = (rules, presentation, inline)
        known = self._styles.get(key)
        if known is None:
            try:
                known = self._cascade(rules, presentation, inline)
            except ReadError as error:
                raise ReadError(error.message, element=str(node)) from error
            if len(self._styles) > MAX_KEPT:
                self._styles.clear()
            self._styles[key] = known
        return known

    def _rules_of(self, node: Node) -> tuple[_Rule, ...]:
        """The rules that match ``node``, the weakest first."""
        if not self._by_key:
            return ()
        identity = node.attributes.get("id", "")
        identity = identity if identity in self._ids else ""
        place = None if self._local else node.parent if self._nested else node
        key = (place, node.tag, identity, node.attributes.get("class", ""))
        known = self._matched.get(key)
        if known is None:
            keys = ["", node.tag] if node.tag else [""]
            keys += ["#" + identity] if identity else []
            keys += ["." + name for name in set(node.classes)]
            candidates = [rule for each in keys for rule in self._by_key.get(each, ())]
            matching = [rule for rule in candidates if rule.selector.matches(node, self._budget)]
            known = tuple(sorted(matching, key=lambda rule: rule.order))
            if place is not node:
                if len(self._matched) > MAX_KEPT:
                    self._matched.clear()
                self._matched[key] = known
        return known

    def _cascade(self, rules: tuple[_Rule, ...], presentation: tuple[tuple[str, str], ...], inline: str) -> Style:
        layers = [_checked((name, value.strip(), False) for name, value in presentation)]
        layers += [rule.declarations for rule in rules]
        if inline:
            declarations = self._texts.get(inline)
            if declarations is None:
                if len(self._texts) > MAX_KEPT:
                    self._texts.clear()
                declarations = self._texts[inline] = parse_declarations(inline)
            layers.append(declarations)
        values: dict[str, str] = {}
        unknown: dict[str, str] = {}
        for layer in layers:
            values.update(layer.normal)
            for name, value in layer.unknown.items():
                unknown[name] = value
                self.ignored.setdefault(f"{name}: {value[:40]}")
        for layer in layers:
            values.update(layer.important)
        return Style(values, {name: value for name, value in unknown.items() if name not in values})


def _is_css(node: Node) -> bool:
    return node.attributes.get("type", "text/css").strip().lower().partition(";")[0] in ("", "text/css")


_FEATURE = re.compile(r"\(\s*([-\w]+)\s*:\s*([-\w]+)\s*\)")
#: Questions about the screen with the answer that is taken for true; others are about its size.
_FEATURES = {"prefers-color-scheme": "light", "prefers-contrast": "no-preference", "update": "fast"}


def _is_for_screens(query: str) -> bool:
    """Whether a media query holds on an ordinary screen; one about its size does not."""
    parts = [part.strip().lower() for part in query.split(",")]
    return any(_holds_on_screens(part) for part in parts) or not query.strip()


def _holds_on_screens(query: str) -> bool:
    negated = query.startswith("not ")
    terms = re.split(r"\s+and\s+", query.removeprefix("not ").removeprefix("only ").strip())

    def holds(term: str) -> bool:
        match = _FEATURE.fullmatch(term)
        return term in ("all", "screen") or (match is not None and _FEATURES.get(match[1]) == match[2])

    return all(holds(term) for term in terms) != negated


def _is_supported(condition: str) -> bool:
    """Whether all that an @supports rule asks for are declarations that are understood."""
    text = condition.strip()
    if re.search(r"\bnot\b|\bor\b|selector\(", text.lower()):
        return False
    asked = re.findall(r"\(\s*([-\w]+)\s*:\s*((?:[^()]|\([^()]*\))+)\)", text)
    return bool(asked) and all(
        name.lower() not in _CHECKS or understood(name.lower(), value) for name, value in asked
    )
