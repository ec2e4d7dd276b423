"""CSS selectors (Selectors 3, with :is and :where) against the tree of an SVG file."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from ..errors import ReadError
from .css_syntax import split_parts, unescape
from .svg_xml import Node

#: Compounds of one selector, and characters of it.
MAX_CHAIN = 10
MAX_SELECTOR = 1_000
#: Comparisons of one element with one part of a selector, over a whole file: a few seconds. Above it the file was
#: made to stall a reader.
MAX_MATCHES = 2_000_000

_NAME = r"(?:[-\w\u0080-\U0010ffff]|\\[0-9a-fA-F]{1,6}\s?|\\[^\n0-9a-fA-F])+"
_COMBINATOR = re.compile(r"\s*([>+~])\s*|\s+")
_TYPE = re.compile(rf"(?:(?:{_NAME}|\*)?\|)?({_NAME}|\*)")
_HASH_OR_CLASS = re.compile(rf"([.#])({_NAME})")
_ATTRIBUTE = re.compile(
    rf"\[\s*(?:(?:{_NAME}|\*)?\|)?({_NAME})\s*(?:([~|^$*]?=)\s*(?:\"([^\"]*)\"|'([^']*)'|({_NAME}))\s*([iIsS])?\s*)?\]"
)
_PSEUDO = re.compile(rf"::?({_NAME})")
_NTH = re.compile(r"(?:([-+]?\d*)n\s*(?:([-+])\s*(\d+))?|([-+]?\d+))\Z")
#: True for no element of a drawing that nobody is pointing at.
_NEVER = frozenset(
    {"hover", "active", "focus", "focus-within", "focus-visible", "visited", "link", "any-link", "target"}
    | {"checked", "disabled", "before", "after", "first-line", "first-letter", "selection", "marker"}
)


class Budget:
    """How many comparisons are left, and where elements stand among their siblings."""

    def __init__(self) -> None:
        self._left = MAX_MATCHES
        self._places: dict[Node, dict[Node, int]] = {}

    def spend(self, count: int = 1) -> None:
        """Raises ReadError when there are no more."""
        self._left -= count
        if self._left < 0:
            raise ReadError("the drawing's style sheet has too many rules for its elements")

    def place(self, node: Node) -> int:
        """The place of ``node`` among its parent's children, from 0; 0 for the root."""
        if node.parent is None:
            return 0
        places = self._places.get(node.parent)
        if places is None:
            self.spend(len(node.parent.children))
            places = {child: k for k, child in enumerate(node.parent.children)}
            self._places[node.parent] = places
        return places[node]


#: A condition on one element beyond its type, id and classes.
Test = Callable[[Node, Budget], bool]


@dataclass(frozen=True)
class _Compound:
    """``path.red#top[data-x]``: all parts must hold for one element."""

    tag: str = ""
    identity: str = ""
    classes: frozenset[str] = frozenset()
    tests: tuple[Test, ...] = ()

    def matches(self, node: Node, budget: Budget) -> bool:
        budget.spend()
        if self.tag and self.tag != node.tag:
            return False
        if self.identity and self.identity != node.attributes.get("id"):
            return False
        if self.classes and not self.classes.issubset(node.classes):
            return False
        return all(test(node, budget) for test in self.tests)


@dataclass(frozen=True)
class Selector:
    """A chain of compounds; the last one is the element itself.

    combinators  combinators[k] is what joins chain[k] and chain[k + 1]: " ", ">", "+" or "~"
    specificity  (ids; classes, attributes and pseudo-classes; types)
    local        whether type, id and classes of the element alone decide
    """

    chain: tuple[_Compound, ...]
    combinators: tuple[str, ...]
    specificity: tuple[int, int, int]
    local: bool = field(default=True)

    @property
    def key(self) -> str:
        """What an element must have to be looked at: ``#id``, ``.class``, its type, or nothing in particular."""
        last = self.chain[-1]
        if last.identity:
            return "#" + last.identity
        return "." + min(last.classes) if last.classes else last.tag

    def matches(self, node: Node, budget: Budget) -> bool:
        """Raises ReadError when the budget is spent."""
        return self._matches(node, len(self.chain) - 1, budget)

    def _matches(self, node: Node, last: int, budget: Budget) -> bool:
        if not self.chain[last].matches(node, budget):
            return False
        if last == 0:
            return True
        combinator = self.combinators[last - 1]
        if combinator in (" ", ">"):
            current = node.parent
            while current is not None:
                if self._matches(current, last - 1, budget):
                    return True
                current = None if combinator == ">" else current.parent
            return False
        if node.parent is None:
            return False
        siblings, place = node.parent.children, budget.place(node)
        before = range(place - 1, -1, -1) if combinator == "~" else range(place - 1, max(place - 2, -1), -1)
        return any(self._matches(siblings[k], last - 1, budget) for k in before)


def parse_selectors(text: str, depth: int = 0) -> list[Selector] | None:
    """The selectors of a list with commas, None when one of them is not understood."""
    selectors = [_parse(part.strip(), depth) for part in split_parts(text, ",")]
    known = [selector for selector in selectors if selector is not None]
    return known if len(known) == len(selectors) else None


