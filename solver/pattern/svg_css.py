"""The part of CSS that drawings use: type, class and id selectors, with descendants and children."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ..errors import ReadError
from .svg_xml import Node

#: Comparisons of one element with one rule, over a whole file; above it the file was made to stall a reader.
MAX_MATCHES = 500_000

_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)|<!--|-->", re.DOTALL)
_SIMPLE = re.compile(r"([.#]?)([-\w\u0080-\uffff]+|\*)")

#: Properties handed down to children, with the values they start from (SVG 1.1, appendix N).
INHERITED = {
    "stroke": "none",
    "fill": "black",
    "color": "black",
    "visibility": "visible",
    "stroke-width": "1",
    "stroke-dasharray": "none",
    "stroke-opacity": "1",
    "fill-opacity": "1",
}
_PROPERTIES = frozenset(INHERITED) | {"display", "opacity", "clip-path", "mask", "transform"}
#: Parts of one selector.
MAX_CHAIN = 10
#: Characters of one property. Only transforms come anywhere near.
MAX_PROPERTY = 10_000


def parse_declarations(text: str) -> dict[str, str]:
    """``"stroke: red; fill:none"`` -> {"stroke": "red", "fill": "none"}. Names in lower case."""
    declarations: dict[str, str] = {}
    for part in _COMMENT.sub("", text).split(";"):
        name, colon, value = part.partition(":")
        if colon and name.strip():
            declarations[name.strip().lower()] = value.partition("!")[0].strip()
    return declarations


@dataclass(frozen=True)
class _Compound:
    """``path.red#top``: all parts must hold for one element."""

    tag: str
    identity: str
    classes: frozenset[str]

    def matches(self, node: Node) -> bool:
        if self.tag and self.tag != node.tag:
            return False
        if self.identity and self.identity != node.attributes.get("id"):
            return False
        return not self.classes or self.classes.issubset(node.classes)


@dataclass(frozen=True)
class _Rule:
    chain: tuple[_Compound, ...]  # the last one is the element itself
    child: tuple[bool, ...]  # whether chain[k + 1] must be a direct child of chain[k]
    order: tuple[int, int, int, int]  # CSS specificity, then the place in the file
    declarations: dict[str, str]

    def matches(self, node: Node) -> bool:
        if not self.chain[-1].matches(node):
            return False
        # Greedy from the inside out: exact for descendants, and for children of the nearest match.
        current = node.parent
        for compound, direct in zip(reversed(self.chain[:-1]), reversed(self.child), strict=True):
            while current is not None and not compound.matches(current):
                if direct:
                    return False
                current = current.parent
            if current is None:
                return False
            current = current.parent
        return True


class Stylesheet:
    """All <style> elements of a drawing. ``skipped`` holds what was not understood, for the notes."""

    def __init__(self, root: Node) -> None:
        self.skipped: list[str] = []
        self._by_key: dict[str, list[_Rule]] = {}
        self._styles: dict[Node, dict[str, str]] = {}
        self._budget = MAX_MATCHES
        order = 0
        for node in root.walk():
            if node.tag == "style" and node.attributes.get("type", "text/css").strip() in ("", "text/css"):
                for selectors, body in self._blocks(_COMMENT.sub("", node.text)):
                    declarations = parse_declarations(body)
                    for selector in selectors.split(","):
                        order += 1
                        self._add(selector.strip(), declarations, order)

    def _blocks(self, text: str) -> Iterator[tuple[str, str]]:
        position = 0
        while (brace := text.find("{", position)) >= 0:
            head = text[position:brace]
            # @import, @charset and the like end with a semicolon and have no block.
            if ";" in head:
                head = head.rpartition(";")[2]
            end = _block_end(text, brace)
            if head.strip().startswith("@"):
                self.skipped.append(head.strip().split("\n")[0][:40])
            else:
                yield head, text[brace + 1 : end]
            position = end + 1

    def _add(self, selector: str, declarations: dict[str, str], order: int) -> None:
        chain: list[_Compound] = []
        child: list[bool] = []
        direct = False
        for token in selector.replace(">", " > ").split():
            if token == ">":
                direct = True
                continue
            compound = _compound(token)
            if compound is None:
                self.skipped.append(selector[:40])
                return
            if chain:
                child.append(direct)
            chain.append(compound)
            if len(chain) > MAX_CHAIN:
                self.skipped.append(selector[:40])
                return
            direct = False
        if not chain:
            return
        rule = _Rule(
            tuple(chain),
            tuple(child),
            (
                sum(bool(c.identity) for c in chain),
                sum(len(c.classes) for c in chain),
                sum(bool(c.tag) for c in chain),
                order,
            ),
            declarations,
        )
        last = chain[-1]
        if last.identity:
            key = "#" + last.identity
        elif last.classes:
            key = "." + min(last.classes)
        else:
            key = last.tag
        self._by_key.setdefault(key, []).append(rule)

    def style(self, node: Node) -> dict[str, str]:
        """What is said of ``node``: by its presentation attributes, then the rules, then style=."""
        known = self._styles.get(node)
        if known is not None:
            return known
        attributes = node.attributes
        result = dict(attributes)
        if self._by_key:
            keys = ["", node.tag, "#" + attributes.get("id", "")]
            keys += ["." + name for name in set(node.classes)]
            candidates = [rule for key in keys for rule in self._by_key.get(key, ())]
            self._budget -= len(candidates)
            if self._budget < 0:
                raise ReadError("the drawing's style sheet has too many rules for its elements")
            for rule in sorted((r for r in candidates if r.matches(node)), key=lambda r: r.order):
                result.update(rule.declarations)
        if "style" in attributes:
            result.update(parse_declarations(attributes["style"]))
        result = {name: value for name, value in result.items() if name in _PROPERTIES}
        for name, value in result.items():
            if len(value) > MAX_PROPERTY:
                raise ReadError(f"{name} has more than {MAX_PROPERTY:,} characters", element=str(node))
        self._styles[node] = result
        return result


def _block_end(text: str, brace: int) -> int:
    depth = 0
    for match in re.compile(r"[{}]").finditer(text, brace):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.start()
    return len(text)


def _compound(token: str) -> _Compound | None:
    tag, identity, classes = "", "", set()
    position = 0
    while position < len(token):
        match = _SIMPLE.match(token, position)
        if match is None:
            return None
        kind, name = match.groups()
        if kind == ".":
            classes.add(name)
        elif kind == "#":
            identity = name
        elif position > 0:
            return None
        elif name != "*":
            tag = name
        position = match.end()
    return _Compound(tag, identity, frozenset(classes))
