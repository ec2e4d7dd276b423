"""The tree of an SVG file, read safely: what is needed of each element, and nothing of other namespaces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ..errors import ReadError
from .safe_xml import parse_xml

SVG_NAMESPACE = "http://www.w3.org/2000/svg"
XLINK_NAMESPACE = "http://www.w3.org/1999/xlink"
INKSCAPE_NAMESPACE = "http://www.inkscape.org/namespaces/inkscape"

#: All XML elements of a file, drawn or not (metadata, gradients, text).
MAX_XML_ELEMENTS = 200_000
#: Class names of one element.
MAX_CLASSES = 50


@dataclass(eq=False, slots=True)
class Node:
    """One XML element.

    tag         local name; elements of foreign namespaces (editors' own data) have the tag ""
    attributes  local names; ``href`` whether plain or xlink, ``inkscape:label`` for Inkscape's layer name
    number      place in the file among elements of the same tag, from 1
    text        character data, collected for <style> only
    classes     its class names; no more than a drawing could mean
    """

    tag: str
    attributes: dict[str, str]
    parent: Node | None
    number: int
    children: list[Node] = field(default_factory=list)
    text: str = ""
    classes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if names := self.attributes.get("class"):
            self.classes = tuple(names.split(None, MAX_CLASSES)[:MAX_CLASSES])

    def __str__(self) -> str:
        identity = self.attributes.get("id", "")[:40]
        return f"<{self.tag}> {self.number}" + (f" (id {identity!r})" if identity else "")

    def walk(self) -> Iterator[Node]:
        """This node and everything below it, in the file's order. Not recursive."""
        stack = [self]
        while stack:
            node = stack.pop()
            yield node
            stack.extend(reversed(node.children))


def parse_svg_tree(data: bytes | str) -> Node:
    """The root <svg> node. Raises ReadError: empty, not XML, not SVG, too deep or too much of anything."""
    builder = _Builder()
    parse_xml(data, builder, MAX_XML_ELEMENTS)
    root = builder.root
    if root is None:
        raise ReadError("this is not well-formed XML (no element in it)")
    if root.tag != "svg":
        raise ReadError(f"this is XML but not SVG: its root element is <{builder.root_name}>")
    return root


class _Builder:
    """What is in the file -> nodes."""

    def __init__(self) -> None:
        self.root: Node | None = None
        self.root_name = ""
        self._open: list[Node] = []
        self._numbers: dict[str, int] = {}

    def start(self, name: str, attributes: dict[str, str]) -> None:
        namespace, _, local = name.rpartition("}")
        # A file without any namespace is read too: several small exporters forget it.
        tag = local if namespace in ("", SVG_NAMESPACE) else ""
        self._numbers[tag] = self._numbers.get(tag, 0) + 1
        parent = self._open[-1] if self._open else None
        node = Node(tag, _attributes(attributes), parent, self._numbers[tag])
        if parent is None:
            self.root, self.root_name = node, local
        else:
            parent.children.append(node)
        self._open.append(node)

    def end(self, _name: str) -> None:
        self._open.pop()

    def characters(self, text: str) -> None:
        if self._open and self._open[-1].tag == "style":
            self._open[-1].text += text


def _attributes(attributes: dict[str, str]) -> dict[str, str]:
    kept: dict[str, str] = {}
    for name, value in attributes.items():
        namespace, _, local = name.rpartition("}")
        if namespace in ("", SVG_NAMESPACE):
            kept[local] = value
        elif namespace == XLINK_NAMESPACE and local == "href":
            kept.setdefault("href", value)
        elif namespace == INKSCAPE_NAMESPACE and local in ("label", "groupmode"):
            kept["inkscape:" + local] = value
        elif local == "layername":  # LibreCAD's own
            kept.setdefault("data-layer", value)
    # SVG 2: a plain href wins over xlink:href, in whatever order they come.
    if "href" in attributes:
        kept["href"] = attributes["href"]
    return kept