def _parse(text: str, depth: int) -> Selector | None:
    if not text or len(text) > MAX_SELECTOR or depth > 2:
        return None
    chain: list[_Compound] = []
    combinators: list[str] = []
    ids = classes = types = 0
    position = 0
    while True:
        parsed = _compound(text, position, depth)
        if parsed is None or len(chain) == MAX_CHAIN:
            return None
        compound, (a, b, c), position = parsed
        chain.append(compound)
        ids, classes, types = ids + a, classes + b, types + c
        if position == len(text):
            break
        match = _COMBINATOR.match(text, position)
        if match is None:
            return None
        combinators.append(match.group(1) or " ")
        position = match.end()
    local = len(chain) == 1 and not chain[0].tests
    return Selector(tuple(chain), tuple(combinators), (ids, classes, types), local)


def _compound(text: str, start: int, depth: int) -> tuple[_Compound, tuple[int, int, int], int] | None:
    tag, identity = "", ""
    names: set[str] = set()
    tests: list[Test] = []
    ids = classes = types = 0
    position = start
    if match := _TYPE.match(text, position):
        tag = "" if match.group(1) == "*" else unescape(match.group(1))
        types += bool(tag)
        position = match.end()
    while position < len(text):
        if match := _HASH_OR_CLASS.match(text, position):
            name = unescape(match.group(2))
            if match.group(1) == ".":
                names.add(name)
                classes += 1
            else:
                if identity and identity != name:
                    tests.append(_never)
                identity = name
                ids += 1
        elif match := _ATTRIBUTE.match(text, position):
            tests.append(_attribute(match))
            classes += 1
        elif match := _PSEUDO.match(text, position):
            end, argument = match.end(), ""
            if text[end : end + 1] == "(":
                close = _bracket(text, end)
                if close < 0:
                    return None
                argument, end = text[end + 1 : close], close + 1
            pseudo = _pseudo(unescape(match.group(1)).lower(), argument.strip(), depth)
            if pseudo is None:
                return None
            test, (a, b, c) = pseudo
            tests.append(test)
            ids, classes, types = ids + a, classes + b, types + c
            position = end
            continue
        else:
            break
        position = match.end()
    if position == start:
        return None
    return _Compound(tag, identity, frozenset(names), tuple(tests)), (ids, classes, types), position


def _bracket(text: str, start: int) -> int:
    depth = 0
    for position in range(start, len(text)):
        depth += (text[position] == "(") - (text[position] == ")")
        if depth == 0:
            return position
    return -1


def _never(_node: Node, _budget: Budget) -> bool:
    return False


def _attribute(match: re.Match[str]) -> Test:
    name, operator = unescape(match.group(1)), match.group(2)
    wanted = next((value for value in match.groups()[2:5] if value is not None), "")
    wanted = unescape(wanted)
    if fold := (match.group(6) or "").lower() == "i":
        wanted = wanted.lower()

    def test(node: Node, _budget: Budget) -> bool:
        value = node.attributes.get(name)
        if value is None or operator is None:
            return value is not None
        if fold:
            value = value.lower()
        if operator == "=":
            return value == wanted
        if operator == "|=":
            return value == wanted or value.startswith(wanted + "-")
        if not wanted:
            return False
        if operator == "~=":
            return wanted in value.split()
        if operator == "^=":
            return value.startswith(wanted)
        return value.endswith(wanted) if operator == "$=" else wanted in value

    return test


def _pseudo(name: str, argument: str, depth: int) -> tuple[Test, tuple[int, int, int]] | None:
    one = (0, 1, 0)
    if name in _NEVER:
        return _never, one
    if name == "root":
        return (lambda node, _: node.parent is None), one
    if name == "empty":
        return (lambda node, _: not node.children), one
    if name in ("not", "is", "where", "matches"):
        inner = parse_selectors(argument, depth + 1)
        if inner is None:
            return None
        wanted = name != "not"
        weight = (0, 0, 0) if name == "where" else max(selector.specificity for selector in inner)
        return (lambda node, budget: any(selector.matches(node, budget) for selector in inner) == wanted), weight
    ends = {"first-child": (False, False), "last-child": (True, False)}
    ends |= {"first-of-type": (False, True), "last-of-type": (True, True)}
    if name in ends:
        return _nth(0, 1, *ends[name]), one
    if name in ("only-child", "only-of-type"):
        first, last = _nth(0, 1, False, name != "only-child"), _nth(0, 1, True, name != "only-child")
        return (lambda node, budget: first(node, budget) and last(node, budget)), one
    counted = {"nth-child": (False, False), "nth-last-child": (True, False)}
    counted |= {"nth-of-type": (False, True), "nth-last-of-type": (True, True)}
    if name in counted:
        text = {"odd": "2n+1", "even": "2n"}.get(argument.lower(), argument.lower())
        match = _NTH.match(text) if len(text) < 40 else None
        if match is None:
            return None
        step, sign, offset, alone = match.groups()
        if alone is not None:
            return _nth(0, int(alone), *counted[name]), one
        a = int(step + "1") if step in ("", "+", "-") else int(step)
        return _nth(a, int((sign or "") + (offset or "0")), *counted[name]), one
    return None


def _nth(a: int, b: int, from_end: bool, of_type: bool) -> Test:
    """Whether an element is the a n + b-th of its siblings, n = 0, 1, ..."""

    def test(node: Node, budget: Budget) -> bool:
        siblings = [node] if node.parent is None else node.parent.children
        place = budget.place(node)
        if of_type:
            some = siblings[place + 1 :] if from_end else siblings[:place]
            budget.spend(len(some))
            count = 1 + sum(other.tag == node.tag for other in some)
        else:
            count = len(siblings) - place if from_end else place + 1
        return count == b if a == 0 else (count - b) % a == 0 and (count - b) // a >= 0

    return test
