"""Reading XML safely, whatever it describes: bounded, few and small entities, nothing from outside of the file.

Expat alone: the standard tree builders expand entities and cannot be told to stop at a depth or a count.
"""

from __future__ import annotations

from typing import Protocol
from xml.parsers import expat

from ..errors import ReadError
from .text import decode_xml
from .xml_entities import Entities

#: Nesting of XML elements; real drawings stay below 30. Each level of an SVG file is a Python call while drawing.
MAX_DEPTH = 100


class XmlEvents(Protocol):
    """Who is told what is in a file. Names are "namespace}local", or "local" without a namespace."""

    def start(self, name: str, attributes: dict[str, str]) -> None: ...

    def end(self, name: str) -> None: ...

    def characters(self, text: str) -> None: ...


def parse_xml(data: bytes | str, events: XmlEvents, most_elements: int) -> None:
    """Tells ``events`` what is in a file. Raises ReadError: empty, not XML, too deep or too many elements."""
    if not data.strip():
        raise ReadError("the file is empty")
    # As text: expat itself knows four encodings, and then takes the declaration for done.
    text = decode_xml(data)
    guard = _Guard(text, events, most_elements)
    parser = expat.ParserCreate(namespace_separator="}")
    parser.StartElementHandler = guard.start
    parser.EndElementHandler = guard.end
    parser.CharacterDataHandler = events.characters
    parser.EntityDeclHandler = guard.entity
    parser.EndDoctypeDeclHandler = guard.end_doctype
    parser.ExternalEntityRefHandler = guard.external
    parser.SkippedEntityHandler = guard.skipped
    parser.buffer_text = True
    # Attributes that a DTD gives to all elements of a kind: a long one would be copied to each of them.
    parser.specified_attributes = True
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise ReadError(
            f"this is not well-formed XML ({expat.ErrorString(error.code)} in line {error.lineno})"
        ) from error
    except (ValueError, LookupError, UnicodeError) as error:
        raise ReadError(f"this is not well-formed XML ({error})") from error


class _Guard:
    """Stands between expat and who is told: counts, and checks entities."""

    def __init__(self, text: str, events: XmlEvents, most_elements: int) -> None:
        self._text = text
        self._events = events
        self._most_elements = most_elements
        self._entities = Entities()
        self._elements = 0
        self._depth = 0

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self._elements += 1
        if self._elements > self._most_elements:
            raise ReadError(f"the drawing has more than {self._most_elements:,} elements")
        if self._depth >= MAX_DEPTH:
            raise ReadError(f"the drawing's elements are nested more than {MAX_DEPTH} deep")
        self._depth += 1
        self._events.start(name, attributes)

    def end(self, name: str) -> None:
        self._depth -= 1
        self._events.end(name)

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
