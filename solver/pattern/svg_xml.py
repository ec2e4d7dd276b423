"""Reading XML safely: bounded, few and small entities, nothing from outside of the file.

A tree of our own is built straight from expat: the standard tree builders expand entities and cannot be told
to stop at a depth or a count.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from ..errors import ReadError
from .text import decode_xml
from .xml_entities import Entities

SVG_NAMESPACE = "http://www.w3.org/2000/svg"
XLINK_NAMESPACE = "http://www.w3.org/1999/xlink"
INKSCAPE_NAMESPACE = "http://www.inkscape.org/namespaces/inkscape"

#: All XML elements of a file, drawn or not (metadata, gradients, text).
MAX_XML_ELEMENTS = 200_000
#: Nesting of XML elements; real drawings stay below 30, and each level is a Python call while drawing.
MAX_DEPTH = 100
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
    if not data.strip():
        raise ReadError("the file is empty")
    # As text: expat itself knows four encodings, and then takes the declaration for done.
    data = decode_xml(data)
    builder = _Builder(data)
    parser = expat.ParserCreate(namespace_separator="}")
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.characters
    parser.EntityDeclHandler = builder.entity
    parser.EndDoctypeDeclHandler = builder.end_doctype
    parser.ExternalEntityRefHandler = builder.external
    parser.SkippedEntityHandler = builder.skipped
    parser.buffer_text = True
    # Attributes that a DTD gives to all elements of a kind: a long one would be copied to each of them.
    parser.specified_attributes = True
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ReadError(
            f"this is not well-formed XML ({expat.ErrorString(error.code)} in line {error.lineno})"
        ) from error
    except (ValueError, LookupError, UnicodeError) as error:
        raise ReadError(f"this is not well-formed XML ({error})") from error
    root = builder.root
    if root is None:
        raise ReadError("this is not well-formed XML (no element in it)")
    if root.tag != "svg":
        raise ReadError(f"this is XML but not SVG: its root element is <{builder.root_name}>")
    return root


class _Builder:
    """Expat's events -> nodes."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._entities = Entities()
        self.root: Node | None = None
        self.root_name = ""
        self._open: list[Node] = []
        self._elements = 0
        self._numbers: dict[str, int] = {}

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._elements += 1
        if self._elements > MAX_XML_ELEMENTS:
            raise ReadError(f"the drawing has more than {MAX_XML_ELEMENTS:,} elements")
        if len(self._open) >= MAX_DEPTH:
            raise ReadError(f"the drawing's elements are nested more than {MAX_DEPTH} deep")
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

    def entity(self, name: str, parameter: int, value: str | None, *_rest: object) -> None:
        # Those of other files have no value here, and parameter entities are never put anywhere.
        if value is not None and not parameter:
            self._entities.declare(name, value)

    def end_doctype(self) -> None:
        if self._entities:
            self._entities.check(self._text)

    def external(self, _context: str | None, _base: str | None, system: str | None, public: str | None) -> int:
        raise ReadError(f"it refers to another file ({(system or public or '')[:80]!r}) by an XML entity, not read")

    def skipped(self, name: str, parameter: int) -> None:
        if not parameter:
            raise ReadError(f"it refers to the XML entity {name[:40]!r}, which is not declared in it")


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
